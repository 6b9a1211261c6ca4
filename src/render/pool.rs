//! Runs a pool of POV-Ray processes that keeps the processors busy.
//!
//! POV-Ray waits 0.3 s before its first image and 0.1 to 0.2 s between two images, whatever they show. So the pool has more processes than
//! processors. The number of processes follows from these waiting times and the measured rendering time of the images.

use std::collections::{HashMap, VecDeque};
use std::io::{self, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::images::Finished;
use super::process::{Process, RenderTask, Setup, Step};
use super::{Images, RenderError};
use crate::system;

/// POV-Ray's warning of the sheared camera of one of two eyes. This camera is meant to be so.
const WARNING_OF_EYES: &str = "Camera vectors are not perpendicular";

/// The time that a POV-Ray process waits between two images, s, measured with POV-Ray 3.7.
const IDLE_SECONDS_PER_IMAGE: f64 = 0.2;

/// The number of processes per processor until the first images are measured.
const INITIAL_PROCESSES_PER_CPU: usize = 4;
/// The largest number of processes per processor after the first images are measured.
const MAX_PROCESSES_PER_CPU: usize = 12;

/// The interval between two polls of the POV-Ray processes.
const POLL_INTERVAL: Duration = Duration::from_millis(8);

/// The result of rendering one picture (a [`RenderTask`]).
pub(super) enum TaskResult {
    /// The image was rendered: the file, and its rendering time in s. It exists until this result has been handled.
    Image(Finished, f64),
    /// POV-Ray has reported this error in the script.
    Broken(String),
    /// POV-Ray has crashed for this reason, and all retries are used up.
    Died(String),
}

/// The POV-Ray processes, and the queue of pictures to render.
pub(super) struct Pool<'a> {
    pub(super) setup: Setup<'a>,
    pub(super) images: &'a Images,
    /// The number of processes. `None` for as many as keep the processors busy.
    pub(super) jobs: Option<usize>,
    /// The number of new attempts for a picture after POV-Ray has crashed on it.
    pub(super) retries: u32,
    pub(super) time_limit: Option<Duration>,
    pub(super) stop: &'a AtomicBool,
    processors: usize,
    running: Vec<Process>,
    queue: VecDeque<RenderTask>,
    /// The number of POV-Ray's crashes on each picture.
    deaths: HashMap<RenderTask, u32>,
    started: usize,
    /// The number of images so far, their total time, and the time of the slowest one, s.
    measured: (usize, f64, f64),
    warnings: Vec<String>,
}

impl<'a> Pool<'a> {
    pub(super) fn new(setup: Setup<'a>, images: &'a Images, stop: &'a AtomicBool) -> Pool<'a> {
        Pool {
            setup,
            images,
            jobs: None,
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

    /// Renders all pictures. `done` receives the result of each. Returns false if the user has stopped the program.
    ///
    /// # Errors
    /// If the disk is full, a folder has disappeared, or `done` fails.
    pub(super) fn run(
        &mut self,
        tasks: impl IntoIterator<Item = RenderTask>,
        done: &mut dyn FnMut(RenderTask, TaskResult) -> Result<(), RenderError>,
    ) -> Result<bool, RenderError> {
        self.queue = tasks.into_iter().collect();
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
            thread::sleep(POLL_INTERVAL);
        }
        Ok(true)
    }

    /// Returns the number of processes that have been started so far.
    pub(super) fn started(&self) -> usize {
        self.started
    }

    /// Takes the warnings that POV-Ray has printed, each text once.
    pub(super) fn warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.warnings)
    }

    /// Returns the number of processes that keeps all processors busy.
    fn wanted(&self) -> usize {
        if let Some(jobs) = self.jobs {
            return jobs;
        }
        let (images, cost, _) = self.measured;
        let processors = self.processors;
        if images < processors {
            INITIAL_PROCESSES_PER_CPU * processors
        } else {
            #[allow(clippy::cast_precision_loss, reason = "numbers of images and processors are small")]
            let (each, processors) = (cost / images as f64, processors as f64);
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it is small and positive"
            )]
            let busy =
                (processors * (1.0 + IDLE_SECONDS_PER_IMAGE / each.max(1e-3))).min(1e3).ceil() as usize;
            busy.clamp(self.processors + 2, MAX_PROCESSES_PER_CPU * self.processors)
        }
    }

    /// Returns the number of pictures for a new process. It becomes small at the end of the job, so that all processes end at about the
    /// same time.
    fn share(&self) -> usize {
        /// The largest number of pictures for one process. More do not save time.
        const MOST_UNITS: usize = 200;
        let (left, processes) = (self.queue.len(), self.wanted());
        let is_first_round = self.started < processes;
        if is_first_round && left <= 4 * processes {
            left.div_ceil(processes - self.started)
        } else {
            left.div_ceil(2 * processes).min(MOST_UNITS)
        }
    }

    /// Starts a process that renders the next pictures of the queue.
    fn start(&mut self) -> Result<(), RenderError> {
        // The first image is rendered alone, so that the user can look at it while all others are being rendered.
        let is_first = self.started == 0;
        let share = if is_first { 1 } else { self.share() };
        let mut tasks = Vec::new();
        while let Some(next) = self.queue.front() {
            // A script that uses POV-Ray's clock needs a process of its own. So does a picture after a crash, since another picture in the
            // same process may have caused the crash.
            let alone = next.asks_clock || self.deaths.contains_key(next);
            if tasks.len() >= share || (alone && !tasks.is_empty()) {
                break;
            }
            tasks.extend(self.queue.pop_front());
            if alone {
                break;
            }
        }
        let folder = self.images.work_folder(self.started)?;
        let low_priority = !is_first && self.measured.0 == 0 && self.jobs.is_none();
        let process = Process::start(&self.setup, folder, tasks, low_priority);
        self.running.push(process?);
        self.started += 1;
        Ok(())
    }

    /// Handles an event of the process with this index. Returns true if the process is still running.
    fn take(
        &mut self,
        index: usize,
        step: Step,
        done: &mut dyn FnMut(RenderTask, TaskResult) -> Result<(), RenderError>,
    ) -> Result<bool, RenderError> {
        match step {
            Step::Working => return Ok(true),
            Step::Image { task, image, seconds } => {
                let (images, cost, slowest) = self.measured;
                self.measured = (images + 1, cost + seconds, slowest.max(seconds));
                done(task, TaskResult::Image(image, seconds))?;
                return Ok(true);
            }
            Step::Done => {}
            Step::Broken { message, left } => {
                let mut left = left.into_iter();
                let broken = left.next();
                // The remaining pictures go back to the front of the queue.
                left.rev().for_each(|task| self.queue.push_front(task));
                if let Some(task) = broken {
                    self.queue.retain(|other| other.index != task.index);
                    done(task, TaskResult::Broken(message))?;
                }
            }
            Step::Died { why, left } => {
                self.probe(index)?;
                let mut left = left.into_iter();
                let died = left.next();
                left.rev().for_each(|task| self.queue.push_front(task));
                if let Some(task) = died {
                    self.again(task, &why, done)?;
                }
            }
        }
        let process = self.running.swap_remove(index);
        for line in process.warnings().split_inclusive('\n') {
            if line.contains("Warning")
                && !line.contains(WARNING_OF_EYES)
                && self.warnings.len() < 20
                && !self.warnings.iter().any(|w| w == line.trim())
            {
                self.warnings.push(line.trim().to_owned());
            }
        }
        Ok(false)
    }

    /// Queues a picture again after POV-Ray has crashed on it, unless all retries are used up.
    fn again(
        &mut self,
        task: RenderTask,
        why: &str,
        done: &mut dyn FnMut(RenderTask, TaskResult) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let deaths = self.deaths.entry(task.clone()).or_insert(0);
        *deaths += 1;
        if *deaths > self.retries {
            self.queue.retain(|other| other.index != task.index);
            let times = if *deaths == 1 { String::new() } else { format!(" ({deaths} times)") };
            return done(task, TaskResult::Died(format!("POV-Ray gave no image: {why}{times}")));
        }
        self.queue.push_front(task);
        Ok(())
    }

    /// Checks for free disk space by writing a test file, since POV-Ray does not report a full disk.
    fn probe(&self, index: usize) -> Result<(), RenderError> {
        let folder = self.running[index].folder();
        let bytes = vec![0x5a; 1 << 20];
        let written =
            folder.create("probe").map_err(io::Error::from).and_then(|mut file| file.write_all(&bytes));
        let removed = folder.remove_file("probe").map(drop).map_err(io::Error::from);
        written.and(removed).map_err(RenderError::io(self.images.folder()))
    }

    /// Kills processes that hang or exceed the time limit.
    fn guard(
        &mut self,
        done: &mut dyn FnMut(RenderTask, TaskResult) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let seconds = system::cpu_seconds_by_group();
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

    /// Returns the default time limit for a frame, which is far above the times of the frames so far.
    fn usual_limit(&self) -> Duration {
        /// The time limit for a frame until the time of a first frame is known.
        const INITIAL_TIME_LIMIT: Duration = Duration::from_secs(24 * 3600);
        let (images, _, slowest) = self.measured;
        if images == 0 {
            return INITIAL_TIME_LIMIT;
        }
        #[allow(clippy::cast_precision_loss, reason = "the number of processes is small")]
        let sharing = (self.running.len().div_ceil(self.processors)) as f64;
        Duration::from_secs_f64(120.0 + 50.0 * slowest * sharing)
    }
}
