//! The scenes that `jabuka new` writes: a first scene, and copies of the examples in `scenes/`.
//!
//! `build.rs` puts the scenes into the program.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::system::Dir;

// `SCENES`, and `FILES`, which the scenes read: made by `build.rs` from the folder `scenes/`.
include!(concat!(env!("OUT_DIR"), "/scenes.rs"));

/// A scene that shows the main keys, with comments.
pub const STARTER: &str = include_str!("starter.toml");

/// A scene of the folder `scenes/`.
#[derive(Debug)]
pub struct Example {
    /// The name of its file, without `.toml`.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl Example {
    /// Returns all examples, by name.
    pub fn all() -> impl Iterator<Item = &'static Example> {
        SCENES.iter()
    }

    /// Returns the title of the scene. If the text has none, it is empty.
    pub fn title(&self) -> &'static str {
        let line = self.text.lines().find_map(|line| line.strip_prefix("title = \""));
        line.map_or("", |line| line.trim_end_matches('"'))
    }

    /// Returns the files that the scene reads, each with its path relative to the scene.
    fn files(&self) -> impl Iterator<Item = &'static (&'static str, &'static [u8])> {
        let text = self.text;
        FILES.iter().filter(move |(name, _)| text.contains(&format!("\"{name}\"")))
    }
}

/// Writes the first scene into a new file. Returns its path: the given one, with `.toml` added if it is missing.
///
/// # Errors
/// If the file exists already, or cannot be written. The error comes with the given path.
pub fn write_starter(path: &Path) -> Result<PathBuf, (PathBuf, io::Error)> {
    write_all(path, STARTER, [])
}

/// Writes an example into a new file, and beside it the files that it reads. Returns its path, as [`write_starter`] does.
///
/// # Errors
/// If a file exists already with other content, or cannot be written. The error comes with the path of the file.
pub fn write_scene(path: &Path, example: &Example) -> Result<PathBuf, (PathBuf, io::Error)> {
    write_all(path, example.text, example.files())
}

fn write_all(
    path: &Path,
    text: &str,
    files: impl IntoIterator<Item = &'static (&'static str, &'static [u8])>,
) -> Result<PathBuf, (PathBuf, io::Error)> {
    let mut scene = path.to_owned();
    if scene.extension().is_none_or(|extension| extension != "toml") {
        scene.as_mut_os_string().push(".toml");
    }
    let failed = |error| (path.to_owned(), error);
    let (folder, name) = Dir::of_file(&scene, false).map_err(|error| failed(error.into()))?;
    let mut file = folder.create_new(&name).map_err(|error| failed(error.into()))?;
    let written = files.into_iter().try_for_each(|(name, bytes)| {
        write_beside(&folder, name, bytes).map_err(|error| (scene.with_file_name(name), error))
    });
    written.and_then(|()| file.write_all(text.as_bytes()).map_err(failed)).inspect_err(|_| {
        // Remove the incomplete file. If removing fails, too, the error of writing is reported anyway.
        let _ = folder.remove_file(&name);
    })?;
    Ok(scene)
}

/// Writes a file that a scene reads. A file that is there already is kept; it must have the same bytes.
fn write_beside(folder: &Dir, name: &str, bytes: &[u8]) -> io::Result<()> {
    if let Some((subfolder, _)) = name.rsplit_once('/') {
        folder.make_folder(subfolder)?;
    }
    match folder.create_new(name).map_err(io::Error::from) {
        Ok(mut file) => file.write_all(bytes).inspect_err(|_| {
            let _ = folder.remove_file(name);
        }),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            let is_same = folder.read(name).is_ok_and(|found| found == bytes);
            if is_same { Ok(()) } else { Err(error) }
        }
        Err(error) => Err(error),
    }
}
