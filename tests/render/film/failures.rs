//! Tests of failures while a film is made: each has a clear message, and an existing film is kept.

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use jabuka::render::{Film, FilmError};

use super::images::{plain, sequence};
use super::probe::{confined, make, try_make};

/// Returns the sorted names of a folder's files, except for the images.
fn others(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.filter(|name| !name.ends_with(".png")).collect();
    names.sort();
    names
}

/// Writes a stand-in for ffmpeg: a shell script that passes the check of version and encoder, and then runs `script`.
fn stand_in(folder: &Path, script: &str) -> PathBuf {
    let path = folder.join("ffmpeg.sh");
    let check = "case $1 in -version) echo ffmpeg version 0.0 x; exit;; esac\n\
                 case \"$*\" in *encoder=*) echo Encoder x; exit;; esac\n";
    fs::write(&path, format!("#!/bin/sh\n{check}{script}\n")).unwrap();
    fs::set_permissions(&path, Permissions::from_mode(0o755)).unwrap();
    path
}

/// Makes a film with a stand-in for ffmpeg where an older film exists. Asserts that a failure keeps only the older film.
fn make_by(script: &str, cancelled: &dyn Fn() -> bool) -> Result<(), FilmError> {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 5, (640, 480));
    let film = Film::new(folder.path().join("film.mp4")).unwrap();
    fs::write(film.path(), "yesterday's").unwrap();
    let ffmpeg = film.check(Some(&stand_in(folder.path(), script)), confined()).unwrap();
    let result = film.make(&images, 25.0, &ffmpeg, cancelled, &|_| {});
    if result.is_err() {
        assert_eq!(others(folder.path()), ["ffmpeg.sh", "film.mp4"]);
        assert_eq!(fs::read_to_string(film.path()).unwrap(), "yesterday's");
    }
    result
}

#[test]
fn a_failing_ffmpeg_is_quoted_by_its_last_lines() {
    let script =
        "cat >/dev/null; yes 'a line of noise' | head -n 200000 >&2; echo 'Out of pixels' >&2; exit 3";
    let error = make_by(script, &|| false).unwrap_err().to_string();
    assert!(error.contains("film.mp4`: it ended with code 3, and said last:\n"), "{error}");
    assert!(error.ends_with("  a line of noise\n  Out of pixels"), "{error}");
    assert!(error.len() < 1000, "{error}");
    // The stand-in ends without reading its input.
    let error = make_by("exit 4", &|| false).unwrap_err().to_string();
    assert!(error.ends_with("film.mp4`: it ended with code 4 without a word"), "{error}");
    let error = make_by("kill -9 $$", &|| false).unwrap_err().to_string();
    assert!(error.ends_with("film.mp4`: it was killed by signal 9 without a word"), "{error}");
}

#[test]
fn a_full_disk_is_called_so() {
    let script = "cat >/dev/null; echo 'av_interleaved_write_frame(): No space left on device' >&2; exit 1";
    let error = make_by(script, &|| false).unwrap_err();
    assert!(matches!(error, FilmError::DiskFull(_)), "{error}");
}

#[test]
fn a_film_whose_last_bytes_are_not_written_is_none_whatever_ffmpeg_says() {
    // Run real ffmpeg with a limit of 2 kB or 4 kB on the size of its output file, depending on the shell.
    let script = "trap '' XFSZ; ulimit -f 4; exec ffmpeg \"$@\"";
    let error = make_by(script, &|| false).unwrap_err().to_string();
    assert!(error.contains("File too large"), "{error}");
    // Real ffmpeg has ended with success after this message.
    let script =
        "cat >/dev/null; echo frame=5; echo 'Error writing trailer of file:x: No space left on device' >&2";
    let error = make_by(script, &|| false).unwrap_err();
    assert!(matches!(error, FilmError::DiskFull(_)), "{error}");
}

#[test]
fn a_film_that_lacks_frames_is_none() {
    let script = "cat >/dev/null; printf 'frame=4\\nprogress=end\\n'";
    let error = make_by(script, &|| false).unwrap_err().to_string();
    assert!(error.starts_with("ffmpeg made 4 frames of 5 images for `"), "{error}");
    assert!(make_by(&script.replace('4', "5"), &|| false).is_ok());
}

#[test]
fn who_asks_to_stop_is_obeyed_at_once_also_where_ffmpeg_has_started_others() {
    let start = Instant::now();
    let error =
        make_by("sleep 30 & sleep 30; exit 0", &|| start.elapsed() > Duration::from_millis(200)).unwrap_err();
    assert!(matches!(error, FilmError::Cancelled), "{error}");
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

#[test]
fn a_real_ffmpeg_is_stopped_too() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 1, (640, 480));
    let film = Film::new(folder.path().join("film.webm")).unwrap();
    let ffmpeg = film.check(None, confined()).unwrap();
    let start = Instant::now();
    let cancelled = || start.elapsed() > Duration::from_millis(300);
    let error = film.make(&vec![images[0].clone(); 100_000], 25.0, &ffmpeg, &cancelled, &|_| {}).unwrap_err();
    assert!(matches!(error, FilmError::Cancelled), "{error}");
    assert_eq!(others(folder.path()), [""; 0]);
}

#[test]
fn a_missing_ffmpeg_is_told_early_with_how_to_install_it() {
    let film = Film::new("film.mp4").unwrap();
    let error = film.check(Some(Path::new("no/ffmpeg")), confined()).unwrap_err();
    let message = "ffmpeg, which makes films, cannot be used: `no/ffmpeg`: there is no such program";
    assert_eq!(error.to_string(), message);
    let help = error.help().unwrap();
    assert!(
        ["apt install ffmpeg", "brew install ffmpeg", "dnf install ffmpeg"].iter().all(|c| help.contains(c))
    );
    let error = film.check(Some(Path::new("true")), confined()).unwrap_err().to_string();
    assert!(error.ends_with("`true`: it is no ffmpeg, for it does not tell its version"), "{error}");
}

#[test]
fn a_path_without_ffmpeg_has_none() {
    // Set `PATH` for a new process only, as changing it in this one would affect other tests.
    let me = std::env::current_exe().unwrap();
    let arguments = ["--exact", "film::failures::finds_no_ffmpeg", "--ignored"];
    let output = Command::new(me).args(arguments).env("PATH", "").output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("1 passed"), "{said}");
}

#[test]
#[ignore = "the test before runs it where there is no ffmpeg"]
fn finds_no_ffmpeg() {
    let error = Film::new("film.mp4").unwrap().check(None, confined()).unwrap_err();
    assert!(error.to_string().ends_with("`ffmpeg`: there is no such program"), "{error}");
}

#[test]
fn an_ffmpeg_without_the_encoder_is_told_early() {
    let folder = tempfile::tempdir().unwrap();
    let poor = stand_in(folder.path(), "");
    let script =
        fs::read_to_string(&poor).unwrap().replace("echo Encoder x", "echo \"Codec 'x' is not recognized\"");
    fs::write(&poor, script).unwrap();
    for (name, encoder) in [("film.mp4", "libx264"), ("film.webm", "libvpx-vp9"), ("film.gif", "gif")] {
        let error = Film::new(name).unwrap().check(Some(&poor), confined()).unwrap_err().to_string();
        assert!(error.ends_with(&format!("was built without the encoder `{encoder}`")), "{error}");
    }
}

#[test]
fn images_that_cannot_make_a_film_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    plain(&path("a.png"), (640, 480), [9; 3]);
    plain(&path("b.png"), (640, 482), [9; 3]);
    let whole = fs::read(path("a.png")).unwrap();
    fs::write(path("cut.png"), &whole[..whole.len() / 2]).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    fs::write(path("flipped.png"), flipped).unwrap();
    fs::write(path("text.png"), "not an image").unwrap();
    fs::write(path("empty.png"), "").unwrap();
    let said = |names: &[&str]| {
        let images: Vec<_> = names.iter().map(|name| path(name)).collect();
        let error = try_make(&path("film.mp4"), &images, 25.0).unwrap_err().to_string();
        assert_eq!(others(folder.path()), [""; 0]);
        error.replace(&format!("{}/", folder.path().display()), "")
    };
    assert_eq!(said(&[]), "there are no images to show");
    assert_eq!(
        said(&["a.png", "a.png", "b.png"]),
        "the images differ in size: `a.png` has 640 × 480 pixels, and `b.png` has 640 × 482"
    );
    for (name, why) in [
        ("missing.png", "No such file"),
        ("cut.png", ""),
        ("flipped.png", ""),
        ("text.png", "Invalid PNG signature"),
        ("empty.png", "it ends too early"),
    ] {
        let error = said(&["a.png", name]);
        assert!(error.starts_with(&format!("the image `{name}` cannot be read: {why}")), "{error}");
    }
}

#[test]
fn rates_that_no_film_has_are_refused() {
    for rate in [0.0, -25.0, f64::NAN, f64::INFINITY, 5e17, 3e-7] {
        let error = try_make(Path::new("film.mp4"), &[], rate).unwrap_err();
        assert!(matches!(error, FilmError::Rate(_)), "{error}");
        assert!(
            error.to_string().starts_with("a film shows from 0.01 to 1000 frames a second, not "),
            "{error}"
        );
    }
}

#[test]
fn where_no_file_can_be_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 1, (16, 16));
    fs::create_dir(folder.path().join("folder.mp4")).unwrap();
    let error = try_make(&folder.path().join("folder.mp4"), &images, 25.0).unwrap_err();
    assert!(matches!(error, FilmError::Folder(_)), "{error}");
    // A superuser may write into every folder, but nobody can write below a file.
    let below = images[0].join("film.mp4");
    let error = try_make(&below, &images, 25.0).unwrap_err();
    assert!(matches!(&error, FilmError::Io(path, _) if *path == below), "{error}");
}

#[test]
fn what_a_killed_run_has_left_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 1, (16, 16));
    fs::write(folder.path().join(".jabuka-film.mp4.tmp"), "half of a film").unwrap();
    let film = folder.path().join("film.mp4");
    make(&film, &images, 25.0);
    assert_eq!(others(folder.path()), ["film.mp4"]);
}

#[test]
fn two_do_not_write_one_film() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 1, (16, 16));
    let busy = fs::File::create(folder.path().join(".jabuka-film.mp4.tmp")).unwrap();
    busy.lock().unwrap();
    let film = folder.path().join("film.mp4");
    let error = try_make(&film, &images, 25.0).unwrap_err();
    assert!(matches!(error, FilmError::Locked(_)), "{error}");
    drop(busy);
    make(&film, &images, 25.0);
}
