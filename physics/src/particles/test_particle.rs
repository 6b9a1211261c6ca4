//! A particle at rest that shows what a force does at any point of space.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;

use super::{Field, RecordedMotion};
use crate::{BodyId, BodySnapshot, Force, Loads, Model, Moment, RigidBody, Shape, State, find};

/// A test particle of 1 kg and 1 C at rest. A force acts on it as on the particles of a [`Cloud`](super::Cloud), and it acts on nothing. So the
/// force on it is the field of the force: N/kg for gravitation, V/m for electric charges.
#[derive(Clone)]
pub struct TestParticle {
    model: Model,
    state: State,
    force: Arc<dyn Force>,
    /// The bodies that cause the force. In the state, they come after the particle.
    sources: Vec<BodyId>,
    time: f64,
}

impl fmt::Debug for TestParticle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TestParticle").field("sources", &self.sources).finish_non_exhaustive()
    }
}

impl TestParticle {
    /// Creates a test particle that a force acts on.
    pub fn new(field: &Field) -> TestParticle {
        let (mut model, mut state) = (Model::default(), State::default());
        // The particle does not rotate, so its radius does not matter.
        model.push(&RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0).with_charge(1.0), &mut state);
        let bodies = field.sources();
        let numbers = (1..=bodies.len()).map(BodyId::new).collect();
        bodies.iter().for_each(|(_, start)| model.push(start, &mut state));
        let force = field.force(vec![BodyId::new(0)], numbers);
        TestParticle {
            model,
            state,
            force,
            sources: bodies.iter().map(|(body, _)| *body).collect(),
            time: 0.0,
        }
    }

    /// Moves the bodies that cause the force to where they are at a time (s). An absent body causes no force.
    pub fn follow(&mut self, time: f64, bodies: &[BodySnapshot]) {
        self.time = time;
        for (place, body) in self.sources.iter().enumerate() {
            let at = find(bodies, body.index());
            self.model.let_come_and_go(&[(1 + place, at.is_some())], &mut self.state);
            if let Some(at) = at {
                self.model.drive(1 + place, Arc::new(RecordedMotion::still(*at)));
            }
        }
        self.model.place(time, &mut self.state);
    }

    /// Returns the force on the particle at a point (m), N.
    pub fn force_at(&mut self, point: DVec3) -> DVec3 {
        self.state.location[0] = point;
        let zero = vec![DVec3::ZERO; self.state.location.len()];
        let mut loads = Loads { force: zero.clone(), torque: zero, ..Loads::default() };
        self.force.apply(&self.moment(), &mut loads);
        loads.force[0]
    }

    /// Returns the potential energy of the particle at a point (m), J. A force without a potential has 0 everywhere.
    pub fn potential_at(&mut self, point: DVec3) -> f64 {
        self.state.location[0] = point;
        self.force.potential(&self.moment())
    }

    fn moment(&self) -> Moment<'_> {
        Moment { time: self.time, state: &self.state, model: &self.model }
    }
}
