//! The sums of the forces and torques on the bodies, and the potential energy.

use std::ops::Range;

use glam::DVec3;

use super::Model;
use crate::{Accounts, Loads, Moment, State};

impl Model {
    /// Computes the sums of all forces and torques at `time`, s, and writes them to `loads`. Constraint forces are not included:
    /// [`System::evaluate`](super::super::System::evaluate) adds them.
    ///
    /// The loads on a body that no load moves are zero, because whatever holds or guides the body balances them.
    pub fn evaluate(&self, time: f64, state: &State, loads: &mut Loads) {
        self.sum(time, state, loads);
        self.bear(state, loads);
    }

    /// Computes the sums of the forces on a range of bodies, including bodies that no load moves. Torques and power are not changed.
    /// Returns false if any force can only be evaluated for all bodies; the loads are then invalid.
    pub(in super::super) fn sum_part(
        &self,
        bodies: Range<usize>,
        time: f64,
        state: &State,
        loads: &mut Loads,
    ) -> bool {
        loads.force.resize(self.len(), DVec3::ZERO);
        self.force.write_part(&mut loads.force, bodies.clone());
        let moment = Moment { time, state, model: self };
        self.forces.iter().all(|force| force.apply_to(bodies.clone(), &moment, loads))
    }

    /// Computes the sums of all forces and torques, including those on bodies that no load moves.
    pub(in super::super) fn sum(&self, time: f64, state: &State, loads: &mut Loads) {
        if self.sum_in_focus(time, state, loads) {
            return;
        }
        self.force.write(&mut loads.force, self.len());
        self.torque.write(&mut loads.torque, self.len());
        loads.power = Accounts::default();
        for &i in &self.torqued {
            loads.power.work += self.torque.get(i).dot(self.angular_velocity(i, state));
        }
        let moment = Moment { time, state, model: self };
        for force in &self.forces {
            force.apply(&moment, loads);
        }
    }

    /// Computes the loads only on the bodies that are advanced at present; those on other bodies become invalid. Returns false if all
    /// bodies are advanced, or if any force can only be evaluated for all bodies.
    fn sum_in_focus(&self, time: f64, state: &State, loads: &mut Loads) -> bool {
        let Some(bodies) = self.in_focus().filter(|_| !self.turns_bodies() && !self.depends_on_motion())
        else {
            return false;
        };
        loads.force.resize(self.len(), DVec3::ZERO);
        loads.torque.resize(self.len(), DVec3::ZERO);
        loads.power = Accounts::default();
        let moment = Moment { time, state, model: self };
        bodies.iter().all(|&i| {
            (loads.force[i], loads.torque[i]) = (self.force.get(i), self.torque.get(i));
            self.forces.iter().all(|force| force.apply_to(i..i + 1, &moment, loads))
        })
    }

    /// Sets the loads to zero on bodies that no load moves. The support of a fixed body bears its loads. The guide of a body with a given
    /// motion, whatever makes it follow this motion, bears its loads and does work.
    pub(in super::super) fn bear(&self, state: &State, loads: &mut Loads) {
        for (i, _) in self.guided() {
            // The guide exerts loads opposite to those on its body, so the guide's work has the opposite sign.
            let turning = loads.torque[i].dot(self.angular_velocity(i, state));
            loads.power.work -= loads.force[i].dot(state.velocity[i]) + turning;
        }
        for &i in &self.unmoved {
            loads.force[i] = DVec3::ZERO;
            loads.torque[i] = DVec3::ZERO;
        }
    }

    /// Computes the potential energy of all forces that have one, J. A constant force has the potential −F·x.
    #[must_use]
    pub fn potential(&self, time: f64, state: &State) -> f64 {
        let mut potential = 0.0;
        for i in (0..self.len()).filter(|&i| self.movable[i]) {
            potential -= self.force.get(i).dot(state.location[i]);
        }
        let moment = Moment { time, state, model: self };
        self.forces.iter().fold(potential, |sum, force| sum + force.potential(&moment))
    }

    /// Returns the share of each body in the [potential energy](Self::potential), J; see [`Force::share_potential`](crate::Force::share_potential).
    #[must_use]
    pub fn potential_of_each(&self, time: f64, state: &State) -> Vec<f64> {
        let moment = Moment { time, state, model: self };
        let constant =
            |i: usize| if self.movable[i] { -self.force.get(i).dot(state.location[i]) } else { 0.0 };
        let mut shares: Vec<f64> = (0..self.len()).map(constant).collect();
        self.forces.iter().for_each(|force| force.share_potential(&moment, &mut shares));
        shares
    }
}
