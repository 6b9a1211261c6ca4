//! The method of Wisdom and Holman: planets follow their orbits about a heavy body, and kicks add the perturbations.

mod kepler;
mod planets;

use glam::DQuat;

use self::planets::Planets;
use super::super::integrator::turn_freely;
use super::super::{BodyId, State};
use super::bodies::Field;
use super::stepper::Stepper;
use super::time::Time;

/// A step is half a drift along the orbits, a kick, and half a drift; the half drifts of two steps are joined. The method is symplectic,
/// and of second order in the mass ratio of the planets to the heavy body. Source: J. Wisdom & M. Holman, Astron. J. 102 (1991) 1528; H.
/// Rein & D. Tamayo, Mon. Not. R. Astron. Soc. 452 (2015) 376.
///
/// The steps follow exactly a motion that differs a little from the true one. The symplectic corrector converts between the two, so
/// requested moments have an error of 17th order in the step, apart from terms with squares of the small masses. Source: J. Wisdom,
/// Astron. J. 131 (2006) 2294.
#[derive(Clone, Default)]
pub(super) struct WisdomHolman {
    step: f64,
    planets: Planets,
    /// Whether half a drift and the inverse corrector are still needed to reach the true positions.
    is_ahead: bool,
    /// The freely rotating bodies, each with its orientation.
    turns: Vec<(usize, DQuat)>,
    elapsed: f64,
}

/// The times of the corrector, in steps, are multiples of √(7/40).
const TIME: f64 = 0.418_330_013_267_037_8;
/// The strengths of its kicks. Source: Wisdom (2006), table 1.
const KICKS: [f64; 8] = [
    0.093_056_103_771_425_95,
    -0.065_192_863_576_377_9,
    0.032_422_198_864_713_58,
    -0.012_071_760_822_342_29,
    0.003_313_257_706_938_065_4,
    -0.000_635_999_830_758_176_6,
    0.000_076_436_355_227_935_74,
    -0.000_004_334_741_547_337_358,
];

impl WisdomHolman {
    pub(super) fn new(step: f64) -> WisdomHolman {
        WisdomHolman { step, ..WisdomHolman::default() }
    }

    /// Converts from the true motion to the one that steps of `dt` follow (1), or back (−1).
    fn correct(&mut self, sign: f64, dt: f64) {
        let kick = |number: usize| sign * KICKS[number] * dt;
        let time = |number: usize| (number + 1) as f64 * TIME * dt;
        for number in (0..KICKS.len()).rev() {
            self.shake(-time(number), -kick(number));
        }
        for number in 0..KICKS.len() {
            self.shake(time(number), kick(number));
        }
    }

    /// A kick, and its opposite at the opposite time.
    fn shake(&mut self, time: f64, kick: f64) {
        self.planets.drift(time);
        self.planets.kick(-kick);
        self.planets.drift(-2.0 * time);
        self.planets.kick(kick);
        self.planets.drift(time);
    }

    /// Moves the planets to their true positions.
    fn arrive(&mut self) {
        if std::mem::take(&mut self.is_ahead) {
            self.planets.drift(0.5 * self.step);
            self.correct(-1.0, self.step);
        }
    }

    fn turn(&mut self, field: &Field<'_>, dt: f64) {
        for (i, turn) in &mut self.turns {
            let (momentum, inverse) = (field.stage.angular_momentum[*i], field.model.inverse_inertia()[*i]);
            *turn = turn_freely(*turn, momentum, inverse, dt);
        }
        self.elapsed += dt;
    }
}

impl Stepper for WisdomHolman {
    fn begin(&mut self, field: &mut Field<'_>, _: Time) {
        self.planets.read(field);
        self.is_ahead = false;
        self.turns.clear();
        self.turns.extend(field.bodies.turning.iter().map(|&i| (i, field.stage.orientation[i])));
        self.elapsed = 0.0;
    }

    fn proposal(&self) -> f64 {
        self.step
    }

    fn step(&mut self, field: &mut Field<'_>, now: Time, longest: f64) -> Result<f64, BodyId> {
        // Up to rounding.
        if longest < self.step * (1.0 - 1e-9) {
            self.step_by(field, now, longest);
            return Ok(longest);
        }
        let dt = self.step;
        if self.is_ahead {
            self.planets.drift(dt);
        } else {
            self.correct(1.0, dt);
            self.planets.drift(0.5 * dt);
            self.is_ahead = true;
        }
        self.planets.kick(dt);
        self.turn(field, dt);
        Ok(dt)
    }

    fn step_by(&mut self, field: &mut Field<'_>, _: Time, duration: f64) {
        self.arrive();
        self.correct(1.0, duration);
        self.planets.drift(0.5 * duration);
        self.planets.kick(duration);
        self.planets.drift(0.5 * duration);
        self.correct(-1.0, duration);
        self.turn(field, duration);
    }

    fn write(&self, field: &Field<'_>, state: &mut State) {
        let mut here = self.clone();
        here.arrive();
        here.planets.each(|i, place, velocity| {
            (state.location[i], state.velocity[i]) = (place, velocity);
        });
        self.turns.iter().for_each(|&(i, turn)| state.orientation[i] = turn);
        field.bodies.spin(field.model, self.elapsed, state);
    }
}
