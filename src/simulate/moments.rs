//! The requested times between frames: for ghosts, open shutters and still images.

use crate::scene::{Scene, Shutter, Timeline};

/// The requested times between frames. They follow from the scene and from single times that the caller requests. They do not affect the
/// run.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    /// The intervals between ghosts, s.
    intervals: Vec<f64>,
    shutters: Vec<Shutter>,
    /// Single requested times, s.
    others: Vec<f64>,
    timeline: Timeline,
}

impl Moments {
    /// Collects all times that the pictures of a scene need: those of ghosts and those of open shutters.
    pub fn of(scene: &Scene) -> Moments {
        let cameras = scene.views.iter().map(|view| &view.camera).chain([&scene.camera]);
        let mut shutters: Vec<Shutter> = Vec::new();
        for shutter in cameras.filter_map(|camera| camera.shutter) {
            if !shutters.contains(&shutter) {
                shutters.push(shutter);
            }
        }
        Moments { shutters, ..Moments::of_ghosts(scene) }
    }

    /// Collects only the times of ghosts.
    pub fn of_ghosts(scene: &Scene) -> Moments {
        let mut intervals: Vec<f64> =
            scene.bodies.iter().filter_map(|body| Some(body.showing.ghosts?.every)).collect();
        intervals.sort_by(f64::total_cmp);
        intervals.dedup();
        let timeline = scene.simulation.timeline;
        Moments { intervals, shutters: Vec::new(), others: Vec::new(), timeline }
    }

    /// Creates an empty list of times: the run has only frames.
    pub(super) fn none(scene: &Scene) -> Moments {
        Moments { intervals: Vec::new(), ..Moments::of_ghosts(scene) }
    }

    /// Adds a time (s), and the sample times of cameras whose shutters open then. The time of a frame adds nothing, so a still image of a
    /// frame needs no new simulation.
    #[must_use]
    pub fn with(mut self, time: f64) -> Moments {
        if self.timeline.is_frame(time) {
            return self;
        }
        let times: Vec<f64> = self.times_of(time).collect();
        self.others.extend(times);
        self
    }

    /// Returns a time (s), and the sample times of cameras whose shutters open then.
    pub(super) fn times_of(&self, time: f64) -> impl Iterator<Item = f64> {
        let opened = self.shutters.iter().flat_map(move |shutter| shutter.moments(time));
        std::iter::once(time).chain(opened)
    }

    /// The sorted times after a frame and before the next frame, s. After the last frame, a time that equals the end of the interval is
    /// included, too.
    pub(super) fn after(&self, frame: usize) -> Vec<f64> {
        let [begin, end] = [frame, frame + 1].map(|frame| self.timeline.time(frame));
        let is_within = |time: &f64| {
            *time > begin && (*time < end || (*time == end && frame + 1 >= self.timeline.frames()))
        };
        let mut times: Vec<f64> = self.others.iter().copied().filter(is_within).collect();
        for shutter in &self.shutters {
            // A shutter closes at the next frame at the latest. By rounding errors, it may close just after this frame, so the shutter of
            // the frame before counts, too.
            for opened in frame.saturating_sub(1)..=frame.min(self.timeline.frames() - 1) {
                times.extend(shutter.moments(self.timeline.time(opened)).filter(is_within));
            }
        }
        let slack = self.timeline.slack();
        for &every in &self.intervals {
            let mut number = ((begin + slack) / every).floor().max(0.0);
            while number * every < end - slack {
                if number * every > begin + slack {
                    times.push(number * every);
                }
                number += 1.0;
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The number of intervals between frames that must be simulated to reach all requested times.
    pub(super) fn intervals(&self) -> usize {
        let last = self.timeline.frames() - 1;
        let open = self.shutters.iter().map(|shutter| shutter.open).fold(0.0, f64::max);
        let latest = self.others.iter().copied().fold(0.0, f64::max).max(self.timeline.time(last) + open);
        let latest = if open > 0.0 || !self.others.is_empty() { latest } else { self.timeline.time(last) };
        let mut intervals = last;
        while self.timeline.time(intervals) < latest {
            intervals += 1;
        }
        intervals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(keys: &str) -> Scene {
        Scene::parse(&format!(
            "simulation = {{ duration = 0.4, frame_rate = 10 }}\n[body.ball]\nshape.sphere.radius = 1\n{keys}"
        ))
        .unwrap()
    }

    #[test]
    fn ghosts_stand_between_frames_and_not_at_them() {
        let moments = Moments::of(&scene("ghosts.every = 0.05"));
        assert_eq!(moments.after(0), [0.05]);
        assert_eq!(moments.after(2), [0.25]);
        assert_eq!(moments.intervals(), 4);
    }

    #[test]
    fn a_shutter_is_open_after_each_frame_also_the_last() {
        let moments = Moments::of(&scene("[camera]\nshutter = 0.08\nsamples = 2"));
        let near = |found: &[f64], expected: &[f64]| {
            found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        for (frame, expected) in [(0, [0.02, 0.06]), (1, [0.12, 0.16]), (4, [0.42, 0.46])] {
            assert!(near(&moments.after(frame), &expected), "{:?}", moments.after(frame));
        }
        assert!(moments.after(5).is_empty());
        assert_eq!(moments.intervals(), 5);
        // A shutter that opens between two frames may close after the second one.
        let moments = moments.with(0.15);
        assert!(near(&moments.after(1), &[0.12, 0.15, 0.16, 0.17]), "{:?}", moments.after(1));
        assert!(near(&moments.after(2), &[0.21, 0.22, 0.26]), "{:?}", moments.after(2));
    }

    #[test]
    fn a_single_time_is_seen_wherever_it_is() {
        let moments = Moments::of(&scene("")).with(0.123);
        assert_eq!(moments.after(1), [0.123]);
        assert!(moments.after(0).is_empty() && moments.after(2).is_empty());
        // A requested time that equals a frame's time adds nothing, so the run of the scene serves.
        let own = Moments::of(&scene(""));
        assert_eq!(own.clone().with(0.2), own);
        assert_ne!(own.clone().with(0.5), own, "there is no frame at this time");
    }
}
