//! Tests that files edited by the user in an output folder are kept, and reported.

use std::fs;
use std::path::Path;

use crate::support::{compile, contents, jabuka, stderr, stdout};

const SCENE: &str = "
    povray.assets = ['wall.txt']
    [simulation]
    duration = 0.2
    [output]
    layout = 'shared'
    [body.ball]
    shape.sphere.radius = 1
    velocity = [1, 0, 0]
    ";

/// Makes a temporary folder with a scene that has been compiled into `out`.
fn place() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::write(folder.path().join("wall.txt"), "bricks").unwrap();
    compile(&folder.path().join("scene.toml"), &folder.path().join("out"), &[]);
    folder
}

/// Compiles the scene again. Returns the messages on stderr, which report edited files.
fn again(folder: &Path, arguments: &[&str]) -> String {
    let output = compile(&folder.join("scene.toml"), &folder.join("out"), arguments);
    stderr(&output)
}

#[test]
fn an_edited_script_is_kept_beside_the_new_one() {
    let folder = place();
    let at = |name: &str| folder.path().join("out").join(name);
    let before = contents_of_files(&at(""));
    assert_eq!(again(folder.path(), &[]), "", "nobody has edited anything");
    for name in ["frame_0002.pov", "common.inc", "animation.ini", "assets/wall.txt"] {
        fs::write(at(name), format!("my {name}")).unwrap();
    }
    // The edit keeps the length of the file.
    let script = fs::read_to_string(at("frame_0004.pov")).unwrap();
    fs::write(at("frame_0004.pov"), script.replace("sphere", "SPHERE")).unwrap();
    let said = again(folder.path(), &[]);
    assert!(said.starts_with("warning[edited-script]: 5 files were edited in `"), "{said}");
    let names = [
        ("frame_0002.pov", "frame_0002.edited.pov"),
        ("common.inc", "common.edited.inc"),
        ("animation.ini", "animation.edited.ini"),
        ("assets/wall.txt", "assets.edited/wall.txt"),
    ];
    for (name, now) in names {
        assert_eq!(fs::read_to_string(at(now)).unwrap(), format!("my {name}"));
        fs::remove_file(at(now)).unwrap();
    }
    assert!(fs::read_to_string(at("frame_0004.edited.pov")).unwrap().contains("SPHERE"));
    fs::remove_file(at("frame_0004.edited.pov")).unwrap();
    assert!(before == contents_of_files(&at("")), "what the scene gives stands in their place");
    assert_eq!(again(folder.path(), &[]), "");
}

#[test]
fn an_edit_is_kept_also_where_the_scene_has_changed_or_the_frame_was_not_asked_for() {
    let folder = place();
    let at = |name: &str| folder.path().join("out").join(name);
    fs::write(at("frame_0002.pov"), "first").unwrap();
    // A frame that is not selected stays as it is. A later compilation still detects the edit.
    assert_eq!(again(folder.path(), &["--frames", "0,1"]), "");
    assert_eq!(fs::read_to_string(at("frame_0002.pov")).unwrap(), "first");
    let said = again(folder.path(), &["--set", "body.ball.shape.sphere.radius=2"]);
    assert!(said.contains("`frame_0002.pov` is now `frame_0002.edited.pov`"), "{said}");
    assert_eq!(fs::read_to_string(at("frame_0002.edited.pov")).unwrap(), "first");
    fs::write(at("frame_0002.pov"), "second").unwrap();
    let said = again(folder.path(), &["--set", "body.ball.shape.sphere.radius=2"]);
    assert!(said.contains("`frame_0002.pov` is now `frame_0002.edited-2.pov`"), "{said}");
    assert_eq!(fs::read_to_string(at("frame_0002.edited.pov")).unwrap(), "first");
}

#[test]
fn an_edit_that_the_scene_gives_now_is_none() {
    let folder = place();
    let at = |name: &str| folder.path().join("out").join(name);
    compile(&folder.path().join("scene.toml"), &folder.path().join("other"), &["--set", "title='x'"]);
    fs::copy(folder.path().join("other/frame_0002.pov"), at("frame_0002.pov")).unwrap();
    assert_eq!(again(folder.path(), &["--set", "title='x'"]), "");
    assert!(!at("frame_0002.edited.pov").exists());
}

#[test]
fn a_job_keeps_edited_scripts_too() {
    let folder = place();
    let batch = |from: &str| {
        let mut command = jabuka();
        command.current_dir(folder.path()).args(["batch", from, "--engine", "slurm", "-o", "job"]);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
        stderr(&output)
    };
    for from in ["scene.toml", "out"] {
        assert_eq!(batch(from), "");
        fs::write(folder.path().join("job/scripts/frame_0002.pov"), from).unwrap();
        assert!(batch(from).contains("`frame_0002.pov` is now `frame_0002.edited"), "{from}");
    }
    let kept = |name: &str| fs::read_to_string(folder.path().join("job/scripts").join(name)).unwrap();
    assert_eq!([kept("frame_0002.edited.pov"), kept("frame_0002.edited-2.pov")], ["scene.toml", "out"]);
}

/// Returns the names and bytes of a folder's files, without its subfolders.
fn contents_of_files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let copy = tempfile::tempdir().unwrap();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        if entry.file_type().unwrap().is_file() {
            fs::copy(entry.path(), copy.path().join(entry.file_name())).unwrap();
        }
    }
    contents(copy.path())
}
