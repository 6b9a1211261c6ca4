//! An iterator over the frames of a run, without recording, trails, particles or survey.

use std::collections::VecDeque;

use super::simulation::Simulation;
use super::{Moments, SimulateError};
use crate::physics::{PairCounter, Snapshot};
use crate::scene::Scene;

/// An iterator over the states of a run at its frames. The states equal those of [`Frames`](super::Frames), bit for bit.
pub struct Snapshots<'a> {
    simulation: Simulation<'a>,
    /// The frames that have been simulated and not returned. An interval has several or none if the film has a speed of its own.
    waiting: VecDeque<Snapshot>,
}

impl<'a> Snapshots<'a> {
    /// Simulates the frames of a scene from its initial state, on demand.
    pub fn new(scene: &'a Scene) -> Snapshots<'a> {
        let simulation = Simulation::new(scene, Moments::none(scene), &PairCounter::default());
        Snapshots { simulation, waiting: VecDeque::new() }
    }

    /// The number of timesteps since the start of the run.
    pub fn steps(&self) -> u64 {
        self.simulation.steps()
    }
}

impl Iterator for Snapshots<'_> {
    type Item = Result<Snapshot, SimulateError>;

    fn next(&mut self) -> Option<Self::Item> {
        let Snapshots { simulation, waiting } = self;
        while waiting.is_empty() {
            match simulation.advance(&mut |entry| waiting.push_back(entry.snapshot)) {
                Ok(true) => {}
                Ok(false) => break,
                Err(error) => return Some(Err(error)),
            }
        }
        waiting.pop_front().map(Ok)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Frames;
    use super::*;

    #[test]
    fn they_are_the_frames_without_the_moments_between() {
        let text = "simulation = { duration = 0.4, step = 0.02, gravity = [0, -1, 0] }\n[body.ball]\n\
                    shape.sphere.radius = 1\nvelocity = [1, 2, 3]\nghosts.every = 0.03\n";
        for speed in ["1", "3", "0.3", "[[0, 1], [0.2, 0.1], [0.3, 4]]"] {
            let scene = Scene::parse(&format!("output.speed = {speed}\n{text}")).unwrap();
            let mut snapshots = Snapshots::new(&scene);
            for frame in Frames::new(&scene) {
                let (frame, snapshot) = (frame.unwrap(), snapshots.next().unwrap().unwrap());
                assert_eq!((frame.time, frame.bodies), (snapshot.time, snapshot.bodies), "{speed}");
            }
            assert!(snapshots.next().is_none(), "{speed}");
            assert_eq!(snapshots.steps(), 20, "{speed}");
        }
    }
}
