//! The separation of neighbours: a twin of the run starts very near it, and the growth of their distance distinguishes regular motion
//! from chaos.
//!
//! The criterion is MEGNO, the mean exponential growth of nearby orbits (P. M. Cincotta, C. Simó, *Astronomy and Astrophysics Supplement*
//! 147, 205, 2000): with the distance d, Y(t) = (2/t) ∫ (ḋ/d) s ds, and its mean over time. If d grows like tⁿ, Y is 2n, so 2 for most
//! regular motion. If d grows like exp(λt), the mean of Y is λt/2.

use glam::DVec3;
use serde::Serialize;

use super::measure::Measured;
use crate::scene::Scene;

/// The initial distance of the twin, as a fraction of the size of the scene.
pub(super) const APART: f64 = 1e-9;

/// Beyond this fraction of the size of the scene, the two no longer count as neighbours.
const FAR: f64 = 0.02;

/// Above this mean of Y the motion is chaotic: a distance that grows like t² has 4.
const CHAOTIC: f64 = 5.0;

/// Below this mean of Y the motion is regular.
const REGULAR: f64 = 3.5;

/// If the distance grows by more than this factor, the motion is not regular, whatever the mean of Y.
const LARGE: f64 = 1e4;

/// The separation of neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Parting {
    /// Unknown: nothing could be displaced, or there were too few frames.
    Unknown,
    /// No faster than in regular motion.
    Regular {
        /// The ratio of their final distance to their initial one.
        growth: f64,
    },
    /// Faster than in regular motion, but the run is too short to tell whether this continues.
    Unclear {
        /// The ratio of their final distance to their initial one.
        growth: f64,
    },
    /// Within a short time, by impacts.
    Sudden {
        /// The time at which they stop being neighbours, s.
        time: f64,
    },
    /// Exponentially.
    Chaotic {
        /// The time in which the distance grows by the factor e, s.
        lyapunov_time: f64,
        /// The time in which it doubles, s.
        doubling_time: f64,
    },
}

/// The scene of the twin: moving bodies start at slightly different positions with slightly different velocities. Bodies with contacts
/// get only different velocities, so that none overlap. Plane motion stays in its plane.
pub(super) fn displaced(scene: &Scene, measured: &Measured) -> Scene {
    let mut twin = scene.clone();
    let starts = || scene.bodies.iter().map(|body| body.start.location);
    let Some(min) = starts().reduce(DVec3::min) else { return twin };
    let max = starts().fold(min, DVec3::max);
    let end = scene.simulation.end();
    let fastest = scene.bodies.iter().map(|body| body.start.velocity.length()).fold(0.0, f64::max);
    let widest = scene.bodies.iter().filter_map(|body| body.shape.bounding_radius()).fold(0.0, f64::max);
    let pull = scene.simulation.gravity.length();
    // The speeds are not known yet; an order of magnitude is enough.
    let size = match (max - min).length() {
        0.0 => widest + (fastest + pull * end) * end,
        size => size,
    };
    let free = axes_of_motion(scene, measured);
    let (apart, touches) = (APART * size, scene.simulation.contacts.is_some());
    for (number, &id) in measured.bodies.iter().enumerate() {
        let start = &mut twin.bodies[id].start;
        if !touches {
            start.location += apart * direction(3 * number, free);
        }
        let faster = apart / end;
        start.velocity += faster * direction(3 * number + 1, free);
        // In plane motion, bodies rotate only about its normal.
        let about = if free == DVec3::ONE { free } else { DVec3::ONE - free };
        start.angular_velocity += APART / end * direction(3 * number + 2, about);
    }
    twin
}

/// The axes of a plane motion, 1 each, and 0 for the normal: axes along which something moves, is pulled, or differs in position. All are
/// 1 if the motion is not plane.
fn axes_of_motion(scene: &Scene, measured: &Measured) -> DVec3 {
    let mut free = DVec3::ZERO;
    let mut first = None;
    for &id in &measured.bodies {
        let start = &scene.bodies[id].start;
        let from = start.location - *first.get_or_insert(start.location);
        // Only a body with an orientation and a rotation about one axis stays in a plane.
        let turns = start.angular_velocity;
        let in_plane = DVec3::new(turns.y.abs() + turns.z.abs(), turns.x.abs() + turns.z.abs(), 0.0)
            + DVec3::Z * (turns.x.abs() + turns.y.abs());
        free += from.abs() + start.velocity.abs() + start.force.abs() + in_plane;
    }
    free += scene.simulation.gravity.abs();
    let free = DVec3::from_array(free.to_array().map(|extent| f64::from(u8::from(extent > 0.0))));
    // A body with a given motion may lead others anywhere, and a body that moves along a line lies in many planes.
    let is_led = scene.bodies.iter().any(|body| body.motion.is_some());
    if is_led || free.element_sum() < 2.0 { DVec3::ONE } else { free }
}

/// Directions that are spread over the sphere, within the free axes; the same in every run.
fn direction(number: usize, free: DVec3) -> DVec3 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    #[allow(clippy::cast_precision_loss, reason = "any number will do")]
    let part = (number as f64 + 0.5) * GOLDEN % 1.0;
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * (17.0 * part % 1.0));
    let height = 1.8 * part - 0.9;
    let around = (1.0 - height * height).sqrt();
    (DVec3::new(around * cos, height, around * sin) * free).normalize_or_zero()
}

/// The separation of neighbours from their distances at some times, s; a distance of 1 is the size of the scene. Also returns the mean of
/// Y, which is 0 if unknown.
pub(super) fn parting(times: &[f64], distances: &[f64]) -> (Parting, f64) {
    /// With fewer moments than this, the result is unknown.
    const FEW: usize = 8;
    let near = distances.iter().position(|distance| *distance > FAR).unwrap_or(distances.len());
    let begin = distances.iter().position(|distance| *distance > 0.0).unwrap_or(near);
    let seen: Vec<(f64, f64)> = (begin..near)
        .filter(|&k| distances[k] > 0.0)
        .map(|k| (times[k] - times[begin], libm::log(distances[k])))
        .collect();
    let (Some(first), Some(last)) = (seen.first(), seen.last()) else { return (Parting::Unknown, 0.0) };
    if seen.len() < FEW {
        return (Parting::Unknown, 0.0);
    }
    let growth = libm::exp(last.1 - first.1);
    let ((mean, late), slope) = (megno(&seen), slope(&seen));
    let found = if mean > CHAOTIC && slope > 0.0 {
        Parting::Chaotic { lyapunov_time: 1.0 / slope, doubling_time: std::f64::consts::LN_2 / slope }
    } else if near < distances.len() && growth > LARGE {
        Parting::Sudden { time: times[near] }
    } else if mean.max(late) > REGULAR || growth > LARGE {
        Parting::Unclear { growth }
    } else {
        Parting::Regular { growth }
    };
    (found, mean)
}

/// The mean of Y over time, and over the second half of it, from times from 0 on (s) and logarithms of distances.
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

/// The slope of the best-fitting line, 1/s.
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

    fn of(distance: impl Fn(f64) -> f64) -> Parting {
        let times: Vec<f64> = (0..500).map(|k| 0.04 * f64::from(k)).collect();
        let distances: Vec<f64> = times.iter().map(|t| 1e-9 * distance(*t)).collect();
        parting(&times, &distances).0
    }

    #[test]
    fn exponential_growth_is_told_from_powers_of_time() {
        assert!(matches!(of(|_| 1.0), Parting::Regular { growth: 1.0 }));
        assert!(matches!(of(|t| 1.0 + 50.0 * t), Parting::Regular { .. }));
        // An orbit: the distance grows with time, and is a hundred times larger near the sun.
        let orbit = |t: f64| (1.0 + 30.0 * t) * (1.0 + 99.0 * libm::pow(libm::cos(t), 20.0));
        assert!(matches!(of(orbit), Parting::Regular { .. }), "{:?}", of(orbit));
        assert!(matches!(of(|t| 1.0 + 30.0 * t * t), Parting::Regular { .. } | Parting::Unclear { .. }));
        let chaos = |t: f64| libm::exp(1.5 * t) * (1.2 + libm::sin(5.0 * t));
        let Parting::Chaotic { lyapunov_time, doubling_time } = of(chaos) else { panic!("{:?}", of(chaos)) };
        assert!((1.5 * lyapunov_time - 1.0).abs() < 0.05, "{lyapunov_time}");
        assert!((doubling_time / lyapunov_time - std::f64::consts::LN_2).abs() < 1e-12);
    }

    #[test]
    fn an_impact_that_tears_neighbours_apart_is_no_regular_motion() {
        let torn = |t: f64| if t < 5.0 { 1.0 } else { libm::exp(60.0 * (t - 5.0)) };
        let Parting::Sudden { time } = of(torn) else { panic!("{:?}", of(torn)) };
        assert!((time - 5.28).abs() < 0.05, "{time}");
        assert!(matches!(
            of(|t| if t < 5.0 { 1.0 } else { 1e5 }),
            Parting::Unclear { .. } | Parting::Chaotic { .. }
        ));
    }

    #[test]
    fn what_nobody_can_see_part_is_not_known() {
        assert_eq!(of(|_| 0.0), Parting::Unknown);
        assert_eq!(of(|_| 1e9), Parting::Unknown);
        assert_eq!(parting(&[], &[]).0, Parting::Unknown);
    }

    #[test]
    fn a_twin_of_a_motion_in_a_plane_stays_in_it() {
        let text = "simulation.gravity = [0, -9.81, 0]\n[body.a]\nshape.sphere.radius = 0.1\nlocation = [1, 0, 0]\n\
                    [body.b]\nshape.sphere.radius = 0.1\nlocation = [2, 0, 0]\n";
        let scene = Scene::parse(text).unwrap();
        let twin = displaced(&scene, &Measured::of(&scene));
        for (one, two) in scene.bodies.iter().zip(&twin.bodies) {
            let by = two.start.location - one.start.location;
            assert!(by.z == 0.0 && (by.length() - 1e-9).abs() < 1e-15, "{by}");
            assert!(two.start.velocity.z == 0.0 && two.start.velocity != DVec3::ZERO);
        }
    }
}
