//! Tests of failures during rendering: a broken script fails alone, and failures of POV-Ray itself are tried again.

use std::fs;
use std::time::{Duration, Instant};

use crate::scene::{Place, SCENE, assert_tidy};
use crate::support::{stderr, stdout};

#[test]
fn one_broken_script_is_one_missing_image() {
    let place = Place::new(SCENE);
    place.succeed(&["compile", "scene.toml"]);
    let path = place.path("out/scene/frame_0007.pov");
    let script = fs::read_to_string(&path).unwrap();
    let line = 1 + script.lines().position(|line| line.ends_with("// ball")).unwrap();
    fs::write(&path, script.replace("sphere { <", "sphere { NOPE <")).unwrap();

    let output = place.run(&["render", "out/scene"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(place.images().len(), 25);
    assert!(!place.images().contains(&"frame_0007.png".to_owned()));
    assert!(
        stdout(&output).starts_with("out/scene/images: 25 of 26 frames\nfailed    1\n"),
        "{}",
        stdout(&output)
    );
    let said = stderr(&output);
    assert!(said.starts_with("error[bad-frame]: frame 7, body `ball`: "), "{said}");
    assert!(said.contains(&format!("out/scene/frame_0007.pov:{line}:1")) && said.contains("NOPE"), "{said}");
    assert_tidy(&place.path("out/scene/images"));
    let note = fs::read_to_string(place.path("out/scene/images/.jabuka/failed/frame_0007.txt")).unwrap();
    assert!(note.starts_with(&format!("frame 7: out/scene/frame_0007.pov:{line}, body `ball`: ")), "{note}");

    fs::write(&path, script).unwrap();
    let said = stdout(&place.succeed(&["render", "out/scene"]));
    assert!(said.contains("as before 25, up to date\n") && said.contains("rendered  1 in "), "{said}");
    assert!(!place.path("out/scene/images/.jabuka/failed/frame_0007.txt").exists());
}

#[test]
fn where_every_frame_fails_it_stops() {
    let scene = format!("[povray]\nsdl = 'sphere {{ nonsense }}'\n{SCENE}");
    let place = Place::new(&scene);
    let output = place.run(&["render", "scene.toml"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(
        said.contains("error[all-frames-fail]: stopped, since all of the first 8 frames failed"),
        "{said}"
    );
    assert_tidy(&place.path("out/scene/images"));
    let output = place.run(&["render", "scene.toml", "--keep-going", "--frames", "0-11"]);
    assert!(
        stdout(&output).starts_with(
            "out/scene/images: 0 of 12 frames\ndrift     0 % of the largest kinetic energy\nfailed    12\n"
        ),
        "{}",
        stdout(&output)
    );
    assert_eq!(stderr(&output).matches("error[bad-frame]").count(), 3);
    assert!(
        stderr(&output).ends_with("and of the frames 3, 4, 5, 6, 7, 8, 9, 10, 11\n"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_povray_that_is_killed_is_started_again() {
    let place = Place::new(SCENE);
    // The first process that renders frame 13 is killed.
    let povray = place.stand_in(
        "if grep -q frame_0013 run.pov && mkdir \"$(dirname \"$0\")/once\" 2>/dev/null; then kill -9 $$; fi
        exec povray \"$@\"",
    );
    place.succeed(&["render", "scene.toml", "--trust", "--povray", &povray]);
    assert!(place.path("once").exists(), "nothing was killed");
    assert_eq!(place.images().len(), 26);
    assert_tidy(&place.path("out/scene/images"));
}

#[test]
fn a_povray_that_is_killed_each_time_fails_its_frame_alone() {
    let place = Place::new(SCENE);
    let povray = place.stand_in("if grep -q frame_0013 run.pov; then kill -9 $$; fi; exec povray \"$@\"");
    let output = place.run(&["render", "scene.toml", "--trust", "--povray", &povray, "--retry", "1"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(place.images().len(), 25);
    let said = stderr(&output);
    let why = "frame 13: POV-Ray gave no image: it was killed by signal 9 (2 times)";
    assert!(said.contains(why), "{said}");
}

#[test]
fn a_povray_that_hangs_is_ended_and_started_again() {
    let place = Place::new(SCENE);
    let povray = place.stand_in(
        "if grep -q frame_0013 run.pov && mkdir \"$(dirname \"$0\")/once\" 2>/dev/null; then sleep 1000; fi
        exec povray \"$@\"",
    );
    let start = Instant::now();
    place.succeed(&["render", "scene.toml", "--trust", "--povray", &povray, "--time-limit", "5"]);
    assert!(place.path("once").exists(), "nothing hung");
    assert!(start.elapsed() < Duration::from_secs(120), "the hanging POV-Ray was waited for");
    assert_eq!(place.images().len(), 26);
    assert_tidy(&place.path("out/scene/images"));
}

#[test]
fn a_povray_that_does_nothing_at_all_is_found_out_without_a_time_limit() {
    let place = Place::new(SCENE);
    let povray = place.stand_in("sleep 1000");
    let start = Instant::now();
    let output = place.run(&[
        "render",
        "scene.toml",
        "--trust",
        "--povray",
        &povray,
        "--frames",
        "0-1",
        "--retry",
        "0",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(start.elapsed() < Duration::from_secs(100));
    assert!(
        stderr(&output).contains("POV-Ray gave no image: it hung: it did nothing for 20 s"),
        "{}",
        stderr(&output)
    );
}
