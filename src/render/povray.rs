//! Finds the installed POV-Ray and its version.

use std::fs;
use std::io::{Read, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, UNIX_EPOCH};

use super::povray_build::{self, PovRayBuild};
use super::started::Started;
use super::{Images, RenderError};
use crate::sandbox::{Confinement, Needs};
use crate::system::{self, POVRAY_NAMES};

/// An installed POV-Ray of a known version.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PovRay {
    path: PathBuf,
    version: String,
    confinement: Confinement,
    /// The reason why POV-Ray may read all files: its error message when it was started with limited read access. `None` if it starts with
    /// limited read access.
    unlimited: Option<String>,
}

/// The name of the file that caches the version of POV-Ray, in the hidden folder among the images.
const VERSION_CACHE_FILE: &str = "povray";

/// The longest time to wait for POV-Ray's answer about its version.
const VERSION_TIMEOUT: Duration = Duration::from_secs(20);

impl PovRay {
    /// Finds POV-Ray: at the path `given`, or else by [`PovRay::locate`]. Asking it for its version takes 0.2 s, so the answer is
    /// cached among the images. The cache is valid as long as the program has the same path, size and modification time.
    ///
    /// The confinement applies to every run of POV-Ray. A POV-Ray with libraries in an unusual folder cannot start with limited read
    /// access. It may then read all files, and [`PovRay::warning`] says so.
    ///
    /// # Errors
    /// If POV-Ray is not found, or its version is unknown.
    pub fn find(
        given: Option<&Path>,
        images: &Images,
        confinement: Confinement,
    ) -> Result<PovRay, RenderError> {
        let path = PovRay::locate(given)?;
        let mark = mark(&path, &confinement).map_err(RenderError::io(&path))?;
        let remembered = images.hidden().read_to_string(VERSION_CACHE_FILE).ok();
        let remembered = remembered.as_deref().and_then(|text| text.split_once('\n'));
        if let Some((_, version)) = remembered.filter(|(of, _)| *of == mark) {
            let version = version.trim_end().to_owned();
            return Ok(PovRay { path, version, confinement, unlimited: None });
        }
        let said = ask(&path, &confinement)?;
        if let Some(version) = known_version(&said) {
            // If the answer cannot be cached, the next command asks POV-Ray again.
            let _ = images
                .hidden()
                .create(VERSION_CACHE_FILE)
                .map(|mut file| file.write_all(format!("{mark}\n{version}\n").as_bytes()));
            let version = version.to_owned();
            return Ok(PovRay { path, version, confinement, unlimited: None });
        }
        let first = said.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
        let first: String = first.chars().filter(|c| !c.is_control()).take(200).collect();
        let reading_all = confinement.reading_all();
        let said = if confinement.limits_reading() { ask(&path, &reading_all)? } else { String::new() };
        let Some(version) = known_version(&said) else {
            return Err(RenderError::NotPovray(path, first.chars().take(80).collect()));
        };
        let version = version.to_owned();
        Ok(PovRay { path, version, confinement: reading_all, unlimited: Some(first) })
    }

    /// Finds the path of POV-Ray without running it, which is quick: at the path `given`, or else as `povray` in the `PATH`. On Windows, finds
    /// `pvengine64` or `pvengine`, too, also where the installer puts it.
    ///
    /// # Errors
    /// If no such program exists.
    pub fn locate(given: Option<&Path>) -> Result<PathBuf, RenderError> {
        let path = match given {
            Some(given) => which::which(given).ok(),
            None => {
                let folders = system::povray_folders();
                let installed =
                    folders.iter().flat_map(|folder| POVRAY_NAMES.iter().map(|name| folder.join(name)));
                let mut wanted = POVRAY_NAMES.iter().map(PathBuf::from).chain(installed);
                wanted.find_map(|name| which::which(name).ok())
            }
        };
        let missing = || RenderError::NoPovray(given.unwrap_or(Path::new("povray")).to_owned());
        let path = path.ok_or_else(missing)?;
        system::canonicalize(&path).map_err(RenderError::io(&path))
    }

    /// Returns the version of the POV-Ray at a path. `None` if it does not tell.
    pub fn version_of(path: &Path) -> Option<String> {
        version(&ask(path, &Confinement::default()).ok()?).map(str::to_owned)
    }

    /// Returns the build of this POV-Ray.
    pub fn build(&self) -> PovRayBuild {
        PovRayBuild::of(&self.path)
    }

    /// Returns the path of the program.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns a warning if POV-Ray may read all files, because it does not start with limited read access.
    pub fn warning(&self) -> Option<String> {
        let why = self.unlimited.as_ref()?;
        let path = self.path.display();
        Some(format!("`{path}` may read all files, since it does not start in the sandbox: it says `{why}`"))
    }

    /// Returns true if the sandbox limits POV-Ray's write access.
    pub(super) fn is_confined(&self) -> bool {
        self.confinement.is_enforced()
    }

    /// Returns true if the sandbox limits POV-Ray's read access.
    pub(super) fn limits_reading(&self) -> bool {
        self.confinement.limits_reading()
    }

    /// Makes a value for tests, without looking for an installed POV-Ray.
    #[cfg(test)]
    pub(super) fn unconfined() -> PovRay {
        let (path, version) = (PathBuf::from("povray"), "3.7".to_owned());
        PovRay { path, version, confinement: Confinement::default(), unlimited: None }
    }

    /// Returns the command that starts POV-Ray in the sandbox. The caller adds the arguments.
    pub(super) fn command(&self, needs: Needs<'_>) -> Command {
        self.confinement.command(&self.path, needs)
    }

    /// Returns the version as POV-Ray prints it: `3.7.0.10.unofficial`.
    pub fn version(&self) -> &str {
        &self.version
    }
}

/// Returns a text that identifies a program without running it: its path, size and modification time, and whether its read access is
/// limited.
fn mark(path: &Path, confinement: &Confinement) -> std::io::Result<String> {
    let limited = if confinement.limits_reading() { " confined" } else { "" };
    let metadata = fs::metadata(path)?;
    let changed = metadata.modified()?.duration_since(UNIX_EPOCH).unwrap_or_default();
    Ok(format!("{} {} {}{limited}", path.display(), metadata.len(), changed.as_nanos()))
}

/// Runs the program with `--version`, and returns its output. The version of POV-Ray for Windows is read from its file.
fn ask(path: &Path, confinement: &Confinement) -> Result<String, RenderError> {
    if PovRayBuild::of(path) == PovRayBuild::Windows {
        let version = povray_build::version_in(path).map_err(RenderError::io(path))?;
        return Ok(version.map_or_else(String::new, |version| format!("POV-Ray {version}")));
    }
    let mut command = confinement.command(path, Needs::default());
    command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = Started::new(&mut command).map_err(RenderError::io(path))?;
    let start = Instant::now();
    while child.exit().map_err(RenderError::io(path))?.is_none() {
        if start.elapsed() > VERSION_TIMEOUT {
            return Err(RenderError::NotPovray(path.to_owned(), "nothing, for 20 s".to_owned()));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let mut said = Vec::new();
    let (_, _, errors) = child.pipes();
    if let Some(errors) = errors {
        // An unreadable answer counts as empty. The limit of 64 kB is more than any version text needs.
        let _ = errors.take(1 << 16).read_to_end(&mut said);
    }
    Ok(String::from_utf8_lossy(&said).into_owned())
}

/// Returns the version number in POV-Ray's output.
fn version(said: &str) -> Option<&str> {
    said.lines().find_map(|line| line.strip_prefix("POV-Ray ")?.split_whitespace().next())
}

/// Returns the version number in POV-Ray's output. `None` unless it is a 3.7 or 3.8.
fn known_version(said: &str) -> Option<&str> {
    let word = version(said)?;
    let known = ["3.7", "3.8"].iter().any(|known| {
        word.strip_prefix(known).is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
    });
    known.then_some(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_is_the_word_after_the_name() {
        let said = "povray: cannot open the user configuration file\nPOV-Ray 3.7.0.10.unofficial\n\nmore";
        assert_eq!(known_version(said), Some("3.7.0.10.unofficial"));
        assert_eq!(known_version("POV-Ray 3.8.0-beta.2"), Some("3.8.0-beta.2"));
        for other in ["", "POV-Ray 3.6.1", "POV-Ray 3.70", "ffmpeg 3.7", "POV-Ray "] {
            assert_eq!(known_version(other), None, "{other:?}");
        }
    }
}
