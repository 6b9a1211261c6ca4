//! The work of forces without a potential in time-stepping.
//!
//! The physics engine holds a force constant over a step, so the work of the force follows from the mean velocity of the step. With the
//! velocity at the start of the step, a servo that starts at rest would do no work.

use glam::DVec3;

use super::super::force::Moment;
use super::super::motion::Twist;
use super::super::{Accounts, Loads, Model, State, WorkAccount};

/// The loads in one step by forces without a potential.
#[derive(Clone, Default)]
pub(super) struct NonPotentialWork {
    /// For each account, the summed loads of the forces whose work belongs to that account.
    alone: Vec<(WorkAccount, Loads)>,
}

impl NonPotentialWork {
    /// Evaluates the forces without a potential at the start of a step, and removes their power from `loads`.
    pub(super) fn begin(&mut self, model: &Model, time: f64, state: &State, loads: &mut Loads) {
        for (_, alone) in &mut self.alone {
            alone.power = Accounts::default();
            alone.force.fill(DVec3::ZERO);
            alone.torque.fill(DVec3::ZERO);
        }
        let moment = Moment { time, state, model };
        for force in model.forces() {
            let Some(account) = force.work_account() else { continue };
            force.apply_without_potential(&moment, self.loads_of(account, state.len()));
        }
        for (_, alone) in &self.alone {
            loads.power.add(-1.0, alone.power);
        }
    }

    /// Returns the loads of an account; creates them with zeros for this number of bodies if needed.
    fn loads_of(&mut self, account: WorkAccount, bodies: usize) -> &mut Loads {
        let known = self.alone.iter().position(|(of, _)| *of == account);
        let place = known.unwrap_or_else(|| {
            let none = vec![DVec3::ZERO; bodies];
            self.alone.push((account, Loads { force: none.clone(), torque: none, ..Loads::default() }));
            self.alone.len() - 1
        });
        &mut self.alone[place].1
    }

    /// Returns the work of the forces without a potential in a step of `dt`, s. `mean` holds the mean motion of each body in the step.
    pub(super) fn work(&self, dt: f64, mean: &[Twist]) -> Accounts {
        let mut accounts = Accounts::default();
        for (account, alone) in &self.alone {
            let loads = alone.force.iter().zip(&alone.torque);
            let power = loads
                .zip(mean)
                .map(|((force, torque), (velocity, turning))| force.dot(*velocity) + torque.dot(*turning));
            *account.of(&mut accounts) += dt * power.sum::<f64>();
        }
        accounts
    }

    /// Returns the sum of the forces without a potential on a body, N.
    pub(super) fn on(&self, body: usize) -> DVec3 {
        self.alone.iter().map(|(_, alone)| alone.force[body]).sum()
    }
}
