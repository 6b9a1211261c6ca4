//! Frames → scripts.
//!
//! Here, and nowhere else, physics becomes POV-Ray's words. An [`Emitter`] is made once for a scene; then it turns
//! any frame into its script, in any order and from several threads at once.

mod bodies;
mod framing;
mod materials;
mod names;
mod number;
mod sdl;
mod stage;
mod templates;
mod text;
mod values;

use minijinja::Environment;

use self::bodies::Block;
use self::sdl::Style;
use self::stage::Stage;
use self::values::FrameConstants;
use crate::scene::Scene;
use crate::simulate::{Frame, Survey};

pub use names::{INI, MASTER, frame_name};
pub use templates::TEMPLATES;
pub(crate) use text::comment;

/// Turns the frames of one scene into scripts.
pub struct Emitter {
    templates: Environment<'static>,
    constants: FrameConstants,
    block: Block,
    unit: f64,
    too_thin: Option<usize>,
    /// The names of the bodies.
    names: Vec<String>,
}

/// That a script cannot be written.
#[derive(Clone, Debug, PartialEq)]
pub enum EmitError {
    /// A place is not a number in POV-Ray's units.
    OutOfRange {
        /// The name of the body.
        body: String,
        /// The time, s.
        time: f64,
    },
    /// A template fails.
    Template(String),
}

impl Emitter {
    /// Prepares everything that the scripts of a scene have in common.
    ///
    /// # Errors
    /// Where a template fails.
    pub fn new(scene: &Scene, survey: &Survey) -> Result<Emitter, EmitError> {
        let templates = templates::environment(scene.povray.digits)?;
        let stage = Stage::new(scene, survey);
        let style = Style { unit: stage.unit, digits: scene.povray.digits };
        let materials = materials::texts(scene);
        let common =
            templates.get_template("common.inc")?.render(values::common(scene, &stage, &materials))?;
        let looks_at_bodies = |(_, template): (_, minijinja::Template<'_, '_>)| {
            template.undeclared_variables(false).contains("bodies")
        };
        let with_bodies = templates.templates().any(looks_at_bodies);
        Ok(Emitter {
            constants: FrameConstants::new(scene, common, &materials, style, with_bodies),
            block: Block::new(scene, &materials, style),
            unit: stage.unit,
            too_thin: stage.too_thin,
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            templates,
        })
    }

    /// The length of one unit of POV-Ray's in the scripts, m.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// The name of a body that POV-Ray may not draw, since no unit makes it thick enough and its surroundings small
    /// enough.
    pub fn too_thin(&self) -> Option<&str> {
        self.too_thin.map(|body| self.names[body].as_str())
    }

    /// The script of a frame.
    ///
    /// # Errors
    /// Where a body is at a place that cannot be written, or a template fails.
    pub fn script(&self, frame: &Frame) -> Result<String, EmitError> {
        let mut bodies_sdl = String::new();
        self.block
            .write(&mut bodies_sdl, frame)
            .map_err(|body| EmitError::OutOfRange { body: self.names[body].clone(), time: frame.time })?;
        Ok(self.templates.get_template("frame.pov")?.render(self.constants.of(frame, bodies_sdl))?)
    }

    /// The files with which one `povray` command renders the whole sequence: name and text of each.
    ///
    /// # Errors
    /// Where a template fails.
    pub fn sequence(&self, scene: &Scene) -> Result<Vec<(&'static str, String)>, EmitError> {
        let values = values::sequence(scene);
        let file = |name: &'static str| Ok((name, self.templates.get_template(name)?.render(&values)?));
        [MASTER, INI].into_iter().map(file).collect()
    }
}

impl From<minijinja::Error> for EmitError {
    fn from(error: minijinja::Error) -> EmitError {
        // The innermost cause says what is wrong; the others say on the way from which template to which.
        let mut message = error.to_string();
        let mut cause = std::error::Error::source(&error);
        while let Some(error) = cause {
            message = format!("{message}: {error}");
            cause = error.source();
        }
        EmitError::Template(message)
    }
}

impl std::fmt::Display for EmitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            EmitError::OutOfRange { body, time } => {
                write!(f, "at t = {time} s `{body}` is at a place that is no number in POV-Ray's units")
            }
            EmitError::Template(message) => write!(f, "a template fails: {message}"),
        }
    }
}

impl std::error::Error for EmitError {}
