//! Changes of a world from outside: bodies, forces, constraints and contacts that are added, and loads that are set.

use std::sync::Arc;

use glam::DVec3;

use super::super::contact::Collider;
use super::super::{BodyId, Constraint, Contacts, Force, Motion, Presence, RigidBody, Shape};
use super::World;

impl World {
    /// Reserves memory for this many more bodies.
    pub fn reserve(&mut self, bodies: usize) {
        self.model.reserve(bodies);
        self.state.reserve(bodies);
    }

    /// Adds a body at any time, and returns its id.
    pub fn add(&mut self, body: RigidBody) -> BodyId {
        self.about_to_change();
        self.model.push(&body, &mut self.state);
        BodyId::new(self.model.len() - 1)
    }

    /// Sets the shapes of bodies, in the order in which the bodies were added.
    pub fn add_shapes(&mut self, shapes: impl IntoIterator<Item = Shape>) {
        shapes.into_iter().for_each(|shape| self.model.push_shape(shape));
    }

    /// Makes a body follow a given motion from now on. The body still acts on other bodies. The balance leaves out the body's kinetic
    /// energy and momentum. The work of the body's guide, whatever makes it follow the motion, is added to the accounts.
    pub fn drive(&mut self, body: BodyId, motion: impl Motion + 'static) {
        self.follow(body, Arc::new(motion));
    }

    /// Makes a body follow a given motion from now on, as [`World::drive`] does. The motion can be shared.
    pub fn follow(&mut self, body: BodyId, motion: Arc<dyn Motion>) {
        self.about_to_change();
        let (i, is_present) = (body.index(), self.model.is_present(body.index()));
        if is_present {
            // Places only this body. Placing all bodies with a given motion for each new one would take n² placements for n bodies.
            self.model.place_body(i, &motion.at(self.time), &mut self.state);
            self.model.drive(i, motion);
        } else {
            self.model.bring(i, &mut self.state);
            self.model.drive(i, motion);
            self.model.take_away(i, &mut self.state);
        }
    }

    /// Restricts a body's presence to the times of `presence` from now on. When the body appears, it has the state in which it last
    /// disappeared, or at first the state in which it was [added](World::add). The energy that comes and goes with the body does not count
    /// as drift.
    ///
    /// A step ends at each birth and death. If the motion of all bodies is given, births and deaths take effect at the end of the step.
    pub fn limit(&mut self, body: BodyId, presence: &Presence) {
        self.about_to_change();
        let i = body.index();
        if !self.calendar.note(i, presence, self.time) {
            self.model.take_away(i, &mut self.state);
        } else if !self.model.is_present(i) {
            self.model.let_come_and_go(&[(i, true)], &mut self.state);
        }
    }

    /// Adds a force, at any time.
    pub fn add_force(&mut self, force: impl Force + 'static) {
        self.add_shared_force(Arc::new(force));
    }

    /// Adds a force that can be shared, at any time.
    pub fn add_shared_force(&mut self, force: Arc<dyn Force>) {
        self.about_to_change();
        self.model.push_force(force);
    }

    /// Adds a constraint, at any time. If the state violates the constraint, the bodies are moved the shortest distance to satisfy it, and
    /// the violating components of their velocities are removed.
    pub fn add_constraint(&mut self, constraint: impl Constraint + 'static) {
        self.add_shared_constraint(Arc::new(constraint));
    }

    /// Adds a constraint that can be shared, at any time.
    pub fn add_shared_constraint(&mut self, constraint: Arc<dyn Constraint>) {
        self.about_to_change();
        self.model.push_constraint(constraint);
    }

    /// Turns on contacts between bodies from now on, with the surfaces and exceptions of `contacts`. The shapes are those of
    /// [`add_shapes`](Self::add_shapes).
    pub fn collide(&mut self, contacts: Contacts) {
        self.about_to_change();
        self.collider = Some(Collider::new(contacts));
    }

    /// Sets the constant force on a body (world axes, N) from now on.
    pub fn apply_force(&mut self, body: BodyId, force: DVec3) {
        self.about_to_change();
        self.model.set_constant_force(body.index(), force);
    }

    /// Sets the constant torque on a body (world axes, N m) from now on.
    pub fn apply_torque(&mut self, body: BodyId, torque: DVec3) {
        self.about_to_change();
        self.model.set_constant_torque(body.index(), torque);
    }

    /// Prepares the world for a change from outside, such as a new body or force. Must be called before each such change: the energy
    /// ledger and the integrator rely on it.
    pub(super) fn about_to_change(&mut self) {
        self.let_all_go();
        self.about_to_change_some();
        if let Some(collider) = &mut self.collider {
            collider.forget();
        }
    }

    /// Prepares the world for a change that does not affect bodies held at rest. These stay held.
    pub(super) fn about_to_change_some(&mut self) {
        self.ledger.open(&self.model, self.time, &self.state);
        self.integrator.discontinuity();
        self.solver.forget();
        self.parts.clear();
        self.is_settled = false;
    }
}
