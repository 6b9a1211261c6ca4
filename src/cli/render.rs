//! `jabuka render`: scene → scripts → images → film.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use jabuka::diagnostic::Report;
use jabuka::output::{self, Folder, OutputError};
use jabuka::render::{self, Event, Images, Job, Outcome, PovRay, Quality, RenderError, Sequence};
use jabuka::scene::Override;
use jabuka::simulate::Selection;

use super::products::Products;
use super::progress::Progress;
use super::scene_arguments::{self, SceneArguments};
use super::{Failure, interrupt, say};

/// Render a scene, or a folder of scripts, into images and a film
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file, or a folder that `jabuka compile` has written
    #[arg(value_name = "SCENE|DIR")]
    source: PathBuf,
    /// The folder for the images [default: the folder `images` beside the scripts]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// The size of the images in pixels, as in 1280x720 [default: that of the scene]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: Option<[u32; 2]>,
    /// How good the images are
    #[arg(long, value_enum, default_value_t)]
    quality: QualityName,
    /// The number of POV-Rays at once [default: as many as keep the processors busy]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Render only every N-th frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    every: Option<u32>,
    /// Make a film of the images: FILE.mp4, FILE.webm or FILE.gif
    #[arg(long, value_name = "FILE")]
    pub(super) video: Option<PathBuf>,
    /// Make one picture of evenly spaced frames with their times
    #[arg(long, value_name = "FILE.png")]
    pub(super) contact_sheet: Option<PathBuf>,
    /// The program POV-Ray [default: povray]
    #[arg(long, value_name = "PATH")]
    povray: Option<PathBuf>,
    /// How often a frame is tried again after POV-Ray was killed or hung
    #[arg(long, value_name = "N", default_value_t = 2)]
    retry: u32,
    /// How long a frame may take, in seconds [default: far longer than others have taken]
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..))]
    time_limit: Option<u64>,
    /// Go on even where the first frames all fail
    #[arg(long)]
    keep_going: bool,
    #[command(flatten)]
    scene: SceneArguments,
    /// Further options for POV-Ray, as in -- +Q4 +AM2
    #[arg(last = true, value_name = "POVRAY OPTIONS")]
    options: Vec<String>,
}

impl Arguments {
    fn every(&self) -> usize {
        self.every.unwrap_or(1) as usize
    }
}

#[derive(Clone, Copy, Default, ValueEnum)]
pub(super) enum QualityName {
    /// For a look at the motion: no anti-aliasing
    Draft,
    /// As `povray animation.ini` renders it
    #[default]
    Good,
    /// For the film that is kept: finer anti-aliasing
    Final,
}

impl From<QualityName> for Quality {
    fn from(name: QualityName) -> Quality {
        match name {
            QualityName::Draft => Quality::Draft,
            QualityName::Good => Quality::Good,
            QualityName::Final => Quality::Final,
        }
    }
}

pub(super) fn parse_size(argument: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.parse::<u32>().ok().filter(|n| (1..=65535).contains(n));
    let size = argument.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([number(w)?, number(h)?]));
    size.ok_or_else(|| "write it as WIDTHxHEIGHT, as in 1280x720".to_owned())
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let stop = interrupt::watched();
    // What is not there is said before anything is done.
    PovRay::locate(arguments.povray.as_deref()).map_err(|error| failed(&error))?;
    let products = Products::of(arguments)?;
    if arguments.source.is_dir() {
        return render_folder(arguments, &products, stop);
    }
    let size =
        arguments.size.map(|[width, height]| Override::new(format!("output.size=[{width}, {height}]")));
    let scene = arguments.scene.read_with(&arguments.source, size.as_slice())?;
    let frames = scene.simulation.frames();
    let selection = arguments.scene.selection(frames)?.every(arguments.every());
    let out = Path::new("out").join(&scene.name);
    let cameras = arguments.scene.cameras(&out, false, &scene)?;
    let shared =
        [&arguments.output, &arguments.video, &arguments.contact_sheet].into_iter().any(Option::is_some);
    if cameras.len() > 1 && shared {
        let message = "several views cannot share one folder of images, film or contact sheet: name one view";
        return Err(Failure::Usage(message.to_owned()));
    }
    let progress = Progress::new(frames + cameras.len() * selection.count_within(frames));
    let run = scene_arguments::survey(&scene, &progress)?;
    let mut folders = Vec::new();
    for (view, folder) in &cameras {
        let seen = scene_arguments::seen(&run, *view, &progress)?;
        let run = seen.as_ref().unwrap_or(&run);
        progress.phase("writing");
        let folder = Folder::open(folder).map_err(|error| progress.failed(&error))?;
        output::write(run, &folder, &selection, &|| progress.step())
            .map_err(|error| progress.failed(&error))?;
        folders.push(folder);
    }
    progress.finish();
    say::report(&Report { diagnostics: run.warnings(), ..Report::default() });
    // The folders stay locked until the images are there, so that nobody changes scripts while they are rendered.
    let mut result = Ok(());
    for folder in &folders {
        match render_scripts(arguments, &products, folder.path(), Some(&selection), stop) {
            Err(Failure::Interrupted) => return Err(Failure::Interrupted),
            other => result = result.and(other),
        }
    }
    result
}

/// Renders the scripts in a folder, as they are.
fn render_folder(arguments: &Arguments, products: &Products, stop: &AtomicBool) -> Result<(), Failure> {
    if !arguments.scene.suit_scripts() {
        let message = "`--set`, `--templates`, `--trust` and `--view` are for scenes; the scripts of a folder are \
                       rendered as they are";
        return Err(Failure::Usage(message.to_owned()));
    }
    let _lock = match Folder::open(&arguments.source) {
        Ok(lock) => Some(lock),
        Err(error @ OutputError::Locked(_)) => {
            say::report(&error.report());
            return Err(Failure::Errors);
        }
        // Scripts that are somebody else's, or that nobody can change, need no lock.
        Err(_) => None,
    };
    let selection = match (&arguments.scene.frames, arguments.every) {
        (None, None) => None,
        (Some(frames), _) => Some(frames.clone()),
        (None, Some(_)) => Some(Selection::first(usize::MAX)),
    };
    let selection = selection.map(|selection| selection.every(arguments.every()));
    render_scripts(arguments, products, &arguments.source, selection.as_ref(), stop)
}

/// Renders the selected scripts of a folder.
fn render_scripts(
    arguments: &Arguments,
    products: &Products,
    folder: &Path,
    selection: Option<&Selection>,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let start = Instant::now();
    let sequence = Sequence::open(folder, selection).map_err(|error| failed(&error))?;
    let images = arguments.output.clone().unwrap_or_else(|| folder.join("images"));
    let images = Images::open(&images).map_err(|error| failed(&error))?;
    let povray = PovRay::find(arguments.povray.as_deref(), &images.povray_memory());
    let povray = povray.map_err(|error| failed(&error))?;
    let size = arguments.size.unwrap_or(sequence.size);
    let mut options = render::options(size, sequence.transparent, arguments.quality.into());
    options.extend(arguments.options.iter().cloned());
    let job = Job {
        sequence: &sequence,
        images: &images,
        povray: &povray,
        options,
        jobs: arguments.jobs.map(usize::from),
        retries: arguments.retry,
        keep_going: arguments.keep_going,
        time_limit: arguments.time_limit.map(Duration::from_secs),
    };
    let outcome = render(&job, stop)?;
    if outcome.stopped {
        let there = outcome.rendered + outcome.copied + outcome.up_to_date;
        let frames = sequence.scripts().len();
        let goes_on = "the same command goes on with the others";
        say::error(&format!("stopped: {there} of {frames} frames are there; {goes_on}\n"));
        return Err(Failure::Interrupted);
    }
    say::result(&summary(&images, &sequence, &outcome, start.elapsed()));
    if !outcome.failed.is_empty() {
        if products.are_wanted() {
            say::error("no film and no contact sheet were made, since frames are missing\n");
        }
        return Err(Failure::Errors);
    }
    products.make(&sequence, &images, arguments.every(), stop)
}

/// Renders, and says how it goes.
fn render(job: &Job<'_>, stop: &AtomicBool) -> Result<Outcome, Failure> {
    /// So many failures are shown in full.
    const SHOWN: usize = 3;
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
                if failures <= SHOWN {
                    progress.iter().for_each(|progress| progress.above(|| say::report(&fault.report())));
                }
                progress.iter().for_each(Progress::step);
            }
        },
        stop,
    );
    progress.iter().for_each(Progress::finish);
    let outcome = result.map_err(|error| failed(&error))?;
    for warning in &outcome.warnings {
        say::error(&format!("POV-Ray: {warning}\n"));
    }
    if outcome.failed.len() > SHOWN {
        let others: Vec<String> =
            outcome.failed[SHOWN..].iter().map(|fault| fault.frame.to_string()).collect();
        say::error(&format!("and of the frames {}\n", others.join(", ")));
    }
    Ok(outcome)
}

/// Says why nothing more is rendered.
fn failed(error: &RenderError) -> Failure {
    say::report(&error.report());
    Failure::Errors
}

/// What was made, in a few lines.
fn summary(images: &Images, sequence: &Sequence, outcome: &Outcome, took: Duration) -> String {
    let frames = sequence.scripts().len();
    let there = frames - outcome.failed.len();
    let mut text = format!("{}: {there} of {frames} frames\n", images.folder().display());
    let mut line = |name: &str, what: String| text.push_str(&format!("{name:10}{what}\n"));
    if outcome.up_to_date > 0 {
        line("as before", format!("{}, up to date", outcome.up_to_date));
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
