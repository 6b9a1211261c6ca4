//! One POV-Ray process, and the images that it makes one after another.
//!
//! Each process waits for 0.6 s in total, so it gets several images through POV-Ray's animation loop: its script includes
//! another script for each frame number.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::started::Started;
use super::{PovRay, cpu};
use crate::sandbox::Needs;

/// A picture that POV-Ray makes: of a frame, or of one moment of a blurred one.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Unit {
    /// The number of the frame within the job.
    pub(super) index: usize,
    /// The number of the frame within the film.
    pub(super) frame: usize,
    /// The name of the script's file.
    pub(super) script: String,
    /// The moment within a blurred frame.
    pub(super) moment: Option<u32>,
    /// Whether the script asks POV-Ray for its clock. Such a script needs a process of its own.
    pub(super) asks_clock: bool,
}

/// The setup common to all processes of a job.
pub(super) struct Setup<'a> {
    pub(super) povray: &'a PovRay,
    /// The folder of the scripts, absolute.
    pub(super) scripts: &'a Path,
    /// The options that affect pixels.
    pub(super) options: &'a [String],
    /// The number of the last frame.
    pub(super) last: usize,
    /// The value of POV-Ray's clock in the first and in the last frame, s.
    pub(super) clock: [f64; 2],
    /// The threads that each process renders with.
    pub(super) threads: usize,
}

/// A running process.
pub(super) struct Process {
    child: Started,
    folder: PathBuf,
    units: Vec<Unit>,
    names: Names,
    done: usize,
    /// The time at which the present image was begun.
    since: Instant,
    /// The CPU time that the process had used by then, s.
    cpu_before: f64,
    /// The CPU time when it was last seen to grow, s, and when that was.
    alive: (f64, Instant),
}

/// The events since the last poll.
pub(super) enum Step {
    /// Nothing new.
    Working,
    /// The image of a unit is whole.
    Image { unit: Unit, path: PathBuf, seconds: f64 },
    /// The process has ended, or was ended, after its last image.
    Done,
    /// It ended early, with this message of POV-Ray's about the script of the first remaining unit.
    Broken { message: String, left: Vec<Unit> },
    /// It ended early, or was ended, for a reason that is not in the script.
    Died { why: String, left: Vec<Unit> },
}

/// How POV-Ray numbers images.
enum Names {
    /// From 0, five digits.
    Plain,
    /// The number of the single image, and its digits.
    Own(usize, usize),
}

impl Process {
    /// Starts a process on some units. With `humble`, other processes run first.
    pub(super) fn start(
        setup: &Setup<'_>,
        folder: PathBuf,
        units: Vec<Unit>,
        humble: bool,
    ) -> io::Result<Process> {
        // Folder names may contain characters that neither POV-Ray's command line nor its strings can.
        std::os::unix::fs::symlink(setup.scripts, folder.join("scripts"))?;
        fs::write(folder.join("run.pov"), master(&units))?;
        let (last, [begin, end]) = (setup.last, setup.clock);
        let (names, range) = match units.as_slice() {
            [unit] if unit.asks_clock => {
                let frame = unit.frame;
                let digits = if last == 0 { 0 } else { last.to_string().len() };
                let range =
                    [format!("+KFI0 +KFF{last} +KI{begin} +KF{end}"), format!("+SF{frame} +EF{frame}")];
                (Names::Own(frame, digits), range.join(" "))
            }
            _ => (Names::Plain, format!("+KFI0 +KFF99999 +SF0 +EF{}", units.len() - 1)),
        };
        let needs = Needs { read: &[setup.scripts], write: &[&folder], humble };
        let mut command = setup.povray.command(needs);
        command
            .current_dir(&folder)
            .args(["-D", "-V", "-GA", "+GWwarnings.txt", "+GFerrors.txt"])
            .args(["+Lscripts", "+Lscripts/assets"])
            .arg(format!("+WT{}", setup.threads))
            .args(setup.options)
            .arg(if units.iter().any(|unit| unit.moment.is_some()) { "+FN16" } else { "+FN8" })
            .args(range.split(' '))
            .args(["+Irun.pov", "+Oimage.png"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(File::create(folder.join("console.txt"))?);
        let child = Started::new(&mut command)?;
        let now = Instant::now();
        Ok(Process { child, folder, units, names, done: 0, since: now, cpu_before: 0.0, alive: (0.0, now) })
    }

    /// Checks for new events.
    pub(super) fn step(&mut self) -> Step {
        // First check for the end, then for images, so that no image made before the end is missed.
        let exit = match self.child.exit() {
            Ok(exit) => exit,
            Err(error) => return self.died(format!("it cannot be watched: {error}")),
        };
        if let Some(unit) = self.units.get(self.done) {
            let path = self.folder.join(self.names.of(self.done));
            if is_whole(&path) {
                let unit = unit.clone();
                let cpu = cpu::seconds(self.child.id());
                let seconds = match cpu {
                    Some(cpu) if cpu - self.cpu_before > 0.01 => cpu - self.cpu_before,
                    _ => self.since.elapsed().as_secs_f64(),
                };
                self.cpu_before = cpu.unwrap_or(0.0);
                self.since = Instant::now();
                self.done += 1;
                return Step::Image { unit, path, seconds };
            }
        } else {
            // Waiting for its end would take a third of a second.
            self.child.end();
            return Step::Done;
        }
        match exit {
            None => Step::Working,
            Some(exit) => self.fate(exit),
        }
    }

    /// Ends it if it hangs, or exceeds its time limit.
    pub(super) fn guard(&mut self, cpu: Option<f64>, limit: Duration) -> Step {
        /// POV-Ray never waits this long for anything.
        const STILL: Duration = Duration::from_secs(20);
        let now = Instant::now();
        if cpu.is_none_or(|cpu| cpu > self.alive.0 + 0.005) {
            self.alive = (cpu.unwrap_or(0.0), now);
        }
        if now - self.alive.1 > STILL {
            self.died("it hung: it did nothing for 20 s".to_owned())
        } else if now - self.since > limit {
            self.died(format!("it took more than the time limit of {:.0} s", limit.as_secs_f64()))
        } else {
            Step::Working
        }
    }

    /// Its process group.
    pub(super) fn group(&self) -> Option<i32> {
        i32::try_from(self.child.id()).ok()
    }

    /// The warnings of the process.
    pub(super) fn warnings(&self) -> String {
        said(&self.folder.join("warnings.txt"))
    }

    /// Its work folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// The reason why it ended before all its images were made.
    fn fate(&mut self, exit: ExitStatus) -> Step {
        let message = said(&self.folder.join("errors.txt"));
        if exit.code() == Some(1) && !message.is_empty() {
            self.child.end();
            return Step::Broken { message, left: self.units.split_off(self.done) };
        }
        let console = fs::read(self.folder.join("console.txt")).unwrap_or_default();
        let console = String::from_utf8_lossy(&console);
        // POV-Ray does not call this a parse error, though it occurs while parsing: for missing images, fonts and the like.
        if let Some(message) = console.lines().find_map(|line| line.strip_prefix("Fatal error in parser: ")) {
            self.child.end();
            return Step::Broken { message: message.to_owned(), left: self.units.split_off(self.done) };
        }
        let last = console.lines().rev().find(|line| !line.trim().is_empty());
        let why = match (exit.signal(), exit.code()) {
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
        Step::Died { why, left: self.units.split_off(self.done.min(self.units.len())) }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.child.end();
        // The next run removes a folder that stays.
        let _ = fs::remove_dir_all(&self.folder);
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

/// The script that includes another one for each frame number.
fn master(units: &[Unit]) -> String {
    let mut text = "#version 3.7;\n#switch (frame_number)\n".to_owned();
    for (index, unit) in units.iter().enumerate() {
        let case = if unit.asks_clock { unit.frame } else { index };
        let _ = writeln!(text, "#case ({case})\n#declare frame_number = {};", unit.frame);
        if let Some(moment) = unit.moment {
            let _ = writeln!(text, "#declare Shutter_Sample = {moment};");
        }
        let _ = writeln!(text, "#include \"scripts/{}\"\n#break", unit.script);
    }
    text + "#end\n"
}

/// Whether an image is complete: it has a beginning and an end.
pub(super) fn is_whole(path: &Path) -> bool {
    /// The last chunk of every PNG: no bytes, `IEND`, and their checksum.
    const END: [u8; 12] = [0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82];
    let ends = || -> io::Result<bool> {
        let mut file = File::open(path)?;
        file.seek(SeekFrom::End(-12))?;
        let mut last = [0; 12];
        file.read_exact(&mut last)?;
        Ok(last == END)
    };
    ends().unwrap_or(false)
}

/// A stream of POV-Ray's output, without the banners between frames.
fn said(path: &Path) -> String {
    let bytes = fs::read(path).unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    let lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('='));
    lines.map(|line| format!("{line}\n")).collect()
}
