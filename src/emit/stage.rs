//! What surrounds the bodies: camera, lights, ground, sky, each as given or as it follows from the motion; in
//! POV-Ray's units, as templates see it.

use glam::{DQuat, DVec3};
use serde::Serialize;

use super::camera::{self, CameraText, Placed};
use super::framing;
use super::screen::Screen;
use crate::scene::{Body, Camera, Environment, Light, LightKind, Scene, Sky};
use crate::simulate::{Bounds, Survey};

/// What surrounds the bodies. Lengths are in POV-Ray's units.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Stage {
    /// The length of one unit, m.
    pub(super) unit: f64,
    /// The diagonal of the box in which everything takes place.
    size: f64,
    /// The middle of that box.
    center: [f64; 3],
    /// The camera, if it is the same in all frames.
    camera: Option<CameraText>,
    /// The lights, if they are the same in all frames; an empty list means the usual ones.
    lights: Option<Vec<LightText>>,
    /// What is not the same in all frames.
    #[serde(skip)]
    pub(super) moving: Moving,
    ground: Option<GroundText>,
    /// The edge of a tile of a checkered plane.
    tile: f64,
    /// The distance from the middle over which its tiles fade.
    tiles_fade: f64,
    /// The distance from the middle over which ground and checkered planes fade into the horizon.
    fade: f64,
    /// The name of the surroundings.
    preset: &'static str,
    /// The ambient light, linear; none: as materials expect it.
    ambient: Option<[f64; 3]>,
    sky: SkyText,
    /// Whether there is nothing behind the bodies.
    transparent: bool,
    fog: bool,
    /// Where everything takes place, for what is measured there.
    #[serde(skip)]
    pub(super) scenery: Scenery,
    /// The number of a body that POV-Ray may not draw.
    #[serde(skip)]
    pub(super) too_thin: Option<usize>,
    /// How many pixels the largest body is wide in the middle of the picture, if that is too little to be seen.
    #[serde(skip)]
    pub(super) too_small: Option<f64>,
}

/// Where everything takes place, in metres, and how it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scenery {
    /// The box in which everything takes place, not rounded.
    pub(super) bounds: Bounds,
    /// The height of the ground, or where it would be.
    pub(super) ground: f64,
    /// The edge of one of its tiles.
    pub(super) tile: f64,
    /// The width of a line that is well seen in the middle of the motion.
    pub(super) stroke: f64,
    /// The plane on which texts stand.
    pub(super) screen: Screen,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct LightText {
    name: String,
    /// `point`, `area` or `sun`.
    kind: &'static str,
    /// Where it is; of a sun: a point that its light comes from.
    location: [f64; 3],
    /// Of an area light: its diameter.
    size: Option<f64>,
    /// Its color times its intensity, linear.
    color: [f64; 3],
    shadows: bool,
}

#[derive(Clone, Debug, Serialize)]
struct GroundText {
    height: f64,
    tile: f64,
    /// The distance from the middle over which the tiles fade.
    tiles_fade: f64,
}

#[derive(Clone, Debug, Serialize)]
struct SkyText {
    /// The color of a plain sky in sRGB; none is the usual sky.
    color: Option<[f64; 3]>,
}

/// Where there is nothing to see, this is looked at.
const NOTHING: Bounds = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };

impl Stage {
    /// The surroundings of a scene whose run has been looked over.
    pub(super) fn new(scene: &Scene, given: &Camera, survey: &Survey) -> Stage {
        let exact = survey.bounds.unwrap_or(NOTHING);
        let bounds = framing::rounded_outward(exact);
        // What stands around is made for the bodies; arrows and axes are no reason to lower the ground.
        let seen = survey.seen.map_or(bounds, framing::rounded_outward);
        let camera = Placed::new(given, seen, scene.output);
        let center = (bounds.min + bounds.max) / 2.0;
        let size = two_digits_up((bounds.max - bounds.min).length());
        let distance = camera.location.distance(center);
        let thinnest = thinnest(scene);
        let unit =
            scene.povray.unit.unwrap_or_else(|| unit(reach(bounds, &camera), thinnest.map(|(_, half)| half)));

        let around = scene.environment.ground.as_ref();
        let ground_height =
            around.and_then(|ground| ground.height).unwrap_or_else(|| just_under(exact.min.y, size));
        let tile_of_ground = around.and_then(|ground| ground.tile).unwrap_or_else(|| tile(size));
        let ground = around.filter(|_| !scene.output.transparent).map(|_| {
            let tile = tile_of_ground;
            GroundText {
                height: ground_height / unit,
                tile: tile / unit,
                // Tiles that are given may be larger than all that moves.
                tiles_fade: (4.5 * size).max(38.0 * tile) / unit,
            }
        });
        let sky = match scene.environment.sky {
            Sky::Gradient => SkyText { color: None },
            Sky::Plain(color) => SkyText { color: Some(color.0) },
        };
        let lights = Lights { lights: scene.lights.clone(), center, reach: size.max(distance), unit };
        let lights_move = scene.lights.iter().any(Light::moves);
        let still = (!lights_move).then(|| lights.at(0.0));
        let too_small = largest_in_pixels(scene, &camera, distance).filter(|&pixels| pixels < SMALLEST_SEEN);
        let fixed = (!given.motion.moves()).then(|| camera.text(unit));
        let scenery = Scenery {
            bounds: exact,
            ground: ground_height,
            tile: tile_of_ground,
            stroke: STROKE * camera.width_at(distance),
            screen: camera.screen(),
        };
        Stage {
            camera: fixed,
            moving: Moving {
                camera: camera::Moving::new(given, camera, &scene.bodies, unit),
                lights: lights_move.then_some(lights),
            },
            too_small,
            unit,
            size: size / unit,
            center: (center / unit).to_array(),
            lights: still,
            ground,
            tile: tile(size) / unit,
            tiles_fade: 4.5 * size / unit,
            // From far away, more of the ground is to be seen.
            fade: 11.0 * size.max(distance / 2.0) / unit,
            preset: scene.environment.preset.name(),
            ambient: Some(ambient(&scene.environment)).filter(|ambient| *ambient != [1.0; 3]),
            sky,
            transparent: scene.output.transparent,
            fog: scene.environment.fog,
            scenery,
            too_thin: thinnest.filter(|(_, half)| half / unit < THINNEST * 0.99).map(|(id, _)| id),
        }
    }
}

/// The ambient light, linear: that of the preset, or what a plain sky sends.
fn ambient(environment: &Environment) -> [f64; 3] {
    match environment.sky {
        Sky::Gradient => environment.preset.ambient(),
        // A plain sky of a light gray is as bright as the usual one. A little is left below a black one, since no
        // place is quite without light.
        Sky::Plain(color) => color.linear().map(|c| (0.03 + 1.6 * c).min(1.0)),
    }
}

/// A positive number rounded up to two digits.
fn two_digits_up(number: f64) -> f64 {
    let step = framing::decimal_step(number) / 10.0;
    (number / step - 1e-6).ceil() * step
}

/// What surrounds the bodies and is not the same in all frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Moving {
    pub(super) camera: Option<camera::Moving>,
    pub(super) lights: Option<Lights>,
}

/// Lights that move.
#[derive(Clone, Debug)]
pub(super) struct Lights {
    lights: Vec<Light>,
    center: DVec3,
    reach: f64,
    unit: f64,
}

impl Lights {
    /// The lights at a time, s.
    pub(super) fn at(&self, time: f64) -> Vec<LightText> {
        self.lights.iter().map(|l| light(l, time, self.center, self.reach, self.unit)).collect()
    }

    /// What suns shine at.
    pub(super) fn center(&self) -> [f64; 3] {
        (self.center / self.unit).to_array()
    }
}

fn light(light: &Light, time: f64, center: DVec3, reach: f64, unit: f64) -> LightText {
    let (kind, location, size) = match &light.kind {
        LightKind::Point { location } => ("point", location.at(time), None),
        LightKind::Area { location, size } => ("area", location.at(time), Some(*size)),
        // Far enough to be outside of everything; its rays are parallel anyway.
        LightKind::Sun { direction } => ("sun", center - *direction * reach * 10.0, None),
    };
    LightText {
        name: light.name.clone(),
        kind,
        location: (location / unit).to_array(),
        size: size.map(|size| size / unit),
        color: light.color.linear().map(|c| c * light.intensity),
        shadows: light.shadows,
    }
}

/// The thinnest body and half its thickness, m; none where there is no body with a size.
fn thinnest(scene: &Scene) -> Option<(usize, f64)> {
    let halves =
        scene.bodies.iter().enumerate().filter_map(|(id, body)| Some((id, body.drawn().half_thickness()?)));
    halves.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The largest number that a script of the scene has to hold, m: POV-Ray counts from its origin.
fn reach(bounds: Bounds, camera: &Placed) -> f64 {
    let farthest = |point: DVec3| point.abs().max_element();
    let size = (bounds.max - bounds.min).length();
    let points = [bounds.min, bounds.max, camera.location, camera.look_at];
    points.into_iter().map(farthest).fold(size, f64::max)
}

/// Half the thickness, in POV-Ray's units, below which it gets edges and shadows wrong, since places nearer than 0.001
/// are one to it. Measured on POV-Ray 3.7.
const THINNEST: f64 = 0.01;

/// The length of a unit of POV-Ray's for a scene of the given reach, whose thinnest body is as thick as given, m.
///
/// What is farther than 10⁵ comes near to the 10⁷ at which POV-Ray 3.7 stops to look.
fn unit(reach: f64, thinnest: Option<f64>) -> f64 {
    const FARTHEST: f64 = 1e5;
    let thinnest = thinnest.unwrap_or(THINNEST);
    // The powers of ten at or above what the far, at or below what the thin asks for; the far is asked first.
    let far = 1.0 / framing::decimal_step(FARTHEST / reach);
    let thin = framing::decimal_step(thinnest / THINNEST);
    if thinnest >= THINNEST && reach <= FARTHEST {
        1.0
    } else if reach > FARTHEST {
        far
    } else {
        thin.max(far)
    }
}

/// The width of lines, as part of the picture's: four pixels of 1280.
const STROKE: f64 = 0.0031;

/// So many pixels across, a body is a dot.
const SMALLEST_SEEN: f64 = 4.0;

/// The width of the largest body in the picture, if it is as far from the camera as the middle of the motion.
fn largest_in_pixels(scene: &Scene, camera: &Placed, distance: f64) -> Option<f64> {
    let reach = |body: &Body| body.drawn().support(DQuat::IDENTITY, DVec3::Y);
    let largest = scene.bodies.iter().filter_map(reach).reduce(f64::max)?;
    Some(camera.pixels(largest, distance))
}

/// A height just under the lowest point of the motion.
fn just_under(lowest: f64, size: f64) -> f64 {
    let step = framing::decimal_step(size) / 100.0;
    (lowest / step - 0.1).floor() * step
}

/// The edge of a ground tile for a scene of the given size: 1, 2 or 5 times a power of ten.
fn tile(size: f64) -> f64 {
    let wanted = size / 12.0;
    let decade = framing::decimal_step(wanted);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    let nearness = |step: &f64| (libm::log(step / wanted)).abs();
    steps.into_iter().min_by(|a, b| nearness(a).total_cmp(&nearness(b))).unwrap_or(decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_is_1_where_povray_can_draw_so() {
        assert_eq!([unit(100.0, Some(0.01)), unit(1e5, Some(1.0)), unit(1.0, None)], [1.0, 1.0, 1.0]);
    }

    #[test]
    fn other_units_keep_the_scene_within_reach_and_thin_bodies_thick_enough() {
        for (reach, thinnest) in
            [(1e-9, 1e-10), (1e13, 6e6), (1e11, 1e8), (2.0, 0.004), (3e5, 50.0), (0.2, 1e-4)]
        {
            let unit = unit(reach, Some(thinnest));
            assert!(
                reach / unit <= 1.000_001e5 && thinnest / unit >= THINNEST * 0.99,
                "{reach} {thinnest}: {unit}"
            );
            assert!((libm::log10(unit) - libm::log10(unit).round()).abs() < 1e-9, "{unit} is a power of ten");
        }
    }

    #[test]
    fn the_ground_is_under_the_lowest_point_but_not_far() {
        for (lowest, size) in [(-2.0, 84.0), (0.0, 3.0), (1.234, 0.5), (-1e-9, 1e-9), (7e12, 1e13)] {
            let ground = just_under(lowest, size);
            assert!(ground < lowest && lowest - ground < size / 50.0, "{lowest} {size}: {ground}");
        }
    }

    #[test]
    fn tiles_are_round_and_about_a_twelfth_of_the_scene() {
        assert_eq!([tile(84.0), tile(12.0), tile(30.0)], [5.0, 1.0, 2.0]);
        for size in [0.003, 0.7, 55.0, 1e4] {
            assert!(
                (size / tile(size) / 12.0).clamp(0.6, 1.7) == size / tile(size) / 12.0,
                "{size}: {}",
                tile(size)
            );
        }
    }
}
