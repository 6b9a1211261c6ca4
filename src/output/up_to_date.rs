//! Checks whether a folder already contains exactly the files that a scene gives.

use std::collections::HashSet;
use std::fs::File;
use std::io::Read;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::manifest::{Entry, Header, Manifest};
use super::{DigestWriter, Folder};
use crate::emit::{ASSETS, frame_name, shutter_name};
use crate::scene::{Scene, View};
use crate::simulate::Selection;

/// Returns the manifest of a folder that already contains the same bytes that this program would write for the selected frames. The scene
/// then need not be simulated. `None` if the folder differs, or if a difference cannot be excluded.
pub fn up_to_date(
    scene: &Scene,
    view: Option<&View>,
    selection: &Selection,
    folder: &Folder,
) -> Option<Manifest> {
    // A manifest from elsewhere may fit scripts that the scene does not give.
    let manifest =
        Manifest::of_dir(folder.dir()).filter(|manifest| folder.is_made_here() && manifest.is_complete())?;
    let shutter = view.map_or(&scene.camera, |view| &view.camera).shutter;
    let head = Header::of(scene, view.map(|view| view.name.as_str()), shutter);
    if !manifest.head.is_of(&head) {
        return None;
    }
    let listed: HashSet<&str> = manifest.files.iter().map(|entry| entry.name.as_str()).collect();
    let frames = scene.simulation.timeline.frames();
    let is_listed = |frame: usize| {
        listed.contains(&*frame_name(frame, frames))
            && (shutter.is_none() || listed.contains(&*shutter_name(frame, frames)))
    };
    let all = (0..frames).filter(|frame| selection.contains(*frame)).all(is_listed);
    let has_length =
        |file: &File, entry: &Entry| file.metadata().is_ok_and(|metadata| metadata.len() == entry.bytes);
    let as_written = |entry: &Entry| {
        let file = folder.dir().open_file(&entry.name);
        file.is_ok_and(|file| has_length(&file, entry) && is_of(file, entry))
    };
    let unchanged = all && manifest.files.par_iter().all(as_written) && same_assets(scene, &manifest);
    unchanged.then_some(manifest)
}

/// Returns true if the folder contains current copies of all assets of the scene. The digest of the scene does not cover the contents of
/// assets.
fn same_assets(scene: &Scene, manifest: &Manifest) -> bool {
    scene.povray.assets.iter().all(|asset| {
        let name = format!("{ASSETS}/{}", asset.name);
        manifest
            .files
            .iter()
            .any(|entry| entry.name == name && asset.open().is_ok_and(|contents| is_of(contents, entry)))
    })
}

/// Returns true if contents have the length and the digest of a manifest entry.
fn is_of(contents: impl Read, entry: &Entry) -> bool {
    let writer = DigestWriter::of(contents).map(|writer| writer.entry(entry.frame, entry.name.clone()));
    writer.is_ok_and(|found| found == *entry)
}
