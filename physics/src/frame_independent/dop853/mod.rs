//! The eighth-order method DOP853 of Dormand and Prince. It chooses its steps by error estimates of orders 5 and 3.

mod coefficients;
mod flat;

use super::super::BodyId;
use super::super::State;
use super::bodies::{Field, FreeRotation};
use super::stepper::{Stepper, is_too_short};
use super::time::Time;
use coefficients::{
    ERROR_3, ERROR_5, RESULT_WEIGHTS, STAGE_2, STAGE_3, STAGE_4, STAGE_5, STAGE_6, STAGE_7, STAGE_8, STAGE_9,
    STAGE_10, STAGE_11, STAGE_12, STAGE_TIMES, Weight,
};

/// A step has this fraction of the length that the error allows, so that few steps are rejected.
const SAFETY_FACTOR: f64 = 0.9;
/// The smallest ratio of the length of a step to that of the previous step.
const MIN_STEP_RATIO: f64 = 1.0 / 3.0;
/// The largest ratio of the length of a step to that of the previous step.
const MAX_STEP_RATIO: f64 = 6.0;

/// The method DOP853, which has twelve stages per step. Source: E. Hairer, S. P. Nørsett & G. Wanner, *Solving Ordinary Differential
/// Equations I*, 2nd edition (1993), II.10; the choice of steps: II.4.
///
/// The allowed error of a step is `tolerance` times each body's distance from the origin, speed and so on. If these values are small, the
/// error is relative to the size of the whole motion ([`Scales`](super::bodies::Scales)). The largest error of all bodies counts, so that
/// it is not averaged away by many small errors.
#[derive(Default)]
pub(super) struct Dop853 {
    tolerance: f64,
    /// The state of the bodies as a list: positions, velocities, orientations with angular momenta, and work.
    values: Vec<f64>,
    /// The slopes (time derivatives) of the values at the twelve stages. The first stage is the present state.
    slopes: [Vec<f64>; 12],
    /// Working memory for the values at a stage.
    stage: Vec<f64>,
    /// The length of the next step, s.
    proposal: f64,
    /// The time since the orientations of uniformly rotating bodies were stored, s.
    elapsed: f64,
    /// What the rotations without torque keep.
    free: Vec<FreeRotation>,
}

impl Dop853 {
    pub(super) fn new(tolerance: f64) -> Dop853 {
        Dop853 { tolerance, ..Dop853::default() }
    }

    /// Computes the values after a step of `h` (s) and stores them in `stage`. The slope at the end of the step is computed later.
    fn try_step(&mut self, field: &mut Field<'_>, now: Time, h: f64) {
        self.find_slope(field, now, h, 1, STAGE_2);
        self.find_slope(field, now, h, 2, STAGE_3);
        self.find_slope(field, now, h, 3, STAGE_4);
        self.find_slope(field, now, h, 4, STAGE_5);
        self.find_slope(field, now, h, 5, STAGE_6);
        self.find_slope(field, now, h, 6, STAGE_7);
        self.find_slope(field, now, h, 7, STAGE_8);
        self.find_slope(field, now, h, 8, STAGE_9);
        self.find_slope(field, now, h, 9, STAGE_10);
        self.find_slope(field, now, h, 10, STAGE_11);
        self.find_slope(field, now, h, 11, STAGE_12);
        self.follow(h, RESULT_WEIGHTS);
    }

    /// Computes the slope of one stage from the slopes of earlier stages.
    fn find_slope<const N: usize>(
        &mut self,
        field: &mut Field<'_>,
        now: Time,
        h: f64,
        number: usize,
        weights: [Weight; N],
    ) {
        self.follow(h, weights);
        flat::find_slope(
            field,
            now.seconds() + STAGE_TIMES[number] * h,
            &self.stage,
            &mut self.slopes[number],
        );
    }

    /// Sets `stage` to the present values plus `h` times the weighted sum of slopes.
    fn follow<const N: usize>(&mut self, h: f64, weights: [Weight; N]) {
        let Dop853 { values, slopes, stage, .. } = self;
        let slopes = weights.map(|(number, _)| &slopes[number][..values.len()]);
        for (i, (stage, value)) in stage.iter_mut().zip(values).enumerate() {
            let mut sum = 0.0;
            for (slope, (_, weight)) in slopes.iter().zip(weights) {
                sum += weight * slope[i];
            }
            *stage = *value + h * sum;
        }
    }

    /// Returns the largest error of the step, divided by the allowed error, and the body with this error. The step is accepted if the
    /// ratio is at most 1.
    fn error(&self, field: &Field<'_>, h: f64) -> (f64, BodyId) {
        let Dop853 { values, slopes, stage, tolerance, .. } = self;
        let sum = |weights: &[Weight], i: usize| -> f64 {
            weights.iter().map(|(number, weight)| weight * slopes[*number][i]).sum()
        };
        let mut worst = (0.0, BodyId::new(0));
        flat::each_body(field, values, stage, |body, parts| {
            let (mut of_5, mut of_3, mut count) = (0.0, 0.0, 0.0);
            for (range, scale) in parts {
                for i in range {
                    let (five, three) = (sum(&ERROR_5, i) / scale, sum(&ERROR_3, i) / scale);
                    of_5 += five * five;
                    of_3 += three * three;
                    count += 1.0;
                }
            }
            let both = (of_5 + 0.01 * of_3) * count;
            let error = if both > 0.0 { h * of_5 / (both.sqrt() * tolerance) } else { both };
            if error > worst.0 || error.is_nan() && !f64::is_nan(worst.0) {
                worst = (error, BodyId::new(body));
            }
        });
        worst
    }

    /// Makes the values in `stage` the new state, and computes their slope.
    fn accept(&mut self, field: &mut Field<'_>, now: Time, h: f64) {
        std::mem::swap(&mut self.values, &mut self.stage);
        flat::normalize(field, &self.free, &mut self.values);
        flat::find_slope(field, now.after(h).seconds(), &self.values, &mut self.slopes[0]);
        self.elapsed += h;
    }

    /// Returns a suitable length of the first step, s. Source: Hairer, Nørsett & Wanner, II.4, where the unit of time is the first guess.
    fn first_step(&mut self, field: &mut Field<'_>, now: Time) -> f64 {
        // Slopes and curvatures are divided by the allowed error. Values of the state would be about 1/tolerance in these units.
        let rate = self.largest(field, |dop, i| dop.slopes[0][i]);
        if rate == 0.0 {
            return f64::INFINITY;
        }
        let guess = 0.01 / (self.tolerance * rate);
        self.follow(guess, [(0, 1.0)]);
        flat::find_slope(field, now.after(guess).seconds(), &self.stage, &mut self.slopes[1]);
        let bend = self.largest(field, |dop, i| dop.slopes[1][i] - dop.slopes[0][i]) / guess;
        let steepest = bend.max(rate * rate * self.tolerance);
        // Multiplied by the square of the guess, the steepest change is a number without a unit. Only such numbers have an eighth root.
        eighth_root(0.01 / (steepest * self.tolerance * guess * guess)).min(100.0) * guess
    }

    /// Returns the largest magnitude of a quantity over all entries of the list, each divided by its allowed error.
    fn largest(&self, field: &Field<'_>, of: impl Fn(&Dop853, usize) -> f64) -> f64 {
        let mut largest: f64 = 0.0;
        flat::each_body(field, &self.values, &self.values, |_, parts| {
            for (range, scale) in parts {
                let most = range.map(|i| of(self, i).abs()).fold(0.0, f64::max);
                largest = largest.max(if most == 0.0 { 0.0 } else { most / (scale * self.tolerance) });
            }
        });
        largest
    }
}

fn eighth_root(x: f64) -> f64 {
    x.sqrt().sqrt().sqrt()
}

impl Stepper for Dop853 {
    fn begin(&mut self, field: &mut Field<'_>, now: Time) {
        flat::read(field, &mut self.values);
        self.free.clear();
        self.free.extend(FreeRotation::all(field));
        let count = self.values.len();
        self.slopes.iter_mut().chain([&mut self.stage]).for_each(|room| room.resize(count, 0.0));
        self.elapsed = 0.0;
        flat::find_slope(field, now.seconds(), &self.values, &mut self.slopes[0]);
        self.proposal = self.first_step(field, now);
    }

    fn proposal(&self) -> f64 {
        self.proposal
    }

    fn step(&mut self, field: &mut Field<'_>, now: Time, longest: f64) -> Result<f64, BodyId> {
        let mut h = self.proposal.min(longest);
        let mut most = MAX_STEP_RATIO;
        loop {
            self.try_step(field, now, h);
            let (error, body) = self.error(field, h);
            if error <= 1.0 {
                self.accept(field, now, h);
                let factor = SAFETY_FACTOR / eighth_root(error);
                // If a limit has shortened this step, the next step may be as long as the method proposed before.
                self.proposal = (h * factor.clamp(MIN_STEP_RATIO, most)).max(if most > 1.0 {
                    h.min(self.proposal)
                } else {
                    0.0
                });
                return Ok(h);
            }
            most = 1.0;
            let factor = if error.is_finite() {
                (SAFETY_FACTOR / eighth_root(error)).max(MIN_STEP_RATIO)
            } else {
                0.1
            };
            h *= factor.min(SAFETY_FACTOR);
            if is_too_short(h, now) {
                return Err(body);
            }
        }
    }

    fn step_by(&mut self, field: &mut Field<'_>, now: Time, duration: f64) {
        self.try_step(field, now, duration);
        self.accept(field, now, duration);
    }

    fn write(&self, field: &Field<'_>, state: &mut State) {
        flat::write(field, &self.values, state);
        field.bodies.spin(field.model, self.elapsed, state);
    }
}

// `Clone` is written by hand, because stages need not be copied, and allocated memory can be reused.
impl Clone for Dop853 {
    fn clone(&self) -> Self {
        let mut clone = Dop853::default();
        clone.clone_from(self);
        clone
    }

    fn clone_from(&mut self, source: &Self) {
        self.values.clone_from(&source.values);
        self.slopes[0].clone_from(&source.slopes[0]);
        self.free.clone_from(&source.free);
        let count = self.values.len();
        self.slopes.iter_mut().chain([&mut self.stage]).for_each(|room| room.resize(count, 0.0));
        (self.tolerance, self.proposal, self.elapsed) = (source.tolerance, source.proposal, source.elapsed);
    }
}
