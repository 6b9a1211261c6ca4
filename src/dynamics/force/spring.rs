//! A spring with a damper beside it.

use glam::DVec3;

use super::super::{BodyId, State};
use super::{Force, Loads, Moment};

/// What an end of a [`Spring`] is fastened to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Anchor {
    /// The centre of mass of a body.
    Body(BodyId),
    /// A point of the world, m.
    Point(DVec3),
}

/// A linear spring and a linear damper, side by side between two anchors (a Kelvin–Voigt element).
///
/// With d the vector from one end to the other, ℓ its length and u = d/ℓ, they pull the ends together with
/// k (ℓ − ℓ₀) + c ℓ' along u. The spring has the potential ½ k (ℓ − ℓ₀)²; the damper has none, and its power −c ℓ'²
/// is counted.
///
/// Where ℓ = 0 there is no u. A spring of rest length 0 needs none, as its force −k d is linear; any other pushes
/// nowhere then. The damper takes the direction of the relative velocity, which is where u is about to point: so an
/// oscillation right through the anchor is damped as m x'' + c x' + k x = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// The two ends.
    pub between: [Anchor; 2],
    /// Stiffness k, N/m.
    pub stiffness: f64,
    /// Damping c, N s/m.
    pub damping: f64,
    /// The length ℓ₀ without tension, m.
    pub rest_length: f64,
}

impl Spring {
    /// Vector from the first end to the second.
    fn span(&self, state: &State) -> DVec3 {
        let [from, to] = self.between.map(|anchor| match anchor {
            Anchor::Body(id) => state.location[id.index()],
            Anchor::Point(point) => point,
        });
        to - from
    }

    /// Velocity of the second end relative to the first.
    fn relative_velocity(&self, state: &State) -> DVec3 {
        let [from, to] = self.between.map(|anchor| match anchor {
            Anchor::Body(id) => state.velocity[id.index()],
            Anchor::Point(_) => DVec3::ZERO,
        });
        to - from
    }

    /// The elastic force on the second end.
    fn elastic(&self, span: DVec3) -> DVec3 {
        if self.rest_length == 0.0 {
            // Not −k ℓ u: linear, and so smooth through ℓ = 0.
            return -self.stiffness * span;
        }
        let length = span.length();
        -self.stiffness * (length - self.rest_length) * span.normalize_or_zero()
    }
}

impl Force for Spring {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let span = self.span(moment.state);
        let mut pull = self.elastic(span);
        if self.damping != 0.0 {
            let velocity = self.relative_velocity(moment.state);
            let line = span.try_normalize().unwrap_or_else(|| velocity.normalize_or_zero());
            let rate = velocity.dot(line);
            pull -= self.damping * rate * line;
            loads.power -= self.damping * rate * rate;
        }
        for (anchor, force) in self.between.iter().zip([-pull, pull]) {
            if let Anchor::Body(id) = anchor {
                loads.force[id.index()] += force;
            }
        }
    }

    fn potential(&self, moment: &Moment) -> f64 {
        let stretch = self.span(moment.state).length() - self.rest_length;
        0.5 * self.stiffness * stretch * stretch
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    const BETWEEN: [Anchor; 2] = [Anchor::Body(BodyId::new(0)), Anchor::Body(BodyId::new(1))];

    fn pair() -> (super::super::Model, State) {
        let velocities = (DVec3::new(1.0, -1.0, 0.5), DVec3::new(-2.0, 0.25, 3.0));
        bodies(&[(DVec3::new(0.5, 1.0, -1.0), velocities.0), (DVec3::new(2.0, -1.0, 0.25), velocities.1)])
    }

    #[test]
    fn the_elastic_force_is_minus_the_gradient_of_the_potential() {
        let (model, state) = pair();
        for rest_length in [0.0, 1.0, 4.0] {
            let spring = Spring { between: BETWEEN, stiffness: 30.0, damping: 0.0, rest_length };
            assert_minus_gradient(&spring, &model, &state);
            let held = Spring { between: [Anchor::Point(DVec3::splat(0.3)), BETWEEN[0]], ..spring };
            assert_minus_gradient(&held, &model, &state);
        }
    }

    #[test]
    fn action_is_reaction_and_the_power_is_that_of_the_damper() {
        let (model, state) = pair();
        let damper = Spring { between: BETWEEN, stiffness: 0.0, damping: 0.7, rest_length: 1.0 };
        let loads = loads(&damper, &model, &state);
        assert_eq!(loads.force[0], -loads.force[1]);
        let power: f64 = (0..2).map(|i| loads.force[i].dot(state.velocity[i])).sum();
        assert!(power < -0.1 && (loads.power - power).abs() < 1e-14, "{power}");
        let span = state.location[1] - state.location[0];
        assert!(loads.force[0].cross(span).length() < 1e-14, "along the line");
    }

    #[test]
    fn at_zero_length_the_damper_brakes_and_nothing_is_undefined() {
        let (model, state) = bodies(&[(DVec3::ZERO, DVec3::new(3.0, 4.0, 0.0))]);
        for rest_length in [0.0, 1.0] {
            let between = [Anchor::Point(DVec3::ZERO), Anchor::Body(BodyId::new(0))];
            let spring = Spring { between, stiffness: 30.0, damping: 0.5, rest_length };
            let loads = loads(&spring, &model, &state);
            assert!(loads.force[0].abs_diff_eq(DVec3::new(-1.5, -2.0, 0.0), 1e-15));
            assert!((loads.power + 12.5).abs() < 1e-14);
        }
    }
}
