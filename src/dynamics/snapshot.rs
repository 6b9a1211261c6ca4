//! The state of all bodies at one moment.

use glam::{DQuat, DVec3};

use super::{Balance, BodyId, ContactSnapshot, Loads, Model, Reaction, State, Undefined};

/// All bodies at one moment of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// The time, s.
    pub time: f64,
    /// The present bodies, in the order of their ids.
    pub bodies: Vec<BodySnapshot>,
    /// The reactions of constraints on the bodies, in the order in which they were added.
    pub reactions: Vec<Reaction>,
    /// The lasting contacts, in the order of the ids of their bodies.
    pub contacts: Vec<ContactSnapshot>,
    /// The greatest penetration of bodies, m; 0 if contacts are exact, or there are none.
    pub penetration: f64,
    /// Energies, momenta and the drift.
    pub balance: Balance,
}

/// A body at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodySnapshot {
    /// The number of the body in the world.
    pub id: usize,
    /// Its centre of mass, m.
    pub location: DVec3,
    /// The rotation from its own axes to the world's.
    pub orientation: DQuat,
    /// Its velocity, m/s.
    pub velocity: DVec3,
    /// Its angular velocity in world axes, rad/s.
    pub angular_velocity: DVec3,
    /// The sum of the forces on it, N; m a if its motion is given.
    pub force: DVec3,
}

impl BodySnapshot {
    /// The present bodies, in the order of their ids. `loads` has the sums of the forces on them.
    pub(super) fn of_all(model: &Model, state: &State, loads: &Loads) -> Vec<BodySnapshot> {
        let body = |id: usize| BodySnapshot {
            id,
            location: state.location[id],
            orientation: model.world_from_body(id, state),
            velocity: state.velocity[id],
            angular_velocity: model.angular_velocity(id, state),
            force: loads.force[id],
        };
        (0..state.len()).filter(|&id| model.is_present(id)).map(body).collect()
    }
}

/// The reason why a run cannot continue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Breakdown {
    /// A body's position or velocity is not finite: the method cannot follow this motion with this step.
    Diverged {
        /// The body.
        body: BodyId,
        /// The time, s.
        time: f64,
    },
    /// A force on a body has no finite value, so its motion has none either.
    Undefined {
        /// The index of the force, in the order in which forces were added.
        force: usize,
        /// The body, the time and the position.
        at: Undefined,
    },
    /// A constraint cannot be kept.
    Broken {
        /// Its index, in the order in which constraints were added.
        constraint: usize,
        /// The time, s.
        time: f64,
        /// The error of the joint, in metres, or in radians for a rotation.
        missing: f64,
    },
    /// Two bodies overlap when contacts begin.
    Overlapping {
        /// The bodies.
        bodies: [BodyId; 2],
        /// The time, s.
        time: f64,
        /// The depth of the penetration, m.
        depth: f64,
    },
    /// No step is short enough for a body.
    Stalled {
        /// The body.
        body: BodyId,
        /// The time, s.
        time: f64,
    },
    /// Impacts follow each other endlessly.
    Jammed {
        /// The bodies of the last impact.
        bodies: [BodyId; 2],
        /// The time, s.
        time: f64,
    },
}

impl Snapshot {
    /// A body, if it is present.
    #[must_use]
    pub fn body(&self, id: usize) -> Option<&BodySnapshot> {
        find(&self.bodies, id)
    }

    /// The snapshot, unless a body's position or velocity is not finite.
    ///
    /// # Errors
    /// Names the first such body.
    pub fn checked(self) -> Result<Snapshot, Breakdown> {
        match self.bodies.iter().find(|body| !body.is_finite()) {
            None => Ok(self),
            Some(body) => Err(Breakdown::Diverged { body: BodyId::new(body.id), time: self.time }),
        }
    }
}

/// The body with an id, from a list in the order of ids.
pub(crate) fn find(bodies: &[BodySnapshot], id: usize) -> Option<&BodySnapshot> {
    // In most runs, all bodies are always present.
    match bodies.get(id) {
        Some(body) if body.id == id => Some(body),
        _ => bodies.binary_search_by_key(&id, |body| body.id).ok().map(|place| &bodies[place]),
    }
}

impl BodySnapshot {
    /// Whether the body's position and velocity are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.location.is_finite()
            && self.orientation.is_finite()
            && self.velocity.is_finite()
            && self.angular_velocity.is_finite()
    }

    /// The position and velocity of a point of the body. The point is given in the body's own axes, relative to its centre of mass, m.
    #[must_use]
    pub fn point(&self, at: DVec3) -> (DVec3, DVec3) {
        if at == DVec3::ZERO {
            return (self.location, self.velocity);
        }
        let arm = self.orientation * at;
        (self.location + arm, self.velocity + self.angular_velocity.cross(arm))
    }
}

impl std::fmt::Display for Breakdown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Breakdown::Diverged { body, time } => {
                write!(f, "at t = {time} s body {} is at no finite place", body.index())
            }
            Breakdown::Undefined { force, at: Undefined { body, time, .. } } => {
                write!(f, "at t = {time} s force {force} has no finite value on body {}", body.index())
            }
            Breakdown::Broken { constraint, time, missing } => {
                write!(f, "at t = {time} s constraint {constraint} is off by {missing:.3e}")
            }
            Breakdown::Overlapping { bodies: [a, b], time, depth } => {
                let (a, b) = (a.index(), b.index());
                write!(f, "at t = {time} s bodies {a} and {b} are {depth:.3e} m within each other")
            }
            Breakdown::Stalled { body, time } => {
                write!(f, "at t = {time} s no step is short enough for body {}", body.index())
            }
            Breakdown::Jammed { bodies: [a, b], time } => {
                let (a, b) = (a.index(), b.index());
                write!(f, "at t = {time} s the impacts of bodies {a} and {b} do not end")
            }
        }
    }
}

impl std::error::Error for Breakdown {}
