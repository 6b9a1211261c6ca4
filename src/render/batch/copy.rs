//! Copies existing scripts into the folder of a cluster job.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::Path;

use crate::emit::{COMMON, INI, MASTER};
use crate::output::{self, Entry, Folder, Header, MANIFEST, Manifest, OutputError};
use crate::render::files;

/// Returns the header of a folder's manifest.
///
/// # Errors
/// If the folder contains no scripts of jabuka's, or some scripts are missing.
pub(super) fn complete(scripts: &Path) -> Result<Header, OutputError> {
    match output::read_manifest(&scripts.join(MANIFEST)) {
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
    let same = |a: &Path, b: &Path| Ok::<_, io::Error>(a.canonicalize()? == b.canonicalize()?);
    if same(from, to.path()).map_err(io_error)? {
        return Ok(());
    }
    let names = scripts(from).map_err(io_error)?;
    let old = scripts(to.path()).map_err(|error| OutputError::Io(to.path().to_owned(), error))?;
    // A file that the user has edited is renamed before a different file replaces it.
    let known = Manifest::read(to.path()).map(|manifest| manifest.files).unwrap_or_default();
    let is_equal = |name: &str| matches!((fs::read(from.join(name)), fs::read(to.path().join(name))), (Ok(a), Ok(b)) if a == b);
    let replaced: Vec<&Entry> = known.iter().filter(|entry| !is_equal(&entry.name)).collect();
    to.set_aside(replaced.into_iter())?;
    for name in old.difference(&names).filter(|name| name.as_str() != MANIFEST) {
        let path = to.path().join(name);
        fs::remove_file(&path).map_err(|error| OutputError::Io(path, error))?;
    }
    // The manifest is copied last, since it marks the folder as complete.
    let last = names.get(MANIFEST);
    for name in names.iter().filter(|name| name.as_str() != MANIFEST).chain(last) {
        let path = from.join(name);
        let bytes = fs::read(&path).map_err(|error| OutputError::Io(path, error))?;
        if fs::read(to.path().join(name)).is_ok_and(|there| there == bytes) {
            continue;
        }
        if let Some((folder, _)) = name.rsplit_once('/') {
            let folder = to.path().join(folder);
            fs::create_dir_all(&folder).map_err(|error| OutputError::Io(folder, error))?;
        }
        to.write(name, &bytes)?;
    }
    to.settle(false)
}

/// Returns the names of all files that jabuka wrote into a folder of scripts, with their assets.
fn scripts(folder: &Path) -> io::Result<BTreeSet<String>> {
    let mut names: BTreeSet<String> = files::of_scripts(folder)?.into_iter().collect();
    names.extend(output::trail_files(folder)?);
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        let numbered = |start: &str| {
            let digits = name.strip_prefix(start).and_then(|name| name.strip_suffix(".pov"));
            digits.is_some_and(|digits| digits.len() >= 4 && digits.bytes().all(|b| b.is_ascii_digit()))
        };
        let ours = [COMMON, INI, MASTER, MANIFEST].contains(&name.as_str());
        if entry.file_type()?.is_file() && (ours || numbered("frame_") || numbered("shutter_")) {
            names.insert(name);
        }
    }
    Ok(names)
}

/// Returns the width and height of the images (pixels), and whether they have an alpha channel. Reads `animation.ini` in the folder of the
/// scripts.
pub fn size(scripts: &Path) -> ([u32; 2], bool) {
    let ini = fs::read_to_string(scripts.join(INI)).unwrap_or_default();
    let value = |key: &str| ini.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
    let number =
        |key: &str, default| value(key).and_then(|value| value.trim().parse().ok()).unwrap_or(default);
    ([number("Width", 1280), number("Height", 720)], value("Output_Alpha").is_some_and(|v| v.trim() == "On"))
}
