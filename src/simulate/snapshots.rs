//! An iterator over the frames of a run, without recording, trails, particles or survey.

use super::simulation::Simulation;
use super::{Moments, SimulateError};
use crate::physics::{PairCounter, Snapshot};
use crate::scene::Scene;

/// An iterator over the states of a run at its frames. The states equal those of [`Frames`](super::Frames), bit for bit.
pub struct Snapshots<'a> {
    simulation: Simulation<'a>,
}

impl<'a> Snapshots<'a> {
    /// Simulates the frames of a scene from its initial state, on demand.
    pub fn new(scene: &'a Scene) -> Snapshots<'a> {
        Snapshots { simulation: Simulation::new(scene, Moments::none(scene), &PairCounter::default()) }
    }

    /// The number of timesteps since the start of the run.
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
