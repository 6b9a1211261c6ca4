//! The contact forces on bodies that Moreau's scheme advances, as snapshots show them.

use std::sync::Arc;

use glam::DVec3;

use super::super::contact::LastingContact;
use super::super::{ContactSnapshot, Loads, Model, State};
use super::Law;
use super::row_modes::Mode;
use super::solver::Solver;
use super::sweep::Purpose;

/// The number of times that sweeps solve for the forces between resting bodies. Each time, the sweeps start from the forces found the time
/// before.
const FORCE_PASSES: usize = 10;

impl Solver {
    /// Computes the contact forces between resting bodies. `loads` are all other forces and torques on these bodies.
    pub(crate) fn forces_at_rest(
        &self,
        contacts: Vec<Arc<LastingContact>>,
        model: &Model,
        (t, state): (f64, &State),
        loads: &Loads,
    ) -> Vec<ContactSnapshot> {
        // The given velocities are those that the loads cause in one second from rest. The impulses that stop the bodies, in newton
        // seconds, then equal the contact forces in newtons.
        let mut given = state.clone();
        for &i in contacts.iter().flat_map(|contact| &contact.bodies) {
            given.velocity[i] = model.inverse_mass()[i] * loads.force[i];
            given.angular_momentum[i] =
                if model.inverse_mass()[i] == 0.0 { DVec3::ZERO } else { loads.torque[i] };
        }
        let mut solver = self.part(contacts);
        solver.warm = self.warm.clone();
        solver.find_by_sweeps();
        solver.prepare_sweeps(model, t, &mut given);
        let goals = vec![0.0; solver.rows.len()];
        for _ in 0..FORCE_PASSES {
            solver.push_all(model, &goals, Purpose::Forces(1.0), &mut given.clone());
        }
        solver.contact_snapshots(model)
    }

    /// Returns the forces of limits and motors that the Gauss–Seidel sweeps of the last substep of Moreau's scheme have found: the
    /// constraint, its row, and the multiplier of each.
    pub(crate) fn joint_forces(&self) -> &[(usize, usize, f64)] {
        &self.joint_forces
    }

    /// Lets limits and motors exert these forces, as [`joint_forces`](Self::joint_forces) gives them, instead of deciding their modes.
    pub(crate) fn give_joint_forces(&mut self, model: &Model, forces: &[(usize, usize, f64)]) {
        self.forget();
        self.plan(model);
        for &(constraint, row, force) in forces {
            let Some(row) = self.first_row.get(constraint).copied().flatten().map(|first| first + row) else {
                continue;
            };
            self.modes[row] = match self.laws[row] {
                Law::SpeedMotor { limit } => {
                    Mode::Pushed(if limit.is_finite() { force / limit } else { 0.0 })
                }
                _ => Mode::Pushed(force),
            };
        }
    }

    /// Returns the contact forces that the Gauss–Seidel sweeps of the last substep of Moreau's scheme have found.
    pub(crate) fn last_forces(
        &self,
        contacts: Vec<Arc<LastingContact>>,
        model: &Model,
        t: f64,
        state: &State,
    ) -> Vec<ContactSnapshot> {
        let mut solver = self.part(contacts);
        solver.warm = self.warm.clone();
        solver.find_by_sweeps();
        solver.prepare_sweeps(model, t, &mut state.clone());
        solver.unknown = vec![0.0; solver.rows.len()];
        solver.start_warm(1.0);
        solver.contact_snapshots(model)
    }
}
