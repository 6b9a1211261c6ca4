//! Friction that begins and ceases to slide again and again within a step.
//!
//! Two bodies that touch at several places can share friction among these in many ways. Where all places are at their limits, one
//! after another would slide and stick without end. After a few changes they stick until the step is over, even beyond the limit.

use super::super::Model;
use super::solver::Solver;
use super::structure::Structure;

/// So many times friction between two bodies may change what it does in a step. Where it needs to be at its limit in several places
/// that imply each other, it would change without end.
pub(super) const RESTLESS: u32 = 4;

impl Solver {
    /// Told at the beginning of a step: what was restless in the one before may change once.
    pub(in crate::dynamics) fn calm(&mut self) {
        self.changes.retain(|_, changes| *changes > RESTLESS);
        self.changes.values_mut().for_each(|changes| *changes = RESTLESS);
        self.grips.iter_mut().for_each(|grip| grip.is_restless = false);
    }

    /// Notes that a row changes what it does.
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

    /// Whether what holds two bodies at each other has changed again and again in the present step.
    pub(in crate::dynamics) fn changes_too_often(&self, bodies: [usize; 2]) -> bool {
        self.changes.get(&bodies).is_some_and(|changes| *changes > RESTLESS + 2)
    }

    /// Notes which pairs of rows are restless.
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
