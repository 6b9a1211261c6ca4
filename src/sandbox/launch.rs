//! The steps of the launcher before it becomes the program.

use std::ffi::OsString;
use std::fmt;
use std::io;
use std::path::PathBuf;
use std::process::Command;

use super::{environment, landlock};
use crate::system::{self, TEMPORARY_FOLDER_VARIABLES};

/// A program to start in the sandbox, with its rights.
#[derive(Clone, Debug, Default)]
pub struct Launch {
    /// The program: a path, or a name to search for in the `PATH`.
    pub program: PathBuf,
    /// The arguments of the program.
    pub arguments: Vec<OsString>,
    /// The files and folders that the program may read and execute, except those that every program may read. A folder includes everything
    /// in it.
    pub read: Vec<PathBuf>,
    /// The files and folders that the program may read and write. Files must exist. Temporary files go to the first folder.
    pub write: Vec<PathBuf>,
    /// The ID of the process that must be the program's parent. If that process has ended, the program is not started.
    pub parent: Option<i32>,
    /// The niceness of the program, as for the command `nice`.
    pub nice: Option<i32>,
}

/// The reason why a program was not started.
#[derive(Debug)]
pub enum LaunchError {
    /// The program was not found.
    NotFound(PathBuf),
    /// The parent process has ended.
    Orphan,
    /// The kernel refuses the restrictions.
    Refused(String),
    /// A path that the program may write does not exist or cannot be opened.
    Write(PathBuf, String),
    /// The system cannot start the program.
    Start(PathBuf, io::Error),
}

impl LaunchError {
    /// The exit code that shells use for this error.
    pub fn code(&self) -> u8 {
        match self {
            LaunchError::NotFound(_) => 127,
            _ => 126,
        }
    }
}

impl Launch {
    /// Restricts this process, then replaces it by the program. The program ends when the thread that started this process ends. Returns
    /// only on failure.
    pub fn run(&self) -> LaunchError {
        if let Some(error) = self.follow_parent() {
            return error;
        }
        let Ok(program) = which::which(&self.program) else {
            return LaunchError::NotFound(self.program.clone());
        };
        if let Err(error) = landlock::restrict(&program, self) {
            return error;
        }
        let mut command = Command::new(&program);
        command.args(&self.arguments);
        command.env_clear().envs(environment::passed_on());
        if let Some(folder) = self.write.iter().find(|path| path.is_dir()) {
            for variable in TEMPORARY_FOLDER_VARIABLES.iter().chain(&["POV_TEMP_DIR"]) {
                command.env(variable, std::path::absolute(folder).unwrap_or_else(|_| folder.clone()));
            }
        }
        let error = system::become_program(&mut command, self.nice);
        LaunchError::Start(program, error)
    }

    /// Ties this process to its parent: the system ends this process when the parent's thread ends.
    #[cfg(target_os = "linux")]
    fn follow_parent(&self) -> Option<LaunchError> {
        use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
        if let Err(error) = set_parent_process_death_signal(Some(Signal::KILL)) {
            return Some(LaunchError::Refused(error.to_string()));
        }
        // A parent that ended before this line causes no signal, so check that the parent still exists.
        let parent = getppid().map(Pid::as_raw_pid);
        (self.parent.is_some() && self.parent != parent).then_some(LaunchError::Orphan)
    }

    #[cfg(not(target_os = "linux"))]
    fn follow_parent(&self) -> Option<LaunchError> {
        None
    }
}

impl fmt::Display for LaunchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LaunchError::NotFound(program) => write!(f, "there is no program `{}`", program.display()),
            LaunchError::Orphan => f.write_str("the process that wanted the program has ended"),
            LaunchError::Refused(why) => write!(f, "the sandbox cannot be made: {why}"),
            LaunchError::Write(path, why) => {
                write!(f, "`{}` cannot be opened to the sandbox: {why}", path.display())
            }
            LaunchError::Start(program, error) => write!(f, "cannot start `{}`: {error}", program.display()),
        }
    }
}

impl std::error::Error for LaunchError {}
