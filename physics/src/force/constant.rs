//! A force and a torque that are constant in time.

use std::sync::Arc;

use glam::DVec3;

use super::super::BodyId;
use super::{Force, ForceOnEach, Loads, Moment, share};

/// A constant force at the centre of mass, and a constant torque, on each of some bodies.
///
/// The force has the potential −F·x. The torque has no potential, because it does work in a full rotation back to the same orientation. So
/// the work of the torque, with the power τ·ω, is added to the accounts.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstantForce {
    /// The bodies that the force and the torque act on.
    pub bodies: Vec<BodyId>,
    /// The force on each body, world axes, N.
    pub force: DVec3,
    /// The torque on each body about its centre of mass, world axes, N m.
    pub torque: DVec3,
}

impl Force for ConstantForce {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        for body in &self.bodies {
            let i = body.index();
            loads.force[i] += self.force;
            loads.torque[i] += self.torque;
            loads.power.work += self.torque.dot(moment.model.angular_velocity(i, moment.state));
        }
    }

    fn is_local(&self) -> bool {
        // The work of a torque is integrated along with the motion, which needs all bodies at the same time.
        self.torque == DVec3::ZERO
    }

    fn depends_on_motion(&self) -> bool {
        self.torque != DVec3::ZERO
    }

    fn turns_bodies(&self) -> bool {
        self.torque != DVec3::ZERO
    }

    fn potential(&self, moment: &Moment) -> f64 {
        let mut potential = 0.0;
        for body in &self.bodies {
            if moment.model.movable()[body.index()] {
                potential -= self.force.dot(moment.state.location[body.index()]);
            }
        }
        potential
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        for i in self.bodies.iter().map(|body| body.index()) {
            share(-self.force.dot(moment.state.location[i]), [i], moment, shares);
        }
    }
}

impl ForceOnEach for ConstantForce {
    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn on_particles(&self, particles: Vec<BodyId>) -> Arc<dyn Force> {
        Arc::new(ConstantForce { bodies: particles, force: self.force, torque: DVec3::ZERO })
    }

    fn changes_momenta(&self) -> [bool; 2] {
        let pushes = self.force != DVec3::ZERO;
        [pushes, pushes || self.torque != DVec3::ZERO]
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    #[test]
    fn it_acts_on_the_named_bodies_and_its_torque_does_work() {
        let (model, mut state) = bodies(&[(DVec3::X, DVec3::Y), (DVec3::splat(2.0), DVec3::X)]);
        // The angular velocity is ω = L / I with I = ⅖ · 2 kg · (0.1 m)².
        state.angular_momentum[1] = DVec3::new(0.0, 0.008, 0.0);
        let force = ConstantForce {
            bodies: vec![BodyId::new(1)],
            force: DVec3::X,
            torque: DVec3::new(0.0, 3.0, 4.0),
        };
        assert_minus_gradient(&force, &model, &state);
        let loads = loads(&force, &model, &state);
        assert_eq!(loads.force, [DVec3::ZERO, DVec3::X]);
        assert_eq!(loads.torque, [DVec3::ZERO, DVec3::new(0.0, 3.0, 4.0)]);
        assert!((loads.power.work - 3.0).abs() < 1e-14);
    }
}
