//! The command `jabuka still`: renders the image of one moment of a scene.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::diagnostic::visible_path;
use crate::output::{self, Folder};
use crate::overwrite::ProtectedFiles;
use crate::render::{Images, Job, Sequence};
use crate::scene::View;
use crate::simulate::{Moments, SimulateError};
use crate::{Run, Scene};

use super::picture_arguments::PictureArguments;
use super::povray_arguments::PovRayArguments;
use super::progress::Progress;
use super::render::{failed, render};
use super::run_arguments;
use super::scene_arguments::SceneArguments;
use super::{Failure, interrupt, terminal};

/// Render the image of one moment of a scene
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The time of the image, in seconds; it need not be the time of a frame
    #[arg(short, long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    time: f64,
    /// The PNG file to write [default: SCENE.png, with --view SCENE-NAME.png]
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    of_scene: SceneArguments,
    /// Use this view instead of the main camera
    #[arg(long, value_name = "NAME")]
    view: Option<String>,
    #[command(flatten)]
    povray: PovRayArguments,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let stop = interrupt::watched();
    let start = Instant::now();
    let is_png =
        |path: &Path| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if let Some(path) = arguments.output.as_deref().filter(|path| !is_png(path)) {
        let message = format!("an image is a PNG, and `{}` does not end in `.png`", visible_path(path));
        return Err(Failure::Usage(message));
    }
    arguments.povray.look().map_err(|error| failed(&error))?;
    let scene = arguments.of_scene.read_with(&arguments.scene, &arguments.picture.overrides())?;
    let view = arguments.view.as_deref().map(|name| run_arguments::view(&scene, name)).transpose()?;
    check_time(&scene, arguments.time)?;

    let name = name_with_view(&scene, view);
    let output = arguments.output.clone().unwrap_or_else(|| format!("{name}.png").into());
    // Other commands do not write to this folder.
    let folder = Path::new("out/.still").join(name);
    let protected = ProtectedFiles::of_scene(&scene).and_folder(&folder);
    let protected = protected.and_then(|protected| protected.and_folder(&folder.join("images")));
    terminal::report_protected(protected.and_then(|protected| protected.check(&output)))?;
    let (folder, breakdown) = write_script(arguments, &scene, view, &folder)?;
    let mut sequence = Sequence::open(folder.path(), None).map_err(|error| failed(&error))?;
    sequence.moment = Some(arguments.time);
    let images = Images::among(folder.dir()).map_err(|error| failed(&error))?;
    let confinement = arguments.of_scene.confinement(Some(&arguments.scene), &[folder.path()]);
    let povray = arguments.povray.find(&images, confinement).map_err(|error| failed(&error))?;
    let job = Job {
        // There is only one image, so POV-Ray may use all processors for it.
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        ..arguments.povray.job(&sequence, &images, &povray, &arguments.picture)
    };
    let progress = Progress::waiting("rendering");
    let outcome = render(&job, stop);
    progress.finish();
    let outcome = outcome?;
    if outcome.stopped {
        terminal::error("stopped: there is no image\n");
        return Err(Failure::Interrupted);
    }
    if !outcome.failed.is_empty() {
        return Err(Failure::Errors);
    }
    for script in sequence.scripts() {
        images.copy_out(&script.name, &output).map_err(|error| failed(&error))?;
    }
    let (shown, took) = (visible_path(&output), start.elapsed().as_secs_f64());
    terminal::result(&format!("{shown}: t = {} s, in {took:.2} s\n", arguments.time));
    let kept = format!("the image at t = {} s is made", arguments.time);
    breakdown.map_or(Ok(()), |breakdown| Err(run_arguments::report_breakdown(&breakdown, &kept)))
}

/// Returns the name of the scene, followed by that of the view.
fn name_with_view(scene: &Scene, view: Option<&View>) -> String {
    let view_name = view.map(|view| format!("-{}", view.name)).unwrap_or_default();
    format!("{}{view_name}", scene.name)
}

/// Simulates the scene and writes the script of the requested moment into `folder`. The returned folder stays locked, so that no other
/// process changes the script before it is rendered. If the simulation breaks down after the requested moment, the error that ended it is
/// returned, too.
fn write_script(
    arguments: &Arguments,
    scene: &Scene,
    view: Option<&View>,
    folder: &Path,
) -> Result<(Folder, Option<SimulateError>), Failure> {
    let progress = Progress::of_run(scene, 0);
    let cache = arguments.of_scene.cache()?;
    let moments = Moments::of(scene).with(arguments.time);
    let recorded = run_arguments::simulated_to_breakdown(scene, &cache, moments, &progress);
    let run =
        recorded.and_then(|recorded| Ok(Run::of(recorded)?)).map_err(|error| progress.failed(&error))?;
    let seen = run_arguments::seen(&run, view, &progress)?;
    let run: &Run<'_> = seen.as_ref().unwrap_or(&run);
    let folder = Folder::open(folder).map_err(|error| progress.failed(&error))?;
    progress.phase("writing");
    let written = output::write_moment(run, &folder, arguments.time);
    progress.above(|| terminal::edits(&folder));
    written.map_err(|error| progress.failed(&error))?;
    progress.finish();
    terminal::report(&run.report());
    Ok((folder, run.recorded().breakdown().cloned()))
}

/// Returns an error of usage if `time` (s) is outside of the simulated time.
fn check_time(scene: &Scene, time: f64) -> Result<(), Failure> {
    let simulation = &scene.simulation;
    let end = simulation.timeline.latest();
    if (0.0..=end).contains(&time) {
        return Ok(());
    }
    Err(Failure::Usage(format!("there is no moment {time} s: the run of this scene goes from 0 to {end} s")))
}
