//! Tests of full disks, and of folders without permission to write.
//!
//! Both are mounts in a private namespace, which needs no privileges and ends with its last process.

use std::process::{Command, Output};

use crate::scene::{Place, SCENE, pixels};
use crate::support::stderr;

/// Runs a shell script in a private mount namespace, with the test's folder as current folder. `$JABUKA` is the path of the command.
fn in_own_mounts(place: &Place, script: &str) -> Output {
    Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-ec", script])
        .current_dir(place.path(""))
        .env("JABUKA", env!("CARGO_BIN_EXE_jabuka"))
        .output()
        .unwrap()
}

#[test]
fn a_full_disk_is_said_and_made_good() {
    let place = Place::new(&SCENE.replace("size = [64, 36]", "size = [320, 180]"));
    place.succeed(&["compile", "scene.toml", "--frames", "0-5"]);
    let script = "
        mkdir small
        mount -t tmpfs -o size=1500k tmpfs small
        code=0
        $JABUKA render out/scene -o small/images >said.txt 2>errors.txt || code=$?
        echo $code >code.txt
        mkdir -p kept
        cp small/images/*.png kept/ 2>/dev/null || true
        mount -o remount,size=100m small
        $JABUKA render out/scene -o small/images
        ls small/images >names.txt
        ";
    let output = in_own_mounts(&place, script);
    assert!(output.status.success(), "{}", stderr(&output));
    let read = |name: &str| std::fs::read_to_string(place.path(name)).unwrap();
    assert_eq!(read("code.txt"), "1\n");
    let said = read("errors.txt");
    assert!(said.contains("error[disk-full]: no space is left for") && said.contains("make room"), "{said}");
    // Images written before the disk was full must be complete.
    for entry in std::fs::read_dir(place.path("kept")).unwrap() {
        pixels(&entry.unwrap().path());
    }
    let all: Vec<String> = (0..6).map(|frame| format!("frame_{frame:04}.png\n")).collect();
    assert_eq!(read("names.txt"), all.concat());
}

#[test]
fn a_folder_that_cannot_be_written_to_is_said() {
    let place = Place::new(SCENE);
    place.succeed(&["compile", "scene.toml", "--frames", "0-1"]);
    let script = "
        mkdir sealed
        mount --bind sealed sealed
        mount -o remount,ro,bind sealed
        $JABUKA render out/scene -o sealed/images
        ";
    let output = in_own_mounts(&place, script);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("error[cannot-write]") && said.contains("`sealed/images`"), "{said}");
}

#[test]
fn scripts_that_nobody_can_change_are_rendered_elsewhere() {
    let place = Place::new(SCENE);
    place.succeed(&["compile", "scene.toml", "--frames", "0-1"]);
    let script = "
        mount --bind out out
        mount -o remount,ro,bind out
        $JABUKA render out/scene -o images
        ls images
        ";
    let output = in_own_mounts(&place, script);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(crate::support::stdout(&output).ends_with("frame_0000.png\nframe_0001.png\n"));
}

#[test]
fn a_folder_of_images_that_is_taken_away_is_said() {
    let place = Place::new(SCENE);
    let povray = place.stand_in("rm -rf \"$(dirname \"$0\")/out/scene/images\"; exec povray \"$@\"");
    let output = place.run(&["render", "scene.toml", "--trust", "--povray", &povray]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("error[cannot-write]"), "{}", stderr(&output));
}
