//! A job folder for tests, and helpers that run its commands and read its files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use super::support::{jabuka, stderr, stdout};

/// A temporary folder with a job. Its path contains a space and a non-ASCII letter.
pub(crate) struct Job {
    folder: tempfile::TempDir,
}

/// Returns the text of a scene with one moving ball and this number of small frames.
pub(crate) fn scene(frames: usize) -> String {
    format!(
        "[simulation]\nduration = {}\nframe_rate = 25\n[output]\nsize = [65, 37]\n\
         [body.ball]\nshape.sphere.radius = 0.5\nvelocity = [1, 0, 0]\n",
        (frames - 1) as f64 / 25.0
    )
}

impl Job {
    /// Writes a scene and its job with `jabuka batch`, and asserts success.
    pub(crate) fn new(scene: &str, arguments: &[&str]) -> Job {
        let job = Job { folder: tempfile::Builder::new().prefix("a jöb ").tempdir().unwrap() };
        let output = job.batch(scene, arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        job
    }

    /// Writes the scene and runs `jabuka batch` on it again, into the same job folder. Returns the output of the command.
    pub(crate) fn batch(&self, scene: &str, arguments: &[&str]) -> Output {
        let path = self.folder.path().join("x.toml");
        fs::write(&path, scene).unwrap();
        jabuka().arg("batch").arg(&path).arg("-o").arg(self.path()).args(arguments).output().unwrap()
    }

    pub(crate) fn path(&self) -> PathBuf {
        self.folder.path().join("the job")
    }

    pub(crate) fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path().join(name)
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Returns a command that runs the script of this name in the job folder.
    pub(crate) fn command(&self, name: &str) -> Command {
        let mut command = Command::new(self.join(name));
        // Run it from another directory and in a fixed locale, to show that it depends on neither.
        command.current_dir(self.folder.path()).env("LC_ALL", "C.UTF-8").env_remove("POVRAY");
        command
    }

    pub(crate) fn chunk(&self, arguments: &[&str]) -> Output {
        self.command("render-chunk").args(arguments).output().unwrap()
    }

    /// Returns the frames that `render-chunk --missing` lists, as text such as `1,3-5`.
    pub(crate) fn missing(&self) -> String {
        let output = self.chunk(&["--missing"]);
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output).trim_end().to_owned()
    }

    /// Returns the output of `jabuka status`, and true if the command reports that everything is done.
    pub(crate) fn status(&self) -> (String, bool) {
        let output = jabuka().arg("status").arg(self.path()).output().unwrap();
        assert_eq!(stderr(&output), "");
        (stdout(&output), output.status.success())
    }

    /// Returns the frames that are being rendered, from the JSON output of `jabuka status`.
    pub(crate) fn running(&self) -> Vec<u64> {
        let output = jabuka().args(["status", "--format", "json"]).arg(self.path()).output().unwrap();
        let status: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        let running = status["running"].as_array().unwrap();
        running.iter().map(|running| running["frame"].as_u64().unwrap()).collect()
    }

    /// Replaces the line of the ball in a frame's script by invalid SDL. Returns the number of that line.
    pub(crate) fn break_frame(&self, frame: usize) -> usize {
        let path = self.join(format!("scripts/frame_{frame:04}.pov"));
        let text = fs::read_to_string(&path).unwrap();
        let line = text.lines().position(|line| line.ends_with("// ball")).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let broken = [&lines[..line], &["sphere { <0, 0, 0>, oops } // ball"], &lines[line + 1..]].concat();
        fs::write(&path, broken.join("\n") + "\n").unwrap();
        line + 1
    }

    /// Returns the names of the PNG images of the job, sorted.
    pub(crate) fn images(&self) -> Vec<String> {
        names(&self.join("images")).into_iter().filter(|name| name.ends_with(".png")).collect()
    }

    /// Returns the names of all temporary files in the hidden folder of the images: everything but the records of images and film.
    pub(crate) fn leftovers(&self) -> Vec<String> {
        let hidden = self.join("images/.jabuka");
        let mut found = Vec::new();
        for name in names(&hidden) {
            match name.as_str() {
                "running" | "failed" => found.extend(names(&hidden.join(&name))),
                name if name.starts_with("frame_") || name == "film.txt" => {}
                _ => found.push(name),
            }
        }
        found
    }
}

/// Returns the names of the entries of a folder, sorted.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Waits until a condition is true, and panics after the time limit. `what` names the condition in the panic's message.
pub(crate) fn wait_until(what: &str, limit: Duration, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < limit, "after {limit:?} still not: {what}");
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Returns the number of frames of a film, and its size and pixel format as ffprobe prints them.
pub(crate) fn film(path: &Path) -> (usize, String) {
    let show = ["-v", "error", "-count_frames", "-select_streams", "v", "-show_entries"];
    let what = "stream=nb_read_frames,pix_fmt,width,height";
    let probe = Command::new("ffprobe").args(show).args([what, "-of", "csv=p=0"]).arg(path).output().unwrap();
    let text = stdout(&probe);
    let (format, frames) = text.trim().rsplit_once(',').unwrap_or_else(|| panic!("{}", stderr(&probe)));
    (frames.parse().unwrap(), format.to_owned())
}
