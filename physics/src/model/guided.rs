//! The bodies that follow given motions.

use std::sync::Arc;

use super::Model;
use crate::{Kinematics, Loads, Motion, State};

impl Model {
    /// Returns the given motion of a body; `None` if forces move it or it is fixed.
    pub(in super::super) fn motion(&self, body: usize) -> Option<Arc<dyn Motion>> {
        self.motions.iter().find(|(other, _)| *other == body).map(|(_, motion)| motion.clone())
    }

    /// Returns true if any present body follows a given motion.
    pub(in super::super) fn has_guided(&self) -> bool {
        self.guided().next().is_some()
    }

    /// Makes a body follow a given motion from now on. Its inverse mass becomes 0, so that loads do not move it.
    pub(in super::super) fn drive(&mut self, body: usize, motion: Arc<dyn Motion>) {
        let is_fixed = !self.movable[body];
        let is_driven = !is_fixed && self.inverse_mass[body] == 0.0;
        if is_driven {
            self.motions.retain(|(other, _)| *other != body);
        } else if !is_fixed {
            self.unmoved.push(body);
        }
        self.motions.push((body, motion));
        self.movable[body] = true;
        self.inverse_mass[body] = 0.0;
        // The inverse moments of inertia do not become 0, because the angular velocity is computed from them and the angular momentum.
        self.inverse_inertia[body] =
            self.inertia[body].map(|moment| if moment > 0.0 { 1.0 / moment } else { 0.0 });
    }

    /// Returns the present bodies with a given motion, each with its motion.
    pub(in super::super) fn guided(&self) -> impl Iterator<Item = (usize, &dyn Motion)> {
        let present = self.motions.iter().filter(|(i, _)| self.is_present(*i));
        present.map(|(i, motion)| (*i, &**motion))
    }

    /// Sets the force on each body with a given motion to m a, the force that this motion requires.
    pub(in super::super) fn guide(&self, t: f64, loads: &mut Loads) {
        for (i, motion) in self.guided() {
            loads.force[i] = self.mass[i] * motion.at(t).acceleration;
        }
    }

    /// Places all present bodies with a given motion where they are at time `t`, s.
    pub fn place(&self, t: f64, state: &mut State) {
        self.guided().for_each(|(i, motion)| self.place_body(i, &motion.at(t), state));
    }

    /// Sets the position, orientation and velocities of one body to those of `given`.
    pub(in super::super) fn place_body(&self, i: usize, given: &Kinematics, state: &mut State) {
        let orientation = (given.orientation * self.principal_axes.get(i)).normalize();
        let in_body = orientation.conjugate() * given.angular_velocity;
        state.location[i] = given.location;
        state.velocity[i] = given.velocity;
        state.orientation[i] = orientation;
        state.angular_momentum[i] = orientation * (self.inertia[i] * in_body);
    }
}
