//! Tests of folders that belong to others, are in use or are missing, and of missing programs.

use std::fs;
use std::process::{Command, Stdio};

use crate::scene::{Place, SCENE, names};
use crate::support::stderr;

/// Checks that pipes in the place of hidden files block nothing: they are replaced, or they are an error.
#[test]
fn pipes_among_the_hidden_files_block_nothing() {
    let place = Place::new(SCENE);
    let render = ["render", "scene.toml", "--frames", "0"];
    place.succeed(&render);
    let within = |arguments: &[&str]| {
        let mut command = Command::new("timeout");
        command.args(["60", env!("CARGO_BIN_EXE_jabuka")]).args(arguments).current_dir(place.path(""));
        command.output().unwrap().status.code()
    };
    let pipe = |name: &str| {
        let path = place.path("out/scene/images/.jabuka").join(name);
        fs::remove_file(&path).unwrap_or_default();
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    };
    for name in ["povray", "frame_0000.txt", "failed/frame_0000.txt"] {
        pipe(name);
        assert_ne!(within(&["status", "out/scene"]), Some(124), "{name}");
        assert_eq!(within(&render), Some(0), "{name}");
    }
    pipe("lock");
    assert_eq!(within(&render), Some(1));
}

#[test]
fn a_folder_with_files_of_others_is_left_alone() {
    let place = Place::new(SCENE);
    fs::create_dir(place.path("thesis")).unwrap();
    fs::write(place.path("thesis/frame_0000.png"), "years of work").unwrap();
    let output = place.run(&["render", "scene.toml", "-o", "thesis"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("error[folder-not-ours]"), "{}", stderr(&output));
    assert_eq!(names(&place.path("thesis")), ["frame_0000.png"]);
}

#[test]
fn images_go_where_they_are_wanted() {
    let place = Place::new(SCENE);
    place.succeed(&["render", "scene.toml", "-o", "a folder of mine/ö", "--frames", "4-20", "--every", "8"]);
    let images: Vec<String> = names(&place.path("a folder of mine/ö"));
    assert_eq!(images, [".jabuka", "frame_0004.png", "frame_0012.png", "frame_0020.png"]);
}

#[test]
fn a_link_in_place_of_the_hidden_folder_is_not_followed() {
    let place = Place::new(SCENE);
    fs::create_dir_all(place.path("images")).unwrap();
    fs::create_dir_all(place.path("elsewhere/work-1-1")).unwrap();
    std::os::unix::fs::symlink(place.path("elsewhere"), place.path("images/.jabuka")).unwrap();
    let output = place.run(&["render", "scene.toml", "-o", "images"]);
    assert!(stderr(&output).contains("error[link]"), "{}", stderr(&output));
    assert!(place.path("elsewhere/work-1-1").exists());
}

#[test]
fn a_folder_in_the_place_of_a_record_is_named() {
    let place = Place::new(SCENE);
    fs::create_dir_all(place.path("images/.jabuka/frame_0000.txt")).unwrap();
    let output = place.run(&["render", "scene.toml", "-o", "images", "--frames", "0"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("`images/.jabuka/frame_0000.txt`: "), "{}", stderr(&output));

    // A folder in the place of an image is an error as well, also if an equal image would be copied.
    fs::remove_dir(place.path("images/.jabuka/frame_0000.txt")).unwrap();
    fs::remove_file(place.path("images/frame_0000.png")).unwrap();
    fs::create_dir_all(place.path("images/frame_0000.png/mine")).unwrap();
    let output = place.run(&["render", "scene.toml", "-o", "images", "--frames", "0"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("`images/frame_0000.png`: "), "{}", stderr(&output));
    assert!(place.path("images/frame_0000.png/mine").exists());
}

#[test]
fn two_at_once_do_not_disturb_each_other() {
    let place = Place::new(SCENE);
    place.succeed(&["compile", "scene.toml"]);
    let povray = place.stand_in("touch \"$(dirname \"$0\")/started\"; exec povray \"$@\"");
    let mut first = place.jabuka(&["render", "scene.toml", "--trust", "--povray", &povray]);
    let mut first = first.stdout(Stdio::null()).spawn().unwrap();
    while !place.path("started").exists() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let output = place.run(&["render", "out/scene"]);
    assert!(stderr(&output).contains("error[folder-locked]"), "{}", stderr(&output));
    assert!(first.wait().unwrap().success());
    assert_eq!(place.images().len(), 26);
}

#[test]
fn what_is_missing_is_said() {
    let place = Place::new(SCENE);
    let fails = |arguments: &[&str], code: i32, words: &[&str]| {
        let output = place.run(arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert!(words.iter().all(|word| said.contains(word)), "{arguments:?}: {said}");
    };
    fails(
        &["render", "scene.toml", "--povray", "nowhere"],
        1,
        &["error[no-povray]", "`nowhere`", "apt install povray"],
    );
    fails(
        &["render", "scene.toml", "--povray", "/bin/true", "--frames", "0"],
        1,
        &["error[wrong-povray]", "3.7"],
    );
    fails(&["render", "nothing.toml"], 1, &["nothing.toml"]);
    fails(&["render", "scene.toml", "--frames", "99"], 2, &["0 to 25"]);
    fails(&["render", "scene.toml", "--size", "640"], 2, &["1280x720"]);
    fails(&["render", "scene.toml", "--view", "top"], 2, &["no view `top`"]);
    fs::create_dir(place.path("empty")).unwrap();
    fails(&["render", "empty"], 1, &["error[no-scripts]", "`empty`"]);
    place.succeed(&["compile", "scene.toml", "--frames", "0-3"]);
    fails(&["render", "out/scene", "--frames", "3-5"], 1, &["error[no-scripts]", "3-5"]);
    fails(&["render", "out/scene", "--set", "a=1"], 2, &["`--set`"]);
    fails(&["render", "out/scene", "--", "+Q8\n+Q9"], 2, &["a line break"]);
    let manifest = fs::read_to_string(place.path("out/scene/manifest.json")).unwrap();
    fs::write(place.path("out/scene/manifest.json"), manifest.replace("\"complete\"", "\"writing\""))
        .unwrap();
    fails(&["render", "out/scene"], 1, &["error[incomplete-scripts]"]);
}

#[test]
fn scripts_without_a_manifest_are_rendered_too() {
    let place = Place::new(SCENE);
    place.succeed(&["compile", "scene.toml", "--frames", "2-4"]);
    fs::create_dir(place.path("mine")).unwrap();
    for frame in 2..5 {
        let name = format!("frame_{frame:04}.pov");
        fs::copy(place.path("out/scene").join(&name), place.path("mine").join(&name)).unwrap();
    }
    place.succeed(&["render", "mine", "--size", "32x18", "-o", "pictures"]);
    assert_eq!(
        names(&place.path("pictures")),
        [".jabuka", "frame_0002.png", "frame_0003.png", "frame_0004.png"]
    );
}
