//! The errors of writing and comparing scripts.

use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::RunError;
use crate::diagnostic::{Code, Diagnostic, Report};
use crate::system::FolderError;

/// An error of writing or comparing scripts. The path is that of the file or folder concerned.
#[derive(Debug)]
pub enum OutputError {
    /// The folder contains files, but no manifest of jabuka's.
    NotOurs(PathBuf),
    /// The path of a folder leads to a file.
    NotAFolder(PathBuf),
    /// The folder to compare with does not exist.
    NoFolder(PathBuf),
    /// The folder contains no scripts that jabuka wrote.
    NoScripts(PathBuf),
    /// The folder lacks scripts, because the command that wrote them was interrupted.
    Incomplete(PathBuf),
    /// A file or folder that jabuka writes to is a symbolic link, whose target may be anywhere.
    Link(PathBuf),
    /// The folder was not made here, and files in it were not written as its manifest says: their names. Only the user can know whether they
    /// are of any use.
    FromElsewhere(PathBuf, Vec<String>),
    /// The job folder was not made here, and holds files that its scripts or an engine would use: their names.
    JobFromElsewhere(PathBuf, Vec<String>),
    /// Another jabuka process writes into the same folder.
    Locked(PathBuf),
    /// A file could not be read, written or removed.
    Io(PathBuf, io::Error),
    /// The run cannot be simulated, read or drawn.
    Run(RunError),
}

impl OutputError {
    /// Returns the diagnostic code of this error.
    pub fn code(&self) -> Code {
        match self {
            OutputError::NotOurs(_) | OutputError::FromElsewhere(..) | OutputError::JobFromElsewhere(..) => {
                Code::FolderNotOurs
            }
            OutputError::NotAFolder(_) | OutputError::NoFolder(_) => Code::NoFolder,
            OutputError::NoScripts(_) => Code::NoScripts,
            OutputError::Incomplete(_) => Code::IncompleteScripts,
            OutputError::Link(_) => Code::Link,
            OutputError::Locked(_) => Code::FolderLocked,
            OutputError::Io(_, error) if is_full(error) => Code::DiskFull,
            OutputError::Io(..) => Code::CannotWrite,
            OutputError::Run(error) => error.code(),
        }
    }

    /// Returns the error as a diagnostic. An error of the run has a position in the scene or in a template.
    pub fn report(&self) -> Report {
        if let OutputError::Run(error) = self {
            return error.report();
        }
        let diagnostic = Diagnostic::error(self.code(), self.to_string());
        let diagnostic = match self.help() {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        };
        Report { diagnostics: vec![diagnostic], ..Report::default() }
    }

    /// Returns advice on how to correct the error. `None` if the error message alone is enough.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            OutputError::Run(error) => return error.help(),
            OutputError::NotOurs(_) => Some("name an empty or a new folder with `-o`"),
            OutputError::FromElsewhere(..) => {
                Some("look at them, and remove or rename them; or name another folder with `-o`")
            }
            OutputError::JobFromElsewhere(..) => Some(
                "look at them: they name programs that run; then remove them, or keep them with `--trust`",
            ),
            OutputError::Link(_) => Some("remove the link, or name the folder that it leads to"),
            OutputError::Locked(_) => {
                Some("wait until the other run has ended, or name another folder with `-o`")
            }
            OutputError::NoFolder(_) => Some("write it first, by the same command without `--check`"),
            OutputError::NoScripts(_) => {
                Some("`jabuka compile` writes them; `jabuka batch SCENE.toml` does both")
            }
            OutputError::Incomplete(_) => Some("run `jabuka compile` again"),
            OutputError::Io(_, error) if is_full(error) => Some(
                "make room, and run the same command again; until then, its folder says that not all scripts are there",
            ),
            _ => None,
        };
        help.map(str::to_owned)
    }
}

/// Returns true if the disk or the user's quota is full.
fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded)
}

/// Lists the first of some names of files.
fn listed(names: &[String]) -> String {
    /// The largest number of files that an error names.
    const MAX_LISTED_FILES: usize = 5;
    let shown: Vec<String> = names.iter().take(MAX_LISTED_FILES).map(|name| format!("`{name}`")).collect();
    match names.len().saturating_sub(MAX_LISTED_FILES) {
        0 => shown.join(", "),
        others => format!("{}, and {others} more", shown.join(", ")),
    }
}

impl fmt::Display for OutputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OutputError::NotOurs(path) => {
                write!(f, "the folder `{}` is not empty, and jabuka did not make it", path.display())
            }
            OutputError::NotAFolder(path) => write!(f, "`{}` is not a folder", path.display()),
            OutputError::NoFolder(path) => write!(f, "there is no folder `{}`", path.display()),
            OutputError::NoScripts(path) => {
                write!(f, "the folder `{}` holds no scripts that jabuka wrote", path.display())
            }
            OutputError::Incomplete(path) => {
                write!(f, "not all scripts are in `{}`: what writes them was interrupted", path.display())
            }
            OutputError::FromElsewhere(path, names) => {
                let (names, path) = (listed(names), path.display());
                write!(f, "the folder `{path}` comes from elsewhere, and jabuka did not write its {names}")
            }
            OutputError::JobFromElsewhere(path, names) => {
                let (names, path) = (listed(names), path.display());
                write!(
                    f,
                    "the job folder `{path}` comes from elsewhere, and its {names} would be used as you edited it here"
                )
            }
            OutputError::Link(path) => write!(f, "`{}` is a link, which is not followed", path.display()),
            OutputError::Locked(path) => {
                write!(f, "another jabuka writes to the folder `{}`", path.display())
            }
            OutputError::Io(path, error) => write!(f, "`{}`: {error}", path.display()),
            OutputError::Run(RunError::Simulate(error)) => f.write_str(&error.message()),
            OutputError::Run(RunError::Emit(error)) => error.fmt(f),
        }
    }
}

impl std::error::Error for OutputError {}

impl From<FolderError> for OutputError {
    fn from(error: FolderError) -> OutputError {
        match error {
            FolderError::Link(path) => OutputError::Link(path),
            FolderError::NotAFolder(path) => OutputError::NotAFolder(path),
            FolderError::Io(path, error) => OutputError::Io(path, error),
        }
    }
}

impl<E: Into<RunError>> From<E> for OutputError {
    fn from(error: E) -> OutputError {
        OutputError::Run(error.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::simulate::Recorded;

    /// Two rods keep the ball 1 m from the origin. The third rod contradicts them, because it is 0.5 mm longer than the distance.
    #[test]
    fn joints_that_contradict_each_other_at_the_start_are_located() {
        let text = "[body.bob]\nshape.sphere.radius = 0.1\nlocation = [0, -1, 0]
[joint.left.rod]\nbetween = [[-1, 0, 0], 'bob']\n[joint.right.rod]\nbetween = [[1, 0, 0], 'bob']
[joint.middle.rod]\nbetween = [[0, 0, 0], 'bob']\nlength = 1.0005\n";
        let scene = Scene::parse(text).unwrap();
        let error = OutputError::from(Recorded::new(&scene).err().unwrap());
        assert_eq!(error.code(), Code::JointApart);
        let report = error.report();
        let [diagnostic] = &report.diagnostics[..] else { panic!("{report}") };
        let span = diagnostic.span().unwrap();
        let line = report.sources.start(span).line;
        assert!([4, 6, 8].contains(&line), "{report}");
        assert!(diagnostic.message.contains("does not hold at the start: "), "{report}");
    }
}
