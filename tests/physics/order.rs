//! Tests of the order of each method, measured as the slope of the error's logarithm over that of the step.

use glam::DVec3;
use jabuka::physics::{
    Anchor, BodyId, METHODS, Method, RigidBody, Shape, Spring, State, UniformGravity, World,
};

use crate::common::{SwingingField, air, ball, distance, method, tether};

/// The tolerance of the measured order. All problems last 1 s, have rates of about 2 /s, and are solved in 128 and in 256 steps.
///
/// The error is C hᵖ (1 + D h + …) with D about equal to the rate, so the slope deviates by D h / (2 ln 2) = 2 / 128 / 1.4, or 0.01. A
/// tolerance of 0.1 allows for a larger D, and is far from the next order. Rounding, 1e-15, is far below the 1e-10 of RK4.
const SLOPE_TOLERANCE: f64 = 0.1;

/// A function that solves one of the problems by a method in a number of steps. Returns the final state.
type Problem = fn(&'static Method, u32) -> State;

fn world(method: &'static Method, steps: u32, body: RigidBody) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(1.0 / f64::from(steps));
    world.add(body);
    world
}

fn assert_orders(problem: Problem, exact: &State) {
    for method in METHODS {
        let error = |steps| distance(&problem(method, steps), exact);
        let errors = (error(128), error(256));
        let slope = libm::log2(errors.0 / errors.1);
        let off = (slope - f64::from(method.order)).abs();
        assert!(off < SLOPE_TOLERANCE, "{}: order {slope}, errors {errors:?}", method.name);
    }
}

fn oscillator(method: &'static Method, steps: u32) -> State {
    let mut world = world(method, steps, ball().with_location(DVec3::X).with_velocity(DVec3::Y));
    world.add_force(tether(BodyId::new(0), 4.0, 0.0));
    world.advance_to(1.0);
    world.state().clone()
}

/// Checks the order on an oscillator: x = cos ωt, y = sin ωt / ω with ω = 2.
#[test]
fn order_on_an_oscillator() {
    let (sin, cos) = libm::sincos(2.0);
    let mut exact = oscillator(method("rk4"), 1);
    exact.location[0] = DVec3::new(cos, sin / 2.0, 0.0);
    exact.velocity[0] = DVec3::new(-2.0 * sin, cos, 0.0);
    assert_orders(oscillator, &exact);
}

fn linear_drag(method: &'static Method, steps: u32) -> State {
    let mut world = world(method, steps, ball().with_velocity(DVec3::X));
    world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -2.0, 0.0) });
    world.add_force(air(BodyId::new(0), 2.0));
    world.advance_to(1.0);
    world.state().clone()
}

/// Checks the order with linear drag: with c = 2, m = 1 and the terminal velocity u = (0, −1, 0), v = u + (v₀ − u) e^(−2t), and the
/// location is its integral. The work is −c ∫ v² dt = −2 ∫ e^(−4t) + (1 − e^(−2t))² dt = −2 (t − (1 − e^(−2t)) + (1 − e^(−4t)) / 2).
///
/// Plain velocity Verlet would fall to first order with this force.
#[test]
fn order_with_linear_drag() {
    let decay = libm::exp(-2.0);
    let (terminal, start) = (DVec3::NEG_Y, DVec3::X);
    let mut exact = linear_drag(method("rk4"), 1);
    exact.velocity[0] = terminal + (start - terminal) * decay;
    exact.location[0] = terminal + (start - terminal) * (1.0 - decay) / 2.0;
    exact.accounts.work = -2.0 * (1.0 - (1.0 - decay) + (1.0 - decay * decay) / 2.0);
    assert_orders(linear_drag, &exact);
}

fn rotation_under_torque(method: &'static Method, steps: u32) -> State {
    let body = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
        .with_inertia(DVec3::new(1.0, 2.0, 3.0))
        .with_orientation(glam::DQuat::from_rotation_x(1.0))
        .with_angular_velocity(DVec3::new(1.0, 1.5, -1.0))
        .with_torque(DVec3::new(1.0, -2.0, 3.0));
    let mut world = world(method, steps, body);
    world.advance_to(1.0);
    world.state().clone()
}

/// Checks the order of a rotation under a torque. It has no closed form: the reference is RK4 with 1/16 of the smallest step, whose error
/// is 16⁻⁴ of that of the smallest step. The other methods, which share no code with RK4, and the flip in `rotation.rs` confirm that RK4
/// converges to the right solution.
#[test]
fn order_of_a_rotation_under_torque() {
    assert_orders(rotation_under_torque, &rotation_under_torque(method("rk4"), 4096));
}

fn magnet(method: &'static Method, steps: u32) -> State {
    let body = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
        .with_inertia(DVec3::new(1.0, 2.0, 3.0))
        .with_orientation(glam::DQuat::from_rotation_z(2.0))
        .with_angular_velocity(DVec3::new(0.5, -0.7, 1.0));
    let mut world = world(method, steps, body);
    world.add_force(SwingingField);
    world.advance_to(1.0);
    world.state().clone()
}

/// Checks the order with loads that depend on time and on orientation, so that each must be evaluated at the right moment of the step. The
/// location has a closed form: v' = (cos 2t, 1, sin 2t) from rest. For the other quantities, the reference is RK4 with 4,096 steps.
#[test]
fn order_in_a_field_that_swings() {
    let mut exact = magnet(method("rk4"), 4096);
    let (sin, cos) = libm::sincos(2.0);
    exact.velocity[0] = DVec3::new(sin / 2.0, 1.0, (1.0 - cos) / 2.0);
    exact.location[0] = DVec3::new((1.0 - cos) / 4.0, 0.5, 0.5 - sin / 4.0);
    assert_orders(magnet, &exact);
}

fn hung(method: &'static Method, steps: u32) -> State {
    let body = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
        .with_inertia(DVec3::new(1.0, 2.0, 3.0))
        .with_velocity(DVec3::new(0.2, 0.5, -0.3))
        .with_angular_velocity(DVec3::new(0.5, -0.7, 1.0));
    let mut world = world(method, steps, body);
    let ball = world.add(ball().with_location(DVec3::new(2.0, 1.0, -1.0)));
    let hook = Anchor::Body { id: BodyId::new(0), at: DVec3::new(0.6, 0.4, -0.5) };
    let fixed = Anchor::Point(DVec3::new(0.0, 3.0, 1.0));
    for between in [[fixed, hook], [hook, Anchor::centre(ball)]] {
        world.add_force(Spring { between, stiffness: 3.0, damping: 0.5, rest_length: 1.0 });
    }
    world.advance_to(1.0);
    world.state().clone()
}

/// Checks the order for a body that turns because springs and dampers pull at a point of it. The reference is RK4 with 4,096 steps.
#[test]
fn order_of_a_body_hung_by_a_point() {
    assert_orders(hung, &hung(method("rk4"), 4096));
}
