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

use minijinja::value::{Serde, Value};
use minijinja::{Environment, context};
use serde::Serialize;

use self::bodies::Block;
use self::materials::MaterialText;
use self::sdl::Style;
use self::stage::Stage;
use crate::dynamics::Shape;
use crate::scene::{Include, Scene};
use crate::simulate::{Frame, Survey};

pub use names::{INI, MASTER, frame_name};
pub use templates::TEMPLATES;
pub(crate) use text::comment;

/// Turns the frames of one scene into scripts.
pub struct Emitter {
    templates: Environment<'static>,
    title: Value,
    frames: usize,
    unit: f64,
    common: Value,
    block: Block,
    /// What templates see of each body beside its place; only made if a template looks at `bodies`.
    bodies: Option<Vec<BodyConstants>>,
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

/// What stays the same about a body.
#[derive(Clone, Serialize)]
struct BodyConstants {
    name: String,
    shape: &'static str,
    material: Option<String>,
}

/// A body as templates see it.
#[derive(Serialize)]
struct BodyValues<'a> {
    #[serde(flatten)]
    constants: &'a BodyConstants,
    location: [f64; 3],
    velocity: [f64; 3],
    force: [f64; 3],
    matrix: String,
}

/// An include file as templates see it.
#[derive(Serialize)]
struct IncludeText<'a> {
    name: &'a str,
    text: Option<&'a str>,
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
        let materials = materials::texts(&scene.materials);
        let title = Value::from(Serde(&scene.title));
        let common = common(scene, &stage, &materials, &title, &templates)?;
        let uses_bodies =
            templates.templates().any(|(_, t)| t.undeclared_variables(false).contains("bodies"));
        Ok(Emitter {
            title,
            frames: scene.simulation.frames(),
            unit: stage.unit,
            common: Value::from(common),
            block: Block::new(scene, &materials, style),
            bodies: uses_bodies.then(|| constants(scene, &materials)),
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            templates,
        })
    }

    /// The length of one unit of POV-Ray's in the scripts, m.
    pub fn unit(&self) -> f64 {
        self.unit
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
        let bodies = self.bodies.as_ref().map(|constants| self.bodies(constants, frame));
        let values = context! {
            frame => frame.index,
            frames => self.frames,
            time => frame.time,
            title => self.title.clone(),
            common => self.common.clone(),
            bodies_sdl,
            bodies,
        };
        Ok(self.templates.get_template("frame.pov")?.render(values)?)
    }

    /// The files with which one `povray` command renders the whole sequence: name and text of each.
    ///
    /// # Errors
    /// Where a template fails.
    pub fn sequence(&self, scene: &Scene) -> Result<Vec<(&'static str, String)>, EmitError> {
        let last = self.frames.saturating_sub(1);
        let digits = names::width(self.frames);
        let values = context! {
            title => self.title.clone(),
            name => scene.name.clone(),
            last,
            digits,
            // POV-Ray numbers images with the digits of the last number, and a single image not at all: these make
            // up for the others.
            padding => "0".repeat(if last == 0 { digits } else { digits - last.to_string().len() }),
            width => scene.output.width,
            height => scene.output.height,
            frame_rate => scene.simulation.frame_rate,
            end => scene.simulation.time(last),
        };
        let file = |name: &'static str| Ok((name, self.templates.get_template(name)?.render(&values)?));
        [MASTER, INI].into_iter().map(file).collect()
    }

    fn bodies(&self, constants: &[BodyConstants], frame: &Frame) -> Value {
        let values = |body: &crate::simulate::BodyFrame| {
            let mut matrix = String::new();
            self.block.style().matrix(&mut matrix, body.orientation, body.location);
            BodyValues {
                constants: &constants[body.id],
                location: (body.location / self.unit).to_array(),
                velocity: body.velocity.to_array(),
                force: body.force.to_array(),
                matrix,
            }
        };
        Value::from(Serde(frame.bodies.iter().map(values).collect::<Vec<_>>()))
    }
}

/// The part that all scripts of a scene have in common.
fn common(
    scene: &Scene,
    stage: &Stage,
    materials: &[MaterialText],
    title: &Value,
    templates: &Environment<'static>,
) -> Result<String, EmitError> {
    let include = |include: &'_ Include| match include {
        Include::Standard(name) => Value::from(Serde(IncludeText { name, text: None })),
        Include::Text { name, text } => Value::from(Serde(IncludeText { name, text: Some(text) })),
    };
    let values = context! {
        title,
        includes => scene.povray.include.iter().map(include).collect::<Vec<_>>(),
        sdl => scene.povray.sdl.clone(),
        materials => Value::from(Serde(materials)),
        axes => scene.bodies.iter().any(|body| matches!(body.shape, Shape::Axes { .. })),
        ..Value::from(Serde(stage))
    };
    Ok(templates.get_template("common.inc")?.render(values)?)
}

fn constants(scene: &Scene, materials: &[MaterialText]) -> Vec<BodyConstants> {
    let constants = |body: &crate::scene::Body| BodyConstants {
        name: body.name.clone(),
        shape: match body.shape {
            Shape::Sphere { .. } => "sphere",
            Shape::Box { .. } => "box",
            Shape::Plane { .. } => "plane",
            Shape::Axes { .. } => "axes",
        },
        material: body.material.map(|material| materials[material].identifier.clone()),
    };
    scene.bodies.iter().map(constants).collect()
}

impl From<minijinja::Error> for EmitError {
    fn from(error: minijinja::Error) -> EmitError {
        EmitError::Template(format!("{error:#}"))
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
