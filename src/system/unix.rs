//! What jabuka asks of Unix: open files, processes, and the folders of the user. `windows.rs` has the same functions.

mod cpu;

use std::env;
use std::ffi::OsStr;
use std::fs::{File, Permissions};
use std::io;
use std::os::unix::fs::{FileExt as _, MetadataExt as _, PermissionsExt as _};
use std::os::unix::process::{CommandExt as _, ExitStatusExt as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};

use rustix::process::{Pid, Signal, kill_process_group};

pub(crate) use cpu::{cpu_seconds, cpu_seconds_by_group};

/// The environment variables that name the folder of temporary files.
pub(crate) const TEMPORARY_FOLDER_VARIABLES: &[&str] = &["TMPDIR"];

/// The names of the program POV-Ray, in the order in which they are looked for.
pub(crate) const POVRAY_NAMES: &[&str] = &["povray"];

/// Returns the folders outside of the `PATH` in which POV-Ray may be installed.
pub(crate) fn povray_folders() -> Vec<PathBuf> {
    Vec::new()
}

/// Returns true if an environment variable has this name.
pub(crate) fn is_variable(variable: &OsStr, name: &str) -> bool {
    variable == name
}

/// What tells a file apart from all other files that exist: its device number and inode number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FileId(u64, u64);

impl FileId {
    /// Returns the identity of an open file.
    pub(crate) fn of(file: &File) -> io::Result<FileId> {
        file.metadata().map(|metadata| FileId(metadata.dev(), metadata.ino()))
    }

    /// Returns the identity of the file at a path. Links are followed.
    pub(crate) fn of_path(path: &Path) -> io::Result<FileId> {
        path.metadata().map(|metadata| FileId(metadata.dev(), metadata.ino()))
    }

    /// Returns the identity of what is at a path. A link is not followed.
    pub(crate) fn of_name(path: &Path) -> io::Result<FileId> {
        path.symlink_metadata().map(|metadata| FileId(metadata.dev(), metadata.ino()))
    }
}

/// Returns the absolute path without links and `..`.
pub(crate) fn canonicalize(path: &Path) -> io::Result<PathBuf> {
    path.canonicalize()
}

/// Fills `bytes` from a file, beginning at `offset`.
pub(crate) fn read_exact_at(file: &File, bytes: &mut [u8], offset: u64) -> io::Result<()> {
    file.read_exact_at(bytes, offset)
}

/// Writes all of `bytes` into a file, beginning at `offset`.
pub(crate) fn write_all_at(file: &File, bytes: &[u8], offset: u64) -> io::Result<()> {
    file.write_all_at(bytes, offset)
}

/// Returns the free space for this user on the disk of an open file, bytes. `_folder` is the folder of the file.
pub(crate) fn free_bytes(file: &File, _folder: &Path) -> io::Result<u64> {
    let space = rustix::fs::fstatvfs(file)?;
    Ok(space.f_bavail.saturating_mul(space.f_frsize))
}

/// Lets everyone who may read a file also execute it.
pub(crate) fn make_executable(file: &File) -> io::Result<()> {
    let mode = file.metadata()?.permissions().mode();
    file.set_permissions(Permissions::from_mode(mode | (mode & 0o444) >> 2))
}

/// Returns the folder in which programs keep files that they can make again.
pub(crate) fn cache_folder() -> Option<PathBuf> {
    user_folder("XDG_CACHE_HOME", ".cache")
}

/// Returns the folder in which programs keep what they know about this machine.
pub(crate) fn state_folder() -> Option<PathBuf> {
    user_folder("XDG_STATE_HOME", ".local/state")
}

/// Returns the folder that a variable of the XDG specification names, or else a folder in the home of the user.
fn user_folder(variable: &str, in_home: &str) -> Option<PathBuf> {
    let value = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    // The XDG specification demands that relative paths in this variable are ignored.
    let of_xdg = value(variable).filter(|path| path.is_absolute());
    of_xdg.or_else(|| Some(value("HOME")?.join(in_home)))
}

/// Returns the folder for large temporary files. On some systems, the usual temporary folder is in memory.
pub(crate) fn large_temporary_folder() -> PathBuf {
    let large = PathBuf::from("/var/tmp");
    match env::var_os("TMPDIR") {
        None if large.is_dir() => large,
        _ => env::temp_dir(),
    }
}

/// Returns the path of the running program. `None` if the system does not reveal it.
pub(crate) fn this_program() -> Option<PathBuf> {
    // This link stays valid even if the file is replaced by a newer version in the meantime.
    let link = PathBuf::from("/proc/self/exe");
    if link.exists() {
        return Some(link);
    }
    // A Linux without /proc does not tell the path. The first argument is the path or the name by which the program was started.
    env::current_exe().ok().or_else(|| which::which(env::args_os().next()?).ok())
}

/// Returns the number of the signal that ended a process. `None` if it ended by itself.
pub(crate) fn signal(exit: ExitStatus) -> Option<i32> {
    exit.signal()
}

/// The processes that a child process has started, with the child itself: its process group.
pub(crate) struct Family(());

impl Family {
    /// Starts a program in a process group of its own, so that an interrupt from the terminal does not reach it.
    pub(crate) fn start(command: &mut Command) -> io::Result<(Child, Family)> {
        Ok((command.process_group(0).spawn()?, Family(())))
    }

    /// Kills all processes of the group, and waits for the child's end.
    pub(crate) fn end(&mut self, child: &mut Child) -> Option<ExitStatus> {
        // Killing fails if the process has already ended, which does no harm.
        let _ = kill_process_group(Pid::from_child(child), Signal::KILL);
        let _ = child.kill();
        child.wait().ok()
    }
}

/// Makes this process another program, with the niceness `nice` as for the command `nice`. Returns only on failure.
pub(crate) fn become_program(command: &mut Command, nice: Option<i32>) -> io::Error {
    if let Some(nice) = nice {
        // A failure is harmless: the niceness affects only the share of processor time.
        let _ = rustix::process::nice(nice);
    }
    command.exec()
}

/// Prepares this process for a command: keeps the signal SIGXFSZ from ending it. The system sends it when a file would exceed the limit that `ulimit -f` sets. With a handler,
/// writing fails with an error instead, and the error removes the temporary file. Programs that jabuka starts have no such handler.
#[cfg(feature = "cli")]
pub(crate) fn prepare_process() {
    let seen = std::sync::Arc::default();
    // Without a handler, the signal ends the process as usual, and the next run removes its temporary files.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, seen);
}
