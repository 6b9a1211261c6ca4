//! Laws that no contact and no joint can break, and how well a run keeps them.
//!
//! Impulses between bodies conserve angular momentum. Friction, and restitution of at most 1, take energy and never add any. Three things
//! are checked: each impact, each substep of Moreau's scheme, and the friction of every other part of a step. A check takes time
//! proportional to the number of contacts. The worst residual of each law stays on record.

use super::super::{BodyId, Breakdown, Model, State};
use super::collider::Collider;
use super::impacts::kinetic;

/// A law that no contact and no joint can break.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionLaw {
    /// Contacts, friction and joints without motors add no energy.
    Energy,
    /// Impulses between bodies do not change their total angular momentum.
    AngularMomentum,
}

impl MotionLaw {
    /// All laws, in the order in which they are reported.
    pub const ALL: [MotionLaw; 2] = [MotionLaw::Energy, MotionLaw::AngularMomentum];

    /// What breaks if this law does: the subject of a message such as "energy is off by 3 J".
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            MotionLaw::Energy => "energy",
            MotionLaw::AngularMomentum => "angular momentum",
        }
    }

    /// The unit of a residual of this law.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            MotionLaw::Energy => "J",
            MotionLaw::AngularMomentum => "kg m²/s",
        }
    }
}

/// A law is broken if its residual exceeds this fraction of its scale. Sweeps over many contacts leave smaller residuals.
const MAX_LAW_RESIDUAL: f64 = 1e-3;

/// A substep is repeated in smaller parts if its impulses add more energy than this fraction of the scale. Sweeps over contacts end when
/// they change rates by less than 1e-7 of the largest rate, so the energy that they leave is less.
const MAX_ENERGY_GAIN: f64 = 1e-6;

/// How far one solve of contacts was off a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawResidual {
    /// The law.
    pub law: MotionLaw,
    /// The time of the solve, s.
    pub time: f64,
    /// The indices of two bodies of the solve, the smaller one first. Both are the same if only one body took part.
    pub bodies: [usize; 2],
    /// The size of the residual, in the [unit](MotionLaw::unit) of the law. It is not negative.
    pub amount: f64,
    /// The amount, relative to the scale of the law: the largest kinetic energy of the solved bodies so far, or the moments of the
    /// impulses about the centers of their bodies.
    pub part: f64,
}

impl LawResidual {
    /// Returns the residual of impulses that have given bodies the energy `gain`, J, beyond that of motors and guides. A loss breaks no law.
    /// `kinetic` is the kinetic energy of the bodies, J.
    pub(super) fn of_energy(gain: f64, kinetic: f64, bodies: [usize; 2], time: f64) -> LawResidual {
        let amount = if gain.is_nan() { gain } else { gain.max(0.0) };
        let part = if amount == 0.0 { 0.0 } else { amount / kinetic.max(f64::MIN_POSITIVE) };
        LawResidual { law: MotionLaw::Energy, time, bodies, amount, part }
    }

    /// Returns the reason why a run stops if this residual is broken.
    pub(super) fn breakdown(&self) -> Breakdown {
        Breakdown::AddsEnergy { bodies: self.bodies.map(BodyId::new), time: self.time, energy: self.amount }
    }

    /// Returns true if a substep with this residual is repeated in smaller parts.
    pub(super) fn is_excess(&self) -> bool {
        self.part > MAX_ENERGY_GAIN || self.part.is_nan()
    }

    /// Returns true if the residual is larger than the errors that solvers leave.
    #[must_use]
    pub fn is_broken(&self) -> bool {
        // A NaN is broken, too.
        self.part > MAX_LAW_RESIDUAL || self.part.is_nan()
    }
}

/// The worst residual of each law in a run so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct LawBook {
    worst: Vec<LawResidual>,
    /// The largest kinetic energy of the solved bodies so far, J.
    energy: f64,
    /// The sum of all energies that friction of lasting contacts has added, J.
    rubbed: f64,
}

impl LawBook {
    /// Records a residual, if it is the worst of its law so far.
    pub(super) fn note(&mut self, new: LawResidual) {
        match self.worst.iter_mut().find(|known| known.law == new.law) {
            Some(known) if new.part.total_cmp(&known.part).is_gt() => *known = new,
            Some(_) => {}
            None => self.worst.push(new),
        }
    }

    /// Returns the residual of impulses that have given bodies the energy `gain`, J, beyond that of motors and guides. The scale is the
    /// largest kinetic energy of solved bodies so far; `kinetic` is that of these bodies, J.
    pub(super) fn weigh(&mut self, gain: f64, kinetic: f64, bodies: [usize; 2], time: f64) -> LawResidual {
        self.energy = self.energy.max(kinetic);
        LawResidual::of_energy(gain, self.energy, bodies, time)
    }

    /// Records that friction of lasting contacts has added the energy `gain`, J. All such energies count together, since the friction of many
    /// steps can add a little each time. `scale` is the energy that has moved, J.
    fn note_friction(&mut self, gain: f64, scale: f64, bodies: [usize; 2], time: f64) {
        self.rubbed += gain;
        let residual = self.weigh(self.rubbed, scale, bodies, time);
        self.note(residual);
    }

    /// Records a moment, N m s, that impulses between bodies exert on all of them together. `moments` is the sum of the moments of the
    /// impulses about the centers of their bodies, N m s.
    pub(super) fn note_moment(&mut self, amount: f64, moments: f64, bodies: [usize; 2], time: f64) {
        let part = if amount == 0.0 { 0.0 } else { amount / moments.max(f64::MIN_POSITIVE) };
        self.note(LawResidual { law: MotionLaw::AngularMomentum, time, bodies, amount, part });
    }

    /// Records the residuals of another book.
    pub(super) fn note_all(&mut self, other: &LawBook) {
        other.worst.iter().for_each(|residual| self.note(*residual));
        self.energy = self.energy.max(other.energy);
    }

    /// Returns the worst residual of each law.
    pub(super) fn worst(&self) -> &[LawResidual] {
        &self.worst
    }
}

impl Collider {
    /// Records the energy that friction has added since its account was `before`, J, if it has. `bodies` are those whose contact presses
    /// hardest.
    pub(crate) fn note_friction(
        &mut self,
        model: &Model,
        state: &State,
        before: f64,
        (bodies, time): ([usize; 2], f64),
    ) {
        let after = state.accounts.friction;
        if after > before || after.is_nan() {
            let moving: f64 = (0..model.len()).map(|body| kinetic(body, model, state)).sum();
            // A body that friction stops has had at least the energy that friction took.
            self.laws.note_friction(after - before, moving.max(after.abs()), bodies, time);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each piece of a step may add an energy that is small enough to be excused, but all of them together may not.
    #[test]
    fn what_friction_adds_in_many_steps_counts_together() {
        let mut book = LawBook::default();
        for (step, is_broken) in [(0, false), (1, true), (2, true)] {
            book.note_friction(0.6e-3, 1.0, [0, 1], f64::from(step));
            let [residual] = book.worst() else { panic!("{:?}", book.worst()) };
            assert_eq!(residual.is_broken(), is_broken, "{residual:?}");
        }
    }
}
