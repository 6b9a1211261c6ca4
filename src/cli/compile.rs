//! `jabuka compile`: scene → scripts.

use std::path::{Path, PathBuf};
use std::time::Instant;

use jabuka::diagnostic::Report;
use jabuka::output::{self, Folder, OutputError};
use jabuka::scene::{Options, Override, View};
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
    /// Write the scripts of this view instead of the main camera's, or of `all` cameras; may be repeated
    #[arg(long, value_name = "NAME")]
    view: Vec<String>,
    /// Write nothing: compare the scripts with those in the folder, and fail where they differ
    #[arg(long)]
    check: bool,
    /// Use the templates in this folder in place of those built in: see `jabuka templates`
    #[arg(long, value_name = "DIR")]
    templates: Option<PathBuf>,
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
    let options = Options {
        overrides: arguments.set.clone(),
        templates: arguments.templates.clone(),
        trust: arguments.trust,
    };
    let scene = Scene::from_path_with(&arguments.scene, &options).map_err(|report| errors(&report))?;
    say::report(&scene.warnings);
    let frames = scene.simulation.frames();
    let selection = selection(arguments, frames)?;
    let cameras = cameras(arguments, &scene)?;

    let progress = Progress::new(frames + cameras.len() * selection.count_within(frames));
    progress.phase("simulating");
    let run =
        Run::new_seeing(&scene, |_| progress.step()).map_err(|error| failed(&progress, &error.into()))?;
    progress.phase(if arguments.check { "comparing" } else { "writing" });
    let mut result = Ok(());
    for (view, folder) in &cameras {
        let seen = view.map(|view| run.seen_by(view)).transpose();
        let seen = seen.map_err(|error| failed(&progress, &error.into()))?;
        let run = seen.as_ref().unwrap_or(&run);
        if arguments.check {
            result = check(run, folder, &selection, &progress).and(result);
        } else {
            write(run, folder, &selection, &progress, start)?;
        }
    }
    result
}

/// The cameras that are asked for, each with the folder for its scripts; `None` is the main one.
fn cameras<'a>(arguments: &Arguments, scene: &'a Scene) -> Result<Vec<(Option<&'a View>, PathBuf)>, Failure> {
    let folder = arguments.output.clone().unwrap_or_else(|| Path::new("out").join(&scene.name));
    let beside = |view: &str| {
        let mut path = folder.clone().into_os_string();
        path.push(format!("-{view}"));
        PathBuf::from(path)
    };
    if arguments.view.is_empty() {
        return Ok(vec![(None, folder)]);
    }
    if arguments.view.iter().any(|name| name == "all") {
        let others = scene.views.iter().map(|view| (Some(view), beside(&view.name)));
        return Ok(std::iter::once((None, folder.clone())).chain(others).collect());
    }
    let find = |name: &String| match scene.views.iter().find(|view| view.name == *name) {
        // The folder that is given is that of the only view that is asked for.
        Some(view) if arguments.view.len() == 1 && arguments.output.is_some() => {
            Ok((Some(view), folder.clone()))
        }
        Some(view) => Ok((Some(view), beside(name))),
        None => {
            let names: Vec<&str> = scene.views.iter().map(|view| view.name.as_str()).collect();
            let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            Err(Failure::Usage(format!("there is no view `{name}`: the views of this scene are {known}")))
        }
    };
    arguments.view.iter().map(find).collect()
}

/// Writes the scripts of one camera, and says what they come to.
fn write(
    run: &Run<'_>,
    folder: &Path,
    selection: &Selection,
    progress: &Progress,
    start: Instant,
) -> Result<(), Failure> {
    let folder = Folder::open(folder).map_err(|error| failed(progress, &error))?;
    let written = output::write(run, &folder, selection, &|| progress.step());
    let written = written.map_err(|error| failed(progress, &error))?;
    progress.finish();
    say::report(&Report { diagnostics: run.warnings(), ..Report::default() });
    say::result(&summary::summary(run, folder.path(), &written, start.elapsed()));
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
    let scripts_a_frame = if run.shutter().is_some() { 2 } else { 1 };
    let compared = scripts_a_frame * selection.count_within(run.scene().simulation.frames());
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
    say::report(&error.report());
    Failure::Errors
}
