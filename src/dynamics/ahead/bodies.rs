//! The bodies that a method advances, and their slopes under the loads.

use glam::{DQuat, DVec3};

use super::super::integrator::{orientation_rate, turn_freely};
use super::super::model::is_isotropic;
use super::super::{Loads, Model, State};

/// The bodies that change with time, by kind.
#[derive(Clone, Default)]
pub(super) struct Bodies {
    /// Bodies moved by forces.
    pub(super) moving: Vec<usize>,
    /// Bodies whose orientation and angular momentum must be integrated.
    pub(super) turning: Vec<usize>,
    /// Bodies without torque and with uniform rotation, each with its orientation at the start.
    spinning: Vec<(usize, DQuat)>,
    /// Whether anything without a potential acts, so that its work must be integrated.
    pub(super) works: bool,
    /// Whether a force depends on velocities.
    pub(super) feels_motion: bool,
}

impl Bodies {
    /// Sorts the bodies of a model into these lists. Absent, fixed and guided bodies are in none of them.
    pub(super) fn sort(&mut self, model: &Model, state: &State) {
        let can_turn = model.turns_bodies();
        self.moving.clear();
        self.turning.clear();
        self.spinning.clear();
        for i in (0..model.len()).filter(|&i| model.inverse_mass()[i] != 0.0) {
            self.moving.push(i);
            let inverse = model.inverse_inertia()[i];
            if inverse == DVec3::ZERO {
                continue;
            }
            let turns = state.angular_momentum[i] != DVec3::ZERO;
            if can_turn || turns && !is_isotropic(inverse) {
                self.turning.push(i);
            } else if turns {
                self.spinning.push((i, state.orientation[i]));
            }
        }
        self.feels_motion = model.depends_on_motion();
        self.works = self.feels_motion || model.has_guided();
    }

    /// Rotates the uniformly rotating bodies to their orientation `elapsed` seconds after the start.
    pub(super) fn spin(&self, model: &Model, elapsed: f64, state: &mut State) {
        for &(i, start) in &self.spinning {
            let momentum = state.angular_momentum[i];
            state.orientation[i] = turn_freely(start, momentum, model.inverse_inertia()[i], elapsed);
        }
    }
}

/// The method's view of the world, with working memory.
pub(super) struct Field<'a> {
    /// Masses and forces.
    pub(super) model: &'a Model,
    /// The bodies that are advanced.
    pub(super) bodies: &'a Bodies,
    /// The scales of the motion.
    pub(super) scales: &'a Scales,
    /// The current stage of the bodies.
    pub(super) stage: &'a mut State,
    /// The loads at that stage.
    pub(super) loads: &'a mut Loads,
}

impl Field<'_> {
    /// Evaluates the loads on the bodies at the stage, at time `t`, s.
    pub(super) fn evaluate(&mut self, t: f64) {
        self.model.place(t, self.stage);
        self.model.evaluate(t, self.stage, self.loads);
    }

    /// The acceleration of a body, m/s².
    pub(super) fn acceleration(&self, i: usize) -> DVec3 {
        self.loads.force[i] * self.model.inverse_mass()[i]
    }

    /// The rate of change of the orientation of a body.
    pub(super) fn turning(&self, i: usize) -> DQuat {
        orientation_rate(self.stage.orientation[i], self.model.angular_velocity(i, self.stage))
    }
}

/// Values below this fraction of the whole motion are measured by the whole.
const SMALL: f64 = 0.1;

/// The scales of the motion, to recognise values that are small against it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scales {
    /// A tenth of the root-mean-square distance of the bodies from their mean position, or of the size of the largest body, m.
    pub(super) length: f64,
    /// A tenth of the largest speed, or of the speed that the forces give over the length above, m/s.
    pub(super) speed: f64,
}

impl Scales {
    /// The scales of the present bodies under these loads.
    pub(super) fn of(bodies: &Bodies, model: &Model, state: &State, loads: &Loads) -> Scales {
        let there = || (0..model.len()).filter(|&i| model.is_present(i));
        #[allow(clippy::cast_precision_loss, reason = "no scene has 2^53 bodies")]
        let count = (there().count() as f64).max(1.0);
        let mean = there().map(|i| state.location[i]).sum::<DVec3>() / count;
        let spread = there().map(|i| state.location[i].distance_squared(mean)).sum::<f64>() / count;
        let own = bodies.moving.iter().map(|&i| model.inertia()[i].max_element() * model.inverse_mass()[i]);
        let length = spread.sqrt().max(own.fold(0.0, f64::max).sqrt());
        let mut square: f64 = 0.0;
        for &i in &bodies.moving {
            let falling = loads.force[i].length() * model.inverse_mass()[i] * length;
            square = square.max(state.velocity[i].length_squared()).max(falling);
        }
        Scales { length: SMALL * length, speed: SMALL * square.sqrt() }
    }
}
