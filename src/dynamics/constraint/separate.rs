//! Separates overlapping bodies.

use glam::{DQuat, DVec3};

use super::super::State;
use super::solver::Solver;
use super::sweep::Purpose;
use super::{Law, Row};

/// Overlaps below this fraction of the smaller body are ignored.
const SHALLOW: f64 = 1e-9;

/// Sweeps end when they move bodies by less than this fraction of the largest overlap.
const APART: f64 = 1e-5;

impl Solver {
    /// Whether bodies overlap by more than the ignored depth. Measures the overlaps at a state; [`prepare_sweeps`](Self::prepare_sweeps)
    /// must have run a little earlier.
    pub(in crate::dynamics) fn are_within(&mut self, t: f64, state: &State) -> bool {
        self.measure(t, state);
        let smallest = self.contacts.iter().map(|contact| contact.size).reduce(f64::min);
        let shallow = SHALLOW * smallest.unwrap_or(0.0);
        let is_within = |(row, law): (&Row, &Law)| *law == Law::Stop && row.violation < -shallow;
        self.rows.iter().zip(&self.laws).any(is_within)
    }

    /// Separates bodies that [overlap](Self::are_within).
    pub(in crate::dynamics) fn separate(&mut self, state: &mut State) {
        self.factorise(true);
        self.find_columns();
        let goals: Vec<f64> = self.rows.iter().map(|row| -row.violation).collect();
        for member in &mut self.members {
            (member.velocity, member.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        self.unknown.fill(0.0);
        let deepest = goals.iter().fold(0.0_f64, |most, goal| most.max(*goal));
        if self.joints() == 0 {
            self.sweep_islands(&goals, false, APART * deepest);
        } else {
            self.sweep_until(APART * deepest, |solver| solver.sweep_rows(&goals, Purpose::Impact));
        }
        let bodies = self.structure.iter().flat_map(|structure| &structure.bodies);
        for (&body, member) in bodies.zip(&self.members).filter(|(_, member)| member.inverse_mass != 0.0) {
            state.location[body] += member.velocity;
            if member.angular_velocity != DVec3::ZERO {
                let turn = DQuat::from_scaled_axis(member.angular_velocity);
                state.orientation[body] = (turn * state.orientation[body]).normalize();
            }
        }
    }
}
