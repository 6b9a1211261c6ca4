//! Buoyancy of bodies in a liquid.

use glam::DVec3;

use super::super::{BodyId, Shape};
use super::{Force, Loads, Moment, share};

/// Buoyancy of some bodies in a liquid at rest: F = −ρ V g acts at the centre of the submerged part of a body, whose volume is V.
///
/// The potential is ρ |g| ∫ (level − h) dV over the submerged part, where h is the height of a point. It is the energy that lifted the
/// displaced liquid to its surface. The force and its torque about the centre of mass are minus the gradient of this potential. The surface
/// stays flat, and its level stays the same. Source: Archimedes, *On Floating Bodies* I, prop. 5 and 6; L. D. Landau & E. M. Lifshitz,
/// *Fluid Mechanics*, § 2.
#[derive(Debug, Clone, PartialEq)]
pub struct Buoyancy {
    /// The bodies that feel the buoyancy, each with its shape. Shapes whose submerged volume cannot be computed feel no force.
    pub bodies: Vec<(BodyId, Shape)>,
    /// The density ρ of the liquid, kg/m³.
    pub density: f64,
    /// The height of the liquid's surface above the origin, in the direction opposite to gravity, m.
    pub level: f64,
    /// The acceleration g of gravity, world axes, m/s². Without gravity there is no buoyancy.
    pub gravity: DVec3,
}

impl Buoyancy {
    /// Returns the unit vector opposite to gravity; `None` without gravity.
    #[must_use]
    pub fn up(&self) -> Option<DVec3> {
        self.gravity.try_normalize().map(|down| -down)
    }

    /// Calls `see` for each present body with its index, its submerged volume (m³), and the first moment of that volume about the centre
    /// of mass (world axes, m⁴).
    fn each(&self, moment: &Moment, mut see: impl FnMut(usize, f64, DVec3)) {
        let Some(up) = self.up() else { return };
        for (body, shape) in &self.bodies {
            let i = body.index();
            if !moment.model.is_present(i) {
                continue;
            }
            let turn = moment.model.world_from_body(i, moment.state);
            let depth = self.level - moment.state.location[i].dot(up);
            if let Some(below) = shape.submerged(turn.conjugate() * up, depth) {
                see(i, below.volume, turn * below.moment);
            }
        }
    }
}

impl Force for Buoyancy {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        self.each(moment, |i, volume, arm| {
            loads.force[i] -= self.density * volume * self.gravity;
            loads.torque[i] -= self.density * arm.cross(self.gravity);
        });
    }

    fn potential(&self, moment: &Moment) -> f64 {
        let Some(up) = self.up() else { return 0.0 };
        let mut sum = 0.0;
        self.each(moment, |i, volume, arm| {
            if moment.model.movable()[i] {
                let depth = self.level - moment.state.location[i].dot(up);
                sum += depth * volume - arm.dot(up);
            }
        });
        self.density * self.gravity.length() * sum
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        let Some(up) = self.up() else { return };
        self.each(moment, |i, volume, arm| {
            let depth = self.level - moment.state.location[i].dot(up);
            let lifted = depth * volume - arm.dot(up);
            share(self.density * self.gravity.length() * lifted, [i], moment, shares);
        });
    }

    fn is_local(&self) -> bool {
        true
    }

    fn depends_on_motion(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::super::super::{RigidBody, State};
    use super::super::testing::{assert_minus_gradient, loads};
    use super::super::{Force, Model};
    use super::*;

    #[allow(clippy::unwrap_used, reason = "it is part of tests")]
    fn floating(shape: &Shape) -> (Buoyancy, Model, State) {
        let (mut model, mut state) = (Model::default(), State::default());
        let body = RigidBody::new(shape, 1.0).with_location(DVec3::new(0.3, 0.2, -0.1));
        model
            .push(&body.with_orientation(DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.7, -0.5)), &mut state);
        let bodies = vec![(BodyId::new(0), shape.clone())];
        (Buoyancy { bodies, density: 2.0, level: 0.25, gravity: DVec3::new(0.0, -3.0, 4.0) }, model, state)
    }

    #[test]
    fn what_is_below_the_surface_weighs_less_by_the_liquid() {
        let (mut force, model, state) = floating(&Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) });
        force.level = 20.0;
        let lifted = loads(&force, &model, &state);
        assert!(
            lifted.force[0].abs_diff_eq(-12.0 * force.gravity, 1e-12) && lifted.torque[0].length() < 1e-12
        );
        force.level = -20.0;
        assert_eq!(loads(&force, &model, &state).force[0].length(), 0.0);
    }

    #[test]
    fn without_gravity_nothing_is_carried() {
        let (mut force, model, state) = floating(&Shape::Box { size: DVec3::ONE });
        force.gravity = DVec3::ZERO;
        let loads = loads(&force, &model, &state);
        assert_eq!((loads.force[0], loads.torque[0]), (DVec3::ZERO, DVec3::ZERO));
        assert_eq!(force.potential(&Moment { time: 0.0, state: &state, model: &model }), 0.0);
    }

    /// The torque must equal minus the derivative of the potential with respect to small rotations about each world axis.
    #[test]
    fn force_and_torque_are_minus_the_gradient_of_the_potential() {
        const H: f64 = 1e-5;
        for shape in [
            Shape::Sphere { radius: 0.4 },
            Shape::Box { size: DVec3::new(0.5, 0.7, 0.3) },
            Shape::Cylinder { radius: 0.3, height: 0.8 },
            Shape::Cone { radius: 0.4, top_radius: 0.1, height: 0.8 },
            Shape::Capsule { radius: 0.2, height: 0.9 },
            Shape::Torus { radius: 0.4, tube_radius: 0.1 },
        ] {
            let (force, model, state) = floating(&shape);
            assert_minus_gradient(&force, &model, &state);
            let loads = loads(&force, &model, &state);
            assert!(loads.force[0].length() > 0.1, "it is not out of the liquid");
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let potential = |angle: f64| {
                    let mut state = state.clone();
                    state.orientation[0] = DQuat::from_axis_angle(axis, angle) * state.orientation[0];
                    force.potential(&Moment { time: 0.0, state: &state, model: &model })
                };
                let expected = (potential(-H) - potential(H)) / (2.0 * H);
                let off = (loads.torque[0].dot(axis) - expected).abs();
                assert!(off < 2e-8, "{shape:?} {axis}: {off:e} of {expected}");
            }
        }
    }
}
