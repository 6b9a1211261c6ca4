//! Compares the time to write the scripts of 1,000 spheres in 1,000 frames with the time to copy the same bytes into new files.
//!
//! Both are measured alternately, because the speed of a machine drifts. The ratio of the medians counts. It should stay below 4.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use jabuka::output::{self, Folder};
use jabuka::simulate::Selection;
use jabuka::{Run, Scene};

const BODIES: usize = 1_000;
const FRAMES: usize = 1_000;
const ROUNDS: usize = 7;

fn main() {
    let scene = Scene::parse(&scene()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (mut emissions, mut wholes, mut copies) = (Vec::new(), Vec::new(), Vec::new());
    let mut bytes = 0;
    for round in 0..=ROUNDS {
        let (written, copied) = (folder.path().join("written"), folder.path().join("copied"));
        let (emission, whole, size) = emit(&scene, &written);
        let copy = copy(&written, &copied);
        bytes = size;
        fs::remove_dir_all(&written).unwrap();
        fs::remove_dir_all(&copied).unwrap();
        // The first round only warms up the machine and does not count.
        if round > 0 {
            emissions.push(emission);
            wholes.push(whole);
            copies.push(copy);
        }
    }
    let (emission, whole, copy) = (median(emissions), median(wholes), median(copies));
    println!("{BODIES} spheres × {FRAMES} frames, {:.1} MB, median of {ROUNDS} rounds", bytes as f64 / 1e6);
    println!("copy      {:7.3} s", copy.as_secs_f64());
    println!("emission  {:7.3} s   {:.2} × copy", emission.as_secs_f64(), ratio(emission, copy));
    println!("whole run {:7.3} s   {:.2} × copy", whole.as_secs_f64(), ratio(whole, copy));
}

/// Returns a scene of free spheres in one material. Their locations and velocities need all digits of a number.
fn scene() -> String {
    let mut text =
        format!("[simulation]\nduration = {}\nframe_rate = 25\nstep = 0.04\n", (FRAMES - 1) as f64 / 25.0);
    text.push_str("[material.red]\ncolor = 'red'\n");
    for i in 0..BODIES {
        let at = |k: f64| (i as f64 * k).fract() * 10.0 - 5.0;
        let _ = write!(
            text,
            "[body.b{i}]\nshape.sphere.radius = 0.1\nmaterial = 'red'\nlocation = [{}, {}, {}]\nvelocity = [{}, {}, {}]\n",
            at(0.618_033_988),
            at(0.414_213_562),
            at(0.732_050_807),
            at(0.236_067_977),
            at(0.645_751_311),
            at(0.302_775_637),
        );
    }
    text
}

/// Compiles the scene into scripts. Returns the time from the first frame to the last file, the time of the whole run, and the number of
/// bytes written.
fn emit(scene: &Scene, path: &Path) -> (Duration, Duration, u64) {
    let start = Instant::now();
    let run = Run::new(scene).unwrap();
    let folder = Folder::open(path).unwrap();
    let middle = Instant::now();
    let written = output::write(&run, &folder, &Selection::first(FRAMES), &|| ()).unwrap();
    (middle.elapsed(), start.elapsed(), written.bytes)
}

/// Copies all files of a folder into a new folder. Returns the time that this takes.
fn copy(from: &Path, to: &Path) -> Duration {
    let start = Instant::now();
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        fs::write(to.join(entry.file_name()), fs::read(entry.path()).unwrap()).unwrap();
    }
    start.elapsed()
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

fn ratio(a: Duration, b: Duration) -> f64 {
    a.as_secs_f64() / b.as_secs_f64()
}
