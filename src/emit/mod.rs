//! Writes frames as POV-Ray scripts.
//!
//! Only this module translates physics into POV-Ray's language. An [`Emitter`] is made once for a scene. It then turns any frame into its
//! script, in any order and from several threads at once.
//!
//! # Shared part and bodies
//!
//! The part that all frames share is rendered once from `templates/common.inc`; the script of a frame is that part and a block of bodies. A
//! moving camera or light is written into each script instead of into the shared part. The block is planned once (`bodies.rs`): the text of
//! a body is made once except for its location and orientation, so a frame costs little more than its numbers. Bodies of one plain material
//! are in a union, which POV-Ray parses in two thirds of the time and with a third of the memory that separate objects need. A single body
//! of a material is in an `object`, which costs nothing, so that its line stays the same when a second body is added. A sphere of one color
//! is written by its center. A body that looks different when it turns gets a matrix, and its pattern turns with it.
//!
//! Particles (`particles.rs`) are grouped by age into at most 32 unions. POV-Ray is fastest with one line for each ball: macros take four
//! times as long, arrays twice. To keep lines short, locations are rounded to a hundredth of the particle's radius or finer.
//!
//! # Numbers and units
//!
//! Numbers have 9 significant digits. More digits would not change a pixel. Names and titles are written as comments and are escaped
//! (`text.rs`). Scripts of equal pictures differ only in their first line, which has the number and time of the frame.
//!
//! POV-Ray's coordinates are left-handed; only `right -x*…` in the camera makes them right-handed. Lengths are divided by a unit. POV-Ray
//! draws objects thinner than 0.01 or farther than 10⁵ wrongly, so the unit is chosen to avoid such numbers; it is 1 m if possible
//! (`unit.rs`).
//!
//! A mesh is declared once, as `mesh2`, after the shared part, and a body is `object { Mesh_x matrix … }`. Its coordinates are scaled to
//! about 10 to 100, since POV-Ray drops very small triangles. In the layout `self-contained`, every script contains the mesh; a warning
//! appears if the scripts become large.
//!
//! The haze over the ground is part of its texture. POV-Ray's fog would wash out the bodies of large scenes, and its depth would depend on
//! the camera.
//!
//! # Motion blur
//!
//! An image with motion blur is the mean of several moments while the shutter is open. The moments come from dense output, so the run's bits
//! never depend on them. One script contains all moments of an image, selected by number, so that one process renders them. All other uses
//! need only the sharp script. The mean is taken in linear light (`render/linear_light.rs`): the mean of black and white is 188 of 255, not
//! 128.
//!
//! # Trails, ghosts, arrows and texts
//!
//! They are planned once, like the bodies, and written by `showing/`. A trail is a cubic curve with at most 512 points, from the locations
//! and velocities of frames; it is exact under a constant force. The choice of its points depends only on the frame's number. A ghost is a
//! moment of the recording (`simulate/past.rs`). So a frame's past has the same bits for any selection of frames, number of threads or
//! moment.
//!
//! The points of a trail are in an array, which POV-Ray parses faster than literals. In the layout `shared`, each finished section of 32
//! segments of a trail is in a file `trail_DIGEST.inc`. So scripts do not repeat the trail. The file name identifies the contents, so the
//! record of an image need not include the file. In the layout `self-contained`, every script holds its whole trail.
//!
//! Texts are on a plane just in front of the camera, so they are always legible, never hidden, and equally large in any unit. If the camera
//! has a lens that blurs, they are on the plane in focus. Only POV-Ray knows the widths of texts, so a macro places them, relative to the
//! edges of the rendered image. The font comes with POV-Ray; a letter that it lacks is an error.

mod bodies;
mod error;
mod materials;
mod meshes;
mod names;
mod particles;
mod precision;
mod sdl;
mod shapes;
mod showing;
mod shutter;
mod span;
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
use self::span::Span;
use self::stage::StageText;
use self::templates::Templates;
use self::unit::Unit;
use self::values::FrameConstants;
use crate::picture::{Lost, Plan, number};
use crate::scene::{Camera, Layout, Scene, SdlPiece, Shutter};
use crate::simulate::{Frame, Survey};

pub use error::EmitError;
#[cfg(feature = "render")]
pub(crate) use names::width;
pub use names::{ASSETS, COMMON, INI, MASTER, frame_name, shutter_name};
pub use showing::{TrailFile, is_trail_file};
pub use templates::{TEMPLATES, write_templates};
#[cfg(feature = "render")]
pub(crate) use text::comment;

/// Turns the frames of a scene into POV-Ray scripts.
pub struct Emitter {
    templates: Templates,
    /// The text of the include file that all scripts share. `None` if each script contains everything.
    shared: Option<String>,
    constants: FrameConstants,
    block: Block,
    showing: Showing,
    particles: Particles,
    /// The contents of the pictures, in meters: camera, surroundings, arrows, labels and so on.
    plan: Plan,
    /// The scene's own SDL, if values in it change from frame to frame. Otherwise it is in the shared part.
    sdl: Vec<SdlPiece>,
    unit: Unit,
    style: Style,
    /// The names of the bodies, by index in the scene.
    names: Vec<Arc<str>>,
    /// The names of the particle emitters, by index in the scene.
    emitters: Vec<Arc<str>>,
    /// The length of the longest text of all bodies in a frame so far, bytes.
    longest: AtomicUsize,
    /// The length of the longest text of all other drawn objects in a frame so far, bytes.
    longest_beside: AtomicUsize,
}

impl Emitter {
    /// Prepares everything that the scripts of a scene share.
    ///
    /// # Errors
    /// If a template fails, or sizes and distances in the scene are too small for POV-Ray.
    pub fn new(scene: &Scene, camera: &Camera, survey: &Survey) -> Result<Emitter, EmitError> {
        let templates = Templates::new(&scene.povray.templates, scene.povray.digits)?;
        let plan = Plan::new(scene, camera, survey);
        let unit = Unit::of(scene, &plan);
        precision::check(scene, camera, &plan, unit.length)?;
        let stage = StageText::new(&plan, unit.length);
        let style = Style { unit: unit.length, digits: scene.povray.digits };
        let materials = materials::texts(scene);
        let meshes = Meshes::new(scene);
        let mut common = templates.render(COMMON, &values::common(scene, &stage, &materials))?;
        meshes.declare(&mut common, scene.output.layout, style.digits);
        Showing::declare(&mut common, &plan, scene.output.layout, style);
        let (in_every_script, shared) = match scene.output.layout {
            Layout::SelfContained => (common, None),
            Layout::Shared => (format!("#include \"{COMMON}\"\n"), Some(common)),
        };
        Ok(Emitter {
            constants: FrameConstants::new(scene, in_every_script, &materials, style, |name| {
                templates.mention(name)
            }),
            shared,
            block: Block::new(scene, &materials, &plan.mapped_colors(), &meshes, style),
            showing: Showing::new(scene, &plan, &materials, &meshes, style),
            particles: Particles::new(scene, style),
            plan,
            sdl: if sdl::constant(&scene.povray.sdl).is_none() {
                scene.povray.sdl.clone()
            } else {
                Vec::new()
            },
            unit,
            style,
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            emitters: scene.emitters.iter().map(|emitter| emitter.name.clone()).collect(),
            longest: AtomicUsize::new(0),
            longest_beside: AtomicUsize::new(0),
            templates,
        })
    }

    /// Returns the length of one POV-Ray unit in the scripts, m.
    pub fn unit(&self) -> f64 {
        self.unit.length
    }

    /// Returns the planned contents of the pictures.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the name of a body or particle emitter that may be too thin for POV-Ray to draw, compared with the size of the scene.
    pub fn too_thin(&self) -> Option<&str> {
        let names = |number: usize| self.names.iter().chain(&self.emitters).nth(number);
        self.unit.too_thin.and_then(names).map(|name| &**name)
    }

    /// Writes the script of a frame.
    ///
    /// # Errors
    /// If the location of a body, a light or the camera is not finite in POV-Ray units, the camera is too close to the point that it looks
    /// at, a value in the scene's own SDL is unknown, or a template fails.
    pub fn script(&self, frame: &Frame) -> Result<String, EmitError> {
        let out_of_range = |what: String| EmitError::OutOfRange { what, time: frame.time };
        if let Some(Lost { what, follows_measures }) = self.plan.lost(frame) {
            let time = frame.time;
            return Err(if follows_measures {
                EmitError::NoValue { what, time }
            } else {
                out_of_range(what)
            });
        }
        if self.plan.camera_moves()
            && !precision::sees(&self.plan.camera(frame), self.unit.length, self.style.digits)
        {
            return Err(EmitError::Blind { time: frame.time });
        }
        // The blocks of all frames have similar lengths. Reserving the length at once avoids a buffer of up to twice the size.
        let mut solids_sdl = String::with_capacity(self.longest.load(Ordering::Relaxed));
        let written = self.block.write(&mut solids_sdl, frame, &self.plan.looks(frame));
        written.map_err(|body| out_of_range(format!("`{}`", self.names[body])))?;
        let mut showing_sdl = String::with_capacity(self.longest_beside.load(Ordering::Relaxed));
        let written = self.particles.write(&mut showing_sdl, frame);
        written.map_err(|emitter| out_of_range(format!("a particle of `{emitter}`")))?;
        self.showing.write(&mut showing_sdl, &self.plan, frame, &self.names);
        self.longest.fetch_max(solids_sdl.len(), Ordering::Relaxed);
        self.longest_beside.fetch_max(showing_sdl.len(), Ordering::Relaxed);
        let sdl = self.own_sdl(frame)?;
        let values = self.constants.of(&self.plan, frame, [solids_sdl, showing_sdl], sdl);
        self.templates.render("frame.pov", &values)
    }

    /// Returns the scene's own SDL with the values of a frame. `None` if it is in the shared part.
    fn own_sdl(&self, frame: &Frame) -> Result<Option<String>, EmitError> {
        let value = self.plan.values(frame);
        let mut sdl = String::new();
        for piece in &self.sdl {
            match piece {
                SdlPiece::Sdl(code) => sdl.push_str(code),
                SdlPiece::Value { text, formula } => {
                    let value = value(formula);
                    if !value.is_finite() {
                        let what = format!("`${{{text}}}` in `povray.sdl`");
                        return Err(EmitError::NoValue { what, time: frame.time });
                    }
                    // The check of untrusted SDL takes the value for a word of its own.
                    sdl.push(' ');
                    self.style.number(&mut sdl, value);
                    sdl.push(' ');
                }
            }
        }
        Ok(Some(sdl).filter(|_| !self.sdl.is_empty()))
    }

    /// Returns the trail files that the script of a frame includes, except those that exist: `has` tells whether a file of a name does. The name of a file contains a
    /// digest of its text, so each file has to be written only once for all frames. The list is empty in the layout `self-contained`.
    pub fn trail_files(&self, frame: &Frame, has: &dyn Fn(&str) -> bool) -> Vec<TrailFile> {
        self.showing.trail_files(&self.plan, frame, has)
    }

    /// Writes the script of an image with motion blur, piece by piece, so that only one moment is in memory at a time. `put` receives each
    /// piece in turn. `frame` is the moment at which the shutter opens.
    ///
    /// # Errors
    /// The errors of [`Emitter::script`], of the simulation of a moment, and of `put`.
    pub fn shutter<E: From<EmitError>>(
        &self,
        frame: &Frame,
        shutter: Shutter,
        moments: impl Iterator<Item = Result<Frame, E>>,
        mut put: impl FnMut(&str) -> Result<(), E>,
    ) -> Result<(), E> {
        put(&shutter::head(frame, shutter, self.style.digits))?;
        for (number, moment) in moments.enumerate() {
            put(&shutter::moment(number, &self.script(&moment?)?))?;
        }
        put(&shutter::end(shutter))
    }

    /// Returns the name and text of each file beside the scripts: the main script and the options with which one `povray` command renders
    /// the whole sequence, and the common include file if there is one. `frames` are the frames whose scripts are in the folder, in any
    /// order: the command renders these.
    ///
    /// # Errors
    /// If a template fails.
    pub fn sequence(
        &self,
        scene: &Scene,
        frames: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<(&'static str, String)>, EmitError> {
        let values = values::sequence(scene, Span::of(frames));
        let shared = self.shared.iter().map(|text| Ok((COMMON, text.clone())));
        let rendered =
            [MASTER, INI].into_iter().map(|name| Ok((name, self.templates.render(name, &values)?)));
        rendered.chain(shared).collect()
    }
}
