//! Tests of the commands that help to write scenes, such as `jabuka list` and `jabuka new`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{self, commands, jabuka, root, stderr, stdout};
use jabuka::catalog::CATEGORIES;
use jabuka::scene::grammar::all_keys;

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
    texts.extend(
        ["src", "physics"].map(|name| files(&root().join(name), &[".rs", ".toml", ".html"])).concat(),
    );
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
    cone         An upright cone or frustum; the center of mass of a cone is a quarter of the height above its base (`radius`, `height`, `top_radius`)
    torus        A ring around the y axis (`radius`, `tube_radius`)
    mesh         A solid with a triangle mesh from a file, in the file's axes (`file`, `scale`, `smooth`)
    plane        An infinite plane, always fixed (`normal`)
    axes         A triad of arrows along x, y, z, as heavy as a ball of half their length (`length`)
    heightfield  A landscape with heights from the gray levels of an image, always fixed; its `location` is the middle of its rectangle at the height of black (`file`, `size`, `smooth`)
    compound     Several solids of one density as one body; its `location` is their common center of mass (`parts`)
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
fn a_list_is_found_by_the_singular_of_its_name() {
    for (one, many) in
        [("shape", "shapes"), ("finish", "finishes"), ("color", "colors"), ("contact", "contacts")]
    {
        let [one, many] = [one, many].map(|name| jabuka().args(["list", name]).output().unwrap());
        assert!(one.status.success() && one.stdout == many.stdout, "{}", stderr(&one));
    }
}

#[test]
fn what_cannot_be_listed_is_an_error() {
    let output = jabuka().args(["list", "shaps"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(
        said.starts_with("error: there is no list of `shaps`; did you mean `shapes`?\nthe lists: "),
        "{said}"
    );
    let said = stderr(&jabuka().args(["list", "foo"]).output().unwrap());
    assert!(CATEGORIES.iter().all(|category| said.contains(category.name)), "{said}");
}

#[test]
fn measures_are_listed_with_units_and_meanings() {
    let said = stdout(&jabuka().args(["list", "measures"]).output().unwrap());
    for words in
        ["\nBODY.speed ", "\nBODY.distance.OTHER ", "\nforce.NAME.x ", " m/s  ", "the distance between"]
    {
        assert!(said.contains(words), "{words} is not in {said}");
    }
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
fn a_new_scene_can_be_like_any_example() {
    let folder = tempfile::tempdir().unwrap();
    let new =
        |arguments: &[&str]| jabuka().current_dir(folder.path()).arg("new").args(arguments).output().unwrap();
    let scenes = fs::read_dir(root().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let scenes: Vec<_> = scenes.filter(|path| path.is_file()).collect();
    let listed = stdout(&jabuka().args(["list", "scenes"]).output().unwrap());
    assert_eq!(listed.lines().count(), scenes.len());
    let mut mine = Vec::new();
    for scene in &scenes {
        let name = scene.file_stem().unwrap().to_str().unwrap();
        assert!(listed.lines().any(|line| line.starts_with(&format!("{name} "))), "{name}");
        let output = new(&[name, "--like", name]);
        let said = format!("{name}.toml: a scene to start from; `jabuka preview {name}.toml` shows it\n");
        assert_eq!(stdout(&output), said, "{}", stderr(&output));
        let copy = folder.path().join(format!("{name}.toml"));
        assert_eq!(fs::read(&copy).unwrap(), fs::read(scene).unwrap());
        mine.push(copy);
    }
    // The files that a scene reads are there, too: every copy is a complete scene.
    let output = jabuka().arg("check").args(&mine).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));

    for named in ["scenes/atom.toml", "atom.toml"] {
        assert!(new(&[&format!("copy of {}", named.replace('/', "_")), "--like", named]).status.success());
    }
    let output = new(&["mine", "--like", "domino"]);
    assert_eq!(output.status.code(), Some(1));
    let said = "error: there is no scene `domino` to start from; did you mean `domino_spiral` or `dominoes`?\n\
                `jabuka new --list` and `jabuka list scenes` show all\n";
    assert_eq!(stderr(&output), said);
    assert!(stderr(&new(&["mine", "--like", "crnak"])).contains("; did you mean `crank`?\n"));
    assert!(!folder.path().join("mine.toml").exists());

    // A file that is there already is kept, and then there is no scene either.
    fs::write(folder.path().join("meshes/hourglass.obj"), "mine").unwrap();
    let output = new(&["sand", "--like", "hourglass"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr(&output), "error: the file `meshes/hourglass.obj` is there already\n");
    assert!(!folder.path().join("sand.toml").exists());
    assert_eq!(fs::read(folder.path().join("meshes/hourglass.obj")).unwrap(), b"mine");
}

/// Each starter is a scene without warnings, also of its run.
#[test]
fn new_has_a_scene_for_each_kind() {
    let folder = tempfile::tempdir().unwrap();
    let new =
        |arguments: &[&str]| jabuka().current_dir(folder.path()).arg("new").args(arguments).output().unwrap();
    let listed = stdout(&new(&["--list"]));
    insta::assert_snapshot!(listed, @r"
    data      Data: a motion from a table, and beside it the same throw computed.
    first     A first scene: a ball and a crate are thrown, a ball hangs from a spring, and another swings on a rod.
    machine   A machine: a motor turns a crank, and a rod moves a piston to and fro.
    orbit     An orbit: a planet around a star.
    pendulum  A pendulum: how does its period depend on its length, and on how far it swings?
    pile      A pile: a wall of bricks, and a ball that hits it.
    throw     A throw: at which angle does the ball fly farthest?
    `jabuka new NAME --like pile` starts from one of these; `jabuka list scenes` shows the gallery
    ");
    for name in listed.lines().filter_map(|line| line.split_once("  ")).map(|(name, _)| name.trim()) {
        let output = new(&[name, "--like", name]);
        assert!(output.status.success(), "{}", stderr(&output));
        let checked =
            jabuka().current_dir(folder.path()).args(["check", "--run", &format!("{name}.toml")]).output();
        let checked = checked.unwrap();
        assert_eq!((&*stdout(&checked), &*stderr(&checked)), (&*format!("{name}.toml: ok\n"), ""));
    }
    let output = new(&["other"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("other.toml"), read("first.toml"));
    assert_eq!(new(&[]).status.code(), Some(2));
    assert_eq!(new(&["mine", "--list"]).status.code(), Some(2));
}

#[test]
fn explain_tells_about_keys_and_names() {
    let explain = |word: &str| jabuka().args(["explain", word]).output().unwrap();
    let said = stdout(&explain("body.ball.restitution"));
    insta::assert_snapshot!(said, @r"
    key       body.NAME.restitution
    meaning   The ratio of the rebound speed to the approach speed: 0 for no bounce, 1 for no loss. Of the two bodies' values, the larger counts
    value     a number from 0 to 1
    default   0
    ");
    insta::assert_snapshot!(stdout(&explain("body.shape.sphere")), @r"
    key       body.NAME.shape.sphere
    meaning   A ball
    value     a table with the keys of a sphere

      radius  Its radius
    ");
    let said = stdout(&explain("body.ball.shape.sphere.radius"));
    assert!(said.ends_with("unit      m\ndefault   none: the key is required\n"), "{said}");
    assert!(stdout(&explain("gravity")).starts_with("key       simulation.gravity\n"));
    let said = stdout(&explain("radius"));
    assert!(said.lines().any(|line| line.starts_with("body.NAME.shape.sphere.radius  ")), "{said}");
    assert_eq!(
        stdout(&explain("studio")),
        "studio: A photographer's room: white and seamless, with soft lights\n\
         in `jabuka list environments`: `environment`\n"
    );
    assert!(stdout(&explain("ball.speed")).starts_with("BODY.speed: m/s its speed\n"));
    let output = explain("simulation.gravty");
    let said = stderr(&output);
    let begin = "error: there is no code or key `simulation.gravty`; did you mean `simulation.gravity`?\n";
    assert!(output.status.code() == Some(1) && said.starts_with(begin), "{said}");
    assert!(said.lines().nth(1).unwrap().contains(": title, include, "), "{said}");
}

#[test]
fn the_page_of_keys_says_what_explain_says() {
    let page = jabuka::scene::grammar::reference();
    for key in all_keys() {
        let row = format!("| `{}` | ", key.spec.name);
        let has_meaning = |line: &str| line.starts_with(&row) && line.contains(key.spec.meaning);
        assert!(page.lines().any(has_meaning), "{}", key.path);
    }
}

#[test]
fn each_command_has_a_manual_page_with_its_options() {
    for (name, options) in
        commands::tree().iter().filter(|(name, _)| !["", "help", "sandbox"].contains(&name.as_str()))
    {
        let output = jabuka().args(["man", name]).output().unwrap();
        assert!(output.status.success(), "{name}: {}", stderr(&output));
        let page = stdout(&output);
        assert!(page.contains(&format!(".TH jabuka-{name} 1")), "{page}");
        for option in options {
            let written = format!("\\-\\-{}", option.replace('-', "\\-"));
            assert!(page.contains(&written), "{name}: {option}");
        }
    }
    assert!(stdout(&jabuka().arg("man").output().unwrap()).contains("jabuka man COMMAND"));
    let output = jabuka().args(["man", "rendr"]).output().unwrap();
    assert_eq!(stderr(&output), "error: there is no command `rendr`; did you mean `render`?\n");
    assert_eq!(jabuka().args(["man", "sandbox"]).output().unwrap().status.code(), Some(1));
}

#[test]
fn shells_complete_the_closed_lists() {
    let script = |shell: &str| stdout(&jabuka().args(["completions", shell]).output().unwrap());
    // What bash offers after the words of a command and a blank.
    let offered = |words: &str| {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(&file, script("bash")).unwrap();
        let ask = format!(
            "source {}; COMP_WORDS=({words} ''); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
             _jabuka jabuka '' \"${{COMP_WORDS[-2]}}\"; echo \"${{COMPREPLY[@]}}\"",
            file.path().display()
        );
        let output = Command::new("bash").args(["-c", &ask]).output().unwrap();
        stdout(&output).split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    for (words, value) in [
        ("jabuka list", "shapes"),
        ("jabuka explain", "unknown-key"),
        ("jabuka explain", "body.restitution"),
        ("jabuka new mine --like", "newtons_cradle"),
        ("jabuka man", "render"),
    ] {
        assert!(offered(words).iter().any(|word| word == value), "{words}: {:?}", offered(words));
    }
    for shell in ["zsh", "fish"] {
        assert!(script(shell).contains("newtons_cradle"), "{shell}");
    }
}

#[test]
fn words_of_other_programs_lead_to_the_command() {
    for (word, command) in
        [("run", "preview"), ("view", "preview"), ("build", "compile"), ("film", "render"), ("init", "new")]
    {
        let output = jabuka().arg(word).arg("scene.toml").output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(
            stderr(&output),
            format!("error: there is no command `{word}`; did you mean `jabuka {command}`?\n")
        );
    }
}

#[test]
fn a_scene_that_is_not_there_is_told_the_one_beside_it() {
    let place = support::place::Place::new(&[("throw.toml", MEETING), ("bounce.toml", MEETING)]);
    let folder = place.0.path();
    for (command, named, meant) in [
        ("compile", "throw", Some("throw.toml")),
        ("check", "./throw", Some("./throw.toml")),
        ("report", "thorw.toml", Some("throw.toml")),
        ("report", "bonce", Some("bounce.toml")),
        ("compile", "pendulum.toml", None),
        ("compile", "no/such/throw", None),
    ] {
        let output = jabuka().current_dir(folder).args([command, named]).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let meant = meant.map_or_else(String::new, |meant| format!("; did you mean `{meant}`?"));
        let said =
            format!("error[cannot-read]: cannot read the scene `{named}`: there is no such file{meant}\n");
        assert!(stderr(&output).starts_with(&said), "{}", stderr(&output));
    }
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
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("throw.toml"), MEETING).unwrap();
    let output = jabuka().current_dir(folder.path()).arg("throw").output().unwrap();
    assert_eq!(stderr(&output), said.replace("`throw.toml` is", "`throw` is"));
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
