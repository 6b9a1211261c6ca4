//! The look of a checked scene: materials, cameras, lights, surroundings, and settings for POV-Ray.

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
    /// The name of the material, from the scene's file or from the palette.
    pub name: String,
    /// The look of the material.
    pub look: Look,
}

/// The look of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Look {
    /// A single color with a finish.
    Plain {
        /// The color.
        color: Color,
        /// How the surface reflects light.
        finish: Finish,
    },
    /// A material of the library.
    Library {
        /// The material of the library.
        material: &'static LibraryMaterial,
        /// The color. `None` if the material has its own colors.
        color: Option<Color>,
    },
    /// The checkered look of the ground, the default for planes.
    Checkered,
    /// A texture that an include file declares, by its name.
    Texture(Arc<str>),
    /// POV-Ray code.
    Sdl(Arc<str>),
}

impl Look {
    /// Whether this look has no pattern, so that turning a ball of it changes nothing in the picture.
    pub fn is_uniform(&self) -> bool {
        match self {
            Look::Plain { .. } => true,
            Look::Library { material, .. } => material.pattern == Pattern::None,
            Look::Checkered | Look::Texture(_) | Look::Sdl(_) => false,
        }
    }

    /// Whether the look gives light by itself. A lamp inside a body with such a look must shine through the surface.
    pub fn glows(&self) -> bool {
        match self {
            Look::Plain { finish, .. } => *finish == Finish::Luminous,
            Look::Library { material, .. } => material.glows(),
            Look::Checkered | Look::Texture(_) | Look::Sdl(_) => false,
        }
    }
}

/// How a surface reflects light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Like chalk.
    Matte,
    /// Like eggshell.
    Satin,
    /// Like enamel. The default.
    Glossy,
    /// Like polished, colored metal.
    Metal,
    /// Like a mirror.
    Mirror,
    /// Gives light by itself.
    Luminous,
}

impl Finish {
    /// All finishes.
    pub const ALL: [Finish; 6] =
        [Finish::Matte, Finish::Satin, Finish::Glossy, Finish::Metal, Finish::Mirror, Finish::Luminous];

    /// The finish with this name.
    pub fn named(name: &str) -> Option<Finish> {
        Finish::ALL.into_iter().find(|finish| finish.name() == name)
    }

    /// The name of the finish in scenes and templates.
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

    /// A description of the finish, in one line.
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

/// A camera. jabuka derives missing values from the motion.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The location of the camera, m.
    pub location: Option<DVec3>,
    /// The point that the camera looks at, in the middle of the picture, m.
    pub look_at: Option<DVec3>,
    /// The motion of the camera.
    pub motion: CameraMotion,
    /// The projection of the camera.
    pub projection: Projection,
    /// The blur of things out of focus. `None` if everything is sharp.
    pub blur: Option<Blur>,
    /// The shutter, for motion blur. `None` for sharp frames.
    pub shutter: Option<Shutter>,
}

/// The motion of a camera. Missing values stay as at the start.
#[derive(Clone, Debug, Default)]
pub struct CameraMotion {
    /// The location of the camera, m.
    pub location: Option<TimedVector>,
    /// The point that the camera looks at, in the middle of the picture, m.
    pub look_at: Option<TimedVector>,
    /// The horizontal field of view of a perspective camera, degrees.
    pub angle: Option<Timed>,
    /// The body that the camera follows.
    pub follow: Option<Follow>,
    /// The time of one turn about the vertical axis through the point that the camera looks at, s.
    pub orbit: Option<f64>,
}

/// A camera that follows a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// The index of the body.
    pub body: usize,
    /// The distance of the camera from the body, m. `None` to keep the distance at the start.
    pub distance: Option<f64>,
    /// The delay of the camera, s: it follows the body's earlier position.
    pub lag: Option<f64>,
}

impl CameraMotion {
    /// Whether the camera changes from frame to frame.
    pub fn moves(&self) -> bool {
        self.location.is_some()
            || self.look_at.is_some()
            || self.angle.is_some()
            || self.follow.is_some()
            || self.orbit.is_some()
    }
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective, as in human vision: farther things look smaller.
    Perspective {
        /// The horizontal field of view, degrees, as in POV-Ray.
        angle: f64,
    },
    /// Parallel rays, as in a technical drawing: distance does not change the size.
    Orthographic {
        /// The width of the view, m. `None` to fit the motion.
        width: Option<f64>,
    },
}

/// The blur of things out of focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blur {
    /// The diameter of the lens, m.
    pub aperture: f64,
    /// The point in focus, m. `None` for the point that the camera looks at.
    pub focus: Option<DVec3>,
    /// The number of rays per pixel.
    pub samples: u32,
}

/// Motion blur: an image is the mean of several moments while the shutter is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// The time for which the shutter is open, s, greater than 0. It opens at the time of the frame.
    pub open: f64,
    /// The number of moments in one image.
    pub samples: u32,
}

impl Light {
    /// Whether the light moves.
    pub fn moves(&self) -> bool {
        match &self.kind {
            LightKind::Point { location } | LightKind::Area { location, .. } => location.changes(),
            LightKind::Sun { .. } => false,
        }
    }
}

impl Shutter {
    /// The times of the moments in an image, s. `begin` is the time at which the shutter opens. Each moment is in the
    /// middle of an equal part of the open time.
    pub fn moments(self, begin: f64) -> impl ExactSizeIterator<Item = f64> {
        (0..self.samples).map(move |i| begin + self.open * (f64::from(i) + 0.5) / f64::from(self.samples))
    }
}

/// An additional camera.
#[derive(Clone, Debug)]
pub struct View {
    /// The name of the view, unique among views: letters, digits, `-` and `_`.
    pub name: String,
    /// The camera. Missing values are taken from `[camera]`.
    pub camera: Camera,
}

/// A light.
#[derive(Clone, Debug)]
pub struct Light {
    /// The name of the light, unique among lights.
    pub name: String,
    /// The kind of the light.
    pub kind: LightKind,
    /// The color of the light.
    pub color: Color,
    /// The brightness. At 1, a white surface that faces the light looks white.
    pub intensity: f64,
    /// Whether it casts shadows and highlights.
    pub shadows: bool,
}

/// The kinds of lights.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// A point light.
    Point {
        /// The location of the light, m.
        location: TimedVector,
    },
    /// A light with a size, and so with soft shadows.
    Area {
        /// The centre of the light, m.
        location: TimedVector,
        /// The diameter of the light, m.
        size: f64,
    },
    /// Parallel light, as from the sun.
    Sun {
        /// The direction in which the light travels, a unit vector.
        direction: DVec3,
    },
}

/// The ground, the sky and fog.
#[derive(Clone, Debug)]
pub struct Environment {
    /// The preset, which supplies missing values.
    pub preset: Preset,
    /// The ground. `None` if there is none.
    pub ground: Option<Ground>,
    /// The sky.
    pub sky: Sky,
    /// Whether the ground fades into haze at the horizon.
    pub fog: bool,
}

impl Environment {
    /// Whether the sky is dark, so that texts before it are light.
    pub fn is_dark(&self) -> bool {
        match self.sky {
            Sky::Gradient => matches!(self.preset, Preset::Night | Preset::Blackboard | Preset::Space),
            Sky::Plain(Color([red, green, blue])) => 0.3 * red + 0.6 * green + 0.1 * blue < 0.4,
        }
    }
}

/// The checkered ground. jabuka derives missing values from the motion.
#[derive(Clone, Debug, Default)]
pub struct Ground {
    /// The height of the ground, m.
    pub height: Option<f64>,
    /// The edge length of one tile, m.
    pub tile: Option<f64>,
    /// The restitution and friction of the ground. `None` if bodies pass through the ground.
    pub surface: Option<Surface>,
}

/// The sky.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// The gradient of the preset.
    Gradient,
    /// One color for the whole sky.
    Plain(Color),
}

/// POV-Ray code and settings of the scene.
#[derive(Clone, Debug)]
pub struct PovRay {
    /// Include files.
    pub include: Vec<Include>,
    /// Files that the POV-Ray code of the scene reads.
    pub assets: Vec<Asset>,
    /// Other files that the trusted POV-Ray code of the scene reads: the kind of each file, and its name as in the
    /// code.
    pub reads: Vec<(FileKind, String)>,
    /// POV-Ray code before the bodies.
    pub sdl: Option<String>,
    /// The length of one POV-Ray unit, m. `None` to derive the unit from the size of the scene.
    pub unit: Option<f64>,
    /// The number of significant digits of numbers in scripts.
    pub digits: usize,
    /// The user's templates, which replace built-in templates of the same names.
    pub templates: Vec<OwnTemplate>,
}

/// A file that scripts read. A copy of the file is placed beside the scripts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asset {
    /// The path of the copy, relative to the folder of all copies, with `/`. Scripts use this path.
    pub name: String,
    /// The path of the original file.
    pub path: PathBuf,
}

/// A template of the user.
#[derive(Clone, Debug)]
pub struct OwnTemplate {
    /// The name of the template: `frame.pov`.
    pub name: String,
    /// The path of the template's file, for messages.
    pub path: String,
    /// The text of the template.
    pub text: String,
}

/// An include file.
#[derive(Clone, Debug)]
pub enum Include {
    /// An include file of POV-Ray's standard library.
    Standard(String),
    /// An include file that was found beside the scene.
    Text {
        /// The name of the file, as in the scene.
        name: String,
        /// The text of the file.
        text: String,
    },
}

/// The size and kind of the images.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// The width of an image, pixels.
    pub width: u32,
    /// The height of an image, pixels.
    pub height: u32,
    /// The place of the code that all scripts share.
    pub layout: Layout,
    /// Whether images have a transparent background: no sky, no ground.
    pub transparent: bool,
    /// The frame rate of a video, frames per second. `None` to derive it from the frame rate of the simulation.
    pub video_rate: Option<f64>,
}

/// The place of the code that all scripts share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// In each script, so that a computer of a cluster needs only one file.
    SelfContained,
    /// In a separate file, which each script includes.
    Shared,
}

impl Layout {
    /// All layouts.
    pub const ALL: [Layout; 2] = [Layout::SelfContained, Layout::Shared];

    /// The name of the layout in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Layout::SelfContained => "self-contained",
            Layout::Shared => "shared",
        }
    }
}
