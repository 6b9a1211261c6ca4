//! Points that follow bodies. Cameras look at these points if they follow a body with a lag, or a body that is sometimes absent.

use glam::DVec3;

use super::Frame;
use crate::scene::Scene;

/// A point that follows a body: x' = (b − x) / τ, where b is the location of the body. The point stays in place while the body is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lagging {
    /// The index of the body.
    pub body: usize,
    /// The time constant τ, s: the delay behind a body with constant velocity. If 0, the point is at the last known location of the body.
    pub lag: f64,
    /// The position of the point, m.
    pub location: DVec3,
    /// The time of the last frame with the body present (s), and the location of the body in that frame (m).
    seen: Option<(f64, DVec3)>,
}

impl Lagging {
    /// Creates the points that a scene's cameras need, at the start of the run.
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

    /// True if the point follows this body with this lag (s).
    #[allow(clippy::float_cmp, reason = "it is the very number of the scene")]
    pub fn is_of(&self, body: usize, lag: f64) -> bool {
        self.body == body && self.lag == lag
    }

    /// Advances the point to `frame`, which must not be earlier than the last frame. The result is exact if the body has a constant
    /// velocity between frames.
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

    /// Behind a body that moves from 0 at speed v, the point is at x = v (t − τ + τ e^(−t/τ)), for any frame rate.
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
            // The formula also holds between frames.
            let between = Frames::at(&scene, 1.23).unwrap();
            let exact = 3.0 * (1.23 - 0.5 + 0.5 * libm::exp(-1.23 / 0.5));
            assert!((between.past.lagging[0].location.x - exact).abs() < 1e-12);
        }
    }
}
