//! A progress bar for what takes long.

use std::borrow::Cow;
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use jabuka::output::OutputError;

use super::{Failure, say};

/// A bar on standard error, for what takes over a second; without a terminal there is none.
pub(super) struct Progress {
    bar: ProgressBar,
    start: Instant,
    shown: AtomicBool,
}

impl Progress {
    /// A bar of so many steps, not yet shown.
    pub(super) fn new(steps: usize) -> Progress {
        Progress::with(steps, "{msg:12} {wide_bar} {percent:>3} %  {eta} left")
    }

    /// A bar of so many frames that are rendered.
    pub(super) fn of_frames(frames: usize) -> Progress {
        Progress::with(frames, "rendering    {wide_bar} {pos} of {len}  {per_sec}  {eta} left  {msg}")
    }

    fn with(steps: usize, template: &str) -> Progress {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        // Without a terminal it counts as shown, and never is.
        Progress { bar, start: Instant::now(), shown: AtomicBool::new(!std::io::stderr().is_terminal()) }
    }

    /// Says what is being done now.
    pub(super) fn phase(&self, what: impl Into<Cow<'static, str>>) {
        self.bar.set_message(what);
    }

    /// Says something above the bar.
    pub(super) fn above(&self, say: impl FnOnce()) {
        self.bar.suspend(say);
    }

    /// One step is done.
    pub(super) fn step(&self) {
        self.bar.inc(1);
        let late = || self.start.elapsed() > Duration::from_secs(1);
        if !self.shown.load(Ordering::Relaxed) && late() && !self.shown.swap(true, Ordering::Relaxed) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    /// All is done: the bar goes.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// It failed: the bar goes, and the reason is said.
    pub(super) fn failed(&self, error: &OutputError) -> Failure {
        self.finish();
        say::report(&error.report());
        Failure::Errors
    }
}
