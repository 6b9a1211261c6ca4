//! The status of the images in a folder, read from the images and not from the program that renders them.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use sha2::{Digest, Sha256};

use super::batch::{InForce, SCRIPTS};
use super::files;
use super::record::{Compare, Files, HIDDEN, Record, State, Verdict};
use crate::diagnostic::visible;
use crate::output::{self, MANIFEST};
use crate::simulate::Selection;

/// The marker of a frame that is being rendered is touched twice a minute. A marker that was not touched for this long belongs
/// to a dead process.
const HEARTBEATS: Duration = Duration::from_secs(180);

/// The status of the images in a folder. Every frame is in one of the lists.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Status {
    /// The requested frames.
    #[serde(skip)]
    pub frames: Vec<usize>,
    /// The frames with up-to-date images.
    pub done: Vec<usize>,
    /// The frames whose images have changed since they were rendered; empty unless the images were read.
    pub changed: Vec<usize>,
    /// The frames whose records have no digest to compare with; empty unless the images were read.
    pub unverified: Vec<usize>,
    /// The frames that are being rendered.
    pub running: Vec<Running>,
    /// The frames that failed at the last attempt.
    pub failed: Vec<Failed>,
    /// The frames that nobody works on, without an image or with an outdated one.
    pub missing: Vec<usize>,
    /// The missing frames that were begun, but have given no sign of life for three minutes.
    pub stale: Vec<Running>,
    /// Whether there is a film of all these images. `None` if no film was requested.
    pub film: Option<bool>,
    /// Whether writing the scripts was interrupted, so that some may be missing or of another version of the scene.
    pub unfinished_scripts: bool,
}

/// A frame that is being rendered.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Running {
    /// Its number.
    pub frame: usize,
    /// The machine.
    pub host: String,
    /// The number of the process.
    pub process: u32,
    /// When it began, in seconds since 1970.
    pub since: u64,
}

/// A frame that failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failed {
    /// Its number.
    pub frame: usize,
    /// Why, in one line: script and line, message, body.
    pub reason: String,
}

/// The paths of a folder's contents.
struct Place {
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
    /// Like [`Status::read`], but also reads the images. Only images with the digest of their record count as done.
    ///
    /// # Errors
    /// The same as those of [`Status::read`].
    pub fn verified(folder: &Path) -> io::Result<Status> {
        let place = Place::find(folder)?;
        let mut status = Status::of(&place)?;
        let verdict = |&frame: &usize| {
            let name = place.name(frame);
            let image = place.images.join(format!("{name}.png"));
            // A file on a damaged disk may be unreadable in part.
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

    /// Reads a job folder, or a folder of scripts whose images are in its folder `images`. It does not read the images
    /// themselves.
    ///
    /// # Errors
    /// If the folder is neither, or cannot be read.
    pub fn read(folder: &Path) -> io::Result<Status> {
        Status::of(&Place::find(folder)?)
    }

    fn of(place: &Place) -> io::Result<Status> {
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
            // Without an image, there is nothing to compare.
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

    /// Whether all images are there.
    pub fn is_complete(&self) -> bool {
        self.done.len() == self.frames.len() && !self.unfinished_scripts
    }

    /// The status for people: how many frames are in each state, and which.
    pub fn to_text(&self) -> String {
        /// The number of failures that are shown.
        const SHOWN: usize = 10;
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
            for failed in self.failed.iter().take(SHOWN) {
                text.push_str(&format!("  frame {}: {}\n", failed.frame, failed.reason));
            }
            if self.failed.len() > SHOWN {
                let rest: Vec<usize> = self.failed.iter().skip(SHOWN).map(|failed| failed.frame).collect();
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

impl Place {
    /// The name of the script and the image of a frame, without the ending.
    fn name(&self, frame: usize) -> String {
        format!("frame_{frame:0width$}", width = self.digits)
    }

    fn find(folder: &Path) -> io::Result<Place> {
        let (scripts, job) = match InForce::read(folder)? {
            Some(job) => (folder.join(SCRIPTS), Some(job)),
            None => (folder.to_owned(), None),
        };
        let images = folder.join("images");
        let head = output::read_manifest(&scripts.join(MANIFEST)).ok_or_else(|| {
            io::Error::new(io::ErrorKind::NotFound, "it holds no scripts that jabuka wrote")
        })?;
        let unfinished_scripts = head.state != output::State::Complete;
        let digits = crate::emit::width(head.frames);
        if let Some(job) = job {
            let frames = (0..head.frames).filter(|frame| job.frames.contains(*frame)).collect();
            let film = Some((folder.join("film.mp4"), job.film));
            return Ok(Place {
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
        // A blurred frame has two scripts but one image.
        let mut frames: Vec<usize> = found.into_iter().map(|(frame, _)| frame).collect();
        frames.dedup();
        let files = files::of_scripts(&scripts)?.into_iter().map(|file| scripts.join(file)).collect();
        Ok(Place { scripts, images, frames, digits, options: None, files, film: None, unfinished_scripts })
    }
}

impl Running {
    /// The marker of a frame that is being rendered, and whether it is fresh.
    fn read(images: &Path, name: &str, frame: usize) -> Option<(Running, bool)> {
        let path = images.join(HIDDEN).join("running").join(name);
        let touched = fs::metadata(&path).ok()?.modified().ok()?;
        let text = fs::read_to_string(&path).ok()?;
        let mut words = text.split_whitespace();
        let host = words.next()?.to_owned();
        let process = words.next()?.parse().ok()?;
        let since = words.next()?.parse().ok()?;
        // The clock of another machine may be ahead.
        let age = SystemTime::now().duration_since(touched).unwrap_or_default();
        Some((Running { frame, host, process, since }, age < HEARTBEATS))
    }
}

impl Failed {
    /// Why a frame failed, unless its script has changed since.
    fn read(images: &Path, name: &str, frame: usize, script: &Path) -> Option<Failed> {
        let path = images.join(HIDDEN).join("failed").join(format!("{name}.txt"));
        let text = fs::read_to_string(&path).ok()?;
        let modified = |path: &Path| fs::metadata(path).and_then(|metadata| metadata.modified()).ok();
        if modified(script) > modified(&path) {
            return None;
        }
        let reason = visible(text.lines().next().unwrap_or_default());
        Some(Failed { frame, reason })
    }
}

/// Whether a film consists of these images, according to the note of `render-video`.
fn is_made(film: &Path, how: &str, place: &Place) -> bool {
    let mut hasher = Sha256::new();
    hasher.update(format!("{how}\n"));
    for frame in &place.frames {
        let name = place.name(*frame);
        let Ok(record) = fs::read_to_string(Record::path(&place.images, &name)) else { return false };
        hasher.update(format!("{}\n", record.trim_end_matches('\n')));
    }
    let digest: String = hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    let noted = fs::read_to_string(Record::path(&place.images, "film")).unwrap_or_default();
    fs::metadata(film).is_ok_and(|film| film.is_file() && film.len() > 0)
        && noted.trim_end() == format!("film {digest}")
}
