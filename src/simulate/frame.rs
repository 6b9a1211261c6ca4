//! What can be seen at one moment.

use super::Past;
use crate::dynamics::{Balance, BodySnapshot, ContactSnapshot, Reaction, Snapshot, find};

/// What can be seen at one moment of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Its number, from 0.
    pub index: usize,
    /// Its time, s.
    pub time: f64,
    /// The bodies that are there, in the order of the scene.
    pub bodies: Vec<BodySnapshot>,
    /// What the joints do to the bodies, in the order of the scene.
    pub reactions: Vec<Reaction>,
    /// Where bodies touch and stay in touch.
    pub contacts: Vec<ContactSnapshot>,
    /// Energies, momenta and the drift.
    pub balance: Balance,
    /// What has been before, as far as the scene asks for it.
    pub past: Past,
}

impl Frame {
    /// The frame of a moment, without what has been before.
    pub fn of(index: usize, moment: Snapshot) -> Frame {
        let Snapshot { time, bodies, reactions, contacts, balance } = moment;
        Frame { index, time, bodies, reactions, contacts, balance, past: Past::default() }
    }

    /// A body, by its number in the scene; none if it is not there.
    pub fn body(&self, id: usize) -> Option<&BodySnapshot> {
        find(&self.bodies, id)
    }
}
