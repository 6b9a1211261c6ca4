//! Tests of sliding and rolling friction in all directions, against closed forms.

use glam::{DQuat, DVec3};
use jabuka::physics::{BodyId, Shape, Surface, World};

use crate::common::method;
use crate::contacts::{G, Table, advance, exact, surface};

/// The radius of the balls, m.
const RADIUS: f64 = 0.1;

/// Returns horizontal unit vectors; only the first two are along axes.
fn headings() -> impl Iterator<Item = DVec3> {
    [0.0_f64, 90.0, 37.0, 130.0, 245.0].into_iter().map(|angle| {
        let (sin, cos) = libm::sincos(angle.to_radians());
        DVec3::new(cos, 0.0, sin)
    })
}

/// Returns a world with a ball of mass 1 in contact with a plane. `friction` is the surface of the ball; the plane has no surface values
/// of its own. `motion` holds velocity and angular velocity.
fn ball_on_plane(
    method: &'static jabuka::physics::Method,
    normal: DVec3,
    friction: Surface,
    motion: (DVec3, DVec3),
) -> (World, BodyId) {
    let mut table = Table::new(method, true);
    table.add(Shape::Plane { normal }, 1.0, Surface::default(), |body| body.with_fixed(true));
    let ball = table.add(Shape::Sphere { radius: RADIUS }, 1.0, friction, |body| {
        body.with_location(RADIUS * normal).with_velocity(motion.0).with_angular_velocity(motion.1)
    });
    (table.build(), ball)
}

/// Checks that a rolling sphere decelerates by 5/7 μᵣ g / r in every direction, and then stays at rest.
#[test]
fn rolling_friction_is_the_same_in_all_directions() {
    let rolling = 0.002;
    let (speed, slowing) = (0.5, 5.0 / 7.0 * rolling * G / RADIUS);
    let friction = Surface { rolling_friction: Some(rolling), ..surface(0.0, 0.8) };
    for (method, heading) in exact().into_iter().flat_map(|method| headings().map(move |h| (method, h))) {
        let spin = DVec3::Y.cross(heading) * speed / RADIUS;
        let (mut world, ball) = ball_on_plane(method, DVec3::Y, friction, (speed * heading, spin));
        let way = |world: &World| world.location(ball) - RADIUS * DVec3::Y;
        advance(&mut world, 1.0);
        let expected = (speed - 0.5 * slowing) * heading;
        assert!((way(&world) - expected).length() < 1e-9, "{} {heading}: {}", method.name, way(&world));
        for t in [1.01 * speed / slowing, 2.0 * speed / slowing] {
            advance(&mut world, t);
            let expected = speed * speed / (2.0 * slowing) * heading;
            assert!((way(&world) - expected).length() < 1e-9, "{} {heading}: {}", method.name, way(&world));
            // A speed below 1e-9 of the initial speed counts as rest.
            assert!(world.velocity(ball).length() < 1e-9 * speed, "{}", method.name);
        }
    }
}

/// Checks a sphere on a plane inclined by α: it rolls with 5/7 g (sin α − μᵣ cos α / r), and stays at rest where this is negative.
#[test]
fn rolling_friction_holds_a_ball_on_a_slope_of_any_direction() {
    let alpha = 0.05_f64;
    let (sin, cos) = libm::sincos(alpha);
    for (method, down) in exact().into_iter().flat_map(|method| headings().map(move |h| (method, h))) {
        let normal = DQuat::from_axis_angle(DVec3::Y.cross(down).normalize(), alpha) * DVec3::Y;
        let along = down.reject_from_normalized(normal).normalize();
        for part in [0.5, 0.99, 1.2, 1.5] {
            let rolling = RADIUS * sin / cos / part;
            let friction = Surface { rolling_friction: Some(rolling), ..surface(0.0, 0.8) };
            let (mut world, ball) = ball_on_plane(method, normal, friction, (DVec3::ZERO, DVec3::ZERO));
            advance(&mut world, 2.0);
            let faster = 5.0 / 7.0 * G * (sin - rolling * cos / RADIUS);
            let expected = RADIUS * normal + 0.5 * faster.max(0.0) * 4.0 * along;
            let off = world.location(ball) - expected;
            assert!(off.length() < 1e-9, "{} {down} {part}: {off}", method.name);
        }
    }
}

/// Checks the direction of friction for a sphere that slides across a slope. Its slip u has du/dt = g sin α x̂ − 7/2 μ g cos α û, with x
/// downhill. If both terms have the same size, |u| + uₓ is constant while the slip turns from across the slope to downhill. rk4 with h =
/// 1/240 s has a relative error of about (h g sin α / u)⁴: 1e-6.
#[test]
fn friction_is_against_the_slip_while_that_turns() {
    let alpha = 0.3;
    let (sin, cos) = libm::sincos(alpha);
    let normal = DVec3::new(sin, cos, 0.0);
    let down = DVec3::new(cos, -sin, 0.0);
    let friction = sin / cos / 3.5;
    let start = 2.0 * DVec3::Z;
    let (mut world, ball) =
        ball_on_plane(method("rk4"), normal, surface(0.0, friction), (start, DVec3::ZERO));
    for i in 1..=20 {
        advance(&mut world, 0.1 * f64::from(i));
        let slip = world.velocity(ball) + world.angular_velocity(ball).cross(-RADIUS * normal);
        let sum = slip.length() + slip.dot(down);
        assert!((sum - 2.0).abs() < 1e-6, "{sum} {slip}");
    }
    let slip = world.velocity(ball) + world.angular_velocity(ball).cross(-RADIUS * normal);
    assert!(slip.dot(down) > 0.9 && slip.z < 0.5, "{slip}");
}

/// Checks a flat box that falls onto a floor while it slides: friction reduces the slip by μ (1 + e) times the speed of the fall, and the
/// box does not turn.
#[test]
fn friction_of_an_impact_is_at_most_what_the_normal_impulse_allows() {
    let (fall, friction) = (2.0, 0.2);
    for (slide, restitution) in [
        (DVec3::new(3.0, 0.0, 0.0), 0.0),
        (DVec3::new(0.0, 0.0, -3.0), 0.5),
        (DVec3::new(1.5, 0.0, -2.0), 0.0),
        (DVec3::new(1.5, 0.0, 2.0), 0.5),
    ] {
        let mut table = Table::new(method("velocity-verlet"), false);
        table.floor(Surface::default());
        let size = DVec3::new(1.0, 0.1, 0.8);
        let block = table.add(Shape::Box { size }, 3.0, surface(restitution, friction), |body| {
            body.with_location(DVec3::new(0.0, 0.06, 0.0)).with_velocity(slide - fall * DVec3::Y)
        });
        let mut world = table.build();
        advance(&mut world, 0.0051);
        let lost = friction * (1.0 + restitution) * fall;
        let expected = slide - lost * slide.normalize() + restitution * fall * DVec3::Y;
        let velocity = world.velocity(block);
        assert!((velocity - expected).length() < 1e-9, "{velocity} {expected}");
        assert!(world.angular_velocity(block).length() < 1e-9, "{}", world.angular_velocity(block));
    }
}
