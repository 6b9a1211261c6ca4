//! The scenes that `jabuka new` writes: starters of several kinds in `scenes/starters/`, and the gallery in `scenes/`.
//!
//! `build.rs` puts the scenes into the program.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::system::Dir;

/// The scenes of a folder, by name, and the files that they read, each with its path relative to the scenes.
struct Folder {
    scenes: &'static [Example],
    files: &'static [(&'static str, &'static [u8])],
}

static GALLERY: Folder = include!(concat!(env!("OUT_DIR"), "/scenes.rs"));
static STARTERS: Folder = include!(concat!(env!("OUT_DIR"), "/starters.rs"));

/// The name of the starter that shows the main keys.
pub const FIRST_STARTER: &str = "first";

/// A scene to start from.
#[derive(Debug, PartialEq, Eq)]
pub struct Example {
    /// The name of its file, without `.toml`.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl Example {
    /// Returns the scenes of the gallery, by name.
    pub fn gallery() -> impl Iterator<Item = &'static Example> {
        GALLERY.scenes.iter()
    }

    /// Returns short scenes with comments, one for each kind of scene, by name.
    pub fn starters() -> impl Iterator<Item = &'static Example> {
        STARTERS.scenes.iter()
    }

    /// Returns the title of the scene. If the text has none, it is empty.
    pub fn title(&self) -> &'static str {
        let line = self.text.lines().find_map(|line| line.strip_prefix("title = \""));
        line.map_or("", |line| line.trim_end_matches('"'))
    }

    /// Returns the first sentence of the comment at its beginning.
    pub fn about(&self) -> &'static str {
        let line = self.text.lines().next().unwrap_or_default().trim_start_matches("# ");
        line.find(['.', '?']).map_or(line, |end| &line[..=end])
    }

    /// Returns the files that the scene reads, each with its path relative to the scene.
    fn files(&self) -> impl Iterator<Item = &'static (&'static str, &'static [u8])> {
        let folder = if STARTERS.scenes.contains(self) { &STARTERS } else { &GALLERY };
        let text = self.text;
        folder.files.iter().filter(move |(name, _)| text.contains(&format!("\"{name}\"")))
    }
}

/// Writes a scene into a new file, and beside it the files that it reads. Returns its path: the given one, with `.toml` added if it is missing.
///
/// # Errors
/// If a file exists already with other content, or cannot be written. The error comes with the path of the file.
pub fn write_scene(path: &Path, example: &Example) -> Result<PathBuf, (PathBuf, io::Error)> {
    let mut scene = path.to_owned();
    if scene.extension().is_none_or(|extension| extension != "toml") {
        scene.as_mut_os_string().push(".toml");
    }
    let failed = |error| (path.to_owned(), error);
    let (folder, name) = Dir::of_file(&scene, false).map_err(|error| failed(error.into()))?;
    let mut file = folder.create_new(&name).map_err(|error| failed(error.into()))?;
    let written = example.files().try_for_each(|(name, bytes)| {
        write_beside(&folder, name, bytes).map_err(|error| (scene.with_file_name(name), error))
    });
    written.and_then(|()| file.write_all(example.text.as_bytes()).map_err(failed)).inspect_err(|_| {
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
