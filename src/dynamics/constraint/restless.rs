//! Friction that starts and stops sliding again and again within a step.
//!
//! Two bodies that touch at several points can share friction among these in many ways. If all points are at their limits, one after
//! another would slide and stick endlessly. After a few changes they stick until the end of the step, even beyond the limit.

use super::super::Model;
use super::solver::Solver;
use super::structure::Structure;

/// The largest number of mode changes of friction between two bodies in a step. If several points that imply each other need to be at
/// their limits, they would change endlessly.
pub(super) const RESTLESS: u32 = 4;

impl Solver {
    /// Called at the start of a step: contacts that were restless in the last step may change only once.
    pub(in crate::dynamics) fn calm(&mut self) {
        self.changes.retain(|_, changes| *changes > RESTLESS);
        self.changes.values_mut().for_each(|changes| *changes = RESTLESS);
        self.grips.iter_mut().for_each(|grip| grip.is_restless = false);
    }

    /// Notes that a row changes its mode.
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

    /// Whether the contacts between two bodies have changed too often in this step.
    pub(in crate::dynamics) fn changes_too_often(&self, bodies: [usize; 2]) -> bool {
        self.changes.get(&bodies).is_some_and(|changes| *changes > RESTLESS + 2)
    }

    /// Updates which pairs of rows are restless.
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
