//! Why scripts could not be written or compared.

use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::RunError;
use crate::diagnostic::{Code, Diagnostic, Report};
use crate::emit::EmitError;
use crate::simulate::{Broken, Diverged, SimulateError, Stalled, Stuck, Undefined};

/// Why scripts could not be written or compared.
#[derive(Debug)]
pub enum OutputError {
    /// The folder contains files, but nothing marks it as jabuka's.
    NotOurs(PathBuf),
    /// There is a file where a folder should be.
    NotAFolder(PathBuf),
    /// There is no such folder to compare with.
    NoFolder(PathBuf),
    /// The folder has no scripts of jabuka's.
    NoScripts(PathBuf),
    /// Not all scripts of the folder were written.
    Incomplete(PathBuf),
    /// A file that jabuka writes to is a link, which may lead anywhere.
    Link(PathBuf),
    /// Another process writes into the folder.
    Locked(PathBuf),
    /// A file could not be read, written or removed.
    Io(PathBuf, io::Error),
    /// The state became non-finite.
    Diverged(Diverged),
    /// A force has no finite value.
    Undefined(Box<Undefined>),
    /// A joint cannot be kept.
    Broken(Broken),
    /// A contact cannot be computed.
    Stuck(Box<Stuck>),
    /// No step is short enough for a body.
    Stalled(Box<Stalled>),
    /// The recording of the run could not be written or read.
    Recording(String),
    /// A script cannot be written.
    Emit(EmitError),
}

impl OutputError {
    /// The kind of mistake, as a diagnostic's code.
    pub fn code(&self) -> Code {
        match self {
            OutputError::NotOurs(_) => Code::FolderNotOurs,
            OutputError::NotAFolder(_) | OutputError::NoFolder(_) => Code::NoFolder,
            OutputError::NoScripts(_) => Code::NoScripts,
            OutputError::Incomplete(_) => Code::IncompleteScripts,
            OutputError::Link(_) => Code::Link,
            OutputError::Locked(_) => Code::FolderLocked,
            OutputError::Io(_, error) if is_full(error) => Code::DiskFull,
            OutputError::Io(..) => Code::CannotWrite,
            OutputError::Diverged(_) => Code::Diverged,
            OutputError::Undefined(undefined) => undefined.why.0,
            OutputError::Broken(broken) if broken.time == 0.0 => Code::JointApart,
            OutputError::Broken(_) => Code::BrokenJoint,
            OutputError::Stuck(stuck) if stuck.depth.is_some() => Code::OverlapAtStart,
            OutputError::Stuck(_) => Code::Jammed,
            OutputError::Stalled(_) => Code::Stalled,
            OutputError::Recording(_) => Code::NoRecording,
            OutputError::Emit(EmitError::Indistinct(_)) => Code::Indistinct,
            OutputError::Emit(_) => Code::CannotEmit,
        }
    }

    /// The error as a diagnostic; that of a template with its place.
    pub fn report(&self) -> Report {
        if let OutputError::Emit(EmitError::Template(report) | EmitError::Indistinct(report)) = self {
            return report.clone();
        }
        let diagnostic = Diagnostic::error(self.code(), self.to_string());
        let diagnostic = match self.help() {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        };
        if let OutputError::Broken(Broken { place: (Some(span), sources), .. }) = self {
            return Report { sources: sources.clone(), diagnostics: vec![diagnostic.at(*span, "")] };
        }
        if let OutputError::Undefined(undefined) = self
            && let (Some(span), sources) = &undefined.place
        {
            let diagnostic = diagnostic.at(*span, undefined.why.2.clone());
            return Report { sources: sources.clone(), diagnostics: vec![diagnostic] };
        }
        if let OutputError::Stalled(stalled) = self {
            let (span, sources) = &stalled.place;
            let diagnostic = span.iter().fold(diagnostic, |diagnostic, span| diagnostic.at(*span, ""));
            return Report { sources: sources.clone(), diagnostics: vec![diagnostic] };
        }
        if let OutputError::Stuck(stuck) = self {
            let (spans, sources) = &stuck.place;
            let diagnostic = spans.iter().fold(diagnostic, |diagnostic, span| diagnostic.at(*span, ""));
            return Report { sources: sources.clone(), diagnostics: vec![diagnostic] };
        }
        Report { diagnostics: vec![diagnostic], ..Report::default() }
    }

    /// A way to mend it, unless the message makes it plain.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            OutputError::Diverged(_) => Some(
                "take a smaller `simulation.step`: a stiff spring wants it well below √(mass / stiffness)",
            ),
            OutputError::Broken(broken) if broken.time == 0.0 => Some(
                "with the other joints of its bodies, it cannot: their lengths and points contradict each other",
            ),
            OutputError::Broken(_) => Some(
                "other joints, or bodies whose motion is given, pull the bodies apart; or take a smaller `simulation.step`",
            ),
            OutputError::Stuck(stuck) if stuck.depth.is_some() => Some(
                "move them apart, or let them pass through each other: `collides = false`, or the same `collision_group`",
            ),
            OutputError::Stuck(_) => Some(
                "give wedged bodies more room or a smaller `restitution`, or end the scene before that time: `--set simulation.duration=…`",
            ),
            OutputError::Stalled(_) => Some(
                "two point-like bodies may meet there: give `gravitation` or `coulomb` a `softening`, move them, or end the scene before that \
                 time: `--set simulation.duration=…`",
            ),
            OutputError::Recording(_) => Some(
                "it goes to a file below /var/tmp, or where TMPDIR says: make room there, or name another folder",
            ),
            OutputError::NotOurs(_) => Some("name an empty or a new folder with `-o`"),
            OutputError::Link(_) => Some("remove the link"),
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
        }
    }
}

/// Whether there is no room on a disk.
fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded)
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
            OutputError::Link(path) => write!(f, "`{}` is a link, which is not followed", path.display()),
            OutputError::Locked(path) => {
                write!(f, "another jabuka writes to the folder `{}`", path.display())
            }
            OutputError::Io(path, error) => write!(f, "`{}`: {error}", path.display()),
            OutputError::Diverged(error) => error.fmt(f),
            OutputError::Undefined(error) => error.fmt(f),
            OutputError::Broken(error) => error.fmt(f),
            OutputError::Stuck(error) => error.fmt(f),
            OutputError::Stalled(error) => error.fmt(f),
            OutputError::Recording(message) => write!(f, "the run could not be recorded: {message}"),
            OutputError::Emit(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for OutputError {}

impl From<SimulateError> for OutputError {
    fn from(error: SimulateError) -> OutputError {
        match error {
            SimulateError::Diverged(error) => OutputError::Diverged(error),
            SimulateError::Undefined(error) => OutputError::Undefined(error),
            SimulateError::Broken(error) => OutputError::Broken(error),
            SimulateError::Stuck(error) => OutputError::Stuck(error),
            SimulateError::Stalled(error) => OutputError::Stalled(error),
            SimulateError::Recording(message) => OutputError::Recording(message),
        }
    }
}

impl From<EmitError> for OutputError {
    fn from(error: EmitError) -> OutputError {
        OutputError::Emit(error)
    }
}

impl From<RunError> for OutputError {
    fn from(error: RunError) -> OutputError {
        match error {
            RunError::Simulate(error) => error.into(),
            RunError::Emit(error) => error.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::simulate::Recorded;

    /// Two rods keep the ball 1 m from the origin, and the third wants a little more.
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
        let line = report.sources.position(span.source, span.start).line;
        assert!([4, 6, 8].contains(&line), "{report}");
        assert!(diagnostic.message.contains("does not hold at the start: "), "{report}");
    }
}
