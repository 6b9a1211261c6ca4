//! Writes all selected scripts of a run into a folder.

use std::collections::{HashMap, HashSet};
use std::io::{self, Write};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use rayon::iter::{ParallelBridge, ParallelIterator};

use super::ledger::Ledger;
use super::manifest::{self, Entry, Header, MANIFEST, Manifest, State};
use super::trails::TrailFiles;
use super::{DigestWriter, Folder, OutputError, assets, is_own_name};
use crate::Run;
use crate::emit::{ASSETS, frame_name, shutter_name};
use crate::scene::{Asset, Shutter};
use crate::simulate::{Exposure, Selection};

/// A summary of the files that [`write()`] has written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The number of frames whose scripts were written.
    pub scripts: usize,
    /// The total length of the written files, without the manifest, in bytes.
    pub bytes: u64,
    /// The number of other frames of the same scene whose scripts were kept.
    pub kept: usize,
    /// The number of other frames whose scripts were removed. They belonged to another scene, or to this scene before it was changed.
    pub removed: usize,
}

/// Writes the selected scripts of a run, and the files that render the whole sequence. `done` is called after every frame.
///
/// The manifest is written first, and again when all files are there. In between, it marks the folder as incomplete, also after a crash.
///
/// # Errors
/// If a file cannot be written, a value of the run becomes non-finite, or a script cannot be made. If a script cannot be made, a folder that
/// was empty before is left as it was.
pub fn write(
    run: &Run<'_>,
    folder: &Folder,
    selection: &Selection,
    done: &(dyn Fn() + Sync),
) -> Result<Written, OutputError> {
    let written = write_all(run, folder, selection, done);
    if let Err(OutputError::Run(_)) = written {
        folder.discard();
    }
    written
}

fn write_all(
    run: &Run<'_>,
    folder: &Folder,
    selection: &Selection,
    done: &(dyn Fn() + Sync),
) -> Result<Written, OutputError> {
    // Most mistakes in a template of the user concern every script. They are found before any file is changed.
    if !run.scene().povray.templates.is_empty()
        && let Some(first) = run.recorded().exposures(selection).next()
    {
        run.script(&first?.frame)?;
    }
    let head = Header::new(run);
    let put_head = |state: State, untouched: &[Entry]| {
        let head = Header { state, planned: Some(selection.to_string()), ..head.clone() };
        folder.write_with(MANIFEST, |file| manifest::write(file, &head, untouched))
    };
    // What the manifest of another machine says is not relied upon, so all scripts are written again.
    let is_same = |old: Header| folder.is_made_here() && old.is_of(&head);
    let unchanged = manifest::read(folder.dir()).is_some_and(is_same);
    let old = replaced(folder, &run.scene().povray.assets);
    // The manifest goes on listing the scripts of unselected frames, so that later commands still recognize edits of them.
    let is_untouched =
        |entry: &Entry| unchanged && entry.frame.is_some_and(|frame| !selection.contains(frame));
    let (untouched, touched): (Vec<Entry>, Vec<Entry>) = old.into_iter().partition(is_untouched);
    folder.set_aside(touched.iter())?;
    let by_name = |entry: &Entry| (entry.name.clone(), entry.clone());
    let known: HashMap<String, Entry> =
        if unchanged { untouched.iter().chain(&touched).map(by_name).collect() } else { HashMap::new() };
    let mut removed = Vec::new();
    if !unchanged {
        put_head(State::Clearing, &[])?;
        removed = folder.remove_scripts()?;
    }
    put_head(State::Writing, &untouched)?;

    let trails = TrailFiles::default();
    let scripts = Scripts::write(run, folder, selection, &trails, done)?;
    let mut entries = Vec::new();
    let trails = trails.into_entries();
    let kept = kept(folder, selection, &known)?;
    let of_frame =
        |entry: &Entry| entry.frame.filter(|&frame| entry.name == frame_name(frame, scripts.scene_frames));
    let present = scripts.written(selection).chain(kept.iter().filter_map(of_frame));
    for (name, text) in run.emitter().sequence(run.scene(), present)? {
        folder.write(name, text.as_bytes())?;
        entries.push(Entry::of(None, name.to_owned(), text.as_bytes()));
    }
    entries.extend(assets::copy(folder, &run.scene().povray.assets)?);
    folder.settle(unchanged)?;
    folder.note_made_here();
    let kept_trails = kept_trails(folder, &trails, &known)?;
    entries.extend(trails);
    removed.retain(|frame| !selection.contains(*frame));
    let bytes = scripts.bytes + entries.iter().map(|entry| entry.bytes).sum::<u64>();
    let written = Written { scripts: scripts.frames, bytes, kept: frames(&kept), removed: removed.len() };
    entries.extend(kept);
    entries.extend(kept_trails);
    entries.sort_by(in_order);
    let all = scripts.merged(entries, selection);
    folder.write_with(MANIFEST, |file| manifest::write_each(file, &head, all))?;
    Ok(written)
}

/// Returns the entries of a folder's manifest whose files a command may replace or remove: scripts, their include files, and these assets.
/// Other files are none of jabuka's, whatever the manifest says.
pub(super) fn replaced(folder: &Folder, assets: &[Asset]) -> Vec<Entry> {
    let mut files = Manifest::of_dir(folder.dir()).map(|manifest| manifest.files).unwrap_or_default();
    let is_asset = |name: &str| {
        let name = name.strip_prefix(ASSETS).and_then(|name| name.strip_prefix('/'));
        name.is_some_and(|name| assets.iter().any(|asset| asset.name == name))
    };
    files.retain(|entry| entry.name != MANIFEST && (is_own_name(&entry.name) || is_asset(&entry.name)));
    files
}

/// Counts the frames that have one of these scripts. The scripts of one frame must be adjacent.
fn frames(entries: &[Entry]) -> usize {
    entries.chunk_by(|a, b| a.frame == b.frame).count()
}

/// The scripts that a command has written, with their sizes and digests.
struct Scripts {
    ledger: Ledger,
    /// The total number of frames of the scene.
    scene_frames: usize,
    /// The number of scripts for each frame: 2 with motion blur, otherwise 1.
    per_frame: usize,
    /// The number of frames whose scripts were written.
    frames: usize,
    /// The total length of the written scripts, in bytes.
    bytes: u64,
}

impl Scripts {
    /// Writes the selected scripts. The recording yields the frames in order, and any free thread takes the next. So there are never more
    /// frames in memory than threads.
    fn write(
        run: &Run<'_>,
        folder: &Folder,
        selection: &Selection,
        trails: &TrailFiles,
        done: &(dyn Fn() + Sync),
    ) -> Result<Scripts, OutputError> {
        let scene_frames = run.scene().simulation.timeline.frames();
        let per_frame = if run.shutter().is_some() { 2 } else { 1 };
        let lost = |error| OutputError::Io(folder.path().join(MANIFEST), error);
        let ledger = Ledger::new(scene_frames * per_frame).map_err(lost)?;
        let (frames, bytes) = (AtomicUsize::new(0), AtomicU64::new(0));
        let note = |place: usize, entry: &Entry| {
            bytes.fetch_add(entry.bytes, Ordering::Relaxed);
            ledger.put(place, entry.bytes, entry.sha256).map_err(lost)
        };
        let put = |exposed| -> Result<(), OutputError> {
            let exposure: Exposure = exposed?;
            let frame = &exposure.frame;
            let text = run.script(frame)?;
            trails.put(run, folder, frame)?;
            let name = frame_name(frame.index, scene_frames);
            folder.write(&name, text.as_bytes())?;
            let first = frame.index * per_frame;
            note(first, &Entry::of(Some(frame.index), name, text.as_bytes()))?;
            if let Some(shutter) = run.shutter() {
                note(first + 1, &put_blurred(run, folder, &exposure, shutter, trails)?)?;
            }
            frames.fetch_add(1, Ordering::Relaxed);
            done();
            Ok(())
        };
        run.recorded().exposures(selection).par_bridge().try_for_each(put)?;
        let (frames, bytes) = (frames.into_inner(), bytes.into_inner());
        Ok(Scripts { ledger, scene_frames, per_frame, frames, bytes })
    }

    /// Yields the numbers of the frames whose scripts were written.
    fn written(&self, selection: &Selection) -> impl Iterator<Item = usize> {
        (0..self.scene_frames).filter(|&frame| selection.contains(frame))
    }

    /// Yields the manifest entries of the written scripts, merged with other sorted entries, in the order of the manifest.
    fn merged(&self, others: Vec<Entry>, selection: &Selection) -> impl Iterator<Item = io::Result<Entry>> {
        let mut scripts = self
            .written(selection)
            .flat_map(|frame| (0..self.per_frame).map(move |which| (frame, which)))
            .map(|(frame, which)| self.entry(frame, which))
            .peekable();
        let mut others = others.into_iter().peekable();
        std::iter::from_fn(move || {
            let is_other_next = match (others.peek(), scripts.peek()) {
                (Some(other), Some(Ok(script))) => in_order(other, script) == std::cmp::Ordering::Less,
                (Some(_), None) => true,
                _ => false,
            };
            if is_other_next { others.next().map(Ok) } else { scripts.next() }
        })
    }

    fn entry(&self, frame: usize, which: usize) -> io::Result<Entry> {
        let (bytes, sha256) = self.ledger.get(frame * self.per_frame + which)?;
        let name = if which == 0 { frame_name } else { shutter_name };
        Ok(Entry { frame: Some(frame), name: name(frame, self.scene_frames), bytes, sha256 })
    }
}

/// Compares two entries by their order in the manifest: first the files of the whole sequence, then the scripts by frame.
fn in_order(a: &Entry, b: &Entry) -> std::cmp::Ordering {
    (a.frame, &a.name).cmp(&(b.frame, &b.name))
}

/// Writes the script of an image with motion blur, one moment after another. Returns its manifest entry.
pub(super) fn put_blurred(
    run: &Run<'_>,
    folder: &Folder,
    exposure: &Exposure,
    shutter: Shutter,
    trails: &TrailFiles,
) -> Result<Entry, OutputError> {
    let frame = &exposure.frame;
    let name = shutter_name(frame.index, run.scene().simulation.timeline.frames());
    let mut digest = DigestWriter::default();
    let moments = exposure.moments(shutter).map(|moment| {
        let moment = moment?;
        trails.put(run, folder, &moment)?;
        Ok(moment)
    });
    folder.try_write_with(&name, |file| {
        run.emitter().shutter(frame, shutter, moments, |piece| {
            digest.add(piece.as_bytes());
            let io_error = |error| OutputError::Io(folder.path().join(&name), error);
            file.write_all(piece.as_bytes()).map_err(io_error)
        })
    })?;
    Ok(digest.entry(Some(frame.index), name))
}

/// Returns the manifest entries of the trail files that were in the folder before and stay. Entries of the old manifest are reused.
fn kept_trails(
    folder: &Folder,
    written: &[Entry],
    known: &HashMap<String, Entry>,
) -> Result<Vec<Entry>, OutputError> {
    let written: HashSet<&str> = written.iter().map(|entry| entry.name.as_str()).collect();
    let others = folder.trail_files()?.into_iter().filter(|name| !written.contains(name.as_str()));
    others.map(|name| kept_entry(folder, None, name, known)).collect()
}

/// Returns the manifest entries of the scripts that were in the folder before and stay. Entries of the old manifest are reused.
fn kept(
    folder: &Folder,
    selection: &Selection,
    known: &HashMap<String, Entry>,
) -> Result<Vec<Entry>, OutputError> {
    let others = folder.scripts(|frame| !selection.contains(frame))?.into_iter();
    others.map(|(frame, name)| kept_entry(folder, Some(frame), name, known)).collect()
}

/// Returns the manifest entry of a file that stays in the folder. An entry of the old manifest is reused, so that a later command
/// recognizes an edit of the file.
fn kept_entry(
    folder: &Folder,
    frame: Option<usize>,
    name: String,
    known: &HashMap<String, Entry>,
) -> Result<Entry, OutputError> {
    if let Some(entry) = known.get(&name) {
        return Ok(entry.clone());
    }
    let bytes = folder.dir().read(&name)?;
    Ok(Entry::of(frame, name, &bytes))
}
