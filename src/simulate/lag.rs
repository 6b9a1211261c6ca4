//! Points that follow bodies, for cameras that follow one with a lag, or one that is not always present.

use glam::DVec3;

use super::Frame;
use crate::scene::Scene;

/// A point that follows a body: x' = (b − x) / τ, where b is the location of the body. It stays in place while the body is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lagging {
    /// The number of the body.
    pub body: usize,
    /// The time τ by which it is behind uniform motion, s. Without it, the point is at the last location of the body.
    pub lag: f64,
    /// The position, m.
    pub location: DVec3,
    /// The last time (s), and the location of the body at that time.
    seen: Option<(f64, DVec3)>,
}

impl Lagging {
    /// The points that a scene's cameras need, before the run has begun.
    pub(super) fn of(scene: &Scene) -> Vec<Lagging> {
        let cameras = scene.views.iter().map(|view| &view.camera).chain([&scene.camera]);
        let mut all: Vec<Lagging> = Vec::new();
        for follow in cameras.filter_map(|camera| camera.motion.follow) {
            let body = &scene.bodies[follow.body];
            if follow.lag.is_none() && body.presence.is_always() {
                continue;
            }
            let lag = follow.lag.unwrap_or(0.0);
            if !all.iter().any(|other| other.is_of(follow.body, lag)) {
                all.push(Lagging { body: follow.body, lag, location: body.start.location, seen: None });
            }
        }
        all
    }

    /// Whether it follows this body with this lag, s.
    #[allow(clippy::float_cmp, reason = "it is the very number of the scene")]
    pub fn is_of(&self, body: usize, lag: f64) -> bool {
        self.body == body && self.lag == lag
    }

    /// The point at a frame, which is not earlier. It is exact for a body that moves uniformly between frames.
    #[must_use]
    pub(super) fn at(self, frame: &Frame) -> Lagging {
        let Some(there) = frame.body(self.body).map(|body| body.location) else { return self };
        let location = match self.seen {
            None => there,
            Some((time, _)) if frame.time <= time => self.location,
            Some((time, before)) => {
                let interval = frame.time - time;
                let behind = (there - before) / interval * self.lag;
                let fades = libm::exp(-interval / self.lag);
                there - behind + (self.location - before + behind) * fades
            }
        };
        Lagging { location, seen: Some((frame.time, there)), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Frames;
    use super::*;

    /// Behind a body that moves at v from 0 on: x = v (t − τ + τ e^(−t/τ)), for any frame rate.
    #[test]
    fn it_is_behind_by_its_lag_when_the_body_moves_evenly() {
        for rate in [5, 50] {
            let scene = Scene::parse(&format!(
                "
                simulation = {{ duration = 2, frame_rate = {rate} }}
                [body.car]
                shape.box.size = [1, 1, 1]
                velocity = [3, 0, 0]
                [camera]
                follow = {{ body = 'car', lag = 0.5 }}
                "
            ))
            .unwrap();
            for frame in Frames::new(&scene).map(Result::unwrap) {
                let exact = 3.0 * (frame.time - 0.5 + 0.5 * libm::exp(-frame.time / 0.5));
                let x = frame.past.lagging[0].location.x;
                assert!((x - exact).abs() < 1e-12, "{rate} {}: {x}, not {exact}", frame.time);
            }
            // Also between frames.
            let between = Frames::at(&scene, 1.23).unwrap();
            let exact = 3.0 * (1.23 - 0.5 + 0.5 * libm::exp(-1.23 / 0.5));
            assert!((between.past.lagging[0].location.x - exact).abs() < 1e-12);
        }
    }
}
