//! Tests of `--frames`: the selected frames have the same bytes as in a full run.

use crate::support::{compile, contents, jabuka, scene, stderr, stdout};

fn scripts(folder: &std::path::Path) -> Vec<(String, Vec<u8>)> {
    contents(folder).into_iter().filter(|(name, _)| name.starts_with("frame_")).collect()
}

#[test]
fn selected_frames_are_those_of_the_full_run() {
    let folder = tempfile::tempdir().unwrap();
    let (all, some) = (folder.path().join("all"), folder.path().join("some"));
    compile(&scene("damped_spring"), &all, &[]);
    compile(&scene("damped_spring"), &some, &["--frames", "0,50,90-100"]);
    let (all, some) = (scripts(&all), scripts(&some));
    assert_eq!((all.len(), some.len()), (151, 13));
    assert!(some.iter().all(|script| all.contains(script)));
}

#[test]
fn other_frames_stay_while_the_scene_is_unchanged_and_go_when_it_is_not() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &[]);
    let full = contents(folder.path());
    compile(&scene("damped_spring"), folder.path(), &["--frames", "3"]);
    assert!(full == contents(folder.path()), "the folder is as it was, manifest and all");

    let change = ["--set", "body.ball.mass=2", "--frames", "3,4"];
    let output = compile(&scene("damped_spring"), folder.path(), &change);
    let said = stdout(&output);
    assert!(said.contains("2 of 151 frames, 149 others of another scene removed"), "{said}");
    let names: Vec<String> = scripts(folder.path()).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["frame_0003.pov", "frame_0004.pov"]);
}

#[test]
fn files_of_others_stay_even_when_the_scene_changes() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &["--frames", "0-9"]);
    for name in ["frame_0000.png", "frame_12.pov", "notes.txt", "common.txt"] {
        std::fs::write(folder.path().join(name), "mine").unwrap();
    }
    compile(&scene("damped_spring"), folder.path(), &["--frames", "0", "--set", "body.ball.mass=2"]);
    let names: Vec<String> = contents(folder.path()).into_iter().map(|(name, _)| name).collect();
    let expected = [
        ".jabuka-lock",
        "animation.ini",
        "animation.pov",
        "common.txt",
        "frame_0000.png",
        "frame_0000.pov",
        "frame_12.pov",
        "manifest.json",
        "notes.txt",
    ];
    assert_eq!(names, expected);
}

#[test]
fn a_frame_that_is_not_there_is_wrong_usage() {
    let folder = tempfile::tempdir().unwrap();
    for (list, message) in
        [("151", "there is no frame 151"), ("5-2", "ends before it begins"), ("x", "not the number")]
    {
        let output = jabuka()
            .args(["compile", "scenes/damped_spring.toml", "--frames", list, "-o"])
            .arg(folder.path().join("out"))
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{list}");
        assert!(stderr(&output).contains(message), "{}", stderr(&output));
        assert!(!folder.path().join("out").exists());
    }
}
