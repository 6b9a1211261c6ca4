//! Tests of rendering again: up-to-date images are kept, and outdated ones are rendered again.

use std::fs;
use std::os::unix::fs::MetadataExt;

use crate::scene::{Place, SCENE, assert_tidy, pixels};
use crate::support::stdout;

/// Returns the names and inode numbers of the images. The inode number changes when an image is written again.
fn inodes(place: &Place) -> Vec<(String, u64)> {
    let inode = |name: &String| fs::metadata(place.path("out/scene/images").join(name)).unwrap().ino();
    place.images().iter().map(|name| (name.clone(), inode(name))).collect()
}

#[test]
fn what_is_up_to_date_starts_no_povray() {
    let place = Place::new(SCENE);
    let povray = place.stand_in("echo started >> \"$(dirname \"$0\")/log\"; exec povray \"$@\"");
    let render = ["render", "scene.toml", "--trust", "--povray", &povray];
    place.succeed(&render);
    let (log, images) = (fs::read_to_string(place.path("log")).unwrap(), inodes(&place));
    assert!(!log.is_empty());
    let said = stdout(&place.succeed(&render));
    assert!(said.contains("as before 26, up to date\n"), "{said}");
    assert_eq!(fs::read_to_string(place.path("log")).unwrap(), log, "POV-Ray was started");
    assert_eq!(inodes(&place), images);
}

#[test]
fn after_a_change_only_what_has_changed_is_rendered() {
    let place = Place::new(SCENE);
    place.succeed(&["render", "scene.toml"]);
    let before = inodes(&place);
    // Change scripts as an edit of the scene would that moves one body from frame 20 on.
    for frame in 20..26 {
        let path = place.path(&format!("out/scene/frame_{frame:04}.pov"));
        let script = fs::read_to_string(&path).unwrap();
        let moved = script.replace("} // ball", "translate y*0.5 } // ball");
        assert_ne!(moved, script);
        fs::write(&path, moved).unwrap();
    }
    let output = place.run(&["render", "out/scene"]);
    let after = inodes(&place);
    let same = before.iter().zip(&after).filter(|(a, b)| a == b).count();
    assert_eq!(same, 20, "{}", stdout(&output));
}

#[test]
fn equal_scripts_are_rendered_once() {
    let place = Place::new(&SCENE.replace("velocity = [1, 0, 0]", ""));
    let said = stdout(&place.succeed(&["render", "scene.toml"]));
    assert!(said.contains("copied    25, equal to others\n") && said.contains("rendered  1 in "), "{said}");
    assert_eq!(place.images().len(), 26);
    assert_tidy(&place.path("out/scene/images"));
    // A lost copy is copied again from its equal image.
    fs::remove_file(place.path("out/scene/images/frame_0007.png")).unwrap();
    let said = stdout(&place.succeed(&["render", "scene.toml"]));
    assert!(said.contains("copied    1, equal to others\n") && said.contains("rendered  0 in "), "{said}");
    let image = |name: &str| pixels(&place.path("out/scene/images").join(name));
    assert_eq!(image("frame_0007.png"), image("frame_0025.png"));
}

#[test]
fn an_image_that_was_changed_or_cut_off_is_rendered_again() {
    let place = Place::new(SCENE);
    place.succeed(&["render", "scene.toml", "--frames", "0-3"]);
    let path = place.path("out/scene/images/frame_0002.png");
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..whole.len() - 1]).unwrap();
    let said = stdout(&place.succeed(&["render", "scene.toml", "--frames", "0-3"]));
    assert!(said.contains("as before 3, up to date\n") && said.contains("rendered  1 in "), "{said}");
    assert_eq!(fs::read(&path).unwrap().len(), whole.len());
}

#[test]
fn other_options_another_povray_and_other_includes_make_other_images() {
    let scene = SCENE.replace("size = [64, 36]", "size = [64, 36]\n layout = 'shared'");
    let place = Place::new(&format!("povray.include = ['extra.inc']\n{scene}"));
    fs::write(place.path("extra.inc"), "#declare Extra = 1;\n").unwrap();
    let render = |more: &[&str]| {
        let arguments = [&["render", "scene.toml", "--frames", "0-1"], more].concat();
        let said = stdout(&place.succeed(&arguments));
        said.lines().last().unwrap().split(' ').filter(|word| !word.is_empty()).nth(1).unwrap().to_owned()
    };
    assert_eq!([render(&[]), render(&[])], ["2", "0"]);
    assert_eq!([render(&["--", "+Q8"]), render(&["--", "+Q8"])], ["2", "0"]);
    let povray = place.stand_in("exec povray \"$@\"");
    assert_eq!(render(&["--povray", &povray, "--", "+Q8"]), "0", "it is of the same version");
    fs::write(place.path("extra.inc"), "#declare Extra = 2;\n").unwrap();
    assert_eq!(render(&["--", "+Q8"]), "2", "the include stands in common.inc");
}

/// Checks that images depend on all files that their include files read. These files may be in other folders, and a file may be included
/// without a `#` by another include file.
#[test]
fn an_image_follows_whatever_its_include_files_read() {
    let place = Place::new("");
    let file = |name: &str| place.path(name).display().to_string();
    let scene = format!("povray.sdl = '#include \"{}\"'\n{SCENE}", file("first.inc"));
    fs::write(place.path("scene.toml"), scene).unwrap();
    fs::write(place.path("first.inc"), format!("include \"{}\"\n", file("second"))).unwrap();
    let second = format!("#declare Sky = pigment {{ image_map {{ ppm \"{}\" }} }}\n", file("sky.ppm"));
    fs::write(place.path("second.inc"), &second).unwrap();
    fs::write(place.path("sky.ppm"), b"P6\n1 1\n255\nabc").unwrap();
    let render = || {
        let said = stdout(&place.succeed(&["render", "scene.toml", "--frames", "0", "--trust"]));
        said.lines().last().unwrap().split(' ').filter(|word| !word.is_empty()).nth(1).unwrap().to_owned()
    };
    assert_eq!([render(), render()], ["1", "0"]);
    fs::write(place.path("sky.ppm"), b"P6\n1 1\n255\nabd").unwrap();
    assert_eq!([render(), render()], ["1", "0"], "an image that an include file reads");
    fs::write(place.path("second.inc"), second + "// more\n").unwrap();
    assert_eq!([render(), render()], ["1", "0"], "a file that an include file includes");
}

#[test]
fn images_of_frames_that_are_no_more_go() {
    let place = Place::new(SCENE);
    place.succeed(&["render", "scene.toml"]);
    fs::write(place.path("out/scene/images/notes.txt"), "mine").unwrap();
    let said = stdout(&place.succeed(&["render", "scene.toml", "--set", "simulation.duration=0.4"]));
    assert!(said.contains("removed   15 of frames that are no more\n"), "{said}");
    assert_eq!(place.images().len(), 11);
    assert!(place.path("out/scene/images/notes.txt").exists());
}

/// Changes one byte of an image, and keeps its length.
fn damage(place: &Place, frame: usize) {
    let path = place.path(&format!("out/scene/images/frame_{frame:04}.png"));
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&path, bytes).unwrap();
}

#[test]
fn an_image_of_which_a_byte_has_changed_is_rendered_again_where_it_is_verified() {
    let place = Place::new(SCENE);
    let render = ["render", "scene.toml", "--frames", "0-4"];
    let verify = [&render[..], &["--verify"]].concat();
    let status = |arguments: &[&str]| {
        let output = place.run(&[&["status", "out/scene"], arguments].concat());
        (stdout(&output), output.status.code())
    };
    place.succeed(&render);
    let good = pixels(&place.path("out/scene/images/frame_0002.png"));
    damage(&place, 2);
    assert!(stdout(&place.succeed(&render)).contains("as before 5, up to date\n"), "images are not read");
    assert_eq!(status(&[]), ("done     5 of 5\n".to_owned(), Some(0)));
    let changed = "done     4 of 5\nchanged  1: 2, since they were rendered\n";
    assert_eq!(status(&["--verify"]), (changed.to_owned(), Some(1)));
    let json: serde_json::Value = serde_json::from_str(&status(&["--verify", "--format", "json"]).0).unwrap();
    assert_eq!((&json["changed"], &json["complete"]), (&serde_json::json!([2]), &serde_json::json!(false)));

    let said = stdout(&place.succeed(&verify));
    assert!(said.contains("changed   2 since they were rendered, and rendered again\n"), "{said}");
    assert!(said.contains("as before 4, up to date\n") && said.contains("\nrendered  1 in "), "{said}");
    assert!(pixels(&place.path("out/scene/images/frame_0002.png")) == good);
    assert_eq!(status(&["--verify"]), ("done     5 of 5\n".to_owned(), Some(0)));
    assert_eq!(place.run(&["status", "out/scene", "--verify", "--watch"]).status.code(), Some(2));

    // A record of an earlier version has no digest. Its image still counts as done, but cannot be verified.
    let record = place.path("out/scene/images/.jabuka/frame_0003.txt");
    let text = fs::read_to_string(&record).unwrap();
    let old: String = text.split_inclusive('\n').take(6).collect();
    fs::write(&record, old).unwrap();
    assert!(stdout(&place.succeed(&render)).contains("as before 5, up to date\n"));
    let unverified = "done     4 of 5\nunverified 1: 3, whose records have no digest\n";
    assert_eq!(status(&["--verify"]), (unverified.to_owned(), Some(1)));
    let said = stdout(&place.succeed(&verify));
    assert!(said.contains("unverified 3, whose records have no digest, rendered again\n"), "{said}");
    assert!(fs::read_to_string(&record).unwrap().contains("\nimage "));
    assert_eq!(status(&["--verify"]), ("done     5 of 5\n".to_owned(), Some(0)));
}

#[test]
fn a_damaged_image_is_not_copied() {
    let place = Place::new(&SCENE.replace("velocity = [1, 0, 0]", ""));
    let render = ["render", "scene.toml", "--frames", "0-2"];
    place.succeed(&render);
    let image = |frame: usize| pixels(&place.path(&format!("out/scene/images/frame_{frame:04}.png")));
    let good = image(0);
    for frame in [0, 1] {
        damage(&place, frame);
    }
    fs::remove_file(place.path("out/scene/images/frame_0002.png")).unwrap();
    let said = stdout(&place.succeed(&render));
    assert!(said.contains("changed   0-1 since they were rendered"), "{said}");
    assert!([0, 1, 2].into_iter().all(|frame| image(frame) == good));
}

/// Checks that two renders of a scene, at two times and in two folders, give the same bytes: with and without motion blur, and of one moment.
#[test]
fn images_have_no_date() {
    const BLURRED: &[&str] = &["--set", "camera.shutter=0.02", "--set", "camera.samples=2"];
    let images = |changed: &[&str]| {
        let place = Place::new(SCENE);
        place.succeed(&[&["render", "scene.toml", "--frames", "0-1"], changed].concat());
        place.succeed(&[&["still", "scene.toml", "-t", "0.04", "-o", "still.png"], changed].concat());
        ["out/scene/images/frame_0000.png", "out/scene/images/frame_0001.png", "still.png"]
            .map(|name| fs::read(place.path(name)).unwrap())
    };
    for changed in [&[], BLURRED] {
        let first = images(changed);
        // The date has a resolution of a second.
        std::thread::sleep(std::time::Duration::from_millis(1100));
        assert!(first == images(changed), "{changed:?}");
        for image in &first {
            let has = |word: &[u8]| image.windows(word.len()).any(|part| part == word);
            assert!(has(b"IDAT") && !has(b"tIME") && !has(b"Render Date"));
        }
    }
}
