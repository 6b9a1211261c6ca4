//! The command `jabuka render`: writes the scripts of a scene, renders them, and makes a film of the images.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use crate::Scene;
use crate::cache::Cache;
use crate::diagnostic::{Report, visible_path};
use crate::output::{self, Folder, OutputError};
use crate::overwrite::ProtectedFiles;
use crate::render::{Event, Images, Job, Outcome, RenderError, Sequence};
use crate::scene::View;
use crate::simulate::Selection;
use crate::system::Dir;

use super::picture_arguments::PictureArguments;
use super::povray_arguments::PovRayArguments;
use super::products::Products;
use super::progress::Progress;
use super::run_arguments::{self, RunArguments};
use super::video_arguments::VideoArguments;
use super::{Failure, interrupt, summary, terminal};

/// Render a scene, or a folder of scripts, into images and a film
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file, or a folder that `jabuka compile` has written
    #[arg(value_name = "SCENE|DIR")]
    source: PathBuf,
    /// The folder for the images [default: the folder `images` within the folder of the scripts]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
    /// The number of POV-Ray processes at the same time [default: as many as keep all processors busy]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Render only every N-th frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    every: Option<u32>,
    /// Make a film from the images: FILE.mp4, FILE.webm or FILE.gif
    #[arg(long, value_name = "FILE")]
    pub(super) video: Option<PathBuf>,
    /// Make a contact sheet: one image that shows evenly spaced frames with their times
    #[arg(long, value_name = "FILE.png")]
    pub(super) contact_sheet: Option<PathBuf>,
    #[command(flatten)]
    pub(super) film: VideoArguments,
    /// Continue even if all of the first frames fail
    #[arg(long)]
    keep_going: bool,
    /// Also check the content of existing images, and render those again that have changed since they were rendered
    #[arg(long)]
    verify: bool,
    #[command(flatten)]
    scene: RunArguments,
    #[command(flatten)]
    povray: PovRayArguments,
}

impl Arguments {
    fn every(&self) -> usize {
        self.every.unwrap_or(1) as usize
    }

    /// Opens the folder for the images of the scripts in the folder `scripts`.
    fn open_images(&self, scripts: &Dir) -> Result<Images, RenderError> {
        match &self.output {
            Some(images) => Images::open(images),
            None => Images::among(scripts),
        }
    }

    /// Returns the folder for the images of the scripts in the folder `scripts`.
    fn images(&self, scripts: &Path) -> PathBuf {
        self.output.clone().unwrap_or_else(|| scripts.join("images"))
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let stop = interrupt::watched();
    // Missing programs are reported before the simulation begins.
    arguments.povray.look().map_err(|error| failed(&error))?;
    let products = Products::of(arguments)?;
    if arguments.source.is_dir() {
        return render_folder(arguments, &products, stop);
    }
    let scene = arguments.scene.read_with(&arguments.source, &arguments.picture.overrides())?;
    let frames = scene.simulation.timeline.frames();
    let selection = arguments.scene.selection(frames)?.every(arguments.every());
    let out = Path::new("out").join(&scene.name);
    let cameras = arguments.scene.cameras(&out, false, &scene)?;
    let shared =
        [&arguments.output, &arguments.video, &arguments.contact_sheet].into_iter().any(Option::is_some);
    if cameras.len() > 1 && shared {
        let message = "several views cannot share one folder of images, film or contact sheet: name one view";
        return Err(Failure::Usage(message.to_owned()));
    }
    for (_, folder) in &cameras {
        let protected = ProtectedFiles::of_scene(&scene).and_folder(folder);
        let protected = protected.and_then(|protected| protected.and_folder(&arguments.images(folder)));
        terminal::report_protected(protected.and_then(|protected| products.replace_nothing_of(&protected)))?;
    }
    products.check([scene.output.width, scene.output.height], scene.output.video_rate)?;
    let folders = write_scripts(&scene, &arguments.scene.cache()?, &selection, &cameras)?;
    // The folders stay locked until all images are finished, so that no other process changes the scripts during rendering.
    let mut result = Ok(());
    for (folder, drift) in &folders {
        match render_scripts(arguments, &products, folder.dir(), Some(&selection), drift, stop) {
            Err(Failure::Interrupted) => return Err(Failure::Interrupted),
            other => result = result.and(other),
        }
    }
    result
}

/// Writes the scripts for each camera into its folder, unless the folder already has them, and prints the warnings of the run. Returns
/// each folder, locked, with the line of the summary that gives the energy error.
fn write_scripts(
    scene: &Scene,
    cache: &Cache,
    selection: &Selection,
    cameras: &[(Option<&View>, PathBuf)],
) -> Result<Vec<(Folder, String)>, Failure> {
    let frames = scene.simulation.timeline.frames();
    let progress = Progress::of_run(scene, cameras.len() * selection.count_within(frames));
    let mut folders = Vec::new();
    let mut run = None;
    for (view, path) in cameras {
        let folder = Folder::open(path).map_err(|error| progress.failed(&error))?;
        let (warnings, drift);
        if let Some(manifest) = output::up_to_date(scene, *view, selection, &folder) {
            let head = &manifest.head;
            (warnings, drift) = (manifest.warnings(), head.drift.map(|drift| (drift, head.drift_scale)));
        } else {
            let first = match run.take() {
                Some(run) => run,
                None => run_arguments::run(scene, cache, &progress)?,
            };
            let first = run.insert(first);
            let seen = run_arguments::seen(first, *view, &progress)?;
            let run = seen.as_ref().unwrap_or(first);
            progress.phase("writing");
            let step = || progress.step();
            let written = output::write(run, &folder, selection, &step);
            progress.above(|| terminal::edits(&folder));
            written.map_err(|error| progress.failed(&error))?;
            let survey = run.survey();
            (warnings, drift) = (run.warnings(), Some((survey.drift, survey.drift_scale)));
        }
        if folders.is_empty() {
            let sources = scene.warnings.sources.clone();
            terminal::report(&Report { sources, diagnostics: warnings });
        }
        folders.push((
            folder,
            drift.map(|(drift, scale)| summary::drift(drift, scale, scene)).unwrap_or_default(),
        ));
    }
    progress.finish();
    Ok(folders)
}

/// Renders the scripts that already exist in a folder.
fn render_folder(arguments: &Arguments, products: &Products, stop: &AtomicBool) -> Result<(), Failure> {
    if arguments.scene.change_the_scene() {
        let message = "`--set`, `--templates` and `--view` are for scenes; the scripts of a folder are rendered as they are";
        return Err(Failure::Usage(message.to_owned()));
    }
    let images = arguments.images(&arguments.source);
    let protected = ProtectedFiles::default()
        .and_folder(&arguments.source)
        .and_then(|protected| protected.and_folder(&images));
    terminal::report_protected(protected.and_then(|protected| products.replace_nothing_of(&protected)))?;
    let _lock = match Folder::open(&arguments.source) {
        Ok(lock) => Some(lock),
        Err(error @ OutputError::Locked(_)) => {
            terminal::report(&error.report());
            return Err(Failure::Errors);
        }
        // A folder that this user may not write to, such as another user's, cannot be locked. Its scripts are rendered without a lock.
        Err(_) => None,
    };
    let selection = match (&arguments.scene.frames, arguments.every) {
        (None, None) => None,
        (Some(frames), _) => Some(frames.clone()),
        (None, Some(_)) => Some(Selection::first(usize::MAX)),
    };
    let selection = selection.map(|selection| selection.every(arguments.every()));
    let dir = match arguments.output {
        Some(_) => Dir::of_path(&arguments.source),
        None => Dir::open(&arguments.source),
    };
    let dir = dir.or_else(|error| {
        // That there are no scripts says more than that the folder is a link.
        Sequence::open(&arguments.source, selection.as_ref()).map_err(|error| failed(&error))?;
        Err(failed(&error.into()))
    })?;
    render_scripts(arguments, products, &dir, selection.as_ref(), "", stop)
}

/// Renders the selected scripts of a folder, then makes the film and contact sheet. `known` is text about the run that is added to the
/// summary.
fn render_scripts(
    arguments: &Arguments,
    products: &Products,
    folder: &Dir,
    selection: Option<&Selection>,
    known: &str,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let start = Instant::now();
    let sequence = Sequence::open(folder.path(), selection).map_err(|error| failed(&error))?;
    products.check(arguments.picture.size_or(sequence.size), sequence.video_rate)?;
    let images = arguments.open_images(folder).map_err(|error| failed(&error))?;
    let scene = (!arguments.source.is_dir()).then_some(arguments.source.as_path());
    let confinement = arguments.scene.confinement(scene, &[folder.path(), images.folder()]);
    let povray = arguments.povray.find(&images, confinement).map_err(|error| failed(&error))?;
    let job = Job {
        jobs: arguments.jobs.map(usize::from),
        keep_going: arguments.keep_going,
        verify: arguments.verify,
        ..arguments.povray.job(&sequence, &images, &povray, &arguments.picture)
    };
    let outcome = render(&job, stop)?;
    if outcome.stopped {
        let there = outcome.rendered + outcome.copied + outcome.up_to_date;
        let frames = sequence.scripts().len();
        let goes_on = "the same command goes on with the others";
        terminal::error(&format!("stopped: {there} of {frames} frames are there; {goes_on}\n"));
        return Err(Failure::Interrupted);
    }
    terminal::result(&summed_up(&images, &sequence, known, &outcome, start.elapsed()));
    if !outcome.failed.is_empty() {
        if products.are_wanted() {
            terminal::error("no film and no contact sheet were made, since frames are missing\n");
        }
        return Err(Failure::Errors);
    }
    products.make(&sequence, &images, arguments.every(), stop)
}

/// Runs a rendering job, and shows its progress and failures.
pub(super) fn render(job: &Job<'_>, stop: &AtomicBool) -> Result<Outcome, Failure> {
    /// The maximum number of failed frames whose errors are shown in full.
    const MAX_SHOWN_FAILURES: usize = 3;
    let mut progress = None;
    let mut failures = 0;
    let mut slowest = 0.0;
    let result = job.run(
        &mut |event| match event {
            Event::Planned { to_make, .. } => progress = Some(Progress::of_frames(to_make)),
            Event::Made { frame, seconds } => {
                let seconds = seconds.filter(|seconds| *seconds > slowest);
                if let (Some(seconds), Some(progress)) = (seconds, &progress) {
                    slowest = seconds;
                    progress.phase(format!("slowest: {frame}, {seconds:.1} s"));
                }
                progress.iter().for_each(Progress::step);
            }
            Event::Failed(fault) => {
                failures += 1;
                if failures <= MAX_SHOWN_FAILURES {
                    progress.iter().for_each(|progress| progress.above(|| terminal::report(&fault.report())));
                }
                progress.iter().for_each(Progress::step);
            }
        },
        stop,
    );
    progress.iter().for_each(Progress::finish);
    let outcome = result.map_err(|error| failed(&error))?;
    for warning in &outcome.warnings {
        terminal::error(&format!("POV-Ray: {warning}\n"));
    }
    if outcome.failed.len() > MAX_SHOWN_FAILURES {
        let others: Vec<String> =
            outcome.failed[MAX_SHOWN_FAILURES..].iter().map(|fault| fault.frame.to_string()).collect();
        terminal::error(&format!("and of the frames {}\n", others.join(", ")));
    }
    Ok(outcome)
}

/// Prints the error that stopped the rendering.
pub(super) fn failed(error: &RenderError) -> Failure {
    terminal::report(&error.report());
    Failure::Errors
}

/// Summarizes the rendered images in a few lines. `known` is text about the run that is included.
fn summed_up(images: &Images, sequence: &Sequence, known: &str, outcome: &Outcome, took: Duration) -> String {
    let frames = sequence.scripts().len();
    let there = frames - outcome.failed.len();
    let mut text = format!("{}: {there} of {frames} frames\n{known}", visible_path(images.folder()));
    let mut line = |name: &str, what: String| text.push_str(&format!("{name:9} {what}\n"));
    if outcome.up_to_date > 0 {
        line("as before", format!("{}, up to date", outcome.up_to_date));
    }
    let list = |frames: &[usize]| frames.iter().copied().collect::<Selection>();
    if !outcome.changed.is_empty() {
        line("changed", format!("{} since they were rendered, and rendered again", list(&outcome.changed)));
    }
    if !outcome.unverified.is_empty() {
        let why = "whose records have no digest, rendered again";
        line("unverified", format!("{}, {why}", list(&outcome.unverified)));
    }
    if outcome.copied > 0 {
        line("copied", format!("{}, equal to others", outcome.copied));
    }
    if outcome.removed > 0 {
        line("removed", format!("{} of frames that are no more", outcome.removed));
    }
    if !outcome.failed.is_empty() {
        line("failed", format!("{}", outcome.failed.len()));
    }
    if let Some((frame, seconds)) = outcome.slowest {
        line("slowest", format!("frame {frame} in {seconds:.2} s"));
    }
    line("rendered", format!("{} in {:.2} s", outcome.rendered, took.as_secs_f64()));
    text
}
