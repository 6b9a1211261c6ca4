//! Compares forces given by formulas with the same forces written in Rust, and the Lennard-Jones force of 32,000 atoms with that of 4,000
//! atoms.
//!
//! Both sides of a comparison are measured alternately, because the speed of a machine drifts. The ratio of the medians counts. A formula
//! should take less than 3 times as long as the Rust code, and eight times as many atoms less than 8.8 times as long.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use jabuka::Scene;
use jabuka::physics::{Accounts, BodyId, Force, LennardJones, Loads, Moment, RigidBody, Shape, World};
use jabuka::simulate::world;

const BODIES: usize = 10_000;
const ROUNDS: usize = 41;

/// A straightforward implementation of a force in Rust, for comparison. It adds its power to the loads.
struct Plain<F>(F);

impl<F: Fn(DVec3, DVec3, f64) -> DVec3 + Send + Sync> Force for Plain<F> {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let state = moment.state;
        let mut power = 0.0;
        for (i, force) in loads.force.iter_mut().enumerate() {
            let (x, v) = (state.location[i], state.velocity[i]);
            let here = (self.0)(x, v, moment.time);
            *force += here;
            power += here.dot(v);
        }
        loads.power.work += power;
    }

    fn potential(&self, _: &Moment) -> f64 {
        0.0
    }
}

fn main() {
    println!("{BODIES} bodies, nanoseconds each, median of {ROUNDS} rounds");
    println!("    Rust  formula  ratio");
    let (k, c) = (4.0, 0.5);
    compare(
        "['-k*x*abs(x)', '-c*vy', 0]",
        &Plain(move |x: DVec3, v: DVec3, _| DVec3::new(-k * x.x * x.x.abs(), -c * v.y, 0.0)),
    );
    compare("['-k*x', '-k*y', '-k*z']", &Plain(move |x: DVec3, _, _| -k * x));
    compare(
        "['-k*x/(r^2 + c)', '-k*y/(r^2 + c)', '-k*z/(r^2 + c)']",
        &Plain(move |x: DVec3, _, _| -k * x / (x.length_squared() + c)),
    );
    compare(
        "['k*vy - c*vx*speed', '-k*vx - c*vy*speed', '-c*vz*speed']",
        &Plain(move |_, v: DVec3, _| DVec3::new(k * v.y, -k * v.x, 0.0) - c * v.length() * v),
    );
    compare(
        "['k*sin(x - 2*t)*exp(-y^2)', 0, 'if(z < 0, -c*z, 0)']",
        &Plain(move |x: DVec3, _, t: f64| {
            let z = if x.z < 0.0 { -c * x.z } else { 0.0 };
            DVec3::new(k * libm::sin(x.x - 2.0 * t) * libm::exp(-x.y * x.y), 0.0, z)
        }),
    );
    println!("atoms    seconds for an evaluation, at the same density");
    let [few, many] = [16, 32].map(atoms);
    let (mut quick, mut slow) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        quick.push(evaluated(&few.1, &few.0));
        slow.push(evaluated(&many.1, &many.0));
    }
    let (quick, slow) = (median(quick), median(slow));
    println!("{:6} {quick:8.5}\n{:6} {slow:8.5}   {:.2} times as long", 4096, 32768, slow / quick);
}

/// Prints the time to evaluate a force by a formula, and the time of the same force in Rust.
fn compare(formula: &str, plain: &impl Force) {
    let text = format!(
        "variables = {{ k = 4, c = 0.5 }}\nsimulation.duration = 0
        [body.b]\nrepeat = {BODIES}\nshape.sphere.radius = 0.1
        location = ['sin(i)', 'cos(2*i)', 'sin(3*i)']\nvelocity = ['cos(i)', 'sin(2*i)', 'cos(5*i)']
        [force.f.formula]\nforce = {formula}"
    );
    let world = world(&Scene::parse(&text).unwrap_or_else(|report| panic!("{report}")));
    let by_formula = &world.model().forces()[0];
    let (mut plains, mut formulas) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        plains.push(evaluated(black_box(plain), &world));
        formulas.push(evaluated(black_box(&**by_formula), &world));
    }
    let (one, other) = (loads(plain, &world), loads(&**by_formula, &world));
    let off = one.force.iter().zip(&other.force).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
    assert!(off < 1e-12 && (one.power.work - other.power.work).abs() < 1e-8, "{formula}: {off:e}");
    let [plain, formula_time] = [plains, formulas].map(|times| median(times) / BODIES as f64 * 1e9);
    println!("{plain:8.2} {formula_time:8.2} {:6.2}  {formula}", formula_time / plain);
}

fn loads(force: &dyn Force, world: &World) -> Loads {
    let zero = vec![DVec3::ZERO; world.state().len()];
    let mut loads = Loads { force: zero.clone(), torque: zero, power: Accounts::default() };
    force.apply(&Moment { time: 0.3, state: world.state(), model: world.model() }, &mut loads);
    loads
}

/// Returns the time of one evaluation of a force, s.
fn evaluated(force: &dyn Force, world: &World) -> f64 {
    let zero = vec![DVec3::ZERO; world.state().len()];
    let mut loads = Loads { force: zero.clone(), torque: zero, power: Accounts::default() };
    let moment = Moment { time: 0.3, state: world.state(), model: world.model() };
    let start = Instant::now();
    force.apply(black_box(&moment), &mut loads);
    let seconds = start.elapsed().as_secs_f64();
    black_box(&loads);
    seconds
}

/// Returns a cube of atoms and the Lennard-Jones force between them. The atoms are half as dense as in a liquid, and slightly displaced
/// from a lattice.
fn atoms(edge: usize) -> (World, LennardJones) {
    let mut world = World::new();
    let part = |i: usize, k: f64| 0.3 * (i as f64 * k).fract();
    for i in 0..edge * edge * edge {
        let place = DVec3::new((i % edge) as f64, (i / edge % edge) as f64, (i / edge / edge) as f64);
        let off = DVec3::new(part(i, 0.618_033), part(i, 0.414_213), part(i, 0.732_050));
        let atom = RigidBody::new(&Shape::Sphere { radius: 0.5 }, 1.0);
        world.add(atom.with_location(1.36 * place + off));
    }
    let bodies = (0..edge * edge * edge).map(BodyId::new).collect();
    let force = LennardJones { bodies, against: None, epsilon: 1.0, sigma: 1.0, cutoff: 2.5, smooth: false };
    (world, force)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}
