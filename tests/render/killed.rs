//! Tests of killed and interrupted renders: no file is left half-written, and the next run continues.

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::scene::{Place, SCENE, assert_tidy, pixels};

/// Starts a render, and returns when this number of images exists.
fn started(place: &Place, images: usize) -> Child {
    let mut command = place.jabuka(&["render", "scene.toml"]);
    let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while !place.path("out/scene/images").exists() || place.images().len() < images {
        assert!(start.elapsed() < Duration::from_secs(100), "no image comes");
        sleep(Duration::from_millis(2));
    }
    child
}

/// Returns the number of POV-Ray processes whose working folder is in the output folder of a test.
fn povrays(place: &Place) -> usize {
    let folder = place.path("").canonicalize().unwrap();
    let processes = std::fs::read_dir("/proc").unwrap().flatten();
    let of_place = |entry: &std::fs::DirEntry| {
        std::fs::read_link(entry.path().join("cwd")).is_ok_and(|cwd| cwd.starts_with(folder.join("out")))
    };
    processes.filter(of_place).count()
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

fn assert_whole(place: &Place, undisturbed: &Place) {
    place.succeed(&["render", "scene.toml"]);
    assert_eq!(place.images(), undisturbed.images());
    for name in place.images() {
        let image = |place: &Place| pixels(&place.path("out/scene/images").join(&name));
        assert!(image(place) == image(undisturbed), "{name} is another picture");
    }
    assert_tidy(&place.path("out/scene/images"));
}

#[test]
fn a_run_that_is_killed_is_made_good_by_the_next() {
    let scene = SCENE.replace("duration = 1.0", "duration = 4.0");
    let undisturbed = Place::new(&scene);
    undisturbed.succeed(&["render", "scene.toml"]);
    let place = Place::new(&scene);
    for images in [1, 20, 60] {
        let mut child = started(&place, images);
        child.kill().unwrap();
        child.wait().unwrap();
        let start = Instant::now();
        while povrays(&place) > 0 {
            assert!(start.elapsed() < Duration::from_secs(5), "POV-Ray outlives jabuka");
            sleep(Duration::from_millis(5));
        }
        // Every image that exists must be complete.
        for name in place.images() {
            pixels(&place.path("out/scene/images").join(name));
        }
    }
    assert!(place.images().len() < 101, "it was killed too late");
    assert_whole(&place, &undisturbed);
}

#[test]
fn ctrl_c_stops_within_a_second() {
    let scene = SCENE.replace("duration = 1.0", "duration = 4.0");
    let place = Place::new(&scene);
    let mut child = started(&place, 5);
    let start = Instant::now();
    signal(&child, "-INT");
    let status = child.wait().unwrap();
    let took = start.elapsed();
    assert_eq!(status.code(), Some(130));
    assert!(took < Duration::from_secs(1), "it took {took:?}");
    assert_eq!(povrays(&place), 0);
    let there = place.images().len();
    assert!((5..101).contains(&there), "{there}");
    assert_tidy(&place.path("out/scene/images"));
    let said = crate::support::stdout(&place.succeed(&["render", "scene.toml"]));
    assert!(said.contains(&format!("as before {there}, up to date\n")), "{said}");
    assert_eq!(place.images().len(), 101);
}
