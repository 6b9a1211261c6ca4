//! Coulomb's force between electric charges.

use std::sync::Arc;

use super::super::{BodyId, RigidBody};
use super::pairs::{self, Pairs};
use super::{Force, ForceBetween, Loads, Moment};

/// Coulomb's force between any two of the listed bodies: they repel each other with k q₁ q₂ r / (r² + ε²)^(3/2), or attract each other if
/// their charges have different signs. The potential is k q₁ q₂ / √(r² + ε²).
///
/// Fixed bodies act on other bodies as well. Moving charges exert no magnetic forces: this law holds for velocities far below that of
/// light. Source: J. D. Jackson, *Classical Electrodynamics*, 1.1.
#[derive(Debug, Clone, PartialEq)]
pub struct Coulomb {
    /// The charged bodies that act on each other.
    pub bodies: Vec<BodyId>,
    /// A second group of bodies, disjoint from the first. If present, each body acts only on the bodies of the other group.
    pub against: Option<Vec<BodyId>>,
    /// The Coulomb constant k = 1/4πε₀, N m²/C².
    pub constant: f64,
    /// The softening length ε, m.
    pub softening: f64,
}

impl Coulomb {
    /// The Coulomb constant 1/4πε₀ in vacuum, N m²/C². Source: ε₀ of CODATA 2022.
    pub const CONSTANT: f64 = 8.987_551_786_2e9;

    fn of<'a>(&'a self, moment: &Moment<'a>) -> Pairs<'a> {
        let strength = moment.model.charge();
        Pairs {
            bodies: &self.bodies,
            against: self.against.as_deref(),
            strength,
            constant: self.constant,
            softening: self.softening,
        }
    }
}

impl Force for Coulomb {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        self.of(moment).apply(moment, loads);
    }

    fn depends_on_motion(&self) -> bool {
        false
    }

    fn turns_bodies(&self) -> bool {
        false
    }

    fn potential(&self, moment: &Moment) -> f64 {
        self.of(moment).potential(moment)
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        self.of(moment).share_potential(moment, shares);
    }

    fn pairs(&self) -> u64 {
        pairs::count(&self.bodies, self.against.as_deref())
    }
}

impl ForceBetween for Coulomb {
    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn against(&self) -> Option<&[BodyId]> {
        self.against.as_deref()
    }

    fn on_particles(&self, particles: Vec<BodyId>, sources: Vec<BodyId>) -> Arc<dyn Force> {
        Arc::new(Coulomb { bodies: particles, against: Some(sources), ..*self })
    }

    fn depends_on_charge(&self) -> bool {
        true
    }

    fn source_strength(&self, source: &RigidBody) -> f64 {
        // Two positive charges attract each other if the constant is negative.
        source.charge * self.constant.signum()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::testing::{assert_minus_gradient, charged, loads};
    use super::*;

    #[test]
    fn charges_of_the_same_sign_repel_and_others_attract() {
        for (charge, x) in [(3.0, -1.5), (-3.0, 1.5)] {
            let (model, state) = charged(&[(2.0, DVec3::ZERO), (charge, 2.0 * DVec3::X)]);
            let bodies = [0, 1].map(BodyId::new).to_vec();
            let coulomb = Coulomb { bodies, against: None, constant: 1.0, softening: 0.0 };
            // The force is k q₁ q₂ / r² = 6 / 4.
            assert_eq!(loads(&coulomb, &model, &state).force, [x * DVec3::X, -x * DVec3::X]);
            assert_minus_gradient(&coulomb, &model, &state);
        }
    }
}
