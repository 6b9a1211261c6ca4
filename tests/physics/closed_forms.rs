//! Tests of motions with closed-form solutions.

use glam::DVec3;
use jabuka::physics::{Drag, METHODS, UniformGravity};

use crate::common::{air, ball, method, tether, tolerance, worlds};

/// Checks the ball of the tutorial. Under a constant force, the error of Euler–Cromer is exactly −½ a t dt (the velocity is one step
/// ahead), that of explicit Euler +½ a t dt; every method of second or higher order is exact. Rounding remains: 200 sums of numbers up to
/// 24, each rounded by 2e-15 at most.
#[test]
fn the_ball_of_the_tutorial() {
    let ball = ball()
        .with_location(DVec3::new(20.0, 0.0, 0.0))
        .with_velocity(DVec3::new(2.0, 10.0, 0.0))
        .with_force(DVec3::new(0.0, -1.0, 0.0));
    for (method, mut world, id) in worlds(ball) {
        world.set_step(0.01);
        world.advance_to(2.0);
        let y = match method.name {
            "euler-cromer" => 17.99,
            "explicit-euler" => 18.01,
            _ => 18.0,
        };
        let off = (world.location(id) - DVec3::new(24.0, y, 0.0)).length();
        assert!(off < 1e-12, "{}: {off:e}", method.name);
    }
}

/// Checks that a force changed between steps acts at once: methods of second or higher order stay exact. If the first step used the stored
/// loads of the previous step, the error would be ½ · 1 N · dt · 1 s = 5e-3.
#[test]
fn a_force_applied_half_way_acts_from_then_on() {
    for (method, mut world, id) in worlds(ball()).filter(|(method, ..)| method.order >= 2) {
        world.set_step(0.01);
        world.advance_to(1.0);
        world.apply_force(id, DVec3::X);
        world.advance_to(2.0);
        let off = (world.location(id) - DVec3::new(0.5, 0.0, 0.0)).length();
        assert!(off < 1e-12, "{}: {off:e}", method.name);
    }
}

/// Checks a projectile with m x'' = −c x' − m g: x = u t + (v₀ − u)(1 − e^(−ct/m)) m/c, with the terminal velocity u = −g m/c.
#[test]
fn a_projectile_with_linear_drag() {
    const END: DVec3 = DVec3::new(77.754_533_795_484_6, 63.630_037_238_547_6, 0.0);
    let (time, steps, rate) = (3.0, 300, 0.1);
    for (method, mut world, id) in worlds(ball().with_velocity(DVec3::new(30.0, 40.0, 0.0))) {
        world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -9.81, 0.0) });
        world.add_force(air(id, rate));
        world.set_step(time / f64::from(steps));
        world.advance_to(time);
        let off = (world.location(id) - END).length();
        // The decaying part of the velocity is v₀ − u, 141 m/s; it covers the distance (v₀ − u) m/c.
        let allowed = 1410.0 * tolerance(method, rate * time, steps);
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
    }
}

/// Checks a fall from rest with m v' = m g − c v²: v = u tanh(g t / u) with the terminal velocity u = √(m g / c), and the distance as its
/// integral.
#[test]
fn a_fall_with_quadratic_drag_reaches_its_terminal_velocity() {
    let (time, steps, gravity, quadratic) = (6.0, 600, 9.81, 0.1);
    let terminal: f64 = f64::sqrt(gravity / quadratic);
    let ratio = gravity * time / terminal;
    let (way, speed) =
        (terminal * terminal / gravity * libm::log(libm::cosh(ratio)), terminal * libm::tanh(ratio));
    assert!(speed > 0.9999 * terminal);
    for (method, mut world, id) in worlds(ball()) {
        world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -gravity, 0.0) });
        world.add_force(Drag { quadratic, ..air(id, 0.0) });
        world.set_step(time / f64::from(steps));
        world.advance_to(time);
        // Near the terminal velocity, deviations decay with the rate 2 g / u. The error of the distance is at most that of the speed,
        // times the decay time.
        let tolerance = tolerance(method, 2.0 * ratio, steps);
        let off = (world.velocity(id) + speed * DVec3::Y).length();
        assert!(off < terminal * tolerance, "{}: {off:e}", method.name);
        let off = (world.location(id) + way * DVec3::Y).length();
        assert!(off < terminal * terminal / (2.0 * gravity) * tolerance, "{}: {off:e}", method.name);
    }
}

/// Checks a ball carried by wind: the relative velocity u = w − v obeys m u' = −c u², so u = w / (1 + c w t / m).
#[test]
fn a_wind_carries_a_ball_along() {
    let (time, steps, quadratic, wind) = (2.0, 500, 0.5, 3.0);
    let rate = quadratic * wind;
    let way = wind * time - libm::log(1.0 + rate * time) / quadratic;
    for (method, mut world, id) in worlds(ball()) {
        world.add_force(Drag { quadratic, wind: wind * DVec3::X, ..air(id, 0.0) });
        world.set_step(time / f64::from(steps));
        world.advance_to(time);
        let off = (world.location(id) - way * DVec3::X).length();
        // Deviations decay with the rate 2 c u, at first 2 c w.
        let allowed = wind / (2.0 * rate) * tolerance(method, 2.0 * rate * time, steps);
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
    }
}

/// Checks m x'' + c x' + k x = 0 with m = 1, c = 2, k = 100, from rest at x = 1. Before t = 2 the ball passes the anchor, where the spring
/// has length 0, six times.
#[test]
fn a_damped_spring() {
    for (method, mut world, id) in worlds(ball().with_location(DVec3::X)) {
        world.add_force(tether(id, 100.0, 2.0));
        world.set_step(1e-3);
        for (time, steps, x) in [(1.0, 1000, -0.336_851_680_590_413), (5.0, 5000, 0.005_526_103_306_932_69)] {
            world.advance_to(time);
            let off = (world.location(id) - DVec3::new(x, 0.0, 0.0)).length();
            // The angular frequency is 10 rad/s; the amplitude has fallen to e^(−t).
            let allowed = libm::exp(-time) * tolerance(method, 10.0 * time, steps);
            assert!(off < allowed, "{} at {time}: {off:e} > {allowed:e}", method.name);
        }
    }
}

/// Checks that the method can be changed during a run. Each half of the run has the error of its own method; the second half, by
/// Euler–Cromer, has the error −½ a t dt with t = 1.
#[test]
fn the_method_is_exchanged_at_run_time() {
    for (first, mut world, id) in worlds(ball().with_force(DVec3::Y)) {
        world.set_step(0.01);
        world.advance_to(1.0);
        world.set_integrator(method("euler-cromer"));
        assert_eq!(world.integrator().name, METHODS[0].name);
        let before = world.location(id).y;
        world.advance_to(2.0);
        let way = world.location(id).y - before;
        assert!((way - 1.505).abs() < 1e-12, "{} first: {way}", first.name);
    }
}
