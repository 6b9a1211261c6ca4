//! Detection of friction that switches between sticking and sliding again and again within a step.
//!
//! Two bodies that touch at several points can distribute friction over these points in many ways. If all points are at their friction
//! limits, they would slide and stick in turn endlessly. After a few changes, all points of these bodies stick until the end of the step,
//! even beyond the limit.

use super::super::Model;
use super::solver::Solver;
use super::structure::Structure;

/// The largest number of mode changes at the contacts between two bodies in a step. Without this limit, several redundant points at their
/// friction limits would change their modes endlessly.
pub(super) const RESTLESS: u32 = 4;

impl Solver {
    /// Resets the counts of mode changes at the start of a step. Contacts that exceeded the limit in the last step may change only once in
    /// this step.
    pub(in crate::dynamics) fn calm(&mut self) {
        self.changes.retain(|_, changes| *changes > RESTLESS);
        self.changes.values_mut().for_each(|changes| *changes = RESTLESS);
        self.grips.iter_mut().for_each(|grip| grip.is_restless = false);
    }

    /// Counts a mode change of a contact's constraint row. Rows of joints are not counted.
    pub(in crate::dynamics) fn note_change(&mut self, model: &Model, row: usize) {
        let Some(structure) = self.structure.take() else { return };
        let place = structure.place_of_row(row);
        let contact = place.and_then(|place| place.constraint.checked_sub(model.constraints().len()));
        if let Some(contact) = contact {
            *self.changes.entry(self.contacts[contact].bodies).or_default() += 1;
            self.see_restless(model, &structure);
        }
        self.structure = Some(structure);
    }

    /// Returns true if the contacts between two bodies have changed their modes too often in this step.
    pub(in crate::dynamics) fn changes_too_often(&self, bodies: [usize; 2]) -> bool {
        self.changes.get(&bodies).is_some_and(|changes| *changes > RESTLESS + 2)
    }

    /// Marks the friction of each contact that has changed its mode too often in this step.
    pub(super) fn see_restless(&mut self, model: &Model, structure: &Structure) {
        if self.changes.is_empty() {
            return;
        }
        for grip in &mut self.grips {
            let Ok(place) = structure.places.binary_search_by_key(&grip.normal, |place| place.row) else {
                continue;
            };
            let contact = structure.places[place].constraint.checked_sub(model.constraints().len());
            let changes = contact.and_then(|contact| self.changes.get(&self.contacts[contact].bodies));
            grip.is_restless = changes.is_some_and(|changes| *changes > RESTLESS);
        }
    }
}
