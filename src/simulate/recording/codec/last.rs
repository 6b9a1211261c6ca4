//! The values of the previous moment. The encoder writes, and the decoder reads, only the differences from them.

use super::{AT_REST, Counts, NUMBERS_PER_BODY, NUMBERS_PER_JOINT};

/// The values of the previous moment. At the start of a page, bodies are at rest at the origin, joints have no load, and impact counts are
/// 0.
#[derive(Default)]
pub(super) struct Last {
    pub(super) bodies: Vec<[f64; NUMBERS_PER_BODY]>,
    pub(super) joints: Vec<[f64; NUMBERS_PER_JOINT]>,
    pub(super) impacts: Vec<f64>,
}

impl Last {
    /// Creates the values for the start of a page.
    pub(super) fn new(Counts { bodies, joints, impacts }: Counts) -> Last {
        Last {
            bodies: vec![AT_REST; bodies],
            joints: vec![[0.0; NUMBERS_PER_JOINT]; joints],
            impacts: vec![0.0; impacts],
        }
    }

    /// Resets the values of the previous moment for the start of a page.
    pub(super) fn begin_page(&mut self) {
        self.bodies.fill(AT_REST);
        self.joints.fill([0.0; NUMBERS_PER_JOINT]);
        self.impacts.fill(0.0);
    }
}
