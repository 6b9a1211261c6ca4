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
        let timeline = scene.simulation.timeline.clone();
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
        if self.timeline.frame_at(time).is_some() {
            return self;
        }
        let times: Vec<f64> = self.times_of(time).collect();
        self.others.extend(times);
        self
    }

    /// Returns a time (s), and the sample times of cameras whose shutters open then.
    pub(super) fn times_of(&self, time: f64) -> impl Iterator<Item = f64> {
        let opened = self.shutters.iter().flat_map(move |shutter| self.timeline.exposure(*shutter, time));
        std::iter::once(time).chain(opened)
    }

    /// The sorted times within an interval, s, including those of frames. The end of the interval is included if it is not the time of a frame.
    pub(super) fn within(&self, interval: usize) -> Vec<f64> {
        let [begin, end] = [interval, interval + 1].map(|interval| self.timeline.interval_start(interval));
        let ends_at_frame = self.timeline.frame_at(end).is_some();
        let is_within = |time: &f64| *time > begin && (*time < end || (*time == end && !ends_at_frame));
        let mut times: Vec<f64> = self.others.iter().copied().filter(is_within).collect();
        let frames = self.timeline.frames_within(begin, end).map(|frame| self.timeline.time(frame));
        let frames: Vec<f64> = frames.filter(is_within).collect();
        times.extend(&frames);
        for shutter in &self.shutters {
            let speed = &self.timeline.speed;
            let earliest = speed.time(speed.film_time(begin) - self.timeline.interval() - shutter.open);
            for opened in self.timeline.frames_within(earliest, end) {
                times.extend(self.timeline.exposure(*shutter, self.timeline.time(opened)).filter(is_within));
            }
        }
        let slack = self.timeline.slack();
        for &every in &self.intervals {
            let mut number = ((begin + slack) / every).floor().max(0.0);
            while number * every <= end + slack {
                let time = number * every;
                let is_last = time >= end - slack;
                let is_seen = |seen: &f64| (seen - time).abs() <= slack;
                if time > begin + slack && !(is_last && ends_at_frame) && !frames.iter().any(is_seen) {
                    times.push(if is_last { end } else { time });
                }
                number += 1.0;
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The number of intervals that must be simulated to reach all frames and all requested times.
    pub(super) fn intervals(&self) -> usize {
        let end = self.timeline.end();
        let open = self.shutters.iter().map(|shutter| shutter.open).fold(0.0, f64::max);
        let closed = self.timeline.speed.time(self.timeline.speed.film_time(end) + open);
        let latest = self.others.iter().copied().fold(0.0, f64::max).max(closed);
        let latest = if open > 0.0 || !self.others.is_empty() { latest } else { end };
        let mut intervals = self.timeline.intervals_before(end);
        while self.timeline.interval_start(intervals) < latest {
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
        assert_eq!(moments.within(0), [0.05]);
        assert_eq!(moments.within(2), [0.25]);
        assert_eq!(moments.intervals(), 4);
    }

    #[test]
    fn a_shutter_is_open_after_each_frame_also_the_last() {
        let moments = Moments::of(&scene("[camera]\nshutter = 0.08\nsamples = 2"));
        let near = |found: &[f64], expected: &[f64]| {
            found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        for (frame, expected) in [(0, [0.02, 0.06]), (1, [0.12, 0.16]), (4, [0.42, 0.46])] {
            assert!(near(&moments.within(frame), &expected), "{:?}", moments.within(frame));
        }
        assert!(moments.within(5).is_empty());
        assert_eq!(moments.intervals(), 5);
        // A shutter that opens between two frames may close after the second one.
        let moments = moments.with(0.15);
        assert!(near(&moments.within(1), &[0.12, 0.15, 0.16, 0.17]), "{:?}", moments.within(1));
        assert!(near(&moments.within(2), &[0.21, 0.22, 0.26]), "{:?}", moments.within(2));
    }

    /// The film runs at half the speed: every other frame is in the middle of an interval.
    #[test]
    fn slow_motion_has_frames_within_intervals() {
        let scene = scene("[output]\nspeed = 0.5");
        assert_eq!(scene.simulation.timeline.frames(), 9);
        let moments = Moments::of(&scene);
        assert_eq!(moments.intervals(), 4);
        assert_eq!([0, 1].map(|interval| moments.within(interval)), [[0.05], [0.15]]);
    }

    /// Ghosts stand where no frame is, also at the end of an interval, and never twice at the same time.
    #[test]
    fn the_speed_of_the_film_leaves_no_ghost_out() {
        for speed in ["1", "0.5", "2", "3", "0.3", "[[0, 1], [0.2, 0.1], [0.4, 2]]"] {
            let scene = scene(&format!("ghosts.every = 0.1\n[output]\nspeed = {speed}"));
            let last = crate::simulate::Frames::new(&scene).last().unwrap().unwrap();
            let times: Vec<f64> = last.past.ghosts.iter().map(|ghost| ghost.time).collect();
            assert_eq!(last.time, 0.4, "{speed}");
            assert_eq!(times, [0.0, 0.1, 0.2, 3.0 * 0.1], "{speed}");
        }
    }

    /// The film runs at twice the speed: it has a frame at every other interval.
    #[test]
    fn a_fast_film_leaves_intervals_without_frames() {
        let scene = scene("[output]\nspeed = 2");
        assert_eq!(scene.simulation.timeline.frames(), 3);
        let moments = Moments::of(&scene);
        assert_eq!(moments.intervals(), 4);
        assert!((0..4).all(|interval| moments.within(interval).is_empty()));
        assert_eq!(moments.with(0.3).within(2), [0.3], "a still image between two frames");
    }

    #[test]
    fn a_single_time_is_seen_wherever_it_is() {
        let moments = Moments::of(&scene("")).with(0.123);
        assert_eq!(moments.within(1), [0.123]);
        assert!(moments.within(0).is_empty() && moments.within(2).is_empty());
        // A requested time that equals a frame's time adds nothing, so the run of the scene serves.
        let own = Moments::of(&scene(""));
        assert_eq!(own.clone().with(0.2), own);
        assert_ne!(own.clone().with(0.5), own, "there is no frame at this time");
    }
}
