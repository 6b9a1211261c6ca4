//! Makes films, and reads their properties with ffprobe and ffmpeg.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use jabuka::render::{Film, FilmError};
use jabuka::sandbox::{Confinement, Launcher};

/// Returns the confinement of ffmpeg in tests, the same that the command uses.
pub(crate) fn confined() -> Confinement {
    Confinement::new(Some(Launcher::new(env!("CARGO_BIN_EXE_jabuka"))))
}

/// Makes a film, and returns the error if it fails.
pub(crate) fn try_make(path: &Path, images: &[PathBuf], rate: f64) -> Result<(), FilmError> {
    let film = Film::new(path)?;
    let ffmpeg =
        film.check(None, confined()).unwrap_or_else(|error| panic!("{error}: tests/run installs it"));
    film.make(images, rate, &ffmpeg, &|| false, &|_| {})
}

/// Makes a film, and asserts success.
pub(crate) fn make(path: &Path, images: &[PathBuf], rate: f64) {
    try_make(path, images, rate).unwrap_or_else(|error| panic!("{error}"));
}

/// Returns the given fields of a film's video stream, in the order of ffprobe.
pub(crate) fn stream(film: &Path, fields: &str) -> String {
    let entries = format!("stream={fields}");
    let arguments = ["-count_frames", "-show_entries", &entries, "-of", "default=nw=1"];
    let output = run(Command::new("ffprobe").args(["-v", "error"]).args(arguments).arg(film));
    String::from_utf8(output.stdout).unwrap().trim().replace('\n', " ")
}

/// Returns the durations of a film's frames, in units of its time base.
pub(crate) fn durations(film: &Path) -> Vec<u32> {
    let arguments = ["-v", "error", "-show_entries", "packet=duration", "-of", "csv=p=0"];
    let output = run(Command::new("ffprobe").args(arguments).arg(film));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| line.trim_end_matches(',').parse().unwrap()).collect()
}

/// Returns all pixels of a film as ffmpeg decodes them.
pub(crate) fn pixels(film: &Path, format: &str) -> Vec<u8> {
    let arguments = ["-f", "rawvideo", "-pix_fmt", format, "-fps_mode", "passthrough", "-"];
    run(Command::new("ffmpeg").args(["-v", "error", "-nostdin", "-i"]).arg(film).args(arguments)).stdout
}

fn run(command: &mut Command) -> Output {
    let output =
        command.output().unwrap_or_else(|error| panic!("{command:?}: {error}: tests/run installs it"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    output
}
