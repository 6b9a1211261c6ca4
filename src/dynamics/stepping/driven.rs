//! The work of forces without a potential.
//!
//! The engine holds a force over a step. So its work is its product with the mean velocity of the step, and not with that at the beginning: a
//! servo that begins to pull at rest has done nothing by the latter.

use glam::DVec3;

use super::super::force::Moment;
use super::super::{Accounts, Loads, Model, State, WorkAccount};
use super::books::Motion;

/// What forces without a potential do in a step.
#[derive(Clone, Default)]
pub(super) struct Driven {
    /// The loads of all of them that share an account.
    alone: Vec<(WorkAccount, Loads)>,
}

impl Driven {
    /// The beginning of a step: finds what these forces do to the bodies, and takes their power out of `loads`.
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

    /// The loads of an account, on some number of bodies.
    fn loads_of(&mut self, account: WorkAccount, bodies: usize) -> &mut Loads {
        let known = self.alone.iter().position(|(of, _)| *of == account);
        let place = known.unwrap_or_else(|| {
            let none = vec![DVec3::ZERO; bodies];
            self.alone.push((account, Loads { force: none.clone(), torque: none, ..Loads::default() }));
            self.alone.len() - 1
        });
        &mut self.alone[place].1
    }

    /// The work of these forces in a step of `dt` (s), in which the bodies moved like this on average.
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

    /// The force of all of them on a body, N.
    pub(super) fn on(&self, body: usize) -> DVec3 {
        self.alone.iter().map(|(_, alone)| alone.force[body]).sum()
    }
}
