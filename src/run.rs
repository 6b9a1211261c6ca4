//! A simulated scene, ready to be converted into scripts.

#[cfg(feature = "render")]
use crate::cache;
use crate::diagnostic::{Code, Diagnostic, Report};
use crate::emit::{EmitError, Emitter};
use crate::picture::number::rounded;
use crate::picture::{FramedPart, Largest, Plan};
use crate::scene::{Scene, Shutter, View};
use crate::simulate::{Exposure, Frame, Frames, Recorded, SimulateError, Survey};
use crate::{motion_warnings, not_drawn};

/// A scene with its finished simulation and the plan for the scripts of its frames.
pub struct Run<'a> {
    recorded: Recorded<'a>,
    emitter: Emitter,
    /// The name of the view, or `None` for the main camera.
    view: Option<String>,
    /// The motion blur of the camera. `None` without motion blur.
    shutter: Option<Shutter>,
}

/// The error that a scene could not be simulated or converted into scripts.
#[derive(Clone, Debug)]
pub enum RunError {
    /// The simulation failed, or its recording could not be read.
    Simulate(SimulateError),
    /// A script could not be written.
    Emit(EmitError),
}

impl<'a> Run<'a> {
    /// Simulates the scene. If the recording exceeds a megabyte, the excess is written to a temporary file. Without the feature `render`,
    /// all of it stays in memory.
    ///
    /// # Errors
    /// If the motion becomes non-finite, the recording cannot be stored, or a template fails.
    pub fn new(scene: &'a Scene) -> Result<Run<'a>, RunError> {
        #[cfg(feature = "render")]
        let recorded = cache::simulate(scene)?;
        #[cfg(not(feature = "render"))]
        let recorded = Recorded::new(scene)?;
        Run::of(recorded)
    }

    /// Makes a `Run` for the main camera from a finished simulation.
    ///
    /// # Errors
    /// If a template fails.
    pub fn of(recorded: Recorded<'a>) -> Result<Run<'a>, RunError> {
        let scene = recorded.scene();
        let emitter = Emitter::new(scene, &scene.camera, recorded.survey())?;
        Ok(Run { recorded, emitter, view: None, shutter: scene.camera.shutter })
    }

    /// Returns the same simulation as seen by another camera (view) of the scene.
    ///
    /// # Errors
    /// If a template fails.
    pub fn seen_by(&self, view: &View) -> Result<Run<'a>, RunError> {
        let emitter = Emitter::new(self.scene(), &view.camera, self.survey())?;
        let (view, shutter) = (Some(view.name.clone()), view.camera.shutter);
        Ok(Run { recorded: self.recorded.clone(), emitter, view, shutter })
    }

    /// Returns the scene that was simulated.
    pub fn scene(&self) -> &'a Scene {
        self.recorded.scene()
    }

    /// Returns the recording of the simulation.
    pub fn recorded(&self) -> &Recorded<'a> {
        &self.recorded
    }

    /// Returns the name of the view, or `None` for the main camera.
    pub fn view(&self) -> Option<&str> {
        self.view.as_deref()
    }

    /// Returns the motion blur of the camera, if it has motion blur.
    pub fn shutter(&self) -> Option<Shutter> {
        self.shutter
    }

    /// Returns statistics of the whole simulation, such as the extent of the motion and the energy error.
    pub fn survey(&self) -> &Survey {
        self.recorded.survey()
    }

    /// Returns the emitter, which converts frames into scripts.
    pub fn emitter(&self) -> &Emitter {
        &self.emitter
    }

    /// Returns all warnings about the simulation and its images. Examples are bodies that pass through planes or each other, bodies too
    /// thin or too small to be seen, and an energy that drifts.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let thin = self.emitter.too_thin().map(|body| {
            let message =
                format!("POV-Ray may not draw `{body}`: it is too thin against the size of the whole scene");
            Diagnostic::warning(Code::TooThin, message).help("look from nearer, or make the body larger")
        });
        let plan = self.emitter.plan();
        let small = plan.too_small().map(|largest| too_small(self.scene(), plan, largest));
        let gone = left_out(self.scene(), plan.left_out());
        let grid = plan.too_fine_grid().map(grid_too_fine);
        let of_motion = motion_warnings::all(self.scene(), self.survey());
        let not_drawn = plan.not_drawn().iter().map(not_drawn::warning);
        let plots = plan.unseen_plots().iter().map(|unseen| not_drawn::of_plot(self.scene(), unseen));
        of_motion
            .into_iter()
            .chain(thin)
            .chain(small)
            .chain(gone)
            .chain(grid)
            .chain(not_drawn)
            .chain(plots)
            .collect()
    }

    /// Returns all warnings about the simulation and its images, with the texts of the scene that they point into.
    pub fn report(&self) -> Report {
        Report { sources: self.scene().warnings.sources.clone(), diagnostics: self.warnings() }
    }

    /// Iterates over the recorded frames, from the initial state on.
    pub fn frames(&self) -> Frames<'a> {
        self.recorded.frames()
    }

    /// Returns the state at any time (s), and the motion after it while the camera's shutter is open. A time before or after the
    /// simulation is replaced by its beginning or end.
    ///
    /// # Errors
    /// If the motion becomes non-finite, or the recording cannot be read. Also if [`Recorded::of`] made the run, and the moment was not
    /// recorded.
    pub fn at(&self, time: f64) -> Result<Exposure, RunError> {
        Ok(self.recorded.at(time)?)
    }

    /// Returns the script of a frame.
    ///
    /// # Errors
    /// If the position of a body cannot be written, or a template fails.
    pub fn script(&self, frame: &Frame) -> Result<String, EmitError> {
        self.emitter.script(frame)
    }

    /// Returns the script of an image with motion blur. The exposure begins at the time of `exposure.frame`. `None` if the camera has no
    /// motion blur.
    ///
    /// # Errors
    /// If the position of a body cannot be written, a template fails, or the recording cannot be read.
    pub fn shutter_script(&self, exposure: &Exposure) -> Result<Option<String>, RunError> {
        let Some(shutter) = self.shutter else { return Ok(None) };
        let mut script = String::new();
        let moments = exposure.moments(shutter).map(|moment| moment.map_err(RunError::from));
        self.emitter.shutter::<RunError>(&exposure.frame, shutter, moments, |piece| {
            script.push_str(piece);
            Ok(())
        })?;
        Ok(Some(script))
    }
}

/// The codes of all warnings that [`Run::warnings`] can return.
#[cfg(feature = "render")]
pub(crate) const RUN_WARNINGS: [Code; 12] = [
    Code::CorrectedStart,
    Code::Crossing,
    Code::Overlap,
    Code::TooThin,
    Code::TooSmall,
    Code::TooFine,
    Code::NotDrawn,
    Code::EnergyDrift,
    Code::EnergyAdded,
    Code::DeepOverlap,
    Code::JointGivesWay,
    Code::FirstOrder,
];

/// Returns the warning that the largest body is too small to be seen, in the images of this camera or in an image of the whole motion.
fn too_small(scene: &Scene, plan: &Plan, largest: &Largest) -> Diagnostic {
    let name = &largest.name;
    let noun = if largest.is_below_fixed { "the largest moving body" } else { "the largest body" };
    let in_whole = |does: String| {
        let pixels = largest.pixels_in_whole;
        format!(
            "the camera {does}: in a picture of the whole run, {noun}, `{name}`, would be {pixels:.1} pixels wide"
        )
    };
    let message = match plan.part() {
        FramedPart::Start(end) => in_whole(format!("frames only the first {} s", rounded(end))),
        FramedPart::Along => in_whole("goes along with the motion".to_owned()),
        FramedPart::Whole => {
            format!("{noun}, `{name}`, is {:.1} pixels wide in the picture", largest.pixels)
        }
    };
    let is_followed = scene.camera.motion.follow.is_some() || plan.part() == FramedPart::Along;
    let follow = format!("`follow = {{ body = \"{name}\" }}` in [camera] goes along with it");
    let has_trail = scene.bodies.iter().any(|body| *body.name == **name && body.showing.trail.is_some());
    let trail = if has_trail { "" } else { ", `trail = true` shows its way" };
    let scale = largest.fit(plan.part()).map_or_else(String::new, |fit| format!(" = {}", rounded(fit)));
    let others = format!(
        "`look.scale{scale}` draws it larger{trail}; or shorten `simulation.duration`, or give a `[camera]`"
    );
    let help = if is_followed { others } else { format!("{follow}; {others}") };
    Diagnostic::warning(Code::TooSmall, message).help(help)
}

/// Returns the warning that bodies fly out of the picture. `left_out` are their indices. `None` if there are none.
fn left_out(scene: &Scene, left_out: &[usize]) -> Option<Diagnostic> {
    let (first, others) = left_out.split_first()?;
    let name = &scene.bodies[*first].name;
    let who = match others.len() {
        0 => format!("`{name}` leaves"),
        1 => format!("`{name}` and 1 other leave"),
        others => format!("`{name}` and {others} others leave"),
    };
    let message = format!("{who} the picture: the camera shows the bodies that stay together");
    let help = format!(
        "`auto = \"whole\"` in [camera] shows all bodies, and `follow = {{ body = \"{name}\" }}` goes along with this one"
    );
    Some(Diagnostic::warning(Code::NotDrawn, message).help(help))
}

/// Returns the warning that the grid is drawn with wider spacing than the scene gives. The arguments are the given and the drawn spacing,
/// m.
fn grid_too_fine((given, drawn): (f64, f64)) -> Diagnostic {
    let (given, drawn) = (rounded(given), rounded(drawn));
    let message =
        format!("the grid has a line every {drawn} m, not every {given} m, which would be too many");
    Diagnostic::warning(Code::TooFine, message).help(format!("give `spacing = {drawn}` or more in [grid]"))
}

impl RunError {
    /// Returns the code of the error, which `jabuka explain` explains.
    pub fn code(&self) -> Code {
        match self {
            RunError::Simulate(error) => error.code(),
            RunError::Emit(error) => error.code(),
        }
    }

    /// Converts the error to a report, with its positions in the scene or in a template.
    pub fn report(&self) -> Report {
        match self {
            RunError::Simulate(error) => error.report(),
            RunError::Emit(error) => error.report(),
        }
    }

    /// Returns advice on how to correct the error. `None` if the message says enough.
    pub fn help(&self) -> Option<String> {
        match self {
            RunError::Simulate(error) => error.help(),
            RunError::Emit(_) => None,
        }
    }
}

impl From<SimulateError> for RunError {
    fn from(error: SimulateError) -> RunError {
        RunError::Simulate(error)
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
            RunError::Simulate(error) => error.fmt(f),
            RunError::Emit(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for RunError {}
