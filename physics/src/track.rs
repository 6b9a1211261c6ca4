//! A motion given by poses at some times: keyframes, or the recording of another simulation.

use glam::{DQuat, DVec3};

use super::{Kinematics, Motion};

/// How a motion is interpolated between two keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Linear interpolation: velocities jump at the keys.
    Linear,
    /// Interpolation by cubic Hermite polynomials: velocities are continuous.
    Cubic,
}

/// A keyframe of a motion: the pose of a body at a given time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// The time of the key, s.
    pub time: f64,
    /// The position of the center of mass, world axes, m.
    pub location: DVec3,
    /// The rotation from body axes to world axes.
    pub orientation: DQuat,
    /// The velocity of the center of mass (world axes, m/s), if known.
    pub velocity: Option<DVec3>,
    /// The angular velocity of the body (world axes, rad/s), if known.
    pub angular_velocity: Option<DVec3>,
}

/// A motion that interpolates given poses. Before the first and after the last pose, the body is at rest there.
#[derive(Clone, Debug)]
pub struct Track {
    keys: Vec<Keyframe>,
    interpolation: Interpolation,
    /// For cubic interpolation: the time derivatives of location and orientation at each key. Empty for linear interpolation.
    slopes: Vec<(DVec3, DQuat)>,
}

impl Track {
    /// Creates the motion through some keys, whose times must be ascending.
    ///
    /// If a key of a cubic track has no velocity, its slope is that of the parabola through the key and its two neighbors. At both ends of
    /// the track, `at_rest` sets this slope to 0; otherwise it is the slope between the two outermost keys at this end.
    #[must_use]
    pub fn new(keys: Vec<Keyframe>, interpolation: Interpolation, at_rest: bool) -> Track {
        Track::with_gaps(keys, &[], interpolation, at_rest)
    }

    /// Creates a motion with gaps. `gaps` holds the index of the key after each gap, in ascending order. The slopes in each part between
    /// gaps depend on that part alone.
    #[must_use]
    pub fn with_gaps(
        mut keys: Vec<Keyframe>,
        gaps: &[usize],
        interpolation: Interpolation,
        at_rest: bool,
    ) -> Track {
        // The quaternions q and −q are the same orientation. The signs are chosen so that the rotation between neighboring keys is the
        // shorter one.
        for i in 1..keys.len() {
            if keys[i].orientation.dot(keys[i - 1].orientation) < 0.0 {
                keys[i].orientation = -keys[i].orientation;
            }
        }
        let slope = |i| slope(&keys, gaps, i, at_rest);
        let slopes = match interpolation {
            Interpolation::Linear => Vec::new(),
            Interpolation::Cubic => (0..keys.len()).map(slope).collect(),
        };
        Track { keys, interpolation, slopes }
    }

    /// Returns the times of the first and the last key, s. `None` if there are no keys.
    #[must_use]
    pub fn span(&self) -> Option<[f64; 2]> {
        Some([self.keys.first()?.time, self.keys.last()?.time])
    }
}

/// Computes the time derivatives of location and orientation at key `i`.
fn slope(keys: &[Keyframe], gaps: &[usize], i: usize, at_rest: bool) -> (DVec3, DQuat) {
    let joins = |i: &usize| gaps.binary_search(i).is_err();
    let before = Some(i).filter(joins).and_then(|i| keys.get(i.checked_sub(1)?));
    let after = Some(i + 1).filter(joins).and_then(|i| keys.get(i));
    let key = &keys[i];
    let rise = |a: &Keyframe, b: &Keyframe| {
        let part = 1.0 / (b.time - a.time);
        ((b.location - a.location) * part, (b.orientation - a.orientation) * part)
    };
    let (location, orientation) = match (before, after) {
        (Some(a), Some(b)) => {
            // The slope of the parabola: the slope of each side is weighted by the length of the other side.
            let weight = (b.time - key.time) / (b.time - a.time);
            let (left, right) = (rise(a, key), rise(key, b));
            (left.0 * weight + right.0 * (1.0 - weight), left.1 * weight + right.1 * (1.0 - weight))
        }
        _ if at_rest => (DVec3::ZERO, DQuat::from_array([0.0; 4])),
        (Some(a), None) => rise(a, key),
        (None, Some(b)) => rise(key, b),
        (None, None) => (DVec3::ZERO, DQuat::from_array([0.0; 4])),
    };
    let turning = key.angular_velocity.map(|omega| spin(omega) * key.orientation * 0.5);
    (key.velocity.unwrap_or(location), turning.unwrap_or(orientation))
}

/// Returns an angular velocity as a quaternion without real part.
fn spin(omega: DVec3) -> DQuat {
    DQuat::from_xyzw(omega.x, omega.y, omega.z, 0.0)
}

impl Motion for Track {
    fn at(&self, t: f64) -> Kinematics {
        let after = self.keys.partition_point(|key| key.time <= t);
        let rest = |key: &Keyframe| Kinematics {
            location: key.location,
            velocity: DVec3::ZERO,
            acceleration: DVec3::ZERO,
            orientation: key.orientation,
            angular_velocity: DVec3::ZERO,
        };
        let (Some(a), Some(b)) = (after.checked_sub(1).map(|i| &self.keys[i]), self.keys.get(after)) else {
            let end = if after == 0 { self.keys.first() } else { self.keys.last() };
            // At the time of the last key, the body still moves.
            return match end {
                Some(last) if after > 1 && last.time == t => self.between(after - 2, t),
                Some(key) => rest(key),
                None => Kinematics {
                    location: DVec3::ZERO,
                    velocity: DVec3::ZERO,
                    acceleration: DVec3::ZERO,
                    orientation: DQuat::IDENTITY,
                    angular_velocity: DVec3::ZERO,
                },
            };
        };
        debug_assert!(a.time <= t && t < b.time);
        self.between(after - 1, t)
    }

    fn angular_acceleration(&self, t: f64) -> DVec3 {
        let after = self.keys.partition_point(|key| key.time <= t);
        let is_end = after == self.keys.len() && self.keys.last().is_some_and(|last| last.time == t);
        let after = if is_end { after.saturating_sub(1) } else { after };
        let within = after > 0 && after < self.keys.len() && self.interpolation == Interpolation::Cubic;
        if within { self.turning(after - 1, t).acceleration() } else { DVec3::ZERO }
    }
}

/// A quaternion of any length that represents an orientation, with its first and second time derivatives.
struct Turning {
    quaternion: DQuat,
    rate: DQuat,
    curvature: DQuat,
}

impl Turning {
    /// Computes the angular acceleration, world axes, rad/s². With w = Q' Q* / |Q|², the angular velocity ω is twice the vector part of w,
    /// and the angular acceleration is 2 vec(Q'' Q*) / |Q|² − 2 Re(w) ω. The length of Q has no effect on the rotation.
    fn acceleration(&self) -> DVec3 {
        let per_square = 1.0 / self.quaternion.length_squared();
        let conjugate = self.quaternion.conjugate() * per_square;
        let (rate, curvature) = (self.rate * conjugate, self.curvature * conjugate);
        2.0 * curvature.xyz() - 4.0 * rate.w * rate.xyz()
    }
}

impl Track {
    /// Returns the pose and the motion at time `t` (s) between key `i` and the next key.
    fn between(&self, i: usize, t: f64) -> Kinematics {
        let (a, b) = (&self.keys[i], &self.keys[i + 1]);
        let duration = b.time - a.time;
        let s = (t - a.time) / duration;
        if self.interpolation == Interpolation::Linear {
            let turn = b.orientation * a.orientation.conjugate();
            let turn = if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis();
            return Kinematics {
                location: a.location.lerp(b.location, s),
                velocity: (b.location - a.location) / duration,
                acceleration: DVec3::ZERO,
                orientation: (DQuat::from_scaled_axis(turn * s) * a.orientation).normalize(),
                angular_velocity: turn / duration,
            };
        }
        let (from, to) = (self.slopes[i], self.slopes[i + 1]);
        let [h00, h10, h01, h11] = hermite(s);
        let [d00, d10, d01, d11] = hermite_slope(s).map(|d| d / duration);
        let [c00, c10, c01, c11] = hermite_curvature(s).map(|c| c / (duration * duration));
        let (m0, m1) = (from.0 * duration, to.0 * duration);
        let Turning { quaternion, rate, .. } = self.turning(i, t);
        let length = quaternion.length();
        let orientation = quaternion * (1.0 / length);
        // Only the vector part of this product rotates the body. The real part changes the length of the quaternion, which the
        // normalization removes.
        let turning = rate * (1.0 / length) * orientation.conjugate();
        Kinematics {
            location: a.location * h00 + m0 * h10 + b.location * h01 + m1 * h11,
            velocity: a.location * d00 + m0 * d10 + b.location * d01 + m1 * d11,
            acceleration: a.location * c00 + m0 * c10 + b.location * c01 + m1 * c11,
            orientation,
            angular_velocity: 2.0 * turning.xyz(),
        }
    }

    /// Returns the quaternion and its derivatives at time `t` (s) between key `i` and the next key, with cubic interpolation.
    fn turning(&self, i: usize, t: f64) -> Turning {
        let (a, b) = (&self.keys[i], &self.keys[i + 1]);
        let duration = b.time - a.time;
        let s = (t - a.time) / duration;
        let (n0, n1) = (self.slopes[i].1 * duration, self.slopes[i + 1].1 * duration);
        let mix =
            |[w00, w10, w01, w11]: [f64; 4]| a.orientation * w00 + n0 * w10 + b.orientation * w01 + n1 * w11;
        Turning {
            quaternion: mix(hermite(s)),
            rate: mix(hermite_slope(s).map(|d| d / duration)),
            curvature: mix(hermite_curvature(s).map(|c| c / (duration * duration))),
        }
    }
}

/// Returns the four cubic Hermite polynomials at `s`: those for the value and the slope at the start, then those for the value and the
/// slope at the end.
fn hermite(s: f64) -> [f64; 4] {
    let r = 1.0 - s;
    [(1.0 + 2.0 * s) * r * r, s * r * r, s * s * (3.0 - 2.0 * s), -s * s * r]
}

/// Returns the first derivatives of the four cubic Hermite polynomials at `s`.
fn hermite_slope(s: f64) -> [f64; 4] {
    let r = 1.0 - s;
    [-6.0 * s * r, r * (1.0 - 3.0 * s), 6.0 * s * r, s * (3.0 * s - 2.0)]
}

/// Returns the second derivatives of the four cubic Hermite polynomials at `s`.
fn hermite_curvature(s: f64) -> [f64; 4] {
    [12.0 * s - 6.0, 6.0 * s - 4.0, 6.0 - 12.0 * s, 6.0 * s - 2.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a key of a body that moves on a unit circle and rotates with it, at 1 rad/s. With `known`, the key has velocities.
    fn key(t: f64, known: bool) -> Keyframe {
        let (sin, cos) = libm::sincos(t);
        Keyframe {
            time: t,
            location: DVec3::new(cos, sin, 0.0),
            orientation: DQuat::from_rotation_z(t),
            velocity: known.then(|| DVec3::new(-sin, cos, 0.0)),
            angular_velocity: known.then_some(DVec3::Z),
        }
    }

    fn circle(interpolation: Interpolation, known: bool, step: f64) -> Track {
        // The keys cover more than a full turn, so the quaternions change their sign.
        let keys = (0..).map(|i| f64::from(i) * step).take_while(|t| *t <= 8.0);
        Track::new(keys.map(|t| key(t, known)).collect(), interpolation, false)
    }

    /// Returns the largest error of position (m) or angle (rad) between keys, in the middle of the track.
    fn error(track: &Track) -> f64 {
        let times = (0..1000).map(|i| 2.0 + f64::from(i) * 0.004);
        let off = |t: f64| {
            let (pose, exact) = (track.at(t), key(t, true));
            let turned = (pose.orientation * exact.orientation.conjugate()).to_scaled_axis().length();
            (pose.location - exact.location).length().max(turned.min(std::f64::consts::TAU - turned))
        };
        times.map(off).fold(0.0, f64::max)
    }

    /// Halving the time between keys divides the error by 2ᵖ. The order p is 2 for linear interpolation, 3 for slopes of parabolas, 4 for
    /// known slopes.
    #[test]
    fn it_goes_through_its_keys_and_is_as_accurate_between_as_its_order_says() {
        use Interpolation::{Cubic, Linear};
        for (interpolation, known, order) in [(Linear, false, 2.0), (Cubic, false, 3.0), (Cubic, true, 4.0)] {
            let track = circle(interpolation, known, 0.1);
            for i in 0..=80 {
                let (pose, exact) = (track.at(f64::from(i) * 0.1), key(f64::from(i) * 0.1, true));
                assert!(pose.location.abs_diff_eq(exact.location, 1e-12));
                assert!(pose.orientation.dot(exact.orientation).abs() > 1.0 - 1e-12);
            }
            let slope = libm::log2(error(&track) / error(&circle(interpolation, known, 0.05)));
            assert!((slope - order).abs() < 0.2, "{interpolation:?} {known}: {slope}");
        }
    }

    /// Compares velocities and accelerations with difference quotients over 2e-6 s, whose rounding error is 1e-16 / 1e-6.
    #[test]
    fn velocities_are_the_derivatives_of_the_place() {
        const H: f64 = 1e-6;
        for track in [circle(Interpolation::Linear, false, 0.3), circle(Interpolation::Cubic, false, 0.3)] {
            for t in [0.1, 1.234, 3.25, 7.4] {
                let (before, here, after) = (track.at(t - H), track.at(t), track.at(t + H));
                let velocity = (after.location - before.location) / (2.0 * H);
                assert!(velocity.abs_diff_eq(here.velocity, 1e-8), "{velocity} {}", here.velocity);
                let acceleration = (after.velocity - before.velocity) / (2.0 * H);
                assert!(
                    acceleration.abs_diff_eq(here.acceleration, 1e-7),
                    "{acceleration} {}",
                    here.acceleration
                );
                let turn = (after.orientation * before.orientation.conjugate()).to_scaled_axis() / (2.0 * H);
                assert!(turn.abs_diff_eq(here.angular_velocity, 1e-8), "{turn} {}", here.angular_velocity);
                let spun = (after.angular_velocity - before.angular_velocity) / (2.0 * H);
                let given = track.angular_acceleration(t);
                assert!(spun.abs_diff_eq(given, 1e-7), "{spun} {given}");
            }
        }
    }

    #[test]
    fn it_rests_before_and_after() {
        let track = circle(Interpolation::Cubic, true, 0.5);
        for (t, end) in [(-1.0, 0.0), (9.0, 8.0)] {
            let pose = track.at(t);
            assert_eq!((pose.velocity, pose.angular_velocity), (DVec3::ZERO, DVec3::ZERO));
            assert_eq!(pose.location, key(end, true).location);
        }
        assert!(track.at(8.0).velocity.length() > 0.9, "at the end it still moves");
        let one = Track::new(vec![key(1.0, false)], Interpolation::Cubic, true);
        assert_eq!(one.at(1.0).location, key(1.0, false).location);
        // At rest at both ends, the motion between two keys accelerates and slows down smoothly.
        let two = Track::new(vec![key(0.0, false), key(1.0, false)], Interpolation::Cubic, true);
        assert_eq!((two.at(0.0).velocity, two.at(1.0).velocity), (DVec3::ZERO, DVec3::ZERO));
        let middle = (key(0.0, false).location + key(1.0, false).location) / 2.0;
        assert!(two.at(0.5).location.abs_diff_eq(middle, 1e-15));
    }
}
