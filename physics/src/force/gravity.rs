//! Uniform gravity, as near the surface of a planet.

use std::ops::Range;

use glam::DVec3;

use super::{Force, Loads, Moment, share};

/// Uniform gravity: a force F = m g on every body, with the potential −m g·x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformGravity {
    /// The acceleration g, world axes, m/s².
    pub acceleration: DVec3,
}

impl Force for UniformGravity {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        self.apply_to(0..loads.force.len(), moment, loads);
    }

    fn apply_to(&self, bodies: Range<usize>, moment: &Moment, loads: &mut Loads) -> bool {
        for (force, &mass) in loads.force[bodies.clone()].iter_mut().zip(&moment.model.mass()[bodies]) {
            *force += mass * self.acceleration;
        }
        true
    }

    fn is_local(&self) -> bool {
        true
    }

    fn depends_on_motion(&self) -> bool {
        false
    }

    fn turns_bodies(&self) -> bool {
        false
    }

    fn potential(&self, moment: &Moment) -> f64 {
        let model = moment.model;
        let mut potential = 0.0;
        for (i, location) in moment.state.location.iter().enumerate() {
            if model.movable()[i] {
                potential -= model.mass()[i] * self.acceleration.dot(*location);
            }
        }
        potential
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        for (i, location) in moment.state.location.iter().enumerate() {
            share(-moment.model.mass()[i] * self.acceleration.dot(*location), [i], moment, shares);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    #[test]
    fn the_weight_is_minus_the_gradient_of_the_potential() {
        let (model, state) = bodies(&[(DVec3::X, DVec3::Y), (DVec3::new(3.0, -2.0, 5.0), DVec3::ZERO)]);
        let gravity = UniformGravity { acceleration: DVec3::new(0.5, -9.81, 0.25) };
        assert_minus_gradient(&gravity, &model, &state);
        assert_eq!(loads(&gravity, &model, &state).force[1], DVec3::new(1.0, -19.62, 0.5));
        assert_eq!(loads(&gravity, &model, &state).power.work, 0.0);
    }
}
