//! Builds the command line that starts a program in the sandbox.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::system;

/// The launcher of the sandbox: a program that restricts its own rights and then becomes another program. It is jabuka itself, with its
/// command `sandbox`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launcher {
    program: PathBuf,
    /// The arguments before the command `sandbox`.
    arguments: Vec<OsString>,
}

/// The launcher of a process that is not the program `jabuka`.
static OF_THIS_PROCESS: OnceLock<Launcher> = OnceLock::new();

impl Launcher {
    /// Creates a launcher from the path of the program `jabuka`.
    pub fn new(jabuka: impl Into<PathBuf>) -> Launcher {
        Launcher { program: absolute(&jabuka.into()), arguments: Vec::new() }
    }

    /// Sets the arguments before the command `sandbox`. With them, an interpreter can be the launcher if it passes all further arguments to
    /// `cli::run`.
    #[must_use]
    pub fn with_arguments(self, arguments: Vec<OsString>) -> Launcher {
        Launcher { arguments, ..self }
    }

    /// Makes this the result of [`of_this_program`](Self::of_this_program) in this process. A program other than `jabuka` calls this before
    /// it runs commands of jabuka. Only the first call counts.
    pub fn use_in_this_process(self) {
        // A second launcher of the same process would be the same program.
        let _ = OF_THIS_PROCESS.set(self);
    }

    /// Returns the launcher of this process, or creates one from the running program, which must then be `jabuka`. `None` if the system
    /// does not reveal its path.
    pub fn of_this_program() -> Option<Launcher> {
        if let Some(launcher) = OF_THIS_PROCESS.get() {
            return Some(launcher.clone());
        }
        system::this_program().map(|program| Launcher { program, arguments: Vec::new() })
    }
}

/// The rights of the programs that jabuka starts.
///
/// The default confines nothing, since a library does not know the path of the launcher.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Confinement {
    launcher: Option<Launcher>,
    /// True if programs may read all files.
    reads_all: bool,
    /// Paths that all programs may write, in addition to their own needs.
    writable: Vec<PathBuf>,
}

/// The files, folders and priority that one program needs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Needs<'a> {
    /// The files and folders that the program reads, except those that every program may read.
    pub(crate) read: &'a [&'a Path],
    /// The files and folders that the program writes. Its temporary files go to the first folder. A path that begins with `./` is relative
    /// to the folder in which the program starts.
    pub(crate) write: &'a [&'a Path],
    /// True if the program runs at low priority.
    pub(crate) low_priority: bool,
}

impl Confinement {
    /// Creates a confinement in which programs may read and write only what they need. Without a launcher, nothing is confined.
    pub fn new(launcher: Option<Launcher>) -> Confinement {
        Confinement { launcher, reads_all: false, writable: Vec::new() }
    }

    /// Extends the rights for a trusted scene: programs may read all files, and also write in the scene's folder and in `folders`. `scene`
    /// is `None` for scripts without their scene.
    #[must_use]
    pub fn trusting(self, scene: Option<&Path>, folders: &[&Path]) -> Confinement {
        let own = scene.map(absolute).and_then(|scene| scene.parent().map(Path::to_owned));
        let writable = folders.iter().copied().map(absolute).chain(own).collect();
        Confinement { reads_all: true, writable, ..self }
    }

    /// Returns a confinement that also grants read access to all files.
    #[must_use]
    pub(crate) fn reading_all(&self) -> Confinement {
        Confinement { reads_all: true, ..self.clone() }
    }

    /// True if programs are confined and may read only some files.
    pub(crate) fn limits_reading(&self) -> bool {
        self.launcher.is_some() && !self.reads_all
    }

    /// True if programs are confined: the confinement has a launcher.
    pub(crate) fn is_enforced(&self) -> bool {
        self.launcher.is_some()
    }

    /// Creates the command that starts a program with the rights that it needs. The caller adds the program's arguments.
    pub(crate) fn command(&self, program: &Path, needs: Needs<'_>) -> Command {
        let Some(launcher) = &self.launcher else { return Command::new(program) };
        let mut command = Command::new(&launcher.program);
        command.args(&launcher.arguments);
        command.args(["sandbox", "--parent", &std::process::id().to_string()]);
        if needs.low_priority {
            command.args(["--nice", "10"]);
        }
        let all = self.reads_all.then_some(Path::new("/"));
        for path in needs.read.iter().copied().chain(all) {
            command.arg("--read").arg(absolute(path));
        }
        for path in needs.write.iter().copied().chain(self.writable.iter().map(PathBuf::as_path)) {
            let in_start = path.starts_with(".");
            command.arg("--write").arg(if in_start { path.to_owned() } else { absolute(path) });
        }
        command.arg("--").arg(program);
        command
    }
}

/// Converts a path to an absolute one, since programs start in folders of their own.
fn absolute(path: &Path) -> PathBuf {
    // The conversion fails only if the current folder no longer exists. No program can start then.
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}
