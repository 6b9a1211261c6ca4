//! Rotations within a step, as the physics engine makes them.

use glam::{DQuat, DVec3};

use super::super::integrator::turn_freely;
use super::super::model::is_isotropic;

/// The largest rotation of a body within a step, rad. Faster rotations are cut off at this angle.
const MAX_ROTATION_PER_STEP: f64 = 3.0;

/// Returns the angular velocity (world axes, rad/s) with which the physics engine rotates a body from orientation `from` to `to` within
/// `dt`, s.
///
/// The engine advances orientations along a straight line, q + ½ ω q dt, and normalises the result. This rotates a body by 2 atan(½ ω dt),
/// so a rotation by φ needs ω = 2 tan(½ φ)/dt.
pub(super) fn leading(from: DQuat, to: DQuat, dt: f64) -> DVec3 {
    let turn = to * from.conjugate();
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let sine = DVec3::new(turn.x, turn.y, turn.z);
    // The tangent is tan(½ φ) = sin(½ φ)/cos(½ φ). A lower bound of the cosine limits the angle.
    let cosine = turn.w.max(libm::cos(0.5 * MAX_ROTATION_PER_STEP));
    2.0 / dt / cosine * sine
}

/// Returns the orientation to which the physics engine rotates a body within `dt` seconds, from an orientation and an angular velocity
/// (world axes, rad/s).
pub(super) fn advanced(from: DQuat, turning: DVec3, dt: f64) -> DQuat {
    let half = 0.5 * dt * turning;
    (from + DQuat::from_xyzw(half.x, half.y, half.z, 0.0) * from).normalize()
}

/// Returns the angular velocity (world axes, rad/s) with which the physics engine rotates a body as free rotation would rotate it within
/// `dt`, s. The body has the orientation `from` and the angular momentum `momentum` (world axes, kg m²/s).
pub(super) fn free(from: DQuat, momentum: DVec3, inverse_inertia: DVec3, dt: f64) -> DVec3 {
    if momentum == DVec3::ZERO {
        return DVec3::ZERO;
    }
    if is_isotropic(inverse_inertia) {
        // The body rotates uniformly, by φ = |ω| dt about the direction of ω. See `leading` for the factor.
        return steady(inverse_inertia.x * momentum, dt);
    }
    leading(from, turn_freely(from, momentum, inverse_inertia, dt), dt)
}

/// Returns the angular velocity (world axes, rad/s) with which the physics engine rotates a body as a rotation at the constant angular
/// velocity `turning` would rotate it within `dt`, s.
pub(super) fn steady(turning: DVec3, dt: f64) -> DVec3 {
    tangent_ratio(0.25 * dt * dt * turning.length_squared()) * turning
}

/// Returns tan(h)/h for an angle h ≥ 0, rad, from its square. Larger angles than `MAX_ROTATION_PER_STEP`/2 are cut off.
fn tangent_ratio(squared: f64) -> f64 {
    /// The first coefficients of the series of tan(h)/h in powers of h². Source: Abramowitz & Stegun, 4.3.67.
    const TANGENT_SERIES: [f64; 6] =
        [1.0, 1.0 / 3.0, 2.0 / 15.0, 17.0 / 315.0, 62.0 / 2835.0, 1382.0 / 155_925.0];
    // Up to this angle, the first term that is left out is below 1e-18.
    const MAX_SERIES_ANGLE: f64 = 0.05;
    if squared < MAX_SERIES_ANGLE * MAX_SERIES_ANGLE {
        return TANGENT_SERIES.iter().rev().fold(0.0, |sum, coefficient| sum * squared + coefficient);
    }
    let angle = libm::sqrt(squared);
    libm::tan(angle.min(0.5 * MAX_ROTATION_PER_STEP)) / angle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_needs_no_orientation_to_rotate_freely() {
        let (from, inverse, dt) = (DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7)), 2.5, 0.01);
        let axis = DVec3::new(0.6, 0.0, -0.8);
        for angle in [1e-9, 0.02, 0.0999, 0.1001, 1.0, 2.9] {
            let momentum = angle / dt / inverse * axis;
            let expected = leading(from, turn_freely(from, momentum, DVec3::splat(inverse), dt), dt);
            let found = free(from, momentum, DVec3::splat(inverse), dt);
            // The orientations are rounded to 1e-16, and the tangent has the slope 1/cos².
            let cos = libm::cos(0.5 * angle);
            assert!((found - expected).length() < 1e-15 / dt / (cos * cos), "{angle}: {found} {expected}");
        }
    }

    #[test]
    fn a_straight_line_then_leads_to_the_other_orientation() {
        let dt = 0.01;
        for turn in [DVec3::new(1.2, -0.3, 0.5), DVec3::new(1e-6, 0.0, 2e-6), DVec3::ZERO] {
            let from = DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7));
            let to = DQuat::from_scaled_axis(turn) * from;
            let omega = leading(from, to, dt);
            let reached = advanced(from, omega, dt);
            assert!(reached.abs_diff_eq(to, 1e-15), "{reached} {to}");
        }
    }
}
