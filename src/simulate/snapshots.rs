//! The frames of a run while it is computed, without recording, drawing or survey.

use super::simulation::Simulation;
use super::{Moments, SimulateError};
use crate::dynamics::{Effort, Snapshot};
use crate::scene::Scene;

/// The frames of a run, each made on demand. They equal those of [`Frames`](super::Frames), bit for bit.
pub struct Snapshots<'a> {
    simulation: Simulation<'a>,
}

impl<'a> Snapshots<'a> {
    /// The frames of a scene from its initial state.
    pub fn new(scene: &'a Scene) -> Snapshots<'a> {
        Snapshots { simulation: Simulation::new(scene, Moments::none(scene), &Effort::default()) }
    }

    /// The number of timesteps so far.
    pub fn steps(&self) -> u64 {
        self.simulation.steps()
    }
}

impl Iterator for Snapshots<'_> {
    type Item = Result<Snapshot, SimulateError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut seen = None;
        match self.simulation.advance(&mut |entry| seen = Some(entry.snapshot)) {
            Ok(_) => seen.map(Ok),
            Err(error) => Some(Err(error)),
        }
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
        let scene = Scene::parse(text).unwrap();
        let mut snapshots = Snapshots::new(&scene);
        for frame in Frames::new(&scene) {
            let (frame, snapshot) = (frame.unwrap(), snapshots.next().unwrap().unwrap());
            assert_eq!((frame.time, frame.bodies), (snapshot.time, snapshot.bodies));
        }
        assert!(snapshots.next().is_none());
        assert_eq!(snapshots.steps(), 20);
    }
}
