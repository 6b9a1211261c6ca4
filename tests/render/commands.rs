//! What `render` and its kin make of the images: films, contact sheets, stills, blurred frames.

use std::fs;
use std::path::Path;
use std::process::Command;

use jabuka::render::linear_light;

use crate::scene::{Place, SCENE, assert_tidy, names, pixels};
use crate::support::{stderr, stdout};

/// The number of pictures in a film, which are decoded, and its pictures a second.
fn film(path: &Path) -> (usize, String) {
    let probe = Command::new("ffprobe")
        .args(["-v", "error", "-count_frames", "-select_streams", "v"])
        .args(["-show_entries", "stream=nb_read_frames,r_frame_rate", "-of", "default=nw=1:nk=1"])
        .arg(path)
        .output()
        .unwrap();
    let said = stdout(&probe);
    let (rate, frames) = said.trim().split_once('\n').unwrap_or_else(|| panic!("{}", stderr(&probe)));
    (frames.parse().unwrap(), rate.to_owned())
}

#[test]
fn one_command_makes_images_a_film_and_a_contact_sheet() {
    let place = Place::new(SCENE);
    let products = ["--video", "film.mp4", "--contact-sheet", "sheet.png"];
    let said = stdout(&place.succeed(&[&["render", "scene.toml"], &products[..]].concat()));
    assert!(said.contains("\nsheet     sheet.png\nfilm      film.mp4, 1.04 s\n"), "{said}");
    assert_eq!(film(&place.path("film.mp4")), (26, "25/1".to_owned()));
    assert!(pixels(&place.path("sheet.png")).0 > 64);

    // Every fifth frame makes a film of the same length.
    let said = stdout(&place.succeed(&[
        "render",
        "out/scene",
        "--every",
        "5",
        "--video",
        "coarse.webm",
        "-o",
        "coarse",
    ]));
    assert!(said.starts_with("coarse: 6 of 6 frames\n"), "{said}");
    assert_eq!(film(&place.path("coarse.webm")), (6, "5/1".to_owned()));
    assert_tidy(&place.path("coarse"));
}

#[test]
fn what_no_film_can_be_is_said_before_anything_is_done() {
    let place = Place::new(SCENE);
    for (arguments, why) in [
        (["--video", "film.avi"], "the name of a film ends in `.mp4`, `.webm` or `.gif`"),
        (["--contact-sheet", "sheet.jpg"], "`sheet.jpg` does not"),
        (["--size", "64"], "WIDTHxHEIGHT"),
    ] {
        let output = place.run(&[&["render", "scene.toml"], &arguments[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
        assert!(!place.path("out").exists(), "{arguments:?}");
    }
}

#[test]
fn a_still_is_the_image_of_any_moment() {
    let place = Place::new(SCENE);
    let still = |time: &str, name: &str| {
        let output = place.succeed(&["still", "scene.toml", "--time", time, "-o", name]);
        assert!(stdout(&output).starts_with(&format!("{name}: t = {time} s, in ")), "{}", stdout(&output));
        pixels(&place.path(name))
    };
    // At the time of a frame it is the frame.
    let at_frame = still("0.4", "frame.png");
    place.succeed(&["render", "scene.toml", "--frames", "10"]);
    assert!(at_frame == pixels(&place.path("out/scene/images/frame_0010.png")));
    // Between two it is neither, but where the ball is then.
    assert!(still("0.42", "between.png") != at_frame);
    let script = fs::read_to_string(place.path("out/.still/scene/frame_0010.pov")).unwrap();
    assert!(script.contains("sphere { <0.42, 0, 0>, 1 "), "{script}");
    assert_eq!(names(&place.path(".")), ["between.png", "frame.png", "out", "scene.toml"]);

    for (time, why) in
        [("1.1", "the run of this scene goes from 0 to 1 s"), ("-1", "from 0"), ("x", "--time")]
    {
        let output = place.run(&["still", "scene.toml", "--time", time, "-o", "no.png"]);
        assert_eq!(output.status.code(), Some(2), "{time}");
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
        assert!(!place.path("no.png").exists());
    }
}

#[test]
fn a_still_sees_the_clock_of_its_moment() {
    let sdl = "sphere { <0, 3, 0>, 1 pigment { color rgb <clock * 2 - 0.84, 0, 0> } finish { emission 1 } }";
    let place = Place::new(&format!("povray.sdl = '{sdl}'\n{SCENE}"));
    // In the middle of the upper half, at the given time: black at 0.42 s, and red half a second later.
    for (time, red) in [("0.42", false), ("0.92", true)] {
        place.succeed(&["still", "scene.toml", "--time", time, "-o", "x.png"]);
        let (width, _, bytes) = pixels(&place.path("x.png"));
        let brightest = bytes.chunks_exact(3).take(18 * width as usize).filter(|p| p[0] > 200 && p[1] < 120);
        assert_eq!(brightest.count() > 4, red, "{time}");
    }
}

const BLURRED: &str = "
    [simulation]
    duration = 0.2
    [output]
    size = [64, 36]
    [camera]
    location = [0, 2, 12]
    look_at = [0, 1, 0]
    shutter = 0.04
    samples = 5
    [body.ball]
    shape.sphere.radius = 1
    velocity = [20, 0, 0]
    ";

#[test]
fn a_blurred_frame_is_the_mean_of_its_moments_in_linear_light() {
    let place = Place::new(BLURRED);
    let said = stdout(&place.succeed(&["render", "scene.toml", "--video", "film.gif"]));
    assert!(said.starts_with("out/scene/images: 6 of 6 frames\n"), "{said}");
    assert_eq!(film(&place.path("film.gif")).0, 6);
    assert_tidy(&place.path("out/scene/images"));

    // The moments of frame 2, each by itself, and their mean by the command that is there for it.
    for moment in 0..5 {
        let status = Command::new("povray")
            .args(["-D", "-GA", "+FN16", "+W64", "+H36", "+A0.1", "+AM1", "+R3", "+KFI0", "+KFF4"])
            .args([format!("+SF{moment}"), format!("+EF{moment}")])
            .args(["+Iout/scene/shutter_0002.pov", "+Omoment.png"])
            .current_dir(place.path("."))
            .output();
        assert!(status.unwrap().status.success());
    }
    let moments: Vec<String> = (0..5).map(|moment| format!("moment{moment}.png")).collect();
    let arguments: Vec<&str> =
        ["average", "-o", "mean.png"].into_iter().chain(moments.iter().map(String::as_str)).collect();
    place.succeed(&arguments);
    let ours = pixels(&place.path("out/scene/images/frame_0002.png"));
    assert!(ours == pixels(&place.path("mean.png")));
    assert!(ours != pixels(&place.path("moment0.png")));
    let paths: Vec<_> = moments.iter().map(|name| place.path(name)).collect();
    assert!(linear_light::mean(&paths).is_ok());

    // Nothing is done twice here either, and a still is blurred as the frame is.
    let said = stdout(&place.succeed(&["render", "scene.toml"]));
    assert!(said.contains("as before 6, up to date\n"), "{said}");
    place.succeed(&["still", "scene.toml", "--time", "0.08", "-o", "still.png"]);
    assert!(ours == pixels(&place.path("still.png")));
}

#[test]
fn a_moment_that_is_broken_fails_its_frame_and_no_other() {
    let place = Place::new(BLURRED);
    place.succeed(&["compile", "scene.toml"]);
    let path = place.path("out/scene/shutter_0003.pov");
    let script = fs::read_to_string(&path).unwrap();
    // The last of its moments.
    let at = script.rfind("sphere {").unwrap();
    fs::write(&path, format!("{}{}", &script[..at], script[at..].replacen("sphere {", "sphere { oops", 1)))
        .unwrap();
    let line = script[..at].matches('\n').count() + 1;
    let output = place.run(&["render", "out/scene"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).starts_with("out/scene/images: 5 of 6 frames\n"), "{}", stdout(&output));
    let said = stderr(&output);
    assert!(said.contains(&format!("out/scene/shutter_0003.pov:{line}")) && said.contains("ball"), "{said}");
    assert_eq!(place.images().len(), 5);
    assert_tidy(&place.path("out/scene/images"));
}

#[test]
fn the_mean_of_what_is_no_image_is_an_error() {
    let place = Place::new(SCENE);
    let output = place.run(&["average", "scene.toml", "-o", "mean.png"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("error: `scene.toml` is no image"), "{}", stderr(&output));
    assert_eq!(place.run(&["average", "-o", "mean.png"]).status.code(), Some(2));
    assert!(!place.path("mean.png").exists());
}
