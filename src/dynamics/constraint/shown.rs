//! The contact forces in frames for bodies advanced by time-stepping.

use std::sync::Arc;

use glam::DVec3;

use super::super::contact::Closed;
use super::super::{ContactSnapshot, Loads, Model, State};
use super::solver::Solver;
use super::sweep::Purpose;

/// The number of rounds of sweeps for the forces between resting bodies. Each round starts with the forces of the last one.
const ROUNDS: usize = 10;

impl Solver {
    /// The forces at contacts between resting bodies. `loads` are the other forces on them.
    pub(in crate::dynamics) fn forces_at_rest(
        &self,
        contacts: Vec<Arc<Closed>>,
        model: &Model,
        (t, state): (f64, &State),
        loads: &Loads,
    ) -> Vec<ContactSnapshot> {
        // In one second, the loads give the bodies these velocities. So the impulses that stop them, in newton seconds, equal the forces
        // in newtons.
        let mut given = state.clone();
        for &i in contacts.iter().flat_map(|contact| &contact.bodies) {
            given.velocity[i] = model.inverse_mass()[i] * loads.force[i];
            given.angular_momentum[i] =
                if model.inverse_mass()[i] == 0.0 { DVec3::ZERO } else { loads.torque[i] };
        }
        let mut solver = self.part(contacts);
        solver.warm = self.warm.clone();
        solver.find_by_sweeps(model);
        solver.prepare_sweeps(model, t, &mut given);
        let goals = vec![0.0; solver.rows.len()];
        for _ in 0..ROUNDS {
            solver.push_all(model, &goals, Purpose::Forces(1.0), &mut given.clone());
        }
        solver.contact_snapshots(model)
    }

    /// The contact forces found in the last part of a step.
    pub(in crate::dynamics) fn last_forces(
        &self,
        contacts: Vec<Arc<Closed>>,
        model: &Model,
        t: f64,
        state: &State,
    ) -> Vec<ContactSnapshot> {
        let mut solver = self.part(contacts);
        solver.warm = self.warm.clone();
        solver.find_by_sweeps(model);
        solver.prepare_sweeps(model, t, &mut state.clone());
        solver.unknown = vec![0.0; solver.rows.len()];
        solver.start_warm(1.0);
        solver.contact_snapshots(model)
    }
}
