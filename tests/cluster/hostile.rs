//! Names and texts that contain shell commands must reach a job unchanged, and must never be executed.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use sha2::{Digest, Sha256};

use super::job::{Job, names, scene};
use super::support::{jabuka, root, stderr, stdout};

/// The file that exists if a shell has executed one of the hostile names.
const MARK: &str = "PWNED";

/// The name of the hostile scene file, without `.toml`. It holds shell commands, placeholders of templates, and control characters.
pub(crate) const SCENE_NAME: &str =
    "-film@files@$(touch PWNED)`touch PWNED`';touch PWNED;'\"x@options@\n{{Param.Frames}}, \u{202e}\u{1b}[2J";

/// Returns the text of a scene whose title, body and asset have hostile names.
pub(crate) fn hostile_scene(frames: usize) -> String {
    let shell = "$(touch PWNED)`touch PWNED`';touch PWNED;'@options@ # \\u001b[2J\\u202e";
    format!(
        "title = \"{shell}\\n#include x\"\n[povray]\nassets = [\"a$(touch PWNED)`touch PWNED`;'@files@.png\"]\n{}",
        scene(frames).replace("[body.ball]", &format!("[body.\"{shell}\"]"))
    )
}

/// Writes the hostile scene, its asset and its job into a folder. Returns the path of the job folder and the output of `jabuka batch`.
pub(crate) fn hostile_job(folder: &Path, frames: usize, arguments: &[&str]) -> (PathBuf, String) {
    let scene = folder.join(format!("{SCENE_NAME}.toml"));
    fs::write(&scene, hostile_scene(frames)).unwrap();
    let asset = folder.join("a$(touch PWNED)`touch PWNED`;'@files@.png");
    fs::copy(root().join("docs/projectile.png"), asset).unwrap();
    let output = jabuka().current_dir(folder).arg("batch").arg(&scene).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    (folder.join("out").join(format!("{SCENE_NAME}-job")), stdout(&output))
}

/// Asserts that this folder and its subfolders contain no [`MARK`] file, so that no hostile name was executed.
pub(crate) fn assert_nothing_was_run(folder: &Path) {
    for name in names(folder) {
        assert_ne!(name, MARK, "in {}", folder.display());
        let path = folder.join(name);
        if fs::symlink_metadata(&path).unwrap().is_dir() {
            assert_nothing_was_run(&path);
        }
    }
    assert!(!root().join(MARK).exists());
}

/// Returns the names of the files in a job folder that bash runs or sources.
fn scripts_of_bash(job: &Path) -> Vec<String> {
    let of_bash = |name: &String| {
        let text = fs::read(job.join(name)).unwrap_or_default();
        text.starts_with(b"#!/") || name.ends_with(".sh")
    };
    names(job).into_iter().filter(of_bash).collect()
}

#[test]
fn shellcheck_finds_nothing_in_any_file_of_a_job() {
    let folder = tempfile::tempdir().unwrap();
    let plain = Job::new(&scene(2), &["--engine", "slurm", "--modules", "povray ffmpeg"]);
    for (engine, files) in [("openjd", 3), ("slurm", 6)] {
        let (hostile, _) = hostile_job(folder.path(), 2, &["--engine", engine, "--partition=@modules@"]);
        for job in [plain.path(), hostile] {
            let scripts = scripts_of_bash(&job);
            assert!(scripts.len() >= files, "{scripts:?}");
            let output =
                Command::new("shellcheck").arg("--norc").args(scripts).current_dir(&job).output().unwrap();
            assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
        }
    }
}

#[test]
fn a_hostile_scene_is_rendered_and_nothing_in_it_is_run() {
    let folder = tempfile::tempdir().unwrap();
    let (job, said) = hostile_job(folder.path(), 2, &["--engine", "slurm"]);
    // The commands that `jabuka batch` suggests must work as printed.
    assert!(!said.chars().any(|c| c == '\u{202e}' || c.is_control() && c != '\n'), "{said}");
    let command = said.lines().find_map(|line| line.strip_prefix("send      ")).unwrap();
    let render =
        command.replace("./submit", "./render-chunk 0-1 && ./render-video && ./render-chunk --missing");
    let output = Command::new("bash").args(["-c", &render]).current_dir(&folder).output().unwrap();
    assert!(output.status.success(), "{render}\n{}{}", stdout(&output), stderr(&output));
    assert!(job.join("film.mp4").exists());
    let watch = said.lines().find_map(|line| line.strip_prefix("watch     jabuka ")).unwrap();
    let watch = format!("{} {watch}", env!("CARGO_BIN_EXE_jabuka"));
    let output = Command::new("bash").args(["-c", &watch]).current_dir(&folder).output().unwrap();
    assert_eq!(stdout(&output), "done     2 of 2\nfilm     made\n", "{watch}: {}", stderr(&output));
    assert_nothing_was_run(folder.path());
}

#[test]
fn a_forged_manifest_puts_no_line_into_the_settings() {
    let job = Job::new(&scene(2), &["--engine", "slurm"]);
    let folder = tempfile::tempdir().unwrap();
    let (scripts, forged) = (job.join("scripts"), folder.path().join("forged"));
    let copied = Command::new("cp").arg("-r").arg(&scripts).arg(&forged).status().unwrap();
    assert!(copied.success());
    let manifest = fs::read_to_string(forged.join("manifest.json")).unwrap();
    let forge = |scene: &str| {
        let forged = manifest.replace("\"scene\": \"x\"", &format!("\"scene\": \"{scene}\""));
        assert_ne!(forged, manifest);
        forged
    };
    for scene in ["@files@", "x\\nPOVRAY=touch", "$(touch PWNED)", "x@options@"] {
        fs::write(forged.join("manifest.json"), forge(scene)).unwrap();
        let mut command = jabuka();
        command.args(["batch", "--engine", "slurm"]).arg(&forged).arg("-o").arg(folder.path().join("job"));
        assert!(command.status().unwrap().success());
        let (new, old) =
            (fs::read_to_string(folder.path().join("job/job.conf")).unwrap(), job.read("job.conf"));
        let but_the_name = |text: &str| text.lines().filter(|line| !line.starts_with("JOB=")).count();
        assert_eq!(but_the_name(&new), but_the_name(&old), "{new}");
        let output = Command::new(folder.path().join("job/render-chunk")).arg("--missing").output().unwrap();
        assert_eq!(stdout(&output), "0-1\n", "{}", stderr(&output));
    }
    // The settings file cannot hold a file name that contains a line break.
    fs::create_dir(forged.join("assets")).unwrap();
    fs::write(forged.join("assets/a\nPOVRAY=touch"), "x").unwrap();
    let mut command = jabuka();
    command.args(["batch", "--engine", "slurm"]).arg(&forged).arg("-o").arg(folder.path().join("other"));
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains(r"assets/a\nPOVRAY=touch"), "{}", stderr(&output));
    assert!(!folder.path().join("other").exists());
    assert_nothing_was_run(folder.path());
}

#[test]
fn options_of_the_engine_are_words() {
    let toml = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    fs::write(toml.path(), scene(2)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for option in ["--partition", "--account", "--time", "--mem", "--modules"] {
        for value in
            ["$(touch PWNED)", "`x`", "a;b", "a\nb", "-x", "", "a 'b", "a --wrap=x", "*", "~", "\u{202e}"]
        {
            let mut command = jabuka();
            command
                .args(["batch", "--engine", "slurm"])
                .arg(toml.path())
                .arg("-o")
                .arg(folder.path().join("job"));
            let output = command.arg(format!("{option}={value}")).output().unwrap();
            // A leading dash is part of the value; Slurm decides whether the value is valid.
            let harmless = value == "-x" && option != "--modules";
            assert_eq!(output.status.code(), Some(if harmless { 0 } else { 2 }), "{option}={value}");
            assert!(!stderr(&output).contains('\u{202e}'));
        }
    }
}

#[test]
fn another_users_comment_in_the_queue_is_not_run() {
    let job = Job::new(&scene(2), &["--engine", "slurm"]);
    // Bash arithmetic would execute the command in these numbers. They come from files that the comment of the queued job points to.
    fs::write(job.join("evil"), "0+LINENO[$(touch PWNED)]\n").unwrap();
    fs::create_dir_all(job.join("logs")).unwrap();
    fs::write(job.join("logs/chunks-7.txt"), "0+LINENO[$(touch PWNED)]\n").unwrap();
    let path = fs::canonicalize(job.path()).unwrap();
    let digest: String = Sha256::digest(path.as_os_str().as_encoded_bytes())
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    let bin = tempfile::tempdir().unwrap();
    let stand_in = |name: &str, text: &str| {
        let path = bin.path().join(name);
        fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    };
    let comment = format!("jabuka:{}", &digest[..12]);
    stand_in(
        "squeue",
        &format!(
            "cat <<'EOF'\n7|0|RUNNING|{comment} ../evil\n8|0|RUNNING|{comment} chunks-7.txt\n\
             a[$(touch PWNED)]|0|RUNNING|{comment} film\nEOF"
        ),
    );
    stand_in("scontrol", "exit 1");
    stand_in("sbatch", "echo 9");
    let path = format!("{}:{}", bin.path().display(), std::env::var("PATH").unwrap());
    let output = job.command("submit").env("PATH", path).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("sent 2 frames in 1 chunk: job 9\n"), "{}", stdout(&output));
    assert_nothing_was_run(&job.path());
}

#[test]
fn an_image_of_which_a_byte_has_changed_is_found_and_not_copied() {
    let still = scene(4).replace("velocity = [1, 0, 0]", "");
    let job = Job::new(&still, &["--engine", "slurm"]);
    assert!(job.chunk(&["0", "3"]).status.success());
    assert!(job.command("render-video").status().unwrap().success());
    let good = fs::read(job.join("images/frame_0000.png")).unwrap();
    let damage = |frame: usize| {
        let mut bytes = good.clone();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(job.join(format!("images/frame_{frame:04}.png")), bytes).unwrap();
    };
    let verified = || {
        let output = jabuka().args(["status", "--verify"]).arg(job.path()).output().unwrap();
        (stdout(&output), output.status.code())
    };
    let whole = ("done     4 of 4\nfilm     made\n".to_owned(), Some(0));
    assert_eq!(verified(), whole);
    damage(1);
    damage(2);
    assert_eq!((job.missing().as_str(), job.status().1), ("", true), "the quick way does not read images");
    let changed = "done     2 of 4\nchanged  2: 1-2, since they were rendered\nfilm     made\n";
    assert_eq!(verified(), (changed.to_owned(), Some(1)));

    // A frame whose script equals that of a damaged image is rendered, not copied from the damaged image.
    fs::remove_file(job.join("images/frame_0003.png")).unwrap();
    let before = fs::metadata(job.join("images/frame_0002.png")).unwrap().ino();
    assert!(stdout(&job.chunk(&["3"])).contains("frame_0003 rendered in"));
    assert!(verified().0.starts_with("done     2 of 4\nchanged  2: 1-2,"), "{}", verified().0);
    assert_eq!(fs::metadata(job.join("images/frame_0002.png")).unwrap().ino(), before);

    let output = job.chunk(&["--verify"]);
    assert_eq!((stdout(&output).as_str(), output.status.code()), ("1-2\n", Some(0)));
    assert_eq!(job.missing(), "1-2");
    assert!(job.chunk(&["0", "3"]).status.success());
    assert_eq!(stdout(&job.chunk(&["--verify"])), "");
    assert_eq!(verified().0, "done     4 of 4\nfilm     not made\n", "the film was made of damaged images");

    // Write the record in the format of an earlier version, which had no digest of the image.
    let record = job.read("images/.jabuka/frame_0001.txt");
    let old: String = record.split_inclusive('\n').take(6).collect();
    fs::write(job.join("images/.jabuka/frame_0001.txt"), old).unwrap();
    assert_eq!(job.missing(), "");
    assert!(verified().0.contains("\nunverified 1: 1, whose records have no digest\n"), "{}", verified().0);
}
