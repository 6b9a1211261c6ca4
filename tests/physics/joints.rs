//! Tests of joints: closed forms, published values, the order of every method, and the violation of the constraints.

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, Ball, BodyId, Breakdown, Dynamics, Fixed, Freedom, Hinge, Kinematics, Method, Motion, Presence,
    RigidBody, Rod, Shape, Slider, UniformGravity, World,
};

use crate::common::{assert_orders, ball, method, that_keep_joints};

const G: f64 = 9.81;

fn gravity() -> UniformGravity {
    UniformGravity { acceleration: DVec3::new(0.0, -G, 0.0) }
}

fn world(method: &'static Method, step: f64) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(step);
    world.add_force(gravity());
    world
}

fn at(id: BodyId, at: DVec3) -> Anchor {
    Anchor::Body { id, at }
}

/// Returns a world with a ball of 1 kg on a rod of 1 m that hangs from the origin, deflected by this angle.
fn pendulum(method: &'static Method, step: f64, degrees: f64) -> World {
    let mut world = world(method, step);
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let bob = world.add(ball().with_location(DVec3::new(sin, -cos, 0.0)));
    world.add_constraint(Rod { between: [Anchor::Point(DVec3::ZERO), Anchor::centre(bob)], length: 1.0 });
    world
}

/// Returns the angle of the first body from the downward vertical, rad, and its rate, rad/s.
fn swing(world: &World) -> (f64, f64) {
    let (x, v) = (world.state().location[0], world.state().velocity[0]);
    (libm::atan2(x.x, -x.y), x.cross(v).z / x.length_squared())
}

/// Returns the time in which the pendulum passes its lowest point `count` times after the first passage, and the largest violation of the
/// rod's length. Passages are found by cubic interpolation of the angle, whose error is (ωh)⁴ / 384 of a step.
fn periods(world: &mut World, h: f64, count: u32) -> (f64, f64) {
    let (mut passed, mut first, mut last) = (0, 0.0, 0.0);
    let mut violation = 0.0_f64;
    let mut before = swing(world);
    let mut step = 0;
    while passed <= count {
        world.advance_to(h * f64::from(step + 1));
        let after = swing(world);
        violation = violation.max((world.state().location[0].length() - 1.0).abs());
        if before.0 > 0.0 && after.0 <= 0.0 {
            // Find the root of the cubic through both angles and rates by Newton's method, starting from the chord.
            let mut s = before.0 / (before.0 - after.0);
            for _ in 0..20 {
                let (s2, s3) = (s * s, s * s * s);
                let value = (2.0 * s3 - 3.0 * s2 + 1.0) * before.0
                    + (s3 - 2.0 * s2 + s) * h * before.1
                    + (3.0 * s2 - 2.0 * s3) * after.0
                    + (s3 - s2) * h * after.1;
                let slope = (6.0 * s2 - 6.0 * s) * (before.0 - after.0)
                    + (3.0 * s2 - 4.0 * s + 1.0) * h * before.1
                    + (3.0 * s2 - 2.0 * s) * h * after.1;
                s -= value / slope;
            }
            let time = h * (f64::from(step) + s);
            if passed == 0 {
                first = time;
            }
            last = time;
            passed += 1;
        }
        before = after;
        step += 1;
    }
    ((last - first) / f64::from(count), violation)
}

#[test]
fn a_rod_pendulum_keeps_its_period_its_energy_and_its_length() {
    let h = 1.0 / 240.0;
    for (degrees, period, rk4, verlet) in
        [(30.0, 2.04098988951913, 5e-10, 1.1e-5), (90.0, 2.36784194757624, 1e-8, 2.6e-5)]
    {
        for (name, allowed) in [("rk4", rk4), ("velocity-verlet", verlet), ("euler-cromer", verlet)] {
            let mut world = pendulum(method(name), h, degrees);
            let (measured, violation) = periods(&mut world, h, 100);
            let off = measured / period - 1.0;
            let drift = world.balance().drift;
            assert!(off.abs() < allowed, "{name} at {degrees}: {off:e}");
            assert!(violation < 1e-12, "{name} at {degrees}: {violation:e}");
            if name == "rk4" {
                assert!(drift.abs() < 1e-7, "{drift:e}");
            }
        }
    }
}

/// Checks the IFToMM benchmark A01: a point mass on a rod, released from rest in the horizontal position.
#[test]
fn the_pendulum_of_the_iftomm_benchmark() {
    let mut world = world(method("rk4"), 2e-4);
    let bob = world.add(ball().with_location(DVec3::NEG_X));
    world.add_constraint(Rod { between: [Anchor::Point(DVec3::ZERO), Anchor::centre(bob)], length: 1.0 });
    world.advance_to(10.0);
    let off = world.location(bob) - DVec3::new(-0.275087462576, -0.961419205099, 0.0);
    assert!(off.length() < 1e-9, "{off}");
}

/// Checks a double pendulum with unit masses and rods, released from rest with both rods at 90°.
#[test]
fn a_double_pendulum_ends_where_published_solutions_do() {
    let mut world = world(method("rk4"), 2e-4);
    let upper = world.add(ball().with_location(DVec3::X));
    let lower = world.add(ball().with_location(2.0 * DVec3::X));
    world.add_constraint(Rod { between: [Anchor::Point(DVec3::ZERO), Anchor::centre(upper)], length: 1.0 });
    world.add_constraint(Rod { between: [Anchor::centre(upper), Anchor::centre(lower)], length: 1.0 });
    world.advance_to(5.0);
    let angle = |d: DVec3| libm::atan2(d.x, -d.y);
    let angles = (angle(world.location(upper)), angle(world.location(lower) - world.location(upper)));
    assert!((angles.0 + 0.6271867050665).abs() < 1e-9, "{angles:?}");
    assert!((angles.1 + 1.30131555021).abs() < 1e-9, "{angles:?}");
}

/// Returns the location and the orientation of a body, or those of the world's axes for `None`.
fn frame(world: &World, body: Option<BodyId>) -> (DVec3, DQuat) {
    body.map_or((DVec3::ZERO, DQuat::IDENTITY), |id| (world.location(id), world.orientation(id)))
}

/// Returns the anchor of a joint on a body, or on the world for `None`. `point` is its location in world axes.
fn anchor(world: &World, body: Option<BodyId>, point: DVec3) -> Anchor {
    let (location, orientation) = frame(world, body);
    body.map_or(Anchor::Point(point), |id| at(id, orientation.conjugate() * (point - location)))
}

fn hinge(world: &mut World, bodies: [Option<BodyId>; 2], point: DVec3, axis: DVec3) {
    let between = bodies.map(|body| anchor(world, body, point));
    let [first, second] = bodies.map(|body| frame(world, body).1);
    world.add_constraint(Hinge::new(between, first.conjugate() * axis, second.conjugate() * first));
}

/// The tolerance of the measured order, derived as in `order.rs`. With rates of up to 5 /s, the slope deviates by a multiple of 5 / 256 /
/// 1.4.
const SLACK: f64 = 0.15;

#[test]
fn order_on_a_rod_pendulum() {
    assert_orders(SLACK, |method, step| pendulum(method, step, 90.0));
}

/// Returns a world with a rotated box on a hinge away from its center, under gravity and a torque.
fn lid(method: &'static Method, step: f64) -> World {
    let mut world = world(method, step);
    let body = RigidBody::new(&Shape::Box { size: DVec3::new(1.0, 0.2, 0.6) }, 2.0)
        .with_location(DVec3::new(0.4, 0.3, 0.2))
        .with_orientation(DQuat::from_scaled_axis(DVec3::new(0.5, -0.3, 0.8)))
        .with_torque(DVec3::new(3.0, -2.0, 1.0));
    let lid = world.add(body);
    hinge(&mut world, [None, Some(lid)], DVec3::new(0.1, 0.0, 0.0), DVec3::new(1.0, 2.0, 2.0) / 3.0);
    world
}

#[test]
fn order_on_a_hinge_under_torque() {
    assert_orders(SLACK, lid);
}

/// A prescribed motion: oscillation along x, and uneven rotation about z.
struct Crank;

impl Motion for Crank {
    fn at(&self, t: f64) -> Kinematics {
        let (sin, cos) = libm::sincos(3.0 * t);
        Kinematics {
            location: DVec3::X * sin,
            velocity: DVec3::X * (3.0 * cos),
            acceleration: DVec3::X * (-9.0 * sin),
            orientation: DQuat::from_rotation_z(cos),
            angular_velocity: DVec3::Z * (-3.0 * sin),
        }
    }

    fn angular_acceleration(&self, t: f64) -> DVec3 {
        DVec3::Z * (-9.0 * libm::cos(3.0 * t))
    }
}

/// Returns a world with a box on a ball joint at a point of a guided body that oscillates and turns. The guided body does work on the box.
fn shaken(method: &'static Method, step: f64) -> World {
    let mut world = world(method, step);
    let hand = world.add(ball());
    world.drive(hand, Crank);
    let body = RigidBody::new(&Shape::Box { size: DVec3::new(0.3, 1.0, 0.1) }, 1.0);
    let body = world.add(body.with_location(DVec3::new(0.2, -0.5, 0.1)));
    let point = DVec3::new(0.2, 0.0, 0.1);
    let between = [Some(hand), Some(body)].map(|id| anchor(&world, id, point));
    world.add_constraint(Ball { between });
    world
}

#[test]
fn order_on_a_body_that_hangs_from_a_guided_one() {
    assert_orders(SLACK, shaken);
}

/// Checks that the work of the guided body is accounted for.
#[test]
fn the_work_of_what_guides_an_end_is_counted() {
    let mut world = shaken(method("rk4"), 1e-3);
    world.advance_to(2.0);
    let balance = world.balance();
    assert!(balance.accounts.work.abs() > 0.5, "{balance:?}");
    // The relative error is (ωh)⁴ with ω about 8 /s, over a phase of 16.
    assert!(balance.drift.abs() < 1e-7, "{balance:?}");
}

/// Returns a world with a spinning top, and the top: a disc with I₁ = 0.12 and I₃ = 0.05 kg m² about its pivot, 1 kg, center at 0.3 m from
/// the pivot, inclined by 30°.
fn top(method: &'static Method, step: f64, precession: f64) -> (World, BodyId) {
    let (i1, i3, length, omega) = (0.12, 0.05, 0.3, 60.0);
    let mut world = world(method, step);
    let turn = DQuat::from_rotation_z(-30f64.to_radians());
    let axis = turn * DVec3::Y;
    let angular_velocity = DVec3::Y * precession + axis * (omega - precession * axis.y);
    let body = ball()
        .with_inertia(DVec3::new(i1 - length * length, i3, i1 - length * length))
        .with_orientation(turn)
        .with_location(axis * length)
        .with_velocity(angular_velocity.cross(axis * length))
        .with_angular_velocity(angular_velocity);
    let top = world.add(body);
    let between = [Anchor::Point(DVec3::ZERO), anchor(&world, Some(top), DVec3::ZERO)];
    world.add_constraint(Ball { between });
    (world, top)
}

/// Checks the two steady precessions, the roots φ' of I₁ cos θ φ'² − I₃ ω₃ φ' + m g ℓ = 0.
#[test]
fn a_heavy_top_has_two_steady_precessions() {
    for (precession, step) in [(1.016815848, 2e-4), (27.850697611, 1e-4)] {
        let (mut world, top) = top(method("rk4"), step, precession);
        let (mut angle, mut before) = (0.0, 0.0);
        for k in 1..=200 {
            world.advance_to(0.01 * f64::from(k));
            let x = world.location(top);
            let now = libm::atan2(-x.z, x.x);
            angle += libm::remainder(now - before, std::f64::consts::TAU);
            before = now;
        }
        let off = angle / 2.0 / precession - 1.0;
        assert!(off.abs() < 1e-8, "{precession}: {off:e}");
    }
}

/// Adds a bar between two points, with a mass of 1 kg per meter.
fn bar(world: &mut World, from: DVec3, to: DVec3) -> BodyId {
    let span = to - from;
    let body = RigidBody::new(&Shape::Cylinder { radius: 0.03, height: span.length() }, span.length())
        .with_location((from + to) / 2.0)
        .with_orientation(DQuat::from_rotation_arc(DVec3::Y, span.normalize()));
    world.add(body)
}

/// Adds a chain of bars between consecutive points, with a hinge at each point. The first and the last hinge connect the chain to the
/// world.
fn linkage(world: &mut World, points: &[DVec3], axes: &[DVec3]) {
    let bars: Vec<BodyId> = points.windows(2).map(|ends| bar(world, ends[0], ends[1])).collect();
    for (i, (point, axis)) in points.iter().zip(axes).enumerate() {
        let before = i.checked_sub(1).map(|i| bars[i]);
        hinge(world, [before, bars.get(i).copied()], *point, *axis);
    }
}

/// Returns Bricard's mechanism of six bars along the edges of a cube, the IFToMM benchmark A05. It can move, although its number of
/// constraint equations suggests that it cannot.
fn bricard(method: &'static Method, step: f64) -> World {
    let mut world = world(method, step);
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    let points = [DVec3::ZERO, x, x - y, x - y + z, z - y, z];
    linkage(&mut world, &points, &[y, z, x, y, z, x]);
    world
}

/// Returns a planar mechanism of crank, coupler and rocker, with twenty constraint equations for eighteen degrees of freedom.
fn four_bar(method: &'static Method, step: f64) -> World {
    let mut world = world(method, step);
    let points = [(0.0, 0.0), (0.0, 1.0), (2.0, 2.0), (2.5, 0.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    linkage(&mut world, &points, &[DVec3::Z; 4]);
    world
}

/// Returns a door on two hinges, one of which is redundant.
fn door(method: &'static Method, step: f64) -> World {
    let mut world = world(method, step);
    let door = RigidBody::new(&Shape::Box { size: DVec3::new(0.8, 2.0, 0.04) }, 20.0)
        .with_location(DVec3::new(0.4, 0.0, 0.0))
        .with_angular_velocity(DVec3::Y)
        .with_velocity(DVec3::new(0.0, 0.0, -0.4));
    let door = world.add(door);
    for height in [-0.8, 0.8] {
        hinge(&mut world, [None, Some(door)], DVec3::new(0.0, height, 0.0), DVec3::Y);
    }
    world
}

#[test]
fn equations_that_others_imply_do_no_harm() {
    for (name, build) in [("bricard", bricard as fn(_, _) -> _), ("four bars", four_bar), ("door", door)] {
        for method in that_keep_joints() {
            let mut world: World = build(method, 1e-3);
            let start = world.state().location.clone();
            let (mut worst, mut moved) = (0.0_f64, 0.0_f64);
            for k in 1..=1000 {
                world.advance_to(0.01 * f64::from(k));
                worst = worst.max(world.violation());
                let ways = world.state().location.iter().zip(&start);
                moved = ways.map(|(now, before)| now.distance(*before)).fold(moved, f64::max);
            }
            let drift = world.balance().drift;
            assert!(worst < 1e-12, "{name}, {}: {worst:e}", method.name);
            assert!(moved > 0.5, "{name}, {}: {moved}", method.name);
            if method.order == 4 {
                assert!(drift.abs() < 1e-7, "{name}: {drift:e}");
            }
        }
    }
}

/// Checks that two bodies joined rigidly move like a single body.
#[test]
fn two_bodies_that_are_fixed_to_each_other_are_one() {
    let method = method("rk4");
    let spin = DVec3::new(0.3, 2.0, -0.7);
    let cube = Shape::Box { size: DVec3::splat(0.5) };
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(1e-3);
    let halves = [-0.25, 0.25].map(|x| {
        let location = DVec3::X * x;
        let body = RigidBody::new(&cube, 1.0).with_location(location).with_angular_velocity(spin);
        world.add(body.with_velocity(spin.cross(location)))
    });
    let between = [at(halves[0], DVec3::X * 0.25), at(halves[1], DVec3::X * -0.25)];
    world.add_constraint(Fixed { between, turned: DQuat::IDENTITY });
    let mut one = World::new();
    one.set_integrator(method);
    one.set_step(1e-3);
    let brick =
        RigidBody::new(&Shape::Box { size: DVec3::new(1.0, 0.5, 0.5) }, 2.0).with_angular_velocity(spin);
    let whole = one.add(brick);
    world.advance_to(3.0);
    one.advance_to(3.0);
    let turn = world.orientation(halves[0]).angle_between(one.orientation(whole));
    let place = world.location(halves[1]).distance(one.orientation(whole) * (DVec3::X * 0.25));
    // The error is (ωh)⁴ over a phase of 6; the angle between unit quaternions has a rounding error of 2e-8.
    assert!(turn < 1e-7 && place < 1e-10, "{turn:e} {place:e}");
}

/// Checks that a block on a rail inclined by 30° slides with g sin 30°, and does not turn.
#[test]
fn a_slider_leads_along_its_axis_alone() {
    for method in that_keep_joints() {
        let mut world = world(method, 1e-3);
        let axis = DVec3::new(0.75f64.sqrt(), 0.5, 0.0);
        let block =
            RigidBody::new(&Shape::Box { size: DVec3::new(0.3, 0.1, 0.2) }, 2.0).with_location(DVec3::Y);
        let block = world.add(block);
        let arm = DVec3::new(0.1, 0.05, 0.0);
        let between = [Anchor::Point(DVec3::Y + arm), at(block, arm)];
        world.add_constraint(Slider { between, axis, turned: DQuat::IDENTITY, freedom: Freedom::default() });
        world.advance_to(1.0);
        let way = world.location(block) - DVec3::Y;
        let expected = -0.25 * G;
        // Euler methods have an error of half a step times the acceleration; all other methods are exact for a constant acceleration.
        let allowed = if method.order == 1 { 0.5 * G * 1e-3 } else { 1e-12 };
        assert!((way.dot(axis) - expected).abs() < allowed, "{}: {way}", method.name);
        assert!(way.cross(axis).length() < 1e-14, "{}: {way}", method.name);
        assert!(world.orientation(block).angle_between(DQuat::IDENTITY) < 1e-7);
    }
}

/// Checks that a joint violated at the start is corrected by the smallest displacement, and that a joint that cannot be satisfied is
/// reported by its number.
#[test]
fn a_start_that_does_not_fit_is_mended_or_named() {
    let mut world = pendulum(method("rk4"), 1e-3, 90.0);
    let bob = world.add(ball().with_location(DVec3::new(3.1, 0.0, 0.0)).with_velocity(DVec3::X));
    world.add_constraint(Rod { between: [Anchor::Point(DVec3::X * 2.0), Anchor::centre(bob)], length: 1.0 });
    assert!(world.violation() < 1e-15);
    assert!((world.location(bob) - DVec3::X * 3.0).length() < 1e-15);
    assert!(world.velocity(bob).length() < 1e-15);
    assert_eq!(world.balance().drift, 0.0);

    let mut torn = pendulum(method("rk4"), 1e-3, 90.0);
    torn.add_constraint(Rod {
        between: [Anchor::Point(DVec3::X * 4.0), Anchor::centre(BodyId::new(0))],
        length: 1.0,
    });
    let error = Dynamics::snapshot(&mut torn).unwrap_err();
    let Breakdown::Broken { time, missing, .. } = error else { panic!("{error:?}") };
    assert!(time == 0.0 && (0.5..=2.0).contains(&missing), "{error:?}");
}

/// Checks that a joint ends when one of its bodies disappears: the upper body disappears, and the lower one falls freely.
#[test]
fn a_joint_ends_with_its_body() {
    let end = 0.5;
    let mut world = world(method("rk4"), 1e-3);
    let upper = world.add(ball().with_location(DVec3::X));
    let lower = world.add(ball().with_location(2.0 * DVec3::X));
    world.add_constraint(Rod { between: [Anchor::Point(DVec3::ZERO), Anchor::centre(upper)], length: 1.0 });
    world.add_constraint(Rod { between: [Anchor::centre(upper), Anchor::centre(lower)], length: 1.0 });
    world.limit(upper, &Presence::during(&[[0.0, end]]));
    world.advance_to(end);
    let (x, v) = (world.location(lower), world.velocity(lower));
    assert!((world.location(upper).distance(x) - 1.0).abs() < 1e-14);
    world.advance_to(1.5);
    let fallen = x + v - DVec3::Y * (0.5 * G);
    assert!(world.location(lower).distance(fallen) < 1e-12);
    assert!(world.balance().drift.abs() < 1e-9, "{}", world.balance().drift);
}

/// Checks that the energy of the RATTLE method has no trend over 10,000 periods: its mean deviation in the second half equals that in the
/// first.
#[test]
fn the_energy_of_rattle_has_no_trend() {
    let mut world = pendulum(method("velocity-verlet"), 1.0 / 60.0, 30.0);
    let mean = |world: &mut World, from: u32| {
        let mut sum = 0.0;
        for k in 0..100_000 {
            world.advance_to(2.04 * 5000.0 * f64::from(from) + 0.102 * f64::from(k + 1));
            sum += world.balance().drift;
        }
        sum / 1e5
    };
    let halves = (mean(&mut world, 0), mean(&mut world, 1));
    assert!((halves.0 - halves.1).abs() < 1e-3 * halves.0.abs(), "{halves:?}");
}
