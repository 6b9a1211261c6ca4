//! Tests of what nothing inside a system can change: its momentum, its angular momentum, and that its energy does not grow. The systems are
//! random: up to five bodies that springs pull together, some of them on joints, with and without friction and restitution.

use glam::{DQuat, DVec3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::super::super::*;
use super::{Scene, run};

/// The step of the runs, s: a quarter of the default step.
const SHORT_STEP: f64 = 1.0 / 960.0;

/// Random numbers for systems.
struct Random(ChaCha8Rng);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    fn vector(&mut self, largest: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.between(-largest, largest)))
    }

    fn below(&mut self, count: u32) -> u32 {
        self.0.next_u32() % count
    }
}

fn shape(random: &mut Random) -> Shape {
    match random.below(5) {
        0 => Shape::Sphere { radius: 0.1 },
        1 => Shape::Box { size: DVec3::new(0.3, 0.2, 0.15) },
        2 => Shape::Cylinder { radius: 0.12, height: 0.2 },
        3 => Shape::Capsule { radius: 0.08, height: 0.3 },
        _ => Shape::Cone { radius: 0.15, top_radius: 0.0, height: 0.25 },
    }
}

/// Returns a random joint between two bodies, in the middle between them.
fn joint(random: &mut Random, bodies: [&RigidBody; 2], ids: [BodyId; 2]) -> LinkKind {
    let [one, two] = bodies;
    let middle = 0.5 * (one.location + two.location);
    let at = |body: &RigidBody| body.orientation.conjugate() * (middle - body.location);
    let ends = [Anchor::Body { id: ids[0], at: at(one) }, Anchor::Body { id: ids[1], at: at(two) }];
    let turned = two.orientation.conjugate() * one.orientation;
    match random.below(4) {
        0 => LinkKind::Ball(Ball { between: ends }),
        1 => LinkKind::Hinge(Hinge::new(ends, random.vector(1.0).normalize(), turned)),
        2 => LinkKind::Fixed(Fixed { between: ends, turned }),
        _ => LinkKind::Rod(Rod {
            between: ids.map(Anchor::centre),
            length: one.location.distance(two.location),
        }),
    }
}

/// Makes a random system in which no force acts from outside.
fn system(random: &mut Random) -> (Scene, World, Vec<Link>) {
    let mut scene = Scene::default();
    let count = 2 + random.below(4);
    let spin = random.vector(2.0);
    let ids: Vec<BodyId> = (0..count)
        .map(|k| {
            let at = 0.45 * (f64::from(k) - 0.5 * f64::from(count)) * DVec3::X + random.vector(0.03);
            let turn = DQuat::from_scaled_axis(random.vector(3.0));
            let (kick, own_spin) = (random.vector(0.1), random.vector(1.0));
            scene.add(shape(random), |body| {
                body.with_location(at)
                    .with_orientation(turn)
                    .with_velocity(spin.cross(at) + kick)
                    .with_angular_velocity(spin + own_spin)
            })
        })
        .collect();
    let surface = Surface {
        friction: Some(random.between(-0.4, 0.8).max(0.0)),
        restitution: Some(random.between(-0.9, 0.9).max(0.0)),
        ..Surface::default()
    };
    scene.surfaces.iter_mut().for_each(|own| *own = Some(surface));
    let mut world = scene.world(0.0);
    let stiffness = random.between(1.0, 10.0);
    for (k, one) in ids.iter().enumerate() {
        for two in &ids[..k] {
            let between = [*one, *two].map(Anchor::centre);
            world.add_force(Spring { between, stiffness, damping: 0.0, rest_length: 0.0 });
        }
    }
    let pairs = if random.below(3) == 0 { 0 } else { ids.len() / 2 };
    let links = ids.chunks_exact(2).take(pairs).map(|pair| {
        let bodies = [&scene.bodies[pair[0].index()], &scene.bodies[pair[1].index()]];
        Link { kind: joint(random, bodies, [pair[0], pair[1]]), collides: false }
    });
    let links = links.collect();
    (scene, world, links)
}

/// Runs fifty systems for 4 s. Momentum is kept to rounding. The other errors are of first order in the step, because the engine separates
/// bodies that overlap without changing their velocities.
#[test]
fn a_system_keeps_its_momenta_and_gains_no_energy() {
    for seed in 0..50 {
        let mut random = Random(ChaCha8Rng::seed_from_u64(seed));
        let (scene, world, links) = system(&mut random);
        let mut stepping = TimeStepping::new(world, &scene.contacts(), &links);
        stepping.set_step(SHORT_STEP);
        let start = run(&mut stepping, 0.0).balance;
        let sum =
            |of: fn(&RigidBody) -> DVec3| scene.bodies.iter().map(|body| of(body).length()).sum::<f64>();
        let momenta = sum(|body| body.mass * body.velocity);
        let angular_momenta = sum(|body| body.mass * body.location.cross(body.velocity));
        let mut energy = start.total;
        for k in 1..=40 {
            let now = run(&mut stepping, 0.1 * f64::from(k)).balance;
            let changed = (now.linear_momentum - start.linear_momentum).length() / momenta;
            let turned = (now.angular_momentum - start.angular_momentum).length() / angular_momenta;
            let gained = (now.total - energy) / start.total;
            assert!(changed < 1e-10 && turned < 0.05 && gained < 0.005, "{seed} {changed} {turned} {gained}");
            energy = now.total;
        }
    }
}
