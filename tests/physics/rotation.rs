//! Free rotation about the middle axis (Dzhanibekov's nut, the tennis racket).

use glam::DVec3;
use jabuka::dynamics::{BodyId, Method, RigidBody, Shape, World};

use crate::common::{method, tolerance};

const STEP: f64 = 1.0 / 4000.0;

fn nut(method: &'static Method) -> (World, BodyId) {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(STEP);
    let nut = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
        .with_inertia(DVec3::new(1.0, 2.0, 3.0))
        .with_angular_velocity(DVec3::new(0.001, 5.0, 0.001));
    let id = world.add(nut);
    (world, id)
}

/// The angular velocity as seen in the frame of the body.
fn in_body(world: &World, id: BodyId) -> DVec3 {
    world.orientation(id).conjugate() * world.angular_velocity(id)
}

/// What turns at |ω| = 5 rad/s for `time` has the relative error `tolerance`. Split steps keep the rotation about
/// the middle axis, from which the nut departs, as it is; those of RK4 disturb it, and what disturbs the 0.001 rad/s
/// by which the nut is off the axis grows with it, to 5 rad/s: 5,000-fold.
fn allowed(method: &Method, time: f64) -> f64 {
    let growth = if method.name == "rk4" { 5000.0 } else { 1.0 };
    growth * tolerance(method, 5.0 * time, (time / STEP) as u32)
}

/// The components at t = 10 s, during the second flip: with them the whole error of the time of the flip is seen.
#[test]
fn the_angular_velocity_during_the_second_flip() {
    const END: DVec3 = DVec3::new(4.510_627_124_012, -2.157_369_682_769, 2.604_211_912_26);
    for method in ["velocity-verlet", "rk4"].map(method) {
        let (mut world, id) = nut(method);
        world.advance_to(10.0);
        let off = (in_body(&world, id) - END).length();
        let allowed = 5.0 * allowed(method, 10.0);
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
    }
}

/// A flip is when the angular velocity about the middle axis passes through zero. Linear interpolation is good to
/// third order there, as the second derivative is zero, too.
#[test]
fn the_nut_flips_at_equal_intervals() {
    for method in ["velocity-verlet", "rk4"].map(method) {
        let (mut world, id) = nut(method);
        let mut flips = Vec::new();
        let mut last = in_body(&world, id).y;
        while flips.len() < 4 {
            let time = world.time();
            world.step(STEP);
            let now = in_body(&world, id).y;
            if last * now < 0.0 {
                flips.push(time + STEP * last / (last - now));
            }
            last = now;
        }
        assert!((flips[0] - 3.539).abs() < 5e-4, "{}: {}, given to 3 digits", method.name, flips[0]);
        for pair in flips.windows(2) {
            // Angle over rate; the interval lies within `pair[1]` seconds of errors.
            let off = (pair[1] - pair[0] - 6.621_223_981_340_68).abs();
            let allowed = allowed(method, pair[1]) / 5.0;
            assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
        }
    }
}
