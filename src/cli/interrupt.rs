//! Handles signals. Ctrl-C: tasks that can stop cleanly check a flag. Long simulations end at once and say how they can be continued.

use std::sync::atomic::{AtomicBool, Ordering};

use super::terminal;

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

/// Installs a handler for Ctrl-C and termination signals that ends the process and tells the user that the simulation can be continued. If
/// another handler is installed already, it stays.
pub(super) fn announced() {
    let handler = || {
        terminal::error("stopped; the same command continues the simulation from its last checkpoint\n");
        std::process::exit(130);
    };
    // Without a handler, Ctrl-C ends the process without a message.
    let _ = ctrlc::set_handler(handler);
}
