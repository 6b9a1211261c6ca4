//! Compares gravitation by the tree with gravitation by REBOUND's tree.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use glam::DVec3;
use jabuka::physics::{Gravitation, Method, RigidBody, Shape, World};

use super::median;

const STARS: usize = 100_000;
const SOFTENING: f64 = 0.01;
const ANGLE: f64 = 0.5;
const STEPS: usize = 5;
/// The errors of the forces are measured on every n-th star, with this n.
const EVERY: usize = 199;

pub(super) fn measure(python: Option<&str>) {
    for (name, place) in [("Plummer's cluster", plummer as fn(usize) -> DVec3), ("a cube", cube)] {
        let places: Vec<DVec3> = (0..STARS).map(place).collect();
        println!("{STARS} stars in {name}, angle {ANGLE}, processor time of a step, median of {STEPS}");
        let exact: Vec<DVec3> = (0..STARS).step_by(EVERY).map(|i| acceleration(&places, i)).collect();
        let error = |found: &dyn Fn(usize) -> DVec3| {
            let off = exact.iter().enumerate().map(|(k, exact)| (found(k * EVERY) - *exact).length_squared());
            let all = exact.iter().map(|exact| exact.length_squared());
            (off.sum::<f64>() / all.sum::<f64>()).sqrt()
        };
        let theirs = python.map(|python| rebound(python, &places));
        if let Some((version, seconds, found)) = &theirs {
            let error = error(&|i| found[i]);
            println!("REBOUND {version:6}     {seconds:7.4} s              rms error {error:.1e}");
        }
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let (processor, clock, found) = pool.install(|| ours(&places));
            let error = error(&|i| found[i]);
            let ratio =
                theirs.as_ref().map(|(_, theirs, _)| format!("   {:.2} × REBOUND", processor / theirs));
            println!(
                "ours, {threads} threads     {processor:7.4} s ({clock:.4} s)   rms error {error:.1e}{}",
                ratio.unwrap_or_default()
            );
        }
    }
}

fn ours(places: &[DVec3]) -> (f64, f64, Vec<DVec3>) {
    let mut world = World::new();
    world.set_integrator(Method::by_name("velocity-verlet").unwrap());
    let star = RigidBody::new(&Shape::Sphere { radius: 0.001 }, 1.0 / STARS as f64);
    let bodies = places.iter().map(|place| world.add(star.with_location(*place))).collect();
    let opening_angle = Some(ANGLE);
    world.add_force(Gravitation {
        bodies,
        against: None,
        constant: 1.0,
        softening: SOFTENING,
        opening_angle,
    });
    world.step(1e-6);
    let (mut processor, mut clock) = (Vec::new(), Vec::new());
    for _ in 0..STEPS {
        let (before, start) = (processor_time(), Instant::now());
        world.step(1e-6);
        clock.push(start.elapsed().as_secs_f64());
        processor.push(processor_time() - before);
    }
    let found = world.forces().iter().map(|force| *force * STARS as f64).collect();
    (median(processor), median(clock), found)
}

/// Returns the processor time of all threads of this process so far, s.
fn processor_time() -> f64 {
    let tasks = std::fs::read_dir("/proc/self/task").unwrap();
    let spent = tasks.map(|task| {
        let said = std::fs::read_to_string(task.unwrap().path().join("schedstat")).unwrap();
        said.split(' ').next().unwrap().parse::<f64>().unwrap()
    });
    1e-9 * spent.sum::<f64>()
}

/// Runs REBOUND. Returns its version, its processor time (s), and the accelerations of all stars.
fn rebound(python: &str, places: &[DVec3]) -> (String, f64, Vec<DVec3>) {
    let folder = tempfile::tempdir().unwrap();
    let (stars, out) = (folder.path().join("stars"), folder.path().join("out"));
    let numbers = |place: &DVec3| [place.x, place.y, place.z, 0.0, 0.0, 0.0, 1.0 / STARS as f64];
    let bytes: Vec<u8> = places.iter().flat_map(numbers).flat_map(f64::to_le_bytes).collect();
    std::fs::write(&stars, bytes).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/rebound_tree.py");
    let said = Command::new(python)
        .arg(script)
        .arg(&stars)
        .args([ANGLE.to_string(), SOFTENING.to_string(), STEPS.to_string()])
        .arg(&out)
        .output()
        .unwrap();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let text = String::from_utf8(said.stdout).unwrap();
    let (version, seconds) = text.trim().split_once(' ').unwrap();
    let numbers: Vec<f64> = std::fs::read(&out)
        .unwrap()
        .chunks_exact(8)
        .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()))
        .collect();
    let found = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
    (version.to_owned(), seconds.parse().unwrap(), found)
}

/// Returns the exact acceleration of one star, as a sum over all other stars.
fn acceleration(places: &[DVec3], i: usize) -> DVec3 {
    let pull = |place: &DVec3| {
        let d = *place - places[i];
        let square = d.length_squared() + SOFTENING * SOFTENING;
        d / (square * square.sqrt() * STARS as f64)
    };
    places.iter().map(pull).sum()
}

/// Returns a number from 0 to 1 that needs all digits.
fn part(i: usize, k: f64) -> f64 {
    (i as f64 * k).fract()
}

fn cube(i: usize) -> DVec3 {
    DVec3::new(part(i, 0.618_033_988_7), part(i, 0.414_213_562_4), part(i, 0.732_050_807_6))
}

/// Returns the location of the `i`-th star in Plummer's model, without the outermost 2 % of the mass. Source: S. J. Aarseth, M. Hénon and
/// R. Wielen, Astron. Astrophys. 37 (1974) 183.
fn plummer(i: usize) -> DVec3 {
    let at = cube(i);
    let radius = 1.0 / (libm::pow(0.98 * at.x + 1e-9, -2.0 / 3.0) - 1.0).sqrt();
    let (z, turn) = (2.0 * at.y - 1.0, std::f64::consts::TAU * at.z);
    let across = (1.0 - z * z).sqrt();
    radius * DVec3::new(across * libm::cos(turn), across * libm::sin(turn), z)
}
