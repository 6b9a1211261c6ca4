//! Compares the time that POV-Ray needs to parse a frame of 100,000 spheres, in unions by material as jabuka writes them, with the time
//! for the same spheres as single objects with a texture each. Needs POV-Ray.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use jabuka::{Run, Scene};

const BODIES: usize = 100_000;
const ROUNDS: usize = 5;

fn main() {
    let scene = Scene::parse(&scene()).unwrap();
    let run = Run::new(&scene).unwrap();
    let grouped = run.script(&run.frames().next().unwrap().unwrap()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("grouped.pov"), &grouped).unwrap();
    fs::write(folder.path().join("literal.pov"), literal(&grouped)).unwrap();
    let (mut unions, mut literals) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        unions.push(parse(folder.path(), "grouped"));
        literals.push(parse(folder.path(), "literal"));
    }
    let (unions, literals) = (median(unions), median(literals));
    println!("{BODIES} spheres, seconds to parse, median of {ROUNDS} rounds");
    println!("literals  {literals:.3}");
    println!("unions    {unions:.3}   {:.2} × literals", unions / literals);
}

fn scene() -> String {
    let mut text = String::from("simulation.duration = 0\n[material.red]\ncolor = 'red'\n");
    for i in 0..BODIES {
        let at = |k: f64| (i as f64 * k).fract() * 100.0;
        let _ = write!(
            text,
            "[body.b{i}]\nshape.sphere.radius = 0.1\nmaterial = 'red'\nlocation = [{}, {}, {}]\n",
            at(0.618_033_988),
            at(0.414_213_562),
            at(0.732_050_807),
        );
    }
    text
}

/// Returns the same script with every sphere as a single object.
fn literal(grouped: &str) -> String {
    let (before, union) = grouped.split_once("union {").unwrap();
    let spheres = union.lines().filter(|line| line.trim_start().starts_with("sphere"));
    let alone = |line: &str| line.replace(" } //", " material { Material_red } } //") + "\n";
    before.to_owned() + &spheres.map(alone).collect::<String>()
}

/// Returns the time that POV-Ray reports for parsing, s. Parsing uses one thread.
fn parse(folder: &Path, name: &str) -> f64 {
    let status = Command::new("povray")
        .current_dir(folder)
        .args(["-D", "-GA", "-F", "+W1", "+H1", "+WT1", "-MB", "+GSstatistics.txt", &format!("+I{name}.pov")])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    assert!(status.unwrap().success());
    let statistics = fs::read_to_string(folder.join("statistics.txt")).unwrap();
    let line = statistics.lines().find(|line| line.contains("Parse Time")).unwrap();
    let (_, seconds) = line.split_once('(').unwrap();
    seconds.split_once(" seconds)").unwrap().0.parse().unwrap()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
