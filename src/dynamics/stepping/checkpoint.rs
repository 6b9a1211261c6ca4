//! A moment of a run as bytes, from which the run goes on with the same bits.
//!
//! It holds all that changes with time: the state, the books, which bodies are there, and the engine with its contacts. All else
//! follows from the scene.

use glam::DVec3;
use rapier3d_f64::prelude::{ColliderHandle, PhysicsWorld};
use serde::{Deserialize, Serialize};

use super::super::{EnergyLedger, State};
use super::TimeStepping;

/// All that changes with time but the engine.
#[derive(Serialize, Deserialize)]
struct Moment {
    time: f64,
    steps: u64,
    state: State,
    ledger: EnergyLedger,
    /// The number of past births and deaths.
    over: usize,
    /// The bodies that are not there, with the velocity (m/s) and the angular momentum (kg m²/s) with which they will come.
    away: Vec<(usize, DVec3, DVec3)>,
    /// Colliders that have come near each other, and have not pushed yet.
    near: Vec<[ColliderHandle; 2]>,
}

impl TimeStepping {
    /// The present moment; none after a failure, or where impacts wait to be asked for.
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

    /// Goes on from a moment that was saved; false where it is not one of this run.
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
