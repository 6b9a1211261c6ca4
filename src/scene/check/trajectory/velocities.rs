//! Finds velocities in a trajectory file that contradict its places, for example because they are in another unit.
//!
//! A cubic through the rows takes its slopes from the velocity columns. Slopes in another unit make it swing far beyond the rows, or stop
//! at each of them.
//!
//! For each interval of `h` seconds between two rows, the way by the velocities, q = h (v₀ + v₁) / 2, is compared with the way by the
//! rows, d. Honest data of a smooth motion is never refused:
//!
//! - An oscillation that is sampled n times per period has q / d = (π / n) / tan(π / n): 0.91 for 6 rows, and 0.60 for 3. This is more than
//!   1 / r, where r is [`MAX_VELOCITY_RATIO`]. An error in the unit is a factor of 1.94 (knots) or more, and of 1.76 or more with 6 rows per
//!   period.
//! - An impact between two rows changes q and d by any factor. An interval with an impact adds at most q² / (4 r) to the evidence
//!   Σ (q d − r d²), from which every other one takes (r − 1) d². Even if half of the intervals have impacts, the sum is negative. Where d
//!   lies between h v₀ and h v₁, an impact explains the interval. Such intervals alone are no evidence.
//! - Noise of the velocities that is independent of the places does not change the mean of q d − r d², and noise of the places does not
//!   change that of q d − r q². The sums must exceed their standard errors several times.
//! - If q and d have little to do with each other, one of them is noise or wrong. White noise has no correlation from row to row, and
//!   differences of places with white noise have a negative one. So if places and velocities both change smoothly, both are signals.
//!   Noise then leaves their ratio between 1 / r and r, and their correlation above [`MIN_CORRELATION`].

use glam::{DQuat, DVec3};

use crate::physics::Keyframe;

/// The largest ratio of velocities and differences of rows, in either direction, that is no contradiction.
const MAX_VELOCITY_RATIO: f64 = 1.75;
/// The smallest correlation of smooth velocities and smooth differences of rows that is no contradiction.
const MIN_CORRELATION: f64 = 0.25;
/// Changes are smooth if the correlation of neighboring rows exceeds this by 1.2 / √n for n intervals.
const MIN_SMOOTHNESS: f64 = 0.4;
/// The correlation of neighboring rows from which on changes are smooth, however few the rows are.
const MAX_REQUIRED_SMOOTHNESS: f64 = 0.95;
/// An axis counts only if the motion along it is more than this part of the whole motion.
const MIN_AXIS_FRACTION: f64 = 0.3;
/// The tolerance for differences that an impact explains, as a fraction of the velocities.
const IMPACT_TOLERANCE: f64 = 0.1;
/// The number of standard errors by which the evidence must exceed what is allowed.
const REQUIRED_STANDARD_ERRORS: f64 = 5.0;
/// If there are few intervals, noise may change the ratio by more: n intervals may differ by the factor
/// [`MAX_VELOCITY_RATIO`] (1 + `SHORT_DATA_ALLOWANCE` / n²).
const SHORT_DATA_ALLOWANCE: f64 = 5.0;
/// With fewer intervals, velocities never count as too small.
const MIN_INTERVALS_IF_SLOW: f64 = 3.0;
/// With fewer intervals, smooth changes never count as unlike each other.
const MIN_INTERVALS_IF_UNLIKE: f64 = 5.0;
/// Rotations between rows by a larger angle are not compared, rad: a recording may have rotated by any number of turns more.
const LARGEST_ANGLE: f64 = 2.0;

/// A velocity that contradicts the places.
#[derive(Debug, PartialEq)]
pub(super) struct Contradiction {
    /// The index of the row.
    pub(super) row: usize,
    /// The axis: 0, 1 or 2.
    pub(super) axis: usize,
    /// The velocity in the column, m/s or rad/s.
    pub(super) column: f64,
    /// The velocity between this row and the next one that follows from places or orientations, m/s or rad/s.
    pub(super) rows: f64,
    /// The typical ratio of the two; 0 if it is unknown.
    pub(super) factor: f64,
}

/// An interval between two rows.
struct Interval {
    row: usize,
    /// The duration, s.
    h: f64,
    /// The velocities in the columns at both ends.
    ends: [DVec3; 2],
    /// The way from row to row.
    way: DVec3,
}

/// Finds a velocity that contradicts the places of a body's rows. `gaps` holds the index of the row after each gap.
pub(super) fn of_places(keys: &[Keyframe], gaps: &[usize]) -> Option<Contradiction> {
    let way = |one: &Keyframe, two: &Keyframe| two.location - one.location;
    find(&intervals(keys, gaps, |key| key.velocity, way), true)
}

/// Finds an angular velocity that contradicts the orientations of a body's rows. `gaps` holds the index of the row after each gap.
pub(super) fn of_orientations(keys: &[Keyframe], gaps: &[usize]) -> Option<Contradiction> {
    let way = |one: &Keyframe, two: &Keyframe| {
        let turn: DQuat = two.orientation * one.orientation.conjugate();
        (if turn.w < 0.0 { -turn } else { turn }).to_scaled_axis()
    };
    let mut all = intervals(keys, gaps, |key| key.angular_velocity, way);
    all.retain(|interval| interval.ends.iter().all(|end| interval.h * end.length() < LARGEST_ANGLE));
    find(&all, false)
}

fn intervals(
    keys: &[Keyframe],
    gaps: &[usize],
    velocity: impl Fn(&Keyframe) -> Option<DVec3>,
    way: impl Fn(&Keyframe, &Keyframe) -> DVec3,
) -> Vec<Interval> {
    let interval = |row: usize| {
        let [one, two] = [&keys[row], &keys[row + 1]];
        let joins = gaps.binary_search(&(row + 1)).is_err();
        let ends = [velocity(one)?, velocity(two)?];
        joins.then(|| Interval { row, h: two.time - one.time, ends, way: way(one, two) })
    };
    (0..keys.len().saturating_sub(1)).filter_map(interval).collect()
}

/// Finds the axis and the row with the clearest contradiction. `also_unlike` is true if smooth changes that are unlike each other count.
fn find(intervals: &[Interval], also_unlike: bool) -> Option<Contradiction> {
    let whole: f64 = intervals.iter().map(|interval| interval.way.length_squared()).sum();
    let axis = (0..3).find(|&axis| {
        let sums = Sums::of(intervals, axis);
        let slight = MIN_AXIS_FRACTION * MIN_AXIS_FRACTION * whole;
        sums.differ(slight) || also_unlike && sums.are_unlike(slight)
    })?;
    let off = |interval: &&Interval| {
        let [one, two] = interval.ends.map(|end| end[axis]);
        (0.5 * (one + two) - interval.way[axis] / interval.h).abs()
    };
    let worst = intervals.iter().rev().max_by(|one, two| off(one).total_cmp(&off(two)))?;
    let Sums { qd, qq, dd, .. } = Sums::of(intervals, axis);
    let factor = if qd * qd > 0.8 * qq * dd && qd > 0.0 { (qq / dd).sqrt() } else { 0.0 };
    let (row, column) = match worst.ends.map(|end| end[axis]) {
        [one, two] if two.abs() > one.abs() => (worst.row + 1, two),
        [one, _] => (worst.row, one),
    };
    Some(Contradiction { row, axis, column, rows: worst.way[axis] / worst.h, factor })
}

/// Sums over all intervals, along one axis.
struct Sums {
    /// The number of intervals.
    n: f64,
    /// The sums of q d, q² and d².
    qd: f64,
    qq: f64,
    dd: f64,
    /// The parts of these sums that no impact explains.
    unexplained: [f64; 3],
    /// The correlation of neighboring velocities, and the one of neighboring differences of rows. 0 if all are 0.
    smoothness: [f64; 2],
}

impl Sums {
    fn of(intervals: &[Interval], axis: usize) -> Sums {
        let mut all = [0.0; 3];
        let mut unexplained = [0.0; 3];
        let (mut velocities, mut ways) = ([0.0; 2], [0.0; 2]);
        let mut last: Option<&Interval> = None;
        for interval in intervals {
            let (h, d) = (interval.h, interval.way[axis]);
            let [one, two] = interval.ends.map(|end| end[axis]);
            let q = 0.5 * h * (one + two);
            let margin = IMPACT_TOLERANCE * h * one.abs().max(two.abs());
            let is_explained = (h * one.min(two) - margin..=h * one.max(two) + margin).contains(&d);
            for (k, term) in [q * d, q * q, d * d].into_iter().enumerate() {
                all[k] += term;
                unexplained[k] += if is_explained { 0.0 } else { term };
            }
            add(&mut velocities, h * h, [one, two]);
            if let Some(last) = last.filter(|last| last.row + 1 == interval.row) {
                add(&mut ways, h * last.h, [last.way[axis] / last.h, d / h]);
            }
            last = Some(interval);
        }
        let correlation = |[both, each]: [f64; 2]| if each > 0.0 { both / each } else { 0.0 };
        #[allow(clippy::cast_precision_loss, reason = "a file has fewer rows than 2⁵³")]
        let n = intervals.len() as f64;
        let [qd, qq, dd] = all;
        Sums { n, qd, qq, dd, unexplained, smoothness: [velocities, ways].map(correlation) }
    }

    /// The largest ratio of velocities and differences of rows that is no contradiction.
    fn most(&self) -> f64 {
        MAX_VELOCITY_RATIO * (1.0 + SHORT_DATA_ALLOWANCE / (self.n * self.n))
    }

    /// Returns true if velocities and differences of rows are proportional to each other, by another factor than 1.
    fn differ(&self, slight: f64) -> bool {
        let Sums { n, qd, qq, dd, unexplained: [qd_of, qq_of, dd_of], .. } = *self;
        let is_more = |own: f64, other: f64, other_of: f64| {
            // The standard error of the sum of q d follows from what is not proportional. A few intervals give a poor estimate of it.
            let freedom = (n - 1.0).max(1.0);
            let error =
                ((own * other - qd * qd).max(0.0) / freedom).sqrt() * (1.0 + 10.0 / (freedom * freedom));
            own > slight
                && qd - self.most() * other > REQUIRED_STANDARD_ERRORS * error
                && qd_of > self.most() * other_of
        };
        dd > 0.0 && is_more(qq, dd, dd_of) || n >= MIN_INTERVALS_IF_SLOW && qq > 0.0 && is_more(dd, qq, qq_of)
    }

    /// Returns true if velocities and differences of rows are smooth, but of different sizes or unlike each other.
    fn are_unlike(&self, slight: f64) -> bool {
        let Sums { n, qd, qq, dd, smoothness, .. } = *self;
        let [velocities, ways] = smoothness
            .map(|smoothness| smoothness > (MIN_SMOOTHNESS + 1.2 / n.sqrt()).min(MAX_REQUIRED_SMOOTHNESS));
        let most = self.most() * self.most();
        let is_too_large = velocities && qq > most * (dd + slight);
        let is_too_small = ways && dd > most * qq + slight;
        let is_other =
            velocities && ways && qq > slight && dd > slight && qd < MIN_CORRELATION * (qq * dd).sqrt();
        n >= MIN_INTERVALS_IF_UNLIKE && (is_too_large || is_too_small || is_other)
    }
}

/// Adds a pair of neighboring values with a weight to the sum of their products and that of the means of their squares.
fn add(sums: &mut [f64; 2], weight: f64, [one, two]: [f64; 2]) {
    sums[0] += weight * one * two;
    sums[1] += weight * 0.5 * (one * one + two * two);
}

#[cfg(test)]
mod tests;
