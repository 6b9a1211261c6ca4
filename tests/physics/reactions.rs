//! Tests of the constraint forces and torques of joints against closed forms.

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, Ball, BodyId, Dynamics, Fixed, Freedom, Hinge, METHODS, Method, Motor, Presence, Reaction, Rod,
    Rope, Slider, UniformGravity, World,
};

use crate::common::{ball, method};

const G: f64 = 9.81;

/// Returns a world with gravity and a ball of 1 kg at a location, and the ball.
fn world(method: &'static Method, location: DVec3) -> (World, BodyId) {
    let mut world = World::new();
    world.set_integrator(method);
    world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -G, 0.0) });
    let body = world.add(ball().with_location(location));
    (world, body)
}

#[allow(clippy::unwrap_used, reason = "only tests call it")]
fn reaction(world: &mut World) -> Reaction {
    world.snapshot().unwrap().reactions[0]
}

/// A motor turns a wheel whose axle also bears a weight beside it. The motor's part is its own torque, up to its limit or as its angle
/// asks for, and the whole torque has the bending moment of the weight, too.
#[test]
fn the_part_of_a_motor_is_its_own_torque() {
    struct Swing;
    impl std::fmt::Debug for Swing {
        fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            f.write_str("0.5 sin 2t")
        }
    }
    impl jabuka::physics::Target for Swing {
        fn at(&self, t: f64) -> [f64; 3] {
            let (sin, cos) = (libm::sin(2.0 * t), libm::cos(2.0 * t));
            [0.5 * sin, cos, -2.0 * sin]
        }
    }
    let mass = ball().mass;
    let inertia = ball().inertia.y;
    for method in methods() {
        let torque = |motor: Motor, limits: Option<[f64; 2]>, spin: f64| {
            let (mut world, _) = world(method, DVec3::X * 9.0);
            let location = DVec3::new(0.0, 0.7, 0.0);
            let body = world.add(ball().with_location(location).with_angular_velocity(DVec3::Y * spin));
            let between = [ORIGIN, Anchor::Body { id: body, at: -location }];
            let hinge = Hinge::new(between, DVec3::Y, DQuat::IDENTITY);
            world.add_constraint(hinge.with(Freedom { motor: Some(motor), limits }));
            world.advance_to(0.3);
            (reaction(&mut world).motor, reaction(&mut world).torque.dot(DVec3::Y))
        };
        // A weak motor that never reaches its speed gives all that it has.
        let weak = torque(Motor::Speed { speed: 1e6, limit: 0.2 }, None, 0.0);
        assert!((weak.0 - 0.2).abs() < 1e-12 && (weak.1 - 0.2).abs() < 1e-11, "{weak:?}");
        let back = torque(Motor::Speed { speed: -1e6, limit: 0.2 }, Some([-3.0, 3.0]), 0.0);
        assert!((back.0 + 0.2).abs() < 1e-12, "{back:?}");
        // A motor that has reached its speed gives nothing.
        let idle = torque(Motor::Speed { speed: 2.0, limit: 50.0 }, None, 2.0);
        assert!(idle.0.abs() < 1e-9, "{idle:?}");
        // The torque that an angle needs is I φ''.
        let exact = torque(Motor::Value(std::sync::Arc::new(Swing)), None, 1.0);
        assert!((exact.0 + 2.0 * inertia * libm::sin(0.6)).abs() < 1e-9, "{exact:?} {mass}");
    }
    // A wheel on a horizontal axle 0.4 m beside its bearing: the bending moment m g 0.4 is none of the motor.
    let (mut world, body) = world(method("rk4"), DVec3::X * 0.4);
    let between = [ORIGIN, Anchor::Body { id: body, at: DVec3::X * -0.4 }];
    let hinge = Hinge::new(between, DVec3::X, DQuat::IDENTITY);
    let motor = Some(Motor::Speed { speed: 1e6, limit: 0.2 });
    world.add_constraint(hinge.with(Freedom { motor, limits: None }));
    world.advance_to(0.1);
    let found = reaction(&mut world);
    assert!((found.motor - 0.2).abs() < 1e-12 && (found.torque.x - 0.2).abs() < 1e-11, "{found:?}");
    assert!((found.torque.length() - libm::hypot(0.2, 0.4 * mass * G)).abs() < 1e-9);
}

fn is_near(found: DVec3, x: f64, y: f64, z: f64) -> bool {
    found.abs_diff_eq(DVec3::new(x, y, z), 1e-11)
}

const ORIGIN: Anchor = Anchor::Point(DVec3::ZERO);

fn methods() -> impl Iterator<Item = &'static Method> {
    METHODS.iter().filter(|method| method.constraints)
}

#[test]
fn what_hangs_is_held_by_its_weight() {
    for method in methods() {
        let hang = |hold: &dyn Fn(&mut World, [Anchor; 2])| {
            let (mut world, body) = world(method, DVec3::NEG_Y);
            hold(&mut world, [ORIGIN, Anchor::Body { id: body, at: DVec3::ZERO }]);
            let before = reaction(&mut world);
            world.advance_to(0.5);
            [before, reaction(&mut world)]
        };
        let rod = hang(&|world, between| world.add_constraint(Rod { between, length: 1.0 }));
        let rope = hang(&|world, between| world.add_constraint(Rope { between, length: 1.0 }));
        for found in rod.into_iter().chain(rope) {
            assert!(is_near(found.force, 0.0, G, 0.0) && is_near(found.torque, 0.0, 0.0, 0.0), "{found:?}");
        }
    }
    // A slack rope exerts no force.
    let (mut slack, body) = world(method("rk4"), DVec3::NEG_Y);
    slack.add_constraint(Rope { between: [ORIGIN, Anchor::centre(body)], length: 2.0 });
    assert_eq!(reaction(&mut slack), Reaction::default());
}

/// Checks the tension T = m g cos θ + m v²/ℓ = m g (3 cos θ − 2 cos θ₀) of a pendulum's rod, by the energy of a swing from rest.
#[test]
fn the_tension_of_a_pendulum_is_that_of_its_swing_to_the_order_of_the_method() {
    let start = 1.2;
    let (sin, cos) = libm::sincos(start);
    let error = |name: &str, h: f64, t: f64| {
        let (mut world, body) = world(method(name), DVec3::new(sin, -cos, 0.0));
        world.set_step(h);
        world.add_constraint(Rod { between: [ORIGIN, Anchor::centre(body)], length: 1.0 });
        world.advance_to(t);
        let (place, velocity) = (world.location(body), world.velocity(body));
        let found = reaction(&mut world);
        // The force points to the pivot, and agrees up to rounding with the simulated angle and speed.
        let own = -place.y * G + velocity.length_squared();
        assert!((found.force + own * place).length() < 1e-11, "{found:?} {own}");
        found.force.length() - G * (-3.0 * place.y - 2.0 * cos)
    };
    for t in [0.4, 0.9, 1.5] {
        let [coarse, fine] = [0.02, 0.01].map(|h| error("rk4", h, t).abs());
        // Halving the step divides the error by about 2⁴ for rk4; the next order of the error makes the ratio a little smaller.
        assert!(coarse < 1e-4 && fine < coarse / 12.0, "{t}: {coarse:e} {fine:e}");
        let [coarse, fine] = [0.02, 0.01].map(|h| error("velocity-verlet", h, t).abs());
        assert!(coarse < 0.05 && fine < coarse / 3.0, "{t}: {coarse:e} {fine:e}");
    }
}

#[test]
fn a_hinge_and_a_clamp_bear_the_torque_of_a_weight_beside_them() {
    for method in methods() {
        // The weight hangs below the z axis, and 0.5 m from the joint along this axis.
        let r = DVec3::new(0.0, -1.0, 0.5);
        let (mut hinged, body) = world(method, r);
        let between = [ORIGIN, Anchor::Body { id: body, at: -r }];
        hinged.add_constraint(Hinge::new(between, DVec3::Z, glam::DQuat::IDENTITY));
        let found = reaction(&mut hinged);
        assert!(is_near(found.force, 0.0, G, 0.0) && is_near(found.torque, -0.5 * G, 0.0, 0.0), "{found:?}");

        let r = DVec3::X * 2.0;
        let (mut beam, body) = world(method, r);
        let between = [ORIGIN, Anchor::Body { id: body, at: -r }];
        beam.add_constraint(Fixed { between, turned: glam::DQuat::IDENTITY });
        beam.advance_to(0.2);
        let found = reaction(&mut beam);
        assert!(is_near(found.force, 0.0, G, 0.0) && is_near(found.torque, 0.0, 0.0, 2.0 * G), "{found:?}");
    }
}

/// Checks that a joint reports the opposite reaction when its two ends are exchanged, both between two bodies and between a body and the
/// world.
#[test]
fn actions_are_opposite() {
    let pair = |turned: bool| {
        let (mut world, upper) = world(method("rk4"), DVec3::new(0.6, -0.8, 0.0));
        let lower = world.add(ball().with_location(DVec3::new(1.4, -1.4, 0.3)));
        let joint = DVec3::new(1.0, -1.0, 0.1);
        let on = |id: BodyId, world: &World| Anchor::Body { id, at: joint - world.location(id) };
        let mut between = [on(upper, &world), on(lower, &world)];
        let mut top = [ORIGIN, Anchor::Body { id: upper, at: DVec3::new(-0.6, 0.8, 0.0) }];
        if turned {
            between.reverse();
            top.reverse();
        }
        world.add_constraint(Fixed { between, turned: glam::DQuat::IDENTITY });
        world.add_constraint(Ball { between: top });
        world.advance_to(0.3);
        world.snapshot().unwrap().reactions
    };
    let (plain, turned) = (pair(false), pair(true));
    assert!(plain[0].torque.length() > 0.1 && plain[1].force.length() > G);
    for (one, other) in plain.iter().zip(&turned) {
        assert!((one.force + other.force).length() < 1e-9, "{one:?} {other:?}");
        assert!((one.torque + other.torque).length() < 1e-9, "{one:?} {other:?}");
    }
}

#[test]
fn a_motor_that_is_too_weak_gives_what_it_has() {
    let (mut world, body) = world(method("rk4"), DVec3::ZERO);
    let freedom = Freedom { limits: None, motor: Some(Motor::Speed { speed: 1e3, limit: 0.25 }) };
    let hinge = Hinge::new([ORIGIN, Anchor::centre(body)], DVec3::Z, glam::DQuat::IDENTITY);
    world.add_constraint(hinge.with(freedom));
    world.advance_to(0.1);
    let found = reaction(&mut world);
    assert!(is_near(found.force, 0.0, G, 0.0) && is_near(found.torque, 0.0, 0.0, 0.25), "{found:?}");
}

/// Checks that a slider exerts forces only across its axis, and none after its body has disappeared.
#[test]
fn a_joint_whose_body_is_away_does_nothing() {
    let (mut world, body) = world(method("rk4"), DVec3::ZERO);
    world.limit(body, &Presence::during(&[[0.0, 0.5]]));
    world.add_constraint(Slider {
        between: [ORIGIN, Anchor::centre(body)],
        axis: DVec3::new(0.6, 0.8, 0.0),
        turned: glam::DQuat::IDENTITY,
        freedom: Freedom::default(),
    });
    // The force is m g without its component along the axis.
    let found = reaction(&mut world);
    assert!(is_near(found.force, -0.48 * G, 0.36 * G, 0.0), "{found:?}");
    world.advance_to(1.0);
    assert_eq!(reaction(&mut world), Reaction::default());
}
