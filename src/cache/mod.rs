//! Keeps runs between commands, so that a change of a color or a camera needs no new simulation.
//!
//! A kept run is a file in the user's cache folder, named by the digest of everything that moves bodies. No result depends on
//! it: a file that is damaged, missing or of another version is made again.
//!
//! | what | where |
//! | --- | --- |
//! | the name of a file | `digest` |
//! | the contents of a file | `file` |
//! | the pages of a run while it is simulated | `spill` |
//! | the point at which a stopped run resumes | `checkpoint` |

mod checkpoint;
mod digest;
mod file;
mod spill;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};
use std::{env, fs, io};

use crate::dynamics::Effort;
use crate::scene::Scene;
use crate::simulate::{Counts, Frame, Moments, Recorded, Recorder, Recording, SimulateError};

pub use spill::Spill;

/// Runs that were simulated faster than this are not kept.
const QUICK: Duration = Duration::from_millis(200);
/// The default limit of the cache, bytes.
const USUAL_LIMIT: u64 = 2_000_000_000;
/// The ending of the names of kept runs.
const KEPT: &str = "run";
/// The ending of their names while they are being written.
const PART: &str = "part";
/// The ending of the names of checkpoints, which are beside the pages.
const STOPPED: &str = "checkpoint";
/// The ending of the names of checkpoints while they are being written.
const SAVING: &str = "saving";
/// The default interval at which a long run is saved.
const USUAL_INTERVAL: Duration = Duration::from_secs(30);

/// A folder that keeps runs, with its limits.
#[derive(Clone, Debug)]
pub struct Cache {
    /// None: nothing is kept.
    folder: Option<PathBuf>,
    /// The largest size of all kept runs, bytes.
    limit: u64,
    /// Runs that took less time than this are not kept.
    quick: Duration,
    /// The interval at which a long run is saved.
    interval: Duration,
}

/// The contents of a cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Holding {
    /// The number of runs.
    pub runs: usize,
    /// The number of stopped runs that can go on.
    pub stopped: usize,
    /// Their size, bytes.
    pub bytes: u64,
}

impl Cache {
    /// A cache that keeps nothing.
    #[must_use]
    pub fn none() -> Cache {
        Cache { folder: None, limit: 0, quick: QUICK, interval: USUAL_INTERVAL }
    }

    /// A cache that keeps at most this many bytes in a folder. The folder is made when it is needed.
    #[must_use]
    pub fn new(folder: PathBuf, limit: u64) -> Cache {
        Cache { folder: Some(folder), limit, quick: QUICK, interval: USUAL_INTERVAL }
    }

    /// The same cache, but it keeps runs however fast they were simulated.
    #[must_use]
    pub fn keeping_all(self) -> Cache {
        Cache { quick: Duration::ZERO, ..self }
    }

    /// The same cache, but with this interval between saves of a long run. A stopped run goes on from its last save.
    #[must_use]
    pub fn saving_every(self, interval: Duration) -> Cache {
        Cache { interval, ..self }
    }

    /// The user's: in `JABUKA_CACHE_DIR`, or `jabuka` below `XDG_CACHE_HOME` or `~/.cache`; at most `JABUKA_CACHE_SIZE` MB,
    /// or 2 GB. With `JABUKA_CACHE_ALL=1`, runs are kept however fast they were simulated.
    ///
    /// # Errors
    /// If `JABUKA_CACHE_SIZE` or `JABUKA_CHECKPOINT_SECONDS` is not a number; the message says so.
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
        // The rules of XDG: a path that is not absolute does not count.
        let of_xdg = variable("XDG_CACHE_HOME").filter(|path| path.is_absolute());
        let caches = of_xdg.or_else(|| variable("HOME").map(|home| home.join(".cache")));
        let folder = variable("JABUKA_CACHE_DIR").or_else(|| caches.map(|caches| caches.join("jabuka")));
        Ok(match folder {
            Some(folder) if limit > 0 && variable("JABUKA_CACHE_ALL").is_some() => {
                Cache::new(folder, limit).keeping_all().saving_every(interval)
            }
            Some(folder) if limit > 0 => Cache::new(folder, limit).saving_every(interval),
            _ => Cache::none(),
        })
    }

    /// The cache folder. `None` if caching is off.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// A run of a scene: the kept one, or else a new one. Counts the interactions of pairs meanwhile, and calls `seen` for
    /// every frame.
    ///
    /// # Errors
    /// If the run becomes non-finite, or there is no room for its recording.
    pub fn run<'a>(
        &self,
        scene: &'a Scene,
        moments: Moments,
        effort: &Effort,
        seen: impl FnMut(&Frame),
    ) -> Result<Recorded<'a>, SimulateError> {
        let recorded = self.run_to_breakdown(scene, moments, effort, seen)?;
        recorded.breakdown().map_or(Ok(()), |breakdown| Err(breakdown.clone()))?;
        Ok(recorded)
    }

    /// Like [`run`](Self::run), but if the run breaks down, it gives the frames before: see [`Recorded::breakdown`]. Such a run
    /// is not kept.
    ///
    /// # Errors
    /// If there is no frame before the breakdown, or there is no room for the recording.
    pub fn run_to_breakdown<'a>(
        &self,
        scene: &'a Scene,
        moments: Moments,
        effort: &Effort,
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
                // A run that cannot be saved goes on unsaved.
                let _: io::Result<bool> = save(&spill, &mut recorder);
                saved = Instant::now();
            }
        }
        let recorded = recorder.finish()?;
        self.keep(&spill, recorded.recording(), if was_stopped { Duration::MAX } else { start.elapsed() });
        Ok(recorded)
    }

    /// A stopped run of the scene, at its last checkpoint. Calls `seen` for every frame up to there.
    fn resume<'a>(
        &self,
        scene: &'a Scene,
        moments: &Moments,
        effort: &Effort,
        seen: &mut dyn FnMut(&Frame),
    ) -> Option<(Spill, Recorder<'a>)> {
        let folder = self.folder.clone().filter(|_| digest::is_worth_keeping(scene))?;
        let (spill, checkpoint) = Spill::resume(folder, digest::of(scene, moments))?;
        let store = Box::new(spill.clone());
        let recorder = Recorder::resume(scene, moments.clone(), effort, (&checkpoint, store), seen)?;
        Some((spill, recorder))
    }

    /// The kept run of a scene, if there is one. Damage may only show when it is read.
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

    /// Removes the damaged run of a scene.
    pub fn forget(&self, scene: &Scene, moments: &Moments) {
        if let Some(path) = self.path(scene, moments) {
            // Another process may have removed it.
            let _: io::Result<()> = fs::remove_file(path);
        }
    }

    /// The store for the pages of a new run.
    #[must_use]
    pub fn spill(&self, scene: &Scene, moments: &Moments) -> Spill {
        match &self.folder {
            Some(folder) if digest::is_worth_keeping(scene) => {
                Spill::to_keep(folder.clone(), digest::of(scene, moments))
            }
            _ => Spill::unnamed(),
        }
    }

    /// Keeps a run that took this long to simulate, if it is worth keeping. Then removes the least recently used runs, until
    /// the rest is within the limit. Failing to keep a run is no error.
    pub fn keep(&self, spill: &Spill, recording: &Recording, took: Duration) {
        let Some(folder) = &self.folder else { return };
        let kept = took >= self.quick
            && recording.index().and_then(|index| spill.keep(&index)).is_ok_and(|kept| kept);
        if kept {
            // The next run tries again.
            let _: io::Result<()> = self.tidy(folder);
        }
    }

    /// The contents of the cache.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn holding(&self) -> io::Result<Holding> {
        let Some(folder) = &self.folder else { return Ok(Holding::default()) };
        let (kept, stopped) = (files(folder, KEPT)?, stopped(folder)?);
        let bytes = kept.iter().chain(&stopped).map(|kept| kept.bytes).sum();
        Ok(Holding { runs: kept.len(), stopped: stopped.len(), bytes })
    }

    /// Removes all kept runs, and returns their number and size.
    ///
    /// # Errors
    /// If a file cannot be removed.
    pub fn clear(&self) -> io::Result<Holding> {
        let held = self.holding()?;
        let Some(folder) = &self.folder else { return Ok(held) };
        sweep(folder)?;
        files(folder, KEPT)?.iter().chain(&stopped(folder)?).try_for_each(Kept::remove)?;
        Ok(held)
    }

    fn tidy(&self, folder: &Path) -> io::Result<()> {
        sweep(folder)?;
        let mut kept = files(folder, KEPT)?;
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
/// If the run becomes non-finite, or there is no room for its recording.
pub fn simulate(scene: &Scene) -> Result<Recorded<'_>, SimulateError> {
    Cache::none().run(scene, Moments::of(scene), &Effort::default(), |_| {})
}

/// A file of the cache.
struct Kept {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
}

impl Kept {
    fn remove(&self) -> io::Result<()> {
        if self.path.extension().is_some_and(|extension| extension == PART) {
            // Only under the lock, since a process may be continuing this run.
            let locked = checkpoint::lock(&self.path);
            locked.iter().for_each(|_| checkpoint::remove(&self.path));
            return Ok(());
        }
        remove(&self.path)
    }
}

/// Saves a run in case it is stopped. Returns whether that was possible.
fn save(spill: &Spill, recorder: &mut Recorder<'_>) -> io::Result<bool> {
    let Some(checkpoint) = recorder.checkpoint()? else { return Ok(false) };
    spill.save(&checkpoint)
}

/// The stopped runs of a folder that can go on: the files of their pages. The file of a run that is being simulated is locked.
fn stopped(folder: &Path) -> io::Result<Vec<Kept>> {
    let of_checkpoint = |found: Kept| {
        let path = found.path.with_extension(PART);
        let bytes = found.bytes + fs::metadata(&path).ok()?.len();
        checkpoint::lock(&path)?;
        Some(Kept { path, bytes, used: found.used })
    };
    Ok(files(folder, STOPPED)?.into_iter().filter_map(of_checkpoint).collect())
}

/// The files of a folder whose names have this ending; none if there is no folder.
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
        // Another process may remove it meanwhile.
        let Ok(about) = fs::symlink_metadata(&path) else { continue };
        if about.is_file() {
            let used = about.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            files.push(Kept { path, bytes: about.len(), used });
        }
    }
    Ok(files)
}

/// Removes the files of killed runs that cannot go on. Nobody has locked these files.
fn sweep(folder: &Path) -> io::Result<()> {
    for part in files(folder, PART)? {
        let is_left = fs::File::open(&part.path).is_ok_and(|file| file.try_lock().is_ok());
        if is_left && !checkpoint::beside(&part.path).exists() {
            remove(&part.path)?;
        }
    }
    for ending in [STOPPED, SAVING] {
        for left in files(folder, ending)? {
            let part = left.path.with_extension(PART);
            let is_left = !part.exists() || ending == SAVING && checkpoint::lock(&part).is_some();
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
