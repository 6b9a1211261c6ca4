//! Integration of a body's orientation.

use glam::{DQuat, DVec3};

use super::super::model::is_isotropic;

/// Returns the time derivative of an orientation that rotates at `angular_velocity` (world axes, rad/s): q' = ½ ω q, where ω is a
/// quaternion without real part.
pub(crate) fn rate(orientation: DQuat, angular_velocity: DVec3) -> DQuat {
    let half = 0.5 * angular_velocity;
    DQuat::from_xyzw(half.x, half.y, half.z, 0.0) * orientation
}

/// Returns the orientation of a body after `dt` seconds of free rotation with the given angular momentum (world axes, kg m²/s).
///
/// With the angular momentum m = Rᵀ L in body axes, the kinetic energy is m₁²/2I₁ + m₂²/2I₂ + m₃²/2I₃. Each of the three terms alone
/// rotates the body uniformly about one of its own axes. These rotations are applied about x and y for half the time each, about z for the
/// whole time, then about y and x for the other half. This splitting is symmetric, so it is of second order and reversible; it is also
/// symplectic. It does not change L, so L is conserved exactly. Source: Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840;
/// Touma & Wisdom, Astron. J. 107 (1994) 1189.
pub(crate) fn free(orientation: DQuat, angular_momentum: DVec3, inverse_inertia: DVec3, dt: f64) -> DQuat {
    if is_isotropic(inverse_inertia) {
        // With three equal moments of inertia, ω is parallel to L and constant, so a single rotation is exact for any step.
        let turn = DQuat::from_scaled_axis(inverse_inertia.x * dt * angular_momentum);
        return (turn * orientation).normalize();
    }
    let half = 0.5 * dt;
    let mut body = Free { orientation, momentum: orientation.conjugate() * angular_momentum };
    for (axis, time) in [(0, half), (1, half), (2, dt), (1, half), (0, half)] {
        body.turn(axis, body.momentum[axis] * inverse_inertia[axis] * time);
    }
    body.orientation.normalize()
}

/// A freely rotating body: its orientation, and its angular momentum in body axes.
struct Free {
    orientation: DQuat,
    momentum: DVec3,
}

impl Free {
    /// Rotates the body by `angle` (rad) about one of its own axes. The angular momentum is fixed in the world, so it rotates backwards in
    /// body axes.
    fn turn(&mut self, axis: usize, angle: f64) {
        let (sin, cos) = libm::sincos(0.5 * angle);
        let turn = DQuat::from_vec4((DVec3::AXES[axis] * sin).extend(cos));
        self.orientation *= turn;
        let (sin, cos) = (2.0 * sin * cos, (cos - sin) * (cos + sin));
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let (mj, mk) = (self.momentum[j], self.momentum[k]);
        self.momentum[j] = cos * mj + sin * mk;
        self.momentum[k] = cos * mk - sin * mj;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The inverse moments of inertia about the body axes, 1/(kg m²).
    const INVERSE_INERTIA: DVec3 = DVec3::new(1.0, 0.5, 0.25);
    const L: DVec3 = DVec3::new(0.3, -1.0, 2.0);

    fn start() -> DQuat {
        DQuat::from_scaled_axis(DVec3::new(0.4, 0.5, -0.6))
    }

    #[test]
    fn the_frame_of_the_body_sees_the_same_momentum() {
        let mut body = Free { orientation: start(), momentum: start().conjugate() * L };
        for axis in 0..3 {
            body.turn(axis, 0.7);
        }
        assert!((body.orientation * body.momentum).abs_diff_eq(L, 1e-14));
    }

    #[test]
    fn a_free_rotation_can_be_undone() {
        let there = free(start(), L, INVERSE_INERTIA, 0.5);
        assert!(!there.abs_diff_eq(start(), 0.1));
        let back = free(there, L, INVERSE_INERTIA, -0.5);
        assert!(back.abs_diff_eq(start(), 1e-15));
    }

    /// The difference quotient of a free rotation over dt = 1e-6 must equal the rate. Its error is ½ q'' dt, where q'' is about 1.
    #[test]
    fn both_ways_to_turn_begin_with_the_same_rate() {
        for inverse in [INVERSE_INERTIA, DVec3::splat(0.5)] {
            let dt = 1e-6;
            let angular_velocity = start() * (inverse * (start().conjugate() * L));
            let moved = (free(start(), L, inverse, dt) - start()) * (1.0 / dt);
            assert!(moved.abs_diff_eq(rate(start(), angular_velocity), 1e-5));
        }
    }
}
