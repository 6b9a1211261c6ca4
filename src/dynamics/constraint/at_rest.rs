//! The forces at the contacts of what time-stepping advances, for somebody who looks.

use std::sync::Arc;

use glam::DVec3;

use super::super::contact::Closed;
use super::super::{ContactSnapshot, Loads, Model, State};
use super::solver::Solver;
use super::sweep::Purpose;

/// The forces on what rests are found in so many rounds of sweeps; each begins with what the one before has found.
const ROUNDS: usize = 10;

impl Solver {
    /// The forces at places where bodies rest on each other, under `loads`.
    pub(in crate::dynamics) fn forces_at_rest(
        &self,
        contacts: Vec<Arc<Closed>>,
        model: &Model,
        (t, state): (f64, &State),
        loads: &Loads,
    ) -> Vec<ContactSnapshot> {
        // The velocities that the loads give in a second are to be stopped: the impulses in newton seconds are the forces in newtons.
        let mut given = state.clone();
        for &i in contacts.iter().flat_map(|contact| &contact.bodies) {
            given.velocity[i] = model.inverse_mass()[i] * loads.force[i];
            given.angular_momentum[i] =
                if model.inverse_mass()[i] == 0.0 { DVec3::ZERO } else { loads.torque[i] };
        }
        let mut solver = self.part(contacts);
        solver.warm = self.warm.clone();
        solver.find_by_sweeps(model);
        for _ in 0..ROUNDS {
            let mut stopped = given.clone();
            solver.prepare_sweeps(model, t, &mut stopped);
            let goals = vec![0.0; solver.rows.len()];
            solver.push_all(model, &goals, Purpose::Forces(1.0), &mut stopped);
        }
        solver.contact_snapshots(model)
    }

    /// The forces at contacts as they were found last.
    pub(in crate::dynamics) fn forces_known(
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
