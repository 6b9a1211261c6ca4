//! Reads the text of a scene into a checked [`Scene`].
//!
//! Reading takes four steps. [`source`] parses the text into a tree. `expand` replaces formulas by numbers (with [`expression`]).
//! `check::validate` checks the tree against the grammar of the scene language in [`grammar`]. `check` makes the [`Scene`]: it resolves
//! names, fills in defaults, and converts to SI units and radians. One run reports the mistakes that all steps find.

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
mod timeline;
mod units;
mod view;

use std::path::{Path, PathBuf};

pub use color::Color;
pub(crate) use color::names as color_names;
pub use contact::{Collider, ContactLaw, is_by_moreau};
pub use emitter::Emitter;
pub(crate) use expand::in_string;
pub use force::{Force, ForceKind};
pub use joint::{Joint, JointKind, JointLook, PrescribedCoordinate};
pub use label::{
    BodyMeasure, Corner, Format, Grid, GridPlane, JointMeasure, JointState, Label, LabelPlace, Measure,
    Piece, RunMeasure, ScaleBar, Side,
};
pub use library::{LibraryMaterial, MATERIALS, Pattern, PlainLook};
pub use look::{
    Asset, Blur, Camera, CameraMotion, Environment, Finish, Follow, Ground, Include, Layout, Light,
    LightKind, Look, Material, Output, OwnTemplate, PovRay, Projection, Shutter, Sky, View,
};
pub(crate) use model::thinnest;
pub use model::{Body, BodyLook, SimulationSettings};
pub use places::Places;
pub use preset::Preset;
pub use showing::{Arrow, BodyAxes, Ghosts, Quantity, Showing, SpringLine, SpringLook, Trail};
pub use source::Override;
pub use timeline::Timeline;

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
    /// The labels in the picture, in the order of the file.
    pub labels: Vec<Label>,
    /// The scale bar in the picture. `None` if the scene has no scale bar.
    pub scale_bar: Option<ScaleBar>,
    /// The grid in the picture. `None` if the scene has no grid.
    pub grid: Option<Grid>,
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
}

impl Scene {
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

    /// Returns the height of the ground (m) and its contact properties. `None` if bodies pass through the ground.
    pub fn ground_that_stops(&self) -> Option<(f64, Surface)> {
        let ground = self.environment.ground.as_ref()?;
        Some((ground.height?, ground.surface?))
    }

    /// Returns true if a force is computed with a tree of bodies. The potential energy is then computed with the same tree.
    pub fn has_tree(&self) -> bool {
        let of_tree = |force: &Force| match &force.kind {
            ForceKind::Gravitation(gravitation) => gravitation.opening_angle.is_some(),
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
