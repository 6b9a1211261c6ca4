//! Copies existing scripts into the folder of a cluster job.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use crate::emit::INI;
use crate::output::{self, Entry, Folder, Header, MANIFEST, Manifest, OutputError};
use crate::render::files;
use crate::system::{self, Dir, FolderError, Kind};

/// Returns the header of a folder's manifest.
///
/// # Errors
/// If the folder contains no scripts of jabuka's, or some scripts are missing.
pub(super) fn complete(scripts: &Path) -> Result<Header, OutputError> {
    match output::read_manifest(scripts) {
        None => Err(OutputError::NoScripts(scripts.to_owned())),
        Some(head) if head.state != output::State::Complete => {
            Err(OutputError::Incomplete(scripts.to_owned()))
        }
        Some(head) => Ok(head),
    }
}

/// Copies all scripts of a folder, and the files that they read, into the script folder of a job. Files that are already equal stay
/// untouched, and obsolete ones are removed.
///
/// # Errors
/// If scripts are missing, or a file cannot be copied.
pub fn copy_scripts(from: &Path, to: &Folder) -> Result<(), OutputError> {
    let io_error = |error| OutputError::Io(from.to_owned(), error);
    complete(from)?;
    let same = |a: &Path, b: &Path| Ok::<_, io::Error>(system::canonicalize(a)? == system::canonicalize(b)?);
    if same(from, to.path()).map_err(io_error)? {
        return Ok(());
    }
    let from_dir = Dir::of_path(from)?;
    let (names, old) = (scripts(&from_dir)?, scripts(to.dir())?);
    // A file that the user has edited is renamed before a different file replaces it.
    let known = Manifest::of_dir(to.dir()).map(|manifest| manifest.files).unwrap_or_default();
    let is_equal =
        |name: &str| matches!((from_dir.read(name), to.dir().read(name)), (Ok(a), Ok(b)) if a == b);
    let is_replaced = |entry: &&Entry| {
        let is_ours = names.contains(&entry.name) || old.contains(&entry.name);
        is_ours && entry.name != MANIFEST && !is_equal(&entry.name)
    };
    to.set_aside(known.iter().filter(is_replaced))?;
    for name in old.difference(&names).filter(|name| name.as_str() != MANIFEST) {
        to.dir().remove_file(name)?;
    }
    // The manifest is copied last, since it marks the folder as complete.
    let last = names.get(MANIFEST);
    for name in names.iter().filter(|name| name.as_str() != MANIFEST).chain(last) {
        let bytes = from_dir.read(name)?;
        if to.dir().read(name).is_ok_and(|there| there == bytes) {
            continue;
        }
        if let Some((folder, _)) = name.rsplit_once('/') {
            to.dir().make_folder(folder)?;
        }
        to.write(name, &bytes)?;
    }
    to.note_made_here();
    to.settle(false)
}

/// Returns the names of all files that jabuka wrote into a folder of scripts, with their assets.
fn scripts(folder: &Dir) -> Result<BTreeSet<String>, OutputError> {
    let files = files::in_folder(folder)?;
    let mut names: BTreeSet<String> = files.into_iter().collect();
    for name in folder.names()? {
        let Ok(name) = name.into_string() else { continue };
        let is_file =
            || Ok::<_, FolderError>(folder.about(&name)?.is_some_and(|found| found.kind == Kind::File));
        if output::is_own_name(&name) && is_file()? {
            names.insert(name);
        }
    }
    Ok(names)
}

/// Returns the width and height of the images (pixels), and whether they have an alpha channel. Reads `animation.ini` in the folder of the
/// scripts.
pub fn size(scripts: &Path) -> ([u32; 2], bool) {
    let ini = system::read_to_string(&scripts.join(INI)).unwrap_or_default();
    let value = |key: &str| ini.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
    let number =
        |key: &str, default| value(key).and_then(|value| value.trim().parse().ok()).unwrap_or(default);
    ([number("Width", 1280), number("Height", 720)], value("Output_Alpha").is_some_and(|v| v.trim() == "On"))
}
