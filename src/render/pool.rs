//! A pool of POV-Ray processes that keeps the processors busy.
//!
//! POV-Ray waits 0.3 s before its first image and 0.1 to 0.2 s between two, whatever they cost. So there are more processes
//! than processors: their number follows from these waits and the measured cost of images.

use std::collections::{HashMap, VecDeque};
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::process::{Process, Setup, Step, Unit};
use super::{Images, RenderError, cpu};

/// The time that POV-Ray waits between two images, s. Measured on POV-Ray 3.7.
const WAIT: f64 = 0.2;

/// Processes for each processor: before any measurement, and at most.
const FIRST: usize = 4;
const MOST: usize = 12;

/// How often all processes are polled.
const TICK: Duration = Duration::from_millis(8);

/// The result of a unit.
pub(super) enum Fate {
    /// Its image is at this path, and stays there until this event is handled. It took this many seconds.
    Image(PathBuf, f64),
    /// POV-Ray reports this error in its script.
    Broken(String),
    /// POV-Ray died for this reason, and retries are exhausted.
    Died(String),
}

/// The processes, and the queue of units.
pub(super) struct Pool<'a> {
    pub(super) setup: Setup<'a>,
    pub(super) images: &'a Images,
    /// The number of processes, if it is given.
    pub(super) jobs: Option<usize>,
    /// The memory that a process may need, bytes.
    pub(super) memory: u64,
    /// How often a unit is tried again after POV-Ray has died on it.
    pub(super) retries: u32,
    pub(super) time_limit: Option<Duration>,
    pub(super) stop: &'a AtomicBool,
    processors: usize,
    running: Vec<Process>,
    queue: VecDeque<Unit>,
    /// How often POV-Ray has died on a unit.
    deaths: HashMap<Unit, u32>,
    started: usize,
    /// The images so far: their number, their total cost, and the wall-clock time of the slowest, s.
    measured: (usize, f64, f64),
    warnings: Vec<String>,
}

impl<'a> Pool<'a> {
    pub(super) fn new(setup: Setup<'a>, images: &'a Images, stop: &'a AtomicBool) -> Pool<'a> {
        Pool {
            setup,
            images,
            jobs: None,
            memory: 0,
            retries: 2,
            time_limit: None,
            stop,
            processors: thread::available_parallelism().map_or(1, usize::from),
            running: Vec::new(),
            queue: VecDeque::new(),
            deaths: HashMap::new(),
            started: 0,
            measured: (0, 0.0, 0.0),
            warnings: Vec::new(),
        }
    }

    /// Renders all units. Returns false if the user has asked to stop. `done` receives each unit.
    ///
    /// # Errors
    /// If the disk is full or a folder is gone; or an error of `done`.
    pub(super) fn run(
        &mut self,
        units: impl IntoIterator<Item = Unit>,
        done: &mut dyn FnMut(Unit, Fate) -> Result<(), RenderError>,
    ) -> Result<bool, RenderError> {
        self.queue = units.into_iter().collect();
        let mut looked = Instant::now();
        while !(self.queue.is_empty() && self.running.is_empty()) {
            if self.stop.load(Ordering::Relaxed) {
                return Ok(false);
            }
            while !self.queue.is_empty() && self.running.len() < self.wanted() {
                self.start()?;
            }
            let mut index = 0;
            while index < self.running.len() {
                let step = self.running[index].step();
                index += usize::from(self.take(index, step, done)?);
            }
            if looked.elapsed() > Duration::from_secs(1) {
                looked = Instant::now();
                self.guard(done)?;
            }
            thread::sleep(TICK);
        }
        Ok(true)
    }

    /// The number of processes that have been started.
    pub(super) fn started(&self) -> usize {
        self.started
    }

    /// The warnings of POV-Ray, each once.
    pub(super) fn warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.warnings)
    }

    /// The number of processes that keep all processors busy.
    fn wanted(&self) -> usize {
        if let Some(jobs) = self.jobs {
            return jobs;
        }
        let (images, cost, _) = self.measured;
        let processors = self.processors;
        let busy = if images < processors {
            FIRST * processors
        } else {
            #[allow(clippy::cast_precision_loss, reason = "numbers of images and processors are small")]
            let (each, processors) = (cost / images as f64, processors as f64);
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it is small and positive"
            )]
            let busy = (processors * (1.0 + WAIT / each.max(1e-3))).min(1e3).ceil() as usize;
            busy.clamp(self.processors + 2, MOST * self.processors)
        };
        let room = cpu::available_memory().map_or(usize::MAX, |bytes| {
            let more = bytes / 2 / self.memory.max(1);
            usize::try_from(more).unwrap_or(usize::MAX).saturating_add(self.running.len())
        });
        busy.min(room.max(1))
    }

    /// The number of units for a new process. It is small at the end, so that all processes end together.
    fn share(&self) -> usize {
        /// Larger numbers do not help.
        const MOST_UNITS: usize = 200;
        let (left, processes) = (self.queue.len(), self.wanted());
        let is_first_round = self.started < processes;
        if is_first_round && left <= 4 * processes {
            left.div_ceil(processes - self.started)
        } else {
            left.div_ceil(2 * processes).min(MOST_UNITS)
        }
    }

    /// Starts a process on the next units of the queue.
    fn start(&mut self) -> Result<(), RenderError> {
        // The user wants to look at the first image while the others are being made.
        let is_first = self.started == 0;
        let share = if is_first { 1 } else { self.share() };
        let mut units = Vec::new();
        while let Some(next) = self.queue.front() {
            // Other frames in the same process may have caused POV-Ray's death.
            let alone = next.asks_clock || self.deaths.contains_key(next);
            if units.len() >= share || (alone && !units.is_empty()) {
                break;
            }
            units.extend(self.queue.pop_front());
            if alone {
                break;
            }
        }
        let folder = self.images.work_folder(self.started)?;
        let humble = !is_first && self.measured.0 == 0 && self.jobs.is_none();
        let process = Process::start(&self.setup, folder.clone(), units, humble);
        self.running.push(process.map_err(RenderError::io(folder))?);
        self.started += 1;
        Ok(())
    }

    /// Handles the news of a process. Returns whether it goes on.
    fn take(
        &mut self,
        index: usize,
        step: Step,
        done: &mut dyn FnMut(Unit, Fate) -> Result<(), RenderError>,
    ) -> Result<bool, RenderError> {
        match step {
            Step::Working => return Ok(true),
            Step::Image { unit, path, seconds } => {
                let (images, cost, slowest) = self.measured;
                self.measured = (images + 1, cost + seconds, slowest.max(seconds));
                done(unit, Fate::Image(path, seconds))?;
                return Ok(true);
            }
            Step::Done => {}
            Step::Broken { message, left } => {
                let mut left = left.into_iter();
                let broken = left.next();
                // The remaining units are unchanged.
                left.rev().for_each(|unit| self.queue.push_front(unit));
                if let Some(unit) = broken {
                    self.queue.retain(|other| other.index != unit.index);
                    done(unit, Fate::Broken(message))?;
                }
            }
            Step::Died { why, left } => {
                self.probe(index)?;
                let mut left = left.into_iter();
                let died = left.next();
                left.rev().for_each(|unit| self.queue.push_front(unit));
                if let Some(unit) = died {
                    self.again(unit, &why, done)?;
                }
            }
        }
        let process = self.running.swap_remove(index);
        for line in process.warnings().split_inclusive('\n') {
            if line.contains("Warning")
                && self.warnings.len() < 20
                && !self.warnings.iter().any(|w| w == line.trim())
            {
                self.warnings.push(line.trim().to_owned());
            }
        }
        Ok(false)
    }

    /// Tries a unit again after POV-Ray has died on it, unless retries are exhausted.
    fn again(
        &mut self,
        unit: Unit,
        why: &str,
        done: &mut dyn FnMut(Unit, Fate) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let deaths = self.deaths.entry(unit.clone()).or_insert(0);
        *deaths += 1;
        if *deaths > self.retries {
            self.queue.retain(|other| other.index != unit.index);
            let times = if *deaths == 1 { String::new() } else { format!(" ({deaths} times)") };
            return done(unit, Fate::Died(format!("POV-Ray gave no image: {why}{times}")));
        }
        self.queue.push_front(unit);
        Ok(())
    }

    /// Checks for free disk space; POV-Ray itself does not report a full disk.
    fn probe(&self, index: usize) -> Result<(), RenderError> {
        let folder = self.running[index].folder();
        let path = folder.join("probe");
        let bytes = vec![0x5a; 1 << 20];
        let result = fs::write(&path, &bytes);
        let removed = fs::remove_file(&path);
        result.and(removed).map_err(RenderError::io(self.images.folder()))
    }

    /// Ends processes that hang.
    fn guard(
        &mut self,
        done: &mut dyn FnMut(Unit, Fate) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let seconds = cpu::seconds_by_group();
        let limit = self.time_limit.unwrap_or_else(|| self.usual_limit());
        let mut index = 0;
        while index < self.running.len() {
            let process = &mut self.running[index];
            let cpu = process.group().and_then(|group| seconds.as_ref()?.get(&group).copied());
            let step = process.guard(cpu, limit);
            index += usize::from(self.take(index, step, done)?);
        }
        Ok(())
    }

    /// The time limit for a frame, from the times of other frames.
    fn usual_limit(&self) -> Duration {
        /// For the first frames, no times are known.
        const UNKNOWN: Duration = Duration::from_secs(24 * 3600);
        let (images, _, slowest) = self.measured;
        if images == 0 {
            return UNKNOWN;
        }
        #[allow(clippy::cast_precision_loss, reason = "the number of processes is small")]
        let sharing = (self.running.len().div_ceil(self.processors)) as f64;
        Duration::from_secs_f64(120.0 + 50.0 * slowest * sharing)
    }
}
