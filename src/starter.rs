//! The scene that a new one starts from.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A scene that shows the main keys, with comments.
pub const STARTER: &str = include_str!("starter.toml");

/// Writes the starter into a new file, and returns its path: the given one, with `.toml` where that is missing.
///
/// # Errors
/// If there is such a file already, or none can be written.
pub fn write_starter(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    if path.extension().is_none_or(|extension| extension != "toml") {
        path.as_mut_os_string().push(".toml");
    }
    let mut file = File::create_new(&path)?;
    file.write_all(STARTER.as_bytes()).inspect_err(|_| {
        // Half a scene is none; where this fails too, the error is said anyway.
        let _ = fs::remove_file(&path);
    })?;
    Ok(path)
}
