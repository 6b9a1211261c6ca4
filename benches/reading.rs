//! Compares the time to read and check a scene of 10,000 bodies, and to write its first frame, with the time to parse the same file as
//! plain TOML: once with numbers, and once with six formulas for each body.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use jabuka::{Run, Scene};

const BODIES: usize = 10_000;
const ROUNDS: usize = 9;

fn main() {
    measure(&numbers());
    measure(&formulas());
}

fn measure(text: &str) {
    let (mut parses, mut checks, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        parses.push(timed(|| assert!(toml::de::DeTable::parse(text).is_ok())));
        checks.push(timed(|| assert!(Scene::parse(text).is_ok())));
        frames.push(timed(|| {
            let scene = Scene::parse(text).unwrap();
            let run = Run::new(&scene).unwrap();
            assert!(run.script(&run.frames().next().unwrap().unwrap()).is_ok());
        }));
    }
    let [parse, check, frame] = [parses, checks, frames].map(median);
    let times = |time: Duration| time.as_secs_f64() / parse.as_secs_f64();
    println!("{BODIES} bodies, {:.2} MB, median of {ROUNDS} rounds", text.len() as f64 / 1e6);
    println!("TOML alone            {:7.1} ms", parse.as_secs_f64() * 1e3);
    println!("read and checked      {:7.1} ms   {:.1} × TOML", check.as_secs_f64() * 1e3, times(check));
    println!("to the first script   {:7.1} ms   {:.1} × TOML", frame.as_secs_f64() * 1e3, times(frame));
}

fn numbers() -> String {
    let mut text = String::from("simulation.duration = 0\n");
    for i in 0..BODIES {
        let (x, y) = (i % 100, i / 100);
        let _ = write!(
            text,
            "[body.ball_{i}]\nshape.sphere.radius = 0.4\nmass = 1.5\nlocation = [{x}.25, {y}.5, 0]\nvelocity = [0, 1, 0]\n"
        );
    }
    text
}

fn formulas() -> String {
    let mut text = String::from("simulation.duration = 0\n[variables]\nr = 2.5\nspeed = '2*pi*r'\n");
    for i in 0..BODIES {
        let _ = write!(
            text,
            "[body.ball_{i}]\nshape.sphere.radius = '0.1*r'\nmass = '1.5*{i}/10 + 1'\n\
             location = ['{i} + r*cos(2*pi*{i}/60)', 'if({i} % 2 == 0, r, -r)', 0]\n\
             velocity = ['uniform(-1, 1)*speed', 'normal(0, 1)', 0]\n"
        );
    }
    text
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}
