//! Tests of contacts on curved surfaces, where the contact point moves on both bodies, against closed forms.

use glam::{DQuat, DVec3};
use jabuka::physics::{BodyId, Dynamics, RigidBody, Shape, World};

use crate::common::{frames, method};
use crate::contacts::{G, Table, advance, surface};

/// A fixed support that a body rolls or slides down: its shape, its radius R in m, and its orientation.
type Support = (Shape, f64, DQuat);

/// The body's starting angle, measured from the top of the support, rad.
const START: f64 = 0.3;

/// The radius of the body that moves, m.
const RADIUS: f64 = 0.1;

fn sphere() -> Support {
    (Shape::Sphere { radius: 1.0 }, 1.0, DQuat::IDENTITY)
}

/// Returns a support that is a cylinder along the z axis.
fn log() -> Support {
    (Shape::Cylinder { radius: 1.0, height: 3.0 }, 1.0, DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2))
}

/// Returns a world with a body of mass 1 at rest near the top of a fixed support. `is_first` makes the support the first of the two
/// bodies.
#[allow(clippy::unwrap_used, reason = "only tests call it")]
fn near_the_top(support: &Support, shape: &Shape, friction: f64, is_first: bool) -> (World, BodyId) {
    let mut table = Table::new(method("rk4"), true);
    let (under, radius, turn) = support;
    let mut body = None;
    for i in 0..2 {
        if (i == 0) == is_first {
            table.add(under.clone(), 1.0, surface(0.0, friction), |body| {
                body.with_orientation(*turn).with_fixed(true)
            });
        } else {
            let (sin, cos) = libm::sincos(START);
            let place = (radius + RADIUS) * DVec3::new(sin, cos, 0.0);
            body = Some(table.add(shape.clone(), 1.0, surface(0.0, friction), |body| {
                body.with_location(place).with_orientation(*turn)
            }));
        }
    }
    (table.build(), body.unwrap())
}

/// Checks the contact forces on curved supports. With k = I/(m r²), a rolling body has v² = 2 g h / (1 + k). The normal force is m g cos θ
/// − m v²/(R + r), the friction m g sin θ k / (1 + k). Without friction, k is 0. The normal force depends on the curvature of the path,
/// the friction on the rate of the slip; both have errors of the fourth power of the step.
#[test]
fn forces_on_curved_supports_are_those_of_theory() {
    let ball = Shape::Sphere { radius: RADIUS };
    let log_of_ball = Shape::Cylinder { radius: RADIUS, height: 1.0 };
    for (support, shape, friction, k) in [
        (sphere(), &ball, 0.0, 0.0),
        (sphere(), &ball, 2.0, 0.4),
        (log(), &ball, 0.0, 0.0),
        (log(), &ball, 2.0, 0.4),
        (log(), &log_of_ball, 2.0, 0.5),
    ] {
        for is_first in [true, false] {
            let (mut world, body) = near_the_top(&support, shape, friction, is_first);
            let way = support.1 + RADIUS;
            for t in [0.2, 0.4] {
                advance(&mut world, t);
                let place = world.location(body);
                let (sin, cos) = (place.x / way, place.y / way);
                let what = format!("{support:?} {shape:?} {friction} {is_first} {t}: {place}");
                assert!((place.length() - way).abs() < 1e-12, "{what}");
                let squared = 2.0 * G * way * (libm::cos(START) - cos) / (1.0 + k);
                assert!((world.velocity(body).length_squared() - squared).abs() < 1e-7, "{what}");
                let contacts = world.snapshot().unwrap().contacts;
                let normal: f64 = contacts.iter().map(|contact| contact.force.length()).sum();
                let held: f64 = contacts.iter().map(|contact| contact.friction.length()).sum();
                assert!((normal - (G * cos - squared / way)).abs() < 1e-6, "{what}: {normal}");
                assert!((held - G * sin * k / (1.0 + k)).abs() < 1e-6, "{what}: {held}");
            }
        }
    }
}

/// Checks that a ball sliding without friction leaves a sphere at cos θ = ⅔ cos θ₀. After that, its horizontal velocity is constant.
#[test]
fn a_ball_leaves_a_sphere_where_it_has_to() {
    let (mut world, ball) = near_the_top(&sphere(), &Shape::Sphere { radius: RADIUS }, 0.0, true);
    advance(&mut world, 1.0);
    assert!(world.snapshot().unwrap().contacts.is_empty());
    let cos = 2.0 / 3.0 * libm::cos(START);
    let speed = (2.0 * G * (1.0 + RADIUS) * (libm::cos(START) - cos)).sqrt();
    assert!((world.velocity(ball).x - speed * cos).abs() < 1e-7, "{}", world.velocity(ball));
}

/// Checks that a tilted can rolling on its rim conserves energy, and that its lowest point does not slip.
#[test]
fn a_can_that_rolls_on_its_rim_keeps_its_energy() {
    let mut table = Table::new(method("rk4"), true);
    table.add(Shape::Plane { normal: DVec3::Y }, 1.0, surface(0.0, 1.0), |body| body.with_fixed(true));
    let (radius, height, tilt) = (0.4, 0.2, 0.8);
    let turn = DQuat::from_rotation_z(tilt);
    let (sin, cos) = libm::sincos(tilt);
    let up = 0.5 * height * cos + radius * sin;
    // The vector from the can's center to the lowest point of its rim.
    let arm = turn * DVec3::new(-radius, -0.5 * height, 0.0);
    let omega = turn * DVec3::new(0.0, 6.0, 0.0) + DVec3::new(0.0, 1.0, 0.0);
    let can = table.add(Shape::Cylinder { radius, height }, 1.0, surface(0.0, 1.0), |body| RigidBody {
        angular_velocity: omega,
        ..body.with_location(DVec3::Y * up).with_orientation(turn).with_velocity(-omega.cross(arm))
    });
    assert!((arm.y + up).abs() < 1e-15);
    let mut world = table.build();
    world.set_step(1.0 / 2000.0);
    let before = world.balance();
    advance(&mut world, 0.5);
    let after = world.balance();
    assert!(after.drift.abs() < 1e-8, "{after:?}");
    assert!((after.total - before.total).abs() < 1e-8 * before.kinetic, "{before:?} {after:?}");
    assert!(world.location(can).x.abs() > 0.01, "it rolls");
}

/// A nearly flat coin falls and spins. Its lowest point runs around the rim, faster than any point of the coin, so the rim can come down
/// where it was high at the beginning of a step. No point of the rim enters the ground.
#[test]
fn no_rim_enters_the_ground() {
    const RADIUS: f64 = 0.5;
    const HEIGHT: f64 = 0.2;
    for (tilt, spin) in [(0.01_f64, 0.3), (0.01, 1.0), (0.01, 3.0), (0.001, 1.0), (0.001, 3.0)] {
        for turn in [30, 100, 170] {
            let (sin, cos) = libm::sincos(f64::from(turn).to_radians());
            let frames = frames(&format!(
                "[simulation]
                duration = 0.2
                frame_rate = 100
                step = 0.01
                gravity = [0, -9.81, 0]
                contacts = 'event-driven'
                integrator = 'velocity-verlet'
                [body.coin]
                shape.cylinder = {{ radius = {RADIUS}, height = {HEIGHT} }}
                location = [0, 0.12, 0]
                orientation = {{ axis = [1, 0, 0], angle = {angle} }}
                angular_velocity = [{x}, 0, {z}]
                restitution = 0.5
                friction = 0.3",
                angle = tilt.to_degrees(),
                x = -spin * cos,
                z = spin * sin,
            ));
            for frame in &frames {
                let coin = &frame.bodies[0];
                let axis = coin.orientation * DVec3::Y;
                let lean = axis.reject_from_normalized(DVec3::Y).length();
                let lowest = coin.location.y - RADIUS * lean - 0.5 * HEIGHT * axis.y.abs();
                assert!(lowest > -1e-9, "{tilt} {spin} {turn}, t = {}: {lowest:e}", frame.time);
            }
        }
    }
}
