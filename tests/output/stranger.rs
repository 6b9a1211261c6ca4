//! Tests that a folder from elsewhere, whatever is in it, makes jabuka move, keep, write or run nothing outside of that folder.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicBool, Ordering};

use crate::support::{jabuka, stderr};

const SCENE: &str = "
    povray.assets = ['wood.png']
    [simulation]
    duration = 0.04
    [output]
    size = [16, 9]
    [body.ball]
    shape.sphere.radius = 1
    ";

/// A home, in which a stranger's project lies.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Home {
        let home = Home(tempfile::tempdir().unwrap());
        for (name, text) in [
            ("ssh/authorized_keys", "MY KEY"),
            ("autostart/mine.desktop", "mine"),
            ("notes.txt", "years of work"),
            ("project/scene.toml", SCENE),
            ("project/wood.png", "wood"),
            ("bin/povray", FAKE_POVRAY),
        ] {
            fs::create_dir_all(home.path(name).parent().unwrap()).unwrap();
            fs::write(home.path(name), text).unwrap();
        }
        fs::write(home.path("bin/image.png"), picture()).unwrap();
        fs::set_permissions(home.path("bin/povray"), fs::Permissions::from_mode(0o755)).unwrap();
        home
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs jabuka in the project. No command may take longer than 20 s, as one would that reads a pipe.
    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new("timeout");
        command.args(["20", env!("CARGO_BIN_EXE_jabuka")]).args(arguments).current_dir(self.path("project"));
        command.env("JABUKA_CACHE_SIZE", "0").env("XDG_STATE_HOME", self.path("state"));
        let output = command.output().unwrap();
        assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}: {output:?}");
        output
    }

    /// Writes the scripts as a stranger would: on a machine whose notes are not those of this home.
    fn forge(&self) {
        let output = jabuka()
            .current_dir(self.path("project"))
            .env("XDG_STATE_HOME", self.path("elsewhere"))
            .args(["batch", "scene.toml", "--engine", "slurm", "-o", "job"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        let copy = |from: &str, to: &str| {
            let to = self.path(to);
            fs::create_dir_all(to.parent().unwrap()).unwrap();
            let copied = Command::new("cp").args(["-r"]).arg(self.path(from)).arg(to).status().unwrap();
            assert!(copied.success());
        };
        copy("project/job/scripts", "project/out/scene");
        copy("project/job/scripts", "project/out/.still/scene");
        fs::remove_dir_all(self.path("elsewhere")).unwrap();
    }

    /// Returns all files outside of the stranger's project with their bytes, and links with their targets.
    fn outside(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        for name in ["ssh", "autostart", "notes.txt", "bin"] {
            add(&self.path(name), &mut found);
        }
        found
    }
}

fn add(path: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
    let kind = fs::symlink_metadata(path).unwrap().file_type();
    let bytes = if kind.is_dir() {
        fs::read_dir(path).unwrap().for_each(|entry| add(&entry.unwrap().path(), found));
        Vec::new()
    } else if kind.is_symlink() {
        fs::read_link(path).unwrap().into_os_string().into_encoded_bytes()
    } else {
        fs::read(path).unwrap()
    };
    found.insert(path.to_owned(), bytes);
}

/// A program that behaves like POV-Ray, and is fast.
const FAKE_POVRAY: &str = "#!/bin/sh
case $1 in --version) echo 'POV-Ray 3.7.0' >&2; exit;; esac
for i in 0 1 2 3; do cp \"${0%/*}/image.png\" image0000$i.png; done
";

/// Returns a PNG of 1 × 1 pixel.
fn picture() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(&[1, 2, 3]).unwrap();
    bytes
}

/// A text in the place of a manifest that lists a file with a digest that it does not have.
fn manifest_with(home: &Home, folder: &str, names: &[&str]) {
    let path = home.path(folder).join("manifest.json");
    let text = fs::read_to_string(&path).unwrap();
    let zeros = "0".repeat(64);
    let entries: String = names
        .iter()
        .map(|name| format!("\n    {{ \"name\": \"{name}\", \"bytes\": 1, \"sha256\": \"{zeros}\" }},"))
        .collect();
    fs::write(path, text.replace("\"files\": [", &format!("\"files\": [{entries}"))).unwrap();
}

/// Replaces a file or folder of the project by a link. The target is a name in the home, or an absolute path.
fn link(home: &Home, name: &str, target: &str) {
    let path = home.path("project").join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    match fs::symlink_metadata(&path) {
        Ok(found) if found.is_dir() => fs::remove_dir_all(&path).unwrap(),
        Ok(_) => fs::remove_file(&path).unwrap(),
        Err(_) => {}
    }
    symlink(home.path(target), path).unwrap();
}

fn pipe(home: &Home, name: &str) {
    let path = home.path("project").join(name);
    let _ = fs::remove_file(&path);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

/// Puts a folder with a file into the place of a file.
fn folder(home: &Home, name: &str) {
    let path = home.path("project").join(name);
    let _ = fs::remove_file(&path);
    fs::create_dir_all(&path).unwrap();
    fs::write(path.join("x"), "x").unwrap();
}

type Shape = (&'static str, fn(&Home, &str));

/// What a stranger may put into a folder of scripts. The second argument is the folder, relative to the project.
const SHAPES: &[Shape] = &[
    ("assets.edited leads out", |home, at| {
        manifest_with(home, &format!("project/{at}"), &["assets/wood.png"]);
        fs::write(home.path("project").join(at).join("assets/wood.png"), "payload").unwrap();
        link(home, &format!("{at}/assets.edited"), "autostart");
    }),
    ("assets leads to keys, which are listed", |home, at| {
        manifest_with(home, &format!("project/{at}"), &["assets/authorized_keys"]);
        link(home, &format!("{at}/assets"), "ssh");
    }),
    ("assets and assets.edited lead out", |home, at| {
        manifest_with(home, &format!("project/{at}"), &["assets/authorized_keys", "assets/wood.png"]);
        link(home, &format!("{at}/assets"), "ssh");
        link(home, &format!("{at}/assets.edited"), "autostart");
    }),
    ("a link in assets leads out", |home, at| {
        manifest_with(home, &format!("project/{at}"), &["assets/deep/authorized_keys"]);
        link(home, &format!("{at}/assets/deep"), "ssh");
    }),
    ("the asset is a link", |home, at| link(home, &format!("{at}/assets/wood.png"), "notes.txt")),
    ("the asset is a dangling link", |home, at| {
        link(home, &format!("{at}/assets/wood.png"), "autostart/new");
    }),
    ("a file that is none of jabuka's is listed", |home, at| {
        manifest_with(home, &format!("project/{at}"), &["assets/thesis", "thesis.txt", ".bashrc"]);
        fs::write(home.path("project").join(at).join("thesis.txt"), "x").unwrap();
    }),
    ("names that lead out are listed", |home, at| {
        manifest_with(
            home,
            &format!("project/{at}"),
            &["../../../notes.txt", "/etc/passwd", "assets/../../x"],
        );
    }),
    ("a script is a link", |home, at| link(home, &format!("{at}/frame_0000.pov"), "notes.txt")),
    ("a listed script is a link", |home, at| {
        manifest_with(home, &format!("project/{at}"), &["frame_0000.pov"]);
        link(home, &format!("{at}/frame_0000.pov"), "notes.txt");
    }),
    ("the next name of an edited script is a link", |home, at| {
        manifest_with(home, &format!("project/{at}"), &["frame_0000.pov"]);
        fs::write(home.path("project").join(at).join("frame_0000.pov"), "payload").unwrap();
        link(home, &format!("{at}/frame_0000.edited.pov"), "autostart/new");
    }),
    ("a script is a hard link", |home, at| {
        let path = home.path("project").join(at).join("frame_0000.pov");
        fs::remove_file(&path).unwrap();
        fs::hard_link(home.path("notes.txt"), path).unwrap();
    }),
    ("the ini file is a hard link", |home, at| {
        let path = home.path("project").join(at).join("animation.ini");
        fs::remove_file(&path).unwrap();
        fs::hard_link(home.path("notes.txt"), path).unwrap();
    }),
    ("a script is a pipe", |home, at| pipe(home, &format!("{at}/frame_0000.pov"))),
    ("the lock is a link", |home, at| link(home, &format!("{at}/.jabuka-lock"), "notes.txt")),
    ("the lock is a dangling link", |home, at| link(home, &format!("{at}/.jabuka-lock"), "autostart/new")),
    ("the lock is a pipe", |home, at| pipe(home, &format!("{at}/.jabuka-lock"))),
    ("the lock is a folder", |home, at| folder(home, &format!("{at}/.jabuka-lock"))),
    ("the manifest is a link", |home, at| link(home, &format!("{at}/manifest.json"), "notes.txt")),
    ("the manifest is a pipe", |home, at| pipe(home, &format!("{at}/manifest.json"))),
    ("a temporary file is a link", |home, at| {
        link(home, &format!("{at}/.jabuka-manifest.json.tmp"), "notes.txt");
    }),
    ("a temporary file is a folder", |home, at| folder(home, &format!("{at}/.jabuka-manifest.json.tmp"))),
    ("a temporary file of an asset is a link", |home, at| {
        link(home, &format!("{at}/.jabuka-assets-wood.png.tmp"), "autostart/new");
    }),
    ("a script is a folder", |home, at| folder(home, &format!("{at}/frame_0001.pov"))),
    ("the asset is a pipe", |home, at| pipe(home, &format!("{at}/assets/wood.png"))),
    ("images lead out", |home, at| link(home, &format!("{at}/images"), "autostart")),
    ("images are a dangling link", |home, at| link(home, &format!("{at}/images"), "autostart/new")),
    ("the hidden folder leads out", |home, at| link(home, &format!("{at}/images/.jabuka"), "autostart")),
    ("leftovers lead out", |home, at| link(home, &format!("{at}/images/.jabuka/work-1-1"), "ssh")),
    ("failures lead out", |home, at| link(home, &format!("{at}/images/.jabuka/failed"), "autostart")),
    ("records are links", |home, at| {
        link(home, &format!("{at}/images/.jabuka/frame_0000.txt"), "notes.txt");
        link(home, &format!("{at}/images/.jabuka/povray"), "notes.txt");
    }),
    ("a record removes a file", |home, at| {
        let images = home.path("project").join(at).join("images");
        fs::create_dir_all(images.join(".jabuka")).unwrap();
        symlink(home.path("ssh/authorized_keys"), images.join("frame_0009.png")).unwrap();
        let record = "script x\nfiles -\noptions -\nframe -\npovray 3.7\nbytes 6\n";
        fs::write(images.join(".jabuka/frame_0009.txt"), record).unwrap();
        fs::write(images.join(".jabuka/x..txt"), record).unwrap();
    }),
    ("an image is a link", |home, at| link(home, &format!("{at}/images/frame_0000.png"), "notes.txt")),
    ("an image is a folder", |home, at| folder(home, &format!("{at}/images/frame_0000.png"))),
    ("the folder itself leads out", |home, at| link(home, at, "autostart")),
    ("the folder itself leads to the root", |home, at| link(home, at, "/")),
    ("the folder above leads out", |home, at| {
        let above = at.split('/').next().unwrap();
        link(home, above, "autostart");
    }),
];

/// Every command that writes, in a folder of every shape.
#[test]
fn a_folder_of_any_shape_changes_nothing_outside() {
    let povray = |home: &Home| home.path("bin/povray").display().to_string();
    let next = std::sync::atomic::AtomicUsize::new(0);
    let work = || {
        while let Some((name, shape)) = SHAPES.get(next.fetch_add(1, Ordering::Relaxed)) {
            for at in ["out/scene", "out/.still/scene", "job/scripts"] {
                let home = Home::new();
                home.forge();
                shape(&home, at);
                let before = home.outside();
                let povray = povray(&home);
                let commands: &[&[&str]] = match at {
                    "out/scene" => &[
                        &["compile", "scene.toml", "--check"],
                        &["render", "out/scene", "--povray", &povray],
                        &["batch", "out/scene", "--engine", "slurm", "-o", "copy"],
                        &["compile", "scene.toml", "--frames", "0"],
                        &["compile", "scene.toml"],
                        &["render", "scene.toml", "--povray", &povray],
                        &["status", "out/scene"],
                    ],
                    "out/.still/scene" => &[&["still", "scene.toml", "-o", "x.png", "--povray", &povray]],
                    _ => &[
                        &["batch", "out/scene", "--engine", "slurm", "-o", "job"],
                        &["batch", "scene.toml", "--engine", "slurm", "-o", "job"],
                        &["status", "job"],
                    ],
                };
                for command in commands {
                    home.run(command);
                    assert!(before == home.outside(), "{name}: {command:?} in {at}");
                }
                let copied = home.path("project/copy/scripts/assets/authorized_keys");
                assert!(!copied.exists(), "{name}: a key was copied");
            }
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
}

#[test]
fn a_folder_that_is_honest_is_written_again() {
    let home = Home::new();
    home.forge();
    for command in
        [&["compile", "scene.toml"][..], &["batch", "scene.toml", "--engine", "slurm", "-o", "job"]]
    {
        let output = home.run(command);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    // After that, edits are the user's own.
    let script = home.path("project/out/scene/frame_0001.pov");
    fs::write(&script, "mine").unwrap();
    let output = home.run(&["compile", "scene.toml"]);
    assert!(stderr(&output).contains("`frame_0001.pov` is now `frame_0001.edited.pov`"), "{output:?}");
    fs::write(home.path("project/job/local.conf"), "LIMIT=60\n").unwrap();
    let output = home.run(&["batch", "scene.toml", "--engine", "slurm", "-o", "job"]);
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn scripts_that_differ_in_a_folder_from_elsewhere_are_refused_by_name() {
    let home = Home::new();
    home.forge();
    let script = home.path("project/out/scene/frame_0001.pov");
    fs::write(&script, "payload").unwrap();
    for command in
        [&["compile", "scene.toml"][..], &["compile", "scene.toml", "--frames", "0", "--set", "title='x'"]]
    {
        let output = home.run(command);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("error[folder-not-ours]") && said.contains("`frame_0001.pov`"), "{said}");
    }
    assert_eq!(fs::read_to_string(&script).unwrap(), "payload");
    assert!(!home.path("project/out/scene/frame_0001.edited.pov").exists());
    // A manifest that fits the foreign scripts does not make jabuka render them.
    let manifest = home.path("project/out/scene/manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();
    let line = text.lines().find(|line| line.contains("frame_0001.pov")).unwrap();
    let payload = "{ \"name\": \"frame_0001.pov\", \"bytes\": 7, \"sha256\": \
                   \"239f59ed55e737c77147cf55ad0c1b030b6d7ee748a7426952f9b852d5a935e5\" }";
    fs::write(&manifest, text.replace(line.trim().trim_end_matches(','), payload)).unwrap();
    let povray = home.path("bin/povray").display().to_string();
    let output = home.run(&["render", "scene.toml", "--povray", &povray]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_ne!(fs::read_to_string(&script).unwrap(), "payload");
}

#[test]
fn files_of_a_job_from_elsewhere_are_refused_by_name_without_trust() {
    let batch = ["batch", "scene.toml", "--engine", "slurm", "-o", "job"];
    for name in ["local.conf", "render.sbatch", "video.sbatch", "template.yaml", "parameter_values.yaml"] {
        let home = Home::new();
        home.forge();
        let path = home.path("project/job").join(name);
        fs::write(&path, "POVRAY=/tmp/payload\n").unwrap();
        let output = home.run(&batch);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{name}: {said}");
        assert!(said.contains("error[folder-not-ours]") && said.contains(&format!("`{name}`")), "{said}");
        assert!(said.contains("--trust"), "{said}");
        let trusted = home.run(&[&batch[..], &["--trust"]].concat());
        assert!(trusted.status.success(), "{}", stderr(&trusted));
        assert_eq!(fs::read_to_string(&path).unwrap(), "POVRAY=/tmp/payload\n");
        // The folder has been looked at. From now on it counts as the user's own.
        assert!(home.run(&batch).status.success());
    }
}

#[test]
fn a_job_with_links_where_its_scripts_write_is_refused() {
    for name in
        ["logs", "images", "images/.jabuka", "images/.jabuka/running", "images/.jabuka/running/frame_0000"]
    {
        let home = Home::new();
        home.forge();
        link(&home, &format!("job/{name}"), "autostart");
        let before = home.outside();
        let output = home.run(&["batch", "scene.toml", "--engine", "slurm", "-o", "job"]);
        assert_eq!(output.status.code(), Some(1), "{name}");
        assert!(stderr(&output).contains("error[link]"), "{name}: {}", stderr(&output));
        assert!(before == home.outside(), "{name}");
    }
}

#[test]
fn a_folder_or_file_that_the_user_names_is_no_link() {
    let home = Home::new();
    fs::create_dir(home.path("empty")).unwrap();
    link(&home, "to", "empty");
    let absolute = home.path("project/to").display().to_string();
    let povray = home.path("bin/povray").display().to_string();
    for command in [
        &["compile", "scene.toml", "-o", "to"][..],
        &["compile", "scene.toml", "-o", "to/"],
        &["compile", "scene.toml", "-o", "to/below"],
        &["compile", "scene.toml", "-o", &absolute],
        &["batch", "scene.toml", "--engine", "slurm", "-o", "to"],
        &["render", "scene.toml", "--povray", &povray, "-o", "to"],
        &["render", "scene.toml", "--povray", &povray, "--contact-sheet", "to/sheet.png"],
        &["still", "scene.toml", "--povray", &povray, "-o", "to/x.png"],
        &["export", "scene.toml", "-o", "to/x.csv"],
        &["export", "scene.toml", "-o", "to/x.glb"],
        &["report", "scene.toml", "--plot", "to/x.svg"],
        &["average", "-o", "to/x.png", "../bin/image.png"],
        &["new", "to/x"],
        &["templates", "to"],
    ] {
        let output = home.run(command);
        assert_eq!(output.status.code(), Some(1), "{command:?}: {output:?}");
        assert!(stderr(&output).contains("is a link, which is not followed"), "{command:?}: {output:?}");
        assert_eq!(fs::read_dir(home.path("empty")).unwrap().count(), 0, "{command:?}");
    }
    // The folders above an absolute path are those of the user and the system. A file that is a link is replaced.
    let below = format!("{absolute}/below");
    assert!(home.run(&["compile", "scene.toml", "-o", &below]).status.success());
    link(&home, "x.csv", "notes.txt");
    assert!(home.run(&["export", "scene.toml", "-o", "x.csv"]).status.success());
    assert_eq!(fs::read_to_string(home.path("notes.txt")).unwrap(), "years of work");
}

/// Another program swaps folders and links in the very moment in which jabuka works in them.
#[test]
fn a_link_that_appears_in_between_is_not_followed() {
    let home = Home::new();
    home.forge();
    let before = home.outside();
    let stop = AtomicBool::new(false);
    let at = |name: &str| home.path("project/out/scene").join(name);
    let swap = || {
        while !stop.load(Ordering::Relaxed) {
            for (name, target) in [("assets", "ssh"), ("images", "autostart"), ("assets.edited", "autostart")]
            {
                let _ = fs::rename(at(name), at("aside"));
                let _ = symlink(home.path(target), at(name));
                std::thread::yield_now();
                let _ = fs::remove_file(at(name));
                let _ = fs::rename(at("aside"), at(name));
            }
        }
    };
    let povray = home.path("bin/povray").display().to_string();
    std::thread::scope(|scope| {
        scope.spawn(swap);
        for _ in 0..15 {
            home.run(&["compile", "scene.toml"]);
            home.run(&["render", "scene.toml", "--povray", &povray]);
        }
        stop.store(true, Ordering::Relaxed);
    });
    assert!(before == home.outside());
}

/// A template whose mistake shows in a later frame only.
#[test]
fn a_mistake_in_a_template_leaves_no_folder() {
    let home = Home::new();
    home.run(&["templates", "mine"]);
    let template = home.path("project/mine/frame.pov");
    let text = fs::read_to_string(&template).unwrap();
    let povray = home.path("bin/povray").display().to_string();
    for mistake in ["${ no_such_value }", "<% if frame == 1 %>${ no_such_value }<% endif %>"] {
        fs::write(&template, format!("{text}\n{mistake}\n")).unwrap();
        for command in [
            &["compile", "scene.toml", "--templates", "mine", "--trust"][..],
            &["render", "scene.toml", "--templates", "mine", "--trust", "--povray", &povray],
            &[
                "still",
                "scene.toml",
                "--templates",
                "mine",
                "--trust",
                "-o",
                "x.png",
                "--time",
                "0.04",
                "--povray",
                &povray,
            ],
            &["batch", "scene.toml", "--templates", "mine", "--trust", "--engine", "slurm", "-o", "job"],
        ] {
            let output = home.run(command);
            assert_eq!(output.status.code(), Some(1), "{command:?}: {output:?}");
            for name in ["out", "job", "x.png"] {
                assert!(!home.path("project").join(name).exists(), "{command:?}, {mistake}: {name}");
            }
        }
    }
}
