//! The method of Wisdom and Holman: planets follow Kepler orbits about a heavy body, and kicks add the perturbations.

mod kepler;
mod planets;

use glam::DQuat;

use self::planets::Planets;
use super::super::integrator::turn_freely;
use super::super::{BodyId, State};
use super::bodies::Field;
use super::stepper::Stepper;
use super::time::Time;

/// The method of Wisdom and Holman. A step is half a drift along the orbits, a kick, and half a drift. The half drifts of two consecutive
/// steps are joined. The method is symplectic. With a corrector, its error is of second order in the mass ratio of the planets to the
/// heavy body. Source: J. Wisdom & M. Holman, Astron. J. 102 (1991) 1528; H. Rein & D. Tamayo, Mon. Not. R. Astron. Soc. 452 (2015) 376.
///
/// The steps follow exactly a motion that differs slightly from the true motion. The symplectic corrector converts between the two
/// motions. So requested moments have an error of 17th order in the step, apart from terms with squares of the small masses. Source: J.
/// Wisdom, Astron. J. 131 (2006) 2294.
#[derive(Clone, Default)]
pub(super) struct WisdomHolman {
    step: f64,
    planets: Planets,
    /// Whether the last step still lacks its second half drift and the inverse corrector. Both are needed for the true positions.
    is_ahead: bool,
    /// The rotating bodies without torque, each with its present orientation.
    turns: Vec<(usize, DQuat)>,
    elapsed: f64,
}

/// The unit of the times in the symplectic corrector, as a fraction of a step: √(7/40).
const CORRECTOR_TIME_UNIT: f64 = 0.418_330_013_267_037_8;
/// The strengths of the kicks in the symplectic corrector, as fractions of a step. Source: Wisdom (2006), table 1.
const CORRECTOR_KICKS: [f64; 8] = [
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

    /// Applies the symplectic corrector. A `sign` of 1 converts from the true motion to the motion that steps of `dt` (s) follow; −1
    /// converts back.
    fn correct(&mut self, sign: f64, dt: f64) {
        let kick = |number: usize| sign * CORRECTOR_KICKS[number] * dt;
        let time = |number: usize| (number + 1) as f64 * CORRECTOR_TIME_UNIT * dt;
        for number in (0..CORRECTOR_KICKS.len()).rev() {
            self.shake(-time(number), -kick(number));
        }
        for number in 0..CORRECTOR_KICKS.len() {
            self.shake(time(number), kick(number));
        }
    }

    /// Applies two opposite kicks at opposite times, one part of the symplectic corrector.
    fn shake(&mut self, time: f64, kick: f64) {
        self.planets.drift(time);
        self.planets.kick(-kick);
        self.planets.drift(-2.0 * time);
        self.planets.kick(kick);
        self.planets.drift(time);
    }

    /// Completes the last step, and moves the planets to their true positions.
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
        // The tolerance allows for rounding errors: a full step is made if `longest` is a full step up to rounding.
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
