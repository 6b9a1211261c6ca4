//! Compares `jabuka render` with its lower bound, with one POV-Ray process after another, and with POV-Ray's own animation loop.
//!
//! Prints the wall time for 24 frames of some scenes, and its ratio to the lower bound: POV-Ray's CPU time for these frames, divided among
//! all processors. Needs POV-Ray. `cargo bench --bench rendering`
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark prints, and stops at the first surprise"
)]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

const FRAMES: usize = 24;

/// A scene that is as cheap to render as possible: a single ball in plain surroundings.
const FLAT: &str = "
    environment = 'paper'
    [body.ball]
    shape.sphere.radius = 1
    velocity = [1, 0, 0]
    [camera]
    location = [0, 0, 30]
    look_at = [0, 0, 0]
    ";

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::write(folder.path().join("flat.toml"), FLAT).unwrap();
    let cases = [
        ("flat", folder.path().join("flat.toml"), [160, 120]),
        ("parabola", root.join("scenes/parabola.toml"), [320, 240]),
        ("hammer", root.join("scenes/hammer.toml"), [800, 600]),
    ];
    for (name, scene, size) in cases {
        let [width, height] = size;
        let frames = format!("0-{}", FRAMES - 1);
        let size = format!("{width}x{height}");
        let render = |images: &str| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_jabuka"));
            command.arg("render").arg(&scene).args(["--frames", &frames, "--size", &size, "-o", images]);
            measured(command.current_dir(folder.path()))
        };
        let (wall, cpu) = render("first");
        let (again, _) = render("first");
        std::fs::remove_dir_all(folder.path().join("first")).unwrap();
        let scripts = folder.path().join("out").join(name);
        let size = [format!("+W{width}"), format!("+H{height}")];
        let mut own = Command::new("povray");
        own.current_dir(&scripts)
            .arg("animation.ini")
            .args(&size)
            .args(["+SF0", &format!("+EF{}", FRAMES - 1)]);
        let (own, _) = measured(&mut own);
        let mut one_by_one = 0.0;
        for frame in 0..FRAMES {
            let mut one = Command::new("povray");
            one.current_dir(&scripts).args(["-D", "+A0.1", "+R3", "+Oone.png"]).args(&size);
            one_by_one += measured(one.arg(format!("+Iframe_{frame:04}.pov"))).0;
        }
        let cores = std::thread::available_parallelism().map_or(1, usize::from) as f64;
        println!(
            "{name:9} {width} x {height}: {wall:.2} s; POV-Ray's CPU time / processors {:.2} s; (wall - 0.7 s) is {:.2} of it",
            cpu / cores,
            (wall - 0.7) / (cpu / cores)
        );
        println!(
            "          {:.3} CPU s a frame; again {again:.3} s; one POV-Ray after another {:.1} x, its own loop {:.1} x",
            cpu / FRAMES as f64,
            one_by_one / wall,
            own / wall
        );
    }
}

/// Runs a command. Returns its wall time, and the CPU time of the command and of all processes that it starts, s.
fn measured(command: &mut Command) -> (f64, f64) {
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let (start, before) = (Instant::now(), children());
    assert!(command.status().unwrap().success());
    (start.elapsed().as_secs_f64(), children() - before)
}

/// Returns the CPU time of all child processes that have ended so far, s.
fn children() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    // Fields 16 and 17 of proc(5) are the user and system times of child processes, in hundredths of a second.
    fields[13..15].iter().map(|ticks| ticks.parse::<f64>().unwrap() / 100.0).sum()
}
