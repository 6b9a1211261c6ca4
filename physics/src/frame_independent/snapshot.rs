//! Makes snapshots of runs with adaptive methods: the bodies and their energy at one moment.

use super::super::{Balance, BodySnapshot, Snapshot};
use super::FrameIndependent;

impl<S> FrameIndependent<S> {
    /// Returns the snapshot at the requested time, with the given energy balance.
    pub(super) fn picture(&mut self, balance: Balance) -> Snapshot {
        let FrameIndependent { model, state, loads, time, .. } = self;
        model.evaluate(*time, state, loads);
        model.guide(*time, loads);
        let bodies = BodySnapshot::of_all(model, state, loads);
        Snapshot { time: *time, bodies, balance, ..Snapshot::default() }
    }
}
