//! What a method is that chooses its own steps.

use super::super::{BodyId, State};
use super::bodies::Field;
use super::time::Time;

/// A method that holds the bodies in its own form, and advances them by steps that it chooses. A clone goes on exactly as the
/// original would.
pub(super) trait Stepper: Clone + Send {
    /// Takes over the bodies of the field's stage as they are at a time, and begins anew.
    fn begin(&mut self, field: &mut Field<'_>, now: Time);

    /// How long the next step will be at most, s.
    fn proposal(&self) -> f64;

    /// Makes a step, at most so long (s); says how long it was.
    ///
    /// # Errors
    /// The body that no step is short enough for.
    fn step(&mut self, field: &mut Field<'_>, now: Time, longest: f64) -> Result<f64, BodyId>;

    /// Makes a step of exactly so many seconds, whatever its error.
    fn step_by(&mut self, field: &mut Field<'_>, now: Time, duration: f64);

    /// Puts the bodies where they are.
    fn write(&self, field: &Field<'_>, state: &mut State);
}

/// Whether a step of so many seconds is too short to change a time (s) in more than its last digits.
pub(super) fn is_too_short(step: f64, now: Time) -> bool {
    step.abs() <= 1e-15 * now.seconds().abs() || step.abs() < f64::MIN_POSITIVE
}
