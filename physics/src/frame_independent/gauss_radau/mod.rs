//! Everhart's Gauss–Radau method of order 15. It chooses its steps by the time scale on which accelerations change.

mod lane;
mod nodes;

use glam::{DQuat, DVec3};

use self::lane::{End, Lane};
use super::super::{BodyId, State};
use super::bodies::{Field, axes};
use super::stepper::{Stepper, is_too_short};
use super::time::Time;

/// A step is repeated if the suitable length is below this fraction of its length. The next step is at most as long as this step divided by
/// this fraction.
const MIN_STEP_RATIO: f64 = 0.25;
/// The largest number of iterations for the coefficients of a step.
const MAX_ITERATIONS: usize = 12;
/// The iteration has converged if the last coefficient changes by less than this fraction of the largest slope.
const CONVERGENCE_TOLERANCE: f64 = 1e-16;
/// A relative change below this may be a rounding error, so the iteration stops when such changes no longer shrink. Larger changes may grow
/// at first and shrink later.
const RELATIVE_ROUNDING: f64 = 1e-12;
/// A value does not limit the step if it changes by at most this fraction of its size within the step, because the change is a rounding
/// error.
const NEGLIGIBLE_CHANGE: f64 = 1e-15;
/// The coefficients of a step are not predicted if the step is more than this many times as long as the last step.
const MAX_PREDICTION_RATIO: f64 = 20.0;

/// Everhart's Gauss–Radau method. Within a step, each slope is a polynomial through its values at eight nodes. Source: E. Everhart, *An
/// efficient integrator that uses Gauss–Radau spacings*, in *Dynamics of Comets* (1985) 185; H. Rein & D. S. Spiegel, Mon. Not. R. Astron.
/// Soc. 446 (2015) 1424.
///
/// Each body allows a step of √(2 a² / (j² + a s)) · (5040 tolerance)^(1/7) seconds, with its acceleration a, jerk j and snap s at the end
/// of the last step. The shortest of these steps is used. It does not depend on the distance of a body from the origin. Source: D. Pham,
/// H. Rein & D. S. Spiegel, Open J. Astrophys. 7 (2024). Orientations and angular momenta limit the step in the same way. Positions,
/// velocities and time are compensated sums, which correct rounding errors.
#[derive(Default)]
pub(super) struct GaussRadau {
    /// The ratio of the step to the shortest time scale of the motion.
    factor: f64,
    /// The integrated quantities: one lane for each moving body; two lanes for the orientation and one for the angular momentum of each
    /// rotating body; one lane for the work.
    lanes: Vec<Lane>,
    proposal: f64,
    /// The length of the last step, s; 0 before the first step.
    last: f64,
    /// The time since the orientations of uniformly rotating bodies were stored, s.
    elapsed: f64,
}

/// The number of lanes for the rotation of a body.
const OF_TURN: usize = 3;

impl GaussRadau {
    pub(super) fn new(tolerance: f64) -> GaussRadau {
        GaussRadau { factor: libm::pow(5040.0 * tolerance, 1.0 / 7.0), ..GaussRadau::default() }
    }

    /// Finds the coefficients of all lanes for a step of `dt` (s), by iteration over the nodes.
    fn solve(&mut self, field: &mut Field<'_>, now: Time, dt: f64) {
        let ratio = if self.last > 0.0 { dt / self.last } else { 0.0 };
        let ratio = if ratio > MAX_PREDICTION_RATIO { 0.0 } else { ratio };
        self.lanes.iter_mut().for_each(|lane| lane.expect(ratio));
        let mut before = f64::INFINITY;
        for round in 0..MAX_ITERATIONS {
            self.visit::<1>(field, now, dt);
            self.visit::<2>(field, now, dt);
            self.visit::<3>(field, now, dt);
            self.visit::<4>(field, now, dt);
            self.visit::<5>(field, now, dt);
            self.visit::<6>(field, now, dt);
            let change = self.visit::<7>(field, now, dt);
            // A small change that no longer shrinks is a rounding error.
            if change < CONVERGENCE_TOLERANCE || round > 1 && change < RELATIVE_ROUNDING && change >= before {
                break;
            }
            before = change;
        }
    }

    /// Evaluates the slopes at node N and updates the coefficients. For the last node, returns the largest change of the last coefficient,
    /// relative to the largest slope with the same unit; for other nodes, 0.
    fn visit<const N: usize>(&mut self, field: &mut Field<'_>, now: Time, dt: f64) -> f64 {
        self.place(field, |lane| lane.place_at(N, dt), |lane| lane.value_at(N, dt));
        field.evaluate(now.after(nodes::NODES[N] * dt).seconds());
        // Accelerations, rotations, torques and powers have different units, so the largest values are found for each unit separately.
        let mut largest = [(0.0f64, 0.0f64); 4];
        self.each_slope(field, |lane, slope, sort| {
            let change = lane.refine::<N>(slope);
            if N == 7 {
                let (changes, slopes) = &mut largest[sort];
                *changes = changes.max(change.abs().max_element());
                *slopes = slopes.max(slope.abs().max_element());
            }
        });
        let parts = largest.iter().filter(|(change, _)| *change > 0.0).map(|(change, slope)| change / slope);
        parts.fold(0.0, f64::max)
    }

    /// Sets the positions, orientations and momenta of the bodies to values of their lanes. Velocities are set only if forces depend on
    /// them.
    #[inline(always)]
    fn place(&self, field: &mut Field<'_>, at: impl Fn(&Lane) -> DVec3, value: impl Fn(&Lane) -> DVec3) {
        let (moving, others) = self.lanes.split_at(field.bodies.moving.len());
        let stage = &mut *field.stage;
        for (lane, &i) in moving.iter().zip(&field.bodies.moving) {
            stage.location[i] = at(lane);
            if field.bodies.feels_motion {
                stage.velocity[i] = value(lane);
            }
        }
        for (turn, &i) in others.as_chunks::<OF_TURN>().0.iter().zip(&field.bodies.turning) {
            let [xyz, w, momentum] = turn.each_ref().map(&value);
            let orientation = DQuat::from_vec4(xyz.extend(w.x)).normalize();
            stage.orientation[i] = orientation;
            stage.angular_momentum[i] = axes(field.model, i, orientation) * momentum;
        }
    }

    /// Calls `see` for each lane with its slope at the current stage, and with an index for the slope's unit.
    #[inline(always)]
    fn each_slope(&mut self, field: &Field<'_>, mut see: impl FnMut(&mut Lane, DVec3, usize)) {
        let (moving, others) = self.lanes.split_at_mut(field.bodies.moving.len());
        for (lane, &i) in moving.iter_mut().zip(&field.bodies.moving) {
            see(lane, field.acceleration(i), 0);
        }
        let (turns, rest) = others.split_at_mut(OF_TURN * field.bodies.turning.len());
        for ([xyz, w, momentum], &i) in
            turns.as_chunks_mut::<OF_TURN>().0.iter_mut().zip(&field.bodies.turning)
        {
            let (rate, torque) = field.turning(i);
            see(xyz, rate.xyz(), 1);
            see(w, DVec3::X * rate.w, 1);
            see(momentum, torque, 2);
        }
        rest.iter_mut().for_each(|work| see(work, DVec3::X * field.loads.power.work, 3));
    }

    /// Returns the length of the next step (s) that the accuracy allows, and the body that limits it. The length is judged by the motion at
    /// the end of the present step of length `dt`. It is NaN if a time derivative is not finite.
    fn suitable(&self, field: &Field<'_>, dt: f64) -> (f64, BodyId) {
        let mut shortest = (f64::INFINITY, 0);
        let mut see = |i: usize, ends: &[End], size: f64| {
            let sum = |of: fn(&End) -> DVec3| ends.iter().map(|end| of(end).length_squared()).sum::<f64>();
            let (slope, rate, curvature) =
                (sum(|end| end.slope), sum(|end| end.rate), sum(|end| end.curvature));
            if (slope.max(rate)).sqrt() * dt <= NEGLIGIBLE_CHANGE * size {
                return;
            }
            let square = 2.0 * slope / (rate + (curvature * slope).sqrt());
            if square < shortest.0 || square.is_nan() && (slope > 0.0 || slope.is_nan()) {
                shortest = (square, i);
            }
        };
        let (moving, others) = self.lanes.split_at(field.bodies.moving.len());
        for (lane, &i) in moving.iter().zip(&field.bodies.moving) {
            see(i, &[lane.end()], field.scales.speed.max(lane.value.value.length()));
        }
        for ([xyz, w, momentum], &i) in others.as_chunks::<OF_TURN>().0.iter().zip(&field.bodies.turning) {
            see(i, &[xyz.end(), w.end()], 1.0);
            see(i, &[momentum.end()], momentum.value.value.length());
        }
        (shortest.0.sqrt() * dt * self.factor, BodyId::new(shortest.1))
    }

    /// Advances all lanes to the end of a step of `dt`, s, and normalises the orientations.
    fn finish(&mut self, field: &mut Field<'_>, dt: f64) {
        let (moving, others) = self.lanes.split_at_mut(field.bodies.moving.len());
        moving.iter_mut().for_each(|lane| lane.finish(dt, true));
        others.iter_mut().for_each(|lane| lane.finish(dt, false));
        let turns = OF_TURN * field.bodies.turning.len();
        for [xyz, w, _] in others[..turns].as_chunks_mut::<OF_TURN>().0 {
            // The quaternion is normalised by an added correction, because a division would lose the compensation of the sums.
            let square = xyz.value.value.length_squared() + w.value.value.length_squared();
            let missing = 0.5 * (1.0 - square);
            xyz.value.add(missing * xyz.value.value);
            w.value.add(missing * w.value.value);
        }
        (self.last, self.elapsed) = (dt, self.elapsed + dt);
    }

    /// Evaluates the slopes of all lanes at the start of a step.
    fn set_out(&mut self, field: &mut Field<'_>, now: Time) {
        self.place(field, |lane| lane.place.value, |lane| lane.value.value);
        field.evaluate(now.seconds());
        self.each_slope(field, |lane, slope, _| lane.slope = slope);
    }
}

impl Stepper for GaussRadau {
    fn begin(&mut self, field: &mut Field<'_>, _: Time) {
        let (bodies, stage) = (field.bodies, &*field.stage);
        let lane = |value| Lane::of(DVec3::ZERO, value);
        self.lanes.clear();
        self.lanes.extend(bodies.moving.iter().map(|&i| Lane::of(stage.location[i], stage.velocity[i])));
        let mut fastest = field.scales.speed / field.scales.length;
        for &i in &bodies.turning {
            let turn = stage.orientation[i];
            self.lanes.extend([turn.xyz(), DVec3::X * turn.w, field.momentum(i)].map(lane));
            fastest = fastest.max(field.model.angular_velocity(i, stage).length());
        }
        self.lanes.extend(bodies.works.then(|| lane(DVec3::X * stage.accounts.work)));
        (self.last, self.elapsed) = (0.0, 0.0);
        self.proposal = if fastest > 0.0 { 1e-3 / fastest } else { f64::INFINITY };
    }

    fn proposal(&self) -> f64 {
        self.proposal
    }

    fn step(&mut self, field: &mut Field<'_>, now: Time, longest: f64) -> Result<f64, BodyId> {
        let mut dt = self.proposal.min(longest);
        self.set_out(field, now);
        loop {
            self.solve(field, now, dt);
            let (suitable, body) = self.suitable(field, dt);
            if suitable >= MIN_STEP_RATIO * dt {
                self.finish(field, dt);
                let next = suitable.min(dt / MIN_STEP_RATIO);
                // If a limit has shortened this step, the next step may be as long as the method proposed before.
                self.proposal = if dt < self.proposal { next.max(self.proposal.min(suitable)) } else { next };
                return Ok(dt);
            }
            dt = if suitable > 0.0 { suitable } else { MIN_STEP_RATIO * dt };
            self.proposal = dt;
            if is_too_short(dt, now) {
                return Err(body);
            }
        }
    }

    fn step_by(&mut self, field: &mut Field<'_>, now: Time, duration: f64) {
        self.set_out(field, now);
        self.solve(field, now, duration);
        self.finish(field, duration);
    }

    fn write(&self, field: &Field<'_>, state: &mut State) {
        let (moving, others) = self.lanes.split_at(field.bodies.moving.len());
        for (lane, &i) in moving.iter().zip(&field.bodies.moving) {
            (state.location[i], state.velocity[i]) = (lane.place.value, lane.value.value);
        }
        let (turns, rest) = others.split_at(OF_TURN * field.bodies.turning.len());
        for ([xyz, w, momentum], &i) in turns.as_chunks::<OF_TURN>().0.iter().zip(&field.bodies.turning) {
            let orientation = DQuat::from_vec4(xyz.value.value.extend(w.value.value.x)).normalize();
            state.orientation[i] = orientation;
            state.angular_momentum[i] = axes(field.model, i, orientation) * momentum.value.value;
        }
        rest.iter().for_each(|work| state.accounts.work = work.value.value.x);
        field.bodies.spin(field.model, self.elapsed, state);
    }
}

// `Clone` is written by hand, because the memory for lanes can be reused.
impl Clone for GaussRadau {
    fn clone(&self) -> Self {
        GaussRadau { lanes: self.lanes.clone(), ..*self }
    }

    fn clone_from(&mut self, source: &Self) {
        self.lanes.clone_from(&source.lanes);
        (self.factor, self.proposal, self.last, self.elapsed) =
            (source.factor, source.proposal, source.last, source.elapsed);
    }
}
