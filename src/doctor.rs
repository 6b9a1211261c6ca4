//! Examines what jabuka needs of the machine, and names the command that gets what is missing.

use std::fmt;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::cache::{Cache, Holding};
use crate::diagnostic::visible_path;
use crate::render::{Format, PovRay, PovRayBuild};
use crate::sandbox;

/// What was found on this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checkup {
    /// What was examined, in the order of its importance.
    pub findings: Vec<Finding>,
}

/// One of the things that jabuka needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Its name, such as `POV-Ray`.
    pub name: &'static str,
    /// What was found, in words.
    pub says: String,
    /// What helps if it is missing or unusable. `None` if all is well.
    pub remedy: Option<Remedy>,
}

/// What gets a missing thing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// The packages of a program.
    Install(Program),
    /// Something that the user can do, in words.
    Do(String),
}

/// A program that jabuka starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// POV-Ray, which renders images.
    Povray,
    /// ffmpeg, which encodes films.
    Ffmpeg,
}

/// A program that installs packages: its name, the command before the names of the packages, and the packages of POV-Ray and of ffmpeg.
struct Manager {
    program: &'static str,
    command: &'static str,
    povray: &'static str,
    ffmpeg: &'static str,
}

/// Those of systems come before those that a user can add to a system.
const PACKAGE_MANAGERS: [Manager; 6] = [
    Manager {
        program: "apt-get",
        command: "sudo apt-get install",
        povray: "povray povray-includes",
        ffmpeg: "ffmpeg",
    },
    Manager { program: "dnf", command: "sudo dnf install", povray: "povray", ffmpeg: "ffmpeg-free" },
    Manager { program: "pacman", command: "sudo pacman -S", povray: "povray", ffmpeg: "ffmpeg" },
    Manager { program: "zypper", command: "sudo zypper install", povray: "povray", ffmpeg: "ffmpeg" },
    Manager { program: "apk", command: "sudo apk add", povray: "povray", ffmpeg: "ffmpeg" },
    Manager { program: "brew", command: "brew install", povray: "povray", ffmpeg: "ffmpeg" },
];

impl Checkup {
    /// Examines this machine. POV-Ray and ffmpeg are asked for their versions, which takes less than a second.
    #[must_use]
    pub fn of_this_machine() -> Checkup {
        Checkup { findings: vec![povray(), ffmpeg(), sandbox(), cores(), fonts(), cache()] }
    }

    /// Returns whether nothing is missing.
    #[must_use]
    pub fn is_well(&self) -> bool {
        self.findings.iter().all(|finding| finding.remedy.is_none())
    }

    /// Returns what the user can do, each as a line: first the one command that installs all missing programs.
    #[must_use]
    pub fn remedies(&self) -> Vec<String> {
        let remedies = || self.findings.iter().filter_map(|finding| finding.remedy.as_ref());
        let missing: Vec<Program> = remedies()
            .filter_map(|remedy| match remedy {
                Remedy::Install(program) => Some(*program),
                Remedy::Do(_) => None,
            })
            .collect();
        let words = remedies().filter_map(|remedy| match remedy {
            Remedy::Do(words) => Some(words.clone()),
            Remedy::Install(_) => None,
        });
        installing(&missing, |program| which::which(program).is_ok()).into_iter().chain(words).collect()
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<8} {}", self.name, self.says)
    }
}

/// Returns the command that installs programs with the package manager of this machine. `has` tells whether it has a program.
fn installing(missing: &[Program], has: impl Fn(&str) -> bool) -> Option<String> {
    if missing.is_empty() {
        return None;
    }
    let Some(manager) = PACKAGE_MANAGERS.iter().find(|manager| has(manager.program)) else {
        let sites = missing.iter().map(|program| match program {
            Program::Povray => "POV-Ray is on https://www.povray.org/download/",
            Program::Ffmpeg => "ffmpeg is on https://ffmpeg.org/download.html",
        });
        return Some(sites.collect::<Vec<_>>().join("; "));
    };
    let packages = missing.iter().map(|program| match program {
        Program::Povray => manager.povray,
        Program::Ffmpeg => manager.ffmpeg,
    });
    Some(format!("{} {}", manager.command, packages.collect::<Vec<_>>().join(" ")))
}

/// Looks for POV-Ray, and asks it for its version.
#[must_use]
pub fn povray() -> Finding {
    let program = Program::Povray;
    let Ok(path) = PovRay::locate(None) else { return program.missing() };
    match (PovRay::version_of(&path), PovRayBuild::of(&path)) {
        (Some(version), PovRayBuild::Console) => program.found(&version, &path),
        (Some(version), build) => program.found(&format!("{version}, {}", build.name()), &path),
        (None, _) => program.unknown(&path, "--version"),
    }
}

/// Looks for ffmpeg, and asks it for its version and the formats of films that it can encode.
#[must_use]
pub fn ffmpeg() -> Finding {
    let program = Program::Ffmpeg;
    let Ok(path) = which::which(program.command()) else { return program.missing() };
    let said = answer(&path, &["-version"]).unwrap_or_default();
    let version =
        said.lines().find_map(|line| line.strip_prefix("ffmpeg version ")?.split_whitespace().next());
    let Some(version) = version else { return program.unknown(&path, "-version") };
    let mut finding = program.found(version, &path);
    let (can, cannot): (Vec<_>, Vec<_>) = Format::ALL.into_iter().partition(|format| {
        let question = format!("encoder={}", format.encoder());
        answer(&path, &["-hide_banner", "-loglevel", "error", "-h", &question])
            .is_some_and(|said| said.starts_with("Encoder "))
    });
    let named =
        |formats: &[Format]| formats.iter().map(|format| format.extension()).collect::<Vec<_>>().join(", ");
    if !can.is_empty() {
        finding.says = format!("{}, films as {}", finding.says, named(&can));
    }
    if !cannot.is_empty() {
        let words = format!("this ffmpeg cannot encode {}: install a complete one", named(&cannot));
        finding.remedy = Some(Remedy::Do(words));
    }
    finding
}

/// Tells what the sandbox enforces for POV-Ray and ffmpeg.
#[must_use]
pub fn sandbox() -> Finding {
    Finding { name: "sandbox", says: sandbox::enforced().to_string(), remedy: None }
}

fn cores() -> Finding {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    Finding { name: "cores", says: cores.to_string(), remedy: None }
}

fn fonts() -> Finding {
    Finding { name: "fonts", says: "DejaVu Sans, which jabuka has in itself".to_owned(), remedy: None }
}

fn cache() -> Finding {
    let finding = |says: String, remedy| Finding { name: "cache", says, remedy };
    let cache = match Cache::of_user() {
        Ok(cache) => cache,
        Err(why) => return finding("unusable".to_owned(), Some(Remedy::Do(why))),
    };
    let Some(folder) = cache.folder() else {
        return finding("none: each command simulates again".to_owned(), None);
    };
    let shown = visible_path(folder);
    match cache.holding() {
        #[allow(clippy::cast_precision_loss, reason = "it is shown with one digit after the point")]
        Ok(Holding { runs, bytes, .. }) => {
            finding(format!("{shown}, {runs} runs, {:.1} MB", bytes as f64 / 1e6), None)
        }
        Err(error) => {
            let words = "name a folder of yours in JABUKA_CACHE_DIR".to_owned();
            finding(format!("{shown} cannot be read: {error}"), Some(Remedy::Do(words)))
        }
    }
}

impl Program {
    fn name(self) -> &'static str {
        match self {
            Program::Povray => "POV-Ray",
            Program::Ffmpeg => "ffmpeg",
        }
    }

    fn command(self) -> &'static str {
        match self {
            Program::Povray => "povray",
            Program::Ffmpeg => "ffmpeg",
        }
    }

    fn found(self, version: &str, path: &Path) -> Finding {
        Finding { name: self.name(), says: format!("{version} ({})", visible_path(path)), remedy: None }
    }

    fn missing(self) -> Finding {
        let says = format!("not found: no `{}` on the PATH", self.command());
        Finding { name: self.name(), says, remedy: Some(Remedy::Install(self)) }
    }

    fn unknown(self, path: &Path, option: &str) -> Finding {
        let says = format!("unknown: `{} {option}` does not tell its version", visible_path(path));
        Finding { name: self.name(), says, remedy: Some(Remedy::Install(self)) }
    }
}

/// Returns what a program prints. `None` if it does not start.
fn answer(path: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new(path).args(arguments).stdin(Stdio::null()).output().ok()?;
    Some(String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_command_installs_all_that_is_missing() {
        let on = |manager: &'static str| move |program: &str| program == manager;
        let both = [Program::Povray, Program::Ffmpeg];
        assert_eq!(installing(&[], on("apt-get")), None);
        assert_eq!(
            installing(&both, on("apt-get")).unwrap(),
            "sudo apt-get install povray povray-includes ffmpeg"
        );
        assert_eq!(installing(&[Program::Ffmpeg], on("dnf")).unwrap(), "sudo dnf install ffmpeg-free");
        assert_eq!(installing(&both, on("brew")).unwrap(), "brew install povray ffmpeg");
        assert!(installing(&both, on("none")).unwrap().contains("https://www.povray.org/download/"));
    }
}
