//! The Lorentz force in uniform electric and magnetic fields.

use std::sync::Arc;

use glam::DVec3;

use super::super::BodyId;
use super::{Force, ForceOnEach, Loads, Moment, share};

/// The Lorentz force F = q (E + v × B) on each of some charged bodies, in fields that are uniform and constant.
///
/// The electric field has the potential −q E·x. The magnetic force is perpendicular to the velocity, and does no work. Source: J. D.
/// Jackson, *Classical Electrodynamics*, 6.7 and 12.2 (for velocities far below that of light).
#[derive(Debug, Clone, PartialEq)]
pub struct Lorentz {
    /// The charged bodies that feel the fields.
    pub bodies: Vec<BodyId>,
    /// The electric field E, world axes, V/m.
    pub electric: DVec3,
    /// The magnetic field B, world axes, T.
    pub magnetic: DVec3,
}

impl Force for Lorentz {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        for body in &self.bodies {
            let i = body.index();
            let field = self.electric + moment.state.velocity[i].cross(self.magnetic);
            loads.force[i] += moment.model.charge()[i] * field;
        }
    }

    fn turns_bodies(&self) -> bool {
        false
    }

    fn potential(&self, moment: &Moment) -> f64 {
        let model = moment.model;
        let movable = self.bodies.iter().map(|body| body.index()).filter(|&i| model.movable()[i]);
        movable.map(|i| -model.charge()[i] * self.electric.dot(moment.state.location[i])).sum()
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        for i in self.bodies.iter().map(|body| body.index()) {
            let energy = -moment.model.charge()[i] * self.electric.dot(moment.state.location[i]);
            share(energy, [i], moment, shares);
        }
    }
}

impl ForceOnEach for Lorentz {
    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn on_particles(&self, particles: Vec<BodyId>) -> Arc<dyn Force> {
        Arc::new(Lorentz { bodies: particles, ..*self })
    }

    fn depends_on_charge(&self) -> bool {
        true
    }

    fn magnetic_field(&self) -> Option<DVec3> {
        Some(self.magnetic)
    }

    fn has_levels(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{assert_minus_gradient, charged, loads};
    use super::*;

    #[test]
    fn the_magnetic_force_is_perpendicular_and_the_electric_one_has_a_potential() {
        let (model, mut state) = charged(&[(2.0, DVec3::X), (-1.0, DVec3::Y)]);
        let bodies = [0, 1].map(BodyId::new).to_vec();
        let lorentz = Lorentz { bodies, electric: DVec3::new(3.0, 0.0, 1.0), magnetic: 4.0 * DVec3::Z };
        assert_minus_gradient(&lorentz, &model, &state);
        state.velocity[0] = DVec3::X;
        // The expected force is q (E + v × B), where x × z = −y.
        let loads = loads(&lorentz, &model, &state);
        assert_eq!(loads.force, [DVec3::new(6.0, -8.0, 2.0), DVec3::new(-3.0, 0.0, -1.0)]);
        assert_eq!(loads.power.work, 0.0);
    }
}
