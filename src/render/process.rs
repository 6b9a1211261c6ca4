//! Runs one POV-Ray process that renders several images one after another.
//!
//! Each process waits for 0.6 s in total, whatever it renders. So it gets several images through POV-Ray's animation loop: its main script
//! includes another script for each frame number.

use std::fmt::Write as _;
use std::io::{self, Read, Seek, SeekFrom, Write as _};
use std::path::Path;
use std::process::{ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::images::{Finished, WorkFolder};
use super::started::Started;
use super::{PovRay, PovRayBuild, RenderError};
use crate::sandbox::Needs;
use crate::system::{self, Dir};

/// A picture for POV-Ray to render: a frame, or one moment of a frame with motion blur.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct RenderTask {
    /// The index of the frame's group within the job. The frames of a group have equal scripts.
    pub(super) index: usize,
    /// The number of the frame within the film.
    pub(super) frame: usize,
    /// The file name of the script.
    pub(super) script: String,
    /// The index of the moment within a frame with motion blur. `None` for a frame without motion blur.
    pub(super) moment: Option<u32>,
    /// True if the script uses POV-Ray's variable `clock` or `frame_number`. Such a script needs a process of its own.
    pub(super) asks_clock: bool,
}

/// The settings that all POV-Ray processes of a job share.
pub(super) struct Setup<'a> {
    pub(super) povray: &'a PovRay,
    /// The folder of the scripts, as an absolute path.
    pub(super) scripts: &'a Path,
    /// The command-line options of POV-Ray that affect pixels.
    pub(super) options: &'a [String],
    /// The number of the film's last frame.
    pub(super) last: usize,
    /// The value of POV-Ray's variable `clock` in the first and in the last frame, s.
    pub(super) clock: [f64; 2],
    /// The number of threads that each POV-Ray process renders with.
    pub(super) threads: usize,
}

/// A running POV-Ray process.
pub(super) struct Process {
    child: Started,
    build: PovRayBuild,
    folder: WorkFolder,
    tasks: Vec<RenderTask>,
    names: Names,
    done: usize,
    /// The time at which POV-Ray began the current image.
    since: Instant,
    /// The CPU time that the process had used when it began the current image, s.
    cpu_before: f64,
    /// The CPU time when it was last seen to grow (s), and the time of that observation.
    alive: (f64, Instant),
}

/// The result of polling a POV-Ray process.
pub(super) enum Step {
    /// The process is running, without a new image.
    Working,
    /// The image of a picture is complete.
    Image { task: RenderTask, image: Finished, seconds: f64 },
    /// The process has rendered its last image, and has ended or was killed.
    Done,
    /// The process has ended early, with an error message about the script of the first remaining picture.
    Broken { message: String, left: Vec<RenderTask> },
    /// The process has ended early or was killed, for a reason outside of the script.
    Died { why: String, left: Vec<RenderTask> },
}

/// How POV-Ray numbers the image files of a process.
enum Names {
    /// The images are numbered from 0, with five digits.
    Plain,
    /// The process renders a single image: its frame number, and the number of digits.
    Own(usize, usize),
}

impl Process {
    /// Starts a POV-Ray process that renders some pictures. With `low_priority`, the process has a low priority.
    pub(super) fn start(
        setup: &Setup<'_>,
        folder: WorkFolder,
        tasks: Vec<RenderTask>,
        low_priority: bool,
    ) -> Result<Process, RenderError> {
        let dir = &folder.dir;
        // A symbolic link with a plain name stands for the folder of the scripts, since the folder's name may contain characters that are
        // not allowed in POV-Ray's command line and strings.
        dir.link(setup.scripts, "scripts")?;
        let written = dir.create_new("run.pov")?.write_all(master(&tasks).as_bytes());
        written.map_err(RenderError::io(dir.path()))?;
        let (last, [begin, end]) = (setup.last, setup.clock);
        let (names, range) = match tasks.as_slice() {
            [task] if task.asks_clock => {
                let frame = task.frame;
                let digits = if last == 0 { 0 } else { last.to_string().len() };
                let range =
                    [format!("+KFI0 +KFF{last} +KI{begin} +KF{end}"), format!("+SF{frame} +EF{frame}")];
                (Names::Own(frame, digits), range.join(" "))
            }
            _ => (Names::Plain, format!("+KFI0 +KFF99999 +SF0 +EF{}", tasks.len() - 1)),
        };
        let needs = Needs { read: &[setup.scripts], write: &[Path::new(".")], low_priority };
        let has_moments = tasks.iter().any(|task| task.moment.is_some());
        let mut options: Vec<String> = Vec::new();
        options.extend(["-D", "-V", "-GA", "+GWwarnings.txt", "+GFerrors.txt"].map(str::to_owned));
        options.extend(["+Lscripts", "+Lscripts/assets"].map(str::to_owned));
        options.push(format!("+WT{}", setup.threads));
        options.extend(setup.options.iter().cloned());
        options.push(if has_moments { "+FN16" } else { "+FN8" }.to_owned());
        options.extend(range.split(' ').map(str::to_owned));
        options.extend(["+Irun.pov", "+Oimage.png"].map(str::to_owned));
        let mut command = setup.povray.command(needs);
        match setup.povray.build() {
            PovRayBuild::Console => command.args(options),
            PovRayBuild::Windows => {
                let written = dir.create_new("run.ini")?.write_all((options.join("\n") + "\n").as_bytes());
                written.map_err(RenderError::io(dir.path()))?;
                command.args(["/EXIT", "/RENDER", "run.ini"])
            }
        };
        command
            .current_dir(dir.path_for_child())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(dir.create_new("console.txt")?);
        let child = Started::new(&mut command).map_err(RenderError::io(dir.path()))?;
        let now = Instant::now();
        let build = setup.povray.build();
        Ok(Process {
            child,
            build,
            folder,
            tasks,
            names,
            done: 0,
            since: now,
            cpu_before: 0.0,
            alive: (0.0, now),
        })
    }

    /// Polls the process for a new image or its end.
    pub(super) fn step(&mut self) -> Step {
        // The end is checked before the images. Otherwise, an image that was completed just before the end could be missed.
        let exit = match self.child.exit() {
            Ok(exit) => exit,
            Err(error) => return self.died(format!("it cannot be watched: {error}")),
        };
        if let Some(task) = self.tasks.get(self.done) {
            let name = self.names.of(self.done);
            if is_whole(&self.folder.dir, &name) {
                let task = task.clone();
                let cpu = system::cpu_seconds(self.child.id());
                let seconds = match cpu {
                    Some(cpu) if cpu - self.cpu_before > 0.01 => cpu - self.cpu_before,
                    _ => self.since.elapsed().as_secs_f64(),
                };
                self.cpu_before = cpu.unwrap_or(0.0);
                self.since = Instant::now();
                self.done += 1;
                let image = Finished { folder: self.folder.dir.clone(), name };
                return Step::Image { task, image, seconds };
            }
        } else {
            // All images are complete. Waiting for POV-Ray's own end would take a third of a second.
            self.child.end();
            return Step::Done;
        }
        match exit {
            None => Step::Working,
            Some(exit) => self.fate(exit),
        }
    }

    /// Kills the process if it hangs or exceeds the time limit. `cpu` is its CPU time so far, s.
    pub(super) fn guard(&mut self, cpu: Option<f64>, limit: Duration) -> Step {
        /// A process that uses no CPU time for longer than this hangs. POV-Ray never waits as long for anything.
        const MAX_IDLE_TIME: Duration = Duration::from_secs(20);
        let now = Instant::now();
        if cpu.is_none_or(|cpu| cpu > self.alive.0 + 0.005) {
            self.alive = (cpu.unwrap_or(0.0), now);
        }
        if now - self.alive.1 > MAX_IDLE_TIME {
            self.died("it hung: it did nothing for 20 s".to_owned())
        } else if now - self.since > limit {
            self.died(format!("it took more than the time limit of {:.0} s", limit.as_secs_f64()))
        } else {
            Step::Working
        }
    }

    /// Returns the id of the process group.
    pub(super) fn group(&self) -> Option<i32> {
        i32::try_from(self.child.id()).ok()
    }

    /// Returns the warnings that the process has printed.
    pub(super) fn warnings(&self) -> String {
        said(&self.folder.dir, "warnings.txt")
    }

    /// Returns the work folder of the process.
    pub(super) fn folder(&self) -> &Dir {
        &self.folder.dir
    }

    /// Finds out why the process ended before all its images were complete.
    fn fate(&mut self, exit: ExitStatus) -> Step {
        let message = said(&self.folder.dir, "errors.txt");
        // The meaning of the exit codes of POV-Ray for Windows is not documented.
        let is_error = exit.code() == Some(1) || self.build == PovRayBuild::Windows;
        if is_error && !message.is_empty() {
            self.child.end();
            return Step::Broken { message, left: self.tasks.split_off(self.done) };
        }
        let console = self.folder.dir.read("console.txt").unwrap_or_default();
        let console = String::from_utf8_lossy(&console);
        // For missing images, fonts and the like, POV-Ray prints this error instead of a parse error.
        if let Some(message) = console.lines().find_map(|line| line.strip_prefix("Fatal error in parser: ")) {
            self.child.end();
            return Step::Broken { message: message.to_owned(), left: self.tasks.split_off(self.done) };
        }
        let last = console.lines().rev().find(|line| !line.trim().is_empty());
        let why = match (system::signal(exit), exit.code()) {
            (Some(signal), _) => format!("it was killed by signal {signal}"),
            (None, Some(0)) => "it ended without an image".to_owned(),
            (None, code) => {
                let code = code.map_or_else(String::new, |code| code.to_string());
                format!("it ended with code {code}: {}", last.unwrap_or("it said nothing").trim())
            }
        };
        self.died(why)
    }

    fn died(&mut self, why: String) -> Step {
        self.child.end();
        Step::Died { why, left: self.tasks.split_off(self.done.min(self.tasks.len())) }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // The process ends before its folder is removed.
        self.child.end();
    }
}

impl Names {
    fn of(&self, index: usize) -> String {
        match *self {
            Names::Plain => format!("image{index:05}.png"),
            Names::Own(_, 0) => "image.png".to_owned(),
            Names::Own(number, digits) => format!("image{number:0digits$}.png"),
        }
    }
}

/// Returns the main script of a process, which includes another script for each frame number.
fn master(tasks: &[RenderTask]) -> String {
    let mut text = "#version 3.7;\n#switch (frame_number)\n".to_owned();
    for (index, task) in tasks.iter().enumerate() {
        let case = if task.asks_clock { task.frame } else { index };
        let _ = writeln!(text, "#case ({case})\n#declare frame_number = {};", task.frame);
        if let Some(moment) = task.moment {
            let _ = writeln!(text, "#declare Shutter_Sample = {moment};");
        }
        let _ = writeln!(text, "#include \"scripts/{}\"\n#break", task.script);
    }
    text + "#end\n"
}

/// Returns true if a PNG file is complete: it ends with the last chunk of a PNG.
fn is_whole(folder: &Dir, name: &str) -> bool {
    /// The last chunk of every PNG: a length of 0, `IEND`, and the checksum.
    const PNG_END_CHUNK: [u8; 12] = [0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82];
    let ends = || -> io::Result<bool> {
        let mut file = folder.open_file(name)?;
        file.seek(SeekFrom::End(-12))?;
        let mut last = [0; 12];
        file.read_exact(&mut last)?;
        Ok(last == PNG_END_CHUNK)
    };
    ends().unwrap_or(false)
}

/// Reads a file of POV-Ray's messages, and removes the banners between frames.
fn said(folder: &Dir, name: &str) -> String {
    let bytes = folder.read(name).unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    let lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('='));
    lines.map(|line| format!("{line}\n")).collect()
}
