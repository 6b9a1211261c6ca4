//! The forces that keep the constraints, where forces are evaluated.

use super::super::{Loads, Model, State};
use super::Law;
use super::jacobian::{for_each_direction, move_members, products};
use super::modes::Mode;
use super::solver::Solver;

impl Solver {
    /// Adds the forces and torques that keep the constraints to the loads.
    pub(in crate::dynamics) fn react(&mut self, model: &Model, t: f64, state: &State, loads: &mut Loads) {
        if model.constraints().is_empty() {
            return;
        }
        if !self.is_ready {
            self.plan(model);
            self.measure(model, t, state);
            self.factorise(false);
        }
        self.is_ready = false;
        self.push_drives(loads);
        self.solve_forces(t, state, loads);
        let Solver { structure: Some(structure), rows, jacobian, unknown, .. } = &*self else { return };
        for (multiplier, row) in unknown.iter().zip(rows) {
            // The power λ J v, since J v + ∂c/∂t = 0.
            loads.power.motors -= multiplier * row.rate;
        }
        for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
            let i = structure.bodies[member];
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
        });
    }

    /// Finds the multipliers at a state that has been measured and factorised. The accelerations without them take the place of
    /// velocities, which are not needed any more. Gives the largest size of the terms of c''.
    fn solve_forces(&mut self, t: f64, state: &State, loads: &Loads) -> f64 {
        let Solver { structure: Some(structure), members, motions, rows, jacobian, unknown, .. } = self
        else {
            return 0.0;
        };
        for ((member, motion), &i) in members.iter_mut().zip(motions).zip(&structure.bodies) {
            if let Some(motion) = motion {
                member.velocity = motion.at(t).acceleration;
                member.angular_velocity = motion.angular_acceleration(t);
            } else {
                let gyroscopic = member.angular_velocity.cross(state.angular_momentum[i]);
                member.velocity = member.inverse_mass * loads.force[i];
                member.angular_velocity = member.turn(loads.torque[i] - gyroscopic);
            }
        }
        let mut size = products(structure, jacobian, members, unknown);
        for (value, row) in unknown.iter_mut().zip(&*rows) {
            size = size.max(row.bias.abs());
            *value = -(*value + row.bias);
        }
        self.factor.solve(unknown);
        size
    }

    /// Finds the multipliers as [`react`](Self::react) does, adds nothing but what drives push, and gives c'' of each row
    /// with them, and the largest size of its terms.
    pub(super) fn react_seeing(
        &mut self,
        t: f64,
        state: &State,
        loads: &mut Loads,
        accelerations: &mut [f64],
    ) -> f64 {
        self.is_ready = false;
        self.push_drives(loads);
        let size = self.solve_forces(t, state, loads);
        let Solver { structure: Some(structure), members, rows, jacobian, unknown, .. } = self else {
            return size;
        };
        move_members(structure, jacobian, unknown, members);
        products(structure, jacobian, members, accelerations);
        for (acceleration, row) in accelerations.iter_mut().zip(&*rows) {
            *acceleration += row.bias;
        }
        size
    }

    /// Adds the forces of drives that push with their limit, and their power.
    fn push_drives(&mut self, loads: &mut Loads) {
        if !self.has_modes {
            return;
        }
        let Solver { structure: Some(structure), members, jacobian, unknown, laws, modes, .. } = self else {
            return;
        };
        for (value, (law, mode)) in unknown.iter_mut().zip(laws.iter().zip(modes)) {
            *value = match (law, mode) {
                (Law::Drive { limit }, Mode::Pushed(sign)) => *sign * *limit,
                _ => 0.0,
            };
        }
        for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
            let (i, member) = (structure.bodies[member], &members[member]);
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
            loads.power.motors += multiplier
                * (direction.linear.dot(member.velocity) + direction.angular.dot(member.angular_velocity));
        });
    }

    /// Adds the forces of motors that are not strong enough for their speed, where they act as forces do.
    pub(in crate::dynamics) fn drive(&mut self, model: &Model, t: f64, state: &State, loads: &mut Loads) {
        if self.modes.iter().any(|mode| matches!(mode, Mode::Pushed(_))) {
            self.measure(model, t, state);
            self.is_ready = false;
            self.push_drives(loads);
        }
    }
}
