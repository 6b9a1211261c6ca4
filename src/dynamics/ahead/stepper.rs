//! The interface of methods that choose their own steps.

use super::super::{BodyId, State};
use super::bodies::Field;
use super::time::Time;

/// A method that holds the bodies in its own form, and advances them by steps that it chooses. A clone continues exactly as the original
/// would.
pub(super) trait Stepper: Clone + Send {
    /// Takes over the bodies of the field's stage at a time, and restarts.
    fn begin(&mut self, field: &mut Field<'_>, now: Time);

    /// The largest length of the next step, s.
    fn proposal(&self) -> f64;

    /// Makes a step of at most `longest` (s). Returns its length.
    ///
    /// # Errors
    /// The body for which no step is short enough.
    fn step(&mut self, field: &mut Field<'_>, now: Time, longest: f64) -> Result<f64, BodyId>;

    /// Makes a step of exactly `duration` seconds, whatever its error.
    fn step_by(&mut self, field: &mut Field<'_>, now: Time, duration: f64);

    /// Writes the bodies to a state.
    fn write(&self, field: &Field<'_>, state: &mut State);
}

/// Whether a step (s) is too short to change a time (s) by more than its last digits.
pub(super) fn is_too_short(step: f64, now: Time) -> bool {
    step.abs() <= 1e-15 * now.seconds().abs() || step.abs() < f64::MIN_POSITIVE
}
