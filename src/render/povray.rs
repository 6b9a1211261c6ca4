//! The POV-Ray that is there.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, UNIX_EPOCH};

use super::RenderError;

/// A POV-Ray that can be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PovRay {
    path: PathBuf,
    version: String,
}

/// So long may it take to tell its version.
const PATIENCE: Duration = Duration::from_secs(20);

impl PovRay {
    /// Finds POV-Ray: at the given path, or else the `povray` of the `PATH`. Asking it for its version costs 0.2 s, so
    /// the answer is kept in the file `memory`, and holds as long as the program has the same path, size and time.
    ///
    /// # Errors
    /// Where there is none, or none of a version that is known.
    pub fn find(given: Option<&Path>, memory: &Path) -> Result<PovRay, RenderError> {
        let path = PovRay::locate(given)?;
        let mark = mark(&path).map_err(RenderError::io(&path))?;
        let remembered = fs::read_to_string(memory).ok();
        let remembered = remembered.as_deref().and_then(|text| text.split_once('\n'));
        if let Some((_, version)) = remembered.filter(|(of, _)| *of == mark) {
            return Ok(PovRay { path, version: version.trim_end().to_owned() });
        }
        let said = ask(&path)?;
        let version = version(&said).ok_or_else(|| {
            let first = said.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
            RenderError::NotPovray(path.clone(), first.chars().take(80).collect())
        })?;
        // Where this cannot be kept, it is asked again the next time.
        let _ = fs::write(memory, format!("{mark}\n{version}\n"));
        Ok(PovRay { path, version: version.to_owned() })
    }

    /// Where POV-Ray is, which is quickly told.
    ///
    /// # Errors
    /// Where there is none.
    pub fn locate(given: Option<&Path>) -> Result<PathBuf, RenderError> {
        let wanted = given.unwrap_or(Path::new("povray"));
        let path = which::which(wanted).map_err(|_| RenderError::NoPovray(wanted.to_owned()))?;
        path.canonicalize().map_err(RenderError::io(&path))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its version, as it says itself: `3.7.0.10.unofficial`.
    pub fn version(&self) -> &str {
        &self.version
    }
}

/// What tells one program from another without running it: path, size and time of change.
fn mark(path: &Path) -> std::io::Result<String> {
    let metadata = fs::metadata(path)?;
    let changed = metadata.modified()?.duration_since(UNIX_EPOCH).unwrap_or_default();
    Ok(format!("{} {} {}", path.display(), metadata.len(), changed.as_nanos()))
}

/// What it says when it is asked for its version.
fn ask(path: &Path) -> Result<String, RenderError> {
    let mut child = Command::new(path)
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(RenderError::io(path))?;
    let start = Instant::now();
    while child.try_wait().map_err(RenderError::io(path))?.is_none() {
        if start.elapsed() > PATIENCE {
            // It is of no use, however this ends.
            let _ = child.kill();
            let _ = child.wait();
            return Err(RenderError::NotPovray(path.to_owned(), "nothing, for 20 s".to_owned()));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let mut said = Vec::new();
    if let Some(stderr) = child.stderr.take() {
        // What cannot be read, it has not said; far more than this it does not say.
        let _ = stderr.take(1 << 16).read_to_end(&mut said);
    }
    Ok(String::from_utf8_lossy(&said).into_owned())
}

/// The version in what POV-Ray says of itself, if it is one that is known.
fn version(said: &str) -> Option<&str> {
    let word = said.lines().find_map(|line| line.strip_prefix("POV-Ray ")?.split_whitespace().next())?;
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
        assert_eq!(version(said), Some("3.7.0.10.unofficial"));
        assert_eq!(version("POV-Ray 3.8.0-beta.2"), Some("3.8.0-beta.2"));
        for other in ["", "POV-Ray 3.6.1", "POV-Ray 3.70", "ffmpeg 3.7", "POV-Ray "] {
            assert_eq!(version(other), None, "{other:?}");
        }
    }
}
