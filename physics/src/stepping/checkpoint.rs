//! Checkpoints: one moment of a run as bytes, from which the run continues with the same bits.
//!
//! A checkpoint holds everything that changes with time: the state, the accounts, the presence of bodies, and the physics engine with its
//! contacts. Everything constant follows from the scene.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{ColliderHandle, PhysicsWorld};
use serde::{Deserialize, Serialize};

use super::super::{EnergyLedger, State};
use super::TimeStepping;
use super::engine_input::EngineInput;
use super::fresh_contacts;
use super::rebound::Rebound;

/// Everything in a run that changes with time, except the physics engine.
#[derive(Serialize, Deserialize)]
struct Moment {
    time: f64,
    steps: u64,
    state: State,
    ledger: EnergyLedger,
    /// The number of births and deaths up to this moment.
    over: usize,
    /// The index of each absent body, with the velocity (m/s) and the angular momentum (kg m²/s) that it will have when it returns.
    away: Vec<(usize, DVec3, DVec3)>,
    /// Pairs of colliders that are near each other, and between which no contact force has acted yet.
    near: Vec<[ColliderHandle; 2]>,
    /// The bodies that have appeared since the last step.
    newcomers: Vec<usize>,
    /// The orientation of each body when the engine last found its contacts anew because of its rotation.
    orientation: Vec<DQuat>,
    /// The location of each round body when the engine last found its contacts anew because it had moved, m.
    location: Vec<DVec3>,
    /// The largest speed of sliding at the contacts of each body in the last step, m/s.
    sliding: Vec<f64>,
    /// The rebounds of the next step.
    rebounds: Vec<Rebound>,
}

impl TimeStepping {
    /// Returns the present moment of the run as bytes; `None` after a failure, or if impacts have not been taken yet.
    pub(super) fn save(&mut self) -> Option<Vec<u8>> {
        if self.failure.is_some() || !self.books.impacts.is_empty() {
            return None;
        }
        let moment = Moment {
            time: self.time,
            steps: self.steps,
            state: self.state.clone(),
            ledger: self.ledger.clone(),
            over: self.calendar.over(),
            away: self.model.away(),
            near: self.books.impacts.near.clone(),
            newcomers: self.newcomers.clone(),
            orientation: self.kept_contacts.orientation.clone(),
            location: self.kept_contacts.location.clone(),
            sliding: self.sliding.speed.clone(),
            rebounds: self.rebounds.due.clone(),
        };
        postcard::to_stdvec(&(moment, &self.engine)).ok()
    }

    /// Restores a saved moment. Returns false and changes nothing if the bytes do not belong to this run.
    pub(super) fn load(&mut self, bytes: &[u8]) -> bool {
        let Ok((moment, mut engine)) = postcard::from_bytes::<(Moment, PhysicsWorld)>(bytes) else {
            return false;
        };
        let bodies = self.model.len();
        let is_ours = moment.state.len() == bodies
            && moment.orientation.len() == bodies
            && moment.location.len() == bodies
            && moment.sliding.len() == bodies
            && moment.away.iter().all(|(body, ..)| *body < bodies)
            && self.handles.iter().all(|handle| engine.bodies.contains(*handle));
        if !is_ours {
            return false;
        }
        let Moment {
            time,
            steps,
            state,
            ledger,
            over,
            away,
            near,
            newcomers,
            orientation,
            location,
            sliding,
            rebounds,
        } = moment;
        self.newcomers = newcomers;
        fresh_contacts::find_contacts_anew(&mut engine);
        self.kept_contacts.resume(&engine, orientation, location);
        self.model.set_away(&away, &mut self.state);
        self.calendar.set_over(over);
        (self.time, self.steps, self.state, self.ledger) = (time, steps, state, ledger);
        self.books.impacts.near = near;
        self.sliding.speed = sliding;
        self.rebounds.set_due(rebounds);
        self.inputs = EngineInput::read_all(&engine, &self.handles);
        self.rolling.resume(&engine, &self.handles);
        self.engine = engine;
        true
    }
}
