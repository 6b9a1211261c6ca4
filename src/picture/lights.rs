//! The lights that a scene gives, at a moment.

use glam::DVec3;

use crate::scene::{Light, LightKind, Scene};

/// A light at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedLight {
    /// Its name in the scene.
    pub name: String,
    /// What it is.
    pub kind: Lamp,
    /// Where it is, m; of a sun: a point that its light comes from.
    pub location: DVec3,
    /// Of an area light: its diameter, m.
    pub size: Option<f64>,
    /// Its color times its intensity, linear.
    pub color: [f64; 3],
    /// Whether it casts shadows and highlights.
    pub shadows: bool,
}

/// What a light is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lamp {
    /// A lamp without size.
    Point,
    /// A lamp with a size.
    Area,
    /// Parallel light, which shines at the middle of the motion.
    Sun,
}

impl Lamp {
    /// Its name: `point`, `area` or `sun`.
    pub fn name(self) -> &'static str {
        match self {
            Lamp::Point => "point",
            Lamp::Area => "area",
            Lamp::Sun => "sun",
        }
    }
}

/// The lights of a scene.
#[derive(Clone, Debug)]
pub(super) struct Lights {
    lights: Vec<Light>,
    /// What suns shine at.
    center: DVec3,
    /// How far everything reaches, m.
    reach: f64,
}

impl Lights {
    pub(super) fn new(scene: &Scene, center: DVec3, reach: f64) -> Lights {
        Lights { lights: scene.lights.clone(), center, reach }
    }

    /// Whether they are not the same in all frames.
    pub(super) fn moves(&self) -> bool {
        self.lights.iter().any(Light::moves)
    }

    /// The lights at a time, s.
    pub(super) fn at(&self, time: f64) -> Vec<PlacedLight> {
        self.lights.iter().map(|light| self.light(light, time)).collect()
    }

    fn light(&self, light: &Light, time: f64) -> PlacedLight {
        let (kind, location, size) = match &light.kind {
            LightKind::Point { location } => (Lamp::Point, location.at(time), None),
            LightKind::Area { location, size } => (Lamp::Area, location.at(time), Some(*size)),
            // Far enough to be outside of everything; its rays are parallel anyway.
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
