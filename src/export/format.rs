//! The formats of an export.

use std::borrow::Cow;
use std::io::Write;

use super::ExportError;
use super::bodies::Bodies;
use super::events::Events;
use super::glb::Model;
use super::joints::Joints;
use super::particles::Particles;
use crate::scene::Scene;
use crate::simulate::{Recorded, Selection};

/// A format of an export: what it contains, and how it is written.
pub trait Format: Sync {
    /// Returns the kind of its files.
    fn file_kind(&self) -> &'static FileKind {
        &TABLE
    }

    /// Returns the option of `jabuka export` that selects the format, without its dashes. `None` if the extension alone selects it.
    fn option(&self) -> Option<&'static str> {
        None
    }

    /// Explains why a scene has nothing to write in this format. `None` if it has something.
    fn lack(&self, _scene: &Scene) -> Option<Cow<'static, str>> {
        None
    }

    /// Returns what the summary says about the particles of a scene: why this format leaves them out, or what writes them. `None` if it says
    /// nothing.
    fn without_particles(&self) -> Option<&'static str> {
        None
    }

    /// Returns true if the format holds only whole runs, with all frames.
    fn needs_all_frames(&self) -> bool {
        false
    }

    /// Writes the selected frames of a run.
    ///
    /// # Errors
    /// If the file cannot be written, the recording cannot be read, or the format cannot hold the scene.
    fn write(
        &self,
        run: &Recorded<'_>,
        selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError>;
}

/// A kind of files.
#[derive(Debug, PartialEq, Eq)]
pub struct FileKind {
    /// The kind in messages, such as "a table".
    pub noun: &'static str,
    /// The extension of file names, without the dot.
    pub extension: &'static str,
}

/// Tables of numbers, separated by commas.
pub static TABLE: FileKind = FileKind { noun: "a table", extension: "csv" };
/// Animated models in binary glTF.
pub static MODEL: FileKind = FileKind { noun: "a model", extension: "glb" };

/// Drawings of lines and letters in SVG.
pub static DRAWING: FileKind = FileKind { noun: "a drawing", extension: "svg" };
/// Drawings as images in PNG.
pub static IMAGE: FileKind = FileKind { noun: "an image", extension: "png" };
/// Drawings of lines and letters in PDF.
pub static PAGE: FileKind = FileKind { noun: "a page", extension: "pdf" };

/// What a written file contains.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// The contents in words, such as "251 rows".
    pub words: String,
    /// The size of the file, bytes. `None` for a text.
    pub bytes: Option<u64>,
    /// The ratio of the simulated time to the time of the animation; 1 for a table.
    pub faster: f64,
}

/// All formats that need no further choice. Each stands here once.
pub static FORMATS: [&dyn Format; 5] = [&Bodies, &Joints, &Particles, &Events, &Model];

impl Contents {
    /// The contents of a table.
    pub(super) fn of_table(words: String) -> Contents {
        Contents { words, bytes: None, faster: 1.0 }
    }

    /// The contents of a table with some rows for each selected frame of several things, such as "3 bodies".
    pub(super) fn of_rows(rows: usize, of: &str, run: &Recorded<'_>, selection: &Selection) -> Contents {
        let times = selection.count_within(run.scene().simulation.timeline.frames());
        Contents::of_table(format!("{rows} rows, {times} times of {of}"))
    }
}

/// Returns the number of bodies of a scene in words.
pub(crate) fn count_of_bodies(scene: &Scene) -> String {
    match scene.bodies.len() {
        1 => "1 body".to_owned(),
        bodies => format!("{bodies} bodies"),
    }
}
