//! The smallest distances so far between the centers of pairs of bodies.
//!
//! The locations and velocities are known at frames. Between two frames, the way from one body to the other is the cubic through them, on
//! which the smallest distance lies at an end or where way and velocity are perpendicular. If one of the bodies was hit between two frames,
//! its path has a corner that is not known here, so only the distances at the frames count.

use std::sync::Arc;

use glam::DVec3;

use super::{Frame, ImpactCounts};
use crate::physics::{BodySnapshot, find};
use crate::scene::Scene;

/// Collects the smallest distances of pairs of bodies, frame by frame.
#[derive(Clone, Default)]
pub(super) struct Approaches {
    pairs: Arc<[[usize; 2]]>,
    /// The way from the first to the second body of each pair at the last frame. `None` while one of them was absent.
    last: Vec<Option<Way>>,
    /// The smallest distance of each pair so far, m. NaN before both bodies have been present.
    closest: Vec<f64>,
}

/// The way from one body to another.
#[derive(Clone, Copy)]
struct Way {
    /// The time, s.
    time: f64,
    /// The way, m.
    way: DVec3,
    /// Its rate of change, m/s.
    rate: DVec3,
    /// The number of impacts of the two bodies so far.
    impacts: f64,
}

impl Approaches {
    /// Begins at the start of a run.
    pub(super) fn new(scene: &Scene) -> Approaches {
        let count = scene.approaches.len();
        Approaches {
            pairs: scene.approaches.as_slice().into(),
            last: vec![None; count],
            closest: vec![f64::NAN; count],
        }
    }

    /// The smallest distance of each pair so far, m. NaN before both bodies have been present.
    pub(super) fn closest(&self) -> &[f64] {
        &self.closest
    }

    pub(super) fn into_closest(self) -> Vec<f64> {
        self.closest
    }

    /// Goes on to a frame, or to a moment after the last frame.
    pub(super) fn note(&mut self, frame: &Frame) {
        for ((pair, last), closest) in self.pairs.iter().zip(&mut self.last).zip(&mut self.closest) {
            let now = Way::of(*pair, frame.time, &frame.bodies, &frame.impacts);
            let before = std::mem::replace(last, now);
            let Some(now) = now else { continue };
            *closest = closest.min(now.way.length());
            if let Some(before) = before.filter(|before| before.impacts == now.impacts) {
                *closest = closest.min(before.shortest_towards(&now));
            }
        }
    }
}

impl Way {
    fn of([from, to]: [usize; 2], time: f64, bodies: &[BodySnapshot], impacts: &ImpactCounts) -> Option<Way> {
        let (a, b) = (find(bodies, from)?, find(bodies, to)?);
        Some(Way {
            time,
            way: b.location - a.location,
            rate: b.velocity - a.velocity,
            impacts: impacts.of_body(from) + impacts.of_body(to),
        })
    }

    /// The smallest length (m) on the cubic to the way at the next frame.
    fn shortest_towards(&self, next: &Way) -> f64 {
        /// The number of parts in which a turning point is looked for. A cubic approaches a point at most three times.
        const SEARCHED_PARTS: u32 = 8;
        /// The number of halvings of a part: enough for all digits.
        const MAX_HALVINGS: u32 = 50;
        let parts = (0..SEARCHED_PARTS)
            .map(|part| [part, part + 1].map(|end| f64::from(end) / f64::from(SEARCHED_PARTS)));
        let approaches = |part: f64| {
            let (way, rate) = self.towards(next, part);
            way.dot(rate)
        };
        let turn = |[mut from, mut to]: [f64; 2]| {
            if !(approaches(from) < 0.0 && approaches(to) >= 0.0) {
                return f64::INFINITY;
            }
            for _ in 0..MAX_HALVINGS {
                let middle = 0.5 * (from + to);
                if approaches(middle) < 0.0 { from = middle } else { to = middle }
            }
            self.towards(next, to).0.length()
        };
        parts.map(turn).fold(f64::INFINITY, f64::min)
    }

    /// The way and its rate of change at a part, from 0 to 1, of the time to the next frame, on Hermite's cubic.
    fn towards(&self, next: &Way, s: f64) -> (DVec3, DVec3) {
        let span = next.time - self.time;
        let (s2, s3) = (s * s, s * s * s);
        let way = (2.0 * s3 - 3.0 * s2 + 1.0) * self.way
            + (s3 - 2.0 * s2 + s) * span * self.rate
            + (3.0 * s2 - 2.0 * s3) * next.way
            + (s3 - s2) * span * next.rate;
        let rate = (6.0 * s2 - 6.0 * s) / span * (self.way - next.way)
            + (3.0 * s2 - 4.0 * s + 1.0) * self.rate
            + (3.0 * s2 - 2.0 * s) * next.rate;
        (way, rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Frames, survey};

    /// Returns the value of the plot's curve at the end of the run.
    fn at_end(text: &str) -> f64 {
        let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
        let curves = survey(&scene, |_| {}).unwrap().curves;
        let last = curves[0].last().unwrap().at.unwrap()[1];
        let frame = Frames::at(&scene, scene.simulation.timeline.end()).unwrap();
        assert_eq!(frame.past.closest, [last], "a frame alone has the value of the whole run");
        last
    }

    /// A line at the distance 2 m from the origin: its nearest point lies between two frames.
    #[test]
    fn the_nearest_point_of_a_straight_line_is_found_between_frames() {
        for start in [-3.0, -3.1, -3.17] {
            let value = at_end(&format!(
                "simulation = {{ duration = 2, frame_rate = 2 }}
                [body.a]\nshape.sphere.radius = 0.1\nfixed = true
                [body.b]\nshape.sphere.radius = 0.1\nlocation = [{start}, 2, 0]\nvelocity = [4, 0, 0]
                [plot.p]\ny = 'b.closest.a'"
            ));
            assert!((value - 2.0).abs() < 1e-12, "{value}");
        }
    }

    /// A comet on an ellipse passes the sun at a (1 − e) = 0.1 m, in a small part of its period of 2 s.
    #[test]
    fn a_comet_is_nearest_at_its_perihelion() {
        let text = |rate: f64| {
            format!(
                "simulation = {{ duration = 2, frame_rate = {rate}, step = 0.0001, integrator = 'yoshida4' }}
                [body.sun]\nshape.sphere.radius = 0.01\nfixed = true\nmass = 1\nlocation = [1, 2, 3]
                [body.comet]\nshape.sphere.radius = 0.01\nmass = 1e-6\nlocation = [2.9, 2, 3]
                velocity = [0, 'pi*sqrt(0.1/1.9)', 0]
                [force.gravity.gravitation]\nconstant = 'pi^2'\n[plot.p]\ny = 'sun.closest.comet'"
            )
        };
        // The perihelion lies at 1 s, which is a frame at 100 Hz and none at the other rates. At the perihelion, the comet turns by 137 rad/s.
        // The cubic has an error of about r (ω h)⁴ / 384: up to 3e-3 m with h = 0.013 s, and 1e-5 m with a quarter of that.
        let [exact, coarse, fine] = [100.0, 77.3, 309.2].map(|rate| (at_end(&text(rate)) - 0.1).abs());
        assert!(exact < 1e-7, "{exact}");
        assert!(fine < 2e-5 && coarse < 1e-2 && coarse > 20.0 * fine, "{coarse} {fine}");
    }

    /// Balls that collide between two frames are never nearer than their radii allow.
    #[test]
    fn an_impact_between_frames_is_not_passed_through() {
        let value = at_end(
            "simulation = { duration = 1, frame_rate = 7, contacts = 'event-driven' }
            environment.ground = false
            [body.a]\nshape.sphere.radius = 0.5\nfixed = true
            [body.b]\nshape.sphere.radius = 0.5\nlocation = [3, 0, 0]\nvelocity = [-4, 0, 0]\nrestitution = 1
            [plot.p]\ny = 'b.closest.a'",
        );
        assert!((1.0..1.0 + 4.0 / 7.0).contains(&value), "{value}");
    }
}
