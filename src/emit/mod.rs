//! Frames → scripts.
//!
//! Here, and nowhere else, physics becomes POV-Ray's words. An [`Emitter`] is made once for a scene; then it turns
//! any frame into its script, in any order and from several threads at once.

mod bodies;
mod distinct;
mod error;
mod materials;
mod meshes;
mod names;
mod particles;
mod sdl;
mod shapes;
mod showing;
mod shutter;
mod stage;
mod templates;
mod text;
mod unit;
mod values;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use self::bodies::Block;
use self::meshes::Meshes;
use self::particles::Particles;
use self::sdl::Style;
use self::showing::Showing;
use self::stage::StageText;
use self::templates::Templates;
use self::unit::Unit;
use self::values::FrameConstants;
use crate::picture::{Plan, number};
use crate::scene::{Camera, Layout, Scene, Shutter};
use crate::simulate::{Frame, Survey};

pub use error::EmitError;
#[cfg(feature = "render")]
pub(crate) use names::width;
pub use names::{ASSETS, COMMON, INI, MASTER, frame_name, shutter_name};
pub use showing::{TrailFile, is_trail_file};
pub use templates::{TEMPLATES, write_templates};
#[cfg(feature = "render")]
pub(crate) use text::comment;

/// Turns the frames of one scene into scripts.
pub struct Emitter {
    templates: Templates,
    /// The part common to all scripts, if it is a file of its own.
    shared: Option<String>,
    constants: FrameConstants,
    block: Block,
    showing: Showing,
    particles: Particles,
    /// The contents of the pictures.
    plan: Plan,
    unit: Unit,
    digits: usize,
    /// The names of the bodies.
    names: Vec<Arc<str>>,
    /// The names of the emitters.
    emitters: Vec<Arc<str>>,
    /// The bytes of the longest block of bodies so far.
    longest: AtomicUsize,
    /// The length of the longest block of things beside the bodies, bytes.
    longest_beside: AtomicUsize,
}

impl Emitter {
    /// Prepares everything that the scripts of a scene have in common.
    ///
    /// # Errors
    /// If a template fails, or POV-Ray could not tell a body, or the camera and what it looks at, apart.
    pub fn new(scene: &Scene, camera: &Camera, survey: &Survey) -> Result<Emitter, EmitError> {
        let templates = Templates::new(&scene.povray.templates, scene.povray.digits)?;
        let plan = Plan::new(scene, camera, survey);
        let unit = Unit::of(scene, &plan);
        distinct::check(scene, camera, &plan, unit.length)?;
        let stage = StageText::new(&plan, unit.length);
        let style = Style { unit: unit.length, digits: scene.povray.digits };
        let materials = materials::texts(scene);
        let meshes = Meshes::new(scene);
        let mut common = templates.render(COMMON, &values::common(scene, &stage, &materials))?;
        meshes.declare(&mut common, scene.output.layout, style.digits);
        let (in_every_script, shared) = match scene.output.layout {
            Layout::SelfContained => (common, None),
            Layout::Shared => (format!("#include \"{COMMON}\"\n"), Some(common)),
        };
        Ok(Emitter {
            constants: FrameConstants::new(scene, in_every_script, &materials, style, |name| {
                templates.mention(name)
            }),
            shared,
            block: Block::new(scene, &materials, &meshes, style),
            showing: Showing::new(scene, &plan, &materials, &meshes, style),
            particles: Particles::new(scene, style),
            plan,
            unit,
            digits: scene.povray.digits,
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            emitters: scene.emitters.iter().map(|emitter| emitter.name.clone()).collect(),
            longest: AtomicUsize::new(0),
            longest_beside: AtomicUsize::new(0),
            templates,
        })
    }

    /// The length of one unit of POV-Ray's in the scripts, m.
    pub fn unit(&self) -> f64 {
        self.unit.length
    }

    /// The contents of the pictures.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The name of a body, or of an emitter of particles, that POV-Ray may not draw, since no unit makes it thick enough and its surroundings small
    /// enough.
    pub fn too_thin(&self) -> Option<&str> {
        let names = |number: usize| self.names.iter().chain(&self.emitters).nth(number);
        self.unit.too_thin.and_then(names).map(|name| &**name)
    }

    /// The script of a frame.
    ///
    /// # Errors
    /// If a body is at a place that cannot be written, or a template fails.
    pub fn script(&self, frame: &Frame) -> Result<String, EmitError> {
        let out_of_range = |what: String| EmitError::OutOfRange { what, time: frame.time };
        if let Some(what) = self.plan.lost(frame) {
            return Err(out_of_range(what));
        }
        if self.plan.camera_moves()
            && !distinct::sees(&self.plan.camera(frame), self.unit.length, self.digits)
        {
            return Err(EmitError::Blind { time: frame.time });
        }
        // The blocks of frames are about as long as each other, and room that grows step by step is twice as much.
        let mut solids_sdl = String::with_capacity(self.longest.load(Ordering::Relaxed));
        let written = self.block.write(&mut solids_sdl, frame);
        written.map_err(|body| out_of_range(format!("`{}`", self.names[body])))?;
        let mut showing_sdl = String::with_capacity(self.longest_beside.load(Ordering::Relaxed));
        let written = self.particles.write(&mut showing_sdl, frame);
        written.map_err(|emitter| out_of_range(format!("a particle of `{emitter}`")))?;
        self.showing.write(&mut showing_sdl, &self.plan, frame, &self.names);
        self.longest.fetch_max(solids_sdl.len(), Ordering::Relaxed);
        self.longest_beside.fetch_max(showing_sdl.len(), Ordering::Relaxed);
        self.templates.render("frame.pov", &self.constants.of(&self.plan, frame, solids_sdl, showing_sdl))
    }

    /// The files with parts of trails that the script of a frame includes, but for those that `has` knows by name: a
    /// name says what is in its file, so each has to be written once for all frames. None in the layout
    /// `self-contained`.
    pub fn trail_files(&self, frame: &Frame, has: &dyn Fn(&str) -> bool) -> Vec<TrailFile> {
        self.showing.trail_files(&self.plan, frame, has)
    }

    /// The script of an image with motion blur, piece by piece, so that its moments need not be held together: `put`
    /// gets one piece after another. `frame` is the moment at which the shutter opens.
    ///
    /// # Errors
    /// As [`Emitter::script`], where a moment cannot be simulated, and what `put` says.
    pub fn shutter<E: From<EmitError>>(
        &self,
        frame: &Frame,
        shutter: Shutter,
        moments: impl Iterator<Item = Result<Frame, E>>,
        mut put: impl FnMut(&str) -> Result<(), E>,
    ) -> Result<(), E> {
        put(&shutter::head(frame, shutter, self.digits))?;
        for (number, moment) in moments.enumerate() {
            put(&shutter::moment(number, &self.script(&moment?)?))?;
        }
        put(&shutter::end(shutter))
    }

    /// The files beside the scripts, name and text of each: those with which one `povray` command renders the whole
    /// sequence, and what the scripts share, if that is a file of its own.
    ///
    /// # Errors
    /// If a template fails.
    pub fn sequence(&self, scene: &Scene) -> Result<Vec<(&'static str, String)>, EmitError> {
        let values = values::sequence(scene);
        let shared = self.shared.iter().map(|text| Ok((COMMON, text.clone())));
        let rendered =
            [MASTER, INI].into_iter().map(|name| Ok((name, self.templates.render(name, &values)?)));
        rendered.chain(shared).collect()
    }
}
