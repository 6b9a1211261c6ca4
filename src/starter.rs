//! The example scene that `jabuka new` writes.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A scene that shows the main keys, with comments.
pub const STARTER: &str = include_str!("starter.toml");

/// Writes the example scene into a new file. Returns its path: the given one, with `.toml` added if it is missing.
///
/// # Errors
/// If the file exists already, or cannot be written.
pub fn write_starter(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    if path.extension().is_none_or(|extension| extension != "toml") {
        path.as_mut_os_string().push(".toml");
    }
    let mut file = File::create_new(&path)?;
    file.write_all(STARTER.as_bytes()).inspect_err(|_| {
        // Remove the incomplete file. If removing fails, too, the error of writing is reported anyway.
        let _ = fs::remove_file(&path);
    })?;
    Ok(path)
}
