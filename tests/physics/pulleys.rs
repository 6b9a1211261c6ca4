//! Tests of ropes over pulleys, fixed and movable, against closed forms and an independent integration.

use glam::{DQuat, DVec3};
use jabuka::physics::{Anchor, BodyId, Dynamics, Kinematics, Motion, Pulley, RigidBody, Shape};

use crate::common::{G, falling, frames, origin, that_keep_joints, world};

fn sphere(mass: f64) -> RigidBody {
    RigidBody::new(&Shape::Sphere { radius: 0.1 }, mass)
}

/// Checks Atwood's machine with a ratio: the tension is the same along the whole rope.
#[test]
fn a_pulley_is_atwoods_machine() {
    for method in that_keep_joints() {
        for ratio in [1.0, 2.0] {
            let mut world = falling(method, 1e-3);
            let light = world.add(sphere(1.0).with_location(DVec3::new(-1.0, -2.0, 0.0)));
            let heavy = world.add(sphere(3.0).with_location(DVec3::new(1.0, -2.0, 0.0)));
            world.add_constraint(Pulley::new(
                [Anchor::centre(light), Anchor::centre(heavy)],
                &[Anchor::Point(DVec3::NEG_X), Anchor::Point(DVec3::X)],
                ratio,
                2.0 + 2.0 + ratio * 2.0,
            ));
            world.advance_to(0.5);
            // The equations of motion are y₁'' = −r y₂''; m₁ (y₁'' + g) = T, m₂ (y₂'' + g) = r T.
            let down = -G * (3.0 - ratio) / (3.0 + ratio * ratio);
            let expected = [-ratio * down * 0.5, down * 0.5];
            let found = [light, heavy].map(|id| world.velocity(id).y);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-11, "{} {ratio}: {found} {expected}", method.name);
            }
        }
    }
}

/// Checks tackles of one to four strands: a load of 4 kg hangs on k strands of a rope whose end holds 2.5 kg. With the load's acceleration a
/// upwards, m a = k T − m g and M k a = M g − T.
#[test]
fn a_tackle_has_any_number_of_strands() {
    for method in that_keep_joints() {
        for strands in 1..=4_u32 {
            let mut world = falling(method, 1e-3);
            let load = world.add(sphere(4.0).with_location(DVec3::NEG_Y * 3.0));
            let hand = world.add(sphere(2.5).with_location(DVec3::NEG_Y * 2.0));
            let (wheel, ceiling) = (Anchor::centre(load), origin());
            // The rope begins where the last strand ends: at the load with an odd number of strands, and at the ceiling otherwise.
            let path: Vec<Anchor> =
                (0..=strands).map(|k| if (strands - k) % 2 == 0 { ceiling } else { wheel }).collect();
            let between = [path[0], Anchor::centre(hand)];
            let length = f64::from(strands) * 3.0 + 2.0;
            world.add_constraint(Pulley::new(between, &path[1..], 1.0, length));
            let (m, held, k) = (4.0, 2.5, f64::from(strands));
            let up = (k * held - m) * G / (m + k * k * held);
            let tension = held * (G - k * up);
            world.advance_to(0.4);
            let case = format!("{} {strands}", method.name);
            let [risen, sunk] = [load, hand].map(|id| world.velocity(id).y);
            assert!(
                (risen - up * 0.4).abs() < 1e-11 && (sunk + k * up * 0.4).abs() < 1e-11,
                "{case}: {risen} {sunk}"
            );
            let snapshot = world.snapshot().unwrap();
            let force = snapshot.reactions[0].force;
            assert!((force - DVec3::Y * tension).length() < 1e-9, "{case}: {force} {tension}");
            let slack = if method.order == 1 { 0.05 } else { 1e-9 };
            assert!(snapshot.balance.drift.abs() < slack, "{case}: {:e}", snapshot.balance.drift);
        }
    }
}

/// Checks an Atwood machine on a movable pulley of 0.5 kg, which hangs on a rope over a fixed wheel with 3 kg at its other end. With the
/// masses m₁, p, m₂ and m₃, and μ = m₂ m₃ / (m₂ + m₃), the tension of the lower rope is 2 μ (g − a₁).
#[test]
fn a_pulley_hangs_on_a_pulley() {
    for method in that_keep_joints() {
        let mut world = falling(method, 1e-3);
        let [first, wheel, second, third] = [(3.0, 2.0), (0.5, 1.5), (1.0, 4.0), (2.0, 3.0)]
            .map(|(mass, depth)| world.add(sphere(mass).with_location(DVec3::NEG_Y * depth)));
        let rope = |between: [BodyId; 2], over: Anchor, length: f64| {
            Pulley::new(between.map(Anchor::centre), &[over], 1.0, length)
        };
        world.add_constraint(rope([first, wheel], origin(), 3.5));
        world.add_constraint(rope([second, third], Anchor::centre(wheel), 4.0));
        world.advance_to(0.4);
        let (m1, p, mu) = (3.0, 0.5, 2.0 / 3.0);
        let up = (4.0 * mu + p - m1) * G / (m1 + p + 4.0 * mu);
        let [upper, lower] = [m1 * (up + G), 2.0 * mu * (G - up)];
        let expected = [up, -up, lower / 1.0 - G, lower / 2.0 - G];
        for (id, expected) in [first, wheel, second, third].into_iter().zip(expected) {
            let found = world.velocity(id).y;
            assert!((found - 0.4 * expected).abs() < 1e-11, "{}: {found} {expected}", method.name);
        }
        let snapshot = world.snapshot().unwrap();
        for (reaction, expected) in snapshot.reactions.iter().zip([upper, lower]) {
            assert!(
                (reaction.force - DVec3::Y * expected).length() < 1e-9,
                "{}: {reaction:?} {expected}",
                method.name
            );
        }
    }
}

/// Checks that a movable wheel hangs between two fixed points, and that a rope whose last end is a point of the world pulls there with its
/// tension. The load is pulled along the ellipse that the rope allows, and its energy holds.
#[test]
fn a_wheel_runs_along_a_rope_between_two_points() {
    for method in that_keep_joints() {
        let mut world = falling(method, 1e-3);
        let start = DVec3::new(1.0, -2.0, 0.0);
        let load = world.add(sphere(1.5).with_location(start));
        let ends = [DVec3::NEG_X * 2.0, DVec3::X * 2.0];
        let length: f64 = ends.iter().map(|end| end.distance(start)).sum();
        world.add_constraint(Pulley::new(ends.map(Anchor::Point), &[Anchor::centre(load)], 1.0, length));
        world.advance_to(1.7);
        let place = world.location(load);
        let found: f64 = ends.iter().map(|end| end.distance(place)).sum();
        assert!((found - length).abs() < 1e-11, "{}: {found} {length}", method.name);
        let snapshot = world.snapshot().unwrap();
        let slack = if method.order == 1 { 0.05 } else { 1e-4 };
        assert!(snapshot.balance.drift.abs() < slack, "{}: {:e}", method.name, snapshot.balance.drift);
        // Both parts pull with the same tension, and together they are what moves the load beside its weight.
        let pull = snapshot.reactions[0].force;
        let [one, other] = ends.map(|end| (end - place).normalize());
        let tension = pull.length();
        assert!((pull + tension * other).length() < 1e-9 * tension, "{}: {pull}", method.name);
        let body = snapshot.bodies[0];
        let weight = DVec3::NEG_Y * G * 1.5;
        assert!((body.force - weight - tension * (one + other)).length() < 1e-8, "{}", method.name);
    }
}

/// Checks that an Atwood machine stops when its light end reaches the wheel; the heavy end stops as well.
#[test]
fn a_pulley_ends_at_its_wheels() {
    for method in that_keep_joints() {
        let mut world = falling(method, 1e-3);
        let light = world.add(sphere(1.0).with_location(DVec3::new(-1.0, -2.0, 0.0)));
        let heavy = world.add(sphere(3.0).with_location(DVec3::new(1.0, -2.0, 0.0)));
        let over = [Anchor::Point(DVec3::NEG_X), Anchor::Point(DVec3::X)];
        let between = [Anchor::centre(light), Anchor::centre(heavy)];
        world.add_constraint(Pulley::new(between, &over, 1.0, 6.0));
        world.advance_to(3.0);
        let expected = [-2.0 * Pulley::NEAREST, -4.0 + 2.0 * Pulley::NEAREST];
        for (id, expected) in [light, heavy].into_iter().zip(expected) {
            assert!(
                (world.location(id).y - expected).abs() < 1e-12,
                "{}: {}",
                method.name,
                world.location(id)
            );
            assert!(world.velocity(id).length() < 1e-12, "{}", method.name);
        }
        let balance = world.balance();
        // The loss is the potential energy lost by the heavy end minus that gained by the light end.
        let slack = if method.order == 1 { 0.1 } else { 1e-9 };
        let lost = -2.0 * G * (2.0 - 2.0 * Pulley::NEAREST);
        assert!((balance.accounts.limits - lost).abs() < slack, "{}: {balance:?} {lost}", method.name);
    }
}

/// The load of a block and tackle at 0.8 s: x and y (m), its angle (rad), the height of the hand (m), and its velocity (m/s).
const LOAD: [f64; 6] =
    [0.125650083895, 0.716748307454, 0.059892892082, 1.564890398544, 0.222816107660, 0.545187660689];

/// Checks a block and tackle whose load hangs beside the middle of its strands, swings and rotates, as the rope pulls at a point above its
/// center. The expected motion is a solution of the equations of motion with a multiplier for the length of the rope, by DOP853 of
/// SciPy 1.17 with a relative tolerance of 1e-13.
#[test]
fn a_tackle_swings_and_turns_its_load() {
    let text = "simulation = { duration = 0.8, gravity = [0, -9.81, 0], integrator = 'rk4', step = 0.001 }
        [body.load]\nshape.sphere.radius = 0.1\nmass = 4\nlocation = [0, 0.5, 0]
        [body.hand]\nshape.sphere.radius = 0.1\nmass = 2.5\nlocation = [0.3, 2, 0]
        [joint.rope.pulley]\nbetween = [[-0.1, 2.5, 0], 'hand']
        over = [{ body = 'load', at = [0, 0.2, 0] }, [0.3, 2.5, 0]]";
    let frame = frames(text).pop().unwrap();
    let [load, hand] = [0, 1].map(|body| frame.body(body).copied().unwrap());
    let place = DVec3::new(LOAD[0], LOAD[1], 0.0);
    assert!((load.location - place).length() < 1e-9, "{}", load.location);
    assert!((load.orientation - DQuat::from_rotation_z(LOAD[2])).length() < 1e-9, "{}", load.orientation);
    assert!((hand.location - DVec3::new(0.3, LOAD[3], 0.0)).length() < 1e-9, "{}", hand.location);
    assert!((load.velocity - DVec3::new(LOAD[4], LOAD[5], 0.0)).length() < 1e-8, "{}", load.velocity);
}

/// Checks three bodies on one rope that runs over two fixed wheels, with the middle body on a wheel between them. With the tension T,
/// T (1/m₁ + 4/m₂ + 1/m₃) = 4 g.
#[test]
fn three_bodies_share_one_rope() {
    for method in that_keep_joints() {
        let mut world = falling(method, 1e-3);
        let masses = [2.0, 3.0, 1.0];
        let [first, middle, last] = [0, 1, 2].map(|i| {
            let place = DVec3::new(i as f64, -2.0, 0.0);
            world.add(sphere(masses[i]).with_location(place))
        });
        let top = |x: f64| Anchor::Point(DVec3::X * x);
        let over = [top(0.0), top(1.0), Anchor::centre(middle), top(1.0), top(2.0)];
        world.add_constraint(Pulley::new([first, last].map(Anchor::centre), &over, 1.0, 10.0));
        world.advance_to(0.4);
        let tension = 4.0 * G / (1.0 / masses[0] + 4.0 / masses[1] + 1.0 / masses[2]);
        for (id, (strands, mass)) in
            [first, middle, last].into_iter().zip([1.0, 2.0, 1.0].into_iter().zip(masses))
        {
            let expected = 0.4 * (strands * tension / mass - G);
            let found = world.velocity(id).y;
            assert!((found - expected).abs() < 1e-11, "{}: {found} {expected}", method.name);
        }
        let force = world.snapshot().unwrap().reactions[0].force;
        assert!((force - DVec3::Y * tension).length() < 1e-9, "{}: {force}", method.name);
    }
}

/// A crane that rises with 3 m/s².
struct Crane;

impl Motion for Crane {
    fn at(&self, t: f64) -> Kinematics {
        Kinematics {
            location: DVec3::Y * (1.5 * t * t),
            velocity: DVec3::Y * (3.0 * t),
            acceleration: DVec3::Y * 3.0,
            orientation: DQuat::IDENTITY,
            angular_velocity: DVec3::ZERO,
        }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }
}

/// Checks Atwood's machine at a crane that rises with an acceleration a: its tension is 2 m₁ m₂ / (m₁ + m₂) (g + a).
#[test]
fn a_rope_runs_over_a_guided_body() {
    for method in that_keep_joints() {
        let mut world = falling(method, 1e-3);
        let crane = world.add(sphere(1.0));
        world.drive(crane, Crane);
        let masses = [2.0, 3.0];
        let [one, other] = [0, 1].map(|i| {
            let x = [-0.2, 0.2][i];
            world.add(sphere(masses[i]).with_location(DVec3::new(x, -2.0, 0.0)))
        });
        let over = [-0.2, 0.2].map(|x| Anchor::Body { id: crane, at: DVec3::X * x });
        world.add_constraint(Pulley::new([one, other].map(Anchor::centre), &over, 1.0, 4.4));
        world.advance_to(0.4);
        let tension = 2.0 * 6.0 / 5.0 * (G + 3.0);
        for (id, mass) in [one, other].into_iter().zip(masses) {
            let (found, expected) = (world.velocity(id).y, 0.4 * (tension / mass - G));
            assert!((found - expected).abs() < 1e-10, "{}: {found} {expected}", method.name);
        }
        let force = world.snapshot().unwrap().reactions[0].force;
        assert!((force - DVec3::Y * tension).length() < 1e-8, "{}: {force}", method.name);
    }
}

/// Checks a picture on a nail: both ends of its cord are on the picture. Held by the cord at 45°, it hangs with the tension m g / √2. After
/// a push, it slides to a side; the cord keeps its length, and the energy holds.
#[test]
fn a_picture_hangs_on_a_nail() {
    for method in that_keep_joints() {
        for push in [0.0, 0.3] {
            let mut world = falling(method, 1e-3);
            let shape = Shape::Box { size: DVec3::new(1.0, 0.5, 0.1) };
            let place = DVec3::NEG_Y * 0.75;
            let body = RigidBody::new(&shape, 2.0).with_location(place).with_velocity(DVec3::X * push);
            let picture = world.add(body);
            let ends = [-0.5, 0.5].map(|x| Anchor::Body { id: picture, at: DVec3::new(x, 0.25, 0.0) });
            let length = 2.0 * 0.5_f64.sqrt();
            world.add_constraint(Pulley::new(ends, &[origin()], 1.0, length));
            if push == 0.0 {
                let force = world.snapshot().unwrap().reactions[0].force;
                let expected = G * DVec3::new(-1.0, 1.0, 0.0);
                assert!((force - expected).length() < 1e-12 * G, "{}: {force}", method.name);
                continue;
            }
            world.advance_to(1.0);
            let snapshot = world.snapshot().unwrap();
            let body = snapshot.bodies[0];
            let found: f64 =
                ends.iter().map(|end| end.place(|_| (body.location, body.orientation)).length()).sum();
            assert!((found - length).abs() < 1e-11, "{}: {found}", method.name);
            let slack = if method.order == 1 { 0.05 } else { 1e-4 };
            assert!(snapshot.balance.drift.abs() < slack, "{}: {:e}", method.name, snapshot.balance.drift);
            assert!(body.location.x > 0.02, "{}: {}", method.name, body.location);
        }
    }
}

/// Checks that a rope between bodies alone conserves momentum and angular momentum, also where its last part counts more.
#[test]
fn a_rope_between_bodies_conserves_momenta() {
    for method in that_keep_joints() {
        for ratio in [1.0, 2.5] {
            let mut world = world(method, 1e-3);
            let places = [[0.0, 0.0], [1.0, 0.3], [1.5, -0.6], [2.5, 0.2]];
            let speeds = [[-1.0, 0.5], [0.3, 0.8], [0.2, -1.0], [1.0, 0.4]];
            let bodies = [0, 1, 2, 3].map(|i| {
                let [[x, y], [u, v]] = [places[i], speeds[i]];
                let body = sphere(1.0 + i as f64).with_location(DVec3::new(x, y, 0.0));
                world.add(body.with_velocity(DVec3::new(u, v, 0.5)))
            });
            let end = |body: usize| Anchor::Body { id: bodies[body], at: DVec3::new(0.05, 0.02, 0.08) };
            let path = [0, 1, 2, 3].map(end);
            let way = |one: usize, other: usize| {
                let [one, other] = [places[one], places[other]];
                libm::hypot(one[0] - other[0], one[1] - other[1])
            };
            let length = way(0, 1) + way(1, 2) + ratio * way(2, 3);
            world.add_constraint(Pulley::new([path[0], path[3]], &path[1..3], ratio, length));
            world.advance_to(0.001);
            let before = world.balance();
            world.advance_to(0.5);
            let after = world.balance();
            let first = world.velocity(bodies[0]);
            assert!((first - DVec3::new(-1.0, 0.5, 0.5)).length() > 0.1, "the rope has pulled");
            let case = format!("{} {ratio}", method.name);
            let linear = (after.linear_momentum - before.linear_momentum).length();
            let angular = (after.angular_momentum - before.angular_momentum).length();
            // A method of order 1 moves the points at which the rope pulls by up to one step before it pulls.
            let slack = if method.order == 1 { 1e-3 } else { 1e-8 };
            assert!(linear < 1e-12 && angular < slack, "{case}: {linear:e} {angular:e}");
        }
    }
}

/// Checks that the load of a tackle stops below its upper wheel: both of its strands reach their smallest length at once.
#[test]
fn a_tackle_stops_where_its_wheels_meet() {
    for method in that_keep_joints() {
        let mut world = falling(method, 1e-3);
        let load = world.add(sphere(1.0).with_location(DVec3::NEG_Y * 2.0));
        let hand = world.add(sphere(3.0).with_location(DVec3::NEG_Y));
        let between = [origin(), Anchor::centre(hand)];
        world.add_constraint(Pulley::new(between, &[Anchor::centre(load), origin()], 1.0, 5.0));
        world.advance_to(3.0);
        let nearest = 5.0 / 3.0 * Pulley::NEAREST;
        for (id, expected) in [(load, -nearest), (hand, -5.0 + 2.0 * nearest)] {
            let (place, speed) = (world.location(id).y, world.velocity(id).length());
            assert!((place - expected).abs() < 1e-12 && speed < 1e-12, "{}: {place} {speed}", method.name);
        }
        // The hand hangs still at the end of its rope.
        let force = world.snapshot().unwrap().reactions[0].force;
        assert!((force - DVec3::Y * 3.0 * G).length() < 1e-9, "{}: {force}", method.name);
    }
}

/// Checks a load on the ground with a tackle that cannot lift it, and one that can: k T = m g − N in rest, and the closed form in motion.
#[test]
fn a_tackle_lifts_a_load_from_the_ground() {
    for held in [3.0_f64, 8.0] {
        let text = format!(
            "simulation = {{ duration = 0.5, gravity = [0, -10, 0], contacts = 'event-driven', step = 0.005 }}
            [body.load]\nshape.box.size = [0.4, 0.4, 0.4]\nmass = 10\nlocation = [0, 0.2, 0]
            [body.hand]\nshape.sphere.radius = 0.1\nmass = {held}\nlocation = [0.5, 2, 0]
            [joint.rope.pulley]\nbetween = [[0, 3, 0], 'hand']\nover = ['load', [0, 3, 0], [0.5, 3, 0]]
            [environment]\nground = true"
        );
        let frame = frames(&text).pop().unwrap();
        let t = frame.time;
        let up = ((2.0 * held - 10.0) * 10.0 / (10.0 + 4.0 * held)).max(0.0);
        let tension = held * (10.0 - 2.0 * up);
        let (load, force) = (frame.body(0).unwrap(), frame.reactions[0].force);
        assert!((load.velocity.y - up * t).abs() < 1e-9, "{held} kg: {}", load.velocity);
        assert!((load.location.y - 0.2 - 0.5 * up * t * t).abs() < 1e-9, "{held} kg: {}", load.location);
        assert!((force - DVec3::Y * tension).length() < 1e-9, "{held} kg: {force}");
    }
}
