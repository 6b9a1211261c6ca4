//! The softness of contacts in the engine for time-stepping, and the time step that follows from it.

/// The natural frequency of contacts as a fraction of the step frequency. It sets the stiffness of contacts. According to the authors of
/// the engine rapier, a quarter is the stiffest stable value.
pub(super) const CONTACT_FREQUENCY_RATIO: f64 = 0.25;

/// Returns the longest step (s) with which bodies of a given thickness (m) stand firmly under gravity (m/s²). The step is 1/240 s divided
/// by a power of two, at most by 32.
///
/// A contact with the natural frequency ω is as soft as a spring of stiffness m ω². Under ten times its own weight, a body may sink in by
/// 3 % of its thickness.
#[must_use]
pub fn suitable_step(thickness: f64, gravity: f64) -> f64 {
    /// The longest step that is suitable for any bodies, s.
    const MAX_STEP: f64 = 1.0 / 240.0;
    // Half of the depth by which a body sinks in comes from the damper that acts beside the spring.
    let softest =
        (0.03 * thickness / (2.0 * 10.0 * gravity)).sqrt() * std::f64::consts::TAU * CONTACT_FREQUENCY_RATIO;
    let mut step = MAX_STEP;
    while step > softest && step > MAX_STEP / 32.0 {
        step *= 0.5;
    }
    step
}
