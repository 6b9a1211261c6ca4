//! Tests of time-stepping against closed forms and against Euler–Cromer.

mod contacts;
mod invariants;
mod joints;
mod machines;
mod rebounds;
mod rolling;
mod sliding;

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::super::*;

const GRAVITY: f64 = 9.81;
const STEP: f64 = 1.0 / 240.0;

/// A test scene: bodies with their shapes and surfaces.
#[derive(Default)]
struct Scene {
    bodies: Vec<RigidBody>,
    shapes: Vec<Shape>,
    surfaces: Vec<Option<Surface>>,
}

impl Scene {
    fn add(&mut self, shape: Shape, body: impl FnOnce(RigidBody) -> RigidBody) -> BodyId {
        let start = RigidBody::new(&shape, 1.0);
        self.bodies.push(body(start));
        self.shapes.push(shape);
        self.surfaces.push(Some(Surface::default()));
        BodyId::new(self.bodies.len() - 1)
    }

    /// Adds the ground, a plane through the origin, rotated by `tilt` (rad) about the z axis.
    fn with_ground(mut self, tilt: f64) -> Scene {
        let turn = DQuat::from_rotation_z(tilt);
        self.add(Shape::Plane { normal: DVec3::Y }, |body| body.with_orientation(turn));
        self
    }

    fn world(&self, gravity: f64) -> World {
        let mut world = World::new();
        self.bodies.iter().for_each(|body| {
            world.add(*body);
        });
        world.add_shapes(self.shapes.iter().cloned());
        if gravity != 0.0 {
            world.add_force(UniformGravity { acceleration: -gravity * DVec3::Y });
        }
        world
    }

    fn contacts(&self) -> Contacts {
        Contacts { surfaces: self.surfaces.clone(), ..Contacts::default() }
    }

    fn stepping(&self) -> TimeStepping {
        TimeStepping::new(self.world(GRAVITY), &self.contacts(), &[])
    }
}

fn cube(edge: f64) -> Shape {
    Shape::Box { size: DVec3::splat(edge) }
}

/// Adds a door that rotates about the y axis through the origin at 3 rad/s. Returns its hinge.
fn door(scene: &mut Scene) -> Hinge {
    let (spin, at) = (3.0 * DVec3::Y, 0.5 * DVec3::X);
    let door = scene.add(Shape::Box { size: DVec3::new(1.0, 2.0, 0.05) }, |body| {
        body.with_location(at).with_angular_velocity(spin).with_velocity(spin.cross(at))
    });
    let ends = [Anchor::Point(DVec3::ZERO), Anchor::Body { id: door, at: -at }];
    Hinge::new(ends, DVec3::Y, DQuat::IDENTITY)
}

#[allow(clippy::unwrap_used, reason = "a run that breaks down fails the test")]
fn run(dynamics: &mut dyn Dynamics, t: f64) -> Snapshot {
    dynamics.advance(t, &[], &mut |_| {}).unwrap();
    dynamics.snapshot().unwrap()
}

/// Free fall, free rotation, torques and springs, without contacts: the results must equal those of Euler–Cromer.
#[test]
fn without_contacts_it_is_euler_cromer() {
    let mut scene = Scene::default();
    let brick = Shape::Box { size: DVec3::new(0.2, 0.5, 1.0) };
    let spinning = scene.add(brick, |body| {
        body.with_location(DVec3::new(3.0, 20.0, 0.0))
            .with_velocity(DVec3::new(1.0, 5.0, -2.0))
            .with_angular_velocity(DVec3::new(3.0, 0.2, -7.0))
            .with_torque(DVec3::new(0.1, 0.0, 0.3))
    });
    let hung = scene.add(Shape::Sphere { radius: 0.1 }, |body| body.with_location(DVec3::Y));
    let spring = Spring {
        between: [Anchor::Point(DVec3::new(0.0, 3.0, 0.0)), Anchor::centre(hung)],
        stiffness: 100.0,
        damping: 0.3,
        rest_length: 1.0,
    };
    let world = |scene: &Scene| {
        let mut world = scene.world(GRAVITY);
        world.add_force(spring);
        world
    };
    let mut here = TimeStepping::new(world(&scene), &scene.contacts(), &[]);
    let mut there = world(&scene);
    for k in 1..=20 {
        let t = 0.1 * f64::from(k);
        let (one, two) = (run(&mut here, t), run(&mut there, t));
        for (one, two) in one.bodies.iter().zip(&two.bodies) {
            assert!(one.location.abs_diff_eq(two.location, 1e-12), "{} {}", one.location, two.location);
            assert!(one.velocity.abs_diff_eq(two.velocity, 1e-12), "{} {}", one.velocity, two.velocity);
            assert!(one.orientation.abs_diff_eq(two.orientation, 1e-12), "{t}");
            assert!(one.angular_velocity.abs_diff_eq(two.angular_velocity, 1e-11), "{t}");
        }
        assert!((one.balance.total - two.balance.total).abs() < 1e-10);
        // The two methods count the work of a damper differently: time-stepping with the mean velocity of a step, Euler–Cromer with the
        // velocity at its start.
        assert!((one.balance.drift - two.balance.drift).abs() < 1e-3);
    }
    assert_eq!(here.steps(), there.steps());
    assert!(here.snapshot().is_ok_and(|snapshot| snapshot.bodies[spinning.index()].velocity.y < -10.0));
}

/// A spring oscillator at ω = 10/s: its energy oscillates by ω dt/2 = 2 % within a period, but must not drift from period to period.
#[test]
fn a_spring_keeps_its_energy_over_a_thousand_periods() {
    let mut scene = Scene::default();
    let bob = scene.add(Shape::Sphere { radius: 0.1 }, |body| body.with_location(DVec3::X));
    let mut world = scene.world(0.0);
    let between = [Anchor::Point(DVec3::ZERO), Anchor::centre(bob)];
    world.add_force(Spring { between, stiffness: 100.0, damping: 0.0, rest_length: 0.0 });
    let mut stepping = TimeStepping::new(world, &scene.contacts(), &[]);
    let period = std::f64::consts::TAU / 10.0;
    // Ten equal intervals per period make all steps equally long.
    let energies: Vec<f64> =
        (1..=10_000).map(|k| run(&mut stepping, 0.1 * f64::from(k) * period).balance.total).collect();
    let mean = |part: &[f64]| part.iter().sum::<f64>() / 100.0;
    let (first, last) = (mean(&energies[..100]), mean(&energies[9900..]));
    println!("mean energy of the first ten periods {first} J, of the last ten {last} J");
    assert!((last / first - 1.0).abs() < 1e-4, "{first} {last}");
}

#[test]
fn masses_and_inertias_are_exact() {
    let mut scene = Scene::default();
    for (mass, x) in [(1.0, 0.0), (0.3, 2.0), (1e-3, 4.0), (7.7e5, 6.0)] {
        scene.add(Shape::Cone { radius: 0.3, top_radius: 0.0, height: 0.7 }, |body| RigidBody {
            mass,
            inertia: mass * DVec3::new(0.011, 0.023, 0.017),
            location: x * DVec3::X,
            ..body
        });
    }
    let mut stepping = scene.stepping();
    run(&mut stepping, STEP);
    let is_same = |one: f64, two: f64| (one - two).abs() <= f64::EPSILON * two.abs();
    for (handle, body) in stepping.handles.iter().zip(&scene.bodies) {
        let properties = stepping.engine.bodies[*handle].mass_properties().local_mprops;
        assert!(is_same(properties.inv_mass, 1.0 / body.mass), "{}", properties.inv_mass);
        // The physics engine orders the principal axes in its own way, so sorted moments are compared.
        let sorted = |moments: DVec3| {
            let mut moments = moments.to_array();
            moments.sort_by(f64::total_cmp);
            moments
        };
        let (found, expected) = (sorted(properties.inv_principal_inertia), sorted(body.inertia.recip()));
        assert!(found.iter().zip(expected).all(|(one, two)| is_same(*one, two)), "{found:?} {expected:?}");
    }
}

#[test]
fn a_run_has_the_same_bits_on_any_number_of_threads() {
    let run_on = |threads: usize| {
        let mut scene = Scene::default().with_ground(0.0);
        for k in 0..40 {
            let at = DVec3::new(0.3 * f64::from(k % 3), 0.5 + 0.9 * f64::from(k), 0.2 * f64::from(k % 4));
            let shape = if k % 2 == 0 { cube(0.8) } else { Shape::Sphere { radius: 0.4 } };
            scene.add(shape, |body| body.with_location(at));
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.map(|pool| pool.install(|| run(&mut scene.stepping(), 3.0)))
    };
    let [one, two, eight] = [1, 2, 8].map(|threads| run_on(threads).ok());
    assert!(one.is_some());
    assert_eq!(one, two);
    assert_eq!(one, eight);
}

/// A ball appears above the ground during the run, falls, lands and disappears.
#[test]
fn bodies_come_and_go() {
    let mut scene = Scene::default().with_ground(0.0);
    let ball = scene.add(Shape::Sphere { radius: 0.1 }, |body| body.with_location(DVec3::Y));
    let mut world = scene.world(GRAVITY);
    world.limit(ball, &Presence::during(&[[0.5, 1.5]]));
    let mut stepping = TimeStepping::new(world, &scene.contacts(), &[]);
    assert_eq!(run(&mut stepping, 0.4).bodies.len(), 1);
    let there = run(&mut stepping, 0.6);
    let fallen = 1.0 - there.bodies[1].location.y;
    assert!((fallen - 0.5 * GRAVITY * 0.01).abs() < GRAVITY * 0.1 * STEP, "{fallen}");
    let landed = run(&mut stepping, 1.5);
    assert!((landed.bodies[1].location.y - 0.1).abs() < 2e-3, "{}", landed.bodies[1].location);
    let gone = run(&mut stepping, 2.0);
    assert_eq!(gone.bodies.len(), 1);
    assert!(gone.balance.drift.abs() < 0.05, "{}", gone.balance.drift);
    let impacts = stepping.impacts();
    assert_eq!(impacts.len(), 1);
    assert_eq!(impacts[0].bodies, [0, 1]);
    assert!(impacts[0].normal.abs_diff_eq(DVec3::Y, 1e-12));
}

/// A given motion along x at 1 m/s.
struct Conveyor;

impl Motion for Conveyor {
    fn at(&self, t: f64) -> Kinematics {
        Kinematics {
            location: DVec3::new(t, -0.5, 0.0),
            velocity: DVec3::X,
            acceleration: DVec3::ZERO,
            orientation: DQuat::IDENTITY,
            angular_velocity: DVec3::ZERO,
        }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }
}

/// A conveyor belt accelerates a block. Friction must lose as much energy as the block gains, and the belt must do twice that work.
#[test]
fn a_guided_body_takes_others_along_and_does_work() {
    let mut scene = Scene::default();
    let belt = scene.add(Shape::Box { size: DVec3::new(20.0, 1.0, 2.0) }, |body| body);
    let block = scene.add(cube(0.4), |body| body.with_location(0.2 * DVec3::Y));
    let mut world = scene.world(GRAVITY);
    world.follow(belt, Arc::new(Conveyor));
    let mut stepping = TimeStepping::new(world, &scene.contacts(), &[]);
    let end = run(&mut stepping, 1.0);
    let velocity = end.bodies[block.index()].velocity;
    assert!(velocity.abs_diff_eq(DVec3::X, 1e-3), "{velocity}");
    let accounts = end.balance.accounts;
    println!("{accounts:?} drift {}", end.balance.drift);
    assert!((accounts.work - 1.0).abs() < 0.02, "{accounts:?}");
    assert!((accounts.friction + 0.5).abs() < 0.02, "{accounts:?}");
}

/// Checkpoints are taken at several moments of a run with a pile, a pendulum, and bodies that appear and disappear. Runs that continue
/// from a checkpoint must give the same bits as an uninterrupted run.
#[test]
#[cfg(feature = "checkpoints")]
fn a_run_goes_on_from_a_checkpoint_with_the_same_bits() {
    let mut scene = Scene::default().with_ground(0.0);
    for k in 0..30 {
        // The bodies that appear during the run, 5 and 10, must not appear inside others.
        let aside = if [4, 9].contains(&k) { -3.0 } else { 0.0 };
        let at = DVec3::new(0.3 * f64::from(k % 3) + aside, 0.5 + 0.9 * f64::from(k), 0.2 * f64::from(k % 4));
        let shape = if k % 2 == 0 { cube(0.8) } else { Shape::Sphere { radius: 0.4 } };
        scene.add(shape, |body| body.with_location(at));
    }
    let bob = scene.add(Shape::Sphere { radius: 0.3 }, |body| body.with_location(DVec3::new(3.0, 1.0, 0.0)));
    let between =
        [Anchor::Point(DVec3::new(2.0, 1.0, 0.0)), Anchor::Body { id: bob, at: DVec3::new(-1.0, 0.0, 0.0) }];
    let links = [Link { kind: LinkKind::Ball(Ball { between }), collides: true }];
    let build = || {
        let mut world = scene.world(GRAVITY);
        // Body 3 disappears, body 10 appears, and body 5 is absent for a while.
        for (body, intervals) in
            [(3, &[[0.0, 0.7]][..]), (10, &[[0.4, f64::INFINITY]]), (5, &[[0.0, 0.6], [1.3, 9.0]])]
        {
            world.limit(BodyId::new(body), &Presence::during(intervals));
        }
        TimeStepping::new(world, &scene.contacts(), &links)
    };
    let stops = [0.1, 0.5, 0.9];
    let mut whole = build();
    for (k, stop) in stops.into_iter().enumerate() {
        run(&mut whole, stop);
        whole.impacts();
        let saved = whole.checkpoint().unwrap();
        let mut again = build();
        assert!(!again.resume(&saved[..saved.len() / 2]), "half of a checkpoint is none");
        assert!(again.resume(&saved));
        let end = run(&mut again, 2.0);
        let mut undisturbed = build();
        stops[..=k].iter().for_each(|&stop| drop((run(&mut undisturbed, stop), undisturbed.impacts())));
        assert_eq!(run(&mut undisturbed, 2.0), end, "stopped at {stop} s");
        assert_eq!(undisturbed.impacts(), again.impacts());
    }
}
