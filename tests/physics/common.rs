//! What the tests share.

use glam::DVec3;
use jabuka::dynamics::{
    Anchor, BodyId, Drag, Force, Loads, METHODS, Method, Moment, RigidBody, Shape, Spring, State, World,
};
use jabuka::simulate::Frame;
use jabuka::{Run, Scene};

/// A field B that swings with time; on each body, a force B and, as on a magnet along its x axis, a torque R x × B:
/// loads that depend on time and on orientation. Defined here, from outside: the list of forces is open.
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

/// A relative error to allow over a time of `angle` (rate × time, for an oscillation its phase) in `steps` steps.
///
/// One step of a method of order p is off by C z^(p+1), z = rate × dt, and there are `steps` of them: C angle zᵖ in
/// all. C is the first coefficient that the method's expansion has wrong, ½ for Euler, 1/12 for Verlet, 1/120 for
/// RK4, and at most 1 for any method worth having; 1 is taken. A method that loses an order exceeds it 1/z-fold.
pub(crate) fn tolerance(method: &Method, angle: f64, steps: u32) -> f64 {
    let z = angle / f64::from(steps);
    let mut tolerance = angle;
    for _ in 0..method.order {
        tolerance *= z;
    }
    // Rounding, where a method is better than that.
    tolerance + 1e-13 * f64::from(steps).sqrt()
}

/// A method by its name.
#[allow(clippy::panic, reason = "only tests call it")]
pub(crate) fn method(name: &str) -> &'static Method {
    Method::by_name(name).unwrap_or_else(|| panic!("no method {name}"))
}

/// The methods that keep joints.
pub(crate) fn that_keep_joints() -> impl Iterator<Item = &'static Method> {
    METHODS.iter().filter(|method| method.constraints)
}

/// A ball of 1 kg.
pub(crate) fn ball() -> RigidBody {
    RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0)
}

/// A world of one body, for each of the methods.
pub(crate) fn worlds(body: RigidBody) -> impl Iterator<Item = (&'static Method, World, BodyId)> {
    METHODS.iter().map(move |method| {
        let mut world = World::new();
        world.set_integrator(method);
        let id = world.add(body);
        (method, world, id)
    })
}

/// A spring of rest length 0 from the origin to a body.
pub(crate) fn tether(body: BodyId, stiffness: f64, damping: f64) -> Spring {
    let between = [Anchor::Point(DVec3::ZERO), Anchor::centre(body)];
    Spring { between, stiffness, damping, rest_length: 0.0 }
}

/// Linear drag on a body, in air at rest.
pub(crate) fn air(body: BodyId, linear: f64) -> Drag {
    Drag { bodies: vec![body], linear, quadratic: 0.0, wind: DVec3::ZERO }
}

/// Asserts that each method that keeps joints has its order over a second, up to `slack`, by its errors with steps of 1/256 s and 1/512 s. `build`
/// makes the world for a method and a step. The reference is RK4 with a sixteenth of the smaller step.
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

/// The largest deviation between two states, of all quantities.
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

/// All frames of a scene.
#[allow(clippy::panic, clippy::unwrap_used, reason = "it is part of tests")]
pub(crate) fn frames(text: &str) -> Vec<Frame> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    Run::new(&scene).unwrap().frames().map(Result::unwrap).collect()
}
