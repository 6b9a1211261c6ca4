//! A scene on its way to scripts.

use crate::diagnostic::{Code, Diagnostic};
use crate::dynamics::Effort;
use crate::emit::{EmitError, Emitter};
use crate::picture::{Largest, Plan, number};
use crate::scene::{Scene, Shutter, View};
use crate::simulate::{
    Branch, Crossing, Diverged, Frame, Frames, Overlap, Selection, Survey, survey_watched,
};

/// A scene whose run has been looked over, so that its frames can be made into scripts.
pub struct Run<'a> {
    scene: &'a Scene,
    survey: Survey,
    emitter: Emitter,
    /// The name of the view; none for the main camera.
    view: Option<String>,
    /// How the camera blurs what moves.
    shutter: Option<Shutter>,
    /// Counts the interactions of pairs whenever the run is simulated.
    effort: Effort,
}

/// A frame, and the run from there on if the camera blurs what moves.
pub(crate) struct Exposed<'a> {
    pub(crate) frame: Frame,
    /// The shutter, and the branch of the run on which it is open.
    pub(crate) shutter: Option<(Shutter, Branch<'a>)>,
}

/// Why a run cannot be drawn.
#[derive(Clone, Debug)]
pub enum RunError {
    /// It left the numbers.
    Diverged(Diverged),
    /// A script cannot be written.
    Emit(EmitError),
}

impl<'a> Run<'a> {
    /// Simulates the scene once, to learn where it takes place.
    ///
    /// # Errors
    /// Where the run leaves the numbers, or a template fails.
    pub fn new(scene: &'a Scene) -> Result<Run<'a>, RunError> {
        Run::new_seeing(scene, |_| {})
    }

    /// Like [`Run::new`]; `seen` is told of every frame that has been simulated.
    ///
    /// # Errors
    /// Where the run leaves the numbers, or a template fails.
    pub fn new_seeing(scene: &'a Scene, seen: impl FnMut(&Frame)) -> Result<Run<'a>, RunError> {
        Run::new_watched(scene, &Effort::default(), seen)
    }

    /// Like [`Run::new_seeing`]; now and later, the interactions of pairs are counted, which tells how far a long frame is.
    ///
    /// # Errors
    /// Where the run leaves the numbers, or a template fails.
    pub fn new_watched(
        scene: &'a Scene,
        effort: &Effort,
        seen: impl FnMut(&Frame),
    ) -> Result<Run<'a>, RunError> {
        let run = Run::surveyed(scene, survey_watched(scene, effort, seen)?)?;
        Ok(Run { effort: effort.clone(), ..run })
    }

    /// The run of a scene that somebody has looked over.
    ///
    /// # Errors
    /// Where a template fails.
    pub fn surveyed(scene: &'a Scene, survey: Survey) -> Result<Run<'a>, RunError> {
        let emitter = Emitter::new(scene, &scene.camera, &survey)?;
        let (shutter, effort) = (scene.camera.shutter, Effort::default());
        Ok(Run { scene, survey, emitter, view: None, shutter, effort })
    }

    /// The same run, seen by one of the scene's other cameras.
    ///
    /// # Errors
    /// Where a template fails.
    pub fn seen_by(&self, view: &View) -> Result<Run<'a>, RunError> {
        let emitter = Emitter::new(self.scene, &view.camera, &self.survey)?;
        let survey = self.survey.clone();
        let (view, shutter) = (Some(view.name.clone()), view.camera.shutter);
        Ok(Run { scene: self.scene, survey, emitter, view, shutter, effort: self.effort.clone() })
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The name of the view that sees the run; none for the main camera.
    pub fn view(&self) -> Option<&str> {
        self.view.as_deref()
    }

    /// How the camera blurs what moves, if it does.
    pub fn shutter(&self) -> Option<Shutter> {
        self.shutter
    }

    /// What is known of the run as a whole.
    pub fn survey(&self) -> &Survey {
        &self.survey
    }

    /// What turns frames into scripts.
    pub fn emitter(&self) -> &Emitter {
        &self.emitter
    }

    /// What was noticed of the run and is no error: bodies that go through planes or each other, bodies too thin or too small to be
    /// seen, an energy that drifts.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let crossings = self.survey.crossings.iter().map(crossing);
        let thin = self.emitter.too_thin().map(|body| {
            let message =
                format!("POV-Ray may not draw `{body}`: it is too thin against the size of the whole scene");
            Diagnostic::warning(Code::TooThin, message).help("look from nearer, or make the body larger")
        });
        let plan = self.emitter.plan();
        let small = plan.too_small().map(|largest| too_small(self.scene, plan, largest));
        let grid = plan.too_fine_grid().map(grid_too_fine);
        crossings
            .chain(self.survey.overlap.iter().map(overlap))
            .chain(thin)
            .chain(small)
            .chain(grid)
            .chain(drift(self.survey.drift))
            .collect()
    }

    /// The frames, from the initial state.
    pub fn frames(&self) -> Frames<'a> {
        Frames::watched(self.scene, &self.effort)
    }

    /// The selected frames; the simulation ends with the last of them.
    pub(crate) fn selected(
        &self,
        selection: &Selection,
    ) -> impl Iterator<Item = Result<Exposed<'a>, Diverged>> + Send {
        let mut frames = self.frames();
        let mut left = selection.last().map_or(0, |last| last.saturating_add(1));
        let shutter = self.shutter;
        let next = move || {
            loop {
                left = left.checked_sub(1)?;
                match frames.next()? {
                    Ok(frame) if !selection.contains(frame.index) => {}
                    Ok(frame) => {
                        let shutter = shutter.map(|shutter| (shutter, frames.branch()));
                        return Some(Ok(Exposed { frame, shutter }));
                    }
                    Err(error) => return Some(Err(error)),
                }
            }
        };
        std::iter::from_fn(next)
    }

    /// The script of a frame.
    ///
    /// # Errors
    /// Where a body is at a place that cannot be written, or a template fails.
    pub fn script(&self, frame: &Frame) -> Result<String, EmitError> {
        self.emitter.script(frame)
    }

    /// The script of an image with motion blur: the moments from the frame on, by which [`Branch::at`] or
    /// [`Frames::branch`] gives the run. None if the camera does not blur what moves.
    ///
    /// # Errors
    /// Where a body is at a place that cannot be written, a template fails, or the run leaves the numbers.
    pub fn shutter_script(&self, frame: &Frame, branch: Branch<'_>) -> Result<Option<String>, RunError> {
        let Some(shutter) = self.shutter else { return Ok(None) };
        let mut script = String::new();
        let moments = branch.moments(shutter).map(|moment| moment.map_err(RunError::from));
        self.emitter.shutter::<RunError>(frame, shutter, moments, |piece| {
            script.push_str(piece);
            Ok(())
        })?;
        Ok(Some(script))
    }
}

/// The kinds of all warnings of a run.
pub(crate) const RUN_WARNINGS: [Code; 6] =
    [Code::Crossing, Code::Overlap, Code::TooThin, Code::TooSmall, Code::TooFine, Code::EnergyDrift];

/// That the energy is wrong by more than anyone would draw knowingly.
fn drift(drift: f64) -> Option<Diagnostic> {
    const NOTICEABLE: f64 = 0.05;
    let message = format!("the energy drifts by {:.0} % of the largest kinetic energy", drift * 100.0);
    let help = "take a smaller `simulation.step`, or an `integrator` of higher order";
    (drift.abs() > NOTICEABLE).then(|| Diagnostic::warning(Code::EnergyDrift, message).help(help))
}

/// That the largest body is too small to be seen in the picture, or would be in one of the whole run.
fn too_small(scene: &Scene, plan: &Plan, largest: &Largest) -> Diagnostic {
    let name = &largest.name;
    let message = match plan.framed_until() {
        Some(end) => format!(
            "the camera frames only the first {} s: in a picture of the whole run, the largest body, `{name}`, would \
             be {:.1} pixels wide",
            rounded(end),
            largest.pixels_in_whole,
        ),
        None => format!("the largest body, `{name}`, is {:.1} pixels wide in the picture", largest.pixels),
    };
    let is_followed = scene.camera.motion.follow.is_some();
    let follow = format!("`follow = {{ body = \"{name}\" }}` in [camera] goes along with it");
    let others = "`look.scale` draws it larger, `trail = true` shows its way; or shorten `simulation.duration`, or give \
                  a `[camera]`";
    let help = if is_followed { others.to_owned() } else { format!("{follow}; {others}") };
    Diagnostic::warning(Code::TooSmall, message).help(help)
}

/// That a grid has fewer lines than the scene asks for.
fn grid_too_fine((given, drawn): (f64, f64)) -> Diagnostic {
    let (given, drawn) = (rounded(given), rounded(drawn));
    let message =
        format!("the grid has a line every {drawn} m, not every {given} m: those would be too many");
    Diagnostic::warning(Code::TooFine, message).help(format!("give `spacing = {drawn}` or more in [grid]"))
}

/// A number with three digits.
fn rounded(number: f64) -> String {
    let mut out = String::new();
    number::write(&mut out, number, 3);
    out
}

/// That a body goes through a plane.
fn crossing(crossing: &Crossing) -> Diagnostic {
    let plane = crossing.plane.as_ref().map_or("the ground".to_owned(), |name| format!("the plane `{name}`"));
    let others = match crossing.others {
        0 => String::new(),
        1 => ", and 1 other body later".to_owned(),
        others => format!(", and {others} other bodies later"),
    };
    let message = format!("`{}` goes through {plane} at t = {} s{others}", crossing.body, crossing.time);
    Diagnostic::warning(Code::Crossing, message).help("bodies do not collide yet: nothing stops it")
}

/// That two bodies go into each other.
fn overlap(overlap: &Overlap) -> Diagnostic {
    let [one, two] = &overlap.bodies;
    let message = format!("`{one}` and `{two}` overlap at t = {} s", overlap.time);
    Diagnostic::warning(Code::Overlap, message).help("bodies do not collide yet: they go through each other")
}

impl From<Diverged> for RunError {
    fn from(error: Diverged) -> RunError {
        RunError::Diverged(error)
    }
}

impl From<EmitError> for RunError {
    fn from(error: EmitError) -> RunError {
        RunError::Emit(error)
    }
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            RunError::Diverged(error) => error.fmt(f),
            RunError::Emit(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for RunError {}
