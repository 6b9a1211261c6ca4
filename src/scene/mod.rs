//! Text → checked scene.
//!
//! A scene goes through four steps: [`source`] makes a tree of its text, `expand` puts numbers in the place of formulas
//! (which [`expression`] reads and evaluates), `check::validate` holds the tree against the description of the language in
//! [`grammar`], and `check` makes the [`Scene`]: names resolved, defaults filled in, SI units, radians. All mistakes of all
//! steps are reported in one run.

mod check;
mod color;
mod color_names;
mod contact;
pub mod drawn;
mod emitter;
mod expand;
pub mod expression;
mod force;
pub mod grammar;
mod joint;
mod label;
pub mod law;
mod library;
mod look;
mod mesh;
mod model;
pub mod motion;
mod palette;
mod places;
mod preset;
mod read;
pub mod sdl;
mod showing;
pub mod source;
pub mod timed;
mod units;
mod view;

use std::path::{Path, PathBuf};

pub use color::Color;
pub(crate) use color::names as color_names;
pub use contact::{Collider, ContactLaw};
pub use emitter::Emitter;
pub(crate) use expand::in_string;
pub use force::{Force, ForceKind};
pub use joint::{Course, Joint, JointKind, JointLook};
pub use label::{
    BodyMeasure, Corner, Format, Grid, GridPlane, JointMeasure, Label, LabelPlace, Measure, Piece,
    RunMeasure, ScaleBar, Side,
};
pub use library::{LibraryMaterial, MATERIALS, Pattern, PlainLook};
pub use look::{
    Asset, Blur, Camera, CameraMotion, Environment, Finish, Follow, Ground, Include, Layout, Light,
    LightKind, Look, Material, Output, OwnTemplate, PovRay, Projection, Shutter, Sky, View,
};
pub use model::{Body, BodyLook, Simulation};
pub use places::Places;
pub use preset::Preset;
pub use showing::{Arrow, BodyAxes, Ghosts, Quantity, Showing, SpringLine, SpringLook, Trail};
pub use source::Override;

use crate::diagnostic::Report;
use crate::dynamics::Surface;

/// Whether a scene may have so many frames.
#[must_use]
pub fn is_possible_number_of_frames(frames: usize) -> bool {
    #[allow(clippy::cast_precision_loss, reason = "the limit is far below 2^53")]
    let possible = (1.0..=check::MAX_FRAMES).contains(&(frames as f64));
    possible
}

/// A checked scene: everything that there is to know, and nothing that could still be wrong.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The name of the scene's file without its ending; `scene` for a text without a file.
    pub name: String,
    /// The title of the scene.
    pub title: Option<String>,
    /// How the world is advanced.
    pub simulation: Simulation,
    /// The bodies, in the order of the file.
    pub bodies: Vec<Body>,
    /// The forces that are not a single body's own, in the order of the file.
    pub forces: Vec<Force>,
    /// Joints, in the order of the file.
    pub joints: Vec<Joint>,
    /// Emitters of particles, in the order of the file.
    pub emitters: Vec<Emitter>,
    /// The materials of the file in its order, then those of bodies' own, the library and the palette.
    pub materials: Vec<Material>,
    /// From where the scene is seen.
    pub camera: Camera,
    /// The cameras beside the main one, in the order of the file.
    pub views: Vec<View>,
    /// The lights; none means the usual ones.
    pub lights: Vec<Light>,
    /// Ground, sky and fog.
    pub environment: Environment,
    /// The pairs of bodies whose impacts the labels count, the smaller number first; that of the ground is the number of bodies.
    pub pairs: Vec<[usize; 2]>,
    /// The texts in the picture, in the order of the file.
    pub labels: Vec<Label>,
    /// The scale bar, if there is one.
    pub scale_bar: Option<ScaleBar>,
    /// The grid, if there is one.
    pub grid: Option<Grid>,
    /// Code and settings passed to POV-Ray as they are.
    pub povray: PovRay,
    /// The images that the scripts are meant for.
    pub output: Output,
    /// A digest (SHA-256, in hexadecimal) of all texts and meshes that the scene was read from.
    pub digest: String,
    /// The places in the text that errors of a run point at. The texts are those of `warnings`.
    pub places: Places,
    /// The values that replaced those of the file, as they were written: `simulation.step=0.001`.
    pub overrides: Vec<String>,
    /// The warnings.
    pub warnings: Report,
}

/// How a scene is read.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Values that replace those of the file.
    pub overrides: Vec<Override>,
    /// A folder with templates that take the place of those built in, and of those that the scene names.
    pub templates: Option<PathBuf>,
    /// Whether the scene may contain SDL that opens, writes or includes files, and paths outside its folder.
    pub trust: bool,
}

impl Scene {
    /// Reads and checks the scene in a file.
    ///
    /// # Errors
    /// All mistakes of the scene, each at its place; or why the file cannot be read.
    pub fn from_path(path: impl AsRef<Path>) -> Result<Scene, Report> {
        Scene::from_path_with(path, &Options::default())
    }

    /// Like [`Scene::from_path`], with options.
    ///
    /// # Errors
    /// All mistakes of the scene, each at its place; or why the file cannot be read.
    pub fn from_path_with(path: impl AsRef<Path>, options: &Options) -> Result<Scene, Report> {
        let path = path.as_ref();
        let text = source::load(path)?;
        let folder =
            path.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
        let name = path.file_stem().map_or_else(|| "scene".into(), std::ffi::OsStr::to_string_lossy);
        check::check(
            &check::Input {
                name: &name,
                shown: &path.display().to_string(),
                path: Some(path),
                folder,
                text: &text,
            },
            options,
        )
    }

    /// The height of the ground, m, and its surface, if it stops bodies.
    pub fn ground_that_stops(&self) -> Option<(f64, Surface)> {
        let ground = self.environment.ground.as_ref()?;
        Some((ground.height?, ground.surface?))
    }

    /// The files that the scene was read from: its own, and all that it names.
    pub fn files(&self) -> &[PathBuf] {
        self.warnings.sources.files()
    }

    /// Reads and checks a scene that is a text in memory. It has no folder, so it cannot include files of its own.
    ///
    /// # Errors
    /// All mistakes of the scene, each at its place.
    pub fn parse(text: &str) -> Result<Scene, Report> {
        Scene::parse_with(text, &Options::default())
    }

    /// Like [`Scene::parse`], with options.
    ///
    /// # Errors
    /// All mistakes of the scene, each at its place.
    pub fn parse_with(text: &str, options: &Options) -> Result<Scene, Report> {
        check::check(
            &check::Input { name: "scene", shown: "scene.toml", path: None, folder: None, text },
            options,
        )
    }
}
