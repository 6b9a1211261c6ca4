//! Helpers for all tests of the physics.

use glam::DVec3;
use jabuka::physics::{
    Anchor, BodyId, Drag, Force, Loads, METHODS, Method, Moment, RigidBody, Shape, Spring, State,
    UniformGravity, World,
};
use jabuka::simulate::Frame;
use jabuka::{Run, Scene};

/// A field B that oscillates in time. It exerts on each body a force B and a torque R x × B, as on a magnet along the body's x axis. These
/// loads depend on time and on orientation. Defined outside the library, it also shows that users can add forces.
pub(crate) struct SwingingField;

impl Force for SwingingField {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let (sin, cos) = libm::sincos(2.0 * moment.time);
        let field = DVec3::new(cos, 1.0, sin);
        for (i, orientation) in moment.state.orientation.iter().enumerate() {
            let torque = (orientation * DVec3::X).cross(field);
            loads.torque[i] += torque;
            loads.force[i] += field;
            loads.power.work += torque.dot(moment.model.angular_velocity(i, moment.state));
            loads.power.work += field.dot(moment.state.velocity[i]);
        }
    }

    fn potential(&self, _: &Moment) -> f64 {
        0.0
    }
}

/// Returns the allowed relative error of a method over a time of `angle` (rate × time; for an oscillator, its phase) in `steps` steps.
///
/// One step of a method of order p has the error C z^(p+1) with z = rate × dt, and there are `steps` of them: C angle zᵖ in all. C is the
/// first wrong coefficient of the method's expansion: ½ for Euler, 1/12 for Verlet, 1/120 for RK4, and at most 1 for any useful method, so
/// 1 is used here. A method with an order too low exceeds this by a factor of 1/z.
pub(crate) fn tolerance(method: &Method, angle: f64, steps: u32) -> f64 {
    let z = angle / f64::from(steps);
    let mut tolerance = angle;
    for _ in 0..method.order {
        tolerance *= z;
    }
    // Allow for rounding where the method's own error is smaller.
    tolerance + 1e-13 * f64::from(steps).sqrt()
}

/// Returns the integration method of this name.
#[allow(clippy::panic, reason = "only tests call it")]
pub(crate) fn method(name: &str) -> &'static Method {
    Method::by_name(name).unwrap_or_else(|| panic!("no method {name}"))
}

/// Returns the methods that support joints.
pub(crate) fn that_keep_joints() -> impl Iterator<Item = &'static Method> {
    METHODS.iter().filter(|method| method.constraints)
}

/// Returns the largest energy drift, by magnitude, of all frames.
pub(crate) fn drift(frames: &[Frame]) -> f64 {
    frames.iter().map(|frame| frame.balance.drift.abs()).fold(0.0, f64::max)
}

/// Returns the frames of two boxes that stand on each other until a ball hits them, 0.7 s after the start. `settings` are further lines of
/// `[simulation]`.
pub(crate) fn boxes_that_a_ball_hits(settings: &str) -> Vec<Frame> {
    frames(&format!(
        r#"
        [simulation]
        duration = 1.2
        frame_rate = 50
        gravity = [0, -9.81, 0]
        {settings}
        [body.box]
        repeat = 2
        shape.box.size = [0.4, 0.4, 0.4]
        mass = 1
        location = [0, "0.2+0.4*i", 0]
        [body.ball]
        shape.sphere.radius = 0.1
        mass = 0.5
        location = [-2.3, 0.6, 0]
        velocity = [2, 3, 0]
        "#
    ))
}

/// The gravitational acceleration of worlds from [`falling`], m/s².
pub(crate) const G: f64 = 9.81;

/// Returns an empty world with an integration method and a step, s.
pub(crate) fn world(method: &'static Method, step: f64) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(step);
    world
}

/// Returns an empty world with gravity [`G`] along −y.
pub(crate) fn falling(method: &'static Method, step: f64) -> World {
    let mut world = world(method, step);
    world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -G, 0.0) });
    world
}

/// Returns the origin of the world, as the end of a joint.
pub(crate) fn origin() -> Anchor {
    Anchor::Point(DVec3::ZERO)
}

/// Returns a scene without gravity and ground, in which an arm can touch the rotor that carries it. `times` holds the keys of the
/// simulation's times, and `bodies` the tables of `rotor` and `arm`. The rotor has its axle at `middle`, and the arm its elbow at `elbow`,
/// both m; all hinges are along z.
pub(crate) fn arm_on_rotor(times: &str, bodies: &str, [middle, elbow]: [DVec3; 2]) -> String {
    format!(
        "[simulation]
        {times}
        gravity = [0, 0, 0]
        contacts = 'event-driven'
        integrator = 'velocity-verlet'
        [environment]
        ground = false
        {bodies}
        [joint.axle.hinge]
        between = [{:?}, 'rotor']
        axis = [0, 0, 1]
        [joint.elbow.hinge]
        between = ['rotor', 'arm']
        at = {:?}
        axis = [0, 0, 1]
        collides = true",
        middle.to_array(),
        elbow.to_array(),
    )
}

/// Runs a scene in which a torque presses an arm on the rotor that carries it, about an axle at `place`, and returns its frames. The arm
/// first closes a gap of 1 mm, and hits the rotor.
pub(crate) fn pressed_arm(place: DVec3, (duration, frame_rate, step): (f64, u32, f64)) -> Vec<Frame> {
    let times = format!("duration = {duration}\nframe_rate = {frame_rate}\nstep = {step}");
    let bodies = format!(
        "[defaults.body]
        friction = 0.5
        [body.rotor]
        shape.box.size = [2, 0.2, 0.2]
        location = {:?}
        mass = 4
        [body.arm]
        shape.box.size = [1, 0.1, 0.1]
        location = {:?}
        torque = [0, 0, -2]
        mass = 1",
        place.to_array(),
        (place + DVec3::new(0.5, 0.151, 0.0)).to_array(),
    );
    frames(&arm_on_rotor(&times, &bodies, [place, place + DVec3::new(0.1, 0.151, 0.0)]))
}

/// Returns a ball with a radius of 0.1 m and a mass of 1 kg.
pub(crate) fn ball() -> RigidBody {
    RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0)
}

/// Returns, for each method, a world with one body.
pub(crate) fn worlds(body: RigidBody) -> impl Iterator<Item = (&'static Method, World, BodyId)> {
    METHODS.iter().map(move |method| {
        let mut world = World::new();
        world.set_integrator(method);
        let id = world.add(body);
        (method, world, id)
    })
}

/// Returns a spring of rest length 0 between the origin and a body's center.
pub(crate) fn tether(body: BodyId, stiffness: f64, damping: f64) -> Spring {
    let between = [Anchor::Point(DVec3::ZERO), Anchor::centre(body)];
    Spring { between, stiffness, damping, rest_length: 0.0 }
}

/// Returns a linear drag force on a body in still air.
pub(crate) fn air(body: BodyId, linear: f64) -> Drag {
    Drag { bodies: vec![body], linear, quadratic: 0.0, wind: DVec3::ZERO }
}

/// Asserts that each method that supports joints has its order over 1 s, up to `slack`, by its errors with steps of 1/256 s and 1/512 s.
/// `build` makes the world for a method and a step. The reference is RK4 with a sixteenth of the smaller step.
pub(crate) fn assert_orders(slack: f64, build: impl Fn(&'static Method, f64) -> World) {
    let end = |method, steps: u32| {
        let mut world = build(method, 1.0 / f64::from(steps));
        world.advance_to(1.0);
        world.state().clone()
    };
    let exact = end(method("rk4"), 8192);
    for method in that_keep_joints() {
        let errors = [256, 512].map(|steps| distance(&end(method, steps), &exact));
        let slope = libm::log2(errors[0] / errors[1]);
        let is_right = (slope - f64::from(method.order)).abs() < slack;
        assert!(is_right, "{}: order {slope}, errors {errors:?}", method.name);
    }
}

/// Returns the largest difference between two states over all their quantities.
pub(crate) fn distance(a: &State, b: &State) -> f64 {
    let mut largest = (a.accounts.work - b.accounts.work).abs();
    for i in 0..a.len() {
        largest = largest
            .max((a.location[i] - b.location[i]).length())
            .max((a.velocity[i] - b.velocity[i]).length())
            .max((a.orientation[i] - b.orientation[i]).length())
            .max((a.angular_momentum[i] - b.angular_momentum[i]).length());
    }
    largest
}

/// Simulates a scene and returns all its frames.
#[allow(clippy::panic, clippy::unwrap_used, reason = "it is part of tests")]
pub(crate) fn frames(text: &str) -> Vec<Frame> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    Run::new(&scene).unwrap().frames().map(Result::unwrap).collect()
}
