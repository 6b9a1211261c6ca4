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
    /// Each of them alone, with the account of its work.
    alone: Vec<(WorkAccount, Loads)>,
    /// The sum of their forces on each body, N; empty where there is none.
    force: Vec<DVec3>,
}

impl Driven {
    /// The beginning of a step: finds what each of these forces does to the bodies, and takes its power out of `loads`.
    pub(super) fn begin(&mut self, model: &Model, time: f64, state: &State, loads: &mut Loads) {
        self.force.clear();
        let moment = Moment { time, state, model };
        let mut count = 0;
        for force in model.forces() {
            if self.alone.len() == count {
                self.alone.push((WorkAccount::Work, Loads::default()));
            }
            let (account, alone) = &mut self.alone[count];
            alone.power = Accounts::default();
            for all in [&mut alone.force, &mut alone.torque] {
                all.clear();
                all.resize(state.len(), DVec3::ZERO);
            }
            let Some(found) = force.apply_without_potential(&moment, alone) else { continue };
            *account = found;
            loads.power.add(-1.0, alone.power);
            self.force.resize(state.len(), DVec3::ZERO);
            self.force.iter_mut().zip(&alone.force).for_each(|(sum, force)| *sum += *force);
            count += 1;
        }
        self.alone.truncate(count);
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
        self.force.get(body).copied().unwrap_or(DVec3::ZERO)
    }
}
