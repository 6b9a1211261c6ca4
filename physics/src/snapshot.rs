//! Snapshots: all observable quantities of a run at one moment.

use glam::{DQuat, DVec3};

use super::{Balance, BodyId, ContactSnapshot, LawResidual, Loads, Model, Reaction, State, Undefined};

/// All bodies, reactions, contacts and energies at one moment of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// The time of the snapshot, s.
    pub time: f64,
    /// The present bodies, in the order of their ids.
    pub bodies: Vec<BodySnapshot>,
    /// The reaction of each constraint, in the order in which the constraints were added.
    pub reactions: Vec<Reaction>,
    /// The angle of each joint, counted through full turns, rad; 0 for a joint without an angle. Empty if nobody counts them: a single
    /// snapshot does not show how often a joint has turned.
    pub angles: Vec<f64>,
    /// The lasting contacts of bodies, in the order of the bodies' ids.
    pub contacts: Vec<ContactSnapshot>,
    /// The largest penetration depth of two bodies, m; 0 if no bodies touch, or if the engine lets no bodies penetrate each other.
    pub penetration: f64,
    /// The worst residual so far of each law that no contact can break. Empty if the engine does not check them.
    pub laws: Vec<LawResidual>,
    /// The energies, the momenta, and the drift of the energy.
    pub balance: Balance,
}

/// The pose, the velocities and the force of one body at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodySnapshot {
    /// The index of the body in the world.
    pub id: usize,
    /// The position of the body's center of mass, world axes, m.
    pub location: DVec3,
    /// The rotation from body axes to world axes.
    pub orientation: DQuat,
    /// The velocity of the body's center of mass, world axes, m/s.
    pub velocity: DVec3,
    /// The angular velocity of the body, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// The sum of all forces on the body, world axes, N. For a body with a given motion, this is m a.
    pub force: DVec3,
}

impl BodySnapshot {
    /// Returns the snapshots of all present bodies, in the order of their ids. `loads` holds the forces at this moment.
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

/// The reason why a simulation run cannot continue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Breakdown {
    /// The position or velocity of a body is not finite: the integration method cannot follow this motion with steps of this length.
    Diverged {
        /// The body with a position or velocity that is not finite.
        body: BodyId,
        /// The time of the first snapshot with such a value, s.
        time: f64,
    },
    /// A force on a body has no finite value, so the body's motion is undefined.
    Undefined {
        /// The index of the force, in the order in which forces were added.
        force: usize,
        /// The body, the time and the position at which the force is undefined.
        at: Undefined,
    },
    /// A constraint, such as a joint, cannot be satisfied.
    Broken {
        /// The index of the constraint, in the order in which constraints were added.
        constraint: usize,
        /// The time at which the constraint failed, s.
        time: f64,
        /// The remaining error of the constraint, in meters, or in radians for a rotation.
        missing: f64,
    },
    /// Two bodies already overlap when contacts between them begin.
    Overlapping {
        /// The two overlapping bodies.
        bodies: [BodyId; 2],
        /// The time at which contacts began, s.
        time: f64,
        /// The depth by which the bodies overlap, m.
        depth: f64,
    },
    /// An adaptive method finds no step that is short enough for the required accuracy.
    Stalled {
        /// The body whose motion needs the shorter step.
        body: BodyId,
        /// The time that the run has reached, s.
        time: f64,
    },
    /// Impacts between bodies follow each other endlessly, or bodies cannot be separated.
    Jammed {
        /// The two bodies of the last impact, or those that cannot be separated.
        bodies: [BodyId; 2],
        /// The time at which the run stopped, s.
        time: f64,
    },
    /// No impulses were found that do not add energy, as contacts never do.
    AddsEnergy {
        /// The two bodies that push each other most.
        bodies: [BodyId; 2],
        /// The time at which the run stopped, s.
        time: f64,
        /// The energy that the impulses would add, J.
        energy: f64,
    },
}

impl Snapshot {
    /// Returns the snapshot of a body; `None` if the body is absent.
    #[must_use]
    pub fn body(&self, id: usize) -> Option<&BodySnapshot> {
        find(&self.bodies, id)
    }

    /// Returns the snapshot itself if all positions and velocities are finite.
    ///
    /// # Errors
    /// Names the first body whose position or velocity is not finite.
    pub fn checked(self) -> Result<Snapshot, Breakdown> {
        match self.bodies.iter().find(|body| !body.is_finite()) {
            None => Ok(self),
            Some(body) => Err(Breakdown::Diverged { body: BodyId::new(body.id), time: self.time }),
        }
    }
}

/// Returns the snapshot of the body with an id, from a list in the order of ids. `None` if the list does not contain this body.
pub fn find(bodies: &[BodySnapshot], id: usize) -> Option<&BodySnapshot> {
    // If all bodies are present, as in most runs, the id is the index in the list.
    match bodies.get(id) {
        Some(body) if body.id == id => Some(body),
        _ => bodies.binary_search_by_key(&id, |body| body.id).ok().map(|place| &bodies[place]),
    }
}

impl BodySnapshot {
    /// The largest coordinate (m), velocity (m/s) and angular velocity (rad/s) of a motion. The squares of larger numbers may not be finite.
    const MAX_MAGNITUDE: f64 = 1e100;

    /// Returns true if the body's position and velocities are finite, and so small that their squares are finite, too.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let is_small =
            |vector: DVec3| vector.abs().max_element() <= BodySnapshot::MAX_MAGNITUDE && !vector.is_nan();
        self.orientation.is_finite()
            && [self.location, self.velocity, self.angular_velocity].into_iter().all(is_small)
    }

    /// Returns the position (m) and the velocity (m/s) of a point of the body, world axes. The point is given in body axes, relative to
    /// the center of mass, m.
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
            Breakdown::AddsEnergy { bodies: [a, b], time, energy } => {
                let (a, b) = (a.index(), b.index());
                write!(f, "at t = {time} s contacts of bodies {a} and {b} would add {energy:.3e} J")
            }
        }
    }
}

impl std::error::Error for Breakdown {}
