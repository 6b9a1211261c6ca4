//! Tests of one-sided joints, motors and gears: closed forms, the order of every method across events, and the energy accounts.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, BodyId, Dynamics, Freedom, Gear, Hinge, Method, Motor, RigidBody, Rod, Rope, Servo, Shape,
    Slider, Target, World,
};

use crate::common::{G, assert_orders, ball, falling, method, origin, that_keep_joints, world};

/// Adds a wheel at a place, with the world's z axis as its axis: I = ½ m r² = 0.5 kg m².
fn wheel(world: &mut World, place: DVec3) -> BodyId {
    let turn = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let disc = RigidBody::new(&Shape::Cylinder { radius: 1.0, height: 0.1 }, 1.0);
    world.add(disc.with_location(place).with_orientation(turn))
}

fn axle(world: &World, wheel: BodyId, freedom: Freedom) -> Hinge {
    let place = world.location(wheel);
    let turn = world.orientation(wheel).conjugate();
    Hinge::new([Anchor::Point(place), Anchor::centre(wheel)], DVec3::Z, turn).with(freedom)
}

fn spin(world: &World, wheel: BodyId) -> f64 {
    world.angular_velocity(wheel).z
}

/// Checks a ball on a slack rope of 1 m. It falls freely for 0.5 m beside the rope's other end. When the rope becomes taut, the ball keeps
/// only the velocity component across the rope, which its energy in the following swing shows.
#[test]
fn a_rope_takes_what_leads_along_it_when_it_becomes_taut() {
    for method in that_keep_joints() {
        let h = 1e-3;
        let mut world = falling(method, h);
        let side = 0.6;
        let bob = world.add(ball().with_location(DVec3::new(side, -0.3, 0.0)));
        world.add_constraint(Rope { between: [origin(), Anchor::centre(bob)], length: 1.0 });
        // The rope is taut where x² + y² = 1: at y = −0.8.
        let time = (2.0 * 0.5 / G).sqrt();
        let speed = G * time;
        world.advance_to(time + 0.05);
        let (x, v) = (world.location(bob), world.velocity(bob));
        // The first-order methods have an error of half a step in time.
        let slack = if method.order == 1 { 3.0 * G * h } else { 1e-5 };
        assert!((x.length() - 1.0).abs() < 1e-12, "{}: {x}", method.name);
        // The component across the rope is v times the sine of the angle between rope and vertical. The lost energy is ½ m (v cos)².
        let across = speed * side;
        let energy = 0.5 * across * across - 0.8 * G;
        let now = 0.5 * v.length_squared() + G * x.y;
        assert!((now - energy).abs() < slack, "{}: {now} {energy}", method.name);
        let taken = world.balance().accounts.limits;
        let along = speed * 0.8;
        let loss = -0.5 * along * along;
        assert!((taken - loss).abs() < slack, "{}: {taken} {loss}", method.name);
        assert!(world.balance().drift.abs() < slack, "{}: {:?}", method.name, world.balance());
    }
}

/// Checks the place where a rope becomes slack: a ball swings up too fast to stay below and too slowly for a full turn. The rope becomes
/// slack where v² = g y with ℓ = 1 m, which by the energy is at y = (v₀² − 2 g ℓ) / 3 g.
#[test]
fn a_rope_becomes_slack_where_it_would_have_to_push() {
    for method in that_keep_joints().filter(|method| method.order > 1) {
        let mut world = falling(method, 5e-4);
        let v0 = (3.5 * G).sqrt();
        let bob = world.add(ball().with_location(DVec3::NEG_Y).with_velocity(DVec3::X * v0));
        world.add_constraint(Rope { between: [origin(), Anchor::centre(bob)], length: 1.0 });
        let height = (v0 * v0 - 2.0 * G) / (3.0 * G);
        let mut last = DVec3::ZERO;
        for k in 1..4000 {
            world.advance_to(5e-4 * f64::from(k));
            let x = world.location(bob);
            if x.length() < 1.0 - 1e-9 {
                break;
            }
            last = x;
        }
        assert!((last.y - height).abs() < 5e-3, "{}: {last} {height}", method.name);
        // From this place the ball moves on a parabola. Its apex is higher by (v cos)² / 2g, since the velocity is perpendicular to the
        // rope.
        let v2 = G * height;
        let up = v2 * (1.0 - height * height) / (2.0 * G);
        let mut top = 0.0_f64;
        for k in 0..2000 {
            world.advance_to(world.time() + 1e-4 * f64::from(k % 2 + 1));
            top = top.max(world.location(bob).y);
            if world.velocity(bob).y < 0.0 {
                break;
            }
        }
        assert!((top - height - up).abs() < 1e-4, "{}: {top} {}", method.name, height + up);
        assert!(world.balance().drift.abs() < 1e-5, "{}", method.name);
    }
}

/// Checks that a ball at rest on a rope stays at rest, and that the rope's tension is its weight.
#[test]
fn a_rope_at_rest_carries_a_weight() {
    for method in that_keep_joints() {
        let mut world = falling(method, 0.01);
        let bob = world.add(ball().with_location(DVec3::NEG_Y));
        world.add_constraint(Rope { between: [origin(), Anchor::centre(bob)], length: 1.0 });
        world.advance_to(10.0);
        assert!(
            world.location(bob).distance(DVec3::NEG_Y) < 1e-12,
            "{}: {}",
            method.name,
            world.location(bob)
        );
        assert_eq!(world.steps(), 1000, "{}", method.name);
    }
}

/// Checks a wheel under a torque of 1 N m: it turns by ½ (τ/I) t² up to its limit and stops there, and the account of the limits holds its
/// energy.
#[test]
fn a_limit_stops_a_hinge_and_takes_its_energy() {
    for method in that_keep_joints() {
        let mut world = world(method, 1e-3);
        let wheel = wheel(&mut world, DVec3::ZERO);
        let freedom = Freedom { limits: Some([-1.0, 0.5]), motor: None };
        world.add_constraint(axle(&world, wheel, freedom));
        world.apply_torque(wheel, DVec3::Z);
        world.advance_to(0.5);
        let off = spin(&world, wheel) - 1.0;
        assert!(off.abs() < 1e-12, "{}: {off}", method.name);
        // The limit of 0.5 rad is reached after √(2 · 0.5 · 0.5 / 1) s, with 0.5 J.
        world.advance_to(3.0);
        assert!(spin(&world, wheel).abs() < 1e-12);
        let turned =
            world.orientation(wheel).angle_between(DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2));
        assert!((turned - 0.5).abs() < 1e-7, "{}: {turned}", method.name);
        let balance = world.balance();
        let slack = if method.order == 1 { 1e-3 } else { 1e-9 };
        assert!((balance.accounts.limits + 0.5).abs() < slack, "{}: {balance:?}", method.name);
        let missing = balance.total - balance.accounts.total();
        assert!(missing.abs() < slack, "{}: {balance:?}", method.name);
        // The wheel leaves the limit when a torque pulls it back.
        world.apply_torque(wheel, DVec3::NEG_Z);
        world.advance_to(3.5);
        assert!((spin(&world, wheel) + 1.0).abs() < 1e-12, "{}", method.name);
    }
}

/// Checks a motor of 2 N m: it brings a wheel to 3 rad/s in 0.75 s and keeps this speed against a torque of 1 N m. A torque of 4 N m is
/// too strong for it.
#[test]
fn a_motor_keeps_its_speed_as_far_as_it_is_strong_enough() {
    for method in that_keep_joints() {
        let mut world = world(method, 1e-3);
        let wheel = wheel(&mut world, DVec3::ZERO);
        let freedom = Freedom { limits: None, motor: Some(Motor::Speed { speed: 3.0, limit: 2.0 }) };
        world.add_constraint(axle(&world, wheel, freedom));
        world.advance_to(0.5);
        assert!((spin(&world, wheel) - 2.0).abs() < 1e-12, "{}: {}", method.name, spin(&world, wheel));
        world.advance_to(1.0);
        assert!((spin(&world, wheel) - 3.0).abs() < 1e-12, "{}: {}", method.name, spin(&world, wheel));
        let slack = if method.order == 1 { 1e-2 } else { 1e-9 };
        let motors = world.balance().accounts.motors;
        assert!((motors - 2.25).abs() < slack, "{}: {motors}", method.name);
        world.apply_torque(wheel, DVec3::NEG_Z);
        world.advance_to(2.0);
        assert!((spin(&world, wheel) - 3.0).abs() < 1e-12, "{}: {}", method.name, spin(&world, wheel));
        let motors = world.balance().accounts.motors;
        assert!((motors - 5.25).abs() < slack, "{}: {motors}", method.name);
        world.apply_torque(wheel, DVec3::Z * -4.0);
        world.advance_to(3.0);
        // The angular acceleration (2 − 4) / 0.5 acts for a second.
        assert!((spin(&world, wheel) + 1.0).abs() < 1e-10, "{}: {}", method.name, spin(&world, wheel));
        assert!(world.balance().drift.abs() < slack, "{}: {:?}", method.name, world.balance());
    }
}

/// Checks that a motor with target speed 0 acts as dry friction: a wheel of 0.5 kg m² stops after ω I / τ, and a weaker torque does not
/// move it.
#[test]
fn a_motor_of_no_speed_is_dry_friction() {
    for method in that_keep_joints() {
        let mut world = world(method, 1e-2);
        let disc = RigidBody::new(&Shape::Cylinder { radius: 1.0, height: 0.1 }, 1.0);
        let wheel = world.add(disc.with_angular_velocity(DVec3::Y * 3.0));
        let between = [origin(), Anchor::centre(wheel)];
        let freedom = Freedom { limits: None, motor: Some(Motor::Speed { speed: 0.0, limit: 1.0 }) };
        world.add_constraint(Hinge::new(between, DVec3::Y, DQuat::IDENTITY).with(freedom));
        world.advance_to(1.0);
        assert!((world.angular_velocity(wheel).y - 1.0).abs() < 1e-12, "{}", method.name);
        world.apply_torque(wheel, DVec3::Y * 0.9);
        world.advance_to(20.0);
        assert!(world.angular_velocity(wheel).y.abs() < 1e-12, "{}", method.name);
        let at_rest = world.orientation(wheel);
        world.advance_to(30.0);
        assert!(world.orientation(wheel).angle_between(at_rest) < 1e-7, "{}", method.name);
    }
}

#[derive(Debug)]
struct Sway;

impl Target for Sway {
    fn at(&self, t: f64) -> [f64; 3] {
        let (sin, cos) = libm::sincos(2.0 * t);
        [0.5 * sin, cos, -2.0 * sin]
    }
}

/// Checks that a motor keeps a prescribed angle exactly, and that its work equals the energy of the wheel.
#[test]
fn a_motor_follows_a_formula() {
    for method in that_keep_joints() {
        let mut world = world(method, 1e-3);
        let wheel = wheel(&mut world, DVec3::ZERO);
        let freedom = Freedom { limits: None, motor: Some(Motor::Value(Arc::new(Sway))) };
        let axle = axle(&world, wheel, freedom);
        let coordinate = axle.coordinate();
        world.add_constraint(axle);
        for k in 1..=20 {
            let t = 0.1 * f64::from(k);
            world.advance_to(t);
            let x = world.orientation(wheel) * DVec3::X;
            let [angle, rate, _] = Sway.at(t);
            assert!((libm::atan2(x.y, x.x) - angle).abs() < 1e-12, "{} {t}", method.name);
            assert!((spin(&world, wheel) - rate).abs() < 1e-12, "{} {t}", method.name);
            let snapshot = world.snapshot().unwrap();
            let [seen, seen_rate] = coordinate.seen(|id| snapshot.body(id.index()).copied()).unwrap();
            assert!((seen - angle).abs() < 1e-12 && (seen_rate - rate).abs() < 1e-12, "{seen} {seen_rate}");
        }
        let slack = [1e-2, 1e-5, 1e-5, 1e-9][usize::min(method.order as usize - 1, 3)];
        assert!(world.balance().drift.abs() < slack, "{}: {:?}", method.name, world.balance());
    }
}

/// Checks that a servo acts as a damped spring in the angle: k/I = 9, d/2I = 0.5, from 0 towards 1 rad.
#[test]
fn a_servo_swings_as_a_damped_spring() {
    #[derive(Debug)]
    struct One;
    impl Target for One {
        fn at(&self, _: f64) -> [f64; 3] {
            [1.0, 0.0, 0.0]
        }
    }
    let mut world = world(method("rk4"), 1e-3);
    let wheel = wheel(&mut world, DVec3::ZERO);
    let hinge = axle(&world, wheel, Freedom::default());
    world.add_force(Servo {
        coordinate: hinge.coordinate(),
        target: Arc::new(One),
        stiffness: 4.5,
        damping: 0.5,
    });
    world.add_constraint(hinge);
    world.advance_to(1.7);
    let (decay, omega) = (0.5, (9.0f64 - 0.25).sqrt());
    let (sin, cos) = libm::sincos(omega * 1.7);
    let expected = 1.0 - libm::exp(-decay * 1.7) * (cos + decay / omega * sin);
    let x = world.orientation(wheel) * DVec3::X;
    assert!((libm::atan2(x.y, x.x) - expected).abs() < 1e-10);
    assert!(world.balance().drift.abs() < 1e-9, "{:?}", world.balance());
}

/// Checks two wheels that are coupled by a gear and share a torque: with the ratio r, the angular acceleration of the first is τ / (I₁ +
/// r² I₂). Both turn several times.
#[test]
fn a_gear_keeps_its_ratio_over_many_turns() {
    for method in that_keep_joints() {
        let mut world = world(method, 1e-2);
        let wheels = [0.0, 3.0].map(|x| wheel(&mut world, DVec3::X * x));
        let axles = wheels.map(|wheel| axle(&world, wheel, Freedom::default()));
        let joints = [axles[0].coordinate(), axles[1].coordinate()];
        axles.into_iter().for_each(|axle| world.add_constraint(axle));
        world.add_constraint(Gear { joints, ratio: -2.5 });
        world.apply_torque(wheels[0], DVec3::Z);
        world.advance_to(10.0);
        let expected = 1.0 / (0.5 + 6.25 * 0.5) * 10.0;
        let [first, second] = wheels.map(|wheel| spin(&world, wheel));
        assert!((first - expected).abs() < 1e-10, "{}: {first} {expected}", method.name);
        assert!((second + 2.5 * first).abs() < 1e-12, "{}", method.name);
        // The first wheel has turned by ½ α t², and the second by −2.5 times this angle, 34 rad.
        let angle = |wheel: BodyId| {
            let x = world.orientation(wheel) * DVec3::X;
            libm::atan2(x.y, x.x)
        };
        let off = libm::remainder(angle(wheels[1]) + 2.5 * 5.0 * expected, std::f64::consts::TAU);
        // First-order methods are half a step behind. The error of Runge–Kutta is the fourth power of its angle per step, 0.07 rad.
        let slack = if method.order == 1 { 2.5 * expected * 1e-2 } else { 1e-6 };
        assert!(off.abs() < slack, "{}: {off}", method.name);
    }
}

/// Checks a rack and pinion: a gear couples a hinge and a slider, 0.3 m for each radian.
#[test]
fn a_gear_couples_a_hinge_and_a_slider() {
    let mut world = falling(method("rk4"), 1e-2);
    let wheel = wheel(&mut world, DVec3::ZERO);
    let rack = world.add(ball().with_location(DVec3::X));
    let axle = axle(&world, wheel, Freedom::default());
    let slider = Slider {
        between: [Anchor::Point(DVec3::X), Anchor::centre(rack)],
        axis: DVec3::Y,
        turned: DQuat::IDENTITY,
        freedom: Freedom::default(),
    };
    let joints = [axle.coordinate(), slider.coordinate()];
    world.add_constraint(axle);
    world.add_constraint(slider);
    world.add_constraint(Gear { joints, ratio: 0.3 });
    world.advance_to(1.0);
    // The equation of motion is m y'' = −m g − (I / r²) y''.
    let expected = -G / (1.0 + 0.5 / 0.09);
    assert!((world.velocity(rack).y - expected).abs() < 1e-12, "{}", world.velocity(rack));
    assert!((spin(&world, wheel) - expected / 0.3).abs() < 1e-12);
}

/// Checks motors whose torque is far too large for the time until they reach their speed to be resolved: each gives the speed at once, to
/// itself and through a gear, and goes on with it. A motor at a stop stays there.
#[test]
fn a_motor_of_any_strength_keeps_its_speed() {
    for method in that_keep_joints() {
        for limit in [1e6, 1e12, 1e30] {
            let mut world = falling(method, 4e-3);
            let first = wheel(&mut world, DVec3::ZERO);
            let second = wheel(&mut world, DVec3::X * 3.0);
            let motor = |speed: f64| Some(Motor::Speed { speed, limit });
            let driven = axle(&world, first, Freedom { limits: None, motor: motor(10.0) });
            let geared = axle(&world, second, Freedom { limits: None, motor: None });
            let joints = [driven.coordinate(), geared.coordinate()];
            world.add_constraint(driven);
            world.add_constraint(geared);
            world.add_constraint(Gear { joints, ratio: -2.0 });
            let stopped = wheel(&mut world, DVec3::X * 9.0);
            let limits = Some([0.0, 1.0]);
            world.add_constraint(axle(&world, stopped, Freedom { limits, motor: motor(-10.0) }));
            world.advance_to(1.0);
            let case = format!("{} {limit:e}", method.name);
            let [first, second, stopped] = [first, second, stopped].map(|id| spin(&world, id));
            assert!((first - 10.0).abs() < 1e-9, "{case}: {first}");
            // The second wheel turns at `ratio` times the speed of the first.
            assert!((second + 2.0 * first).abs() < 1e-8, "{case}: {second}");
            // Motor and stop cancel to the rounding error of their impulse in a step; the wheel has 0.5 kg m². A motor of 1e30 N·m acts at
            // once instead.
            let rounding = if limit < 1e15 { f64::EPSILON * limit * 4e-3 } else { 0.0 };
            assert!(stopped.abs() < 1e-9 + rounding / 0.5, "{case}: {stopped}");
        }
    }
}

/// Checks that events within a step keep the order of a method: a rope becomes taut, a limit is reached, and a motor reaches its speed.
#[test]
fn events_keep_the_order_of_a_method() {
    let build = |method: &'static Method, step: f64| {
        let mut world = falling(method, step);
        let bob = world.add(ball().with_location(DVec3::new(0.6, -0.3, 0.1)).with_velocity(DVec3::Z * 0.5));
        world.add_constraint(Rope { between: [origin(), Anchor::centre(bob)], length: 1.0 });
        let lever = world.add(
            RigidBody::new(&Shape::Box { size: DVec3::new(1.0, 0.1, 0.1) }, 1.0)
                .with_location(DVec3::new(0.5, 0.0, 5.0)),
        );
        let at = Anchor::Body { id: lever, at: DVec3::X * -0.5 };
        let freedom = Freedom { limits: Some([-1.0, 1.0]), motor: None };
        let hinge = Hinge::new([Anchor::Point(DVec3::Z * 5.0), at], DVec3::Z, DQuat::IDENTITY).with(freedom);
        world.add_constraint(hinge);
        let wheel = wheel(&mut world, DVec3::X * 9.0);
        let freedom = Freedom { limits: None, motor: Some(Motor::Speed { speed: 1.0, limit: 1.0 }) };
        world.add_constraint(axle(&world, wheel, freedom));
        world
    };
    assert_orders(0.5, build);
}

/// Checks that moments within a step are on the correct side of an event: they agree with a run of shorter steps.
#[test]
fn moments_around_an_event_are_those_of_shorter_steps() {
    let build = |step: f64| {
        let mut world = falling(method("rk4"), step);
        let bob = world.add(ball().with_location(DVec3::new(0.6, -0.3, 0.0)));
        world.add_constraint(Rope { between: [origin(), Anchor::centre(bob)], length: 1.0 });
        world
    };
    let moments: Vec<f64> = (1..40).map(|k| 0.01 * f64::from(k)).collect();
    let see = |mut world: World| {
        let mut seen = Vec::new();
        world.advance(0.4, &moments, &mut |snapshot| seen.push(snapshot)).unwrap();
        seen
    };
    let (coarse, fine) = (see(build(0.04)), see(build(0.001)));
    assert_eq!(coarse.len(), 39);
    for (a, b) in coarse.iter().zip(&fine) {
        let off = a.bodies[0].location.distance(b.bodies[0].location);
        let faster = a.bodies[0].velocity.distance(b.bodies[0].velocity);
        // The relative error within a step is (ω h)⁴ with ω about 5 /s: 2e-3.
        assert!(off < 1e-5 && faster < 1e-3, "{}: {off:e} {faster:e}", a.time);
    }
}

/// Checks a ball on a rod and on a rope that is taut from the start: the redundant constraint changes nothing.
#[test]
fn a_rope_beside_a_rod_does_no_harm() {
    for method in that_keep_joints() {
        let mut world = falling(method, 1e-3);
        let bob = world.add(ball().with_location(DVec3::X));
        let between = [origin(), Anchor::centre(bob)];
        world.add_constraint(Rod { between, length: 1.0 });
        world.add_constraint(Rope { between, length: 1.0 });
        world.advance_to(2.0);
        assert!((world.location(bob).length() - 1.0).abs() < 1e-12, "{}", method.name);
        let slack = if method.order == 1 { 0.05 } else { 1e-4 };
        assert!(world.balance().drift.abs() < slack, "{}: {:?}", method.name, world.balance());
    }
}

/// Checks that a falling chain of slack ropes, which become taut one after another, takes few steps. Ropes that are taut at the same time
/// must not cause endless events. An event takes about ten steps.
#[test]
fn a_chain_of_ropes_has_few_events() {
    let mut world = falling(method("rk4"), 2e-3);
    let mut before = origin();
    for i in 0..20 {
        let k = f64::from(i);
        let x = 0.2 * (k + 1.0) * libm::cos(0.3 * k);
        let bob = world.add(ball().with_location(DVec3::new(x, 0.15 * libm::sin(1.7 * k), 0.0)));
        world.add_constraint(Rope { between: [before, Anchor::centre(bob)], length: 1.2 });
        before = Anchor::centre(bob);
    }
    for k in 1..=120 {
        world.advance_to(0.05 * f64::from(k));
        assert!(world.steps() < 3000 + 2000, "{} steps at {} s", world.steps(), world.time());
    }
    assert!(world.violation() < 1e-11);
    assert!(world.balance().drift.abs() < 1e-3, "{:?}", world.balance());
}

/// Checks a wheel that starts to turn beyond its limit: it stops at once, and the loss of energy is not counted as drift.
#[test]
fn what_a_limit_takes_at_the_start_is_no_drift() {
    for method in that_keep_joints() {
        let mut world = world(method, 1e-2);
        let disc = RigidBody::new(&Shape::Cylinder { radius: 1.0, height: 0.1 }, 1.0);
        let wheel = world.add(disc.with_angular_velocity(DVec3::new(0.1, -2.0, 0.3)));
        let freedom = Freedom { limits: Some([0.0, 1.0]), motor: None };
        let between = [origin(), Anchor::centre(wheel)];
        world.add_constraint(Hinge::new(between, DVec3::Y, DQuat::IDENTITY).with(freedom));
        world.advance_to(1.0);
        assert!(world.angular_velocity(wheel).length() < 1e-12, "{}", method.name);
        assert!(world.balance().drift.abs() < 1e-12, "{}: {:?}", method.name, world.balance());
    }
}
