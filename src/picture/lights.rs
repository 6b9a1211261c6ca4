//! The lights of a scene at a given time, and the default lights.

use glam::DVec3;

use super::followed::FollowedValues;
use super::stage::Stage;
use crate::scene::{Color, Light, LightKind, MeasureFormula, Preset, Scene};
use crate::simulate::Frame;

/// A light at a given time.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedLight {
    /// The name of the light in the scene.
    pub name: String,
    /// The kind of the light.
    pub kind: Lamp,
    /// The position of the light in the world, m. For a sun, a far point in the direction from which its light comes.
    pub location: DVec3,
    /// The diameter of an area light, m. `None` for other lights.
    pub size: Option<f64>,
    /// The linear color of the light, multiplied by its intensity.
    pub color: [f64; 3],
    /// True if the light casts shadows and makes highlights.
    pub shadows: bool,
}

/// The kind of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lamp {
    /// A lamp without size, whose shadows have sharp edges.
    Point,
    /// A lamp with a size, whose shadows have soft edges.
    Area,
    /// A distant light whose parallel rays shine towards the middle of the motion.
    Sun,
}

impl Lamp {
    /// The name of the kind: `point`, `area` or `sun`.
    pub fn name(self) -> &'static str {
        match self {
            Lamp::Point => "point",
            Lamp::Area => "area",
            Lamp::Sun => "sun",
        }
    }
}

/// A default light. Lengths are relative to the size of the stage.
struct DefaultLight {
    name: &'static str,
    /// The position relative to the middle of the stage.
    location: [f64; 3],
    /// The diameter of an area light. `None` for a point light.
    size: Option<f64>,
    color: UsualColor,
    shadows: bool,
}

/// A linear or sRGB color, which may be brighter than white.
enum UsualColor {
    Linear([f64; 3]),
    Srgb([f64; 3]),
}

/// The default lights of an environment. They equal those in `templates/lights.inc`; a test in `emit` compares them.
fn usual(preset: Preset) -> &'static [DefaultLight] {
    use UsualColor::{Linear, Srgb};
    const SUN: DefaultLight = DefaultLight {
        name: "sun",
        location: [-30.0, 16.0, 26.0],
        size: None,
        color: Linear([1.25, 1.22, 1.15]),
        shadows: true,
    };
    const MOON: DefaultLight = DefaultLight {
        name: "moon",
        location: [-20.0, 20.0, 10.0],
        size: Some(0.6),
        color: Linear([0.4, 0.47, 0.62]),
        shadows: true,
    };
    const SOFT: [DefaultLight; 2] = [
        DefaultLight {
            name: "lamp",
            location: [-13.0, 24.0, 12.0],
            size: Some(6.0),
            color: Linear([0.95; 3]),
            shadows: true,
        },
        DefaultLight {
            name: "fill",
            location: [18.0, 3.0, 18.0],
            size: None,
            color: Linear([0.16; 3]),
            shadows: false,
        },
    ];
    const WARM: [DefaultLight; 3] = [
        DefaultLight {
            name: "lamp",
            location: [-13.0, 22.0, 16.0],
            size: Some(3.6),
            color: Srgb([1.1, 1.067, 1.012]),
            shadows: true,
        },
        DefaultLight {
            name: "fill",
            location: [7.0, -2.5, 7.0],
            size: None,
            color: Srgb([0.5, 0.52, 0.56]),
            shadows: false,
        },
        DefaultLight {
            name: "rim",
            location: [9.0, -1.5, -9.0],
            size: None,
            color: Srgb([0.48, 0.52, 0.58]),
            shadows: false,
        },
    ];
    match preset {
        Preset::Space => &[SUN],
        Preset::Night => &[MOON],
        Preset::Studio | Preset::Paper => &SOFT,
        Preset::Daylight | Preset::Blackboard => &WARM,
    }
}

/// The default lights around a stage, in world coordinates.
pub(super) fn usual_lights(stage: &Stage) -> Vec<PlacedLight> {
    let place = |light: &DefaultLight| PlacedLight {
        name: light.name.to_owned(),
        kind: if light.size.is_some() { Lamp::Area } else { Lamp::Point },
        location: stage.center + DVec3::from_array(light.location) * stage.size,
        size: light.size.map(|size| size * stage.size),
        color: match light.color {
            UsualColor::Linear(color) => color,
            UsualColor::Srgb(color) => Color(color).linear(),
        },
        shadows: light.shadows,
    };
    usual(stage.preset).iter().map(place).collect()
}

/// The lights that a scene gives.
#[derive(Clone, Debug)]
pub(super) struct Lights {
    lights: Vec<Light>,
    /// The point that all suns shine at, m.
    center: DVec3,
    /// The radius of the visible scene, m. Suns are placed far outside.
    reach: f64,
    followed: FollowedValues,
}

impl Lights {
    pub(super) fn new(scene: &Scene, center: DVec3, reach: f64, followed: &FollowedValues) -> Lights {
        Lights { lights: scene.lights.clone(), center, reach, followed: followed.clone() }
    }

    /// True if any of the lights moves.
    pub(super) fn moves(&self) -> bool {
        self.lights.iter().any(Light::moves)
    }

    /// True if a light, given by its index in the scene, follows measures.
    pub(super) fn follows_measures(&self, number: usize) -> bool {
        self.lights[number].formulas().next().is_some()
    }

    /// The lights in a frame.
    pub(super) fn at(&self, frame: &Frame) -> Vec<PlacedLight> {
        let value = self.followed.at(frame);
        self.lights.iter().map(|light| self.light(light, frame.time, &value)).collect()
    }

    /// The lights at the start of the run.
    pub(super) fn at_start(&self) -> Vec<PlacedLight> {
        let value = self.followed.at_start();
        self.lights.iter().map(|light| self.light(light, 0.0, &value)).collect()
    }

    fn light(&self, light: &Light, time: f64, value: impl Fn(&MeasureFormula) -> f64) -> PlacedLight {
        let (kind, location, size) = match &light.kind {
            LightKind::Point { location } => (Lamp::Point, location.at(time, value), None),
            LightKind::Area { location, size } => (Lamp::Area, location.at(time, value), Some(*size)),
            // The distance is large enough to be outside the scene. It has no other effect, since the rays are parallel.
            LightKind::Sun { direction } => (Lamp::Sun, self.center - *direction * self.reach * 10.0, None),
        };
        PlacedLight {
            name: light.name.clone(),
            kind,
            location,
            size,
            color: light.color.linear().map(|c| c * light.intensity),
            shadows: light.shadows,
        }
    }
}
