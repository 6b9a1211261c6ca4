//! All selected scripts of a run into a folder.

use std::fs;

use rayon::iter::{ParallelBridge, ParallelIterator};

use super::manifest::{self, Entry, Head, MANIFEST, State};
use super::{Folder, OutputError, assets};
use crate::Run;
use crate::emit::frame_name;
use crate::simulate::Selection;

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The number of scripts.
    pub scripts: usize,
    /// The bytes of all files but the manifest.
    pub bytes: u64,
    /// The scripts of other frames of the scene that have stayed.
    pub kept: usize,
    /// The scripts of other frames that were of another scene, or of this one before it was changed, and are gone.
    pub removed: usize,
}

/// Writes the selected scripts of a run, and what renders the whole sequence. `done` is told of every script.
///
/// The manifest is there from the first moment to the last: a run that is killed leaves a folder that says so.
///
/// # Errors
/// Where a file cannot be written, the run leaves the numbers, or a script cannot be made.
pub fn write(
    run: &Run<'_>,
    folder: &Folder,
    selection: &Selection,
    done: &(dyn Fn() + Sync),
) -> Result<Written, OutputError> {
    let head = Head::new(run);
    let put_head = |state: State| {
        let head = Head { state, planned: Some(selection.to_string()), ..head.clone() };
        folder.write_with(MANIFEST, |file| manifest::write(file, &head, &[]))
    };
    let unchanged = manifest::read(&folder.path().join(MANIFEST)).is_some_and(|old| old.is_of(&head));
    let mut removed = Vec::new();
    if !unchanged {
        put_head(State::Clearing)?;
        removed = folder.remove_scripts()?;
    }
    put_head(State::Writing)?;

    let mut entries = scripts(run, folder, selection, done)?;
    let scripts = entries.len();
    for (name, text) in run.emitter().sequence(run.scene())? {
        folder.write(name, text.as_bytes())?;
        entries.push(Entry::of(None, name.to_owned(), text.as_bytes()));
    }
    entries.extend(assets::copy(folder, &run.scene().povray.assets)?);
    removed.retain(|frame| !selection.contains(*frame));
    let bytes = entries.iter().map(|entry| entry.bytes).sum();
    let kept = kept(folder, selection)?;
    let written = Written { scripts, bytes, kept: kept.len(), removed: removed.len() };
    entries.extend(kept);
    // First what belongs to the sequence as a whole, then the scripts in their order.
    entries.sort_by(|a, b| (a.frame, &a.name).cmp(&(b.frame, &b.name)));
    folder.write_with(MANIFEST, |file| manifest::write(file, &head, &entries))?;
    Ok(written)
}

/// Writes the selected scripts. The frames come one after another, as the simulation makes them; whichever thread is
/// free takes the next, so there are never more frames in memory than threads.
fn scripts(
    run: &Run<'_>,
    folder: &Folder,
    selection: &Selection,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Entry>, OutputError> {
    let frames = run.scene().simulation.frames();
    let put = |frame| -> Result<Entry, OutputError> {
        let frame = frame?;
        let text = run.script(&frame)?;
        let name = frame_name(frame.index, frames);
        folder.write(&name, text.as_bytes())?;
        done();
        Ok(Entry::of(Some(frame.index), name, text.as_bytes()))
    };
    run.selected(selection).par_bridge().map(put).collect()
}

/// The scripts of the folder that were there before and have stayed.
fn kept(folder: &Folder, selection: &Selection) -> Result<Vec<Entry>, OutputError> {
    let others = folder.scripts()?.into_iter().filter(|(frame, _)| !selection.contains(*frame));
    let entry = |(frame, name): (usize, String)| {
        let path = folder.path().join(&name);
        let bytes = fs::read(&path).map_err(|error| OutputError::Io(path, error))?;
        Ok(Entry::of(Some(frame), name, &bytes))
    };
    others.map(entry).collect()
}
