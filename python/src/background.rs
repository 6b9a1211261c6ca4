//! Runs long work in a thread of its own, while this thread lets other Python threads run and notices Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// The interval between two looks at signals and two reports of progress.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// A request to stop that several runs can share, such as those of a sweep.
#[pyclass(frozen)]
#[derive(Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

#[pymethods]
impl Stop {
    /// Creates a request that has not been made yet.
    #[new]
    fn new() -> Stop {
        Stop::default()
    }

    /// Asks everything that shares this request to stop.
    fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the request has been made.
    fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What the work and the waiting thread share.
pub(crate) struct Control {
    stop: Arc<AtomicBool>,
    /// The number of steps that are done, such as frames.
    done: AtomicUsize,
    /// The number of all steps. 0 while it is unknown.
    total: AtomicUsize,
}

impl Control {
    /// The flag that asks the work to stop.
    pub(crate) fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    /// Whether the work has been asked to stop.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Sets the number of all steps, and begins to count at 0.
    pub(crate) fn begin(&self, total: usize) {
        self.done.store(0, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    /// Counts a step as done.
    pub(crate) fn step(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Sets the number of steps that are done.
    pub(crate) fn set_done(&self, done: usize) {
        self.done.store(done, Ordering::Relaxed);
    }
}

/// The result of work, and the Python exception that stopped it, if any: usually `KeyboardInterrupt`.
pub(crate) struct Ended<T> {
    pub(crate) result: T,
    pub(crate) interrupt: Option<PyErr>,
}

impl<T> Ended<T> {
    /// Returns the result of work that is worthless if it was stopped.
    pub(crate) fn whole(self) -> PyResult<T> {
        self.interrupt.map_or(Ok(self.result), Err)
    }
}

/// Does work in a thread of its own. Ctrl-C and an exception of `progress` ask the work to stop. `progress` is called with the number of
/// done steps and of all steps, from time to time and at the end. `stop` can stop the work from other threads.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    stop: Option<&Stop>,
    work: impl FnOnce(&Control) -> T + Send,
) -> PyResult<Ended<T>> {
    let stop = stop.map_or_else(Arc::default, |stop| Arc::clone(&stop.0));
    let control = Control { stop, done: AtomicUsize::new(0), total: AtomicUsize::new(0) };
    let report = || {
        let total = control.total.load(Ordering::Relaxed);
        match progress.filter(|_| total > 0) {
            Some(progress) => progress.call1((control.done.load(Ordering::Relaxed), total)).map(drop),
            None => Ok(()),
        }
    };
    let mut interrupt = None;
    let result = std::thread::scope(|scope| {
        let (sender, mut receiver) = channel();
        let shared = &control;
        scope.spawn(move || {
            // The receiver is dropped only after the result has arrived.
            let _ = sender.send(work(shared));
        });
        loop {
            // A receiver cannot be shared between threads, so this thread alone has it.
            let waiting = &mut receiver;
            let waited = py.detach(move || waiting.recv_timeout(POLL_INTERVAL));
            match waited {
                Ok(result) => return Some(result),
                Err(RecvTimeoutError::Disconnected) => return None,
                Err(RecvTimeoutError::Timeout) => {}
            }
            if interrupt.is_none() {
                interrupt = py.check_signals().and_then(|()| report()).err();
                if interrupt.is_some() {
                    control.stop.store(true, Ordering::Relaxed);
                }
            }
        }
    });
    let result = result.ok_or_else(|| PyRuntimeError::new_err("jabuka has panicked; please report this"))?;
    if interrupt.is_none() {
        interrupt = report().err();
    }
    Ok(Ended { result, interrupt })
}
