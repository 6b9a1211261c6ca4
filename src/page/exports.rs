//! The files that `jabuka export` would write, for users who take them along from the browser.

use super::{Failed, PageRun};
use crate::diagnostic::{Code, Report};
use crate::export::{ExportError, FORMATS, FileKind, Format};
use crate::simulate::Selection;

/// Returns the table or the model that the command writes without further options, with all frames of the run.
pub(super) fn file(run: &PageRun, kind: &FileKind) -> Result<Vec<u8>, Failed> {
    let is_wanted = |format: &&dyn Format| format.option().is_none() && format.file_kind() == kind;
    let format = FORMATS.into_iter().find(is_wanted).ok_or(Failed::Gone)?;
    written(run, format)
}

/// Returns the file of a format, with all frames of the run.
pub(super) fn written(run: &PageRun, format: &dyn Format) -> Result<Vec<u8>, Failed> {
    let recorded = run.finished()?;
    if let Some(lack) = format.lack(&run.scene) {
        return Err(Report::of_error(Code::CannotExport, lack).into());
    }
    let mut bytes = Vec::new();
    format.write(&recorded, &Selection::first(run.scene.simulation.timeline.frames()), &mut bytes)?;
    Ok(bytes)
}

impl From<ExportError> for Failed {
    fn from(error: ExportError) -> Failed {
        match error {
            ExportError::Io(error) => Failed::Io(error),
            ExportError::Simulate(error) => error.into(),
            ExportError::Run(report) => report.into(),
            error => Report::of_error(Code::CannotExport, error.to_string()).into(),
        }
    }
}
