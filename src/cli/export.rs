//! `jabuka export`: scene → a table of where everything is.

use std::fs::{self, OpenOptions};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use jabuka::diagnostic::Report;
use jabuka::export::{ExportError, write_csv};
use jabuka::output::OutputError;
use jabuka::simulate::Selection;

use super::scene_arguments::SceneArguments;
use super::{Failure, say};

/// Write where all bodies are at every frame, as a CSV file
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The file to write: FILE.csv
    #[arg(short, long, value_name = "FILE.csv")]
    output: PathBuf,
    /// Take only these frames, as in 0,50,90-100
    #[arg(long, value_name = "LIST")]
    frames: Option<Selection>,
    #[command(flatten)]
    of_scene: SceneArguments,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let shown = arguments.output.display();
    if arguments.output.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("csv")) {
        return Err(Failure::Usage(format!("a table is a CSV file, and `{shown}` does not end in `.csv`")));
    }
    let scene = arguments.of_scene.read_with(&arguments.scene, &[])?;
    let frames = scene.simulation.frames();
    let selection = arguments.frames.clone().unwrap_or_else(|| Selection::first(frames));
    if let Some(last) = selection.last().filter(|last| *last >= frames) {
        let message = format!("there is no frame {last}: the frames of this scene are 0 to {}", frames - 1);
        return Err(Failure::Usage(message));
    }
    let rows = whole(&arguments.output, |file| write_csv(&scene, &selection, file)).map_err(|error| {
        let error = match error {
            ExportError::Io(error) => OutputError::Io(arguments.output.clone(), error),
            ExportError::Diverged(error) => OutputError::from(error),
        };
        say::report(&Report { ..error.report() });
        Failure::Errors
    })?;
    let times = selection.count_within(frames);
    say::result(&format!("{shown}: {rows} rows, {times} times of {} bodies\n", scene.bodies.len()));
    Ok(())
}

/// Writes a file that appears whole or not at all.
fn whole(
    path: &Path,
    write: impl FnOnce(BufWriter<fs::File>) -> Result<usize, ExportError>,
) -> Result<usize, ExportError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = path.with_file_name(format!(".jabuka-{name}.tmp"));
    // What a killed run has left.
    let _ = fs::remove_file(&temporary);
    let done = OpenOptions::new().write(true).create_new(true).open(&temporary).map_err(ExportError::from);
    let done = done.and_then(|file| write(BufWriter::new(file)));
    let done = done.and_then(|rows| fs::rename(&temporary, path).map(|()| rows).map_err(ExportError::from));
    done.inspect_err(|_| {
        // What could not be written may not be there.
        let _: io::Result<()> = fs::remove_file(&temporary);
    })
}
