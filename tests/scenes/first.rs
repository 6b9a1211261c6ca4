//! Tests of scenes as a new user would write them from the README alone: none of them gets a warning.

use jabuka::{Run, Scene};

#[test]
fn first_scenes_get_no_warning() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/first_scenes");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(paths.len() >= 10, "{paths:?}");
    for path in paths {
        let scene = Scene::parse(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let run = Run::new(&scene).unwrap();
        for frame in run.frames() {
            frame.unwrap();
        }
        let said: Vec<String> = run.warnings().into_iter().map(|warning| warning.message).collect();
        assert!(
            scene.warnings.diagnostics.is_empty() && said.is_empty(),
            "{path:?}: {}{said:?}",
            scene.warnings
        );
    }
}

/// Checks that a scene in which nothing stops a falling body says so, and that a throw that ends near its start does not.
#[test]
fn a_body_that_falls_without_end_gets_a_warning() {
    let said = |keys: &str| {
        let ball = "[body.ball]\nshape.sphere.radius = 0.1\n";
        let scene =
            Scene::parse(&format!("simulation.gravity = [0, -9.81, 0]\n{keys}\n{ball}location = [0, 1, 0]"))
                .unwrap();
        let run = Run::new(&scene).unwrap();
        run.frames().for_each(|frame| drop(frame.unwrap()));
        let warnings = run.warnings().into_iter();
        warnings
            .map(|warning| format!("{}; {}", warning.message, warning.help.unwrap_or_default()))
            .collect::<Vec<_>>()
    };
    let warnings = said("simulation.duration = 2");
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    // The lowest point falls by 0.9 m in 0.428 s, and the next frame is at 0.44 s.
    assert!(warning.starts_with("`ball` falls below height 0 at t = 0.44 s"), "{warning}");
    assert!(warning.contains("`simulation.contacts = \"event-driven\"`"), "{warning}");
    assert_eq!(said("simulation.duration = 2\nenvironment.ground = true").len(), 1);
    let none: [String; 0] = [];
    assert_eq!(said("simulation.duration = 0.5"), none, "it falls no further than it was high");
    assert_eq!(said("simulation.duration = 2\nenvironment.ground = false"), none);
    assert_eq!(said("simulation.duration = 2\nenvironment = 'space'"), none);
    assert_eq!(said("simulation.duration = 2\nsimulation.contacts = 'event-driven'"), none);
    assert_eq!(said("simulation.duration = 2\njoint.rod.rod.between = [[0.5, 1, 0], 'ball']"), none);
}
