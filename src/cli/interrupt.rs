//! Ctrl-C: a request to stop, which long tasks check.

use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// From now on, Ctrl-C (or a termination signal) sets this flag; a second one ends the process at once.
pub(super) fn watched() -> &'static AtomicBool {
    let handler = || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    // Without a handler, Ctrl-C ends the process as usual, and the next run sweeps up.
    let _ = ctrlc::set_handler(handler);
    &STOP
}
