//! Computes the rotation of free bodies within a step of the physics engine.

use glam::{DQuat, DVec3};

/// The largest rotation of a body within a step, rad. Faster rotations are cut off at this angle.
const LARGEST: f64 = 3.0;

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
    let cosine = turn.w.max(libm::cos(0.5 * LARGEST));
    2.0 / dt / cosine * sine
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_then_leads_to_the_other_orientation() {
        let dt = 0.01;
        for turn in [DVec3::new(1.2, -0.3, 0.5), DVec3::new(1e-6, 0.0, 2e-6), DVec3::ZERO] {
            let from = DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7));
            let to = DQuat::from_scaled_axis(turn) * from;
            let omega = leading(from, to, dt);
            let half = 0.5 * dt * omega;
            let reached = (from + DQuat::from_xyzw(half.x, half.y, half.z, 0.0) * from).normalize();
            assert!(reached.abs_diff_eq(to, 1e-15), "{reached} {to}");
        }
    }
}
