//! What is seen between frames: exact states of the run, which the run itself does not notice.

use super::track::Track;
use super::{Diverged, Frame, Frames};
use crate::dynamics::Dynamics;
use crate::scene::{Scene, Shutter};

/// A run from one of its moments on, which goes its own way: the frames of the run are the same bits whether or not
/// anybody looks between them.
pub struct Branch<'a> {
    scene: &'a Scene,
    dynamics: Box<dyn Dynamics>,
    /// The number of the frame at which it has branched off, or after which.
    index: usize,
    /// The time of the moment at which it has branched off, s.
    begin: f64,
    /// What has been up to the frame.
    track: Track,
    /// The run at the frame, if somebody asks how it was between then and now.
    origin: Option<Box<dyn Dynamics>>,
}

impl<'a> Branch<'a> {
    pub(super) fn new(scene: &'a Scene, dynamics: &dyn Dynamics, index: usize, track: &Track) -> Branch<'a> {
        Branch {
            scene,
            dynamics: dynamics.branch(),
            index,
            begin: dynamics.time(),
            track: track.clone(),
            origin: track.has_ghosts().then(|| dynamics.branch()),
        }
    }

    /// The moment that it has reached, with what has been before.
    fn here(&mut self) -> Result<Frame, Diverged> {
        let time = self.dynamics.time();
        let mut frame = Frame::of(self.dynamics.as_mut(), self.index, time).checked(self.scene)?;
        frame.past = match &self.origin {
            None => self.track.before(&frame),
            Some(origin) => {
                let mut track = self.track.clone();
                track.pass(origin.as_ref(), time);
                track.before(&frame)
            }
        };
        Ok(frame)
    }

    /// The run from any of its moments on; from that of a frame on it is the branch of the frame. A time (s) before
    /// the beginning is the beginning, one after the end is the end.
    ///
    /// # Errors
    /// Where the run leaves the numbers before.
    pub fn at(scene: &'a Scene, time: f64) -> Result<Branch<'a>, Diverged> {
        let simulation = &scene.simulation;
        let last = simulation.frames() - 1;
        let end = simulation.duration.max(simulation.time(last));
        let time = if time > 0.0 { time.min(end) } else { 0.0 };
        let mut frames = Frames::new(scene);
        for index in 0..=last {
            frames.next().transpose()?;
            if index == last || simulation.time(index + 1) > time {
                break;
            }
        }
        let mut branch = frames.branch();
        branch.begin = time;
        branch.dynamics.advance_to(time);
        Ok(branch)
    }

    /// The moment that it has reached. It has the number of the frame at or before the moment at which the branch
    /// began.
    ///
    /// # Errors
    /// Where the run has left the numbers.
    pub fn frame(&mut self) -> Result<Frame, Diverged> {
        self.here()
    }

    /// The moments at which a camera looks while its shutter is open, from where the branch began, each simulated when
    /// it is asked for. They may be later than the last frame.
    pub fn moments(mut self, shutter: Shutter) -> impl Iterator<Item = Result<Frame, Diverged>> + 'a {
        shutter.moments(self.begin).map(move |time| {
            self.dynamics.advance_to(time);
            self.here()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::METHODS;
    use crate::scene::{Options, Override};

    const SCENE: &str = "
        [simulation]
        duration = 0.4
        gravity = [0, -9.81, 0]
        step = 0.007
        [body.box]
        shape.box.size = [3, 1, 2]
        angular_velocity = [0.1, 0.2, 5]
        [body.ball]
        shape.sphere.radius = 1
        location = [9, 0, 0]
        [force.air.drag]
        quadratic = 0.3
        [force.spring.spring]
        between = ['box', 'ball']
        stiffness = 50
        ";

    const SHUTTER: Shutter = Shutter { open: 0.03, samples: 5 };

    fn scenes() -> impl Iterator<Item = Scene> {
        METHODS.iter().map(|method| {
            let overrides = vec![Override::new(format!("simulation.integrator={}", method.name))];
            Scene::parse_with(SCENE, &Options { overrides, ..Options::default() }).unwrap()
        })
    }

    #[test]
    fn a_run_that_is_looked_at_between_its_frames_is_the_same_bit_for_bit() {
        for scene in scenes() {
            let sharp: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
            let mut frames = Frames::new(&scene);
            let mut looked_at = Vec::new();
            while let Some(frame) = frames.next() {
                let moments = frames.branch().moments(SHUTTER);
                assert_eq!(moments.map(Result::unwrap).count(), 5);
                // Also by a branch that is abandoned half-way.
                assert!(frames.branch().moments(SHUTTER).nth(1).is_some());
                looked_at.push(frame.unwrap());
            }
            // Places, velocities, energies, momenta and drift.
            assert_eq!(looked_at, sharp, "{}", scene.simulation.method.name);
        }
    }

    #[test]
    fn moments_are_evenly_spread_over_the_time_that_the_shutter_is_open() {
        let scene = scenes().next().unwrap();
        let mut frames = Frames::new(&scene);
        let last = frames.by_ref().last().unwrap().unwrap();
        assert_eq!((last.index, last.time), (10, 0.4));
        let moments: Vec<Frame> = frames.branch().moments(SHUTTER).map(Result::unwrap).collect();
        let times: Vec<f64> = moments.iter().map(|moment| moment.time).collect();
        let near = |(time, expected): (&f64, f64)| (time - expected).abs() < 1e-12;
        assert!(times.iter().zip([0.403, 0.409, 0.415, 0.421, 0.427]).all(near), "{times:?}");
        assert!(moments.iter().all(|moment| moment.index == 10));
    }

    /// A body that spins evenly without a force is where it must be, to rounding, whatever the method.
    #[test]
    fn moments_are_states_of_the_motion_and_not_something_between() {
        let text = "
            simulation.duration = 0.2
            [body.ball]
            shape.sphere.radius = 1
            velocity = [3, 0, 0]
            angular_velocity = [0, 0, 40]
            ";
        let scene = Scene::parse(text).unwrap();
        let mut frames = Frames::new(&scene);
        frames.nth(3);
        for moment in frames.branch().moments(SHUTTER) {
            let Frame { time, bodies, .. } = moment.unwrap();
            assert!((bodies[0].location.x - 3.0 * time).abs() < 1e-12);
            let expected = glam::DQuat::from_rotation_z(40.0 * time);
            assert!((bodies[0].orientation.dot(expected).abs() - 1.0).abs() < 1e-12, "at {time}");
        }
    }

    #[test]
    fn at_the_time_of_a_frame_there_is_the_frame_and_between_two_what_is_between() {
        for scene in scenes() {
            let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
            for frame in &frames {
                assert_eq!(Frames::at(&scene, frame.time).as_ref(), Ok(frame));
            }
            let between = Frames::at(&scene, 0.21).unwrap();
            assert_eq!((between.index, between.time), (5, 0.21));
            let height = |frame: &Frame| frame.bodies[0].location.y;
            assert!(height(&frames[5]) > height(&between) && height(&between) > height(&frames[6]));
            // What is before the beginning or after the end.
            for (time, index) in [(-1.0, 0), (f64::NAN, 0), (7.0, 10)] {
                assert_eq!(Frames::at(&scene, time).as_ref(), Ok(&frames[index]));
            }
        }
    }

    #[test]
    fn the_moments_of_a_frame_are_those_of_its_time() {
        for scene in scenes() {
            let mut frames = Frames::new(&scene);
            let frame = frames.nth(4).unwrap().unwrap();
            let of_frame: Vec<_> = frames.branch().moments(SHUTTER).collect();
            let of_time: Vec<_> = Branch::at(&scene, frame.time).unwrap().moments(SHUTTER).collect();
            assert_eq!(of_frame, of_time);
        }
    }
}
