//! Tests that the images equal those that POV-Ray makes of the same scripts without jabuka.

use std::process::{Command, Stdio};

use crate::scene::{Place, SCENE, assert_tidy, pixels};
use crate::support::stdout;

#[test]
fn every_frame_is_the_image_of_its_script() {
    let place = Place::new(SCENE);
    let output = place.succeed(&["render", "scene.toml"]);
    let said = stdout(&output);
    assert!(said.starts_with("out/scene/images: 26 of 26 frames\n"), "{said}");
    assert_eq!(place.images().len(), 26);
    assert_tidy(&place.path("out/scene/images"));
    // Render the sequence with POV-Ray's own animation loop, as `animation.ini` describes it.
    let status = Command::new("povray")
        .args(["animation.ini", "-GA", "-V"])
        .current_dir(place.path("out/scene"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    assert!(status.unwrap().success());
    for name in place.images() {
        let ours = pixels(&place.path("out/scene/images").join(&name));
        assert_eq!((ours.0, ours.1), (64, 36));
        assert!(ours == pixels(&place.path("out/scene").join(&name)), "{name} is another picture");
    }
}

#[test]
fn sdl_that_asks_for_the_clock_gets_the_right_one() {
    let place = Place::new(
        "
        [simulation]
        duration = 0.4
        frame_rate = 10
        [output]
        size = [32, 18]
        [camera]
        location = [0, 0, 12]
        look_at = [0, 0, 0]
        [povray]
        sdl = 'sphere { <0, 2, 0>, 1 + clock pigment { color rgb <clock_delta * 5, frame_number / 4, 0> } }'
        [body.ball]
        shape.sphere.radius = 1
        ",
    );
    place.succeed(&["render", "scene.toml"]);
    let status = Command::new("povray")
        .args(["animation.ini", "-GA", "-V"])
        .current_dir(place.path("out/scene"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    assert!(status.unwrap().success());
    let images: Vec<_> =
        place.images().iter().map(|name| pixels(&place.path("out/scene/images").join(name))).collect();
    assert_eq!(images.len(), 5);
    for (image, name) in images.iter().zip(place.images()) {
        assert!(*image == pixels(&place.path("out/scene").join(&name)), "{name} is another picture");
    }
    assert!(images.windows(2).all(|pair| pair[0] != pair[1]), "the clock goes on");
}

#[test]
fn size_quality_and_options_reach_povray() {
    let place = Place::new(SCENE);
    let image = || pixels(&place.path("out/scene/images/frame_0003.png"));
    place.succeed(&["render", "scene.toml", "--frames", "3", "--size", "80x45"]);
    let good = image();
    assert_eq!((good.0, good.1), (80, 45));
    place.succeed(&["render", "scene.toml", "--frames", "3", "--size", "80x45", "--quality", "draft"]);
    let draft = image();
    assert_ne!(draft, good);
    place.succeed(&["render", "scene.toml", "--frames", "3", "--size", "80x45", "--quality", "final"]);
    assert!(image() != draft && image() != good);
    // The quality `+Q0` leaves out the lights, so the image must differ.
    place.succeed(&["render", "scene.toml", "--frames", "3", "--size", "80x45", "--", "+Q0"]);
    assert_ne!(image(), good);
}

#[test]
fn another_aspect_frames_the_motion_anew() {
    let place = Place::new(
        "
        [output]
        size = [64, 36]
        [body.ball]
        shape.sphere.radius = 1
        ",
    );
    place.succeed(&["render", "scene.toml", "--frames", "0", "--size", "36x64"]);
    let script = std::fs::read_to_string(place.path("out/scene/frame_0000.pov")).unwrap();
    place.succeed(&["compile", "scene.toml", "--frames", "0", "-o", "wide"]);
    assert_ne!(script, std::fs::read_to_string(place.path("wide/frame_0000.pov")).unwrap());
}
