//! What can be known of a moment.

use super::super::{Balance, BodySnapshot, Snapshot};
use super::Ahead;

impl<S> Ahead<S> {
    /// The bodies as they are at the time that has been asked for.
    pub(super) fn picture(&mut self, balance: Balance) -> Snapshot {
        let Ahead { model, state, loads, time, .. } = self;
        model.evaluate(*time, state, loads);
        model.guide(*time, loads);
        let body = |id: usize| BodySnapshot {
            id,
            location: state.location[id],
            orientation: model.world_from_body(id, state),
            velocity: state.velocity[id],
            angular_velocity: model.angular_velocity(id, state),
            force: loads.force[id],
        };
        let bodies = (0..state.len()).filter(|&id| model.is_present(id)).map(body).collect();
        Snapshot { time: *time, bodies, balance, ..Snapshot::default() }
    }
}
