//! Tests of the commands that help to write scenes, such as `jabuka list` and `jabuka new`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{self, commands, jabuka, root, stderr, stdout};
use jabuka::catalog::CATEGORIES;

/// Options of other programs that the project's texts mention, by program.
const FOREIGN: [(&str, &[&str]); 8] = [
    ("cargo", &["features", "path", "release", "open", "example", "locked", "test", "no-default-features"]),
    ("docker", &["workdir"]),
    ("openjd", &["step"]),
    ("povray", &["version"]),
    ("parallel", &["joblog", "resume-failed", "sshlogin", "workdir"]),
    ("render-chunk and submit", &["chunk", "chunks", "missing", "dry-run"]),
    ("sbatch", &["partition", "account", "time", "mem", "cpus-per-task"]),
    ("setpriv", &["pdeathsig"]),
];

/// Returns all files below a folder whose names have one of these endings.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, endings));
        } else if endings.iter().any(|ending| path.to_string_lossy().ends_with(ending)) {
            found.push(path);
        }
    }
    found
}

#[test]
fn no_text_names_an_option_or_a_command_that_there_is_not() {
    let tree = commands::tree();
    assert!(tree.len() > 10 && tree["render"].contains("video"), "{tree:?}");
    let mut known: BTreeSet<&str> = tree.values().flatten().map(String::as_str).collect();
    known.extend(FOREIGN.iter().flat_map(|(_, options)| *options));
    let mut texts =
        vec![root().join("README.md"), root().join("CHANGELOG.md"), root().join("templates/README.md")];
    texts.extend(files(&root().join("src"), &[".rs", ".toml", ".html"]));
    texts.extend(
        ["explanations", "docs", "scenes"].map(|name| files(&root().join(name), &[".md", ".toml"])).concat(),
    );
    let mut wrong = Vec::new();
    for path in &texts {
        let text = fs::read_to_string(path).unwrap();
        let text = text.split("#[cfg(test)]").next().unwrap();
        let mut say = |what: String| wrong.push(format!("{}: {what}", path.display()));
        for option in commands::options(text) {
            if !known.contains(&*option) {
                say(format!("there is no option --{option}"));
            }
        }
        // In prose, a command stands between backquotes; in an example, it stands after `$ `.
        for (at, start) in ["`jabuka ", "$ jabuka "].iter().flat_map(|start| text.match_indices(start)) {
            let end = if start.starts_with('`') { '`' } else { '\n' };
            let command = text[at + start.len()..].split([end, '\n', '|', '&', '#', ';']).next().unwrap();
            let name: &str = command.split([' ', '`', '"', '\'', '{', '…']).next().unwrap();
            if name.is_empty() || name.starts_with('-') || !name.starts_with(char::is_lowercase) {
                continue;
            }
            let Some(options) = tree.get(name) else {
                say(format!("there is no command `jabuka {name}`"));
                continue;
            };
            for option in commands::options(command) {
                if !options.contains(&option) {
                    say(format!("`jabuka {name}` has no option --{option}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn list_shows_what_there_is_to_choose_from() {
    let output = jabuka().args(["list", "shapes"]).output().unwrap();
    assert!(output.status.success());
    insta::assert_snapshot!(stdout(&output), @r"
    sphere       A ball (`radius`)
    box          A box, optionally with rounded edges (`size`, `rounding`)
    cylinder     A cylinder (`radius`, `height`)
    capsule      A cylinder with a hemisphere on either end (`radius`, `height`)
    cone         An upright cone or frustum; the centre of mass of a cone is a quarter of the height above its base (`radius`, `height`, `top_radius`)
    torus        A ring around the y axis (`radius`, `tube_radius`)
    mesh         A solid with a triangle mesh from a file, in the file's axes (`file`, `scale`, `smooth`)
    plane        An infinite plane, always fixed (`normal`)
    axes         A triad of arrows along x, y, z, as heavy as a ball of half their length (`length`)
    heightfield  A landscape with heights from the gray levels of an image, always fixed; its `location` is the middle of its rectangle at the height of black (`file`, `size`, `smooth`)
    compound     Several solids of one density as one body; its `location` is their common centre of mass (`parts`)
    sdl          An object in SDL, with a solid for mechanics (`object`, `stand_in`)
    ");
    let said = stdout(&jabuka().args(["list", "colors"]).output().unwrap());
    assert!(said.starts_with("aliceblue             #f0f8ff\n"), "{said}");
    let said = stdout(&jabuka().args(["list", "functions"]).output().unwrap());
    assert!(said.contains("`atan2(y, x)`") && said.lines().any(|line| line.starts_with("tau ")), "{said}");
    let said = stdout(&jabuka().args(["list", "repeats"]).output().unwrap());
    assert!(said.lines().any(|line| line.starts_with("scatter ")), "{said}");
    let said = stdout(&jabuka().arg("list").output().unwrap());
    assert_eq!(said.lines().count(), CATEGORIES.len());
}

#[test]
fn what_cannot_be_listed_is_an_error() {
    let output = jabuka().args(["list", "shape"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(
        said.starts_with("error: there is no list of `shape`; did you mean `shapes`?\nthe lists: "),
        "{said}"
    );
    let said = stderr(&jabuka().args(["list", "foo"]).output().unwrap());
    assert!(CATEGORIES.iter().all(|category| said.contains(category.name)), "{said}");
}

const MEETING: &str = "
    simulation.duration = 2
    [body.left]
    shape.sphere.radius = 0.5
    velocity = [2, 0, 0]
    [body.right]
    shape.sphere.radius = 0.5
    location = [3, 0, 0]
    ";

#[test]
fn check_takes_settings_and_says_what_a_run_would() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, MEETING).unwrap();
    let check = |arguments: &[&str]| jabuka().arg("check").arg(&scene).args(arguments).output().unwrap();
    assert!(stdout(&check(&[])).ends_with("scene.toml: ok\n"));
    let output = check(&["--run"]);
    assert!(
        stderr(&output).starts_with("warning[overlap]: `left` and `right` overlap at t = 1.04 s\n"),
        "{}",
        stderr(&output)
    );
    assert!(output.status.success() && stdout(&output).ends_with("scene.toml: ok, 1 warning\n"));
    let output = check(&["--run", "--set", "body.right.location=[3, 2, 0]"]);
    assert!(stdout(&output).ends_with("scene.toml: ok\n"), "{}", stderr(&output));
    let output = check(&["--set", "body.right.mass=-1"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("--set:1:17"), "{}", stderr(&output));
    // Editors get the warnings about the run as JSON, too.
    let said = stdout(&check(&["--run", "--format", "json"]));
    assert!(said.contains("\"overlap\""), "{said}");
}

#[test]
fn a_manifest_says_what_was_set() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    support::compile(
        &support::scene("projectile"),
        &out,
        &["--frames", "0", "--set", "simulation.step=0.002"],
    );
    let manifest = std::fs::read_to_string(out.join("manifest.json")).unwrap();
    assert!(manifest.contains("\"simulation.step=0.002\""), "{manifest}");
}

#[test]
fn a_new_scene_compiles_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let new = |name: &str| jabuka().current_dir(folder.path()).args(["new", name]).output().unwrap();
    let output = new("first");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("first.toml: "));
    let scene = folder.path().join("first.toml");
    let output = support::compile(&scene, &folder.path().join("out"), &[]);
    assert_eq!(stderr(&output), "");

    // An existing file is never overwritten, with or without the ending `.toml` in the argument.
    std::fs::write(&scene, "mine").unwrap();
    for name in ["first", "first.toml"] {
        let output = new(name);
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(stderr(&output), format!("error: the scene `{name}` is there already\n"));
    }
    assert_eq!(std::fs::read_to_string(&scene).unwrap(), "mine");
    assert_eq!(new("no/such/folder/x").status.code(), Some(1));
    assert!(new("a.b").status.success() && folder.path().join("a.b.toml").is_file());
}

#[test]
fn shells_and_the_manual_know_every_command() {
    for arguments in [["completions", "bash"].as_slice(), &["completions", "fish"], &["man"]] {
        let output = jabuka().args(arguments).output().unwrap();
        assert!(output.status.success());
        for command in ["compile", "check", "explain", "schema", "list", "new", "completions", "man"] {
            assert!(stdout(&output).contains(command), "{arguments:?}: {command}");
        }
    }
    assert_eq!(jabuka().args(["completions", "smoke"]).output().unwrap().status.code(), Some(2));
}

#[test]
fn a_scene_in_place_of_a_command_is_told_the_command() {
    let output = jabuka().arg("throw.toml").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = "error: `throw.toml` is not a command; did you mean `jabuka compile throw.toml`?\n";
    assert_eq!((stderr(&output).as_str(), stdout(&output).as_str()), (said, ""));
    let output = jabuka().arg("throw").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("unrecognized subcommand"));
    assert_eq!(jabuka().arg("--help").output().unwrap().status.code(), Some(0));
}

#[test]
fn ranges_without_an_end_are_told_what_they_lack() {
    for (frames, expected) in [
        ("-1", "`-1` does not say where it begins: the first frame is 0"),
        ("50-", "`50-` does not say where it ends, as `50-60` does"),
        ("-", "does not say where it begins"),
    ] {
        let mut command = jabuka();
        let output = command.args(["compile", "scenes/parabola.toml", "--frames", frames]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{frames}");
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
}
