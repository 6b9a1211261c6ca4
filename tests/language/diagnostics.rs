//! Tests of the diagnostics for bad scenes.
//!
//! Every scene in `tests/bad` holds one mistake, or one kind of mistake. The output of `jabuka check` on it is compared with the snapshot
//! of the same name, so a new scene in the folder is a new test.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Output;

use crate::support::{self, jabuka, root, stderr, stdout};
use jabuka::diagnostic::Code;

/// Error codes that no scene file alone can cause, each with the name of its test.
const ELSEWHERE: [(Code, &str); 8] = [
    (Code::NoTemplates, "a_folder_without_templates_is_said_to_be_so"),
    (Code::CannotRead, "a_missing_file_is_said_to_be_missing"),
    (Code::NotAFile, "a_folder_is_no_scene"),
    (Code::NotUtf8, "what_is_not_utf_8_is_refused_at_its_first_byte"),
    (Code::FileTooLarge, "a_huge_file_is_refused_before_it_is_read"),
    (Code::ComputedInclude, "trusted_sdl_that_computes_what_it_includes_gets_a_warning_wherever_it_stands"),
    (Code::SameAsset, "two_files_cannot_be_copied_to_one_place"),
    (Code::BadSet, "a_setting_is_refused_at_its_place_in_the_argument"),
];

/// Compares the messages for every bad scene with its snapshot, and checks that an error makes the command fail.
#[test]
fn every_bad_scene_is_told_what_is_wrong_with_it() {
    insta::glob!("../bad", "*.toml", |path| {
        let output = check(path, &[]);
        let said = stderr(&output);
        let errors = said.lines().filter(|line| line.starts_with("error[")).count();
        assert_eq!(output.status.code(), Some(i32::from(errors > 0)), "{said}");
        insta::assert_snapshot!("check", format!("{said}{}", stdout(&output)));
    });
}

/// Compares the JSON diagnostics of some bad scenes, which editors read, with their snapshots.
#[test]
fn editors_are_told_the_same_as_data() {
    insta::glob!(
        "../bad",
        "{ten_mistakes,byte_order_mark,unicode_before_the_error,camera_at_its_look_at}.toml",
        |path| {
            let output = check(path, &["--format", "json"]);
            assert_eq!(output.status.code(), Some(1));
            assert_eq!(stderr(&output), "");
            insta::assert_snapshot!("json", stdout(&output));
        }
    );
}

#[test]
fn a_folder_without_templates_is_said_to_be_so() {
    let output = check(&bad("templates_without_trust"), &["--trust"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("error[no-templates]: cannot read the templates in"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn every_code_that_a_scene_can_get_is_in_some_snapshot() {
    let source = root().join("src/scene");
    let made = support::codes(&source);
    assert!(made.len() > 25, "{made:?}");
    let mut snapshots = String::new();
    for entry in std::fs::read_dir(root().join("tests/language/snapshots")).unwrap() {
        snapshots.push_str(&std::fs::read_to_string(entry.unwrap().path()).unwrap());
    }
    let tests = include_str!("diagnostics.rs");
    for code in made {
        let shown = snapshots.contains(&format!("[{code}]: "));
        match ELSEWHERE.iter().find(|(elsewhere, _)| *elsewhere == code) {
            Some((_, test)) => assert!(tests.contains(&format!("fn {test}()")), "{test} is not there"),
            None => assert!(shown, "no scene in tests/bad shows `{code}`"),
        }
    }
}

#[test]
fn ten_mistakes_are_ten_errors_each_at_its_line() {
    let output = check(&bad("ten_mistakes"), &[]);
    let said = stderr(&output);
    let lines: BTreeSet<&str> = said.lines().filter(|line| line.contains("--> ")).collect();
    assert_eq!((said.matches("error[").count(), lines.len()), (10, 10), "{said}");
}

#[test]
fn trusted_sdl_that_computes_what_it_includes_gets_a_warning_wherever_it_stands() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "
[povray]
include = ['plain.inc', 'walls.inc']
sdl = '#include Wall'
[material.m]
sdl = '#include concat(\"a\", \".inc\")'
[body.a]
shape.sphere.radius = 1
look.sdl_before = '#include Before // once'
look.sdl_after = '#include \"after.inc\" // #include Nothing'
[body.b]
shape.sdl = { object = 'sphere { 0, 1 #include Skin }', stand_in.sphere.radius = 1 }
";
    std::fs::write(&scene, text).unwrap();
    std::fs::write(folder.path().join("plain.inc"), "#include \"more.inc\"\n").unwrap();
    std::fs::write(folder.path().join("walls.inc"), "#for (I, 1, 3)\n#include Walls[I]\n#end\n").unwrap();
    let output = check(&scene, &["--trust"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stderr(&output);
    let places: Vec<_> = said.lines().filter_map(|line| line.split_once("scene.toml:")).collect();
    let places: Vec<_> = places.into_iter().map(|(_, place)| place).collect();
    assert_eq!(places, ["3:25", "4:7", "6:7", "9:19", "12:24"], "{said}");
    assert_eq!(said.matches("warning[computed-include]: ").count(), 5, "{said}");
}

#[test]
fn two_files_cannot_be_copied_to_one_place() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(folder.path().join("a.png"), "a").unwrap();
    std::fs::write(inner.join("a.png"), "another").unwrap();
    let scene = inner.join("scene.toml");
    std::fs::write(&scene, "povray.assets = ['a.png', '../a.png']\n").unwrap();
    let said = stderr(&check(&scene, &["--trust"]));
    let expected = "error[same-asset]: two assets would be copied to `assets/a.png`\n";
    assert!(said.contains(expected) && said.contains("scene.toml:1:27\n"), "{said}");
}

#[test]
fn a_missing_file_is_said_to_be_missing() {
    let output = jabuka().args(["check", "no/such/scene.toml"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = "error[cannot-read]: cannot read the scene `no/such/scene.toml`: there is no such file\n\n";
    assert_eq!(stderr(&output), said);
}

#[test]
fn a_folder_is_no_scene() {
    let output = jabuka().args(["check", "scenes"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr(&output), "error[not-a-file]: `scenes` is a folder, not a scene file\n\n");
}

#[test]
fn what_is_not_utf_8_is_refused_at_its_first_byte() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("latin1.toml");
    std::fs::write(&scene, b"# 1\ntitle = \"caf\xe9\"\n").unwrap();
    let output = check(&scene, &[]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.starts_with("error[not-utf8]: ") && said.contains("latin1.toml:2:13\n"), "{said}");
}

#[test]
fn a_huge_file_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("huge.toml");
    std::fs::File::create(&scene).unwrap().set_len(100_000_000).unwrap();
    let output = check(&scene, &[]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.starts_with("error[file-too-large]: ") && said.contains("64 MiB"), "{said}");
}

/// A scene for each kind of file that a scene can name, and the name of that file.
const NAMING: [(&str, &str); 6] = [
    ("include = ['x.toml']", "x.toml"),
    ("povray.include = ['x.inc']", "x.inc"),
    ("povray.assets = ['x.png']", "x.png"),
    ("[body.b]\nshape.sphere.radius = 1\nmotion.trajectory.file = 'x.csv'", "x.csv"),
    ("[body.b]\nshape.mesh.file = 'x.obj'", "x.obj"),
    ("[body.b]\nshape.heightfield = { file = 'x.png', size = [1, 1, 1] }", "x.png"),
];

/// Returns the messages of `jabuka check` on a file. A check that takes too long is killed, and the test fails.
#[cfg(unix)]
fn check_soon(path: &Path) -> String {
    let mut child = jabuka()
        .arg("check")
        .arg(path)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let is_done = (0..2_000).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(10));
        child.try_wait().unwrap().is_some()
    });
    if !is_done {
        child.kill().unwrap();
    }
    let output = child.wait_with_output().unwrap();
    assert!(is_done, "the check of {} blocks", path.display());
    assert_eq!(output.status.code(), Some(1));
    stderr(&output)
}

/// Opening a named pipe blocks until another process writes to it, so jabuka must refuse it first.
#[cfg(unix)]
#[test]
fn a_named_pipe_is_refused_wherever_a_scene_names_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = |name: &str| {
        let made = std::process::Command::new("mkfifo").arg(folder.path().join(name)).status().unwrap();
        assert!(made.success());
        folder.path().join(name)
    };
    let said = check_soon(&pipe("scene.toml"));
    assert!(
        said.starts_with("error[not-a-file]: ") && said.contains("is a named pipe, not a scene"),
        "{said}"
    );
    std::fs::remove_file(folder.path().join("scene.toml")).unwrap();
    for (text, name) in NAMING {
        let (scene, pipe) = (folder.path().join("scene.toml"), pipe(name));
        std::fs::write(&scene, text).unwrap();
        let said = check_soon(&scene);
        assert!(said.contains("a named pipe") && said.contains("scene.toml:"), "{text}: {said}");
        std::fs::remove_file(pipe).unwrap();
    }
    std::os::unix::net::UnixListener::bind(folder.path().join("x.toml")).unwrap();
    std::fs::write(folder.path().join("scene.toml"), "include = ['x.toml']").unwrap();
    assert!(check_soon(&folder.path().join("scene.toml")).contains("is a socket"));
    assert!(check_soon(Path::new("/dev/zero")).contains("`/dev/zero` is a device, not a scene file"));
}

/// The files are sparse: they have their length but occupy no disk space.
#[test]
fn files_of_five_gigabytes_are_refused_with_the_number_of_their_bound() {
    let folder = tempfile::tempdir().unwrap();
    let bounds = ["64 MiB", "1 MiB", "", "256 MiB", "512 MiB", "512 MiB"];
    for ((text, name), bound) in NAMING.into_iter().zip(bounds) {
        let (scene, file) = (folder.path().join("scene.toml"), folder.path().join(name));
        std::fs::write(&scene, text).unwrap();
        std::fs::File::create(&file).unwrap().set_len(5 << 30).unwrap();
        let output = check(&scene, &[]);
        let said = stderr(&output);
        // An asset has no size limit, because it is copied in pieces and never held in memory.
        let is_refused = output.status.code() == Some(1) && said.contains("scene.toml:");
        assert!(bound.is_empty() || is_refused && said.contains(bound), "{text}: {said}");
        std::fs::remove_file(file).unwrap();
    }
}

#[test]
fn a_setting_is_refused_at_its_place_in_the_argument() {
    for (setting, expected) in [
        (
            "simulation.step=true",
            "error[wrong-type]: expected a number greater than 0, found a boolean\n --> --set:1:17\n",
        ),
        (
            "simulation.stepp=1",
            "--> --set:1:12\n  |\n1 | simulation.stepp=1\n  |            ^^^^^ did you mean `step`?",
        ),
        ("simulation..step=1", "error[bad-set]: `simulation..step` is not a key"),
        ("a b=1", "error[bad-set]: `a b` is not a key"),
        ("title.x=1", "error[bad-set]: `title` is not a table, so nothing in it can be set"),
        ("simulation.integrator=euler", "error[unknown-name]: unknown integrator `euler`\n --> --set:1:23\n"),
        (
            "body.ball.velocity=[1, 2]",
            "error[wrong-length]: expected a list of 3 numbers, found a list of 2\n --> --set:1:20\n",
        ),
        (
            "simulation.gravity=[0,-1.6,0",
            "error[bad-set]: the value is not valid TOML: the list is never closed\n --> --set:1:20\n",
        ),
        ("output.size=[640, 0]", "--> --set:1:19\n"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let mut command = jabuka();
        command.arg("compile").arg(support::scene("parabola")).arg("-o").arg(&out).args(["--set", setting]);
        let output = command.output().unwrap();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{setting}: {said}");
        assert!(said.contains(expected), "{setting}: {said}");
        assert!(!out.exists(), "{setting}");
    }
}

/// Two settings that belong together as one key have a correction that spans two texts, so it cannot be shown as one excerpt.
#[test]
fn settings_that_are_one_key_are_refused() {
    let mut command = jabuka();
    command.arg("check").arg(support::scene("parabola"));
    let output = command.args(["--set", "output.width=400", "--set", "output.height=225"]).output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("unknown keys `width` and `height` in [output]"), "{said}");
}

#[test]
fn a_setting_without_an_equals_sign_is_wrong_usage() {
    for setting in ["simulation.step", "", "=1"] {
        let mut command = jabuka();
        let output = command.arg("compile").arg(support::scene("parabola")).args(["--set", setting]).output();
        let output = output.unwrap();
        assert_eq!(output.status.code(), Some(2), "{setting:?}");
        assert!(stderr(&output).contains("KEY=VALUE"), "{setting:?}");
        assert_eq!(stdout(&output), "");
    }
}

#[test]
fn several_scenes_are_checked_in_one_run_and_one_bad_one_fails_it() {
    let output = jabuka();
    let mut output = output;
    let output =
        output.args(["check", "scenes/parabola.toml", "tests/bad/empty.toml", "tests/bad/two_shapes.toml"]);
    let output = output.output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let verdicts =
        "scenes/parabola.toml: ok\ntests/bad/empty.toml: ok, 1 warning\ntests/bad/two_shapes.toml: 1 error\n";
    assert_eq!(stdout(&output), verdicts);
    assert_eq!(stderr(&output).matches("error[").count(), 1);

    let output = jabuka().args(["check", "scenes/parabola.toml", "tests/bad/empty.toml"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let output = jabuka().arg("check").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn compiling_a_bad_scene_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = jabuka().arg("compile").arg(bad("two_shapes")).arg("-o").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stdout(&output), "");
    assert!(stderr(&output).ends_with("nothing was written: 1 error\n"));
    assert!(!out.exists());
}

#[test]
fn ten_thousand_mistakes_are_all_told() {
    use std::fmt::Write;
    let folder = tempfile::tempdir().unwrap();
    let (mut keys, mut names) = (String::new(), String::new());
    for i in 0..10_000 {
        writeln!(keys, "[body.b{i}]\nshape.sphere.radius = 1\nlocatoin = [{i}, 0, 0]\n").unwrap();
        writeln!(names, "[body.b{i}]\nshape.sphere.radius = 1\nmaterial = \"m{i}x\"\n[material.m{i}]")
            .unwrap();
    }
    let on: Vec<String> = (0..10_000).map(|i| format!("\"b{i}\"")).collect();
    let line = format!("[force.wind.constant]\non = [{}]\n", on.join(", "));
    for (name, text) in [("keys", keys), ("names", names), ("line", line)] {
        let scene = folder.path().join(name).with_extension("toml");
        std::fs::write(&scene, text).unwrap();
        let output = check(&scene, &[]);
        assert!(stdout(&output).ends_with(": 10000 errors\n"), "{name}");
    }
}

/// Returns the path of the bad scene of this name.
fn bad(name: &str) -> PathBuf {
    root().join("tests/bad").join(name).with_extension("toml")
}

/// Runs `jabuka check` on a scene. Scenes of the project are given by their relative path, so that messages are the same on every machine.
fn check(scene: &Path, arguments: &[&str]) -> Output {
    let root = root().canonicalize().unwrap();
    let scene = scene.strip_prefix(&root).or_else(|_| scene.strip_prefix(support::root())).unwrap_or(scene);
    jabuka().arg("check").arg(scene).args(arguments).output().unwrap()
}
