//! Runge–Kutta steps of bodies on which no torque acts. Their angular momenta are constant, so only positions and velocities need the full
//! computation.

use std::ops::Range;

use glam::{DQuat, DVec3};

use super::super::{Accounts, Loads, Model, State, System};
use super::rotation;

/// The number of independent bodies that are advanced together. Their data stay in the first-level cache.
const BLOCK_SIZE: usize = 128;

/// A stage of a Runge–Kutta method in which each stage depends only on the previous stage.
#[derive(Clone, Copy)]
pub(super) struct Stage {
    /// The time of the stage, s.
    pub(super) time: f64,
    /// The weight of the stage's slope in the result of the step.
    pub(super) weight: f64,
    /// The duration from the start of the step to the next stage, s. The next stage is reached from the start of the step along this
    /// stage's slope.
    pub(super) next: f64,
}

/// Advances bodies on which no torque acts. Holds the working memory for a step. The results have the same bits as those of
/// [`Slope`](super::runge_kutta::Slope) and [`follow`](super::runge_kutta::follow).
#[derive(Clone, Default)]
pub(super) struct TorqueFree {
    stage: State,
    loads: Loads,
    /// The weighted sums of the slopes of all stages so far, for the bodies of a block.
    location: Vec<DVec3>,
    velocity: Vec<DVec3>,
    power: Accounts,
}

impl TorqueFree {
    /// Returns whether this type can advance a system: no force can rotate bodies, no motion is given, and no constraint is active.
    pub(super) fn suits(system: &System<'_>) -> bool {
        let model = system.model();
        !model.turns_bodies() && !model.has_guided() && !system.is_constrained()
    }

    /// Advances `state` by one step of `dt` seconds with the given stages.
    pub(super) fn advance(&mut self, system: &System<'_>, stages: &[Stage], dt: f64, state: &mut State) {
        let (model, count) = (system.model(), state.len());
        if self.stage.len() != count {
            self.stage.clone_from(state);
        }
        self.turn(model, stages, dt, state);
        let by_blocks = model.is_local() && model.sum_part(0..0, 0.0, state, &mut self.loads);
        let size = if by_blocks { BLOCK_SIZE } else { count.max(1) };
        for start in (0..count).step_by(size) {
            let block = start..(start + size).min(count);
            self.location.clear();
            self.location.resize(block.len(), DVec3::ZERO);
            self.velocity.clone_from(&self.location);
            self.power = Accounts::default();
            for (number, stage) in stages.iter().enumerate() {
                let here = if number == 0 { &*state } else { &self.stage };
                if by_blocks {
                    model.sum_part(block.clone(), stage.time, here, &mut self.loads);
                } else {
                    model.evaluate(stage.time, here, &mut self.loads);
                    self.power.add(stage.weight, self.loads.power);
                }
                self.go_on(model, block.clone(), stage, number == 0, state);
            }
            let add = |values: &mut [DVec3], sums: &[DVec3]| {
                values.iter_mut().zip(sums).for_each(|(value, sum)| *value += dt * *sum);
            };
            add(&mut state.location[block.clone()], &self.location);
            add(&mut state.velocity[block], &self.velocity);
            state.accounts.add(dt, self.power);
        }
    }

    /// Adds the slopes of a stage to the weighted sums, and moves the bodies of a block to the next stage.
    #[inline]
    fn go_on(&mut self, model: &Model, block: Range<usize>, stage: &Stage, is_first: bool, state: &State) {
        let Stage { weight, next, .. } = *stage;
        let bodies = || block.clone();
        if is_first {
            self.stage.velocity[bodies()].copy_from_slice(&state.velocity[bodies()]);
        }
        let begin = state.location[bodies()].iter().zip(&state.velocity[bodies()]);
        let loads = self.loads.force[bodies()].iter().zip(&model.inverse_mass()[bodies()]);
        let here = self.stage.location[bodies()].iter_mut().zip(&mut self.stage.velocity[bodies()]);
        let sums = self.location.iter_mut().zip(&mut self.velocity);
        for (((begin, load), here), sum) in begin.zip(loads).zip(here).zip(sums) {
            let (velocity, acceleration) = (*here.1, *load.0 * *load.1);
            *sum.0 += weight * velocity;
            *sum.1 += weight * acceleration;
            // `follow` sums up slopes from zero, which turns a negative zero into zero. The added zero has the same effect.
            *here.0 = *begin.0 + next * (DVec3::ZERO + velocity);
            *here.1 = *begin.1 + next * (DVec3::ZERO + acceleration);
        }
    }

    /// Advances the orientation of each rotating body. The angular momenta are constant.
    fn turn(&mut self, model: &Model, stages: &[Stage], dt: f64, state: &mut State) {
        let nothing = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        let advanced = |from: DQuat, rate: DQuat, time: f64| {
            if rate.length_squared() == 0.0 { from } else { (from + rate * time).normalize() }
        };
        let here = &mut self.stage;
        for i in 0..state.len() {
            if state.angular_momentum[i] == DVec3::ZERO {
                continue;
            }
            here.angular_momentum[i] = state.angular_momentum[i];
            here.orientation[i] = state.orientation[i];
            let mut sum = nothing;
            for stage in stages {
                let rate = rotation::rate(here.orientation[i], model.angular_velocity(i, here));
                sum += rate * stage.weight;
                here.orientation[i] = advanced(state.orientation[i], nothing + rate * 1.0, stage.next);
            }
            state.orientation[i] = advanced(state.orientation[i], sum, dt);
            // `follow` adds a torque of zero, which turns a negative zero into zero.
            state.angular_momentum[i] += DVec3::ZERO;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{BodyId, Gravitation, RigidBody, Shape, UniformGravity, World};
    use super::super::Method;
    use super::*;

    /// A force without effect. The integrator must assume that it can rotate bodies.
    struct Idle;

    impl super::super::super::Force for Idle {
        fn apply(&self, _: &super::super::super::Moment, _: &mut Loads) {}

        fn potential(&self, _: &super::super::super::Moment) -> f64 {
            0.0
        }
    }

    fn world(attract: bool, idle: bool) -> World {
        let mut world = World::new();
        world.set_integrator(Method::by_name("rk4").unwrap());
        for i in 0..300 {
            let part = f64::from(i);
            let mut body = RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0 + part)
                .with_location(DVec3::new(part, -0.5 * part, 0.01 * part * part))
                .with_velocity(DVec3::new(1.0 / (1.0 + part), -0.3, 0.0))
                .with_fixed(i % 7 == 0);
            if i % 3 == 0 {
                let inertia = DVec3::new(1.0, 2.0, 2.5);
                body = body.with_inertia(inertia).with_angular_velocity(DVec3::new(0.3, part, -0.2));
            }
            if i % 5 == 0 {
                body = body.with_force(DVec3::new(0.1, part, 0.0));
            }
            world.add(body);
        }
        world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -9.81, 0.3) });
        if attract {
            let bodies = (0..20).map(BodyId::new).collect();
            world.add_force(Gravitation {
                bodies,
                against: None,
                constant: 0.7,
                softening: 0.1,
                opening_angle: None,
            });
        }
        if idle {
            world.add_force(Idle);
        }
        world
    }

    /// Steps of this type must have the same bits as those of the general method, for independent bodies and for bodies that attract each
    /// other.
    #[test]
    fn bodies_that_nothing_turns_have_the_same_bits_as_all_others() {
        for attract in [false, true] {
            let [short, long] = [false, true].map(|idle| {
                let mut world = world(attract, idle);
                (0..20).for_each(|_| world.step(0.013));
                world.state().clone()
            });
            assert_eq!(short, long);
            let bits = |state: &State| {
                let places = state.location.iter().chain(&state.velocity).flat_map(DVec3::to_array);
                places.map(f64::to_bits).collect::<Vec<_>>()
            };
            assert_eq!(bits(&short), bits(&long));
        }
    }
}
