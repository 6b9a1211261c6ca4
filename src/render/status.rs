//! Finds out which images of a folder are done, from the images and their records. The program that renders them is not asked.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use sha2::{Digest, Sha256};

use super::batch::{CurrentSettings, SCRIPTS_FOLDER};
use super::files;
use super::record::{Compare, Files, HIDDEN_FOLDER, Record, State, Verdict};
use crate::diagnostic::visible;
use crate::output;
use crate::simulate::Selection;
use crate::system;

/// The age from which on the marker of a running frame counts as abandoned. A living process updates its marker twice a minute.
const MAX_MARKER_AGE: Duration = Duration::from_secs(180);

/// The status of the images in a folder. Each list contains the numbers of frames in one state.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Status {
    /// The requested frames.
    #[serde(skip)]
    pub frames: Vec<usize>,
    /// The frames with up-to-date images.
    pub done: Vec<usize>,
    /// The frames whose images have changed since they were rendered. The list is filled by [`Status::verified`] only.
    pub changed: Vec<usize>,
    /// The frames whose records have no digest to verify. The list is filled by [`Status::verified`] only.
    pub unverified: Vec<usize>,
    /// The frames that are being rendered.
    pub running: Vec<Running>,
    /// The frames whose last attempt failed.
    pub failed: Vec<Failed>,
    /// The frames without an up-to-date image that no process renders.
    pub missing: Vec<usize>,
    /// The missing frames that a process began to render and then abandoned: it has given no sign of life for three minutes.
    pub stale: Vec<Running>,
    /// True if a film of all these images exists. `None` if no film was requested.
    pub film: Option<bool>,
    /// True if the writing of the scripts was interrupted. Some may then be missing, or belong to another version of the scene.
    pub unfinished_scripts: bool,
}

/// A frame that a process is rendering.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Running {
    /// The number of the frame.
    pub frame: usize,
    /// The host name of the machine that renders the frame.
    pub host: String,
    /// The id of the process that renders the frame.
    pub process: u32,
    /// The time at which the process began, in seconds since 1970.
    pub since: u64,
}

/// A frame that could not be rendered.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failed {
    /// The number of the frame.
    pub frame: usize,
    /// The reason in one line: script and line, body, and POV-Ray's message.
    pub reason: String,
}

/// The paths and settings of a folder that contains scripts and their images.
struct FolderContents {
    scripts: PathBuf,
    images: PathBuf,
    frames: Vec<usize>,
    digits: usize,
    options: Option<String>,
    files: Vec<PathBuf>,
    film: Option<(PathBuf, String)>,
    unfinished_scripts: bool,
}

impl Status {
    /// Reads the status as [`Status::read`] does, and also reads the images. An image counts as done only if it has the digest of its
    /// record.
    ///
    /// # Errors
    /// If [`Status::read`] fails.
    pub fn verified(folder: &Path) -> io::Result<Status> {
        let place = FolderContents::find(folder)?;
        let mut status = Status::of(&place)?;
        let verdict = |&frame: &usize| {
            let name = place.name(frame);
            let image = place.images.join(format!("{name}.png"));
            // On a damaged disk, parts of a file may be unreadable. The image then counts as changed.
            let of_record = |record: Record| record.verify(&image).unwrap_or(Verdict::Changed);
            Record::read(&place.images, &name).map_or(Verdict::Unverified, of_record)
        };
        let verdicts: Vec<Verdict> = status.done.par_iter().map(verdict).collect();
        for (frame, verdict) in std::mem::take(&mut status.done).into_iter().zip(verdicts) {
            match verdict {
                Verdict::Intact => status.done.push(frame),
                Verdict::Changed => status.changed.push(frame),
                Verdict::Unverified => status.unverified.push(frame),
            }
        }
        Ok(status)
    }

    /// Reads the status of a job folder, or of a folder of scripts with a subfolder `images`. The images themselves are not read.
    ///
    /// # Errors
    /// If the folder contains no scripts of jabuka's, or a file that the scripts read is missing.
    pub fn read(folder: &Path) -> io::Result<Status> {
        Status::of(&FolderContents::find(folder)?)
    }

    fn of(place: &FolderContents) -> io::Result<Status> {
        let files = Files::read(&place.files).map_err(|(path, error)| {
            io::Error::new(error.kind(), format!("it needs `{}`: {error}", path.display()))
        })?;
        let compare = if place.options.is_some() { Compare::NotPovray } else { Compare::Scene };
        let options = place.options.as_deref().unwrap_or_default();
        let unfinished_scripts = place.unfinished_scripts;
        let mut status = Status { frames: place.frames.clone(), unfinished_scripts, ..Status::default() };
        for &frame in &place.frames {
            let name = place.name(frame);
            let blurred = place.scripts.join(format!("{name}.pov").replacen("frame", "shutter", 1));
            let script = if blurred.is_file() { blurred } else { place.scripts.join(format!("{name}.pov")) };
            // Without an image, the record need not be computed.
            let image = place.images.join(format!("{name}.png")).is_file();
            let expected =
                image.then(|| Record::expected(&script, frame, &files, options, "").ok()).flatten();
            let state = expected.map_or(State::Missing, |e| e.state(&place.images, &name, compare));
            let running = Running::read(&place.images, &name, frame);
            match running {
                _ if state == State::UpToDate => status.done.push(frame),
                Some((running, true)) => status.running.push(running),
                stale => match Failed::read(&place.images, &name, frame, &script) {
                    Some(failed) => status.failed.push(failed),
                    None => {
                        status.missing.push(frame);
                        status.stale.extend(stale.map(|(running, _)| running));
                    }
                },
            }
        }
        status.film = place.film.as_ref().map(|(film, how)| is_made(film, how, place));
        Ok(status)
    }

    /// Returns true if all requested frames have up-to-date images.
    pub fn is_complete(&self) -> bool {
        self.done.len() == self.frames.len() && !self.unfinished_scripts
    }

    /// Returns the status as text for a terminal: the number of frames in each state, and their numbers.
    pub fn to_text(&self) -> String {
        /// The largest number of failed frames that are shown.
        const MAX_SHOWN_FAILURES: usize = 10;
        let list = |frames: &[usize]| frames.iter().copied().collect::<Selection>().to_string();
        let on_hosts = |running: &[Running]| {
            let hosts: BTreeSet<&str> = running.iter().map(|running| running.host.as_str()).collect();
            let of = |host: &&str| {
                let frames: Vec<usize> =
                    running.iter().filter(|r| r.host == **host).map(|r| r.frame).collect();
                format!("{} on {host}", list(&frames))
            };
            visible(&hosts.iter().map(of).collect::<Vec<_>>().join("; "))
        };
        let mut text = String::new();
        if self.unfinished_scripts {
            text.push_str("scripts  not all there: what writes them was interrupted; run it again\n");
        }
        text.push_str(&format!("done     {} of {}\n", self.done.len(), self.frames.len()));
        if !self.changed.is_empty() {
            let frames = list(&self.changed);
            text.push_str(&format!("changed  {}: {frames}, since they were rendered\n", self.changed.len()));
        }
        if !self.unverified.is_empty() {
            let (count, frames) = (self.unverified.len(), list(&self.unverified));
            text.push_str(&format!("unverified {count}: {frames}, whose records have no digest\n"));
        }
        if !self.running.is_empty() {
            text.push_str(&format!("running  {}: {}\n", self.running.len(), on_hosts(&self.running)));
        }
        if !self.failed.is_empty() {
            text.push_str(&format!("failed   {}\n", self.failed.len()));
            for failed in self.failed.iter().take(MAX_SHOWN_FAILURES) {
                text.push_str(&format!("  frame {}: {}\n", failed.frame, failed.reason));
            }
            if self.failed.len() > MAX_SHOWN_FAILURES {
                let rest: Vec<usize> =
                    self.failed.iter().skip(MAX_SHOWN_FAILURES).map(|failed| failed.frame).collect();
                text.push_str(&format!("  and {}\n", list(&rest)));
            }
        }
        if !self.missing.is_empty() {
            text.push_str(&format!("missing  {}: {}\n", self.missing.len(), list(&self.missing)));
        }
        if !self.stale.is_empty() {
            let hosts = on_hosts(&self.stale);
            text.push_str(&format!("         begun and not heard of for three minutes: {hosts}\n"));
        }
        match self.film {
            Some(true) => text.push_str("film     made\n"),
            Some(false) => text.push_str("film     not made\n"),
            None => {}
        }
        text
    }
}

impl FolderContents {
    /// Returns the name of a frame's script and image, without extension: `frame_0007`.
    fn name(&self, frame: usize) -> String {
        format!("frame_{frame:0width$}", width = self.digits)
    }

    fn find(folder: &Path) -> io::Result<FolderContents> {
        let (scripts, job) = match CurrentSettings::read(folder)? {
            Some(job) => (folder.join(SCRIPTS_FOLDER), Some(job)),
            None => (folder.to_owned(), None),
        };
        let images = folder.join("images");
        let head = output::read_manifest(&scripts).ok_or_else(|| {
            io::Error::new(io::ErrorKind::NotFound, "it holds no scripts that jabuka wrote")
        })?;
        let unfinished_scripts = head.state != output::State::Complete;
        let digits = crate::emit::width(head.frames);
        if let Some(job) = job {
            let frames = (0..head.frames).filter(|frame| job.frames.contains(*frame)).collect();
            let film = Some((folder.join("film.mp4"), job.film));
            return Ok(FolderContents {
                scripts,
                images,
                frames,
                digits,
                options: Some(job.options),
                files: job.files,
                film,
                unfinished_scripts,
            });
        }
        let found = output::scripts(&scripts).map_err(io::Error::other)?;
        // A frame with motion blur has two scripts but one image.
        let mut frames: Vec<usize> = found.into_iter().map(|(frame, _)| frame).collect();
        frames.dedup();
        let files = files::of_scripts(&scripts)?.into_iter().map(|file| scripts.join(file)).collect();
        Ok(FolderContents {
            scripts,
            images,
            frames,
            digits,
            options: None,
            files,
            film: None,
            unfinished_scripts,
        })
    }
}

impl Running {
    /// Reads the marker of a frame that is being rendered. Also returns true if the marker is recent, so that the process is probably
    /// alive.
    fn read(images: &Path, name: &str, frame: usize) -> Option<(Running, bool)> {
        let path = images.join(HIDDEN_FOLDER).join("running").join(name);
        let touched = fs::metadata(&path).ok()?.modified().ok()?;
        let text = system::read_to_string(&path).ok()?;
        let mut words = text.split_whitespace();
        let host = words.next()?.to_owned();
        let process = words.next()?.parse().ok()?;
        let since = words.next()?.parse().ok()?;
        // The clock of another machine may be ahead, so the age could be negative.
        let age = SystemTime::now().duration_since(touched).unwrap_or_default();
        Some((Running { frame, host, process, since }, age < MAX_MARKER_AGE))
    }
}

impl Failed {
    /// Reads the reason of a frame's failure. `None` if the frame has not failed, or its script has changed since.
    fn read(images: &Path, name: &str, frame: usize, script: &Path) -> Option<Failed> {
        let path = images.join(HIDDEN_FOLDER).join("failed").join(format!("{name}.txt"));
        let text = system::read_to_string(&path).ok()?;
        let modified = |path: &Path| fs::metadata(path).and_then(|metadata| metadata.modified()).ok();
        if modified(script) > modified(&path) {
            return None;
        }
        let reason = visible(text.lines().next().unwrap_or_default());
        Some(Failed { frame, reason })
    }
}

/// Returns true if the film exists and consists of these images, according to the digest that `render-video` has saved.
fn is_made(film: &Path, how: &str, place: &FolderContents) -> bool {
    let mut hasher = Sha256::new();
    hasher.update(format!("{how}\n"));
    for frame in &place.frames {
        let name = place.name(*frame);
        let Ok(record) = system::read_to_string(&Record::path(&place.images, &name)) else {
            return false;
        };
        hasher.update(format!("{}\n", record.trim_end_matches('\n')));
    }
    let digest: String = hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    let noted = system::read_to_string(&Record::path(&place.images, "film")).unwrap_or_default();
    fs::metadata(film).is_ok_and(|film| film.is_file() && film.len() > 0)
        && noted.trim_end() == format!("film {digest}")
}
