//! Handles Ctrl-C: sets a flag that long tasks check, so that they can stop cleanly.

use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// Installs a handler for Ctrl-C and termination signals, and returns the flag that the first signal sets. A second signal ends the
/// process at once.
pub(super) fn watched() -> &'static AtomicBool {
    let handler = || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    // If no handler can be installed, Ctrl-C ends the process as usual, and the next run removes its temporary files.
    let _ = ctrlc::set_handler(handler);
    &STOP
}
