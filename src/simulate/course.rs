//! Where the moving bodies are in the course of a run, for a camera that goes along with them.

use super::Bounds;
use crate::scene::Scene;

/// The largest number of stretches of a course.
const MAX_STRETCHES: usize = 512;

/// A short time of a run, and where its moving bodies are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The time of the first frame, s.
    pub from: f64,
    /// The time of the last frame, s.
    pub until: f64,
    /// The box around all particles and all bodies that are not fixed, m.
    pub bounds: Bounds,
}

impl Stretch {
    /// The middle of the stretch in time, s.
    pub fn middle(&self) -> f64 {
        (self.from + self.until) / 2.0
    }
}

/// Collects the course of a run, frame by frame.
pub(super) struct Course {
    /// The duration of a stretch, s.
    duration: f64,
    stretches: Vec<Stretch>,
}

impl Course {
    pub(super) fn new(scene: &Scene) -> Course {
        let timeline = &scene.simulation.timeline;
        let frames_per_stretch = timeline.frames().div_ceil(MAX_STRETCHES).max(1);
        #[allow(clippy::cast_precision_loss, reason = "there are fewer frames than a number can count")]
        let frames = frames_per_stretch as f64;
        let duration = if timeline.speed.is_even() {
            // Half of an interval keeps rounding errors away from the ends of stretches.
            (frames - 0.5) * timeline.interval()
        } else {
            timeline.end() / MAX_STRETCHES as f64
        };
        Course { duration, stretches: Vec::new() }
    }

    /// Adds a part of what moves at the time of a frame (s).
    pub(super) fn see(&mut self, time: f64, here: Bounds) {
        match self.stretches.last_mut().filter(|last| time - last.from < self.duration) {
            Some(last) => {
                last.until = time;
                last.bounds = last.bounds.union(here);
            }
            None => self.stretches.push(Stretch { from: time, until: time, bounds: here }),
        }
    }

    /// The stretches of the run, in order. Times at which nothing moves are left out.
    pub(super) fn finish(self) -> Vec<Stretch> {
        self.stretches
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::simulate::survey;

    /// A run of 2,001 frames has fewer stretches, which together have the box around all that moves.
    #[test]
    fn a_course_is_the_motion_in_at_most_so_many_parts() {
        let scene = |duration: f64| {
            let text = format!(
                "simulation = {{ duration = {duration}, frame_rate = 100 }}\n\
                 [body.ball]\nshape.sphere.radius = 0.5\nvelocity = [1, 0, 0]\n\
                 [body.wall]\nshape.box.size = [1, 9, 9]\nlocation = [-30, 0, 0]\nfixed = true"
            );
            Scene::parse(&text).unwrap()
        };
        let course = survey(&scene(20.0), |_| {}).unwrap().course;
        assert!((400..=MAX_STRETCHES).contains(&course.len()), "{}", course.len());
        assert!(course.windows(2).all(|pair| pair[0].until < pair[1].from));
        let all = course.iter().map(|stretch| stretch.bounds).reduce(Bounds::union).unwrap();
        assert!(all.min == DVec3::splat(-0.5) && (all.max.x - 20.5).abs() < 1e-9, "{all:?}");
        let course = survey(&scene(0.1), |_| {}).unwrap().course;
        assert_eq!(course.len(), 11, "a stretch for each frame");
        assert!(course.iter().all(|stretch| stretch.from == stretch.until));
    }
}
