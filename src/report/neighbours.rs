//! Measures how fast neighboring runs separate. A twin of the run starts very close to it; the growth of the distance between the two
//! distinguishes regular motion from chaos.
//!
//! The criterion is MEGNO, the mean exponential growth of nearby orbits (P. M. Cincotta, C. Simó, *Astronomy and Astrophysics Supplement*
//! 147, 205, 2000): with the distance d, Y(t) = (2/t) ∫ (ḋ/d) s ds, and its mean over time. If d grows like tⁿ, Y is 2n, so 2 for most
//! regular motion. If d grows like exp(λt), the mean of Y is λt/2.

use glam::DVec3;
use serde::Serialize;

use super::measure::ComparedBodies;
use crate::scene::Scene;

/// The initial distance between two neighboring runs, as a fraction of the size of the scene.
pub(super) const INITIAL_DISTANCE: f64 = 1e-9;

/// The largest distance at which two runs count as neighbors, as a fraction of the size of the scene.
const MAX_NEIGHBOR_DISTANCE: f64 = 0.02;

/// The largest mean of MEGNO's Y that does not indicate chaos. (A distance that grows like t² gives 4.)
const MAX_NONCHAOTIC_MEGNO: f64 = 5.0;

/// The largest mean of MEGNO's Y that indicates regular motion.
const MAX_REGULAR_MEGNO: f64 = 3.5;

/// The largest growth factor of the distance in regular motion. Beyond it, the motion is not regular, whatever the mean of Y.
const MAX_REGULAR_GROWTH: f64 = 1e4;

/// How two neighboring runs, whose starts differ very slightly, separate with time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Separation {
    /// The separation is unknown, because no body could be displaced or there were too few frames.
    Unknown,
    /// Neighboring runs separate no faster than in regular motion.
    Regular {
        /// The ratio of the final distance between the neighboring runs to the initial one.
        growth: f64,
    },
    /// Neighboring runs separate faster than in regular motion, but the run is too short to show chaos.
    Unclear {
        /// The ratio of the final distance between the neighboring runs to the initial one.
        growth: f64,
    },
    /// Neighboring runs separate within a short time, by impacts.
    Sudden {
        /// The time at which the two runs are too far apart to count as neighbors, s.
        time: f64,
    },
    /// Neighboring runs separate exponentially: the motion is chaotic.
    Chaotic {
        /// The Lyapunov time, in which the distance grows by the factor e, s.
        lyapunov_time: f64,
        /// The time in which the distance doubles, s.
        doubling_time: f64,
    },
}

/// Returns the scene of a neighboring run: the bodies that forces move start at slightly different positions with slightly different
/// velocities. In a scene with contacts, only the velocities differ, so that no bodies overlap. A plane motion stays in its plane.
pub(super) fn displaced(scene: &Scene, measured: &ComparedBodies) -> Scene {
    let mut twin = scene.clone();
    let starts = || scene.bodies.iter().map(|body| body.start.location);
    let Some(min) = starts().reduce(DVec3::min) else { return twin };
    let max = starts().fold(min, DVec3::max);
    let end = scene.simulation.timeline.end();
    let fastest = scene.bodies.iter().map(|body| body.start.velocity.length()).fold(0.0, f64::max);
    let widest = scene.bodies.iter().filter_map(|body| body.shape.bounding_radius()).fold(0.0, f64::max);
    let pull = scene.simulation.gravity.length();
    // If all bodies start at one point, the size follows from the distance that they can travel. Speeds during the run are unknown at this
    // time; an order of magnitude is enough.
    let size = match (max - min).length() {
        0.0 => widest + (fastest + pull * end) * end,
        size => size,
    };
    let free = axes_of_motion(scene, measured);
    let (apart, touches) = (INITIAL_DISTANCE * size, scene.simulation.contacts.is_some());
    for (number, &id) in measured.bodies.iter().enumerate() {
        let start = &mut twin.bodies[id].start;
        if !touches {
            start.location += apart * direction(3 * number, free);
        }
        let faster = apart / end;
        start.velocity += faster * direction(3 * number + 1, free);
        // In a plane motion, bodies rotate only about the normal of the plane.
        let about = if free == DVec3::ONE { free } else { DVec3::ONE - free };
        start.angular_velocity += INITIAL_DISTANCE / end * direction(3 * number + 2, about);
    }
    twin
}

/// Returns 1 for each coordinate axis along which bodies can move, and 0 for the normal of a plane motion. Bodies move along an axis if
/// their positions differ along it or a velocity or force has a component along it. All components are 1 if the motion is not plane.
fn axes_of_motion(scene: &Scene, measured: &ComparedBodies) -> DVec3 {
    let mut free = DVec3::ZERO;
    let mut first = None;
    for &id in &measured.bodies {
        let start = &scene.bodies[id].start;
        let from = start.location - *first.get_or_insert(start.location);
        // A body stays in a plane only if it rotates about the normal of the plane, so a rotation about one axis adds the two other axes.
        let turns = start.angular_velocity;
        let in_plane = DVec3::new(turns.y.abs() + turns.z.abs(), turns.x.abs() + turns.z.abs(), 0.0)
            + DVec3::Z * (turns.x.abs() + turns.y.abs());
        free += from.abs() + start.velocity.abs() + start.force.abs() + in_plane;
    }
    free += scene.simulation.gravity.abs();
    let free = DVec3::from_array(free.to_array().map(|extent| f64::from(u8::from(extent > 0.0))));
    // A body with a prescribed motion may push others anywhere, and a motion along a line lies in many planes.
    let is_led = scene.bodies.iter().any(|body| body.motion.is_some());
    if is_led || free.element_sum() < 2.0 { DVec3::ONE } else { free }
}

/// Returns the unit vector with this number in a fixed sequence of vectors that are spread over the sphere. Components along axes with
/// `free` = 0 are removed first.
fn direction(number: usize, free: DVec3) -> DVec3 {
    /// The reciprocal of the golden ratio. Its multiples are spread evenly over the interval from 0 to 1, without their integer parts.
    const INVERSE_GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;
    #[allow(clippy::cast_precision_loss, reason = "any number will do")]
    let part = (number as f64 + 0.5) * INVERSE_GOLDEN_RATIO % 1.0;
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * (17.0 * part % 1.0));
    let height = 1.8 * part - 0.9;
    let around = (1.0 - height * height).sqrt();
    (DVec3::new(around * cos, height, around * sin) * free).normalize_or_zero()
}

/// Classifies the separation of two neighboring runs. `times` are in s; `distances` are fractions of the size of the scene. Also returns
/// the mean of MEGNO's Y, 0 if unknown.
pub(super) fn parting(times: &[f64], distances: &[f64]) -> (Separation, f64) {
    /// The smallest number of frames for which the separation is classified.
    const MIN_FRAMES: usize = 8;
    let near =
        distances.iter().position(|distance| *distance > MAX_NEIGHBOR_DISTANCE).unwrap_or(distances.len());
    let begin = distances.iter().position(|distance| *distance > 0.0).unwrap_or(near);
    let seen: Vec<(f64, f64)> = (begin..near)
        .filter(|&k| distances[k] > 0.0)
        .map(|k| (times[k] - times[begin], libm::log(distances[k])))
        .collect();
    let (Some(first), Some(last)) = (seen.first(), seen.last()) else { return (Separation::Unknown, 0.0) };
    if seen.len() < MIN_FRAMES {
        return (Separation::Unknown, 0.0);
    }
    let growth = libm::exp(last.1 - first.1);
    let ((mean, late), slope) = (megno(&seen), slope(&seen));
    let found = if mean > MAX_NONCHAOTIC_MEGNO && slope > 0.0 {
        Separation::Chaotic { lyapunov_time: 1.0 / slope, doubling_time: std::f64::consts::LN_2 / slope }
    } else if near < distances.len() && growth > MAX_REGULAR_GROWTH {
        Separation::Sudden { time: times[near] }
    } else if mean.max(late) > MAX_REGULAR_MEGNO || growth > MAX_REGULAR_GROWTH {
        Separation::Unclear { growth }
    } else {
        Separation::Regular { growth }
    };
    (found, mean)
}

/// Returns the mean of MEGNO's Y over all times, and over the second half of them. `seen` holds times from 0 (s) with the logarithms of
/// the distances.
fn megno(seen: &[(f64, f64)]) -> (f64, f64) {
    let end = seen.last().map_or(0.0, |last| last.0);
    let (mut integral, mut sum, mut late) = (0.0, 0.0, 0.0);
    for pair in seen.windows(2) {
        let ([(before, from), (now, to)], middle) = ([pair[0], pair[1]], f64::midpoint(pair[0].0, pair[1].0));
        integral += (to - from) * middle;
        let part = 2.0 * integral / now * (now - before);
        sum += part;
        late += if middle > end / 2.0 { part } else { 0.0 };
    }
    if end > 0.0 { (sum / end, 2.0 * late / end) } else { (0.0, 0.0) }
}

/// Returns the slope of the least-squares line through points of times (s) and logarithms, 1/s.
fn slope(seen: &[(f64, f64)]) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "there are at most a million")]
    let count = seen.len() as f64;
    let (t, y) = seen.iter().fold((0.0, 0.0), |(t, y), point| (t + point.0 / count, y + point.1 / count));
    let [both, square] = seen.iter().fold([0.0; 2], |[both, square], point| {
        [both + (point.0 - t) * (point.1 - y), square + (point.0 - t) * (point.0 - t)]
    });
    if square > 0.0 { both / square } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(distance: impl Fn(f64) -> f64) -> Separation {
        let times: Vec<f64> = (0..500).map(|k| 0.04 * f64::from(k)).collect();
        let distances: Vec<f64> = times.iter().map(|t| 1e-9 * distance(*t)).collect();
        parting(&times, &distances).0
    }

    #[test]
    fn exponential_growth_is_told_from_powers_of_time() {
        assert!(matches!(of(|_| 1.0), Separation::Regular { growth: 1.0 }));
        assert!(matches!(of(|t| 1.0 + 50.0 * t), Separation::Regular { .. }));
        // A planet's orbit: the distance between neighboring runs grows in proportion to time, and is a hundred times larger near the sun.
        let orbit = |t: f64| (1.0 + 30.0 * t) * (1.0 + 99.0 * libm::pow(libm::cos(t), 20.0));
        assert!(matches!(of(orbit), Separation::Regular { .. }), "{:?}", of(orbit));
        assert!(matches!(
            of(|t| 1.0 + 30.0 * t * t),
            Separation::Regular { .. } | Separation::Unclear { .. }
        ));
        let chaos = |t: f64| libm::exp(1.5 * t) * (1.2 + libm::sin(5.0 * t));
        let Separation::Chaotic { lyapunov_time, doubling_time } = of(chaos) else {
            panic!("{:?}", of(chaos))
        };
        assert!((1.5 * lyapunov_time - 1.0).abs() < 0.05, "{lyapunov_time}");
        assert!((doubling_time / lyapunov_time - std::f64::consts::LN_2).abs() < 1e-12);
    }

    #[test]
    fn an_impact_that_tears_neighbours_apart_is_no_regular_motion() {
        let torn = |t: f64| if t < 5.0 { 1.0 } else { libm::exp(60.0 * (t - 5.0)) };
        let Separation::Sudden { time } = of(torn) else { panic!("{:?}", of(torn)) };
        assert!((time - 5.28).abs() < 0.05, "{time}");
        assert!(matches!(
            of(|t| if t < 5.0 { 1.0 } else { 1e5 }),
            Separation::Unclear { .. } | Separation::Chaotic { .. }
        ));
    }

    #[test]
    fn what_nobody_can_see_part_is_not_known() {
        assert_eq!(of(|_| 0.0), Separation::Unknown);
        assert_eq!(of(|_| 1e9), Separation::Unknown);
        assert_eq!(parting(&[], &[]).0, Separation::Unknown);
    }

    #[test]
    fn a_twin_of_a_motion_in_a_plane_stays_in_it() {
        let text = "simulation.gravity = [0, -9.81, 0]\n[body.a]\nshape.sphere.radius = 0.1\nlocation = [1, 0, 0]\n\
                    [body.b]\nshape.sphere.radius = 0.1\nlocation = [2, 0, 0]\n";
        let scene = Scene::parse(text).unwrap();
        let twin = displaced(&scene, &ComparedBodies::of(&scene));
        for (one, two) in scene.bodies.iter().zip(&twin.bodies) {
            let by = two.start.location - one.start.location;
            assert!(by.z == 0.0 && (by.length() - 1e-9).abs() < 1e-15, "{by}");
            assert!(two.start.velocity.z == 0.0 && two.start.velocity != DVec3::ZERO);
        }
    }
}
