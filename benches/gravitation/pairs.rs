//! Compares the sum of gravitation over all pairs of stars with a plain double loop in C.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use glam::DVec3;
use jabuka::physics::{Gravitation, RigidBody, Shape, World};

use super::median;

const STARS: usize = 10_000;
const ROUNDS: usize = 7;

pub(super) fn measure() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("gravitation");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/gravitation/pairs.c");
    let compiled = Command::new("cc").arg("-O3").arg(source).arg("-lm").arg("-o").arg(&program).status();
    assert!(compiled.unwrap().success());

    let mut world = World::new();
    let bodies = (0..STARS).map(|i| world.add(star(i))).collect();
    world.add_force(Gravitation {
        bodies,
        against: None,
        constant: 1.0,
        softening: 0.01,
        opening_angle: None,
    });
    let (mut forces, mut potentials, mut plain) = (Vec::new(), Vec::new(), Vec::new());
    for round in 0..=ROUNDS {
        let start = Instant::now();
        let ours = world.forces()[STARS / 2].x;
        let force = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let potential = world.model().potential(0.0, world.state());
        let energy = start.elapsed().as_secs_f64();
        assert!(potential < 0.0);
        let said = Command::new(&program).arg(STARS.to_string()).output().unwrap();
        let said = String::from_utf8(said.stdout).unwrap();
        let (seconds, theirs) = said.trim().split_once(' ').unwrap();
        // The two programs sum up 10,000 terms in different orders, so the results differ by rounding.
        assert!((ours / theirs.parse::<f64>().unwrap() - 1.0).abs() < 1e-9, "{ours} {theirs}");
        // The first round only warms up the machine and does not count.
        if round > 0 {
            forces.push(force);
            potentials.push(energy);
            plain.push(seconds.parse().unwrap());
        }
    }
    let (force, potential, plain) = (median(forces), median(potentials), median(plain));
    println!("{STARS} stars, median of {ROUNDS} rounds");
    println!("plain C    {plain:7.4} s");
    println!("forces     {force:7.4} s   {:.2} × plain C", force / plain);
    println!("potential  {potential:7.4} s   {:.2} × plain C", potential / plain);
}

/// Returns the `i`-th star, at a location that needs all digits of a number.
fn star(i: usize) -> RigidBody {
    let part = |k: f64| (i as f64 * k).fract();
    RigidBody::new(&Shape::Sphere { radius: 0.001 }, 1.0 + part(0.236_067_977)).with_location(DVec3::new(
        part(0.618_033_988),
        part(0.414_213_562),
        part(0.732_050_807),
    ))
}
