//! Separation of overlapping bodies, by moving them apart.

use glam::{DQuat, DVec3};

use super::super::State;
use super::solver::Solver;
use super::sweep::{Purpose, Stopping};
use super::{Law, Row};

/// Overlaps below this fraction of the smallest body's size are ignored.
pub(super) const IGNORED_OVERLAP: f64 = 1e-9;

/// The Gauss–Seidel sweeps that separate bodies end when they move bodies by less than this fraction of the deepest overlap.
pub(super) const SEPARATION_SWEEP_TOLERANCE: f64 = 1e-5;

/// Closing gaps may move a body at most this many times the deepest overlap times the number of contacts. It is more than 1, because a body
/// may have to turn about a point far from its center.
pub(super) const MAX_SHIFT: f64 = 10.0;

impl Solver {
    /// Measures the overlaps of bodies at a state. Returns true if any of them is too deep to be ignored.
    /// [`prepare_sweeps`](Self::prepare_sweeps) must have run at a state shortly before.
    pub(crate) fn are_within(&mut self, t: f64, state: &State) -> bool {
        self.measure(t, state);
        let smallest = self.contacts.iter().map(|contact| contact.size).reduce(f64::min);
        let shallow = IGNORED_OVERLAP * smallest.unwrap_or(0.0);
        let is_within = |(row, law): (&Row, &Law)| *law == Law::Inequality && row.violation < -shallow;
        self.rows.iter().zip(&self.laws).any(is_within)
    }

    /// Moves overlapping bodies apart. [`are_within`](Self::are_within) must have measured the overlaps at this state.
    pub(crate) fn separate(&mut self, state: &mut State) {
        self.factorise(true);
        self.find_columns();
        let goals: Vec<f64> = self.rows.iter().map(|row| -row.violation).collect();
        for member in &mut self.members {
            (member.velocity, member.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        self.unknown.fill(0.0);
        let depths = goals.iter().enumerate().map(|(row, goal)| goal / self.unit(row));
        let deepest = depths.fold(0.0, f64::max);
        // Where bodies are wedged, the acceleration can go astray. In a stack, the impulses grow with the square of the number of bodies.
        #[allow(clippy::cast_precision_loss, reason = "there are fewer rows")]
        let bound = deepest * (goals.len() * goals.len()) as f64;
        self.sweep_until(Stopping::fast(SEPARATION_SWEEP_TOLERANCE * deepest).within(bound), |solver| {
            solver.sweep_rows(&goals, Purpose::Impact)
        });
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
