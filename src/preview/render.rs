//! Renders a frame with POV-Ray, as `jabuka still` does.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use serde::Deserialize;

use crate::Run;
use crate::diagnostic::{Code, Report};
use crate::output::{self, Folder};
use crate::page::{Failed, PageRun, RunId};
use crate::render::{Images, Job, PovRay, Quality, Sequence, options};
use crate::sandbox::Confinement;
use crate::scene::{Camera, View};

/// Renders frames with POV-Ray, one at a time.
pub(super) struct Renderer {
    povray: Option<PathBuf>,
    confinement: Confinement,
    one_at_a_time: Mutex<()>,
    /// The stop flags of all requests for images. The flag of a finished request no longer exists.
    wishes: Mutex<Vec<Weak<AtomicBool>>>,
}

/// The parameters of a request for an image by POV-Ray.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Wanted {
    run: String,
    frame: usize,
    /// The index of the camera: 0 for the main camera, then the views in their order.
    #[serde(default)]
    view: usize,
    /// The camera of the viewer. `None` for a camera of the scene.
    own: Option<OwnCamera>,
    /// True for an image of the best quality, false for a quick one.
    #[serde(default)]
    fine: bool,
}

/// The own camera of the viewer. Its fields have the meaning of the keys of `[camera]`.
#[derive(Clone, Debug, Deserialize)]
struct OwnCamera {
    /// The location of the camera, m.
    location: [f64; 3],
    /// The point in the middle of the picture, m.
    look_at: [f64; 3],
    /// The horizontal field of view, degrees.
    angle: f64,
}

/// The stop flag of a client's request for an image. When the client closes the connection, the value is dropped, which stops the
/// rendering.
pub(super) struct Wish(Arc<AtomicBool>);

impl Wish {
    /// Returns the flag that becomes `true` when the client has closed the connection.
    pub(super) fn stop(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.0)
    }
}

impl Drop for Wish {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl OwnCamera {
    /// Returns the view of the scene that has this camera.
    fn view(&self) -> Result<View, Report> {
        let angle = self.angle.clamp(0.1, 179.9);
        let camera = Camera::standing(self.location.into(), self.look_at.into(), angle);
        if camera.is_at_target() {
            let message = "the camera is at the point that it looks at";
            return Err(Report::of_error(Code::CameraAtLookAt, message));
        }
        Ok(View { name: "own".to_owned(), camera })
    }
}

impl Wanted {
    /// Returns the finished run as the wanted camera sees it.
    fn seen<'a>(&self, run: &'a PageRun) -> Result<Run<'a>, Failed> {
        match &self.own {
            Some(own) => Ok(Run::of(run.finished()?)?.seen_by(&own.view()?)?),
            None => run.seen_by(self.view),
        }
    }

    /// Returns the id of the requested run.
    pub(super) fn run(&self) -> RunId {
        self.run.parse().unwrap_or_default()
    }
}

impl Renderer {
    /// Makes a renderer. `povray` is the path of POV-Ray, `None` for `povray` in the `PATH`.
    pub(super) fn new(povray: Option<PathBuf>, confinement: Confinement) -> Renderer {
        Renderer { povray, confinement, one_at_a_time: Mutex::new(()), wishes: Mutex::default() }
    }

    /// Stops all renderings, since the server stops.
    pub(super) fn end(&self) {
        let wishes = self.wishes.lock().unwrap_or_else(PoisonError::into_inner);
        wishes.iter().filter_map(Weak::upgrade).for_each(|stop| stop.store(true, Ordering::Relaxed));
    }

    /// Registers a request for an image, and returns its stop flag.
    pub(super) fn wish(&self) -> Wish {
        let stop = Arc::default();
        let mut wishes = self.wishes.lock().unwrap_or_else(PoisonError::into_inner);
        wishes.retain(|wish| wish.strong_count() > 0);
        wishes.push(Arc::downgrade(&stop));
        Wish(stop)
    }

    /// Renders the image of a frame, and returns the bytes of a PNG.
    pub(super) fn render(
        &self,
        run: &PageRun,
        wanted: &Wanted,
        stop: &AtomicBool,
    ) -> Result<Vec<u8>, Failed> {
        let seen = wanted.seen(run)?;
        let _turn = self.one_at_a_time.lock().unwrap_or_else(PoisonError::into_inner);
        if stop.load(Ordering::Relaxed) {
            return Err(Failed::Gone);
        }
        let scene = &run.scene;
        // A hidden folder keeps these files apart from the scripts of other commands.
        let folder = Folder::open(&Path::new("out/.preview").join(&scene.name))?;
        let time = scene.simulation.timeline.time(wanted.frame.min(scene.simulation.timeline.frames() - 1));
        output::write_moment(&seen, &folder, time)?;
        self.image(&folder, time, wanted.fine, stop)
    }

    fn image(&self, folder: &Folder, time: f64, fine: bool, stop: &AtomicBool) -> Result<Vec<u8>, Failed> {
        let mut sequence = Sequence::open(folder.path(), None)?;
        sequence.moment = Some(time);
        let images = Images::among(folder.dir())?;
        let povray = PovRay::find(self.povray.as_deref(), &images, self.confinement.clone())?;
        let quality = if fine { Quality::Final } else { Quality::Draft };
        let job = Job {
            sequence: &sequence,
            images: &images,
            povray: &povray,
            options: options(sequence.size, sequence.transparent, quality),
            jobs: None,
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            retries: 1,
            keep_going: false,
            time_limit: None,
            verify: false,
        };
        let outcome = job.run(&mut |_| {}, stop)?;
        if let Some(fault) = outcome.failed.first() {
            return Err(Failed::Report(fault.report()));
        }
        let Some(script) = sequence.scripts().first().filter(|_| !outcome.stopped) else {
            return Err(Failed::Gone);
        };
        Ok(images.read(&script.name)?)
    }
}
