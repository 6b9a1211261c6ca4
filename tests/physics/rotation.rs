//! Tests of free rotation about the intermediate principal axis, which is unstable (Dzhanibekov's wing nut, the tennis racket).

use glam::DVec3;
use jabuka::physics::{BodyId, Method, RigidBody, Shape, World};

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

/// Returns the angular velocity of a body in body axes, rad/s.
fn in_body(world: &World, id: BodyId) -> DVec3 {
    world.orientation(id).conjugate() * world.angular_velocity(id)
}

/// Returns the allowed error of the angular velocity after a time, rad/s. A rotation at |ω| = 5 rad/s has the relative error `tolerance`.
/// Methods with split steps do not disturb the unstable rotation about the intermediate axis. RK4 does, and its errors grow with the
/// initial deviation of 0.001 rad/s, which grows to 5 rad/s: 5,000-fold.
fn allowed(method: &Method, time: f64) -> f64 {
    let growth = if method.name == "rk4" { 5000.0 } else { 1.0 };
    growth * tolerance(method, 5.0 * time, (time / STEP) as u32)
}

/// Checks the components at t = 10 s, during the second flip, where an error in the time of the flip is fully visible.
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

/// Checks the intervals between flips. A flip is the time at which the component of the angular velocity along the intermediate axis
/// changes sign. Linear interpolation has an error of third order at this time, as the second derivative is zero.
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
            // The error of a time is the error of an angle divided by the rate. The errors of the interval build up over `pair[1]`
            // seconds.
            let off = (pair[1] - pair[0] - 6.621_223_981_340_68).abs();
            let allowed = allowed(method, pair[1]) / 5.0;
            assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
        }
    }
}
