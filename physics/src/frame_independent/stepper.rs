//! The interface of integration methods that choose their own steps.

use super::super::{BodyId, State};
use super::bodies::Field;
use super::time::Time;

/// An integration method that keeps the bodies in its own representation, and advances them in steps that it chooses. A clone continues
/// exactly as the original would.
pub(super) trait Stepper: Clone + Send {
    /// Reads the bodies from the current stage at time `now`, and starts again without data from earlier steps.
    fn begin(&mut self, field: &mut Field<'_>, now: Time);

    /// Returns the length of the next step that the method proposes, s.
    fn proposal(&self) -> f64;

    /// Makes a step from time `now`, of at most `longest`, s. Returns the length of the step, s.
    ///
    /// # Errors
    /// Returns the body for which no step is short enough.
    fn step(&mut self, field: &mut Field<'_>, now: Time, longest: f64) -> Result<f64, BodyId>;

    /// Makes a step of exactly `duration` seconds from time `now`. The error of the step is not checked.
    fn step_by(&mut self, field: &mut Field<'_>, now: Time, duration: f64);

    /// Writes the present state of the method's bodies to `state`.
    fn write(&self, field: &Field<'_>, state: &mut State);
}

/// Returns whether a step (s) is too short to change the time by more than its last digits.
pub(super) fn is_too_short(step: f64, now: Time) -> bool {
    step.abs() <= 1e-15 * now.seconds().abs() || step.abs() < f64::MIN_POSITIVE
}
