//! Tests of time-stepping: stacks, rebounds and thin walls.

use std::f64::consts::FRAC_PI_2;

use glam::{DQuat, DVec3};

use super::super::super::*;
use super::{GRAVITY, STEP, Scene, cube, run};

/// Two rings hang in each other, the upper one fixed, and the lower one begins with a swing. Friction must bring it to rest, and may at no
/// time add energy.
#[test]
fn a_ring_that_hangs_in_another_comes_to_rest() {
    let mut scene = Scene::default();
    let ring = Shape::Torus { radius: 0.1, tube_radius: 0.02 };
    scene.add(ring.clone(), |body| body.with_fixed(true).with_orientation(DQuat::from_rotation_x(FRAC_PI_2)));
    let hung = scene.add(ring, |body| {
        let turn = DQuat::from_rotation_z(FRAC_PI_2);
        body.with_location(-0.1595 * DVec3::Y).with_orientation(turn).with_velocity(DVec3::new(0.3, 0.0, 0.2))
    });
    let mut stepping = scene.stepping();
    let mut energy = f64::INFINITY;
    for k in 1..=20 {
        let now = run(&mut stepping, 0.5 * f64::from(k)).balance;
        assert!(now.total < energy + 1e-3, "{k}: {} after {energy}", now.total);
        energy = now.total;
    }
    let end = run(&mut stepping, 12.0).bodies[hung.index()];
    println!("{} {}", end.velocity, end.angular_velocity);
    assert!(end.velocity.length() < 0.02, "{}", end.velocity);
}

/// Ten boxes of 1 m stand on each other. They may sink into each other slightly, but must stay in place.
#[test]
fn ten_boxes_stand_for_a_minute() {
    let mut scene = Scene::default().with_ground(0.0);
    for k in 0..10 {
        scene.add(cube(1.0), |body| body.with_location(DVec3::Y * (0.5 + f64::from(k))));
    }
    let mut stepping = scene.stepping();
    run(&mut stepping, 1.0);
    let early = run(&mut stepping, 10.0);
    let end = run(&mut stepping, 60.0);
    for k in 1..=10 {
        let (body, ideal) = (end.bodies[k], DVec3::Y * (k as f64 - 0.5));
        let moved = body.location - early.bodies[k].location;
        println!("{k}: {} from {ideal}, moved by {moved} since 10 s", body.location - ideal);
        assert!(moved.length() < 0.01, "{k} {moved}");
    }
    for k in 1..10 {
        let gap = end.bodies[k + 1].location.y - end.bodies[k].location.y - 1.0;
        assert!(gap.abs() < 0.03, "{k} {gap}");
        assert!(end.bodies[k].location.with_y(0.0).length() < 0.03, "{k}");
    }
    println!("penetration {} m, drift {}", stepping.penetration(), end.balance.drift);
}

/// While a wall of bricks settles under its weight, its energy error equals that of Euler–Cromer, −½ Δt Σ F·v: the method uses forces at
/// the start of a step and velocities at its end. All energy that contacts take must be booked.
#[test]
fn a_wall_that_settles_loses_what_is_booked() {
    let mut scene = Scene::default().with_ground(0.0);
    for k in 0..40 {
        let (row, place) = (f64::from(k / 5), f64::from(k % 5) + 0.2 * f64::from(k / 5 % 2));
        let at = DVec3::new(0.52 * place, 0.1 + 0.2 * row, 0.0);
        scene.add(Shape::Box { size: DVec3::new(0.5, 0.2, 0.25) }, |body| body.with_location(at));
    }
    let mut stepping = scene.stepping();
    let before = stepping.snapshot().unwrap().balance.total;
    let mut largest: f64 = 0.0;
    for k in 1..=100 {
        let seen = run(&mut stepping, 4.0 * STEP * f64::from(k));
        let sinking: f64 = seen.bodies.iter().map(|body| body.velocity.y).sum();
        let of_method = 0.5 * STEP * GRAVITY * sinking;
        let taken = seen.balance.accounts.total();
        let error = seen.balance.total - before - taken - of_method;
        assert!(error.abs() < 1e-3 * taken.abs(), "{}: {error} of {taken}", seen.time);
        largest = largest.max(of_method.abs());
    }
    assert!(largest > 1e-3, "{largest}");
}

/// A ball at 2,000 m/s, which flies 8 m within a step, must not pass through a wall of 1 cm.
#[test]
fn what_is_fast_does_not_pass_through_a_thin_wall() {
    for fixed in [true, false] {
        let mut scene = Scene::default();
        let ball = scene.add(Shape::Sphere { radius: 0.02 }, |body| {
            body.with_location(-20.3 * DVec3::X).with_velocity(2000.0 * DVec3::X)
        });
        scene.add(Shape::Box { size: DVec3::new(0.01, 4.0, 4.0) }, |body| {
            RigidBody { mass: 1e4, ..body }.with_fixed(fixed)
        });
        let mut stepping = TimeStepping::new(scene.world(0.0), &scene.contacts(), &[]);
        let end = run(&mut stepping, 0.1);
        let (ball, wall) = (end.bodies[ball.index()], end.bodies[1]);
        assert!(ball.location.x < wall.location.x, "{fixed} {} {}", ball.location, wall.location);
    }
}

/// A ball with restitution 1 falls from 1 m, with steps of 1/240 s. A warning of the scene's check names the loss of height that this test
/// measures.
#[test]
fn a_rebound_loses_as_much_height_as_the_warning_says() {
    let mut scene = Scene::default().with_ground(0.0);
    let ball = scene.add(Shape::Sphere { radius: 0.1 }, |body| body.with_location(1.1 * DVec3::Y));
    scene.surfaces[ball.index()] = Some(Surface { restitution: Some(1.0), ..Surface::default() });
    let mut stepping = scene.stepping();
    let (mut heights, mut rising) = (Vec::new(), false);
    for k in 1..30_000 {
        let ball = run(&mut stepping, STEP * f64::from(k)).bodies[ball.index()];
        if rising && ball.velocity.y <= 0.0 {
            heights.push(ball.location.y - 0.1);
        }
        rising = ball.velocity.y > 0.0;
    }
    println!("{} rebounds, the 10th {} m, the last {:?} m", heights.len(), heights[9], heights.last());
    assert!((heights[9] - 0.82).abs() < 0.01, "{}", heights[9]);
    assert!((90..=98).contains(&heights.len()), "{}", heights.len());
}

/// A torus and a frustum, which the physics engine approximates by simpler solids, must rest at the heights of the exact shapes.
#[test]
fn shapes_that_are_fitted_are_right_to_a_percent() {
    let mut scene = Scene::default().with_ground(0.0);
    let ring =
        scene.add(Shape::Torus { radius: 0.5, tube_radius: 0.1 }, |body| body.with_location(0.12 * DVec3::Y));
    let bucket = Shape::Cone { radius: 0.3, top_radius: 0.2, height: 0.4 };
    let base = -cone_base(0.3, 0.2, 0.4);
    let frustum = scene.add(bucket, |body| body.with_location(DVec3::new(2.0, base + 0.02, 0.0)));
    let end = run(&mut scene.stepping(), 2.0);
    let [ring, frustum] = [ring, frustum].map(|id| end.bodies[id.index()].location.y);
    assert!((ring - 0.1).abs() < 0.001, "{ring}");
    assert!((frustum - base).abs() < 0.001, "{frustum} {base}");
}

/// Two boxes of 1 m whose centres are 0.8 m apart must be reported. At 0.98 m, the overlap is small enough to be accepted.
#[test]
fn bodies_that_overlap_at_the_start_are_a_mistake() {
    for (apart, is_wrong) in [(0.8, true), (0.98, false)] {
        let mut scene = Scene::default();
        scene.add(cube(1.0), |body| body);
        scene.add(cube(1.0), |body| body.with_location(apart * DVec3::X));
        let found = scene.stepping().advance(0.1, &[], &mut |_| {});
        match found {
            Err(Breakdown::Overlapping { bodies, depth, time }) => {
                assert!(is_wrong && (depth - 0.2).abs() < 0.02, "{depth}");
                assert_eq!((bodies.map(BodyId::index), time), ([0, 1], 0.0));
            }
            other => assert!(!is_wrong && other.is_ok(), "{other:?}"),
        }
    }
}

/// The same holds for a body that appears during the run inside another one.
#[test]
fn a_body_that_appears_inside_another_is_a_mistake() {
    for (apart, is_wrong) in [(0.2, true), (1.5, false)] {
        let mut scene = Scene::default();
        scene.add(cube(1.0), |body| body);
        let late = scene.add(cube(1.0), |body| body.with_location(apart * DVec3::X));
        let mut world = scene.world(0.0);
        world.limit(late, &Presence::during(&[[0.5, f64::INFINITY]]));
        let mut stepping = TimeStepping::new(world, &scene.contacts(), &[]);
        match stepping.advance(1.0, &[], &mut |_| {}) {
            Err(Breakdown::Overlapping { bodies, time, .. }) => {
                assert!(is_wrong, "{apart}");
                assert_eq!((bodies.map(BodyId::index), time), ([0, 1], 0.5));
            }
            other => assert!(!is_wrong && other.is_ok(), "{other:?}"),
        }
    }
}

/// A house of five floors of cards that lean against each other at 20° from upright. Only friction holds the cards: with a tenth of the
/// friction, they must slide apart.
#[test]
fn a_house_of_cards_stands_by_friction() {
    const FLOORS: u32 = 5;
    let (length, thick, lean) = (1.0, 0.02, 20_f64.to_radians());
    let (sin, cos) = (libm::sin(lean), libm::cos(lean));
    let (half, storey) = (0.5 * (length * sin + thick * cos), length * cos + thick * sin);
    for (friction, stands) in [(0.6, true), (0.06, false)] {
        let mut scene = Scene::default().with_ground(0.0);
        for floor in 0..FLOORS {
            let (pairs, base) = (FLOORS - floor, f64::from(floor) * (storey + thick));
            let middle = 0.5 * f64::from(pairs - 1);
            for pair in 0..pairs {
                for side in [-1.0, 1.0] {
                    let at =
                        DVec3::new(0.98 * (f64::from(pair) - middle) + side * half, base + 0.5 * storey, 0.0);
                    let turn = DQuat::from_rotation_z(side * lean);
                    scene.add(Shape::Box { size: DVec3::new(thick, length, 0.7) }, |body| {
                        body.with_location(at).with_orientation(turn)
                    });
                }
            }
            for deck in 1..pairs {
                let at =
                    DVec3::new(0.98 * (f64::from(deck) - 0.5 - middle), base + storey + 0.5 * thick, 0.0);
                scene.add(Shape::Box { size: DVec3::new(0.97, thick, 0.7) }, |body| body.with_location(at));
            }
        }
        scene
            .surfaces
            .iter_mut()
            .for_each(|surface| *surface = Some(Surface { friction: Some(friction), ..Surface::default() }));
        let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &[]);
        stepping.set_step(1.0 / 960.0);
        let end = run(&mut stepping, 5.0);
        let moved = |(body, start): (&BodySnapshot, &RigidBody)| (body.location - start.location).length();
        let moved = end.bodies.iter().zip(&scene.bodies).map(moved).fold(0.0, f64::max);
        assert_eq!(moved < 0.01, stands, "{friction}: {moved} m");
    }
}

/// The first of twenty dominoes is pushed. All dominoes must fall, one after another.
#[test]
fn dominoes_fall_to_the_last() {
    let mut scene = Scene::default().with_ground(0.0);
    for k in 0..20 {
        scene.add(Shape::Box { size: DVec3::new(0.1, 0.8, 0.4) }, |body| {
            let body = body.with_location(DVec3::new(0.4 * f64::from(k), 0.4, 0.0));
            if k > 0 {
                return body;
            }
            body.with_velocity(DVec3::X).with_angular_velocity(-2.5 * DVec3::Z)
        });
    }
    let mut stepping = scene.stepping();
    let has_fallen = |body: &BodySnapshot| (body.orientation * DVec3::Y).y < 0.6;
    let mut fallen = Vec::new();
    for k in 1..=40 {
        let seen = run(&mut stepping, 0.1 * f64::from(k));
        fallen.push(seen.bodies[1..].iter().take_while(|body| has_fallen(body)).count());
    }
    assert!(fallen.is_sorted(), "{fallen:?}");
    assert!(fallen[9] < 15, "{fallen:?}");
    assert_eq!(fallen[39], 20, "{fallen:?}");
}

/// Bodies fall flat on the ground from 1 m, with a restitution of 0.8. They must rise to 0.64 m without spin. The impact happens within a
/// step, so the height may be wrong by the path of one step.
#[test]
fn what_falls_flat_rebounds_without_spin() {
    const RESTITUTION: f64 = 0.8;
    let lying = DQuat::from_rotation_z(0.5 * std::f64::consts::PI);
    let shapes = [
        ("cylinder", Shape::Cylinder { radius: 0.1, height: 0.2 }, DQuat::IDENTITY, 0.1),
        ("lying cylinder", Shape::Cylinder { radius: 0.1, height: 0.4 }, lying, 0.1),
        ("cone", Shape::Cone { radius: 0.1, top_radius: 0.0, height: 0.2 }, DQuat::IDENTITY, 0.05),
        ("cube", cube(0.2), DQuat::IDENTITY, 0.1),
        ("plate", Shape::Box { size: DVec3::new(1.0, 0.1, 0.6) }, DQuat::IDENTITY, 0.05),
        ("lying capsule", Shape::Capsule { radius: 0.1, height: 0.6 }, lying, 0.1),
        ("slab", Shape::Box { size: DVec3::new(1.2, 0.6, 0.8) }, DQuat::IDENTITY, 0.3),
    ];
    for (name, shape, orientation, rest) in shapes {
        for step in [STEP, 0.002, 0.25 * STEP, 0.001, 0.0007, 0.0005] {
            let mut scene = Scene::default().with_ground(0.0);
            let start = (1.0 + rest) * DVec3::Y;
            scene.add(shape.clone(), |body| body.with_location(start).with_orientation(orientation));
            scene.surfaces[1] = Some(Surface { restitution: Some(RESTITUTION), ..Surface::default() });
            let mut stepping = scene.stepping();
            stepping.set_step(step);
            let (mut highest, mut spin) = (0.0_f64, 0.0_f64);
            for k in 50..100 {
                let body = run(&mut stepping, 0.01 * f64::from(k)).bodies[1];
                highest = highest.max(body.location.y - rest);
                spin = spin.max(body.angular_velocity.length());
            }
            let fallen = RESTITUTION * RESTITUTION;
            let tolerance = 2.0 * step * libm::sqrt(2.0 * GRAVITY);
            println!("{name}: {highest} m, {spin} rad/s");
            assert!((highest - fallen).abs() < tolerance, "{name}, {step} s: {highest} m");
            assert!(spin < 1e-6, "{name}, {step} s: {spin} rad/s");
        }
    }
}

/// Two cubes without friction collide face to face, one of them at rest, with a restitution of 1. They must exchange their velocities.
#[test]
fn cubes_exchange_their_velocities() {
    let mut scene = Scene::default();
    let surface = Some(Surface { restitution: Some(1.0), friction: Some(0.0), ..Surface::default() });
    scene.add(cube(0.2), |body| body.with_velocity(2.0 * DVec3::X));
    // Half of each face touches the other one.
    scene.add(cube(0.2), |body| body.with_location(DVec3::new(1.0, 0.1, 0.0)));
    scene.surfaces = vec![surface; 2];
    let mut stepping = TimeStepping::new(scene.world(0.0), &scene.contacts(), &[]);
    let end = run(&mut stepping, 1.0);
    let momentum = end.bodies[0].velocity + end.bodies[1].velocity;
    assert!((momentum - 2.0 * DVec3::X).length() < 1e-12, "{momentum}");
    assert!((end.balance.kinetic / 2.0 - 1.0).abs() < 1e-9, "{}", end.balance.kinetic);
    let rotates = end.bodies.iter().all(|body| body.angular_velocity.z.abs() > 1.0);
    assert!(rotates && end.bodies.iter().all(|body| body.angular_velocity.x.abs() < 1e-9));
}

/// A spinning ball falls on the ground with a restitution of 0.9, and slides during the impact. Friction must give it μ (1 + e) v, where v is its
/// speed at the impact.
#[test]
fn friction_in_an_impact_counts_the_rebound() {
    let mut scene = Scene::default().with_ground(0.0);
    let ball = Shape::Sphere { radius: 0.1 };
    scene.add(ball, |body| body.with_location(0.6 * DVec3::Y).with_angular_velocity(-200.0 * DVec3::Z));
    let surface = Surface { restitution: Some(0.9), friction: Some(0.5), ..Surface::default() };
    scene.surfaces = vec![Some(surface); 2];
    let end = run(&mut scene.stepping(), 0.4).bodies[1];
    let rebound = end.velocity.y + GRAVITY * (0.4 - libm::sqrt(2.0 * 0.5 / GRAVITY));
    let gained = 0.5 * 1.9 * rebound / 0.9;
    assert!((end.velocity.x / gained - 1.0).abs() < 0.02, "{} {gained}", end.velocity);
}

/// Balls fall slantwise on the ground from heights that differ by a fraction of a step. Friction changes the speed by μ (1 + e) times the speed
/// of the impact, wherever in a step the impact comes.
#[test]
fn friction_in_an_impact_does_not_depend_on_the_step() {
    for step in [STEP, 1e-3, 2.5e-4] {
        let mut scene = Scene::default().with_ground(0.0);
        for k in 0..5 {
            scene.add(Shape::Sphere { radius: 0.1 }, |body| {
                body.with_location(DVec3::new(0.0, 0.115 + 0.00025 * f64::from(k), 0.5 * f64::from(k)))
                    .with_velocity(DVec3::new(1.0, -0.3, 0.0))
            });
        }
        let surface = Surface { restitution: Some(0.5), friction: Some(0.3), ..Surface::default() };
        scene.surfaces = vec![Some(surface); 6];
        let mut stepping = TimeStepping::new(scene.world(0.0), &scene.contacts(), &[]);
        stepping.set_step(step);
        for body in &run(&mut stepping, 0.2).bodies[1..] {
            let expected = DVec3::new(1.0 - 0.3 * 1.5 * 0.3, 0.15, 0.0);
            assert!(body.velocity.abs_diff_eq(expected, 1e-3), "{step} {}", body.velocity);
        }
    }
}

/// Cylinders and capsules roll slowly on a level box. Nothing drives or brakes them.
#[test]
fn slow_rolling_is_even_on_a_box() {
    let lying = DQuat::from_rotation_x(0.5 * std::f64::consts::PI);
    for shape in [Shape::Cylinder { radius: 0.2, height: 0.3 }, Shape::Capsule { radius: 0.2, height: 0.8 }] {
        let mut scene = Scene::default();
        let floor = Shape::Box { size: DVec3::new(20.0, 1.0, 4.0) };
        scene.add(floor, |body| body.with_location(-0.5 * DVec3::Y).with_fixed(true));
        scene.add(shape, |body| {
            body.with_location(0.2 * DVec3::Y)
                .with_orientation(lying)
                .with_velocity(0.1 * DVec3::X)
                .with_angular_velocity(-0.5 * DVec3::Z)
        });
        let end = run(&mut scene.stepping(), 5.0).bodies[1];
        assert!((end.velocity.x - 0.1).abs() < 1e-4, "{}", end.velocity);
    }
}

/// Twenty coins lie on each other without gaps. At the start, the contacts yield until they carry the coins. The top coin may sink by little
/// more than one thickness.
#[test]
fn a_stack_of_coins_sinks_little_at_the_start() {
    /// The thickness of a coin, m.
    const COIN_THICKNESS: f64 = 0.002;
    let mut scene = Scene::default().with_ground(0.0);
    for k in 0..20 {
        let at = (f64::from(k) + 0.5) * COIN_THICKNESS * DVec3::Y;
        scene.add(Shape::Cylinder { radius: 0.012, height: COIN_THICKNESS }, |body| body.with_location(at));
    }
    let mut stepping = scene.stepping();
    stepping.set_step(5e-4);
    let mut lowest = f64::INFINITY;
    for k in 1..=40 {
        lowest = lowest.min(run(&mut stepping, 0.005 * f64::from(k)).bodies[20].location.y);
    }
    let sunk = 19.5 * COIN_THICKNESS - lowest;
    println!("{sunk} m");
    assert!(sunk < 1.25 * COIN_THICKNESS, "{sunk}");
}

/// Two bodies without friction attract each other by a spring, touch, and revolve about each other at 1 rad/s. They must keep their angular
/// momentum. In each step, the engine moves them along their tangents, and then closes the gap between them. This takes the part ½ ω² Δt of the
/// angular momentum in each second.
#[test]
fn what_touches_revolves_freely() {
    for shape in [Shape::Sphere { radius: 0.1 }, cube(0.2)] {
        let mut scene = Scene::default();
        let spin = DVec3::Z;
        let [one, two] = [-0.1, 0.1].map(|x| {
            let at = x * DVec3::X;
            let turning = if matches!(shape, Shape::Sphere { .. }) { DVec3::ZERO } else { spin };
            scene.add(shape.clone(), |body| {
                body.with_location(at).with_velocity(spin.cross(at)).with_angular_velocity(turning)
            })
        });
        let surface = Surface { friction: Some(0.0), ..Surface::default() };
        scene.surfaces.iter_mut().for_each(|own| *own = Some(surface));
        let mut world = scene.world(0.0);
        world.add_force(Spring {
            between: [Anchor::centre(one), Anchor::centre(two)],
            stiffness: 10.0,
            damping: 0.0,
            rest_length: 0.0,
        });
        let mut stepping = TimeStepping::new(world, &scene.contacts(), &[]);
        let start = run(&mut stepping, 0.0).balance.angular_momentum;
        let end = run(&mut stepping, 10.0).balance.angular_momentum;
        println!("{end} of {start}");
        assert!((end - start).length() < 1.2 * 0.5 * STEP * 10.0 * start.length(), "{end} {start}");
    }
}
