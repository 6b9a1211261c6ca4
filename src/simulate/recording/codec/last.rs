//! The numbers of the last moment, relative to which the next is written and read.

use super::{AT_REST, Counts, JOINT_NUMBERS, NUMBERS};

/// The numbers of the last moment. Before the first moment of a page, bodies are at rest at the origin, and joints are without load.
#[derive(Default)]
pub(super) struct Last {
    pub(super) bodies: Vec<[f64; NUMBERS]>,
    pub(super) joints: Vec<[f64; JOINT_NUMBERS]>,
    pub(super) impacts: Vec<f64>,
}

impl Last {
    /// The numbers at the start of a page.
    pub(super) fn new(Counts { bodies, joints, impacts }: Counts) -> Last {
        Last {
            bodies: vec![AT_REST; bodies],
            joints: vec![[0.0; JOINT_NUMBERS]; joints],
            impacts: vec![0.0; impacts],
        }
    }

    /// Restarts at the start of a page.
    pub(super) fn begin_page(&mut self) {
        self.bodies.fill(AT_REST);
        self.joints.fill([0.0; JOINT_NUMBERS]);
        self.impacts.fill(0.0);
    }
}
