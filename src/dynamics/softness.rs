//! The softness of contacts in time-stepping, and the step that follows from it.

/// The stiffness of contacts: their natural frequency as a fraction of the step frequency. The engine's authors find that a quarter is
/// the stiffest stable value.
pub(super) const STIFFNESS: f64 = 0.25;

/// The longest step (s) with which bodies of some thickness (m) stand well under a gravity (m/s²). It divides 1/240 s.
///
/// A contact with the natural frequency ω is as soft as a spring of stiffness m ω². Under ten times its own weight, a body may sink in by
/// 3 % of its thickness.
#[must_use]
pub fn suitable_step(thickness: f64, gravity: f64) -> f64 {
    const USUAL: f64 = 1.0 / 240.0;
    // Half of a contact's sinking comes from the damper beside the spring.
    let softest = (0.03 * thickness / (2.0 * 10.0 * gravity)).sqrt() * std::f64::consts::TAU * STIFFNESS;
    let mut step = USUAL;
    while step > softest && step > USUAL / 32.0 {
        step *= 0.5;
    }
    step
}
