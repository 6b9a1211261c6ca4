//! What jabuka asks of Windows: open files, processes, and the folders of the user. `unix.rs` has the same functions.
//!
//! A child process and all that it starts are in a job object. The system ends them when the job is closed, thus also when jabuka is killed.

use std::collections::HashMap;
use std::env;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::windows::fs::{FileExt as _, OpenOptionsExt as _};
use std::os::windows::io::AsRawHandle as _;
use std::os::windows::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::thread;
use std::time::Duration;

use win32job::{ExtendedLimitInfo, Job, JobError, PriorityClass};
#[cfg(feature = "cli")]
use winapi_util::console::Console;

/// The environment variables that name the folder of temporary files.
pub(crate) const TEMPORARY_FOLDER_VARIABLES: &[&str] = &["TEMP", "TMP"];

/// Allows to open a folder, and a file without following a link. See `CreateFileW`.
pub(super) const FILE_FLAG_BACKUP_SEMANTICS: u32 = 0x0200_0000;
pub(super) const FILE_FLAG_OPEN_REPARSE_POINT: u32 = 0x0020_0000;

/// Keeps Ctrl-C from a new process. See the process creation flags of Windows.
const CREATE_NEW_PROCESS_GROUP: u32 = 0x0000_0200;

/// The names of the program POV-Ray, in the order in which they are looked for: a build for consoles, then POV-Ray for Windows.
pub(crate) const POVRAY_NAMES: &[&str] = &["povray", "pvengine64", "pvengine"];

/// Returns the folders outside of the `PATH` in which POV-Ray may be installed, the newest version first.
pub(crate) fn povray_folders() -> Vec<PathBuf> {
    let Some(programs) = env::var_os("ProgramFiles") else { return Vec::new() };
    let versions = fs::read_dir(Path::new(&programs).join("POV-Ray")).into_iter().flatten().flatten();
    let mut folders: Vec<PathBuf> = versions.map(|version| version.path().join("bin")).collect();
    folders.sort_unstable();
    folders.reverse();
    folders
}

/// Returns true if an environment variable has this name, in capitals or not.
pub(crate) fn is_variable(variable: &OsStr, name: &str) -> bool {
    variable.eq_ignore_ascii_case(name)
}

/// What tells a file apart from all other files that exist: the serial number of its volume, and its number there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FileId(u64, u64);

impl FileId {
    /// Returns the identity of an open file or folder.
    pub(crate) fn of(file: &File) -> io::Result<FileId> {
        winapi_util::file::information(file)
            .map(|about| FileId(about.volume_serial_number(), about.file_index()))
    }

    /// Returns the identity of the file at a path. Links are followed.
    pub(crate) fn of_path(path: &Path) -> io::Result<FileId> {
        FileId::of(&to_look_at(FILE_FLAG_BACKUP_SEMANTICS, path)?)
    }

    /// Returns the identity of what is at a path. A link is not followed.
    pub(crate) fn of_name(path: &Path) -> io::Result<FileId> {
        FileId::of(&to_look_at(FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT, path)?)
    }
}

/// Opens a file or folder to ask for its properties, which hinders nobody.
fn to_look_at(flags: u32, path: &Path) -> io::Result<File> {
    OpenOptions::new().access_mode(0).custom_flags(flags).open(path)
}

/// Returns the absolute path without links and `..`, in the form that all programs understand: without `\\?\` if it is short.
pub(crate) fn canonicalize(path: &Path) -> io::Result<PathBuf> {
    dunce::canonicalize(path)
}

/// Fills `bytes` from a file, beginning at `offset`.
pub(crate) fn read_exact_at(file: &File, mut bytes: &mut [u8], mut offset: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        let read = file.seek_read(bytes, offset)?;
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        bytes = &mut bytes[read..];
        offset += read as u64;
    }
    Ok(())
}

/// Writes all of `bytes` into a file, beginning at `offset`.
pub(crate) fn write_all_at(file: &File, mut bytes: &[u8], mut offset: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        let written = file.seek_write(bytes, offset)?;
        if written == 0 {
            return Err(io::ErrorKind::WriteZero.into());
        }
        bytes = &bytes[written..];
        offset += written as u64;
    }
    Ok(())
}

/// Returns the free space for this user on the disk of a folder, bytes. `_file` is an open file in this folder.
pub(crate) fn free_bytes(_file: &File, folder: &Path) -> io::Result<u64> {
    fs4::available_space(folder)
}

/// Does nothing: on Windows, the ending of a name tells whether a file is a program.
pub(crate) fn make_executable(_: &File) -> io::Result<()> {
    Ok(())
}

/// Returns the folder in which programs keep files that they can make again.
pub(crate) fn cache_folder() -> Option<PathBuf> {
    env::var_os("LOCALAPPDATA").map(PathBuf::from).filter(|path| path.is_absolute())
}

/// Returns the folder in which programs keep what they know about this machine.
pub(crate) fn state_folder() -> Option<PathBuf> {
    cache_folder()
}

/// Returns the folder for large temporary files.
pub(crate) fn large_temporary_folder() -> PathBuf {
    env::temp_dir()
}

/// Returns the path of the running program. `None` if the system does not reveal it.
pub(crate) fn this_program() -> Option<PathBuf> {
    env::current_exe().ok()
}

/// Returns `None`: Windows has no signals.
pub(crate) fn signal(_: ExitStatus) -> Option<i32> {
    None
}

/// Returns `None`: the CPU times of other processes are not asked for on Windows.
pub(crate) fn cpu_seconds_by_group() -> Option<HashMap<i32, f64>> {
    None
}

/// Returns `None`: the CPU times of other processes are not asked for on Windows.
pub(crate) fn cpu_seconds(_: u32) -> Option<f64> {
    None
}

/// The processes that a child process has started, with the child itself: a job object. Its processes end when it is dropped.
pub(crate) struct Family(Option<Job>);

impl Family {
    /// Starts a program in a job of its own. Ctrl-C does not reach it.
    pub(crate) fn start(command: &mut Command) -> io::Result<(Child, Family)> {
        let job = job(None).map_err(io::Error::other)?;
        let mut child = command.creation_flags(CREATE_NEW_PROCESS_GROUP).spawn()?;
        if let Err(error) = job.assign_process(child.as_raw_handle() as isize)
            && child.try_wait()?.is_none()
        {
            // Without the job, the program could outlive jabuka.
            child.kill()?;
            return Err(io::Error::other(error));
        }
        Ok((child, Family(Some(job))))
    }

    /// Kills all processes of the job, and waits for their end.
    pub(crate) fn end(&mut self, child: &mut Child) -> Option<ExitStatus> {
        // Killing fails if the process has already ended, which does no harm.
        let _ = child.kill();
        let exit = child.wait().ok();
        if let Some(job) = self.0.take() {
            // The launcher's own job ends the program with the launcher. It may take a moment, and until then its files cannot be removed.
            for _ in 0..100 {
                if job.query_process_id_list().is_ok_and(|processes| processes.is_empty()) {
                    break;
                }
                thread::sleep(Duration::from_millis(5));
            }
        }
        exit
    }
}

/// Makes a job whose processes end when its last handle is closed.
fn job(priority: Option<PriorityClass>) -> Result<Job, JobError> {
    let mut limits = ExtendedLimitInfo::new();
    limits.limit_kill_on_job_close();
    if let Some(priority) = priority {
        limits.limit_priority_class(priority);
    }
    Job::create_with_limit_info(&limits)
}

/// Runs another program in place of this process: in the same job, with the same end. With `nice`, it runs at low priority. Returns only on
/// failure.
///
/// Windows cannot replace a process by a program, so this process waits.
pub(crate) fn become_program(command: &mut Command, nice: Option<i32>) -> io::Error {
    let job = match job(nice.map(|_| PriorityClass::BelowNormal)) {
        Ok(job) => job,
        Err(error) => return io::Error::other(error),
    };
    if let Err(error) = job.assign_current_process() {
        return io::Error::other(error);
    }
    // This process is in the job: to close the job would end it before it can tell its exit code.
    let _ = job.into_handle();
    match command.spawn().and_then(|mut child| child.wait()) {
        Ok(exit) => std::process::exit(exit.code().unwrap_or(1)),
        Err(error) => error,
    }
}

/// Prepares this process for a command: lets older consoles understand the sequences for colors and for moving up.
#[cfg(feature = "cli")]
pub(crate) fn prepare_process() {
    for mut console in [Console::stdout(), Console::stderr()].into_iter().flatten() {
        // A console that does not know these sequences shows them.
        let _ = console.set_virtual_terminal_processing(true);
    }
}
