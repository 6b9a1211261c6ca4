//! The state of a run at one moment.

use super::simulation::Entry;
use super::{ImpactCounts, Past, Swarm};
use crate::physics::{Balance, BodySnapshot, ContactSnapshot, LawResidual, Reaction, Snapshot, find};

/// The state of a run at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The number of the frame, counted from 0. For a moment between two frames, the number of the earlier frame.
    pub index: usize,
    /// The time of the frame, s.
    pub time: f64,
    /// The bodies that are present in the frame, in the order of the scene.
    pub bodies: Vec<BodySnapshot>,
    /// The constraint force and torque of each joint on its second body, in the order of the scene.
    pub reactions: Vec<Reaction>,
    /// The angle of each joint, counted through full turns, rad; 0 for a joint without an angle.
    pub angles: Vec<f64>,
    /// The contacts that persist at this time, with their forces.
    pub contacts: Vec<ContactSnapshot>,
    /// The largest penetration between two bodies, m.
    pub penetration: f64,
    /// The worst residual so far of each law that no contact can break. Empty without event-driven contacts.
    pub laws: Vec<LawResidual>,
    /// The energies and momenta of the system, and its energy error.
    pub balance: Balance,
    /// The numbers of impacts from the start to this frame.
    pub impacts: ImpactCounts,
    /// The living particles of each emitter, in the order of the scene.
    pub particles: Vec<Swarm>,
    /// The earlier positions of bodies, for trails, ghosts and following cameras.
    pub past: Past,
}

impl Frame {
    /// Creates a frame from a snapshot of the dynamics. Its impact counts, particles and past are empty.
    pub fn of(index: usize, moment: Snapshot) -> Frame {
        let Snapshot { time, bodies, reactions, angles, contacts, penetration, laws, balance } = moment;
        let (impacts, past, particles) = (ImpactCounts::default(), Past::default(), Vec::new());
        Frame {
            index,
            time,
            bodies,
            reactions,
            angles,
            contacts,
            penetration,
            laws,
            balance,
            impacts,
            particles,
            past,
        }
    }

    /// Creates a frame from a moment of a run, with its impact counts. Its particles and its past are empty.
    pub(super) fn of_entry(index: usize, entry: Entry) -> Frame {
        Frame { impacts: entry.counts, ..Frame::of(index, entry.snapshot) }
    }

    /// Finds a body by its index in the scene. `None` if the body is absent in this frame.
    pub fn body(&self, id: usize) -> Option<&BodySnapshot> {
        find(&self.bodies, id)
    }
}
