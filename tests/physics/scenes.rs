//! Tests of the gallery's scenes against closed forms.

use glam::DVec3;
use jabuka::physics::BodySnapshot;
use jabuka::{Run, Scene};

/// Simulates a scene of the gallery. Returns the time and the bodies of each frame.
#[allow(clippy::panic, clippy::unwrap_used, reason = "it is part of tests")]
fn frames(name: &str) -> Vec<(f64, Vec<BodySnapshot>)> {
    let scene = Scene::from_path(format!("scenes/{name}.toml")).unwrap_or_else(|report| panic!("{report}"));
    let run = Run::new(&scene).unwrap();
    run.frames().map(Result::unwrap).map(|frame| (frame.time, frame.bodies.clone())).collect()
}

/// Checks the precession rate, the slow root of I₁ Ω² cos θ − I₃ s Ω + m g a = 0: H. Goldstein, *Classical Mechanics*, 3rd ed., 5.7.
#[test]
fn the_gyroscope_precesses_at_the_rate_of_theory() {
    let (g, r, h, a, s) = (9.81, 0.15, 0.03, 0.25, 60.0);
    let (sin, cos) = libm::sincos(70_f64.to_radians());
    let (i1, i3) = ((3.0 * r * r + h * h) / 12.0 + a * a, r * r / 2.0);
    let rate = (i3 * s - ((i3 * s) * (i3 * s) - 4.0 * i1 * cos * g * a).sqrt()) / (2.0 * i1 * cos);

    let (mut turned, mut before) = (0.0, DVec3::X);
    let mut last = 0.0;
    for (time, bodies) in frames("precession") {
        let arm = bodies[0].location - DVec3::new(0.0, 0.4, 0.0);
        assert!((arm.y / a - cos).abs() < 1e-6, "the tilt changes: {arm} at {time} s");
        let level = DVec3::new(arm.x, 0.0, arm.z) / (a * sin);
        turned += libm::atan2(before.cross(level).y, before.dot(level));
        (before, last) = (level, time);
    }
    let off = turned / last / rate - 1.0;
    assert!(off.abs() < 1e-6, "{off:e}");
}

/// Returns the location of a body's point in world axes, m. `at` is the point in body axes.
fn point(body: &BodySnapshot, at: DVec3) -> DVec3 {
    body.location + body.orientation * at
}

#[test]
fn the_four_bar_linkage_stays_closed() {
    let u = 0.2;
    for (time, bodies) in frames("four_bar") {
        let [crank, rocker, coupler] = [&bodies[0], &bodies[1], &bodies[2]];
        let loose = [
            point(crank, DVec3::new(0.5 * u, 0.0, 0.0)) - DVec3::new(0.0, 0.3, 0.0),
            point(crank, DVec3::new(-0.5 * u, 0.0, 0.02)) - point(coupler, DVec3::new(-2.5 * u, 0.0, -0.02)),
            point(rocker, DVec3::new(1.25 * u, 0.0, 0.02)) - point(coupler, DVec3::new(0.0, 0.0, -0.02)),
            point(rocker, DVec3::new(-1.25 * u, 0.0, 0.0)) - DVec3::new(2.0 * u, 0.3, 0.0),
        ];
        let worst = loose.into_iter().map(DVec3::length).fold(0.0, f64::max);
        assert!(worst < 1e-12, "{worst:e} at {time} s");
    }
}

/// Checks Jellett's integral of a tippe top: while only its ball touches the floor, the scalar product of its angular momentum and the
/// vector from its center of mass to the contact point is constant: J. H. Jellett, *A Treatise on the Theory of Friction*, 1872. Finally
/// it stands on its stem.
#[test]
fn the_tippe_top_keeps_the_integral_of_jellett_and_turns_over() {
    use std::f64::consts::PI;
    // Lengths are in radii of the ball, masses in masses of the ball, and moments of inertia relative to the largest one.
    let (stem, high) = (0.15_f64, 0.9);
    let ball = 4.0 / 3.0 * PI;
    let stem = (PI * stem * stem * (high - 2.0 * stem) + ball * (stem * stem * stem)) / ball;
    let heavy = 2.0 * (0.7 * 0.7 * 0.7);
    let offset = (0.25 * heavy - 1.05 * stem) / (1.0 + heavy + stem);
    let jellett = |body: &BodySnapshot| {
        let axis = body.orientation * DVec3::Y;
        let spin = body.angular_velocity.dot(axis) * axis;
        let momentum = 0.95 * (body.angular_velocity - spin) + spin;
        momentum.dot(DVec3::Y - offset * axis)
    };
    let frames = frames("tippe_top");
    let tilt = |body: &BodySnapshot| libm::acos((body.orientation * DVec3::Y).y).to_degrees();
    let first = jellett(&frames[0].1[0]);
    let on_its_ball: Vec<_> = frames.iter().take_while(|(_, bodies)| tilt(&bodies[0]) < 120.0).collect();
    assert!(on_its_ball.len() > 200, "{}", on_its_ball.len());
    for (time, bodies) in on_its_ball {
        // The error of rk4 with 0.15 rad per step; the measured error is 2.4e-7.
        let off = jellett(&bodies[0]) / first - 1.0;
        assert!(off.abs() < 1e-6, "{off:e} at {time} s");
    }
    let late = frames.iter().filter(|(time, _)| *time > 2.6);
    assert!(late.into_iter().all(|(_, bodies)| tilt(&bodies[0]) > 150.0));
}
