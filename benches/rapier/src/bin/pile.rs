//! Compares spheres that fall into a box in jabuka with the same spheres in three bare programs of rapier: the processor time of a step,
//! measured in one run.
//!
//! The first bare program uses jabuka's parameters. The second one also finds contacts anew as often as jabuka does. jabuka does so because
//! old contacts brake spheres that roll over each other. The third program uses rapier's own parameters, except for the timestep. All three
//! have thick walls. In jabuka, the walls are five planes.
//!
//! `cargo run --release --manifest-path benches/rapier/Cargo.toml --bin pile [SPHERES [STEPS]]`

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Contacts, Dynamics, RigidBody, Shape, Surface, TimeStepping, UniformGravity, World,
};
use rapier3d_f64::prelude::{
    CoefficientCombineRule, ColliderBuilder, IntegrationParameters, MassProperties, PhysicsWorld,
    RigidBodyBuilder, SpringCoefficients,
};
use rustix::time::{ClockId, clock_gettime};

const STEP: f64 = 1.0 / 240.0;
const RADIUS: f64 = 0.1;
const GRAVITY: f64 = 9.81;
/// Half of the length of an inner edge of the box, m.
const HALF: f64 = 1.2;

fn main() {
    let mut arguments = std::env::args().skip(1).filter_map(|argument| argument.parse::<usize>().ok());
    let spheres = arguments.next().unwrap_or(10_000);
    let steps = arguments.next().unwrap_or(240);
    let places: Vec<DVec3> = (0..spheres).map(place).collect();
    let mut here = ours(&places);
    let fresh = IntegrationParameters { normalized_contact_recycle_distance: 0.5e-4, ..parameters() };
    let own = IntegrationParameters { dt: STEP, ..IntegrationParameters::default() };
    let mut bare = [parameters(), fresh, own].map(|parameters| theirs(&places, parameters));
    let (mut of_here, mut of_bare) = (0.0, [0.0; 3]);
    // The programs take turns, so that changes in the machine's speed affect them equally.
    for _ in 0..steps {
        let begin = now();
        let t = here.time() + STEP;
        here.advance(t, &[], &mut |_| {}).unwrap();
        of_here += now() - begin;
        for (bare, sum) in bare.iter_mut().zip(&mut of_bare) {
            let begin = now();
            bare.step();
            *sum += now() - begin;
        }
    }
    let steps = steps as f64;
    println!("{spheres} spheres, {steps} steps of 1/240 s, milliseconds of the processor for a step");
    println!("  here                               {:8.3}", of_here / steps);
    let names = ["jabuka's parameters", "and fresh contacts ", "its own parameters "];
    for (name, sum) in names.into_iter().zip(of_bare) {
        println!("  bare rapier, {name}   {:8.3}   ratio {:.3}", sum / steps, of_here / sum);
    }
}

/// Returns the initial location of a sphere, m. The spheres are in layers above the box, and each layer is slightly displaced from the one
/// below.
fn place(i: usize) -> DVec3 {
    let across = 10;
    let (layer, rest) = (i / (across * across), i % (across * across));
    let shift = 0.01 * (layer % 3) as f64;
    let at = |k: usize| -HALF + 0.12 + 0.23 * k as f64 + shift;
    DVec3::new(at(rest % across), 0.2 + 0.21 * layer as f64, at(rest / across))
}

/// Returns a point and the unit normal of the ground and of each of the four walls.
fn walls() -> [(DVec3, DVec3); 5] {
    let wall = |normal: DVec3| (-HALF * normal, normal);
    [(DVec3::ZERO, DVec3::Y), wall(DVec3::X), wall(-DVec3::X), wall(DVec3::Z), wall(-DVec3::Z)]
}

fn ours(places: &[DVec3]) -> TimeStepping {
    let mut world = World::new();
    let mut shapes = Vec::new();
    let shape = Shape::Sphere { radius: RADIUS };
    for place in places {
        world.add(RigidBody::new(&shape, 1.0).with_location(*place));
        shapes.push(shape.clone());
    }
    for (point, normal) in walls() {
        let plane = Shape::Plane { normal };
        world.add(RigidBody::new(&plane, 1.0).with_location(point));
        shapes.push(plane);
    }
    world.add_shapes(shapes);
    world.add_force(UniformGravity { acceleration: -GRAVITY * DVec3::Y });
    world.set_step(STEP);
    let surfaces = vec![Some(Surface::default()); places.len() + 5];
    let mut stepping = TimeStepping::new(world, &Contacts { surfaces, ..Contacts::default() }, &[]);
    stepping.show_contacts(false);
    stepping
}

fn theirs(places: &[DVec3], parameters: IntegrationParameters) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = -GRAVITY * DVec3::Y;
    world.integration_parameters = parameters;
    let collider = |collider: ColliderBuilder| {
        let collider = collider.density(0.0).friction(0.5).restitution(0.0);
        collider.friction_combine_rule(CoefficientCombineRule::GeometricMean)
    };
    for place in places {
        let body = RigidBodyBuilder::dynamic().translation(*place).can_sleep(false);
        let inertia = DVec3::splat(0.4 * RADIUS * RADIUS);
        let body = body.additional_mass_properties(MassProperties::new(DVec3::ZERO, 1.0, inertia));
        world.insert(body, collider(ColliderBuilder::ball(RADIUS)));
    }
    for (point, normal) in walls() {
        let turn = DQuat::from_rotation_arc(DVec3::Y, normal);
        let body = RigidBodyBuilder::fixed().pose(rapier3d_f64::prelude::Pose::from_parts(point - normal, turn));
        world.insert(body, collider(ColliderBuilder::cuboid(1000.0, 1.0, 1000.0)));
    }
    world
}

/// Returns the parameters that jabuka sets in rapier; see `src/dynamics/stepping/mod.rs`.
fn parameters() -> IntegrationParameters {
    let length: f64 = 2.0 * RADIUS;
    let softness = SpringCoefficients { natural_frequency: 0.25 / STEP, damping_ratio: 10.0 };
    IntegrationParameters {
        dt: STEP,
        length_unit: length,
        num_solver_iterations: 1,
        num_internal_pgs_iterations: 2,
        num_internal_stabilization_iterations: 4,
        normalized_allowed_linear_error: 0.002,
        normalized_max_linear_velocity: f64::MAX,
        normalized_max_corrective_velocity: 3.0 / length.sqrt(),
        contact_softness: softness,
        static_contact_softness: softness,
        warmstart_joints: true,
        ..IntegrationParameters::default()
    }
}

/// Returns the processor time of this thread so far, ms.
fn now() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 * 1e3 + now.tv_nsec as f64 * 1e-6
}
