//! Reads the text of a scene into a checked [`Scene`].
//!
//! Reading takes four steps. [`source`] parses the text into a tree. `expand` replaces formulas by numbers (with [`expression`]).
//! `check::validate` checks the tree against the grammar of the scene language in [`grammar`]. `check` makes the [`Scene`]: it resolves
//! names, fills in defaults, and converts to SI units and radians. One run reports the mistakes that all steps find.
//!
//! # The grammar
//!
//! `grammar/` describes every key as data: name, kind of value, unit, default, meaning. The validation (`check/validate.rs`) and the
//! suggestions (`check/suggest.rs`) use this description. `docs/scene-language.md`, the JSON Schema that `jabuka schema` prints, and the
//! text of `jabuka explain KEY` (`grammar/find.rs`) are generated from it. `scene` imports names from `physics`, such as `Shape` and the
//! table of methods, so that it can check the names in a scene; it runs no simulation.
//!
//! # The four steps
//!
//! 1. `source/` opens only regular files, each up to a size limit (`source/file.rs`), and parses the text into a tree in which every value keeps
//!    its position. The parser recovers from syntax errors.
//!
//! 2. `expand/` applies `--set`, fills in values from included files, and replaces formulas by their values, so that later stages see no
//!    formulas. Each value keeps the position of its formula in the text. `[variables]` are evaluated in the order of their dependencies.
//!    The random numbers of a formula depend only on the seed and the path of its key. `[defaults]` fill in the missing keys of each body,
//!    force and so on. A formula in `[defaults]` is evaluated for each of them separately (`expand/merge.rs`).
//!
//! 3. `check/validate.rs` compares the tree with the grammar. It finds every error that needs no knowledge of physics.
//!
//! 4. `check/` makes the [`Scene`]: it resolves names, fills in defaults, and converts to SI units and radians. Later stages have nothing
//!    left to check.
//!
//! For each kind of value, one function in `read.rs` returns the value or an error. The validation uses the error, the check uses the value.
//! Serde's derive would stop at the first error and lose positions, so serde is used only for files that jabuka writes. The guesses for TOML
//! are in `source/corrections.rs` and `source/foreign.rs`, those for formulas in `expand/corrections.rs`, and those for keys and values in
//! `check/corrections/`, a file for each kind of mistake.
//!
//! # Copies
//!
//! A body with a `repeat` is replaced by its copies (`expand/repeat/`). Each copy is a table with its own name, such as `brick[3,0]`, which
//! is part of the paths of its keys. An error that all copies share is reported once. Forces and joints repeat as well (`expand/links.rs`),
//! and the index of a copy in a name may be a formula (`expand/index.rs`). Copies share equal tables and lists (`source/shared.rs`), so a
//! copy takes little memory (about 800 bytes), and half a million are possible. The size of the data that copies do not share, mainly from
//! formulas, is checked before they are made. Scattered copies are placed one after another, each with its own random numbers, so that later
//! copies do not move earlier ones.
//!
//! # Formulas
//!
//! `expression/` is the language of formulas: text → tree → program. A program has an accumulator, a small stack, and instructions that hold
//! most of their operands. When a result is not finite, a second evaluation checks every step to find the cause. A tree is stored as a list
//! in which operands come before their operations. So only the parser is recursive, and its depth is limited.
//!
//! Forces given by formulas are evaluated for 64 bodies at once (`expression/wide.rs`). Each instruction works on columns of numbers, so
//! decoding it costs little, and the compiler makes vector instructions of the loop. The result for each body has the same bits as an
//! evaluation for this body alone. `force_formula.rs` gives such formulas to the dynamics as a `ForceLaw`; the check compares the force with
//! the exact derivative of its potential.
//!
//! A number that may depend on time is a `Timed`: a constant, or a formula with its derivative (`expression/derive.rs`), which gives the
//! velocity.
//!
//! # Meshes
//!
//! Other crates read meshes (`mesh/`). They get the text line by line, so that an error message can name its line. Lines are rewritten if
//! other programs write them in a form that these crates do not support. A sort merges vertices at the same place, so touching surfaces are
//! connected. A surface is closed if every edge belongs to as many triangles in one direction as in the other. Then mass and inertia follow
//! from the divergence theorem. A heightfield is a mesh as well, because POV-Ray's own `height_field` might interpret the pixels
//! differently, and jabuka needs the exact heights to place camera and ground.
//!
//! # SDL and files of untrusted scenes
//!
//! Raw SDL is code. Without `--trust`, SDL is split into POV-Ray's tokens (`sdl/`) and may contain only words that access no file. A file
//! name must be a plain string: the name of an asset, or of one of POV-Ray's own files. Paths that leave the scene's folder need `--trust`,
//! too.
//!
//! # Presence
//!
//! A body with a trajectory from a file is present from its first row to its last, except for gaps (`check/presence.rs`).

mod asset;
mod check;
mod color;
mod color_map;
mod color_names;
mod contact;
mod default_looks;
mod drawn_field;
mod emitter;
mod expand;
pub mod expression;
mod file_columns;
mod force;
pub mod force_formula;
pub mod grammar;
mod handle;
mod joint;
mod label;
mod library;
mod look;
mod mark;
mod measure;
mod mesh;
mod model;
pub mod motion;
mod places;
mod plot;
mod preset;
mod read;
pub mod sampled_number;
pub mod sdl;
mod showing;
pub mod source;
mod speed_curve;
pub mod timed;
mod timeline;
mod units;
mod value;
mod value_map;
mod variable_slider;
mod varying;
mod view;

use std::path::{Path, PathBuf};

pub use asset::{Asset, AssetSource};
pub use color::Color;
pub(crate) use color::names as color_names;
pub use color_map::{ColorMap, Palette};
pub use contact::{Collider, ContactLaw, is_by_moreau, why_for_many_bodies};
pub use drawn_field::{DrawnField, FieldStyle};
pub use emitter::Emitter;
pub(crate) use expand::in_string;
pub use file_columns::{ColumnUnit, FileColumn, FileColumns};
pub use force::{Force, ForceKind};
pub use handle::{Handle, HandleKind, HandlePlace};
pub use joint::{Joint, JointKind, JointLook, PrescribedCoordinate};
pub use label::{Corner, Format, Grid, GridPlane, Label, LabelPlace, Piece, ScaleBar, Side};
pub use library::{LibraryMaterial, MATERIALS, Pattern, PlainLook};
pub use look::{
    Auto, Blur, Camera, CameraMotion, DecimalSign, Environment, Finish, Follow, Ground, Include, Layout,
    Light, LightKind, Look, Material, Output, OwnTemplate, PovRay, Projection, SdlPiece, Shutter, Sky, View,
};
pub use mark::{Angle, Area, ArrowMark, ArrowOwner, Components, Distance, Leg};
pub use measure::{
    Aggregate, Aggregation, AskedUnit, BodyMeasure, EmitterMeasure, ForceMeasure, JointMeasure, JointState,
    ListedMeasure, Measure, MeasureFormula, RunMeasure, Subject,
};
pub(crate) use model::thinnest;
pub use model::{Body, BodyLook, SimulationSettings};
pub use places::{Places, PlotSpans};
pub use plot::{Curve, Plot, PlotKind, PlotPlace};
pub use preset::Preset;
pub use showing::{Arrow, BodyAxes, Ghosts, Quantity, Showing, SpringLine, SpringLook, Trail};
pub use source::Override;
pub use speed_curve::SpeedCurve;
pub use timeline::Timeline;
pub use value_map::{LookAspect, LookNumber, ValueMap, Visibility};
pub use variable_slider::VariableSlider;
pub use varying::{Varying, VaryingPoint};

use crate::diagnostic::Report;
use crate::physics::Surface;

/// Returns whether a scene can have this number of frames.
#[must_use]
pub fn is_possible_number_of_frames(frames: usize) -> bool {
    #[allow(clippy::cast_precision_loss, reason = "the limit is far below 2^53")]
    let possible = (1.0..=check::MAX_FRAMES).contains(&(frames as f64));
    possible
}

/// A scene that has been read and checked. It is complete and has no errors.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The file name of the scene without its extension. The name is `scene` if the scene was not read from a file.
    pub name: String,
    /// The title of the scene. `None` if the scene gives no title.
    pub title: Option<String>,
    /// The settings of the simulation: times, integrator, gravity and contacts.
    pub simulation: SimulationSettings,
    /// The bodies, in the order of the file. A copy made by `repeat` is a body of its own.
    pub bodies: Vec<Body>,
    /// The forces, in the order of the file. The `force` key of a single body is part of that body instead.
    pub forces: Vec<Force>,
    /// The joints, in the order of the file, but with all gears last.
    pub joints: Vec<Joint>,
    /// The particle emitters, in the order of the file.
    pub emitters: Vec<Emitter>,
    /// The materials: first those of `[material.NAME]` in the order of the file, then those of single bodies, the library and the palette.
    pub materials: Vec<Material>,
    /// The color maps of materials, each once.
    pub color_maps: Vec<ColorMap>,
    /// The maps of the numbers of looks that follow values, such as transparencies.
    pub value_maps: Vec<ValueMap>,
    /// The conditions under which bodies are drawn: formulas that are not 0 then.
    pub conditions: Vec<MeasureFormula>,
    /// The main camera, from `[camera]`.
    pub camera: Camera,
    /// The additional cameras (`[view.NAME]`), in the order of the file.
    pub views: Vec<View>,
    /// The lights, in the order of the file. If the list is empty, the lights of the preset are used.
    pub lights: Vec<Light>,
    /// The surroundings: ground, sky and fog.
    pub environment: Environment,
    /// The pairs of bodies whose impacts the labels count, as indices of bodies with the smaller index first. An index equal to the number
    /// of bodies means the ground.
    pub pairs: Vec<[usize; 2]>,
    /// The further columns of trajectory files that formulas can name.
    pub file_columns: FileColumns,
    /// The pairs of bodies whose smallest distances formulas use, as indices of bodies with the smaller index first.
    pub approaches: Vec<[usize; 2]>,
    /// The sums, means and extremes over several bodies that labels and plots show.
    pub aggregates: Vec<Aggregate>,
    /// The labels in the picture, in the order of the file.
    pub labels: Vec<Label>,
    /// The plots in the picture, in the order of the file.
    pub plots: Vec<Plot>,
    /// The angles in the picture, in the order of the file.
    pub angles: Vec<Angle>,
    /// The dimension lines in the picture, in the order of the file.
    pub distances: Vec<Distance>,
    /// The swept areas in the picture, in the order of the file.
    pub areas: Vec<Area>,
    /// The drawings of fields, in the order of the file.
    pub fields: Vec<DrawnField>,
    /// The formulas of [`Options::measures`], in their order. No picture shows them.
    pub measures: Vec<MeasureFormula>,
    /// The texts and components of arrows: first those of bodies, then those of joints.
    pub arrow_marks: Vec<ArrowMark>,
    /// The scale bar in the picture. `None` if the scene has no scale bar.
    pub scale_bar: Option<ScaleBar>,
    /// The grid in the picture. `None` if the scene has no grid.
    pub grid: Option<Grid>,
    /// The sliders of variables, in the order of the scene.
    pub variable_sliders: Vec<VariableSlider>,
    /// The vectors that a user can drag in the picture. Those of bodies come last.
    pub handles: Vec<Handle>,
    /// The POV-Ray code of the scene, and its settings for POV-Ray.
    pub povray: PovRay,
    /// The settings for the images, the scripts and the video.
    pub output: Output,
    /// The SHA-256 digest, in hexadecimal, of all texts and other files that the scene was read from.
    pub digest: String,
    /// The source spans of names and values, for errors during a run. The texts themselves are in `warnings`.
    pub places: Places,
    /// The `--set` arguments that replaced values of the file, as written: `simulation.step=0.001`.
    pub overrides: Vec<String>,
    /// The warnings about the scene, with the source texts that they refer to.
    pub warnings: Report,
}

/// The options for reading a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The values that replace values of the scene's file, as with `--set`.
    pub overrides: Vec<Override>,
    /// The folder of the user's templates, which replace the built-in templates. `None` for the templates that the scene names.
    pub templates: Option<PathBuf>,
    /// Whether the scene is trusted: its POV-Ray code may open, write and include files, and its paths may lead out of its folder.
    pub trust: bool,
    /// Further formulas of measures, written as in plots, such as `ball.speed:km/h`. No picture shows them. Their compiled form is
    /// [`Scene::measures`].
    pub measures: Vec<String>,
}

impl Scene {
    /// Returns the texts that show values of the moment, each as its pieces: labels, and the texts of angles, distances and arrows.
    pub fn texts(&self) -> impl Iterator<Item = &[Piece]> {
        let labels = self.labels.iter().map(|label| label.text.as_slice());
        let angles = self.angles.iter().map(|angle| angle.text.as_slice());
        let distances = self.distances.iter().filter_map(|distance| distance.text.as_deref());
        let arrows = self.arrow_marks.iter().filter_map(|mark| mark.text.as_deref());
        let components = self.arrow_marks.iter().filter_map(|mark| mark.components.as_ref()?.texts.as_ref());
        let components = components.flatten().map(Vec::as_slice);
        labels.chain(angles).chain(distances).chain(arrows).chain(components)
    }

    /// Returns all formulas of measures: of texts, plots, looks, cameras, lights, SDL, of the aggregates in them, and those that
    /// [`Options::measures`] asks for.
    pub fn formulas(&self) -> impl Iterator<Item = &MeasureFormula> {
        let of_texts = self.texts().flatten().filter_map(|piece| match piece {
            Piece::Value { formula, .. } => Some(formula),
            Piece::Words(_) => None,
        });
        let of_plots = self
            .plots
            .iter()
            .flat_map(|plot| std::iter::once(&plot.x).chain(plot.curves.iter().map(|curve| &curve.y)));
        let of_aggregates = self.aggregates.iter().map(|it| &it.formula);
        let of_colors = self.color_maps.iter().map(|map| &map.of);
        let of_numbers = self.value_maps.iter().map(|map| &map.of);
        let of_looks = of_colors.chain(of_numbers).chain(&self.conditions);
        let of_sdl = self.povray.sdl.iter().filter_map(SdlPiece::formula);
        let of_stage =
            self.cameras().flat_map(Camera::formulas).chain(self.lights.iter().flat_map(Light::formulas));
        let asked = self.measures.iter();
        of_texts
            .chain(of_plots)
            .chain(of_aggregates)
            .chain(of_looks)
            .chain(of_sdl)
            .chain(of_stage)
            .chain(asked)
    }

    /// Returns all cameras: the main one, then those of the views.
    pub fn cameras(&self) -> impl Iterator<Item = &Camera> {
        std::iter::once(&self.camera).chain(self.views.iter().map(|view| &view.camera))
    }

    /// Returns whether a camera or a light follows measures.
    pub fn stage_follows_measures(&self) -> bool {
        self.cameras().any(|camera| camera.formulas().next().is_some())
            || self.lights.iter().any(|light| light.formulas().next().is_some())
    }

    /// Returns whether a formula shows a quantity of bodies for which `is` is true.
    pub fn shows_of_bodies(&self, is: impl Fn(BodyMeasure) -> bool) -> bool {
        let mut inputs = self.formulas().flat_map(|formula| &formula.inputs);
        inputs.any(|input| matches!(input, Measure::Body(_, measure) if is(*measure)))
    }

    /// Returns whether the pictures show values of the moment: in letters, as looks, as arrows of named forces, or by what cameras, lights and
    /// SDL follow.
    pub fn shows_measures(&self) -> bool {
        let has_arrows = self.forces.iter().any(|force| force.arrow.is_some());
        has_arrows || self.writes_measures() || self.formulas().next().is_some()
    }

    /// Returns whether the pictures have texts with values: labels, plots, color bars, or marks.
    pub fn writes_measures(&self) -> bool {
        let has_marks = !self.angles.is_empty() || !self.distances.is_empty() || !self.arrow_marks.is_empty();
        has_marks
            || !self.labels.is_empty()
            || !self.plots.is_empty()
            || self.color_maps.iter().any(|map| map.bar.is_some())
    }

    /// Returns the arrows of named forces, in the order of bodies, then of forces: the index of the force, and that of the body.
    pub fn arrows_of_forces(&self) -> impl Iterator<Item = (usize, usize)> {
        let forces = self.forces.iter().enumerate().filter(|(_, force)| force.arrow.is_some());
        let bodies = forces.flat_map(|(number, force)| {
            force.kind.bodies().into_iter().map(move |body| (body.index(), number))
        });
        let mut arrows: Vec<(usize, usize)> =
            bodies.filter(|(body, _)| !self.bodies[*body].start.fixed).collect();
        arrows.sort_unstable();
        arrows.into_iter().map(|(body, force)| (force, body))
    }

    /// Returns the color map of a body. `None` if the color of the body never changes.
    pub fn color_map_of(&self, body: &Body) -> Option<usize> {
        self.materials[body.material?].color_map
    }

    /// Returns the map that a part of a body's look follows. `None` if this part never changes.
    pub fn value_map_of(&self, body: &Body, aspect: LookAspect) -> Option<usize> {
        let material = || body.material.map(|material| &self.materials[material]);
        match aspect {
            LookAspect::Transparency => material()?.transparency.map(),
            LookAspect::Glow => material()?.glow.map(),
            LookAspect::Scale => body.look.scale_map,
        }
    }

    /// Returns the color map of a body's trail. `None` without a trail, or if the trail has one color.
    pub fn trail_map_of(&self, body: &Body) -> Option<usize> {
        body.showing.trail.filter(|trail| trail.color.is_none())?;
        self.color_map_of(body)
    }

    /// Reads and checks the scene in a file.
    ///
    /// # Errors
    /// All mistakes of the scene with their source positions, or the reason why the file cannot be read.
    pub fn from_path(path: impl AsRef<Path>) -> Result<Scene, Report> {
        Scene::from_path_with(path, &Options::default())
    }

    /// Like [`Scene::from_path`], with options.
    ///
    /// # Errors
    /// All mistakes of the scene with their source positions, or the reason why the file cannot be read.
    pub fn from_path_with(path: impl AsRef<Path>, options: &Options) -> Result<Scene, Report> {
        let path = path.as_ref();
        Scene::from_text_at(path, &source::load(path)?, options)
    }

    /// Reads and checks a text as if it stood in the file `path`, such as a text that an editor has not saved yet.
    ///
    /// # Errors
    /// All mistakes of the scene with their source positions.
    pub fn from_text_at(path: impl AsRef<Path>, text: &str, options: &Options) -> Result<Scene, Report> {
        let path = path.as_ref();
        let folder =
            path.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
        let name = path.file_stem().map_or_else(|| "scene".into(), std::ffi::OsStr::to_string_lossy);
        check::check(
            &check::Input { name: &name, shown: &path.display().to_string(), path: Some(path), folder, text },
            options,
        )
    }

    /// Returns the height of the ground (m) and its contact properties. `None` if bodies pass through the ground.
    pub fn ground_that_stops(&self) -> Option<(f64, Surface)> {
        let ground = self.environment.ground.as_ref()?;
        Some((ground.height?, ground.surface?))
    }

    /// Returns true if a force is computed with a tree of bodies. The potential energy is then computed with the same tree.
    pub fn has_tree(&self) -> bool {
        let of_tree = |force: &Force| match &force.kind {
            ForceKind::Between(force) => {
                force.gravitation().is_some_and(|gravitation| gravitation.opening_angle.is_some())
            }
            _ => false,
        };
        self.forces.iter().any(of_tree)
    }

    /// Returns the paths of the scene's own file and of all files that the scene names.
    pub fn files(&self) -> &[PathBuf] {
        self.warnings.sources.files()
    }

    /// Reads and checks the text of a scene. Such a scene has no folder, so it cannot include other files of the user.
    ///
    /// # Errors
    /// All mistakes of the scene with their source positions.
    pub fn parse(text: &str) -> Result<Scene, Report> {
        Scene::parse_with(text, &Options::default())
    }

    /// Like [`Scene::parse`], with options.
    ///
    /// # Errors
    /// All mistakes of the scene with their source positions.
    pub fn parse_with(text: &str, options: &Options) -> Result<Scene, Report> {
        check::check(
            &check::Input { name: "scene", shown: "scene.toml", path: None, folder: None, text },
            options,
        )
    }
}
