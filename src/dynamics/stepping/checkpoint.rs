//! A moment of a run as bytes, from which the run continues with the same bits.
//!
//! A checkpoint holds everything that changes with time: the state, the accounts, the presence of bodies, and the engine with its
//! contacts. The rest follows from the scene.

use glam::DVec3;
use rapier3d_f64::prelude::{ColliderHandle, PhysicsWorld};
use serde::{Deserialize, Serialize};

use super::super::{EnergyLedger, State};
use super::TimeStepping;

/// Everything that changes with time, except the engine.
#[derive(Serialize, Deserialize)]
struct Moment {
    time: f64,
    steps: u64,
    state: State,
    ledger: EnergyLedger,
    /// The number of past births and deaths.
    over: usize,
    /// The absent bodies, with the velocity (m/s) and the angular momentum (kg m²/s) of their return.
    away: Vec<(usize, DVec3, DVec3)>,
    /// Pairs of colliders that have come near each other, and have not pushed yet.
    near: Vec<[ColliderHandle; 2]>,
}

impl TimeStepping {
    /// Saves the present moment. `None` after a failure, or while impacts have not been taken.
    pub(super) fn save(&mut self) -> Option<Vec<u8>> {
        if self.failure.is_some() || self.books.has_impacts() {
            return None;
        }
        let moment = Moment {
            time: self.time,
            steps: self.steps,
            state: self.state.clone(),
            ledger: self.ledger.clone(),
            over: self.calendar.over(),
            away: self.model.away(),
            near: self.books.near.clone(),
        };
        postcard::to_stdvec(&(moment, &self.engine)).ok()
    }

    /// Continues from a saved moment. Returns false if it does not belong to this run.
    pub(super) fn load(&mut self, bytes: &[u8]) -> bool {
        let Ok((moment, engine)) = postcard::from_bytes::<(Moment, PhysicsWorld)>(bytes) else {
            return false;
        };
        let bodies = self.model.len();
        let is_ours = moment.state.len() == bodies
            && moment.away.iter().all(|(body, ..)| *body < bodies)
            && self.handles.iter().all(|handle| engine.bodies.contains(*handle));
        if !is_ours {
            return false;
        }
        let Moment { time, steps, state, ledger, over, away, near } = moment;
        self.model.set_away(&away, &mut self.state);
        self.calendar.set_over(over);
        (self.time, self.steps, self.state, self.ledger) = (time, steps, state, ledger);
        self.books.near = near;
        self.engine = engine;
        true
    }
}
