//! Tests of the commands that make films, contact sheets, stills and blurred frames from images.

use std::fs;
use std::path::Path;
use std::process::Command;

use jabuka::render::linear_light;

use crate::scene::{Place, SCENE, assert_tidy, names, pixels};
use crate::support::{stderr, stdout};

/// Returns the number of decoded frames of a film, and its frame rate.
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

    // A film of every fifth frame has the same duration.
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

/// A scene of three frames that are 100 s apart, too slow for a film in real time.
const SLOW: &str = "
    [simulation]
    duration = 200
    frame_rate = 0.01
    [output]
    size = [32, 18]
    [body.ball]
    shape.sphere.radius = 1
    velocity = [0.01, 0, 0]
    ";

#[test]
fn a_scene_of_any_time_makes_a_film_and_its_pace_is_said() {
    let place = Place::new(SLOW);
    let made = |arguments: &[&str], name: &str| {
        let said = stdout(&place.succeed(&[&["render", "scene.toml", "--video", name], arguments].concat()));
        let line = said.lines().find_map(|line| line.strip_prefix("film      ")).unwrap().to_owned();
        (line, film(&place.path(name)))
    };
    let (said, (frames, rate)) = made(&[], "a.mp4");
    assert_eq!(said, "a.mp4, 0.12 s, 2500 times faster than life");
    assert_eq!((frames, &*rate), (3, "25/1"));
    let (said, (_, rate)) = made(&["--video-rate", "10", "--video-quality", "draft"], "b.mp4");
    assert_eq!((&*said, &*rate), ("b.mp4, 0.30 s, 1000 times faster than life", "10/1"));
    let own = ["--set", "output.video_rate=5"];
    assert_eq!(made(&own, "c.webm").1.1, "5/1");
    // A rate on the command line overrides that of the scene. The scene's rate is for all frames, so every second frame halves it.
    assert_eq!(made(&[&own[..], &["--video-rate", "20"]].concat(), "d.mp4").1.1, "20/1");
    assert_eq!(made(&[&own[..], &["--every", "2"]].concat(), "e.mp4").1, (2, "5/2".to_owned()));
    let (said, _) =
        made(&["--set", "simulation.frame_rate=0.02", "--set", "output.video_rate=0.01"], "f.mp4");
    assert!(said.ends_with(", 2 times slower than life"), "{said}");
    // A film of higher quality is larger.
    let length = |quality: &str| {
        made(&["--video-quality", quality], "q.mp4");
        fs::metadata(place.path("q.mp4")).unwrap().len()
    };
    let lengths = ["draft", "good", "final"].map(length);
    assert!(lengths.is_sorted(), "{lengths:?}");
}

#[test]
fn a_film_that_cannot_be_is_said_before_anything_is_done() {
    let place = Place::new(SCENE);
    fs::write(place.path("file"), "").unwrap();
    for (arguments, code, why) in [
        (&["--video-rate", "25"][..], 2, "name it with `--video FILE`"),
        (&["--video", "a.mp4", "--video-rate", "5000"], 2, "from 0.01 to 1000 frames a second, not 5000"),
        (&["--video", "a.mp4", "--video-rate", "fast"], 2, "it is not a number"),
        (&["--video", "a.gif", "--video-quality", "final"], 2, "`a.gif` has 256 colors in any quality"),
        (&["--video", "a.mp4", "--size", "20000x20"], 1, "error[bad-film-size]"),
        (&["--video", "file/a.mp4"], 1, "error[cannot-write]"),
        (&["--contact-sheet", "file/a.png"], 1, "error[cannot-write]"),
        (&["--video", "a.mp4", "--set", "output.video_rate=0"], 1, "error[out-of-range]"),
    ] {
        let output = place.run(&[&["render", "scene.toml"], arguments].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
        assert!(!place.path("out").exists(), "{arguments:?}");
    }
}

#[test]
fn what_is_read_or_kept_is_never_replaced() {
    let place = Place::new(&format!(
        "povray.assets = ['wall.gif', 'wall.png']\n[body.land.shape.heightfield]\nfile = 'h.png'\nsize = [4, 1, 4]\n{SCENE}"
    ));
    linear_light::mean(&[support_image(&place)]).unwrap().write(&place.path("h.png")).unwrap();
    for name in ["wall.gif", "wall.png"] {
        fs::copy(place.path("h.png"), place.path(name)).unwrap();
    }
    fs::create_dir(place.path("sub")).unwrap();
    fs::hard_link(place.path("h.png"), place.path("hard.png")).unwrap();
    let before = fs::read(place.path("h.png")).unwrap();
    let sheet = "--contact-sheet";
    for arguments in [
        ["render", "scene.toml", sheet, "h.png"],
        ["render", "scene.toml", sheet, "sub/../wall.png"],
        ["render", "scene.toml", sheet, "hard.png"],
        ["render", "scene.toml", "--video", "wall.gif"],
        ["render", "scene.toml", sheet, "out/scene/images/frame_0003.png"],
        ["render", "scene.toml", "--video", "out/scene/assets/wall.gif"],
        ["still", "scene.toml", "-o", "h.png"],
        ["still", "scene.toml", "-o", "out/.still/scene/images/frame_0000.png"],
    ] {
        let output = place.run(&arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let said = stderr(&output);
        assert!(said.contains("error[cannot-overwrite]") && said.contains("would be overwritten"), "{said}");
        assert!(!place.path("out").exists(), "{arguments:?}");
    }
    for name in ["h.png", "wall.gif", "wall.png"] {
        assert!(fs::read(place.path(name)).unwrap() == before, "{name}");
    }
    // This holds also for commands that read no scene.
    place.succeed(&["render", "scene.toml", "--frames", "0-1"]);
    let frame = "out/scene/images/frame_0001.png";
    for arguments in [
        &["average", "-o", "h.png", "h.png", "hard.png"][..],
        &["average", "-o", frame, "h.png"],
        &["render", "out/scene", "--frames", "0", sheet, frame],
        &["still", "scene.toml", "-o", frame],
    ] {
        let output = place.run(arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(stderr(&output).contains("error[cannot-overwrite]"), "{}", stderr(&output));
    }
    place.succeed(&["average", "-o", "mean.png", "h.png", "hard.png"]);
}

/// Writes a small image for a heightfield. Returns its path.
fn support_image(place: &Place) -> std::path::PathBuf {
    let path = place.path("heights.png");
    let mut encoder = png::Encoder::new(fs::File::create(&path).unwrap(), 8, 8);
    encoder.set_color(png::ColorType::Rgb);
    let pixels: Vec<u8> = (0..192_u8).collect();
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    path
}

#[test]
fn scripts_do_not_replace_what_the_scene_reads() {
    let place = Place::new(&format!("povray.assets = ['out/scene/frame_0000.png']\n{SCENE}"));
    fs::create_dir_all(place.path("out/scene")).unwrap();
    fs::write(place.path("out/scene/frame_0000.png"), "mine").unwrap();
    for arguments in [&["compile", "scene.toml"][..], &["render", "scene.toml", "-o", "out/scene"]] {
        let output = place.run(arguments);
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains("error[cannot-overwrite]"), "{}", stderr(&output));
    }
    assert_eq!(fs::read_to_string(place.path("out/scene/frame_0000.png")).unwrap(), "mine");
}

#[test]
fn a_still_without_a_name_has_the_name_of_the_scene_and_the_view() {
    let place = Place::new(&format!("{SCENE}\n[view.side]\nlocation = [9, 2, 0]"));
    let said = stdout(&place.succeed(&["still", "scene.toml"]));
    assert!(said.starts_with("scene.png: t = 0 s, in "), "{said}");
    let said = stdout(&place.succeed(&["still", "scene.toml", "--view", "side"]));
    assert!(said.starts_with("scene-side.png: t = 0 s, in "), "{said}");
    assert!(pixels(&place.path("scene.png")) != pixels(&place.path("scene-side.png")));
    // A file that the scene reads is not replaced.
    let place = Place::new(&format!("povray.assets = ['scene.png']\n{SCENE}"));
    fs::write(place.path("scene.png"), "mine").unwrap();
    let output = place.run(&["still", "scene.toml"]);
    assert!(stderr(&output).contains("error[cannot-overwrite]"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(place.path("scene.png")).unwrap(), "mine");
}

#[test]
fn a_still_is_the_image_of_any_moment() {
    let place = Place::new(SCENE);
    let still = |time: &str, name: &str| {
        let output = place.succeed(&["still", "scene.toml", "--time", time, "-o", name]);
        assert!(stdout(&output).starts_with(&format!("{name}: t = {time} s, in ")), "{}", stdout(&output));
        pixels(&place.path(name))
    };
    // At the time of a frame, a still equals this frame.
    let at_frame = still("0.4", "frame.png");
    place.succeed(&["render", "scene.toml", "--frames", "10"]);
    assert!(at_frame == pixels(&place.path("out/scene/images/frame_0010.png")));
    // Between two frames, a still shows the ball at its location at that time.
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

/// Two walls close in on a ball, and touch it at 0.5 s.
const JAMMED: &str = "
    simulation = { duration = 1, frame_rate = 10, gravity = [0, 0, 0], contacts = 'event-driven' }
    output.size = [64, 36]
    [body.ball]
    shape.sphere.radius = 0.5
    location = [0, 2, 0]
    restitution = 1
    [body.left]
    shape.box.size = [1, 3, 3]
    motion.formula.location = ['-1.5 + t', 2, 0]
    [body.right]
    shape.box.size = [1, 3, 3]
    motion.formula.location = ['1.5 - t', 2, 0]
";

#[test]
fn a_still_shows_a_moment_before_a_breakdown_and_none_after_it() {
    let place = Place::new(JAMMED);
    for (time, is_made) in [("0", true), ("0.43", true), ("0.7", false)] {
        let image = format!("{time}.png");
        let output = place.run(&["still", "scene.toml", "--time", time, "-o", &image]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{time}: {said}");
        assert!(said.contains("error[jammed]: "), "{time}: {said}");
        assert_eq!(
            said.contains(&format!("; the image at t = {time} s is made\n")),
            is_made,
            "{time}: {said}"
        );
        assert_eq!(place.path(&image).exists(), is_made, "{time}");
    }
}

#[test]
fn a_still_sees_the_clock_of_its_moment() {
    let sdl = "sphere { <0, 3, 0>, 1 pigment { color rgb <clock * 2 - 0.84, 0, 0> } finish { emission 1 } }";
    let place = Place::new(&format!("povray.sdl = '{sdl}'\n{SCENE}"));
    // Look at the upper half of the picture: black at 0.42 s, and red half a second later.
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

    // Render each moment of frame 2 separately, and average them with `jabuka average`.
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

    // Blurred frames are not rendered twice, and a still is blurred like the frame at its time.
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
    // Break the last moment of the frame.
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
