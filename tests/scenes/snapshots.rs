//! Snapshot tests of the first, a middle and the last script of every scene of the gallery. Each new scene is tested automatically.

use jabuka::{Run, Scene};

#[test]
fn scripts_of_the_gallery() {
    insta::glob!("../../scenes", "*.toml", |path| {
        let options = jabuka::scene::Options { overrides: fewer(path), ..Default::default() };
        let scene = Scene::from_path_with(path, &options).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(scene.warnings.diagnostics.len(), 0, "{}", scene.warnings);
        let run = Run::new(&scene).unwrap();
        assert_eq!(run.survey().crossings, []);
        let last = scene.simulation.timeline.frames() - 1;
        for (name, index) in [("first", 0), ("middle", last / 2), ("last", last)] {
            let frame = run.frames().nth(index).unwrap().unwrap();
            insta::assert_snapshot!(name, run.script(&frame).unwrap());
        }
        for (name, text) in run.emitter().sequence(&scene, 0..=last).unwrap() {
            insta::assert_snapshot!(name, text);
        }
    });
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
