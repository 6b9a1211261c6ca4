//! Keeps recorded runs between commands, so that a change of a color or a camera needs no new simulation.
//!
//! A cached run is a file in the user's cache folder. The file's name contains the digest of everything that affects the motion of bodies.
//! No result depends on the cache: a file that is damaged, missing or of another version is made again.
//!
//! | what | where |
//! | --- | --- |
//! | the digest that identifies a run | `digest` |
//! | the file of a cached run | `file` |
//! | the recorded pages of a run while it is simulated | `spill` |
//! | the state from which an interrupted run continues | `checkpoint` |
//!
//! Runs that took longer than 0.2 s are kept, in the user's cache folder. The key is the digest of everything that moves bodies, of the
//! moments, and of jabuka's sources. A file is written under another name, locked, and renamed when it is complete. Other programs can write
//! to this folder, too: a pipe, a device, a folder or a link in the place of a file counts as missing (`system/folder.rs`), so it neither
//! blocks a command nor leads it elsewhere.
//!
//! `spill` keeps the first megabyte of a recording in memory, and all other pages in a temporary file in `/var/tmp` or `TMPDIR`, each with
//! its digest.
//!
//! A long run is saved every 10 s (`checkpoint`). A checkpoint is a separate file with the state from which the dynamics continue with the
//! same bits (`Dynamics::checkpoint`; so far only the engine with rapier supports it). The process that simulates a run locks its pages, so
//! unlocked pages belong to a killed run. The next command that needs this run surveys the recorded frames again, and continues. Two
//! processes have separate files.

mod checkpoint;
mod digest;
mod file;
mod spill;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};
use std::{env, fs, io};

use crate::physics::PairCounter;
use crate::scene::Scene;
use crate::simulate::{Counts, Frame, Moments, Recorded, Recorder, Recording, SimulateError};
use crate::system;

pub use spill::Spill;

/// The computing time from which on a run is kept. Faster runs are simply repeated.
const MIN_KEPT_COMPUTING_TIME: Duration = Duration::from_millis(200);
/// The default size limit of the cache, bytes.
const USUAL_LIMIT: u64 = 2_000_000_000;
/// The file extension of cached runs.
const RUN_EXTENSION: &str = "run";
/// The file extension of runs whose simulation has not ended.
const PARTIAL_RUN_EXTENSION: &str = "part";
/// The file extension of checkpoints. A checkpoint is beside the file of its run's pages.
const CHECKPOINT_EXTENSION: &str = "checkpoint";
/// The file extension of checkpoints that are being written.
const SAVING_EXTENSION: &str = "saving";
/// The default interval between two checkpoints of a long run.
const USUAL_INTERVAL: Duration = Duration::from_secs(10);

/// The cache of recorded runs: a folder, and its limits.
#[derive(Clone, Debug)]
pub struct Cache {
    /// The cache folder. `None` if caching is off.
    folder: Option<PathBuf>,
    /// The largest total size of all cached runs, bytes.
    limit: u64,
    /// The simulation time below which a run is not kept.
    quick: Duration,
    /// The interval between two checkpoints of a long run.
    interval: Duration,
}

/// The number and size of the runs in a cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Holding {
    /// The number of complete runs.
    pub runs: usize,
    /// The number of interrupted runs that can be continued.
    pub stopped: usize,
    /// The total size of complete and interrupted runs, bytes.
    pub bytes: u64,
}

impl Cache {
    /// Makes a cache that keeps nothing.
    #[must_use]
    pub fn none() -> Cache {
        Cache { folder: None, limit: 0, quick: MIN_KEPT_COMPUTING_TIME, interval: USUAL_INTERVAL }
    }

    /// Makes a cache that keeps at most `limit` bytes in a folder. The folder is created when the first run is kept.
    #[must_use]
    pub fn new(folder: PathBuf, limit: u64) -> Cache {
        Cache { folder: Some(folder), limit, quick: MIN_KEPT_COMPUTING_TIME, interval: USUAL_INTERVAL }
    }

    /// Makes the cache keep every run, however short its simulation was.
    #[must_use]
    pub fn keeping_all(self) -> Cache {
        Cache { quick: Duration::ZERO, ..self }
    }

    /// Sets the interval between two checkpoints of a long run. An interrupted run continues from its last checkpoint.
    #[must_use]
    pub fn saving_every(self, interval: Duration) -> Cache {
        Cache { interval, ..self }
    }

    /// Returns the user's cache. Its folder is `JABUKA_CACHE_DIR`, or `jabuka` below `XDG_CACHE_HOME` or `~/.cache` (on
    /// Windows: `%LOCALAPPDATA%`). Its limit is
    /// `JABUKA_CACHE_SIZE` MB, or 2 GB. With `JABUKA_CACHE_ALL=1`, every run is kept, however short its simulation was.
    /// `JABUKA_CHECKPOINT_SECONDS` sets the interval between two checkpoints.
    ///
    /// # Errors
    /// If `JABUKA_CACHE_SIZE` or `JABUKA_CHECKPOINT_SECONDS` is not a number. The error is a message for the user.
    pub fn of_user() -> Result<Cache, String> {
        let limit = match env::var("JABUKA_CACHE_SIZE") {
            Err(env::VarError::NotPresent) => USUAL_LIMIT,
            text => text.ok().and_then(|text| text.trim().parse::<u64>().ok()).map(|mb| mb.saturating_mul(1_000_000)).ok_or(
                "JABUKA_CACHE_SIZE is a number of megabytes, as in JABUKA_CACHE_SIZE=500; with 0, nothing is kept",
            )?,
        };
        let interval = match env::var("JABUKA_CHECKPOINT_SECONDS") {
            Err(env::VarError::NotPresent) => USUAL_INTERVAL,
            text => text.ok().and_then(|text| text.trim().parse().ok()).map(Duration::from_secs).ok_or(
                "JABUKA_CHECKPOINT_SECONDS is a whole number of seconds, as in JABUKA_CHECKPOINT_SECONDS=60",
            )?,
        };
        let variable = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let usual = || Some(system::cache_folder()?.join("jabuka"));
        let folder = variable("JABUKA_CACHE_DIR").or_else(usual);
        Ok(match folder {
            Some(folder) if limit > 0 && variable("JABUKA_CACHE_ALL").is_some() => {
                Cache::new(folder, limit).keeping_all().saving_every(interval)
            }
            Some(folder) if limit > 0 => Cache::new(folder, limit).saving_every(interval),
            _ => Cache::none(),
        })
    }

    /// Returns the cache folder. `None` if caching is off.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Returns the run of a scene from the cache, or simulates the run. Meanwhile, `effort` counts the pair interactions, and `seen` is
    /// called for every frame.
    ///
    /// # Errors
    /// If a value of the run becomes non-finite, or the disk has no space for the recording.
    pub fn run<'a>(
        &self,
        scene: &'a Scene,
        moments: Moments,
        effort: &PairCounter,
        seen: impl FnMut(&Frame),
    ) -> Result<Recorded<'a>, SimulateError> {
        let recorded = self.run_to_breakdown(scene, moments, effort, seen)?;
        recorded.breakdown().map_or(Ok(()), |breakdown| Err(breakdown.clone()))?;
        Ok(recorded)
    }

    /// Returns the run of a scene as [`run`](Self::run) does. If the run breaks down, returns the frames before the breakdown; see
    /// [`Recorded::breakdown`]. Such a run is not kept.
    ///
    /// # Errors
    /// If the run breaks down before its first frame, or the disk has no space for the recording.
    pub fn run_to_breakdown<'a>(
        &self,
        scene: &'a Scene,
        moments: Moments,
        effort: &PairCounter,
        mut seen: impl FnMut(&Frame),
    ) -> Result<Recorded<'a>, SimulateError> {
        if let Some(recording) = self.find(scene, &moments) {
            if let Ok(recorded) = Recorded::read(scene, Arc::new(recording), &mut seen) {
                return Ok(recorded);
            }
            self.forget(scene, &moments);
        }
        let start = Instant::now();
        let (spill, mut recorder) = match self.resume(scene, &moments, effort, &mut seen) {
            Some(stopped) => stopped,
            None => {
                let spill = self.spill(scene, &moments);
                (spill.clone(), Recorder::new(scene, moments, effort, Box::new(spill)))
            }
        };
        let was_stopped = recorder.resumed().is_some();
        let mut saved = Instant::now();
        loop {
            match recorder.advance() {
                Ok(Some(frame)) => seen(&frame),
                Ok(None) => break,
                Err(breakdown) => return recorder.finish_early(breakdown),
            }
            if spill.has_name() && saved.elapsed() >= self.interval {
                // If a checkpoint cannot be written, the simulation continues without it.
                let _: io::Result<bool> = save(&spill, &mut recorder);
                saved = Instant::now();
            }
        }
        let recorded = recorder.finish()?;
        self.keep(&spill, recorded.recording(), if was_stopped { Duration::MAX } else { start.elapsed() });
        Ok(recorded)
    }

    /// Continues an interrupted run of the scene from its last checkpoint. Calls `seen` for every frame up to the checkpoint. `None` if
    /// there is no such run.
    fn resume<'a>(
        &self,
        scene: &'a Scene,
        moments: &Moments,
        effort: &PairCounter,
        seen: &mut dyn FnMut(&Frame),
    ) -> Option<(Spill, Recorder<'a>)> {
        let folder = self.folder.clone().filter(|_| digest::is_worth_keeping(scene))?;
        let (spill, checkpoint) = Spill::resume(folder, digest::of(scene, moments))?;
        let store = Box::new(spill.clone());
        let recorder = Recorder::resume(scene, moments.clone(), effort, &checkpoint, store, seen)?;
        Some((spill, recorder))
    }

    /// Opens the cached run of a scene. `None` if there is none, or its file is damaged. Damage of single pages is noticed only when they
    /// are read.
    #[must_use]
    pub fn find(&self, scene: &Scene, moments: &Moments) -> Option<Recording> {
        let path = self.path(scene, moments)?;
        let key = digest::of(scene, moments);
        let opened = file::open(&path, key, Counts::of(scene));
        if opened.is_err() {
            // If the file does not exist, there is nothing to remove.
            let _: io::Result<()> = fs::remove_file(&path);
        }
        opened.ok()
    }

    /// Removes the damaged cached run of a scene.
    pub fn forget(&self, scene: &Scene, moments: &Moments) {
        if let Some(path) = self.path(scene, moments) {
            // Another process may have removed the file.
            let _: io::Result<()> = fs::remove_file(path);
        }
    }

    /// Makes the store for the recorded pages of a new run.
    #[must_use]
    pub fn spill(&self, scene: &Scene, moments: &Moments) -> Spill {
        match &self.folder {
            Some(folder) if digest::is_worth_keeping(scene) => {
                Spill::to_keep(folder.clone(), digest::of(scene, moments))
            }
            _ => Spill::unnamed(),
        }
    }

    /// Keeps a run whose simulation took the time `took`, if it is worth keeping. Then removes the least recently used runs, until the
    /// cache is within its limit. A failure to keep a run is ignored.
    pub fn keep(&self, spill: &Spill, recording: &Recording, took: Duration) {
        let Some(folder) = &self.folder else { return };
        let kept = took >= self.quick
            && recording.index().and_then(|index| spill.keep(&index)).is_ok_and(|kept| kept);
        if kept {
            // If old runs cannot be removed, the next command tries again.
            let _: io::Result<()> = self.tidy(folder);
        }
    }

    /// Returns the number and size of the runs in the cache.
    ///
    /// # Errors
    /// If the cache folder cannot be read.
    pub fn holding(&self) -> io::Result<Holding> {
        let Some(folder) = &self.folder else { return Ok(Holding::default()) };
        let (kept, stopped) = (files(folder, RUN_EXTENSION)?, stopped(folder)?);
        let bytes = kept.iter().chain(&stopped).map(|kept| kept.bytes).sum();
        Ok(Holding { runs: kept.len(), stopped: stopped.len(), bytes })
    }

    /// Removes all runs from the cache, and returns their number and size.
    ///
    /// # Errors
    /// If a file cannot be removed.
    pub fn clear(&self) -> io::Result<Holding> {
        let held = self.holding()?;
        let Some(folder) = &self.folder else { return Ok(held) };
        sweep(folder)?;
        files(folder, RUN_EXTENSION)?.iter().chain(&stopped(folder)?).try_for_each(Kept::remove)?;
        Ok(held)
    }

    fn tidy(&self, folder: &Path) -> io::Result<()> {
        sweep(folder)?;
        let mut kept = files(folder, RUN_EXTENSION)?;
        kept.extend(stopped(folder)?);
        kept.sort_by(|a, b| (a.used, &a.path).cmp(&(b.used, &b.path)));
        let mut bytes: u64 = kept.iter().map(|kept| kept.bytes).sum();
        for oldest in kept {
            if bytes <= self.limit {
                break;
            }
            oldest.remove()?;
            bytes -= oldest.bytes;
        }
        Ok(())
    }

    fn path(&self, scene: &Scene, moments: &Moments) -> Option<PathBuf> {
        let folder = self.folder.as_ref().filter(|_| digest::is_worth_keeping(scene))?;
        Some(folder.join(file::name(digest::of(scene, moments))))
    }
}

/// Simulates a scene without keeping the run. The part of the recording beyond a megabyte goes to a nameless file.
///
/// # Errors
/// If a value of the run becomes non-finite, or the disk has no space for the recording.
pub fn simulate(scene: &Scene) -> Result<Recorded<'_>, SimulateError> {
    Cache::none().run(scene, Moments::of(scene), &PairCounter::default(), |_| {})
}

/// Returns whether the recording of one scene's run is also that of the other's: the same bodies move in the same way, and the same moments
/// and contacts are recorded.
#[must_use]
pub fn have_same_recording(one: &Scene, other: &Scene) -> bool {
    let key = |scene: &Scene| digest::of(scene, &Moments::of(scene));
    key(one) == key(other)
}

/// A file in the cache folder, with its size in bytes and the time of its last use.
struct Kept {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
}

impl Kept {
    fn remove(&self) -> io::Result<()> {
        if self.path.extension().is_some_and(|extension| extension == PARTIAL_RUN_EXTENSION) {
            // The file is only removed under its lock, since another process may be continuing this run.
            let locked = checkpoint::lock(&self.path);
            locked.iter().for_each(|_| checkpoint::remove(&self.path));
            return Ok(());
        }
        remove(&self.path)
    }
}

/// Writes a checkpoint of a run. Returns false if the simulation has no checkpoints, or the pages are not all in the cache folder.
fn save(spill: &Spill, recorder: &mut Recorder<'_>) -> io::Result<bool> {
    let Some(checkpoint) = recorder.checkpoint()? else { return Ok(false) };
    spill.save(&checkpoint)
}

/// Returns the files of pages of all interrupted runs that can be continued. The file of a run that is being simulated is locked, and does
/// not count.
fn stopped(folder: &Path) -> io::Result<Vec<Kept>> {
    let of_checkpoint = |found: Kept| {
        let path = found.path.with_extension(PARTIAL_RUN_EXTENSION);
        let bytes = found.bytes + fs::metadata(&path).ok()?.len();
        checkpoint::lock(&path)?;
        Some(Kept { path, bytes, used: found.used })
    };
    Ok(files(folder, CHECKPOINT_EXTENSION)?.into_iter().filter_map(of_checkpoint).collect())
}

/// Returns the files of a folder with this file extension. The list is empty if the folder does not exist.
fn files(folder: &Path, ending: &str) -> io::Result<Vec<Kept>> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?,
    };
    let mut files = Vec::new();
    for entry in entries {
        let path = entry?.path();
        if path.extension().is_none_or(|extension| extension != ending) {
            continue;
        }
        // Another process may have removed the file meanwhile.
        let Ok(about) = fs::symlink_metadata(&path) else { continue };
        if about.is_file() {
            let used = about.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            files.push(Kept { path, bytes: about.len(), used });
        }
    }
    Ok(files)
}

/// Removes the files of killed processes from which no run can be continued. No process has locked these files.
fn sweep(folder: &Path) -> io::Result<()> {
    for part in files(folder, PARTIAL_RUN_EXTENSION)? {
        let is_left = system::open(&part.path).is_ok_and(|file| file.try_lock().is_ok());
        if is_left && !checkpoint::beside(&part.path).exists() {
            remove(&part.path)?;
        }
    }
    for ending in [CHECKPOINT_EXTENSION, SAVING_EXTENSION] {
        for left in files(folder, ending)? {
            let part = left.path.with_extension(PARTIAL_RUN_EXTENSION);
            let is_left = !part.exists() || ending == SAVING_EXTENSION && checkpoint::lock(&part).is_some();
            if is_left {
                remove(&left.path)?;
            }
        }
    }
    Ok(())
}

fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        done => done,
    }
}
