//! The command line that starts a program in the sandbox.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The program that confines itself and then becomes another one: jabuka itself, by its command `sandbox`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launcher(PathBuf);

impl Launcher {
    /// The program `jabuka` at this path.
    pub fn new(jabuka: impl Into<PathBuf>) -> Launcher {
        Launcher(absolute(&jabuka.into()))
    }

    /// The running program, which must be `jabuka`; `None` if the system does not reveal its path.
    pub fn of_this_program() -> Option<Launcher> {
        // This link stays right even if the file is replaced by a newer version meanwhile.
        let link = Path::new("/proc/self/exe");
        if link.exists() {
            return Some(Launcher(link.to_owned()));
        }
        std::env::current_exe().ok().map(Launcher)
    }
}

/// What the programs that jabuka starts may do.
///
/// The default confines nothing, since a library does not know the launcher's path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Confinement {
    launcher: Option<Launcher>,
    /// Whether programs may read all files.
    reads_all: bool,
    /// Paths that programs may write in addition to their needs.
    writable: Vec<PathBuf>,
}

/// The needs of one program.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Needs<'a> {
    /// The files and folders that it reads, besides those open to every program.
    pub(crate) read: &'a [&'a Path],
    /// The files and folders that it writes. The first folder also takes its temporary files.
    pub(crate) write: &'a [&'a Path],
    /// Whether it runs at low priority.
    pub(crate) humble: bool,
}

impl Confinement {
    /// Programs read and write only what they need. `None` confines nothing.
    pub fn new(launcher: Option<Launcher>) -> Confinement {
        Confinement { launcher, reads_all: false, writable: Vec::new() }
    }

    /// The same for a trusted scene: programs may also read all files, and write below the scene's folder and
    /// `writable`. `None` stands for scripts without their scene.
    #[must_use]
    pub fn trusting(self, scene: Option<&Path>, folders: &[&Path]) -> Confinement {
        let own = scene.map(absolute).and_then(|scene| scene.parent().map(Path::to_owned));
        let writable = folders.iter().copied().map(absolute).chain(own).collect();
        Confinement { reads_all: true, writable, ..self }
    }

    /// The same with read access to all files.
    #[must_use]
    pub(crate) fn reading_all(&self) -> Confinement {
        Confinement { reads_all: true, ..self.clone() }
    }

    /// Whether programs may read only some files.
    pub(crate) fn limits_reading(&self) -> bool {
        self.launcher.is_some() && !self.reads_all
    }

    /// Whether there is a launcher.
    pub(crate) fn is_enforced(&self) -> bool {
        self.launcher.is_some()
    }

    /// The command that starts a confined program. The caller adds the arguments.
    pub(crate) fn command(&self, program: &Path, needs: Needs<'_>) -> Command {
        let Some(Launcher(launcher)) = &self.launcher else { return Command::new(program) };
        let mut command = Command::new(launcher);
        command.args(["sandbox", "--parent", &std::process::id().to_string()]);
        if needs.humble {
            command.args(["--nice", "10"]);
        }
        let all = self.reads_all.then_some(Path::new("/"));
        for path in needs.read.iter().copied().chain(all) {
            command.arg("--read").arg(absolute(path));
        }
        for path in needs.write.iter().copied().chain(self.writable.iter().map(PathBuf::as_path)) {
            command.arg("--write").arg(absolute(path));
        }
        command.arg("--").arg(program);
        command
    }
}

/// The absolute path: programs start in folders of their own.
fn absolute(path: &Path) -> PathBuf {
    // This fails only if the current folder is gone. Then no program can start anyway.
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}
