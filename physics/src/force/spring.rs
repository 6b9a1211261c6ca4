//! A spring and a damper in parallel.

use glam::DVec3;

use super::super::{Anchor, BodyId, WorkAccount};
use super::{Force, Loads, Moment, share};

/// One end of a spring at one moment, in world axes.
struct End {
    /// The position of the end, m.
    location: DVec3,
    /// The vector from the body's centre of mass to the end, m; zero for an end at a fixed point.
    arm: DVec3,
}

impl End {
    fn of(anchor: Anchor, moment: &Moment) -> End {
        match anchor {
            Anchor::Body { id, at } => {
                let (i, Moment { state, model, .. }) = (id.index(), moment);
                // The state holds the orientation of the principal axes of inertia, so `at` is converted from body axes to principal axes.
                let from_body = || state.orientation[i] * (model.principal_axes(i).conjugate() * at);
                let arm = if at == DVec3::ZERO { at } else { from_body() };
                End { location: state.location[i] + arm, arm }
            }
            Anchor::Point(point) => End { location: point, arm: DVec3::ZERO },
        }
    }

    /// Returns the velocity of the end, world axes, m/s.
    fn velocity(&self, anchor: Anchor, moment: &Moment) -> DVec3 {
        let Some(i) = anchor.body().map(BodyId::index) else { return DVec3::ZERO };
        let velocity = moment.state.velocity[i];
        if self.arm == DVec3::ZERO {
            return velocity;
        }
        velocity + moment.model.angular_velocity(i, moment.state).cross(self.arm)
    }
}

/// A linear spring and a linear damper, in parallel between two anchors (a Kelvin–Voigt element).
///
/// With d the vector from one end to the other, ℓ its length and u = d/ℓ, spring and damper pull the ends together with k (ℓ − ℓ₀) + c ℓ'
/// along u. A force F at an anchor off the centre of mass rotates its body: with the arm r from the centre, the torque is r × F, and the
/// anchor's velocity is v + ω × r. The spring has the potential ½ k (ℓ − ℓ₀)². The damper has none, so its work, with the power −c ℓ'², is
/// added to the accounts.
///
/// At ℓ = 0, u is undefined. A spring of rest length 0 needs no u, because its force −k d is linear; any other spring exerts no force at ℓ
/// = 0. The damper then acts along the relative velocity, which is the next direction of u. So an oscillation through the anchor is damped
/// as m x'' + c x' + k x = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// The two ends of the spring.
    pub between: [Anchor; 2],
    /// The stiffness k of the spring, N/m.
    pub stiffness: f64,
    /// The damping constant c of the damper, N s/m.
    pub damping: f64,
    /// The rest length ℓ₀ of the spring, m.
    pub rest_length: f64,
}

impl Spring {
    /// Returns whether the bodies at both ends are present. A spring with an absent end exerts no force and holds no energy.
    fn is_whole(&self, moment: &Moment) -> bool {
        self.between.iter().filter_map(|end| end.body()).all(|id| moment.model.is_present(id.index()))
    }

    fn ends(&self, moment: &Moment) -> [End; 2] {
        self.between.map(|anchor| End::of(anchor, moment))
    }

    /// Returns the velocity of the second end relative to the first, m/s.
    fn relative_velocity(&self, [from, to]: &[End; 2], moment: &Moment) -> DVec3 {
        to.velocity(self.between[1], moment) - from.velocity(self.between[0], moment)
    }

    /// Returns the elastic force on the second end, N. `span` is the vector from the first end to the second, m.
    fn elastic(&self, span: DVec3) -> DVec3 {
        if self.rest_length == 0.0 {
            // This form is linear, and so smooth at ℓ = 0, where u in −k ℓ u is undefined.
            return -self.stiffness * span;
        }
        let length = span.length();
        -self.stiffness * (length - self.rest_length) * span.normalize_or_zero()
    }
}

impl Force for Spring {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        if !self.is_whole(moment) {
            return;
        }
        let ends = self.ends(moment);
        let span = ends[1].location - ends[0].location;
        let mut pull = self.elastic(span);
        if self.damping != 0.0 {
            let velocity = self.relative_velocity(&ends, moment);
            let line = span.try_normalize().unwrap_or_else(|| velocity.normalize_or_zero());
            let rate = velocity.dot(line);
            pull -= self.damping * rate * line;
            loads.power.work -= self.damping * rate * rate;
        }
        for ((anchor, end), force) in self.between.iter().zip(ends).zip([-pull, pull]) {
            if let Anchor::Body { id, .. } = anchor {
                loads.force[id.index()] += force;
                if end.arm != DVec3::ZERO {
                    loads.torque[id.index()] += end.arm.cross(force);
                }
            }
        }
    }

    fn work_account(&self) -> Option<WorkAccount> {
        (self.damping != 0.0).then_some(WorkAccount::Work)
    }

    fn apply_without_potential(&self, moment: &Moment, loads: &mut Loads) {
        Spring { stiffness: 0.0, ..*self }.apply(moment, loads);
    }

    fn depends_on_motion(&self) -> bool {
        self.damping != 0.0
    }

    fn turns_bodies(&self) -> bool {
        self.between.iter().any(|end| !end.is_centre())
    }

    fn potential(&self, moment: &Moment) -> f64 {
        if !self.is_whole(moment) {
            return 0.0;
        }
        let [from, to] = self.ends(moment);
        let stretch = (to.location - from.location).length() - self.rest_length;
        0.5 * self.stiffness * stretch * stretch
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        let energy = self.potential(moment);
        match self.between.map(|end| end.body().map(BodyId::index)) {
            [Some(one), Some(other)] => share(energy, [one, other], moment, shares),
            [Some(one), None] | [None, Some(one)] => share(energy, [one], moment, shares),
            [None, None] => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::super::super::{Compound, Model, Part, RigidBody, Shape, State};
    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    const BETWEEN: [Anchor; 2] = [Anchor::centre(BodyId::new(0)), Anchor::centre(BodyId::new(1))];

    fn pair() -> (Model, State) {
        let velocities = (DVec3::new(1.0, -1.0, 0.5), DVec3::new(-2.0, 0.25, 3.0));
        bodies(&[(DVec3::new(0.5, 1.0, -1.0), velocities.0), (DVec3::new(2.0, -1.0, 0.25), velocities.1)])
    }

    /// Returns a world of two bodies that move and rotate, and a spring between points off their centres of mass. The first body is a
    /// compound whose principal axes of inertia differ from its body axes.
    fn hinged(stiffness: f64, damping: f64) -> (Model, State, Spring) {
        let ball = |radius: f64, x: f64, y: f64| Part {
            shape: Shape::Sphere { radius },
            location: DVec3::new(x, y, 0.1 * x),
            orientation: DQuat::IDENTITY,
        };
        let crooked = Shape::Compound(Compound::new(vec![
            ball(0.3, 0.0, 0.0),
            ball(0.2, 1.0, 0.7),
            ball(0.1, -0.4, 1.0),
        ]));
        let crooked = RigidBody::new(&crooked, 2.0)
            .with_orientation(DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7)))
            .with_velocity(DVec3::new(1.0, -1.0, 0.5))
            .with_angular_velocity(DVec3::new(-0.3, 2.0, 1.2));
        assert!(crooked.principal_axes.angle_between(DQuat::IDENTITY) > 0.1);
        let block = RigidBody::new(&Shape::Box { size: DVec3::new(0.3, 0.5, 0.9) }, 1.0)
            .with_location(DVec3::new(2.0, 0.3, -1.0))
            .with_orientation(DQuat::from_scaled_axis(DVec3::new(0.8, 0.2, -0.5)))
            .with_velocity(DVec3::new(-0.2, 0.4, 0.9))
            .with_angular_velocity(DVec3::new(0.5, 1.0, -2.0));
        let (mut model, mut state) = (Model::default(), State::default());
        model.push(&crooked, &mut state);
        model.push(&block, &mut state);
        let end = |i, at| Anchor::Body { id: BodyId::new(i), at };
        let between = [end(0, DVec3::new(0.4, -0.2, 0.6)), end(1, DVec3::new(-0.1, 0.3, 0.5))];
        (model, state, Spring { between, stiffness, damping, rest_length: 0.8 })
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

    /// The torque must be τ = −∂U/∂φ for rotations φ about each world axis, with the same tolerance as the forces. The position of the
    /// spring's end is also compared with the pose of its body, because an error in this position would change the force and the potential
    /// alike.
    #[test]
    fn the_torque_is_minus_the_gradient_of_the_potential_over_turns() {
        const H: f64 = 1e-5;
        let (model, state, spring) = hinged(30.0, 0.0);
        assert_minus_gradient(&spring, &model, &state);
        let given = loads(&spring, &model, &state);
        for i in 0..2 {
            for (axis, given) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().zip(given.torque[i].to_array()) {
                let potential = |angle: f64| {
                    let mut state = state.clone();
                    state.orientation[i] = DQuat::from_scaled_axis(angle * axis) * state.orientation[i];
                    spring.potential(&Moment { time: 0.0, state: &state, model: &model })
                };
                let minus_gradient = (potential(-H) - potential(H)) / (2.0 * H);
                assert!((given - minus_gradient).abs() < 2e-8, "{i} {axis}: {given} {minus_gradient}");
            }
        }
        let turn = state.orientation[0] * model.principal_axes(0).conjugate();
        let moment = Moment { time: 0.0, state: &state, model: &model };
        let [from, _] = spring.ends(&moment);
        assert!(from.location.abs_diff_eq(turn * DVec3::new(0.4, -0.2, 0.6), 1e-15), "{}", from.location);
        let placed = spring.between[0].place(|_| (state.location[0], turn));
        assert!(placed.abs_diff_eq(from.location, 1e-15), "{placed}");
    }

    /// The forces on the two bodies must be opposite, and their torques about the origin must add up to zero.
    #[test]
    fn off_the_centre_action_is_reaction_and_the_power_is_that_of_the_damper() {
        let (model, state, spring) = hinged(0.0, 0.7);
        let loads = loads(&spring, &model, &state);
        assert_eq!(loads.force[0], -loads.force[1]);
        let angular: DVec3 = (0..2).map(|i| loads.torque[i] + state.location[i].cross(loads.force[i])).sum();
        assert!(angular.length() < 1e-14, "{angular}");
        let of = |i: usize| {
            loads.force[i].dot(state.velocity[i]) + loads.torque[i].dot(model.angular_velocity(i, &state))
        };
        let power = of(0) + of(1);
        assert!(power < -0.1 && (loads.power.work - power).abs() < 1e-14, "{power} {}", loads.power.work);
    }

    #[test]
    fn action_is_reaction_and_the_power_is_that_of_the_damper() {
        let (model, state) = pair();
        let damper = Spring { between: BETWEEN, stiffness: 0.0, damping: 0.7, rest_length: 1.0 };
        let loads = loads(&damper, &model, &state);
        assert_eq!(loads.force[0], -loads.force[1]);
        let power: f64 = (0..2).map(|i| loads.force[i].dot(state.velocity[i])).sum();
        assert!(power < -0.1 && (loads.power.work - power).abs() < 1e-14, "{power}");
        let span = state.location[1] - state.location[0];
        assert!(loads.force[0].cross(span).length() < 1e-14, "along the line");
    }

    #[test]
    fn at_zero_length_the_damper_brakes_and_nothing_is_undefined() {
        let (model, state) = bodies(&[(DVec3::ZERO, DVec3::new(3.0, 4.0, 0.0))]);
        for rest_length in [0.0, 1.0] {
            let between = [Anchor::Point(DVec3::ZERO), Anchor::centre(BodyId::new(0))];
            let spring = Spring { between, stiffness: 30.0, damping: 0.5, rest_length };
            let loads = loads(&spring, &model, &state);
            assert!(loads.force[0].abs_diff_eq(DVec3::new(-1.5, -2.0, 0.0), 1e-15));
            assert!((loads.power.work + 12.5).abs() < 1e-14);
        }
    }
}
