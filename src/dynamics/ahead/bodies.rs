//! Which bodies a method advances, and how what acts on them becomes slopes.

use glam::{DQuat, DVec3};

use super::super::integrator::{orientation_rate, turn_freely};
use super::super::model::is_isotropic;
use super::super::{Loads, Model, State};

/// The bodies that change with time, by how they do.
#[derive(Clone, Default)]
pub(super) struct Bodies {
    /// Those that forces move.
    pub(super) moving: Vec<usize>,
    /// Those whose orientation and angular momentum have to be integrated.
    pub(super) turning: Vec<usize>,
    /// Those that nothing can turn and that turn evenly, each with its orientation at the beginning.
    spinning: Vec<(usize, DQuat)>,
    /// Whether something without a potential acts, whose work is integrated along.
    pub(super) works: bool,
    /// Whether a force depends on velocities.
    pub(super) feels_motion: bool,
}

impl Bodies {
    /// Sorts the bodies of a model. What is not there, fixed or guided is among none of them.
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

    /// Turns the bodies that turn evenly to where they are so many seconds after the beginning.
    pub(super) fn spin(&self, model: &Model, elapsed: f64, state: &mut State) {
        for &(i, start) in &self.spinning {
            let momentum = state.angular_momentum[i];
            state.orientation[i] = turn_freely(start, momentum, model.inverse_inertia()[i], elapsed);
        }
    }
}

/// What a method sees of the world, with room to work in.
pub(super) struct Field<'a> {
    /// Masses and forces.
    pub(super) model: &'a Model,
    /// Which bodies are advanced.
    pub(super) bodies: &'a Bodies,
    /// How large a motion is.
    pub(super) scales: &'a Scales,
    /// Where the bodies are at present.
    pub(super) stage: &'a mut State,
    /// What acts on them there.
    pub(super) loads: &'a mut Loads,
}

impl Field<'_> {
    /// Finds what acts on the bodies where they are, at time `t`, s.
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

/// What is smaller than this part of the whole is measured by the whole.
const SMALL: f64 = 0.1;

/// How large the motion is, so that what is small against it can be told.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scales {
    /// A tenth of how far the bodies are from their mean place, as a root mean square; of one alone, how large it is, m.
    pub(super) length: f64,
    /// A tenth of the speed of the fastest, or of what it will be after such a way, m/s.
    pub(super) speed: f64,
}

impl Scales {
    /// Those of the bodies that are there, under these loads.
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
