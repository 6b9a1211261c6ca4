//! Tells the physics engine which contacts to find anew, and for which contacts to make a callback.
//!
//! The engine keeps contacts that have hardly changed, and freezes their lever arms in world axes. This makes tall stacks stable, but it is
//! wrong for bodies that rotate: a coin on a turntable would creep outwards. Contacts with a callback are never kept.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{ActiveHooks, Collider, ColliderHandle, InteractionGroups, PhysicsWorld};

use super::super::State;

/// The contacts of a body that rotates slowly are kept until the body has rotated by this angle, rad. They are then found anew. With 0.003
/// rad, slender towers fall.
const MAX_KEPT_ROTATION: f64 = 0.01;

/// The contacts of a round body are kept until the body has moved by this multiple of half its thickness. They are then found anew. The
/// normal of a contact between two round bodies turns as they move around each other. A kept normal would act like friction.
pub(super) const MAX_KEPT_PATH: f64 = 1e-4;

/// The colliders of all bodies, and the callbacks for their contacts.
pub(super) struct KeptContacts {
    bodies: Vec<Caller>,
    /// The orientation of each body when its rotation last caused a new search for its contacts.
    pub(super) orientation: Vec<DQuat>,
    /// The location of each round body when its motion last caused a new search for its contacts, m.
    pub(super) location: Vec<DVec3>,
}

struct Caller {
    colliders: Vec<ColliderHandle>,
    /// Whether the engine makes a callback for each contact of these colliders.
    is_called: bool,
    /// Whether it does so in all steps.
    is_always_called: bool,
}

impl KeptContacts {
    /// `colliders` holds the colliders of each body.
    pub(super) fn new(
        engine: &PhysicsWorld,
        colliders: impl Iterator<Item = Vec<ColliderHandle>>,
        state: &State,
    ) -> KeptContacts {
        let caller = |colliders: Vec<ColliderHandle>| {
            let is_called = is_called(engine, &colliders);
            Caller { colliders, is_called, is_always_called: is_called }
        };
        KeptContacts {
            bodies: colliders.map(caller).collect(),
            orientation: state.orientation.clone(),
            location: state.location.clone(),
        }
    }

    /// Continues with an engine that has been restored from a checkpoint.
    #[cfg(feature = "checkpoints")]
    pub(super) fn resume(&mut self, engine: &PhysicsWorld, orientation: Vec<DQuat>, location: Vec<DVec3>) {
        (self.orientation, self.location) = (orientation, location);
        for body in &mut self.bodies {
            body.is_called = is_called(engine, &body.colliders);
        }
    }

    /// The colliders of a body.
    pub(super) fn colliders(&self, body: usize) -> &[ColliderHandle] {
        &self.bodies[body].colliders
    }

    /// Sets whether the engine makes a callback for each contact of a body.
    pub(super) fn set(&mut self, engine: &mut PhysicsWorld, body: usize, is_called: bool) {
        let body = &mut self.bodies[body];
        if is_called == body.is_called || body.is_always_called {
            return;
        }
        body.is_called = is_called;
        for handle in &body.colliders {
            if let Some(collider) = engine.colliders.get_mut(*handle) {
                collider.set_active_hooks(if is_called {
                    collider.active_hooks() | ActiveHooks::MODIFY_SOLVER_CONTACTS
                } else {
                    collider.active_hooks() - ActiveHooks::MODIFY_SOLVER_CONTACTS
                });
                find_anew(collider);
            }
        }
    }

    /// Makes the engine find the contacts of a body anew if the body has rotated by a small angle since the last time.
    pub(super) fn turn(&mut self, engine: &mut PhysicsWorld, body: usize, orientation: DQuat) {
        // The product of two unit quaternions is the cosine of half the angle between them.
        if self.orientation[body].dot(orientation).abs() >= 1.0 - MAX_KEPT_ROTATION * MAX_KEPT_ROTATION / 8.0
        {
            return;
        }
        self.orientation[body] = orientation;
        self.find_anew(engine, body);
    }

    /// Makes the engine find the contacts of a round body anew if the body has moved by `way` (m) since the last time.
    pub(super) fn shift(&mut self, engine: &mut PhysicsWorld, body: usize, location: DVec3, way: f64) {
        if self.location[body].distance_squared(location) > way * way {
            self.location[body] = location;
            self.find_anew(engine, body);
        }
    }

    fn find_anew(&self, engine: &mut PhysicsWorld, body: usize) {
        let Caller { colliders, is_called, .. } = &self.bodies[body];
        for handle in colliders.iter().filter(|_| !is_called) {
            if let Some(collider) = engine.colliders.get_mut(*handle) {
                find_anew(collider);
            }
        }
    }
}

/// Returns whether the engine makes a callback for each contact of these colliders.
fn is_called(engine: &PhysicsWorld, colliders: &[ColliderHandle]) -> bool {
    let colliders = colliders.iter().filter_map(|collider| engine.colliders.get(*collider));
    colliders.map(Collider::active_hooks).any(|hooks| hooks.contains(ActiveHooks::MODIFY_SOLVER_CONTACTS))
}

/// Makes the engine find all contacts of a collider anew in the next step. A change of groups does so.
fn find_anew(collider: &mut Collider) {
    let groups = collider.solver_groups();
    collider.set_solver_groups(InteractionGroups::none());
    collider.set_solver_groups(groups);
}
