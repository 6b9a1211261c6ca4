//! Measures how the time grows with the number of things of one kind in a scene, from the text of the scene to the script of the second
//! frame.
//!
//! Prints a table with the times for 100, 1,000 and 10,000 things. If the time grows as n^p, linear growth has p = 1. The table shows p
//! from 100 to 10,000, and p from 1,000 to 10,000. The first exponent may be at most 1.1, and 2.1 for forces between all pairs. Constant
//! costs, which matter most for 100 things, make it smaller. The second exponent is nearly free of constant costs, but it includes waiting
//! for memory: the data of 1,000 things fit into the fast caches of a processor, those of 10,000 do not. Waiting adds up to 0.2 (the
//! groups, with an exponent of 1.2, take 9.7 times as many instructions for 10 times as many things). So the second exponent may be larger
//! by 0.15. Where only one thread works, processor time is measured.
//!
//! `cargo bench --bench growth -- labels frames` measures the kinds with these words in their names.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Instant;

use jabuka::output::{self, Folder};
use jabuka::scene::Options;
use jabuka::simulate::Selection;
use jabuka::{Run, Scene};
use tempfile::TempDir;

const NUMBERS: [usize; 3] = [100, 1_000, 10_000];
const LINEAR: f64 = 1.1;
const PAIRS: f64 = 2.1;
/// The amount by which the exponent from 1,000 to 10,000 may exceed the allowed one, because of waiting for memory.
const MEMORY: f64 = 0.15;

/// A kind of thing in a scene: its name, a function that returns a scene with n such things, and the largest allowed exponent.
type Kind = (&'static str, fn(usize) -> String, f64);

const KINDS: [Kind; 26] = [
    ("bodies", |n| bodies(n, |_| String::new()), LINEAR),
    ("bodies by repeat", |n| copies(n, "location = ['i % 100', 'i / 100', 0]"), LINEAR),
    ("bodies by scatter", scatter, LINEAR),
    (
        "formula motions",
        |n| copies(n, "motion.formula.location = ['i % 100 + sin(t)', 'i / 100', 'cos(t)']"),
        LINEAR,
    ),
    ("guided bodies that come and go", |n| copies(n, COMING_AND_GOING), LINEAR),
    (
        "free bodies that come at once",
        |n| copies(n, "location = ['i % 100', 'i / 100', 0]\nstart = 0.02"),
        LINEAR,
    ),
    ("torques", |n| bodies(n, |_| "torque = [0, 1, 0]".to_owned()), LINEAR),
    ("keyframes", keyframes, LINEAR),
    ("groups, each with a force", groups, LINEAR),
    ("members of one group", group, LINEAR),
    ("springs", springs, LINEAR),
    ("links of a chain", chain, LINEAR),
    ("labels at bodies", labels, LINEAR),
    (
        "labels in a corner",
        |n| named(n, |i| format!("[label.l{i}]\ntext = '{i}: ${{t}} s'\ncorner = 'top-left'\n")),
        LINEAR,
    ),
    ("arrows", |n| bodies(n, |_| "velocity = [1, 0, 0]\narrows.velocity = true".to_owned()), LINEAR),
    ("trails", |n| bodies(n, |_| "velocity = [1, 0, 0]\ntrail = true".to_owned()), LINEAR),
    ("ghosts of bodies", |n| bodies(n, |_| "velocity = [9, 0, 0]\nghosts.every = 0.04".to_owned()), LINEAR),
    ("ghosts with arrows", ghosts_with_arrows, LINEAR),
    ("materials", materials, LINEAR),
    ("lights", |n| named(n, |i| format!("[light.l{i}]\npoint.location = [{i}, 50, 9]\n")), LINEAR),
    (
        "views",
        |n| named(n, |i| format!("[view.v{i}]\nlocation = [0, 5, {}]\nlook_at = [0, 0, 0]\n", 10 + i)),
        LINEAR,
    ),
    (
        "planes",
        |n| named(n, |i| format!("[body.p{i}]\nshape.plane = {{}}\nlocation = [0, -{i}, 0]\n")),
        LINEAR,
    ),
    ("parts of a compound", compound, LINEAR),
    ("variables", variables, LINEAR),
    ("bodies with defaults", |n| bodies(n, |_| String::new()) + "[defaults.body]\nmass = 2\n", LINEAR),
    ("gravitation of all pairs", gravitation, PAIRS),
];

/// The keys of guided bodies that each appear and disappear at different times.
const COMING_AND_GOING: &str = "motion.formula.location = ['i % 100 + sin(t)', 'i / 100', 'cos(t)']\n\
    start = '0.04*(0.618*i % 1)'\nend = '0.02 + 0.04*(0.618*i % 1)'";

fn main() {
    println!("{:<28}{:>10}{:>10}{:>10}   exponent, from 1,000", "seconds", "100", "1,000", "10,000");
    let mut fastest: f64 = 0.0;
    for (name, scene, most) in KINDS {
        if !is_asked_for(name) {
            continue;
        }
        row(name, |n| mean(&scene(n), to_script), most, &mut fastest);
    }
    let folder = in_memory();
    let written = |n: usize, layout: &str, trail: &str| {
        let scene = Scene::parse(&film(n, layout, trail)).unwrap();
        move |folder: &Path| write(&scene, folder)
    };
    for (name, layout, trail) in
        [("frames", "self-contained", ""), ("frames with a trail, shared", "shared", "trail = true")]
    {
        if !is_asked_for(name) {
            continue;
        }
        let time = |n| {
            let write = written(n, layout, trail);
            let folders = [(); 3].map(|()| in_memory());
            folders.iter().map(|folder| passed(|| write(folder.path()))).fold(f64::MAX, f64::min)
        };
        row(name, time, LINEAR, &mut fastest);
    }
    if is_asked_for("mistakes") || is_asked_for("included") {
        mistakes_and_includes(folder.path(), &mut fastest);
    }
    if is_asked_for("megabytes") {
        megabytes();
    }
    println!("\nthe fastest growth is {fastest:.2} of what is allowed");
}

/// Returns whether a kind is to be measured: the arguments contain a part of its name, or there are no arguments.
fn is_asked_for(name: &str) -> bool {
    let mut words = std::env::args().skip(1).filter(|word| !word.starts_with("--")).peekable();
    words.peek().is_none() || words.any(|word| name.contains(&word))
}

/// Prints the sizes of the scripts of a scene with four trails.
fn megabytes() {
    println!("\nmegabytes of four trails{:>14}{:>10}{:>10} frames", "100", "1,000", "10,000");
    for layout in ["self-contained", "shared"] {
        let size = |n: usize| {
            let scene = Scene::parse(&four_trails(n, layout)).unwrap();
            let folder = in_memory();
            write(&scene, folder.path());
            let files = fs::read_dir(folder.path()).unwrap();
            files.map(|file| file.unwrap().metadata().unwrap().len()).sum::<u64>() as f64 / 1e6
        };
        let [a, b, c] = NUMBERS.map(size);
        println!("{layout:<28}{a:10.1}{b:10.1}{c:10.1}");
    }
}

/// Prints the row of a kind in the table. `time` returns the time for n things, s; `most` is the allowed exponent.
fn row(name: &str, time: impl Fn(usize) -> f64, most: f64, fastest: &mut f64) {
    let [a, b, c] = NUMBERS.map(&time);
    let (overall, last) = (libm::log10(c / a) / 2.0, libm::log10(c / b));
    let verdict = if overall > most || last > most + MEMORY { ": too much" } else { "" };
    println!("{name:<28}{a:10.4}{b:10.4}{c:10.4}   {overall:.2}, {last:.2}{verdict}");
    *fastest = fastest.max(overall / most).max(last / (most + MEMORY));
}

/// Compiles the text of a scene to the script of the second frame, for every camera.
fn to_script(text: &str) {
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().nth(1).unwrap().unwrap();
    assert!(run.script(&frame).is_ok());
    for view in &scene.views {
        assert!(run.seen_by(view).unwrap().script(&frame).is_ok());
    }
}

/// Measures the checks of a scene with many mistakes, and of two included files with many bodies.
fn mistakes_and_includes(folder: &Path, fastest: &mut f64) {
    let time = |n| {
        let text = bodies(n, |_| "mass = 'x'".to_owned());
        mean(&text, |text| assert!(Scene::parse(text).is_err()))
    };
    row("mistakes", time, LINEAR, fastest);
    let scene = folder.join("scene.toml");
    fs::write(&scene, "include = ['a.toml', 'b.toml']\nsimulation.duration = 0.04\n").unwrap();
    let time = |n| {
        let text = bodies(n, |_| String::new()).replace("simulation.duration = 0.04\n", "");
        fs::write(folder.join("a.toml"), &text).unwrap();
        fs::write(folder.join("b.toml"), text.replace("[body.b", "[body.c")).unwrap();
        mean("", |_| drop(Scene::from_path_with(&scene, &Options::default()).unwrap()))
    };
    row("bodies in included files", time, LINEAR, fastest);
}

/// Creates a temporary folder, in memory if the system supports this. File systems on disks are slow after files have been removed.
fn in_memory() -> TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap()
}

fn write(scene: &Scene, path: &Path) {
    let run = Run::new(scene).unwrap();
    let folder = Folder::open(path).unwrap();
    output::write(&run, &folder, &Selection::first(scene.simulation.timeline.frames()), &|| ()).unwrap();
}

/// Returns the mean time of some work, s. Repeats the work until the total is long compared with the resolution of the processor's clock,
/// which may be milliseconds.
fn mean(text: &str, work: impl Fn(&str)) -> f64 {
    const LEAST: f64 = 0.4;
    let (mut total, mut rounds) = (0.0, 0.0);
    while total < LEAST {
        total += timed(|| work(text));
        rounds += 1.0;
    }
    total / rounds
}

/// Returns the time of some work on this thread, s. On Linux, this is processor time, which does not depend on other work of the machine.
fn timed(work: impl FnOnce()) -> f64 {
    let (start, begin) = (Instant::now(), of_processor());
    work();
    match begin.zip(of_processor()) {
        Some((begin, end)) => end - begin,
        None => start.elapsed().as_secs_f64(),
    }
}

/// Returns the processor time of this thread so far, s; `None` if the system is not Linux.
fn of_processor() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split(' ').next()?.parse::<f64>().ok()? / 1e9)
}

/// Returns the wall time of some work that several threads do, s.
fn passed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn each(n: usize, mut text: String, of: impl Fn(usize) -> String) -> String {
    for i in 0..n {
        text.push_str(&of(i));
    }
    text
}

fn bodies(n: usize, keys: impl Fn(usize) -> String) -> String {
    each(n, "simulation.duration = 0.04\n".to_owned(), |i| {
        let mut body = format!("[body.b{i}]\nshape.sphere.radius = 0.1\n");
        let _ = writeln!(body, "location = [{}, {}, 0]\n{}", i % 100, i / 100, keys(i));
        body
    })
}

fn named(n: usize, of: impl Fn(usize) -> String) -> String {
    bodies(1, |_| String::new()) + &each(n, String::new(), of)
}

fn copies(n: usize, keys: &str) -> String {
    format!("simulation.duration = 0.04\n[body.b]\nrepeat = {n}\nshape.sphere.radius = 0.1\n{keys}\n")
}

fn scatter(n: usize) -> String {
    let size = 2.0 * libm::cbrt(n as f64);
    copies(n, "").replace(
        &format!("repeat = {n}"),
        &format!("repeat.scatter = {{ count = {n}, within.box.size = [{size}, {size}, {size}] }}"),
    )
}

fn keyframes(n: usize) -> String {
    let keys =
        each(n, String::new(), |i| format!("{{ time = {}, location = [{i}, 0, 0] }},\n", i as f64 / 100.0));
    format!(
        "simulation.duration = 0.04\n[body.b]\nshape.sphere.radius = 1\nmotion.keyframes.at = [\n{keys}]\n"
    )
}

fn groups(n: usize) -> String {
    each(n, "simulation.duration = 0.04\n".to_owned(), |i| {
        format!(
            "[body.g{i}]\nrepeat = 2\nshape.sphere.radius = 0.1\nlocation = [{i}, 'i', 0]\n\
             [force.f{i}.drag]\non = ['g{i}']\nlinear = 0.1\n"
        )
    })
}

fn group(n: usize) -> String {
    copies(n, "location = ['i', 0, 0]") + "[force.f.drag]\non = ['b']\nlinear = 0.1\n"
}

fn springs(n: usize) -> String {
    let spring = |i| format!("[force.f{i}.spring]\nbetween = ['b{i}', [0, 0, 5]]\nstiffness = 1\n");
    bodies(n, |_| String::new()) + &each(n, String::new(), spring)
}

fn chain(n: usize) -> String {
    let names = each(n, String::new(), |i| format!("'b{i}', "));
    bodies(n, |_| String::new()) + &format!("[force.f.spring]\nbetween = [{names}]\nstiffness = 1\n")
}

fn labels(n: usize) -> String {
    let label = |i| format!("[label.l{i}]\nbody = 'b{i}'\ntext = '${{b{i}.speed}} m/s'\n");
    bodies(n, |_| String::new()) + &each(n, String::new(), label)
}

fn ghosts_with_arrows(n: usize) -> String {
    let keys = "velocity = [9, 0, 0]\nghosts = { every = 0.04, arrows = true }\narrows.velocity = true";
    bodies(n, |_| keys.to_owned())
}

fn materials(n: usize) -> String {
    let material = |i| format!("[material.m{i}]\ncolor = [0.5, 0.{i}, 0.1]\n");
    bodies(n, |i| format!("material = 'm{i}'")) + &each(n, String::new(), material)
}

fn compound(n: usize) -> String {
    let parts = each(n, String::new(), |i| format!("{{ sphere.radius = 0.1, location = [{i}, 0, 0] }},\n"));
    format!("simulation.duration = 0.04\n[body.b]\nshape.compound.parts = [\n{parts}]\n")
}

fn variables(n: usize) -> String {
    let variable = |i: usize| match i % 50 {
        0 => format!("v{i} = {i}\n"),
        _ => format!("v{i} = 'v{} + 1'\n", i - 1),
    };
    bodies(1, |_| String::new()) + &each(n, "[variables]\n".to_owned(), variable)
}

fn gravitation(n: usize) -> String {
    bodies(n, |_| "mass = 1".to_owned()).replace("0.04\n", "0.04\nsimulation.step = 0.04\n")
        + "[force.f.gravitation]\nsoftening = 0.1\n"
}

/// Returns a scene with a body that moves fast on a circle. Its trail soon has the largest number of points: 512, with 16 pieces between
/// two frames. The trail of a slow body would take longer to reach this number.
fn film(frames: usize, layout: &str, keys: &str) -> String {
    let duration = (frames - 1) as f64 / 25.0;
    format!(
        "[simulation]\nduration = {duration}\nstep = 0.04\n[output]\nlayout = '{layout}'\n[body.b]\n\
         shape.sphere.radius = 0.1\nmotion.formula.location = ['cos(20*t)', 'sin(20*t)', 0]\n{keys}\n"
    )
}

/// Returns a scene with four bodies on circles and their trails. The bodies move by 0.12 rad per frame, slowly enough for a visible
/// motion.
fn four_trails(frames: usize, layout: &str) -> String {
    let body = |i: usize| {
        format!(
            "[body.t{i}]\nshape.sphere.radius = 0.1\ntrail = true\n\
             motion.formula.location = ['{i} + cos(3*t)', 'sin(3*t)', 't/40']\n"
        )
    };
    each(4, film(frames, layout, ""), body)
}
