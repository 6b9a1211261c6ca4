//! The constraint forces that belong to the positions, velocities and loads of one moment.

use super::super::{Loads, Model, State};
use super::jacobian::{for_each_direction, magnitude, move_members, product, products};
use super::row_modes::Mode;
use super::solver::Solver;

/// A contact needs an implausible acceleration if it exceeds [`Solver::typical_acceleration`] by this factor. The factor is large, because the
/// contact point of two nearly parallel lines, or of a nearly flat rim, moves much faster than the bodies.
const MAX_ACCELERATION: f64 = 1e4;

impl Solver {
    /// Adds the constraint forces and torques to the loads of the bodies, and their power.
    pub(crate) fn react(&mut self, model: &Model, t: f64, state: &State, loads: &mut Loads) {
        if self.is_idle(model) {
            return;
        }
        if !self.is_ready {
            self.plan(model);
            self.measure(t, state);
            self.factorise(false);
        }
        self.is_ready = false;
        if self.has_modes {
            self.push_drives(loads);
            self.see_slips_that_constraints_allow();
        }
        self.solve_forces(t, state, loads);
        if self.has_modes {
            self.book_friction(loads);
        }
        let Solver { structure: Some(structure), rows, jacobian, unknown, .. } = &*self else { return };
        for (multiplier, row) in unknown.iter().zip(rows) {
            // The power of a time-dependent constraint is λ J v, where J v = −∂c/∂t.
            loads.power.motors -= multiplier * row.rate;
        }
        for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
            let i = structure.bodies[member];
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
        });
    }

    /// Solves for the multipliers λ at a state whose equations are measured and factorized. The velocities of the members are overwritten
    /// with the accelerations that they would have without constraints.
    fn solve_forces(&mut self, t: f64, state: &State, loads: &Loads) {
        self.see_free_accelerations(t, state, loads);
        let Solver { structure: Some(structure), members, rows, jacobian, unknown, .. } = self else {
            return;
        };
        for ((i, value), row) in unknown.iter_mut().enumerate().zip(rows) {
            *value = -(product(structure, jacobian, members, i).0 + row.bias);
        }
        if self.has_modes && self.slides() {
            let is_found = self.solve_sliding();
            self.is_unsolved |= !is_found;
        } else {
            self.solve();
        }
    }

    /// Overwrites the velocities of the members with the accelerations that they would have without constraints.
    pub(super) fn see_free_accelerations(&mut self, t: f64, state: &State, loads: &Loads) {
        let Solver { structure: Some(structure), members, motions, .. } = self else { return };
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
    }

    /// Solves for the multipliers λ as [`react`](Self::react) does, but adds only the forces of motors at their limits to the loads.
    /// Writes c'' of each constraint row to `accelerations`, and returns the largest magnitude of its terms, m/s². Those of angles count
    /// times the size of the mechanism. If contacts would need accelerations that nothing causes, returns those that something does.
    pub(super) fn react_seeing(
        &mut self,
        t: f64,
        state: &State,
        loads: &mut Loads,
        accelerations: &mut [f64],
    ) -> f64 {
        self.is_ready = false;
        self.push_drives(loads);
        self.see_slips();
        self.solve_forces(t, state, loads);
        let [of_joints, of_contacts] = self.largest_biases();
        let typical = self.typical_acceleration(loads, of_joints);
        self.is_implausible = of_contacts > MAX_ACCELERATION * typical;
        let Solver { structure: Some(structure), members, rows, jacobian, unknown, grips, .. } = self else {
            return 0.0;
        };
        let size = magnitude((structure, jacobian, members), rows, grips, |row| row.bias);
        move_members(structure, jacobian, unknown, members);
        products(structure, jacobian, members, accelerations);
        for (acceleration, row) in accelerations.iter_mut().zip(&*rows) {
            *acceleration += row.bias;
        }
        if self.is_implausible { typical } else { size }
    }

    /// Returns the order of magnitude of the accelerations in which contacts take part, m/s²: those by loads and of given motions, those that
    /// joints need (`of_joints`), and v²/r for motion along a curve with the speed v and the radius r.
    fn typical_acceleration(&self, loads: &Loads, of_joints: f64) -> f64 {
        let (Some(structure), false) = (&self.structure, self.contacts.is_empty()) else {
            return f64::INFINITY;
        };
        let of_bodies = self.members.iter().zip(&self.motions).zip(&structure.bodies);
        let of_bodies = of_bodies.map(|((member, motion), &body)| {
            let [linear, angular] = match motion {
                Some(_) => [member.velocity, member.angular_velocity],
                None => [member.inverse_mass * loads.force[body], member.turn(loads.torque[body])],
            };
            linear.length() + structure.length * angular.length()
        });
        let caused = of_bodies.fold(of_joints, f64::max);
        let smallest = self.contacts.iter().map(|contact| contact.size).fold(f64::INFINITY, f64::min);
        let speed = self.largest_rate + caused * self.step;
        caused + speed * speed / smallest
    }

    /// Returns the largest part of c'' that does not depend on accelerations, m/s²: of all joints, and of all contacts.
    fn largest_biases(&self) -> [f64; 2] {
        let joints = self.all.len() - self.contacts.len();
        let mut largest = [0.0_f64; 2];
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            let largest = &mut largest[usize::from(place.constraint >= joints)];
            for row in place.row..place.row + place.rows {
                *largest = largest.max(self.rows[row].bias.abs() / self.unit(row));
            }
        }
        largest
    }

    /// Adds the forces of motors at their limits, and their power, to the loads.
    pub(super) fn push_drives(&mut self, loads: &mut Loads) {
        if !self.has_modes {
            return;
        }
        let Solver { structure: Some(structure), members, jacobian, unknown, laws, modes, .. } = self else {
            return;
        };
        for (value, (law, mode)) in unknown.iter_mut().zip(laws.iter().zip(modes)) {
            *value = mode.given(*law).unwrap_or(0.0);
        }
        for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
            let (i, member) = (structure.bodies[member], &members[member]);
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
            loads.power.motors += multiplier
                * (direction.linear.dot(member.velocity) + direction.angular.dot(member.angular_velocity));
        });
    }

    /// Adds the forces of motors at their limits and of sliding friction to the loads. Splitting methods treat both like any other force.
    pub(crate) fn drive(&mut self, t: f64, state: &State, loads: &mut Loads) {
        let slides = self.slides();
        if !slides && !self.modes.iter().any(|mode| matches!(mode, Mode::Pushed(_))) {
            return;
        }
        self.measure(t, state);
        self.is_ready = false;
        self.push_drives(loads);
        if !slides {
            return;
        }
        self.factorise(false);
        self.see_slips_that_constraints_allow();
        self.solve_forces(t, state, loads);
        self.book_friction(loads);
        for i in 0..self.unknown.len() {
            if self.modes[i] != Mode::Slid {
                self.unknown[i] = 0.0;
            }
        }
        let Solver { structure: Some(structure), jacobian, unknown, .. } = &*self else { return };
        for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
            let i = structure.bodies[member];
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
        });
    }
}
