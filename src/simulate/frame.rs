//! The state of a run at one moment.

use super::simulation::Entry;
use super::{ImpactCounts, Past, Swarm};
use crate::dynamics::{Balance, BodySnapshot, ContactSnapshot, Reaction, Snapshot, find};

/// The state of a run at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Its number, from 0.
    pub index: usize,
    /// Its time, s.
    pub time: f64,
    /// The present bodies, in the order of the scene.
    pub bodies: Vec<BodySnapshot>,
    /// The reactions of the joints on the bodies, in the order of the scene.
    pub reactions: Vec<Reaction>,
    /// The lasting contacts.
    pub contacts: Vec<ContactSnapshot>,
    /// The greatest penetration of bodies, m.
    pub penetration: f64,
    /// Energies, momenta and the drift.
    pub balance: Balance,
    /// The numbers of impacts so far.
    pub impacts: ImpactCounts,
    /// The living particles, for each emitter in the order of the scene.
    pub particles: Vec<Swarm>,
    /// The remembered past.
    pub past: Past,
}

impl Frame {
    /// The frame of a moment, with the impacts up to it, but without particles and past.
    pub fn of(index: usize, moment: Snapshot) -> Frame {
        let Snapshot { time, bodies, reactions, contacts, penetration, balance } = moment;
        let (impacts, past, particles) = (ImpactCounts::default(), Past::default(), Vec::new());
        Frame { index, time, bodies, reactions, contacts, penetration, balance, impacts, particles, past }
    }

    /// The frame of a moment of a run, without its past.
    pub(super) fn of_entry(index: usize, entry: Entry) -> Frame {
        Frame { impacts: entry.counts, ..Frame::of(index, entry.snapshot) }
    }

    /// A body, by its index in the scene; `None` if it is absent.
    pub fn body(&self, id: usize) -> Option<&BodySnapshot> {
        find(&self.bodies, id)
    }
}
