//! Compares a swinging chain in jabuka with the same chain in rapier's multibody joints: the processor time of a step, measured in one
//! run.
//!
//! Both simulate balls of 1 kg, 1 m apart, under the same gravity. Each ball is held at its distance from the previous ball.
//!
//! - In jabuka, by a rod, or by a ball joint at the centre of the previous ball.
//! - In rapier, by a hinge, so that the chain swings in a plane and has the fewest coordinates. The chain of 100 also runs with spherical
//!   joints; with these, a chain of 1,000 would take too long.
//!
//! The default damping of rapier's joints is switched off. There are no contacts, and rapier runs on one thread.
//!
//! `cargo run --release --manifest-path benches/rapier/Cargo.toml`

use glam::DVec3;
use jabuka::physics::{Anchor, Ball, Method, Rod, Shape, UniformGravity, World};
use rapier3d_f64::dynamics::IntegrationParameters;
use rapier3d_f64::prelude::{
    GenericJoint, PhysicsWorld, RevoluteJointBuilder, RigidBodyBuilder, SphericalJointBuilder, Vector,
};
use rustix::time::{ClockId, clock_gettime};

const STEP: f64 = 1e-3;
const RADIUS: f64 = 0.1;
const GRAVITY: f64 = 9.81;

/// The number of timed steps, and the time after which no further step begins, s.
const STEPS: u32 = 20;
const PATIENCE: f64 = 10.0;

/// The kind of joint between the links of jabuka's chain.
#[derive(Clone, Copy)]
enum Link {
    Rod,
    Ball,
}

fn main() {
    println!(
        "milliseconds of the processor for a step of {STEP} s, the fastest of {STEPS}, or of those made within {PATIENCE} s; where \
         the first ball is then, m"
    );
    for links in [100, 1000] {
        println!("chain of {links}");
        let best = theirs("hinges", links, RevoluteJointBuilder::new(Vector::Z).into());
        if links == 100 {
            theirs("spherical joints", links, SphericalJointBuilder::new().into());
        }
        for (link, name) in [(Link::Rod, "rods"), (Link::Ball, "ball joints")] {
            for method in ["euler-cromer", "velocity-verlet", "rk4"] {
                let time = ours(&format!("{name}, {method}"), links, link, method);
                println!("    {:.0} times as fast as rapier's hinges", best / time);
            }
        }
    }
}

fn ours(name: &str, links: u32, link: Link, method: &str) -> f64 {
    let mut world = World::new();
    world.set_integrator(Method::by_name(method).unwrap());
    world.add_force(UniformGravity { acceleration: -GRAVITY * DVec3::Y });
    let mut last = None;
    let mut first = None;
    for i in 1..=links {
        let ball = jabuka::physics::RigidBody::new(&Shape::Sphere { radius: RADIUS }, 1.0);
        let ball = world.add(ball.with_location(DVec3::X * f64::from(i)));
        let end = last.map_or(Anchor::Point(DVec3::ZERO), Anchor::centre);
        match link {
            Link::Rod => world.add_constraint(Rod { between: [end, Anchor::centre(ball)], length: 1.0 }),
            Link::Ball => {
                let socket = Anchor::Body { id: ball, at: DVec3::NEG_X };
                world.add_constraint(Ball { between: [end, socket] });
            }
        }
        last = Some(ball);
        first = first.or(last);
    }
    let time = time(|| world.step(STEP));
    let at = world.location(first.unwrap());
    report(&format!("here, {name}"), time, [at.x, at.y]);
    time.0
}

fn theirs(name: &str, links: u32, joint: GenericJoint) -> f64 {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::Y * -GRAVITY;
    world.integration_parameters = IntegrationParameters { dt: STEP, ..IntegrationParameters::default() };
    let mut last = world.insert_body(RigidBodyBuilder::fixed());
    let mut first = None;
    let mut handle = None;
    for i in 1..=links {
        let inertia = Vector::splat(0.4 * RADIUS * RADIUS);
        let ball = RigidBodyBuilder::dynamic()
            .translation(Vector::X * f64::from(i))
            .can_sleep(false)
            .additional_mass_properties(rapier3d_f64::prelude::MassProperties::new(
                Vector::ZERO,
                1.0,
                inertia,
            ));
        let ball = world.insert_body(ball);
        let mut joint = joint;
        joint.set_local_anchor2(-Vector::X);
        handle = world.insert_multibody_joint(last, ball, joint);
        last = ball;
        first = first.or(Some(ball));
    }
    let (multibody, _) = world.multibody_joints.get_mut(handle.unwrap()).unwrap();
    multibody.damping_mut().fill(0.0);
    let time = time(|| world.step());
    let at = world.bodies[first.unwrap()].translation();
    report(&format!("rapier, {name}"), time, [at.x, at.y]);
    time.0
}

fn report(name: &str, (time, steps): (f64, u32), at: [f64; 2]) {
    println!("  {name:32} {time:10.3}   ({:.6}, {:.6}) after {steps} steps", at[0], at[1]);
}

/// Returns the time of the fastest step, ms, and the number of timed steps: [`STEPS`], or as many as begin within [`PATIENCE`]. A step
/// that has begun is always completed.
fn time(mut step: impl FnMut()) -> (f64, u32) {
    let now = || {
        let now = clock_gettime(ClockId::ThreadCPUTime);
        now.tv_sec as f64 * 1e3 + now.tv_nsec as f64 * 1e-6
    };
    let (begin, mut best, mut steps) = (now(), f64::INFINITY, 0);
    while steps < STEPS && now() - begin < 1e3 * PATIENCE {
        let start = now();
        step();
        best = best.min(now() - start);
        steps += 1;
    }
    (best, steps)
}
