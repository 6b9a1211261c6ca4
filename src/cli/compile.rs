//! The command `jabuka compile`: writes the POV-Ray scripts of a scene.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::Run;
use crate::diagnostic::visible_path;
use crate::output::{self, Folder};
use crate::overwrite::ProtectedFiles;
use crate::simulate::Selection;

use super::progress::Progress;
use super::run_arguments::{self, RunArguments, seen};
use super::{Failure, summary, terminal};

/// Compile a scene into POV-Ray scripts, one per frame
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The folder for the scripts [default: out/<name of the scene file>]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    of_scene: RunArguments,
    /// Write nothing: compare the scripts with those in the folder, and fail if they differ
    #[arg(long)]
    check: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let scene = arguments.of_scene.read(&arguments.scene)?;
    let frames = scene.simulation.timeline.frames();
    let selection = arguments.of_scene.selection(frames)?;
    let folder = arguments.output.clone().unwrap_or_else(|| Path::new("out").join(&scene.name));
    let cameras = arguments.of_scene.cameras(&folder, arguments.output.is_some(), &scene)?;

    if !arguments.check {
        for (_, folder) in &cameras {
            terminal::report_protected(ProtectedFiles::of_scene(&scene).and_folder(folder))?;
        }
    }
    let cache = arguments.of_scene.cache()?;
    let progress = Progress::of_run(&scene, cameras.len() * selection.count_within(frames));
    let run = run_arguments::run_to_breakdown(&scene, &cache, &progress)?;
    let whole = run_arguments::whole(run.recorded(), &selection);
    if whole.last().is_none() {
        progress.finish();
        return run_arguments::broken_down(run.recorded(), &whole);
    }
    progress.phase(if arguments.check { "comparing" } else { "writing" });
    let mut result = Ok(());
    for (view, folder) in &cameras {
        let seen = seen(&run, *view, &progress)?;
        let run = seen.as_ref().unwrap_or(&run);
        if arguments.check {
            result = check(run, folder, &whole, &progress).and(result);
        } else {
            write(run, &arguments.scene, folder, &whole, &progress, start)?;
        }
    }
    run_arguments::broken_down(run.recorded(), &whole).and(result)
}

/// Writes the scripts for one camera into a folder, and prints a summary.
fn write(
    run: &Run<'_>,
    path: &Path,
    folder: &Path,
    selection: &Selection,
    progress: &Progress,
    start: Instant,
) -> Result<(), Failure> {
    let folder = Folder::open(folder).map_err(|error| progress.failed(&error))?;
    let written = output::write(run, &folder, selection, &|| progress.step());
    let written =
        written.map_err(|error| progress.failed(&error)).inspect_err(|_| terminal::edits(&folder))?;
    progress.finish();
    terminal::edits(&folder);
    terminal::report(&run.report());
    terminal::result(&summary::summary(run, path, folder.path(), &written, start.elapsed()));
    Ok(())
}

fn check(run: &Run<'_>, folder: &Path, selection: &Selection, progress: &Progress) -> Result<(), Failure> {
    /// The maximum number of differing scripts that are shown in full.
    const MAX_SHOWN_DIFFERENCES: usize = 3;
    let differences = output::compare(run, folder, selection, &|| progress.step());
    let differences = differences.map_err(|error| progress.failed(&error))?;
    progress.finish();
    let scripts_a_frame = if run.shutter().is_some() { 2 } else { 1 };
    let compared = scripts_a_frame * selection.count_within(run.scene().simulation.timeline.frames());
    if differences.is_empty() {
        terminal::result(&format!(
            "{}: {compared} scripts are as the scene gives them\n",
            visible_path(folder)
        ));
        return Ok(());
    }
    for difference in differences.iter().take(MAX_SHOWN_DIFFERENCES) {
        terminal::result(&difference.to_text());
    }
    if differences.len() > MAX_SHOWN_DIFFERENCES {
        terminal::result(&format!("… and {} more scripts\n", differences.len() - MAX_SHOWN_DIFFERENCES));
    }
    terminal::result(&format!(
        "{}: {} of {compared} scripts differ\n",
        visible_path(folder),
        differences.len()
    ));
    Err(Failure::Errors)
}
