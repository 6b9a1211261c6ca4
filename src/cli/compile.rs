//! `jabuka compile`: scene → scripts.

use std::path::{Path, PathBuf};
use std::time::Instant;

use jabuka::diagnostic::{Diagnostic, Report};
use jabuka::output::{self, Folder, OutputError};
use jabuka::scene::{Options, Override};
use jabuka::simulate::Selection;
use jabuka::{Run, Scene};

use super::progress::Progress;
use super::{Failure, say, summary};

/// Compile a scene into POV-Ray scripts, one per frame
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The folder for the scripts [default: out/<name of the scene file>]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace a value of the scene: a TOML value, or else a string; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    set: Vec<Override>,
    /// Write only these frames, as in 0,50,90-100
    #[arg(long, value_name = "LIST", allow_negative_numbers = true)]
    frames: Option<Selection>,
    /// Write nothing: compare the scripts with those in the folder, and fail where they differ
    #[arg(long)]
    check: bool,
    /// Let the scene's SDL open, write and include files, and its paths leave its folder
    #[arg(long)]
    trust: bool,
}

fn parse_set(argument: &str) -> Result<Override, String> {
    match argument.split_once('=') {
        Some((key, _)) if !key.trim().is_empty() => Ok(Override::new(argument)),
        _ => Err("write it as KEY=VALUE, as in simulation.step=0.001".to_owned()),
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let options = Options { overrides: arguments.set.clone(), trust: arguments.trust };
    let scene = Scene::from_path_with(&arguments.scene, &options).map_err(|report| errors(&report))?;
    say::report(&scene.warnings);
    let frames = scene.simulation.frames();
    let selection = selection(arguments, frames)?;
    let folder = arguments.output.clone().unwrap_or_else(|| Path::new("out").join(&scene.name));

    let progress = Progress::new(frames + selection.count_within(frames));
    progress.phase("simulating");
    let run =
        Run::new_seeing(&scene, |_| progress.step()).map_err(|error| failed(&progress, &error.into()))?;
    progress.phase(if arguments.check { "comparing" } else { "writing" });
    if arguments.check {
        return check(&run, &folder, &selection, &progress);
    }
    let folder = Folder::open(&folder).map_err(|error| failed(&progress, &error))?;
    let written = output::write(&run, &folder, &selection, &|| progress.step());
    let written = written.map_err(|error| failed(&progress, &error))?;
    progress.finish();
    say::report(&Report { diagnostics: run.warnings(), ..Report::default() });
    say::result(&summary::summary(&run, folder.path(), &written, start.elapsed()));
    Ok(())
}

fn selection(arguments: &Arguments, frames: usize) -> Result<Selection, Failure> {
    let Some(selection) = &arguments.frames else { return Ok(Selection::first(frames)) };
    match selection.last() {
        Some(last) if last >= frames => {
            let message =
                format!("there is no frame {last}: the frames of this scene are 0 to {}", frames - 1);
            Err(Failure::Usage(message))
        }
        _ => Ok(selection.clone()),
    }
}

fn check(run: &Run<'_>, folder: &Path, selection: &Selection, progress: &Progress) -> Result<(), Failure> {
    /// So many frames are shown in full.
    const SHOWN: usize = 3;
    let differences = output::compare(run, folder, selection, &|| progress.step());
    let differences = differences.map_err(|error| failed(progress, &error))?;
    progress.finish();
    let compared = selection.count_within(run.scene().simulation.frames());
    if differences.is_empty() {
        say::result(&format!("{}: {compared} scripts are as the scene gives them\n", folder.display()));
        return Ok(());
    }
    for difference in differences.iter().take(SHOWN) {
        say::result(&difference.to_text());
    }
    if differences.len() > SHOWN {
        say::result(&format!("… and {} more scripts\n", differences.len() - SHOWN));
    }
    say::result(&format!("{}: {} of {compared} scripts differ\n", folder.display(), differences.len()));
    Err(Failure::Errors)
}

/// Says the errors of a scene.
fn errors(report: &Report) -> Failure {
    say::report(report);
    let (errors, s) = (report.errors(), if report.errors() == 1 { "" } else { "s" });
    say::error(&format!("nothing was written: {errors} error{s}\n"));
    Failure::Errors
}

/// Says why a run failed.
fn failed(progress: &Progress, error: &OutputError) -> Failure {
    progress.finish();
    let diagnostic = Diagnostic::error(error.code(), error.to_string());
    let diagnostic = match error.help() {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    };
    say::report(&Report { diagnostics: vec![diagnostic], ..Report::default() });
    Failure::Errors
}
