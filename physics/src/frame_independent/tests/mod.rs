mod accuracy;
mod planets;

use glam::{DQuat, DVec3};

use super::super::*;

/// Prepares the run of a world by the adaptive method with this name.
fn run(name: &str, tolerance: f64, end: f64, mut world: World) -> Box<dyn Dynamics> {
    let method = Method::by_name(name).unwrap();
    world.set_integrator(method);
    method.take_over.unwrap()(world, Accuracy { tolerance, end })
}

fn sphere(mass: f64) -> RigidBody {
    RigidBody::new(&Shape::Sphere { radius: 0.1 }, mass)
}

fn attract(world: &mut World) {
    let bodies = (0..world.len()).map(BodyId::new).collect();
    world.add_force(Gravitation {
        bodies,
        against: None,
        constant: 1.0,
        softening: 0.0,
        opening_angle: None,
    });
}

/// Returns a world with a fixed star and a planet at the perihelion of an orbit with this eccentricity.
fn kepler(eccentricity: f64) -> World {
    let mut world = World::new();
    world.add(sphere(1.0).with_fixed(true));
    let speed = ((1.0 + eccentricity) / (1.0 - eccentricity)).sqrt();
    let planet = sphere(1e-3).with_location(DVec3::X * (1.0 - eccentricity));
    world.add(planet.with_velocity(DVec3::Y * speed));
    attract(&mut world);
    world
}

const ADAPTIVE: [&str; 2] = ["dop853", "gauss-radau"];

/// After ten orbits, the planet must be back at its start. The error of DOP853 grows with the tolerance. The error of Gauss–Radau comes
/// from rounding, some 10⁻¹⁴ √10 in the energy.
#[test]
fn a_planet_comes_back_to_where_it_was() {
    let end = 10.0 * std::f64::consts::TAU;
    for (name, tolerance, drift, place) in
        [("dop853", 1e-9, 1e-6, 1e-3), ("dop853", 1e-12, 1e-9, 1e-7), ("gauss-radau", 1e-9, 3e-13, 1e-10)]
    {
        let mut run = run(name, tolerance, end, kepler(0.9));
        run.advance(end, &[], &mut |_| {}).unwrap();
        let snapshot = run.snapshot().unwrap();
        let off = (snapshot.bodies[1].location - DVec3::X * 0.1).length();
        assert!(snapshot.balance.drift.abs() < drift, "{name}: {:e}", snapshot.balance.drift);
        assert!(off < place, "{name}: {off:e}");
        assert!((300..2000).contains(&run.steps()), "{name}: {} steps", run.steps());
    }
}

/// The result of a run must be the same, bit for bit, if the run is advanced in parts, and if moments are requested.
#[test]
fn what_is_looked_at_changes_nothing() {
    for name in ADAPTIVE {
        let end = 7.0;
        let mut straight = run(name, 1e-9, end, kepler(0.5));
        straight.advance(end, &[], &mut |_| {}).unwrap();
        let mut watched = run(name, 1e-9, end, kepler(0.5));
        let mut seen = Vec::new();
        let mut t = 0.0;
        while t < end {
            let next = (t + 0.13_f64).min(end);
            watched.advance(next, &[t + 0.01, t + 0.02], &mut |snapshot| seen.push(snapshot)).unwrap();
            t = next;
        }
        assert_eq!(watched.snapshot().unwrap().bodies, straight.snapshot().unwrap().bodies);
        assert_eq!(watched.steps(), straight.steps());
        // The snapshots of requested moments must be as accurate as the run.
        for moment in &seen {
            assert!(moment.balance.drift.abs() < 1e-8, "{name} {}: {:e}", moment.time, moment.balance.drift);
            let mut alone = run(name, 1e-9, end, kepler(0.5));
            alone.advance(moment.time, &[], &mut |_| {}).unwrap();
            assert_eq!(alone.snapshot().unwrap().bodies, moment.bodies);
        }
        assert!(seen.len() > 100);
    }
}

/// A free body with the principal moments 1, 2, 3 and the angular velocity (0.001, 5, 0.001) flips again and again. In the middle of its
/// first flip, at 3.539 s, the angular velocity about the middle axis changes its sign. The angular velocity after 10 s is known to twelve
/// digits from Euler's equations.
#[test]
fn a_wing_nut_flips_when_it_has_to() {
    // During a flip, an energy error δ grows to about δ/10⁻⁶.
    for (name, tolerance, allowed) in [("dop853", 1e-14, 1e-4), ("gauss-radau", 1e-9, 1e-7)] {
        let mut world = World::new();
        let body = sphere(1.0).with_inertia(DVec3::new(1.0, 2.0, 3.0));
        world.add(body.with_angular_velocity(DVec3::new(0.001, 5.0, 0.001)));
        let mut run = run(name, tolerance, 60.0, world);
        let about = |snapshot: &Snapshot| {
            let body = snapshot.bodies[0];
            body.orientation.conjugate() * body.angular_velocity
        };
        let momentum = run.snapshot().unwrap().balance.angular_momentum;
        let mut seen = Vec::new();
        run.advance(10.0, &[3.538, 3.54], &mut |snapshot| seen.push(about(&snapshot))).unwrap();
        // In the middle of the flip, the angular velocity about the middle axis is 0.
        assert!(seen[0].y * seen[1].y < 0.0, "{name}: {seen:?}");
        let off = about(&run.snapshot().unwrap())
            - DVec3::new(4.510_627_124_012, -2.157_369_682_769, 2.604_211_912_26);
        assert!(off.length() < allowed, "{name}: {off}");
        run.advance(60.0, &[], &mut |_| {}).unwrap();
        let balance = run.snapshot().unwrap().balance;
        let lost = (balance.angular_momentum - momentum).length() / momentum.length();
        assert!(lost < 1e-12 && balance.drift.abs() < 1e-10, "{name}: {lost:e} {:e}", balance.drift);
    }
}

/// The work of a damper and of a body with a given motion is integrated along with the motion. The drift of the energy must stay as small
/// as the error of the method.
#[test]
fn work_is_integrated_along() {
    struct Swing;
    impl Motion for Swing {
        fn at(&self, t: f64) -> Kinematics {
            let (sin, cos) = libm::sincos(3.0 * t);
            Kinematics {
                location: DVec3::X * sin,
                velocity: DVec3::X * (3.0 * cos),
                acceleration: DVec3::X * (-9.0 * sin),
                orientation: DQuat::IDENTITY,
                angular_velocity: DVec3::ZERO,
            }
        }
        fn angular_acceleration(&self, _: f64) -> DVec3 {
            DVec3::ZERO
        }
    }
    for name in ADAPTIVE {
        let mut world = World::new();
        let hand = world.add(sphere(1.0));
        world.drive(hand, Swing);
        let ball =
            world.add(sphere(2.0).with_inertia(DVec3::new(0.1, 0.2, 0.3)).with_location(DVec3::Y * 2.0));
        let hook = Anchor::Body { id: ball, at: DVec3::new(0.1, 0.2, 0.3) };
        let between = [Anchor::centre(hand), hook];
        world.add_force(Spring { between, stiffness: 20.0, damping: 0.5, rest_length: 1.0 });
        world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -9.81, 0.0) });
        let mut run = run(name, 1e-11, 10.0, world);
        run.advance(10.0, &[], &mut |_| {}).unwrap();
        let balance = run.snapshot().unwrap().balance;
        assert!(balance.drift.abs() < 1e-9, "{name}: {:e}", balance.drift);
        assert!(balance.accounts.work.abs() > 1.0);
    }
}

/// A body appears and disappears during the run. A step must end at each of these times, and the energy of the body must not count as
/// drift.
#[test]
fn bodies_come_and_go_between_steps() {
    for name in ADAPTIVE {
        let mut world = kepler(0.3);
        let guest = world.add(sphere(0.1).with_location(DVec3::new(0.0, 0.0, 3.0)));
        attract(&mut world);
        world.limit(guest, &Presence::during(&[[0.7, 2.3]]));
        let mut run = run(name, 1e-10, 5.0, world);
        let mut counts = Vec::new();
        run.advance(5.0, &[0.6, 0.7, 0.8, 2.3, 2.31], &mut |snapshot| {
            assert!(snapshot.balance.drift.abs() < 1e-8, "{name}: {:e}", snapshot.balance.drift);
            counts.push(snapshot.bodies.len());
        })
        .unwrap();
        assert_eq!(counts, [2, 3, 3, 3, 2], "{name}");
        assert!(run.snapshot().unwrap().balance.drift.abs() < 1e-8);
    }
}

/// Two point masses of 1 kg fall towards each other from a distance of 2 m. They collide after π/(2√2) √(d³ / (G (m₁ + m₂))) = π/√2 s,
/// where no step is short enough.
#[test]
fn where_no_step_is_short_enough_the_run_says_so() {
    for name in ADAPTIVE {
        let mut world = World::new();
        world.add(sphere(1.0).with_location(DVec3::NEG_X));
        world.add(sphere(1.0).with_location(DVec3::X));
        attract(&mut world);
        let mut run = run(name, 1e-9, 10.0, world);
        let error = run.advance(10.0, &[], &mut |_| {}).unwrap_err();
        let Breakdown::Stalled { time, .. } = error else { panic!("{name}: {error}") };
        let meeting = std::f64::consts::PI * std::f64::consts::FRAC_1_SQRT_2;
        assert!((time - meeting).abs() < 1e-3, "{name}: {time} {meeting}");
    }
}

/// A ball without torque rotates uniformly. Its orientation must be exact after a thousand rotations, and its rotation must not limit the
/// steps.
#[test]
fn what_turns_evenly_takes_no_steps() {
    for name in ADAPTIVE {
        let mut world = World::new();
        world
            .add(sphere(1.0).with_velocity(DVec3::X).with_angular_velocity(DVec3::Z * std::f64::consts::TAU));
        let mut run = run(name, 1e-9, 1000.0, world);
        run.advance(1000.25, &[], &mut |_| {}).unwrap();
        let body = run.snapshot().unwrap().bodies[0];
        assert!((body.orientation * DVec3::X).abs_diff_eq(DVec3::Y, 1e-11), "{name}: {}", body.orientation);
        assert!(run.steps() < 40, "{name}: {}", run.steps());
    }
}

/// Two bodies far from the origin must need as many steps as the same bodies near the origin, because the steps of Gauss–Radau do not
/// depend on the origin.
#[test]
fn the_origin_does_not_matter() {
    let mut counts = Vec::new();
    for shift in [DVec3::ZERO, DVec3::splat(1024.0)] {
        let mut world = World::new();
        world.add(sphere(1.0).with_location(shift));
        let planet = sphere(1e-3).with_location(shift + DVec3::X);
        world.add(planet.with_velocity(DVec3::Y));
        attract(&mut world);
        let mut run = run("gauss-radau", 1e-9, 20.0, world);
        run.advance(20.0, &[], &mut |_| {}).unwrap();
        counts.push(run.steps());
    }
    assert!(counts[0].abs_diff(counts[1]) <= 2, "{counts:?}");
}
