//! Tests that the commands in the explanations do what the text says.

use std::fs;
use std::process::Command;

use jabuka::explain::explanations;

use crate::support::{commands, jabuka, root, stderr};

/// The scene in the folder that the explanations' commands run in.
const SCENE: &str = "
    [simulation]
    duration = 0.4
    [output]
    size = [32, 18]
    [body.ball]
    shape.sphere.radius = 1
    velocity = [2, 0, 0]
    ";

#[test]
fn commands_that_an_explanation_calls_wrong_get_the_code_and_those_it_calls_right_succeed() {
    let prepared = tempfile::tempdir().unwrap();
    let place = |name: &str| prepared.path().join(name);
    let write = |name: &str, text: &[u8]| fs::write(place(name), text).unwrap();
    let table = "t [s],body,x [m],y [m],z [m]\n0,ball,0,0,0\n1,ball,1,0,0\n";
    let lift = "[body.ball]\nshape.sphere.radius = 1\nmotion.trajectory.file = \"lift_as_measured.csv\"\n";
    for name in ["scene.toml", "film.toml", "ball.toml", "lamp.toml", "caffè.toml"] {
        write(name, format!("title = \"caffè\"\n{SCENE}").as_bytes());
    }
    write(
        "old.toml",
        format!("title = \"caff\u{e8}\"\n{SCENE}").chars().map(|c| c as u8).collect::<Vec<_>>().as_slice(),
    );
    write("lift.toml", lift.as_bytes());
    write("lift_as_measured.csv", table.as_bytes());
    write("notes.txt", b"years of work");
    fs::File::create(place("film.mp4")).unwrap().set_len(5 << 30).unwrap();
    fs::create_dir(place("mine")).unwrap();
    fs::create_dir(place("empty_folder")).unwrap();
    std::os::unix::fs::symlink(root().join("scenes"), place("scenes")).unwrap();
    let output = jabuka().args(["render", "scene.toml"]).current_dir(prepared.path()).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));

    let mut tried = 0;
    for entry in explanations() {
        let code = entry.code;
        let (wrong, right) = (entry.wrong(), entry.right());
        // A comment after a command marks an example that a test cannot set up.
        if !commands::are(&wrong) || wrong.contains(" # ") {
            continue;
        }
        tried += 1;
        let folder = tempfile::tempdir().unwrap();
        let copied = Command::new("cp").arg("-a").arg(prepared.path().join(".")).arg(folder.path()).status();
        assert!(copied.unwrap().success());
        if wrong.contains("out/scene") {
            // The copy of a folder counts as one from elsewhere, so these examples get a folder that was made here.
            fs::remove_dir_all(folder.path().join("out")).unwrap();
            let output = commands::run("$ jabuka render scene.toml", folder.path());
            assert!(output.status.success(), "{}", stderr(&output));
        }
        let output = commands::run(&wrong, folder.path());
        let said = stderr(&output);
        // Invalid arguments give the exit code 2, and no error code in the message.
        let named = said.contains(&format!("[{code}]")) || output.status.code() == Some(2);
        assert!(!output.status.success() && named, "explanations/{code}.md: what is wrong says:\n{said}");
        let output = commands::run(&right, folder.path());
        let said = stderr(&output);
        assert!(output.status.success(), "explanations/{code}.md: what is right says:\n{said}");
    }
    assert!(tried >= 20, "only {tried} examples were run");
}
