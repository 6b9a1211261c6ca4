//! The bodies that an adaptive method advances, and their rates of change under the loads.

use glam::{DQuat, DVec3};

use super::super::integrator::{orientation_rate, turn_freely};
use super::super::model::is_isotropic;
use super::super::{Loads, Model, State};

/// The bodies that change with time, sorted by the kind of their motion.
#[derive(Clone, Default)]
pub(super) struct Bodies {
    /// The indices of the bodies that forces move.
    pub(super) moving: Vec<usize>,
    /// The indices of the bodies whose orientation and angular momentum must be integrated.
    pub(super) turning: Vec<usize>,
    /// The bodies that rotate uniformly without torque, each with its orientation at the start.
    spinning: Vec<(usize, DQuat)>,
    /// Whether forces without a potential or bodies with a given motion may do work. This work must then be integrated.
    pub(super) works: bool,
    /// Whether a force depends on velocities, or does work without a potential.
    pub(super) feels_motion: bool,
}

impl Bodies {
    /// Fills the lists with the bodies of a model. Absent bodies, fixed bodies and bodies with a given motion are in no list.
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

    /// Sets the orientations of uniformly rotating bodies to those `elapsed` seconds after the start.
    pub(super) fn spin(&self, model: &Model, elapsed: f64, state: &mut State) {
        for &(i, start) in &self.spinning {
            let momentum = state.angular_momentum[i];
            state.orientation[i] = turn_freely(start, momentum, model.inverse_inertia()[i], elapsed);
        }
    }
}

/// The data that a method needs to evaluate the loads: the bodies and forces, and working memory.
pub(super) struct Field<'a> {
    /// The masses of the bodies and the forces on them.
    pub(super) model: &'a Model,
    /// The bodies that the method advances.
    pub(super) bodies: &'a Bodies,
    /// The typical length and speed of the motion.
    pub(super) scales: &'a Scales,
    /// The state of the bodies at the current stage of the method.
    pub(super) stage: &'a mut State,
    /// The loads on the bodies at the current stage.
    pub(super) loads: &'a mut Loads,
}

impl Field<'_> {
    /// Evaluates the loads on the bodies at the current stage, at time `t`, s. Bodies with a given motion are placed first.
    pub(super) fn evaluate(&mut self, t: f64) {
        self.model.place(t, self.stage);
        self.model.evaluate(t, self.stage, self.loads);
    }

    /// Returns the acceleration of a body at the current stage, m/s².
    pub(super) fn acceleration(&self, i: usize) -> DVec3 {
        self.loads.force[i] * self.model.inverse_mass()[i]
    }

    /// Returns the time derivative of a body's orientation at the current stage, 1/s.
    pub(super) fn turning(&self, i: usize) -> DQuat {
        orientation_rate(self.stage.orientation[i], self.model.angular_velocity(i, self.stage))
    }
}

/// The error of a position or speed is relative to its value, but at least to this fraction of the typical value.
const SMALL: f64 = 0.1;

/// Lower limits of the values to which the errors of positions and speeds are relative. The error of a value below its limit is divided by
/// the limit instead of the value. The limits follow from the size of the whole motion.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scales {
    /// A tenth of the root-mean-square distance of the bodies from their mean position, or of the largest radius of gyration of a body if
    /// that is longer, m.
    pub(super) length: f64,
    /// A tenth of the largest speed, or of √(a L) if that is larger, m/s. Here, a is the largest acceleration and L is ten times the
    /// length above.
    pub(super) speed: f64,
}

impl Scales {
    /// Computes the scales from the present bodies and the loads on them.
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
