//! Measures the cost of event-driven contacts: the time of an impact in the scene `pi_by_collisions`, and the time of a frame in the scene
//! `galton` (Galton's board).
//!
//! The time of an impact must not grow with the number of impacts. `cargo bench --bench contacts -- galton` measures the board as well,
//! which takes a minute.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::time::Instant;

use jabuka::scene::{Options, Override};
use jabuka::{Run, Scene};

/// The mass ratios of the two blocks in `pi_by_collisions`, and the numbers of impacts that they lead to.
const IMPACTS: [(&str, u32); 4] = [("1e4", 314), ("1e6", 3_141), ("1e8", 31_415), ("1e10", 314_159)];

/// The times at which parts of the film of Galton's board begin and end, s. The mean time of a frame is measured for each part.
const SECONDS: [u32; 6] = [0, 2, 8, 12, 16, 20];

fn main() {
    println!("pi by collisions");
    for (ratio, impacts) in IMPACTS {
        let seconds = simulate("pi_by_collisions", &format!("variables.ratio={ratio}"));
        let each = 1e6 * seconds / f64::from(impacts);
        println!("{impacts:7} impacts   {seconds:6.2} s   {each:5.1} µs each");
    }
    if std::env::args().any(|word| word == "galton") {
        galton();
    }
}

/// Measures Galton's board. Simulates the film from its beginning up to the end of each part; the differences are the times of the parts.
fn galton() {
    println!("Galton's board");
    let mut before = 0.0;
    for ends in SECONDS.windows(2) {
        let seconds = simulate("galton", &format!("simulation.duration={}", ends[1]));
        let frames = f64::from(25 * (ends[1] - ends[0]));
        println!("{:2} s to {:2} s   {:5.0} ms a frame", ends[0], ends[1], 1e3 * (seconds - before) / frames);
        before = seconds;
    }
}

/// Returns the time to simulate a scene of the gallery with a changed setting, s.
fn simulate(name: &str, setting: &str) -> f64 {
    let options = Options { overrides: vec![Override::new(setting)], ..Options::default() };
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let scene = Scene::from_path_with(&path, &options).unwrap();
    let start = Instant::now();
    Run::new(&scene).unwrap();
    start.elapsed().as_secs_f64()
}
