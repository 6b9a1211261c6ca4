//! The last contact forces, from which the next Gauss–Seidel sweeps start.

use std::collections::BTreeMap;

use super::super::contact::LastingContact;

/// The last known contact forces: for each pair of bodies, their contacts with the multipliers of each contact's rows, N or N m.
#[derive(Clone, Debug, Default)]
pub(super) struct LastForces(BTreeMap<[usize; 2], Vec<(LastingContact, Vec<f64>)>>);

impl LastForces {
    /// Discards the stored forces between two bodies.
    pub(super) fn forget(&mut self, bodies: [usize; 2]) {
        self.0.remove(&bodies);
    }

    /// Stores the forces along the constraint rows of a contact, N or N m.
    pub(super) fn note(&mut self, contact: &LastingContact, forces: impl Iterator<Item = f64>) {
        let known = self.0.entry(contact.bodies).or_default();
        known.push((contact.clone(), forces.collect()));
    }

    /// Returns the stored forces along the constraint rows of the same contact; `None` if there are none.
    pub(super) fn find(&self, contact: &LastingContact) -> Option<Vec<f64>> {
        let known = self.0.get(&contact.bodies)?.iter();
        let mut same = known.filter(|(other, _)| other.is(contact));
        same.next().map(|(other, forces)| other.carried(forces, contact))
    }
}
