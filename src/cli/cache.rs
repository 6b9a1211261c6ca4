//! The command `jabuka cache`: shows or removes the simulated runs that are kept between commands.

use crate::cache::{Cache, Holding};
use crate::diagnostic::{Code, Report, visible_path};

use super::summary::bytes;
use super::{Failure, terminal};

/// Show which simulated runs are kept between commands, or remove them
///
/// If the bodies of a scene move as in an earlier command, the scene is not simulated again: the run of that command was kept in
/// JABUKA_CACHE_DIR, or by default in the folder `jabuka` of XDG_CACHE_HOME or ~/.cache (on Windows: of LOCALAPPDATA). Runs that take less than 0.2 s are not kept,
/// unless JABUKA_CACHE_ALL is 1. If the kept runs exceed JABUKA_CACHE_SIZE megabytes (default: 2000; 0 keeps nothing), the least recently
/// used runs are removed.
///
/// A long run with `contacts = "time-stepping"` is saved every 10 s (or every JABUKA_CHECKPOINT_SECONDS). If it is stopped, the next
/// command that needs the run continues it.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Remove all runs that are kept
    #[arg(long)]
    clear: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let cache = Cache::of_user().map_err(Failure::Usage)?;
    let Some(folder) = cache.folder() else {
        terminal::result("nothing is kept: JABUKA_CACHE_SIZE is 0, or there is no folder for it\n");
        return Ok(());
    };
    let held = if arguments.clear { cache.clear() } else { cache.holding() };
    let Holding { runs, stopped, bytes: size } = held.map_err(|error| {
        let message = format!("`{}`: {error}", visible_path(folder));
        terminal::report(&Report::of_error(Code::CannotWrite, message));
        Failure::Errors
    })?;
    let runs = if runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") };
    let removed = if arguments.clear { " removed" } else { "" };
    let stopped = match stopped {
        0 => String::new(),
        1 => " and 1 that was stopped".to_owned(),
        stopped => format!(" and {stopped} that were stopped"),
    };
    terminal::result(&format!("{}: {runs}{stopped}, {}{removed}\n", visible_path(folder), bytes(size)));
    Ok(())
}
