//! Images, films and pages of runs. POV-Ray and ffmpeg run in the sandbox.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use jabuka::diagnostic::{Code, Report};
use jabuka::export::Format as _;
use jabuka::output::{self, Folder};
use jabuka::page::OneFile;
use jabuka::render::{self, Event, Images, Job, PovRay, Quality, Sequence};
use jabuka::sandbox::{Confinement, Launcher};
use jabuka::simulate::{Recorded, Selection};
use jabuka::{Run, Scene, cache};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::background::{self, Control};
use crate::errors::{self, Class};
use crate::measures::changed;
use crate::run::Outcome;
use crate::scene::Reading;

/// How images are rendered.
pub(crate) struct Look {
    /// Width and height, pixels. `None` for those of the scene.
    size: Option<[u32; 2]>,
    quality: Quality,
    /// The name of the view. `None` for the main camera.
    view: Option<String>,
    /// The path of POV-Ray. `None` for `povray` on the `PATH`.
    povray: Option<PathBuf>,
}

impl Look {
    /// Checks the name of a quality.
    pub(crate) fn new(
        (size, quality): (Option<[u32; 2]>, &str),
        view: Option<String>,
        povray: Option<PathBuf>,
    ) -> PyResult<Look> {
        let quality = match quality {
            "draft" => Quality::Draft,
            "good" => Quality::Good,
            "final" => Quality::Final,
            other => {
                let message = format!("there is no quality `{other}`: take \"draft\", \"good\" or \"final\"");
                return Err(PyValueError::new_err(message));
            }
        };
        Ok(Look { size, quality, view, povray })
    }
}

/// A film to make.
pub(crate) struct Film {
    pub(crate) path: PathBuf,
    /// The number of frames per second. `None` for that of the scene.
    pub(crate) rate: Option<f64>,
    /// Every n-th frame of the run is rendered.
    pub(crate) every: usize,
    /// The folder of scripts and images, which later films can use again. `None` for a temporary folder.
    pub(crate) folder: Option<PathBuf>,
}

/// A simulated scene, and how it was read.
type Simulated<'a> = (&'a Reading, &'a Arc<Scene>, &'a Outcome);

/// Why there is no image. `None` if the work was stopped.
type Failure = Option<Report>;

/// Renders the image of one moment (s). Returns it as PNG, and the texts of warnings.
pub(crate) fn still(
    py: Python<'_>,
    simulated: Simulated<'_>,
    time: f64,
    look: &Look,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Vec<u8>, Vec<String>)> {
    in_background(py, progress, |control| {
        with_run(simulated, look, |run| {
            let place = Place::new(None)?;
            let folder = Folder::open(place.path()).map_err(|error| error.report())?;
            output::write_moment(run, &folder, time).map_err(|error| error.report())?;
            let mut sequence = Sequence::open(folder.path(), None).map_err(|error| error.report())?;
            sequence.moment = Some(time);
            // There is only one image, so POV-Ray may use all processors for it.
            let threads = std::thread::available_parallelism().map_or(1, usize::from);
            let mut said = warnings(run, &folder);
            let images = rendered(simulated, &folder, (&sequence, look), (threads, &mut said), control)?;
            let script = sequence.scripts().first().ok_or(None)?;
            Ok((images.read(&script.name).map_err(|error| error.report())?, said))
        })
    })
}

/// Renders the frames of a run into a film. Returns the texts of warnings.
pub(crate) fn film(
    py: Python<'_>,
    simulated: Simulated<'_>,
    Film { path, rate, every, folder }: &Film,
    look: &Look,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<String>> {
    if *every == 0 {
        return Err(PyValueError::new_err("`every` must be at least 1"));
    }
    in_background(py, progress, |control| {
        // A missing ffmpeg is reported before the long work.
        let film = render::Film::new(path).map_err(|error| error.report())?;
        rate.map_or(Ok(()), render::Film::check_rate).map_err(|error| error.report())?;
        let ffmpeg = film.check(None, Confinement::new(Launcher::of_this_program()));
        let ffmpeg = ffmpeg.map_err(|error| error.report())?;
        film.check_place().map_err(|error| error.report())?;
        with_run(simulated, look, |run| {
            let place = Place::new(folder.as_deref())?;
            let folder = Folder::open(place.path()).map_err(|error| error.report())?;
            let selection = Selection::first(run.recorded().recording().frames()).every(*every);
            output::write(run, &folder, &selection, &|| {}).map_err(|error| error.report())?;
            let sequence = Sequence::open(folder.path(), Some(&selection)).map_err(|error| error.report())?;
            film.check_size(look.size.unwrap_or(sequence.size)).map_err(|error| error.report())?;
            let mut said = warnings(run, &folder);
            let images = rendered(simulated, &folder, (&sequence, look), (1, &mut said), control)?;
            let frames: Vec<PathBuf> =
                sequence.scripts().iter().map(|script| images.image(&script.name)).collect();
            #[allow(clippy::cast_precision_loss, reason = "numbers of frames are small")]
            let every = *every as f64;
            let rate = rate.or(sequence.video_rate.map(|rate| rate / every));
            let pace = film.pace(sequence.timeline.frame_rate / every, rate);
            control.begin(frames.len());
            let done = |done| control.set_done(done);
            let made = film.make(&frames, pace.rate, &ffmpeg, &|| control.is_stopped(), &done);
            made.map_err(|error| error.report())?;
            Ok(said)
        })
    })
}

/// Returns a run as a page in HTML.
pub(crate) fn page(py: Python<'_>, scene: &Scene, outcome: &Outcome) -> PyResult<String> {
    in_background(py, None, |_| {
        if let Some(lack) = OneFile.lack(scene) {
            return Err(Some(Report::of_error(Code::CannotExport, lack)));
        }
        let frames = Selection::first(outcome.recording.frames());
        let mut page = Vec::new();
        let written = OneFile.write(&outcome.recorded(scene), &frames, &mut page);
        written.map_err(|error| Some(Report::of_error(Code::CannotExport, error.to_string())))?;
        Ok(String::from_utf8_lossy(&page).into_owned())
    })
}

/// Returns the texts of the warnings about pictures of a run, and about files of the folder that the user has edited. Those about its motion
/// belong to the run.
fn warnings(run: &Run<'_>, folder: &Folder) -> Vec<String> {
    let of_motion = jabuka::motion_warnings::all(run.scene(), run.survey()).len();
    let of_pictures = run.warnings().into_iter().skip(of_motion);
    let diagnostics: Vec<_> = of_pictures.chain(folder.edits()).collect();
    if diagnostics.is_empty() {
        return Vec::new();
    }
    vec![Report { sources: run.scene().warnings.sources.clone(), diagnostics }.to_text(false)]
}

/// Does work that can be stopped, and converts its failure to an exception.
fn in_background<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Control) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let result = background::run(py, progress, None, work)?.whole()?;
    result.map_err(|failure| match failure {
        Some(report) => errors::exception(py, Class::Render, &report),
        None => PyValueError::new_err("the work was stopped"),
    })
}

/// Calls `work` with the run as the camera of a look sees it.
fn with_run<T>(
    (reading, scene, outcome): Simulated<'_>,
    look: &Look,
    work: impl FnOnce(&Run<'_>) -> Result<T, Failure>,
) -> Result<T, Failure> {
    // The camera depends on the ratio of width and height.
    let sized = match look.size {
        Some([width, height]) => {
            let sized = reading.with_value(format!("output.size=[{width}, {height}]")).scene()?;
            if !cache::have_same_recording(&sized, scene) {
                return Err(Some(changed()));
            }
            Some(sized)
        }
        None => None,
    };
    let scene = sized.as_ref().unwrap_or(scene);
    let recorded: Recorded<'_> = outcome.recorded(scene);
    let run = Run::of(recorded).map_err(|error| error.report())?;
    let Some(name) = &look.view else { return work(&run) };
    let view = scene.views.iter().find(|view| view.name == *name).ok_or_else(|| {
        let names: Vec<&str> = scene.views.iter().map(|view| view.name.as_str()).collect();
        let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        let message = format!("there is no view `{name}`: the views of this scene are {known}");
        Report::of_error(jabuka::diagnostic::Code::UnknownName, message)
    })?;
    work(&run.seen_by(view).map_err(|error| error.report())?)
}

/// Renders the scripts of a folder with this number of threads for each image. Returns the folder of the images, and adds the texts of warnings
/// to `said`.
fn rendered(
    (reading, ..): Simulated<'_>,
    folder: &Folder,
    (sequence, look): (&Sequence, &Look),
    (threads, said): (usize, &mut Vec<String>),
    control: &Control,
) -> Result<Images, Failure> {
    let images = Images::among(folder.dir()).map_err(|error| error.report())?;
    let confinement = Confinement::new(Launcher::of_this_program());
    let confinement = match reading.trust() {
        true => confinement.trusting(reading.path().map(PathBuf::as_path), &[folder.path()]),
        false => confinement,
    };
    let povray =
        PovRay::find(look.povray.as_deref(), &images, confinement).map_err(|error| error.report())?;
    said.extend(povray.warning());
    let size = look.size.unwrap_or(sequence.size);
    let job = Job {
        sequence,
        images: &images,
        povray: &povray,
        options: render::options(size, sequence.transparent, look.quality),
        jobs: None,
        threads,
        retries: 2,
        keep_going: false,
        time_limit: None,
        verify: false,
    };
    let mut watch = |event: Event<'_>| match event {
        Event::Planned { to_make, .. } => control.begin(to_make),
        Event::Made { .. } | Event::Failed(_) => control.step(),
    };
    let outcome = job.run(&mut watch, control.stop()).map_err(|error| error.report())?;
    said.extend(outcome.warnings.iter().map(|warning| format!("POV-Ray: {warning}")));
    if outcome.stopped {
        return Err(None);
    }
    if let Some(fault) = outcome.failed.first() {
        return Err(Some(fault.report()));
    }
    Ok(images)
}

/// The folder of scripts and images.
enum Place<'a> {
    Given(&'a Path),
    Temporary(tempfile::TempDir),
}

impl Place<'_> {
    /// Returns the given folder, or makes a temporary one, which is removed at the end.
    fn new(given: Option<&Path>) -> Result<Place<'_>, Failure> {
        if let Some(given) = given {
            return Ok(Place::Given(given));
        }
        let made = tempfile::Builder::new().prefix("jabuka-").tempdir();
        made.map(Place::Temporary).map_err(|error| {
            let folder = std::env::temp_dir();
            Some(output::OutputError::Io(folder, error).report())
        })
    }

    fn path(&self) -> &Path {
        match self {
            Place::Given(path) => path,
            Place::Temporary(folder) => folder.path(),
        }
    }
}
