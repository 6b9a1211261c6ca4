//! The look of a scene: materials, cameras, lights, environment, and settings for POV-Ray.

use std::sync::Arc;

use glam::DVec3;

use super::MeasureFormula;
use super::sdl::FileKind;
use super::varying::{Varying, VaryingPoint};
use super::{Asset, Color, LibraryMaterial, LookNumber, Pattern, Preset};
use crate::physics::Surface;

/// A named material that bodies can have.
#[derive(Clone, Debug)]
pub struct Material {
    /// The name of the material: from the scene, the library or the palette, or the name of the body that the material belongs to.
    pub name: String,
    /// The color, pattern and finish of the material. A color that follows a value is the middle one of its map here.
    pub look: Look,
    /// The color map that gives each body its own color, by its index in the scene. `None` for a color that never changes.
    pub color_map: Option<usize>,
    /// The part of the light that passes through a convex body: from 0 for opaque to 1 for invisible.
    pub transparency: LookNumber,
    /// The part of the color that shines by itself: from 0 for none to 1 for a luminous body.
    pub glow: LookNumber,
}

impl Material {
    /// Returns a material of one look, whose color never changes.
    pub(in crate::scene) fn new(name: &str, look: Look) -> Material {
        let zero = LookNumber::Fixed(0.0);
        Material { name: name.to_owned(), look, color_map: None, transparency: zero, glow: zero }
    }

    /// Returns whether two materials differ at most in their names.
    pub fn looks_like(&self, other: &Material) -> bool {
        let numbers = |material: &Material| [material.transparency, material.glow];
        self.look == other.look && self.color_map == other.color_map && numbers(self) == numbers(other)
    }

    /// Returns whether the material shines all by itself, so that a body with it casts no shadow.
    pub fn glows(&self) -> bool {
        self.look.glows() || self.glow == LookNumber::Fixed(1.0)
    }
}

/// The look of a material: its color, pattern and finish.
#[derive(Clone, Debug, PartialEq)]
pub enum Look {
    /// A single color, and a finish that says how the surface reflects light.
    Plain {
        /// The color of the material.
        color: Color,
        /// The finish: how the surface reflects light, such as matte or glossy.
        finish: Finish,
    },
    /// A material of the library, such as `gold`.
    Library {
        /// The entry of the material in the library.
        material: &'static LibraryMaterial,
        /// The color that the material is given. `None` if the material has fixed colors.
        color: Option<Color>,
    },
    /// The checkered pattern of the ground, which is the default for planes.
    Checkered,
    /// The name of a POV-Ray texture that an include file declares.
    Texture(Arc<str>),
    /// POV-Ray code for the material.
    Sdl(Arc<str>),
}

impl Look {
    /// Returns the single color of the look. `None` for patterns, and for looks that only POV-Ray knows. Scripts, trails, ghosts and
    /// the preview take their color from here.
    pub fn color(&self) -> Option<Color> {
        match self {
            Look::Plain { color, .. } => Some(*color),
            Look::Library { color, .. } => *color,
            Look::Checkered | Look::Texture(_) | Look::Sdl(_) => None,
        }
    }

    /// Returns the same look in another color. A look whose color is fixed stays.
    #[must_use]
    pub fn with_color(&self, new: Color) -> Look {
        match self {
            Look::Plain { finish, .. } => Look::Plain { color: new, finish: *finish },
            Look::Library { material, color: Some(_) } => Look::Library { material, color: Some(new) },
            other => other.clone(),
        }
    }

    /// Returns whether the look has no pattern, so that rotating a ball with this look changes nothing in the picture.
    pub fn is_uniform(&self) -> bool {
        match self {
            Look::Plain { .. } => true,
            Look::Library { material, .. } => material.pattern == Pattern::None,
            Look::Checkered | Look::Texture(_) | Look::Sdl(_) => false,
        }
    }

    /// Returns whether the look emits light. A lamp inside a body with such a look must shine through the surface.
    pub fn glows(&self) -> bool {
        match self {
            Look::Plain { finish, .. } => *finish == Finish::Luminous,
            Look::Library { material, .. } => material.glows(),
            Look::Checkered | Look::Texture(_) | Look::Sdl(_) => false,
        }
    }
}

/// The finish of a surface: how it reflects light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// A surface like chalk, without a highlight.
    Matte,
    /// A surface like eggshell, with a soft highlight.
    Satin,
    /// A surface like enamel, with a sharp highlight. This is the default.
    Glossy,
    /// A surface of polished metal in the material's color.
    Metal,
    /// A perfect mirror.
    Mirror,
    /// A surface that emits light evenly.
    Luminous,
}

impl Finish {
    /// All finishes.
    pub const ALL: [Finish; 6] =
        [Finish::Matte, Finish::Satin, Finish::Glossy, Finish::Metal, Finish::Mirror, Finish::Luminous];

    /// Returns the finish with this name. `None` for an unknown name.
    pub fn named(name: &str) -> Option<Finish> {
        Finish::ALL.into_iter().find(|finish| finish.name() == name)
    }

    /// Returns the name of the finish in scenes and templates.
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

    /// Returns a short description of the finish.
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

/// A camera. If a location or target is missing, jabuka derives it from the motion of the bodies.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The initial location of the camera, m. `None` for a location that jabuka derives, or that follows measures.
    pub location: Option<DVec3>,
    /// The initial target of the camera, m: the point in the middle of the picture. `None` for a target that jabuka derives, or that follows
    /// measures.
    pub look_at: Option<DVec3>,
    /// The direction that points up in the picture, a unit vector. `None` for the vertical.
    pub up: Option<DVec3>,
    /// The initial angle by which the camera is turned about its line of sight, degrees: clockwise as seen from behind it.
    pub roll: f64,
    /// The motion of the camera, such as an orbit around its target.
    pub motion: CameraMotion,
    /// The part of the motion that a camera without a location shows. `None` for a part that jabuka chooses.
    pub auto: Option<Auto>,
    /// The projection of the camera: perspective, orthographic or spherical.
    pub projection: Projection,
    /// The distance of the eye to the right of the camera, m; negative to the left. 0 for a camera that is not one of two eyes.
    pub eye: f64,
    /// The blur of objects that are out of focus. `None` if all objects are sharp.
    pub blur: Option<Blur>,
    /// The shutter, which gives motion blur. `None` for frames without motion blur.
    pub shutter: Option<Shutter>,
}

impl Camera {
    /// Returns a camera that stands still, with a horizontal field of view in degrees.
    #[cfg(feature = "preview")]
    pub(crate) fn standing(location: DVec3, look_at: DVec3, angle: f64) -> Camera {
        Camera {
            location: Some(location),
            look_at: Some(look_at),
            up: None,
            roll: 0.0,
            motion: CameraMotion::default(),
            auto: None,
            projection: Projection::Perspective { angle },
            eye: 0.0,
            blur: None,
            shutter: None,
        }
    }

    /// Returns true if the camera is given the same point as location and as target. POV-Ray draws nothing useful if rounding errors exceed
    /// their distance.
    pub(crate) fn is_at_target(&self) -> bool {
        let points = self.location.zip(self.look_at);
        points.is_some_and(|(location, look_at)| {
            location.distance(look_at) <= 1e-9 * location.abs().max(look_at.abs()).max_element()
        })
    }
}

/// The part of the motion that a camera without a location shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Auto {
    /// The motion of the whole run, by a camera that stands still.
    Whole,
    /// What moves at each time, by a camera that goes along smoothly.
    Track,
}

impl Auto {
    /// Both parts.
    pub const ALL: [Auto; 2] = [Auto::Whole, Auto::Track];

    /// Returns the name of the part in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Auto::Whole => "whole",
            Auto::Track => "track",
        }
    }
}

impl Camera {
    /// Returns the formulas of measures that the camera follows.
    pub fn formulas(&self) -> impl Iterator<Item = &MeasureFormula> {
        let CameraMotion { location, look_at, angle, roll, .. } = &self.motion;
        let points = [location, look_at].into_iter().flatten().flat_map(VaryingPoint::formulas);
        points.chain(angle.iter().chain(roll).filter_map(Varying::formula))
    }
}

/// The motion of a camera. A quantity that is `None` keeps its initial value.
#[derive(Clone, Debug, Default)]
pub struct CameraMotion {
    /// The location of the camera as a function of time and of measures, m.
    pub location: Option<VaryingPoint>,
    /// The target of the camera as a function of time and of measures, m: the point in the middle of the picture.
    pub look_at: Option<VaryingPoint>,
    /// The horizontal field of view of a perspective camera as a function of time and of measures, degrees.
    pub angle: Option<Varying>,
    /// The angle by which the camera is turned about its line of sight as a function of time and of measures, degrees.
    pub roll: Option<Varying>,
    /// The body that the camera follows. `None` if the camera follows no body.
    pub follow: Option<Follow>,
    /// The period of the camera's orbit about the upward axis through its target, s.
    pub orbit: Option<f64>,
}

/// The settings of a camera that follows a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// The index of the body that the camera follows.
    pub body: usize,
    /// The distance of the camera from the body, m. `None` to keep the initial distance.
    pub distance: Option<f64>,
    /// The delay of the camera behind the body, s: the time constant of a first-order lag. `None` if the camera has no delay.
    pub lag: Option<f64>,
}

impl CameraMotion {
    /// Returns whether the camera changes from frame to frame.
    pub fn moves(&self) -> bool {
        self.location.is_some()
            || self.look_at.is_some()
            || self.angle.is_some()
            || self.roll.is_some()
            || self.follow.is_some()
            || self.orbit.is_some()
    }
}

/// The projection with which a camera maps the scene to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A perspective projection, in which distant objects look smaller.
    Perspective {
        /// The horizontal field of view, degrees, as in POV-Ray.
        angle: f64,
    },
    /// A parallel projection, as in a technical drawing, in which the distance does not change the size.
    Orthographic {
        /// The width of the visible area, m. `None` for a width that fits the motion.
        width: Option<f64>,
    },
    /// A picture of all directions around the camera, for 360° viewers: 360° wide and 180° high, with its middle towards the camera's target.
    Spherical,
}

impl Projection {
    /// The names of all projections in scenes.
    pub const NAMES: [&'static str; 3] = ["perspective", "orthographic", "spherical"];

    /// The width of a spherical picture, which shows 360°, divided by its height, which shows 180°.
    pub const SPHERICAL_ASPECT: u32 = 2;
}

/// The blur of objects that are out of focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blur {
    /// The diameter of the camera's lens, m.
    pub aperture: f64,
    /// The point in focus, m. `None` for the camera's target.
    pub focus: Option<DVec3>,
    /// The number of rays per pixel with which POV-Ray computes the blur.
    pub samples: u32,
}

/// The shutter of a camera, for motion blur: an image is the mean of several moments while the shutter is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// The time for which the shutter is open, s. It is greater than 0. The shutter opens at the time of the frame.
    pub open: f64,
    /// The number of moments that are averaged in one image.
    pub samples: u32,
}

impl Light {
    /// Returns whether the light moves.
    pub fn moves(&self) -> bool {
        match &self.kind {
            LightKind::Point { location } | LightKind::Area { location, .. } => location.changes(),
            LightKind::Sun { .. } => false,
        }
    }

    /// Returns the formulas of measures that the light follows.
    pub fn formulas(&self) -> impl Iterator<Item = &MeasureFormula> {
        let location = match &self.kind {
            LightKind::Point { location } | LightKind::Area { location, .. } => Some(location),
            LightKind::Sun { .. } => None,
        };
        location.into_iter().flat_map(VaryingPoint::formulas)
    }
}

impl Shutter {
    /// Returns the times of the moments in one image, s. `begin` is the time at which the shutter opens. Each moment is in the middle of
    /// one of `samples` equal intervals.
    pub fn moments(self, begin: f64) -> impl ExactSizeIterator<Item = f64> {
        (0..self.samples).map(move |i| begin + self.open * (f64::from(i) + 0.5) / f64::from(self.samples))
    }
}

/// An additional camera, from `[view.NAME]`.
#[derive(Clone, Debug)]
pub struct View {
    /// The name of the view, unique among views. It consists of letters, digits, `-` and `_`.
    pub name: String,
    /// The camera of the view. Values that the view does not give come from `[camera]`.
    pub camera: Camera,
}

/// A light source of the scene.
#[derive(Clone, Debug)]
pub struct Light {
    /// The name of the light, unique among lights.
    pub name: String,
    /// The kind of the light, with its location or direction.
    pub kind: LightKind,
    /// The color of the light.
    pub color: Color,
    /// The brightness of the light. At 1, a white surface that faces the light looks white.
    pub intensity: f64,
    /// Whether the light casts shadows and highlights.
    pub shadows: bool,
}

/// The kinds of light sources.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// A point light, which shines in all directions.
    Point {
        /// The location of the light as a function of time, m.
        location: VaryingPoint,
    },
    /// A light with a size, which gives soft shadows.
    Area {
        /// The center of the light as a function of time, m.
        location: VaryingPoint,
        /// The diameter of the light source, m.
        size: f64,
    },
    /// A light with parallel rays, like sunlight.
    Sun {
        /// The direction in which the light travels, a unit vector.
        direction: DVec3,
    },
}

/// The surroundings of a scene: ground, sky and fog.
#[derive(Clone, Debug)]
pub struct Environment {
    /// The preset, which supplies the values that the scene does not give.
    pub preset: Preset,
    /// The checkered ground. `None` if the scene has no ground.
    pub ground: Option<Ground>,
    /// The look of the sky.
    pub sky: Sky,
    /// Whether the ground fades into haze at the horizon.
    pub fog: bool,
}

impl Environment {
    /// Returns whether the sky is dark. Text in front of a dark sky must be light.
    pub fn is_dark(&self) -> bool {
        match self.sky {
            Sky::Gradient => matches!(self.preset, Preset::Night | Preset::Blackboard | Preset::Space),
            Sky::Plain(Color([red, green, blue])) => 0.3 * red + 0.6 * green + 0.1 * blue < 0.4,
        }
    }
}

/// The checkered ground. If a value is missing, jabuka derives it from the motion of the bodies.
#[derive(Clone, Debug, Default)]
pub struct Ground {
    /// The y coordinate of the ground, m. `None` for a height that jabuka derives.
    pub height: Option<f64>,
    /// The edge length of one tile, m. `None` for a length that jabuka derives.
    pub tile: Option<f64>,
    /// The contact properties of the ground. `None` if bodies pass through the ground.
    pub surface: Option<Surface>,
}

/// The look of the sky.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// The color gradient of the preset.
    Gradient,
    /// A single color for the whole sky.
    Plain(Color),
}

/// The POV-Ray code of a scene, and its settings for POV-Ray.
#[derive(Clone, Debug)]
pub struct PovRay {
    /// The include files of the scene's POV-Ray code.
    pub include: Vec<Include>,
    /// The assets: files in the scene's folder that its POV-Ray code reads. They are copied beside the scripts.
    pub assets: Vec<Asset>,
    /// The files that the POV-Ray code of a trusted scene names: the kind of each file, and its name in the code.
    pub reads: Vec<(FileKind, String)>,
    /// The POV-Ray code that scripts contain before the bodies, in pieces. Empty without such code.
    pub sdl: Vec<SdlPiece>,
    /// The length of one POV-Ray unit, m. `None` for a unit that jabuka derives from the size of the scene.
    pub unit: Option<f64>,
    /// The number of significant digits of numbers in scripts.
    pub digits: usize,
    /// The user's templates. They replace the built-in templates with the same names.
    pub templates: Vec<OwnTemplate>,
}

/// A piece of the scene's POV-Ray code.
#[derive(Clone, Debug)]
pub enum SdlPiece {
    /// Code that is the same in all scripts.
    Sdl(String),
    /// The value of a formula at the time of the frame.
    Value {
        /// The formula as it is written in the scene.
        text: String,
        /// The formula.
        formula: MeasureFormula,
    },
}

impl SdlPiece {
    /// Returns the formula of the piece. `None` if the piece is the same in all scripts.
    pub fn formula(&self) -> Option<&MeasureFormula> {
        match self {
            SdlPiece::Sdl(_) => None,
            SdlPiece::Value { formula, .. } => Some(formula),
        }
    }
}

/// A script template of the user.
#[derive(Clone, Debug)]
pub struct OwnTemplate {
    /// The name of the template, such as `frame.pov`.
    pub name: String,
    /// The path of the template's file, for diagnostics.
    pub path: String,
    /// The text of the template's file.
    pub text: String,
}

/// An include file of the scene's POV-Ray code.
#[derive(Clone, Debug)]
pub enum Include {
    /// An include file of POV-Ray's standard library, by its name.
    Standard(String),
    /// An include file in the scene's folder.
    Text {
        /// The name of the file in the scene.
        name: String,
        /// The text of the include file.
        text: String,
    },
}

/// The settings for the images, the scripts and the video.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// The width of an image, pixels.
    pub width: u32,
    /// The height of an image, pixels.
    pub height: u32,
    /// Where the code that all scripts share is written.
    pub layout: Layout,
    /// Whether images have a transparent background instead of the sky and the ground.
    pub transparent: bool,
    /// The frame rate of the video, frames per second. `None` for the frame rate of the simulation, or for 25 if that rate is not from 1
    /// to 120.
    pub video_rate: Option<f64>,
    /// The sign before the decimals of numbers in pictures.
    pub decimal: DecimalSign,
}

/// The sign before the decimals of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DecimalSign {
    /// A point, as in English.
    #[default]
    Point,
    /// A comma, as in most languages of Europe.
    Comma,
}

impl DecimalSign {
    /// All signs.
    pub const ALL: [DecimalSign; 2] = [DecimalSign::Point, DecimalSign::Comma];

    /// Returns the sign as scenes write it.
    pub fn name(self) -> &'static str {
        match self {
            DecimalSign::Point => ".",
            DecimalSign::Comma => ",",
        }
    }
}

/// Where the code that all scripts share is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// The shared code is in each script, so that a computer of a cluster needs only one file.
    SelfContained,
    /// The shared code is in a separate file that each script includes.
    Shared,
}

impl Layout {
    /// All script layouts.
    pub const ALL: [Layout; 2] = [Layout::SelfContained, Layout::Shared];

    /// Returns the name of the layout in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Layout::SelfContained => "self-contained",
            Layout::Shared => "shared",
        }
    }
}
