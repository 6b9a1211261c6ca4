//! A progress bar on the terminal for long tasks.

use std::borrow::Cow;
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::{Duration, Instant};

use crate::Scene;
use crate::output::OutputError;
use crate::physics::PairCounter;
use crate::simulate::Workload;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use super::{Failure, terminal};

/// The duration of a task after which its progress bar appears.
const BAR_DELAY: Duration = Duration::from_secs(1);
/// The interval between two updates of the bar.
const UPDATE_INTERVAL: Duration = Duration::from_millis(200);

/// A progress bar on standard error, shown for tasks that take more than a second. If standard error is no terminal, nothing is shown.
///
/// One step (one frame) of a simulation may take minutes, so the bar also moves within a step: in proportion to the interactions between
/// pairs of bodies that have been computed.
pub(super) struct Progress(Arc<Shared>);

struct Shared {
    bar: ProgressBar,
    start: Instant,
    pair_counter: PairCounter,
    workload: Workload,
    steps: Mutex<Steps>,
}

/// The progress of the task in steps.
#[derive(Default)]
struct Steps {
    /// The number of steps that the task has finished.
    done: usize,
    /// The position of the bar at the end of the last finished step.
    position: u64,
    /// The number of interactions computed up to the end of the last finished step.
    before: u64,
    /// True if the bar is already shown, or if it can never be shown because standard error is no terminal.
    shown: bool,
}

impl Progress {
    /// Makes a bar for a task with this many steps. The bar is hidden at first.
    pub(super) fn new(steps: usize) -> Progress {
        Progress::with(steps as u64, Workload::default(), "{msg:12} {wide_bar} {percent:>3} %  {left}")
    }

    /// Makes a bar for the simulation of a scene and the writing of this many scripts after it.
    pub(super) fn of_run(scene: &Scene, scripts: usize) -> Progress {
        let workload = Workload::of(scene);
        let steps = scene.simulation.timeline.frames() + scripts;
        let length = (0..steps).map(|step| weight(workload, step)).fold(0, u64::saturating_add);
        Progress::with(length, workload, "{msg:12} {wide_bar} {percent:>3} %  {left}")
    }

    /// Makes a bar for rendering this many frames.
    pub(super) fn of_frames(frames: usize) -> Progress {
        let template = "rendering    {wide_bar} {pos} of {len}  {per_sec}  {left}  {msg}";
        Progress::with(frames as u64, Workload::default(), template)
    }

    /// Makes a spinner for a task of unknown length. It shows the elapsed time.
    pub(super) fn waiting(what: &'static str) -> Progress {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{msg:12} {spinner} {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(what);
        bar.enable_steady_tick(UPDATE_INTERVAL);
        let steps = Mutex::new(Steps { shown: true, ..Steps::default() });
        let (pair_counter, workload) = (PairCounter::default(), Workload::default());
        Progress(Arc::new(Shared { bar, start: Instant::now(), pair_counter, workload, steps }))
    }

    fn with(length: u64, workload: Workload, template: &str) -> Progress {
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.with_key("left", left));
        }
        let steps = Mutex::new(Steps { shown: !std::io::stderr().is_terminal(), ..Steps::default() });
        let is_watched = !steps.lock().unwrap_or_else(PoisonError::into_inner).shown;
        let pair_counter = PairCounter::default();
        let shared = Arc::new(Shared { bar, start: Instant::now(), pair_counter, workload, steps });
        if is_watched {
            let weak = Arc::downgrade(&shared);
            std::thread::spawn(move || look(&weak));
        }
        Progress(shared)
    }

    /// Returns the counter of computed interactions. The simulation increments it, and the bar shows its progress.
    pub(super) fn pair_counter(&self) -> &PairCounter {
        &self.0.pair_counter
    }

    /// Shows the name of the current phase beside the bar.
    pub(super) fn phase(&self, what: impl Into<Cow<'static, str>>) {
        self.0.bar.set_message(what);
    }

    /// Calls `say` to print a message above the bar, which is hidden meanwhile.
    pub(super) fn above(&self, say: impl FnOnce()) {
        self.0.bar.suspend(say);
    }

    /// Counts one more finished step and moves the bar.
    pub(super) fn step(&self) {
        let shared = &self.0;
        let mut steps = shared.steps.lock().unwrap_or_else(PoisonError::into_inner);
        steps.position = steps.position.saturating_add(weight(shared.workload, steps.done));
        steps.done += 1;
        steps.before = shared.pair_counter.done();
        shared.show(&mut steps);
    }

    /// Removes the bar from the terminal at the end of the task.
    pub(super) fn finish(&self) {
        self.0.bar.finish_and_clear();
    }

    /// Removes the bar and prints the error of a failed task.
    pub(super) fn failed(&self, error: &OutputError) -> Failure {
        self.finish();
        terminal::report(&error.report());
        Failure::Errors
    }
}

impl Shared {
    /// Moves the bar to the current progress. Shows it if the task has taken long enough.
    fn show(&self, steps: &mut Steps) {
        // Within a step, the bar stops one unit before the step's end. Only [`Progress::step`] completes a step.
        let most = weight(self.workload, steps.done).saturating_sub(1);
        let within = self.pair_counter.done().saturating_sub(steps.before).min(most);
        self.bar.set_position(steps.position.saturating_add(within));
        if !steps.shown && self.start.elapsed() > BAR_DELAY {
            steps.shown = true;
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

/// Returns the length of a step on the bar: the expected number of interactions between bodies in its frame, or 1 if the scene has none.
fn weight(workload: Workload, step: usize) -> u64 {
    if workload.is_empty() { 1 } else { workload.of_step(step).max(1) }
}

/// Updates a bar at regular intervals, until it is finished or dropped.
fn look(bar: &Weak<Shared>) {
    while let Some(shared) = bar.upgrade().filter(|shared| !shared.bar.is_finished()) {
        shared.show(&mut shared.steps.lock().unwrap_or_else(PoisonError::into_inner));
        shared.bar.tick();
        drop(shared);
        std::thread::sleep(UPDATE_INTERVAL);
    }
}

/// Writes the estimated remaining time. It is unknown until the bar has moved.
fn left(state: &ProgressState, out: &mut dyn std::fmt::Write) {
    // A write error only means that the bar is not shown.
    let _ = match state.pos() {
        0 => write!(out, "time left unknown"),
        _ => write!(out, "{:#} left", HumanDuration(state.eta())),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_moves_within_a_step_by_what_is_computed() {
        let text = "[body.star]\nrepeat = 200\nshape.sphere.radius = 0.1\nlocation = ['i', 0, 0]\n\
                    [force.f.gravitation]\n[simulation]\nduration = 0.04\n";
        let scene = Scene::parse(text).unwrap();
        let progress = Progress::of_run(&scene, 2);
        let shared = &progress.0;
        let position = || {
            shared.show(&mut shared.steps.lock().unwrap());
            shared.bar.position()
        };
        assert_eq!(position(), 0);
        let mut frames = crate::simulate::Frames::watched(&scene, progress.pair_counter());
        frames.next();
        let first = position();
        assert!(first > 0, "a frame is computed, and no step is done");
        progress.step();
        assert!(position() > first);
        frames.next();
        progress.step();
        (0..2).for_each(|_| progress.step());
        assert_eq!(position(), shared.bar.length().unwrap());
    }
}
