//! Checked scene → world → frames.
//!
//! This is the only place where a [`Scene`] meets the [`dynamics`](crate::dynamics).

mod build;
mod frame;
mod labour;
mod lag;
mod moments;
mod overlap;
mod reach;
mod selection;
mod span;
mod survey;
mod track;
mod vectors;

use self::track::Track;
use crate::dynamics::{Dynamics, Effort};
use crate::scene::Scene;

pub use build::world;
pub use frame::{BodyFrame, Frame};
pub use labour::Labour;
pub use lag::Lagging;
pub use moments::Branch;
pub use overlap::Overlap;
pub use reach::Reach;
pub use selection::Selection;
pub use span::{Bounds, Span};
pub use survey::{Crossing, Survey, Surveyor, survey, survey_watched};
pub use track::{Ghost, Passed, Past, Way};
pub(crate) use vectors::anchors;
pub use vectors::{axis, root, shown, surface};

/// A run of a scene: its frames, one after another, each made when it is asked for.
///
/// The scene knows the initial state, so a run that begins again is another `Frames` of the same scene, and it
/// gives the same frames bit for bit.
pub struct Frames<'a> {
    scene: &'a Scene,
    dynamics: Box<dyn Dynamics>,
    next: usize,
    track: Track,
}

/// That a run left the numbers: what is asked for cannot be computed with this step and method.
#[derive(Clone, Debug, PartialEq)]
pub struct Diverged {
    /// The name of the first body that has no finite place or velocity.
    pub body: String,
    /// The time of the frame, s.
    pub time: f64,
}

impl<'a> Frames<'a> {
    /// The frames of a scene from its initial state.
    pub fn new(scene: &'a Scene) -> Frames<'a> {
        Frames::watched(scene, &Effort::default())
    }

    /// The same frames; the interactions of pairs are counted while they are made.
    pub fn watched(scene: &'a Scene, effort: &Effort) -> Frames<'a> {
        let mut world = world(scene);
        world.watch(effort);
        Frames { scene, dynamics: Box::new(world), next: 0, track: Track::new(scene) }
    }

    /// The same frames, which remember nothing of what has been before.
    fn without_track(self) -> Frames<'a> {
        Frames { track: Track::idle(), ..self }
    }

    /// What is to be seen at any time of the run, s: at that of a frame, the frame, bit for bit; else what is between
    /// two. A time before the beginning is the beginning, one after the end is the end.
    ///
    /// # Errors
    /// Where the run leaves the numbers before.
    pub fn at(scene: &Scene, time: f64) -> Result<Frame, Diverged> {
        Branch::at(scene, time)?.frame()
    }

    /// The run from the frame on that was asked for last, or from the beginning, to be looked at without touching it.
    pub fn branch(&self) -> Branch<'a> {
        // After the end, or a frame that is none, there is no further one.
        let frames = self.scene.simulation.frames();
        let index = self.next.min(frames).saturating_sub(1);
        Branch::new(self.scene, self.dynamics.as_ref(), index, &self.track)
    }

    /// Starts over, as the space key does in a simulation with a window.
    pub fn reset(&mut self) {
        *self = Frames::new(self.scene);
    }
}

impl Iterator for Frames<'_> {
    type Item = Result<Frame, Diverged>;

    fn next(&mut self) -> Option<Self::Item> {
        let index = self.next;
        if index >= self.scene.simulation.frames() {
            return None;
        }
        let time = self.scene.simulation.time(index);
        self.track.pass(self.dynamics.as_ref(), time);
        self.dynamics.advance_to(time);
        let mut frame = Frame::of(self.dynamics.as_mut(), index, time).checked(self.scene);
        if let Ok(frame) = &mut frame {
            self.track.note(frame);
            frame.past = self.track.before(frame);
        }
        // After what is not finite, nothing could be.
        self.next = if frame.is_ok() { index + 1 } else { usize::MAX };
        Some(frame)
    }
}

impl std::fmt::Display for Diverged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the run diverged: at t = {} s `{}` is at no finite place", self.time, self.body)
    }
}

impl std::error::Error for Diverged {}

#[cfg(test)]
mod tests {
    use super::*;

    const TUMBLE: &str = "
        [simulation]
        duration = 1
        gravity = [0, -9.81, 0]
        [body.box]
        shape.box.size = [3, 1, 2]
        angular_velocity = [0.1, 0.2, 5]
        torque = [1, 0, 0]
        ";

    #[test]
    fn a_run_after_a_reset_is_the_first_run_bit_for_bit() {
        for method in crate::dynamics::METHODS {
            let set = crate::scene::Override::new(format!("simulation.integrator={}", method.name));
            let options = crate::scene::Options { overrides: vec![set], ..Default::default() };
            let scene = Scene::parse_with(TUMBLE, &options).unwrap();
            let mut frames = Frames::new(&scene);
            let first: Vec<Frame> = frames.by_ref().map(Result::unwrap).collect();
            assert_eq!(first.len(), 26);
            assert_ne!(first[0].bodies, first[25].bodies);
            frames.reset();
            assert_eq!(frames.map(Result::unwrap).collect::<Vec<_>>(), first, "{}", method.name);
        }
    }

    /// The same brick, whole and in two halves whose common frame is turned against it, tumbles the same.
    #[test]
    fn a_compound_tumbles_as_the_solid_that_it_makes_up() {
        let tumble = |shape: &str, orientation: &str| {
            let text = format!(
                "
                [simulation]
                duration = 2
                integrator = 'rk4'
                [body.brick]
                mass = 2
                angular_velocity = [0.3, 0.2, 3]
                torque = [0.1, 0, 0]
                shape.{shape}
                orientation = {orientation}
                "
            );
            let scene = Scene::parse(&text).unwrap();
            let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
            (frames[0].bodies[0], frames[50].bodies[0])
        };
        let turn = glam::DQuat::from_rotation_z(30f64.to_radians());
        let (_, whole) = tumble("box.size = [3, 1, 2]", "[0, 0, 30]");
        let half = |x: f64| {
            let place = turn * glam::DVec3::new(x, 0.0, 0.0) + 5.0;
            format!("{{ box.size = [1.5, 1, 2], orientation = [0, 0, 30], location = {place} }}")
        };
        let parts = format!("compound.parts = [{}, {}]", half(-0.75), half(0.75));
        let (first, halves) = tumble(&parts, "[0, 0, 0]");
        assert!(first.orientation.abs_diff_eq(glam::DQuat::IDENTITY, 1e-15), "{}", first.orientation);
        assert!(halves.angular_velocity.abs_diff_eq(whole.angular_velocity, 1e-9));
        let whole = whole.orientation * turn.conjugate();
        assert!((halves.orientation.dot(whole).abs() - 1.0).abs() < 1e-9, "{whole} {}", halves.orientation);
    }

    #[test]
    fn frames_know_their_time_and_the_forces() {
        let scene = Scene::parse(TUMBLE).unwrap();
        let last = Frames::new(&scene).last().unwrap().unwrap();
        assert_eq!((last.index, last.time), (25, 1.0));
        assert_eq!(last.bodies[0].force, glam::DVec3::new(0.0, -9.81, 0.0));
    }

    #[test]
    fn a_run_that_leaves_the_numbers_ends_there() {
        let text = "
            simulation.integrator = 'explicit-euler'
            [body.far]
            shape.sphere.radius = 1
            location = [1, 0, 0]
            [force.spring]
            spring = { between = ['far', [0, 0, 0]], stiffness = 1e50, rest_length = 0 }
            ";
        let scene = Scene::parse(text).unwrap();
        let frames: Vec<_> = Frames::new(&scene).collect();
        let Some(Err(diverged)) = frames.last() else { panic!("the run did not diverge") };
        assert_eq!(diverged.body, "far");
        assert!(frames.len() < 251 && frames[..frames.len() - 1].iter().all(Result::is_ok));
    }
}
