//! Snapshot tests of the scripts of every scene of the gallery. Each new scene is tested automatically.
//!
//! A reviewer can read the snapshots: they show the beginning and the end of long scripts. Where bodies touch, small changes of a method grow
//! until all digits differ, so only the first script is shown; the list of `digests` tells which scenes have changed in any byte. `warnings`
//! tells which laws of physics a run breaks.

use jabuka::{Run, Scene, motion_warnings};

/// The numbers of lines that a snapshot shows from the beginning and from the end of a script.
const SHOWN_LINES: (usize, usize) = (90, 10);

#[test]
fn scripts_of_the_gallery() {
    let mut warnings = Vec::new();
    insta::glob!("../../scenes", "*.toml", |path| {
        let options = jabuka::scene::Options { overrides: fewer(path), ..Default::default() };
        let scene = Scene::from_path_with(path, &options).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(scene.warnings.diagnostics.len(), 0, "{}", scene.warnings);
        let run = Run::new(&scene).unwrap();
        assert_eq!(run.survey().crossings, []);

        let last = scene.simulation.timeline.frames() - 1;
        for (name, index) in [("first", 0), ("middle", last / 2), ("last", last)] {
            let frame = run.frames().nth(index).unwrap().unwrap();
            if index == 0 || scene.simulation.contacts.is_none() {
                insta::assert_snapshot!(name, shortened(&run.script(&frame).unwrap()));
            }
        }
        for (name, text) in run.emitter().sequence(&scene, 0..=last).unwrap() {
            insta::assert_snapshot!(name, text);
        }
        let broken = motion_warnings::all(&scene, run.survey());
        let broken: String = broken.iter().map(|warning| format!(" {}", warning.code.name())).collect();
        if !broken.is_empty() {
            warnings.push(format!("{}{broken}", path.file_stem().unwrap().to_string_lossy()));
        }
    });
    warnings.sort();
    insta::assert_snapshot!("warnings", warnings.join("\n"));
}

/// Returns the lines of a script that a snapshot shows.
fn shortened(script: &str) -> String {
    let lines: Vec<&str> = script.lines().collect();
    let (from_start, from_end) = SHOWN_LINES;
    let Some(hidden) = lines.len().checked_sub(from_start + from_end + 1).filter(|hidden| *hidden > 0) else {
        return script.to_owned();
    };
    let note = format!("… {} more lines …", hidden + 1);
    [&lines[..from_start], &[&*note], &lines[lines.len() - from_end..]].concat().join("\n")
}

/// Returns overrides that reduce the number of particles and the duration of some scenes, so that their scripts are short.
fn fewer(path: &std::path::Path) -> Vec<jabuka::scene::Override> {
    let settings: &[&str] = match path.file_stem().and_then(std::ffi::OsStr::to_str) {
        Some("fountain") => &["variables.drops=40"],
        Some("sparks") => &["variables.sparks=60"],
        Some("rain") => &["variables.beads=30"],
        Some("galton") => &["variables.balls=15", "simulation.duration=2"],
        Some("two_galaxies") => &["variables.stars=25"],
        _ => &[],
    };
    settings.iter().map(|setting| jabuka::scene::Override::new(*setting)).collect()
}

/// Checks the known results of the tutorial's scene for several methods.
#[test]
fn the_ball_of_the_tutorial_is_where_each_method_takes_it() {
    let ball = |settings: &[&str], frame: usize| {
        let overrides = settings.iter().map(|set| jabuka::scene::Override::new(*set)).collect();
        let options = jabuka::scene::Options { overrides, ..Default::default() };
        let scene = Scene::from_path_with("scenes/parabola.toml", &options).unwrap();
        let run = Run::new(&scene).unwrap();
        let frame = run.frames().nth(frame).unwrap().unwrap();
        let script = run.script(&frame).unwrap();
        let line = script.lines().find(|line| line.ends_with("// ball")).unwrap();
        line.trim_start().strip_suffix(" } // ball").unwrap().to_owned()
    };
    // By hand: y = v t − ½ t² (exact) − ½ t dt (the error of Euler–Cromer), at t = 2 s with dt = 0.01 s and 0.1 s.
    assert_eq!(ball(&[], 50), "sphere { <24, 17.99, 0>, 2");
    assert_eq!(ball(&["simulation.integrator=rk4"], 50), "sphere { <24, 18, 0>, 2");
    assert_eq!(ball(&["simulation.frame_rate=10", "simulation.step=0.1"], 20), "sphere { <24, 17.9, 0>, 2");
}
