//! The part of a checked scene that is look.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;

use super::sdl::FileKind;
use super::timed::{Timed, TimedVector};
use super::{Color, LibraryMaterial, Pattern, Preset};
use crate::dynamics::Surface;

/// A material of bodies.
#[derive(Clone, Debug)]
pub struct Material {
    /// Its name: that of the file, or one of the palette's.
    pub name: String,
    /// Its look.
    pub look: Look,
}

/// The look of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Look {
    /// One color all over.
    Plain {
        /// The color.
        color: Color,
        /// How the surface throws light back.
        finish: Finish,
    },
    /// One of the library.
    Library {
        /// Which.
        material: &'static LibraryMaterial,
        /// Its color, unless it has colors of its own.
        color: Option<Color>,
    },
    /// The checkered look of the ground, for planes without a material.
    Checkered,
    /// A texture that an include file declares.
    Texture(Arc<str>),
    /// POV-Ray's own words.
    Sdl(Arc<str>),
}

impl Look {
    /// Whether a body of this look that is the same from all sides looks the same however it is turned.
    pub fn is_uniform(&self) -> bool {
        match self {
            Look::Plain { .. } => true,
            Look::Library { material, .. } => material.pattern == Pattern::None,
            Look::Checkered | Look::Texture(_) | Look::Sdl(_) => false,
        }
    }

    /// Whether it shines by itself, so that a lamp in a body of it must shine out.
    pub fn glows(&self) -> bool {
        match self {
            Look::Plain { finish, .. } => *finish == Finish::Luminous,
            Look::Library { material, .. } => material.glows(),
            Look::Checkered | Look::Texture(_) | Look::Sdl(_) => false,
        }
    }
}

/// How a surface throws light back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Like chalk.
    Matte,
    /// Like eggshell.
    Satin,
    /// Like enamel; the usual one.
    Glossy,
    /// Like polished, colored metal.
    Metal,
    /// Like a mirror.
    Mirror,
    /// Shines by itself.
    Luminous,
}

impl Finish {
    /// All of them.
    pub const ALL: [Finish; 6] =
        [Finish::Matte, Finish::Satin, Finish::Glossy, Finish::Metal, Finish::Mirror, Finish::Luminous];

    /// The finish of a name.
    pub fn named(name: &str) -> Option<Finish> {
        Finish::ALL.into_iter().find(|finish| finish.name() == name)
    }

    /// Its name in scenes and templates.
    pub fn name(self) -> &'static str {
        match self {
            Finish::Matte => "matte",
            Finish::Satin => "satin",
            Finish::Glossy => "glossy",
            Finish::Metal => "metal",
            Finish::Mirror => "mirror",
            Finish::Luminous => "luminous",
        }
    }

    /// Its description, in one line.
    pub fn summary(self) -> &'static str {
        match self {
            Finish::Matte => "Like chalk",
            Finish::Satin => "Like eggshell",
            Finish::Glossy => "Like enamel; the usual one",
            Finish::Metal => "Like polished, colored metal",
            Finish::Mirror => "Like a mirror",
            Finish::Luminous => "Shines by itself",
        }
    }
}

/// From where the scene is seen. What is not given follows from the motion.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The place of the camera, m.
    pub location: Option<DVec3>,
    /// The point in the middle of the picture, m.
    pub look_at: Option<DVec3>,
    /// How it moves.
    pub motion: CameraMotion,
    /// How it sees.
    pub projection: Projection,
    /// How it blurs what is not in focus.
    pub blur: Option<Blur>,
    /// How it blurs what moves.
    pub shutter: Option<Shutter>,
}

/// How a camera moves: what is not given stays as it is at the start.
#[derive(Clone, Debug, Default)]
pub struct CameraMotion {
    /// The place of the camera, m.
    pub location: Option<TimedVector>,
    /// The point in the middle of the picture, m.
    pub look_at: Option<TimedVector>,
    /// The horizontal field of view in perspective, degrees.
    pub angle: Option<Timed>,
    /// The body that it goes along with.
    pub follow: Option<Follow>,
    /// The time of a turn about the vertical through what it looks at, s.
    pub orbit: Option<f64>,
}

/// A camera that follows a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// The number of the body.
    pub body: usize,
    /// How far the camera stays from it, m; none: as at the start.
    pub distance: Option<f64>,
    /// The time by which the camera is behind, s.
    pub lag: Option<f64>,
}

impl CameraMotion {
    /// Whether the camera is not the same in all frames.
    pub fn moves(&self) -> bool {
        self.location.is_some()
            || self.look_at.is_some()
            || self.angle.is_some()
            || self.follow.is_some()
            || self.orbit.is_some()
    }
}

/// How a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// As eyes do: what is farther is smaller.
    Perspective {
        /// The horizontal field of view, degrees (as POV-Ray takes it).
        angle: f64,
    },
    /// By parallel rays, as in a technical drawing: size does not depend on distance.
    Orthographic {
        /// The width that is seen, m; none: that of the motion.
        width: Option<f64>,
    },
}

/// How a camera blurs what is not in focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blur {
    /// The diameter of the lens, m.
    pub aperture: f64,
    /// The point that is sharp, m; none: the one that is looked at.
    pub focus: Option<DVec3>,
    /// The number of rays for a pixel.
    pub samples: u32,
}

/// How a camera blurs what moves: while its shutter is open, it looks at several moments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// How long the shutter is open from the time of a frame on, s; greater than 0.
    pub open: f64,
    /// The number of moments.
    pub samples: u32,
}

impl Light {
    /// Whether it is not the same in all frames.
    pub fn moves(&self) -> bool {
        match &self.kind {
            LightKind::Point { location } | LightKind::Area { location, .. } => location.changes(),
            LightKind::Sun { .. } => false,
        }
    }
}

impl Shutter {
    /// The moments at which the camera looks for an image that begins at a time (s), each in the middle of an equal
    /// part of the time for which the shutter is open.
    pub fn moments(self, begin: f64) -> impl ExactSizeIterator<Item = f64> {
        (0..self.samples).map(move |i| begin + self.open * (f64::from(i) + 0.5) / f64::from(self.samples))
    }
}

/// A camera beside the main one.
#[derive(Clone, Debug)]
pub struct View {
    /// Its name, unique among views: letters, digits, `-` and `_`.
    pub name: String,
    /// The camera; what the view does not say is as in `[camera]`.
    pub camera: Camera,
}

/// A light.
#[derive(Clone, Debug)]
pub struct Light {
    /// Its name, unique among lights.
    pub name: String,
    /// The kind of the light.
    pub kind: LightKind,
    /// Its color.
    pub color: Color,
    /// Its brightness: 1 shows a white surface that faces it as white.
    pub intensity: f64,
    /// Whether it casts shadows and highlights.
    pub shadows: bool,
}

/// The kinds of lights.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// A lamp without size.
    Point {
        /// The place of the lamp, m.
        location: TimedVector,
    },
    /// A lamp with a size.
    Area {
        /// The centre of the lamp, m.
        location: TimedVector,
        /// Its diameter, m.
        size: f64,
    },
    /// Parallel light.
    Sun {
        /// The unit vector in which the light travels.
        direction: DVec3,
    },
}

/// Ground, sky and fog.
#[derive(Clone, Debug)]
pub struct Environment {
    /// The preset, which supplies the parts that are not given.
    pub preset: Preset,
    /// The ground, if there is one.
    pub ground: Option<Ground>,
    /// The sky.
    pub sky: Sky,
    /// Whether the ground fades into haze.
    pub fog: bool,
}

impl Environment {
    /// Whether what stands before it is seen best in a light color.
    pub fn is_dark(&self) -> bool {
        match self.sky {
            Sky::Gradient => matches!(self.preset, Preset::Night | Preset::Blackboard | Preset::Space),
            Sky::Plain(Color([red, green, blue])) => 0.3 * red + 0.6 * green + 0.1 * blue < 0.4,
        }
    }
}

/// The checkered ground. What is not given follows from the motion.
#[derive(Clone, Debug, Default)]
pub struct Ground {
    /// Its height, m.
    pub height: Option<f64>,
    /// The edge of one tile, m.
    pub tile: Option<f64>,
    /// How it behaves where bodies touch it; none: they pass through it.
    pub surface: Option<Surface>,
}

/// The sky.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// The gradient of the preset.
    Gradient,
    /// The same color everywhere.
    Plain(Color),
}

/// Code and settings passed to POV-Ray as they are.
#[derive(Clone, Debug)]
pub struct PovRay {
    /// Include files.
    pub include: Vec<Include>,
    /// Files that POV-Ray's own words read.
    pub assets: Vec<Asset>,
    /// Other files that the scene's trusted POV-Ray code names: the name between its quotes, and how it is read.
    pub reads: Vec<(FileKind, String)>,
    /// POV-Ray's own words, before the bodies.
    pub sdl: Option<String>,
    /// The length of one unit of POV-Ray's, m; none: it follows from the size of the scene.
    pub unit: Option<f64>,
    /// Significant digits of the numbers in scripts.
    pub digits: usize,
    /// Templates that take the place of those built in.
    pub templates: Vec<OwnTemplate>,
}

/// A file that scripts read, of which a copy stands beside them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asset {
    /// The name in scripts: the path of its copy below the folder of all copies, with `/`.
    pub name: String,
    /// The path of its file.
    pub path: PathBuf,
}

/// A template of the user's own.
#[derive(Clone, Debug)]
pub struct OwnTemplate {
    /// Its name among templates: `frame.pov`.
    pub name: String,
    /// The path of its file, for messages.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// An include file.
#[derive(Clone, Debug)]
pub enum Include {
    /// One that POV-Ray finds by itself.
    Standard(String),
    /// One that was found beside the scene, and its text.
    Text {
        /// Its name as the scene gives it.
        name: String,
        /// Its text.
        text: String,
    },
}

/// The images that the scripts are meant for.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// The place of the part that all scripts have in common.
    pub layout: Layout,
    /// Whether nothing stands behind the bodies: no sky, no ground, and alpha in the images.
    pub transparent: bool,
    /// The frames per second of a film, if it has a rate of its own.
    pub video_rate: Option<f64>,
}

/// The place of the part that all scripts have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// In every script: a node of a cluster needs one file.
    SelfContained,
    /// In a file of its own, which every script includes.
    Shared,
}

impl Layout {
    /// All of them.
    pub const ALL: [Layout; 2] = [Layout::SelfContained, Layout::Shared];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Layout::SelfContained => "self-contained",
            Layout::Shared => "shared",
        }
    }
}
