//! The command `jabuka report`: measures the accuracy of the simulation of a scene.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use crate::Scene;
use crate::diagnostic::visible_path;
use crate::export::ExportError;
use crate::output::OutputError;
use crate::overwrite::ProtectedFiles;
use crate::report::plot::{Picture, png, svg};
use crate::report::{Assessment, DEFAULT_ACCURACY, Phase, assess};
use clap::ValueEnum;

use super::export::whole;
use super::progress::Progress;
use super::scene_arguments::SceneArguments;
use super::{Failure, interrupt, terminal};

/// Measure the accuracy of a simulation, and find the method and step for a wanted accuracy
///
/// The simulation is compared with others at half and at a quarter of its step, and with one that starts from slightly different
/// positions. Then other methods and steps are tried. This takes about ten times as long as the simulation, or two seconds. No file is
/// written except the plot.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The wanted accuracy: the maximum position error of any point of a body, as a fraction of the size of the scene. 0.001 is about a
    /// pixel
    #[arg(long, value_name = "PART", default_value_t = DEFAULT_ACCURACY, value_parser = parse_accuracy)]
    accuracy: f64,
    /// Plot the energy drift, the error, and the distance between neighboring runs over time: FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// The format of the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    #[command(flatten)]
    of_scene: SceneArguments,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Text for people
    Text,
    /// JSON for programs: one object
    Json,
}

/// The file formats of a plot.
#[derive(Clone, Copy)]
enum Plot {
    Svg,
    Png,
}

impl Plot {
    /// Returns the format that belongs to the extension of a plot's file name.
    fn of(path: &Path) -> Result<Plot, Failure> {
        let extension = path.extension().unwrap_or_default();
        if extension.eq_ignore_ascii_case("svg") {
            Ok(Plot::Svg)
        } else if extension.eq_ignore_ascii_case("png") {
            Ok(Plot::Png)
        } else {
            let shown = visible_path(path);
            Err(Failure::Usage(format!("a plot is an `.svg` or a `.png`, and `{shown}` ends in neither")))
        }
    }
}

fn parse_accuracy(argument: &str) -> Result<f64, String> {
    match argument.parse() {
        Ok(part) if (1e-12..=0.5).contains(&part) => Ok(part),
        _ => Err("it is a part of the size of the scene, from 1e-12 to 0.5, as in 1e-3".to_owned()),
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    /// The number of steps of the progress bar in each of the two phases of the report.
    const STEPS_PER_PHASE: usize = 500;
    let stop = interrupt::watched();
    let plot = arguments.plot.as_deref().map(|path| Ok((path, Plot::of(path)?))).transpose()?;
    let scene = arguments.of_scene.read_with(&arguments.scene, &[])?;
    if let Some((path, _)) = plot {
        terminal::report_protected(ProtectedFiles::of_scene(&scene).check(path))?;
    }
    let progress = Progress::new(2 * STEPS_PER_PHASE);
    let mut done = 0;
    let assessed = assess(&scene, arguments.accuracy, &mut |phase, part| {
        let (what, before) = match phase {
            Phase::Comparing => ("comparing", 0),
            Phase::Trying => ("trying", STEPS_PER_PHASE),
        };
        progress.phase(what);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is a part of few steps"
        )]
        let now = before + (part * STEPS_PER_PHASE as f64) as usize;
        while done < now {
            progress.step();
            done += 1;
        }
        !stop.load(Ordering::Relaxed)
    });
    progress.finish();
    let Ok(assessment) = assessed else {
        terminal::error("stopped\n");
        return Err(Failure::Interrupted);
    };
    match arguments.format {
        Format::Text => terminal::result(&assessment.to_text(&visible_path(&arguments.scene).to_string())),
        Format::Json => match serde_json::to_string_pretty(&assessment) {
            Ok(text) => terminal::json(&format!("{text}\n")),
            Err(error) => return Err(Failure::Usage(error.to_string())),
        },
    }
    match plot {
        Some((path, format)) => draw(&assessment, &scene, path, format, arguments.format),
        None => Ok(()),
    }
}

/// Writes the plot to a file. Prints the file's path if the report is in text format.
fn draw(
    assessment: &Assessment,
    scene: &Scene,
    path: &Path,
    plot: Plot,
    format: Format,
) -> Result<(), Failure> {
    let title = scene.title.as_deref().unwrap_or(&scene.name);
    let Some(picture) = Picture::of(assessment, title) else {
        terminal::error("nothing is integrated, so there is no plot\n");
        return Err(Failure::Errors);
    };
    let written = whole(path, |file| {
        match plot {
            Plot::Svg => file.write_all(svg(&picture).as_bytes())?,
            Plot::Png => file.write_all(&png(&picture).map_err(std::io::Error::from)?)?,
        }
        file.flush().map_err(ExportError::from)
    });
    if let Err(ExportError::Io(error)) = written {
        terminal::report(&OutputError::Io(path.to_owned(), error).report());
        return Err(Failure::Errors);
    }
    if format == Format::Text {
        terminal::result(&format!("plot      {}\n", visible_path(path)));
    }
    Ok(())
}
