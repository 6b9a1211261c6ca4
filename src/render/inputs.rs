//! What a script reads beside itself: the files that it includes, and the assets of its scene.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::record::{Files, Record};
use super::{RenderError, Script, Sequence};
use crate::emit::is_trail_file;
use crate::scene::sdl::{Include, includes};

/// The record that the image of each script would get now, but for the length of the image.
///
/// # Errors
/// Where a file cannot be read.
pub(super) fn records(sequence: &Sequence, options: &str, version: &str) -> Result<Vec<Record>, RenderError> {
    let scripts = sequence.scripts();
    let lists: Result<Vec<Vec<PathBuf>>, RenderError> =
        scripts.par_iter().map(|script| files_of(sequence, script)).collect();
    let lists = lists?;
    // All scripts of a scene read the same files.
    let mut digests: HashMap<&[PathBuf], Files> = HashMap::new();
    for list in &lists {
        if !digests.contains_key(list.as_slice()) {
            let files = Files::read(list).map_err(|(path, error)| RenderError::io(path)(error))?;
            digests.insert(list, files);
        }
    }
    let pairs: Vec<(&Script, &Files)> =
        scripts.iter().zip(lists.iter().map(|list| &digests[list.as_slice()])).collect();
    let record = |(script, files): &(&Script, &Files)| {
        let path = sequence.folder().join(&script.file);
        Record::expected(&path, script.frame, files, options, version).map_err(RenderError::io(path))
    };
    pairs.par_iter().map(record).collect()
}

/// The files that a script reads, but for those that come with POV-Ray: these belong to its version.
fn files_of(sequence: &Sequence, script: &Script) -> Result<Vec<PathBuf>, RenderError> {
    let path = sequence.folder().join(&script.file);
    let bytes = fs::read(&path).map_err(RenderError::io(&path))?;
    let mut files = Vec::new();
    add_included(sequence.folder(), &bytes, &mut files);
    files.extend(sequence.assets.iter().filter(|asset| !files.contains(asset)).cloned().collect::<Vec<_>>());
    Ok(files)
}

/// Adds the files that a text includes, and those that these include.
fn add_included(folder: &Path, text: &[u8], files: &mut Vec<PathBuf>) {
    for include in includes(&String::from_utf8_lossy(text)) {
        let Include::Literal(name) = include else { continue };
        // The name says what is in it, and stands in the script.
        if is_trail_file(&name) {
            continue;
        }
        let path =
            [folder.join(&name), folder.join("assets").join(&name)].into_iter().find(|path| path.is_file());
        let Some(path) = path.filter(|path| !files.contains(path)) else { continue };
        let text = fs::read(&path).unwrap_or_default();
        files.push(path);
        add_included(folder, &text, files);
    }
}
