//! Finds the program ffmpeg and runs it.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{ChildStdin, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use super::super::started::Started;
use super::target::Target;
use super::{FilmError, Format};
use crate::sandbox::{Confinement, Needs};
use crate::system;

/// An installed ffmpeg that has the encoder for the format of a film.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ffmpeg {
    program: PathBuf,
    version: String,
    confinement: Confinement,
}

/// The result of a run of ffmpeg that was not cancelled.
pub(super) struct End {
    /// True if ffmpeg's exit status means success. The film can be broken even then.
    pub(super) success: bool,
    /// How ffmpeg ended, as text: "ended with code 1".
    pub(super) how: String,
    /// The last lines of ffmpeg's error output.
    pub(super) said: String,
    /// The number of frames that ffmpeg has written.
    pub(super) frames: usize,
}

impl Ffmpeg {
    /// Finds ffmpeg, and checks that it has the encoder for a format. `program` is its path or name, `None` for `ffmpeg` in the `PATH`.
    pub(super) fn find(
        program: Option<&Path>,
        format: Format,
        confinement: Confinement,
    ) -> Result<Ffmpeg, FilmError> {
        let program = program.unwrap_or(Path::new("ffmpeg"));
        let unusable = |why: String| FilmError::NoFfmpeg(program.to_owned(), why);
        if which::which(program).is_err() {
            return Err(unusable("there is no such program".to_owned()));
        }
        let ask = |arguments: &[&str]| {
            let mut command = confinement.command(program, Needs::default());
            let output = command.args(arguments).stdin(Stdio::null()).output();
            let output = output.map_err(|error| unusable(error.to_string()))?;
            Ok::<_, FilmError>(String::from_utf8_lossy(&output.stdout).into_owned())
        };
        let answer = ask(&["-version"])?;
        let version = answer.strip_prefix("ffmpeg version ").and_then(|rest| rest.split_whitespace().next());
        let Some(version) = version else {
            return Err(unusable("it is no ffmpeg, for it does not tell its version".to_owned()));
        };
        let encoder = format.encoder();
        let answer = ask(&["-hide_banner", "-loglevel", "error", "-h", &format!("encoder={encoder}")])?;
        if !answer.starts_with("Encoder ") {
            return Err(FilmError::NoEncoder(program.to_owned(), encoder));
        }
        Ok(Ffmpeg { program: program.to_owned(), version: version.to_owned(), confinement })
    }

    /// Returns the path of the program, or the name that the `PATH` was searched for.
    pub fn program(&self) -> &Path {
        &self.program
    }

    /// Returns the version of ffmpeg, such as `5.1.6-0+deb12u1`.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Runs ffmpeg with write access to the temporary file of `film` only. `feed` writes to ffmpeg's standard input, on a thread of its own. `progress`
    /// receives the number of written frames.
    ///
    /// # Errors
    /// If ffmpeg cannot be started, `feed` fails, or `cancelled` returns true.
    pub(super) fn run(
        &self,
        arguments: &[OsString],
        film: &Target,
        feed: impl FnOnce(&mut dyn Write, &AtomicBool) -> Result<(), FilmError> + Send,
        cancelled: &dyn Fn() -> bool,
        progress: &dyn Fn(usize),
    ) -> Result<End, FilmError> {
        let temporary = film.temporary();
        let needs = Needs { write: &[&temporary], ..Needs::default() };
        let mut command = self.confinement.command(&self.program, needs);
        command
            .current_dir(film.folder().path_for_child())
            .args(["-hide_banner", "-loglevel", "error", "-nostats", "-xerror", "-progress", "pipe:1"])
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            // ffmpeg's messages must be in English, since they are searched for English words.
            .env("LC_ALL", "C")
            // The first variable adds colors to ffmpeg's messages. The second makes it write a log file.
            .env_remove("AV_LOG_FORCE_COLOR")
            .env_remove("FFREPORT");
        let started = Started::new(&mut command);
        let mut running =
            started.map_err(|error| FilmError::NoFfmpeg(self.program.clone(), error.to_string()))?;
        let (input, output, errors) = running.pipes();
        let (stop, frames) = (AtomicBool::new(false), AtomicUsize::new(0));
        let mut shown = 0;
        thread::scope(|scope| {
            let feeder =
                scope.spawn(|| input.map_or(Ok(()), |mut input: ChildStdin| feed(&mut input, &stop)));
            scope.spawn(|| output.map(|output| count(output, &frames)));
            let said = scope.spawn(|| errors.map(last_lines).unwrap_or_default());
            let stopped = loop {
                let now = frames.load(Ordering::Relaxed);
                if now != shown {
                    progress(now);
                    shown = now;
                }
                if running.exit().is_ok_and(|exit| exit.is_some()) {
                    break false;
                }
                let has_failed = feeder.is_finished() && stop.load(Ordering::Relaxed);
                if has_failed || cancelled() {
                    break !has_failed;
                }
                thread::sleep(Duration::from_millis(10));
            };
            stop.store(true, Ordering::Relaxed);
            // After this, ffmpeg's ends of the pipes are closed, so no other thread waits for ffmpeg any longer.
            let exit = running.end();
            if stopped {
                return Err(FilmError::Cancelled);
            }
            // A panic of the feeding thread would be a bug in this file, so it is ignored.
            feeder.join().unwrap_or(Ok(()))?;
            let said = said.join().unwrap_or_default();
            Ok(End { success: exit.is_some_and(|exit| exit.success()), how: how(exit), said, frames: 0 })
        })
        .map(|end| {
            // The last frames may have been counted after the loop has read the number of frames for the last time.
            let frames = frames.load(Ordering::Relaxed);
            if frames != shown {
                progress(frames);
            }
            End { frames, ..end }
        })
    }
}

fn how(exit: Option<ExitStatus>) -> String {
    match exit.map(|exit| (exit.code(), system::signal(exit))) {
        Some((Some(code), _)) => format!("ended with code {code}"),
        Some((None, Some(signal))) => format!("was killed by signal {signal}"),
        Some((None, None)) => "ended".to_owned(),
        None => "could not be watched".to_owned(),
    }
}

/// Reads ffmpeg's progress messages to their end, and stores the number of written frames from lines such as `frame=25`.
fn count(output: impl Read, frames: &AtomicUsize) {
    for line in BufReader::new(output).lines().map_while(Result::ok) {
        if let Some(number) = line.strip_prefix("frame=").and_then(|text| text.trim().parse().ok()) {
            frames.store(number, Ordering::Relaxed);
        }
    }
}

/// Reads to the end, and returns the last few lines. Long lines are shortened, and characters that control a terminal are removed.
fn last_lines(mut from: impl Read) -> String {
    /// The largest number of lines that are returned.
    const MAX_SHOWN_LINES: usize = 8;
    /// The number of bytes at the end of the output from which the lines are taken.
    const MAX_KEPT_BYTES: usize = 4000;
    let mut last = VecDeque::new();
    let mut piece = [0; 4096];
    while let Ok(length @ 1..) = from.read(&mut piece) {
        last.extend(&piece[..length]);
        last.drain(..last.len().saturating_sub(MAX_KEPT_BYTES));
    }
    let text: Vec<u8> = last.into();
    let text = String::from_utf8_lossy(&text).replace('\r', "\n");
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    let shown = |line: &&str| -> String {
        let plain = line.chars().filter(|c| !c.is_control());
        format!("  {}", plain.take(300).collect::<String>())
    };
    lines[lines.len().saturating_sub(MAX_SHOWN_LINES)..].iter().map(shown).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_what_is_said_the_last_is_kept_and_nothing_that_steers_a_terminal() {
        let mut text = "noise\n".repeat(1_000_000);
        text += "one\rtwo \u{1b}[31mthree\n\n";
        let last = last_lines(text.as_bytes());
        assert_eq!(last.lines().count(), 8);
        assert!(last.ends_with("  noise\n  one\n  two [31mthree"), "{last}");
        assert!(last_lines("x".repeat(1_000_000).as_bytes()).len() < 400);
    }
}
