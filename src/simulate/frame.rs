//! What can be seen at one moment.

use glam::{DQuat, DVec3};

use super::{Diverged, Past};
use crate::dynamics::{Balance, BodyId, Dynamics};
use crate::scene::Scene;

/// What can be seen at one moment of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Its number, from 0.
    pub index: usize,
    /// Its time, s.
    pub time: f64,
    /// The bodies, in the order of the scene.
    pub bodies: Vec<BodyFrame>,
    /// Energies, momenta and the drift.
    pub balance: Balance,
    /// What has been before, as far as the scene asks for it.
    pub past: Past,
}

/// A body at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyFrame {
    /// The number of the body in the scene.
    pub id: usize,
    /// Its centre of mass, m.
    pub location: DVec3,
    /// The rotation that takes its own axes to the world's.
    pub orientation: DQuat,
    /// Its velocity, m/s.
    pub velocity: DVec3,
    /// Its angular velocity in world axes, rad/s.
    pub angular_velocity: DVec3,
    /// The sum of the forces on it, N.
    pub force: DVec3,
}

impl Frame {
    /// The present moment of a world.
    pub(super) fn of(dynamics: &mut dyn Dynamics, index: usize, time: f64) -> Frame {
        let balance = dynamics.balance();
        let forces = dynamics.forces().to_vec();
        let state = dynamics.state();
        let body = |id: usize| BodyFrame {
            id,
            location: state.location[id],
            orientation: dynamics.orientation(BodyId::new(id)),
            velocity: state.velocity[id],
            angular_velocity: dynamics.angular_velocity(BodyId::new(id)),
            force: forces[id],
        };
        Frame {
            index,
            time,
            bodies: (0..state.location.len()).map(body).collect(),
            balance,
            past: Past::default(),
        }
    }

    /// The frame, unless a body is at no finite place.
    pub(super) fn checked(self, scene: &Scene) -> Result<Frame, Diverged> {
        match self.bodies.iter().position(|body| !body.is_finite()) {
            None => Ok(self),
            Some(body) => Err(Diverged { body: scene.bodies[body].name.clone(), time: self.time }),
        }
    }
}

impl BodyFrame {
    /// Whether the body is at a finite place and moves at a finite velocity.
    pub fn is_finite(&self) -> bool {
        self.location.is_finite()
            && self.orientation.is_finite()
            && self.velocity.is_finite()
            && self.angular_velocity.is_finite()
    }
}
