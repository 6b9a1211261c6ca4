//! The contact forces that frames show of bodies that time-stepping advances.

use std::sync::Arc;

use glam::DVec3;

use super::super::contact::Closed;
use super::super::{ContactSnapshot, Loads, Model, State};
use super::solver::Solver;
use super::sweep::Purpose;

/// The forces between bodies at rest are found in so many rounds of sweeps. Each round begins with the forces of the one before.
const ROUNDS: usize = 10;

impl Solver {
    /// The forces at places where bodies rest on each other. `loads` are the other forces on them.
    pub(in crate::dynamics) fn forces_at_rest(
        &self,
        contacts: Vec<Arc<Closed>>,
        model: &Model,
        (t, state): (f64, &State),
        loads: &Loads,
    ) -> Vec<ContactSnapshot> {
        // In one second, the loads give the bodies these velocities. The impulses that stop them, in newton seconds, are as large as the
        // forces in newtons.
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

    /// The forces at contacts that were found in the last part of a step.
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
