//! The work of forces without a potential.
//!
//! The engine holds a force constant over a step. So its work uses the mean velocity of the step, not that at the start: with the latter,
//! a servo that starts to pull at rest would do no work.

use glam::DVec3;

use super::super::force::Moment;
use super::super::{Accounts, Loads, Model, State, WorkAccount};
use super::books::Motion;

/// The loads of forces without a potential in a step.
#[derive(Clone, Default)]
pub(super) struct Driven {
    /// The summed loads of each account.
    alone: Vec<(WorkAccount, Loads)>,
}

impl Driven {
    /// Called at the start of a step: evaluates these forces, and removes their power from `loads`.
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

    /// The loads of an account, for a number of bodies.
    fn loads_of(&mut self, account: WorkAccount, bodies: usize) -> &mut Loads {
        let known = self.alone.iter().position(|(of, _)| *of == account);
        let place = known.unwrap_or_else(|| {
            let none = vec![DVec3::ZERO; bodies];
            self.alone.push((account, Loads { force: none.clone(), torque: none, ..Loads::default() }));
            self.alone.len() - 1
        });
        &mut self.alone[place].1
    }

    /// The work of these forces in a step of `dt` (s), with the mean motion of the bodies.
    pub(super) fn work(&self, dt: f64, mean: &[Motion]) -> Accounts {
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

    /// The sum of these forces on a body, N.
    pub(super) fn on(&self, body: usize) -> DVec3 {
        self.alone.iter().map(|(_, alone)| alone.force[body]).sum()
    }
}
