//! A job folder for a test, and what is done with it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use super::support::{jabuka, stderr, stdout};

/// A job folder; its path has a space and a letter beyond ASCII.
pub(crate) struct Job {
    folder: tempfile::TempDir,
}

/// A ball that flies, in so many small frames.
pub(crate) fn scene(frames: usize) -> String {
    format!(
        "[simulation]\nduration = {}\nframe_rate = 25\n[output]\nsize = [65, 37]\n\
         [body.ball]\nshape.sphere.radius = 0.5\nvelocity = [1, 0, 0]\n",
        (frames - 1) as f64 / 25.0
    )
}

impl Job {
    /// The job of a scene.
    pub(crate) fn new(scene: &str, arguments: &[&str]) -> Job {
        let job = Job { folder: tempfile::Builder::new().prefix("a jöb ").tempdir().unwrap() };
        let output = job.batch(scene, arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        job
    }

    /// Writes the job, again, of a scene.
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

    /// A command of the folder.
    pub(crate) fn command(&self, name: &str) -> Command {
        let mut command = Command::new(self.join(name));
        // Another folder than that of the job, and another language than ours.
        command.current_dir(self.folder.path()).env("LC_ALL", "C.UTF-8").env_remove("POVRAY");
        command
    }

    pub(crate) fn chunk(&self, arguments: &[&str]) -> Output {
        self.command("render-chunk").args(arguments).output().unwrap()
    }

    /// The frames that `render-chunk` finds missing.
    pub(crate) fn missing(&self) -> String {
        let output = self.chunk(&["--missing"]);
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output).trim_end().to_owned()
    }

    /// What `jabuka status` says, and whether all is done.
    pub(crate) fn status(&self) -> (String, bool) {
        let output = jabuka().arg("status").arg(self.path()).output().unwrap();
        assert_eq!(stderr(&output), "");
        (stdout(&output), output.status.success())
    }

    /// The frames that are being rendered, as `jabuka status` says it to programs.
    pub(crate) fn running(&self) -> Vec<u64> {
        let output = jabuka().args(["status", "--format", "json"]).arg(self.path()).output().unwrap();
        let status: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        let running = status["running"].as_array().unwrap();
        running.iter().map(|running| running["frame"].as_u64().unwrap()).collect()
    }

    /// Replaces the line of the ball by one that POV-Ray does not take; returns its number.
    pub(crate) fn break_frame(&self, frame: usize) -> usize {
        let path = self.join(format!("scripts/frame_{frame:04}.pov"));
        let text = fs::read_to_string(&path).unwrap();
        let line = text.lines().position(|line| line.ends_with("// ball")).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let broken = [&lines[..line], &["sphere { <0, 0, 0>, oops } // ball"], &lines[line + 1..]].concat();
        fs::write(&path, broken.join("\n") + "\n").unwrap();
        line + 1
    }

    /// The names of the images, in their order.
    pub(crate) fn images(&self) -> Vec<String> {
        names(&self.join("images")).into_iter().filter(|name| name.ends_with(".png")).collect()
    }

    /// What is in the hidden folder that is no record, and in its folders.
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

/// The names in a folder, in their order.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Waits until something is so; a machine may be slow.
pub(crate) fn wait_until(what: &str, limit: Duration, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < limit, "after {limit:?} still not: {what}");
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// The number of frames of a film, and its pixel format, by another program than the one that made it.
pub(crate) fn film(path: &Path) -> (usize, String) {
    let show = ["-v", "error", "-count_frames", "-select_streams", "v", "-show_entries"];
    let what = "stream=nb_read_frames,pix_fmt,width,height";
    let probe = Command::new("ffprobe").args(show).args([what, "-of", "csv=p=0"]).arg(path).output().unwrap();
    let text = stdout(&probe);
    let (format, frames) = text.trim().rsplit_once(',').unwrap_or_else(|| panic!("{}", stderr(&probe)));
    (frames.parse().unwrap(), format.to_owned())
}
