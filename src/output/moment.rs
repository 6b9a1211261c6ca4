//! Writes the script of a single moment of a run.

use super::manifest::{self, Entry, Header, MANIFEST, State};
use super::trails::TrailFiles;
use super::write::{put_blurred, replaced};
use super::{Folder, OutputError, assets};
use crate::Run;
use crate::emit::frame_name;

/// Writes the script of one moment of a run, and removes all other scripts in the folder. `time` (s) may lie between two frames. Returns
/// the number of the frame at or before that time, which is part of the script's name.
///
/// # Errors
/// If a file cannot be written, a value of the run becomes non-finite before that time, or the script cannot be made. If the script cannot be
/// made, a folder that was empty before is left as it was.
pub fn write_moment(run: &Run<'_>, folder: &Folder, time: f64) -> Result<usize, OutputError> {
    let written = write_all(run, folder, time);
    if let Err(OutputError::Run(_)) = written {
        folder.discard();
    }
    written
}

fn write_all(run: &Run<'_>, folder: &Folder, time: f64) -> Result<usize, OutputError> {
    let scene = run.scene();
    // The script is made before any file is changed, so that existing files stay if this fails.
    let exposure = run.at(time)?;
    let frame = &exposure.frame;
    let script = run.script(frame)?;

    let head = Header::new(run);
    folder.set_aside(replaced(folder, &scene.povray.assets).iter())?;
    let begun = Header { state: State::Clearing, ..head.clone() };
    folder.write_with(MANIFEST, |file| manifest::write(file, &begun, &[]))?;
    folder.remove_scripts()?;

    let mut entries = Vec::new();
    let mut put = |number: Option<usize>, name: String, text: &str| {
        folder.write(&name, text.as_bytes())?;
        entries.push(Entry::of(number, name, text.as_bytes()));
        Ok::<(), OutputError>(())
    };
    for (name, text) in run.emitter().sequence(scene, [frame.index])? {
        put(None, name.to_owned(), &text)?;
    }
    let trails = TrailFiles::default();
    trails.put(run, folder, frame)?;
    put(Some(frame.index), frame_name(frame.index, scene.simulation.timeline.frames()), &script)?;
    if let Some(shutter) = run.shutter() {
        entries.push(put_blurred(run, folder, &exposure, shutter, &trails)?);
    }
    entries.extend(trails.into_entries());
    entries.extend(assets::copy(folder, &scene.povray.assets)?);
    entries.sort_by(|a, b| (a.frame, &a.name).cmp(&(b.frame, &b.name)));
    folder.settle(false)?;
    folder.note_made_here();
    folder.write_with(MANIFEST, |file| manifest::write(file, &head, &entries))?;
    Ok(frame.index)
}
