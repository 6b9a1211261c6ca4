//! Scenes of the gallery against closed forms.

use glam::DVec3;
use jabuka::dynamics::BodySnapshot;
use jabuka::{Run, Scene};

/// The bodies of all frames, with their times.
fn frames(name: &str) -> Vec<(f64, Vec<BodySnapshot>)> {
    let scene = Scene::from_path(format!("scenes/{name}.toml")).unwrap_or_else(|report| panic!("{report}"));
    let run = Run::new(&scene).unwrap();
    run.frames().map(Result::unwrap).map(|frame| (frame.time, frame.bodies.clone())).collect()
}

/// The rate is the slow root of I₁ Ω² cos θ − I₃ s Ω + m g a = 0: H. Goldstein, *Classical Mechanics*, 3rd ed., 5.7.
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
