//! Charges that act on each other.

use glam::DVec3;
use jabuka::dynamics::{Coulomb, Dynamics};

use crate::common::{ball, tolerance, worlds};

/// Two equal charges of 1 kg, let go at the distance r₀ = 1, at s times that distance: with the relative acceleration
/// 2 k q² / r² = 2 / r², energy gives r'² = 4 (1 − 1/r), and its integral t = ½ (√(s (s − 1)) + ln(√s + √(s − 1))).
#[test]
fn two_equal_charges_fly_apart() {
    let (distance, steps) = (4.0_f64, 2000);
    let (root, less) = (distance.sqrt(), (distance - 1.0).sqrt());
    let time = 0.5 * (root * less + libm::log(root + less));
    for (method, mut world, one) in worlds(ball().with_charge(1e-3).with_location(0.5 * DVec3::X)) {
        let two = world.add(ball().with_charge(1e-3).with_location(-0.5 * DVec3::X));
        world.add_force(Coulomb { bodies: vec![one, two], constant: 1e6, softening: 0.0 });
        world.set_step(time / f64::from(steps));
        world.advance_to(time);
        let off = ((world.location(one) - world.location(two)).length() - distance).abs();
        // The rate √(2 · 2 k q² / r³) is 2 /s at the start, and falls.
        let allowed = distance * tolerance(method, 2.0 * time, steps);
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
    }
}
