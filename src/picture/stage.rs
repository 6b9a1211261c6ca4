//! The surroundings of the bodies: ground, sky and haze, as given or chosen to fit the motion.

use glam::DVec3;

use super::camera::Placed;
use super::framing;
use super::scope::Part;
use crate::scene::{Color, Environment, GridPlane, Output, Preset, Scene, Sky};
use crate::simulate::Bounds;

/// The surroundings of the bodies. Lengths are in metres.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The diagonal of the box that contains the motion.
    pub size: f64,
    /// The middle of that box.
    pub center: DVec3,
    /// The ground, if it is visible.
    pub ground: Option<StageGround>,
    /// The edge of a tile of a checkered plane.
    pub tile: f64,
    /// The distance from the middle over which its tiles fade.
    pub tiles_fade: f64,
    /// The distance from the middle over which ground and checkered planes fade into the horizon.
    pub fade: f64,
    /// The preset for everything not given.
    pub preset: Preset,
    /// The ambient light, linear; none for the materials' default.
    pub ambient: Option<[f64; 3]>,
    /// The color of a plain sky; none for the sky of the preset.
    pub sky: Option<Color>,
    /// Whether the background is transparent.
    pub transparent: bool,
    /// Whether the ground fades into haze.
    pub fog: bool,
    /// The extent of the motion, and the sizes that follow from it.
    pub scenery: Scenery,
    /// The box of the whole run, not rounded, even if the camera frames only the start.
    pub whole: Bounds,
}

/// The ground. Lengths are in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageGround {
    /// Its height.
    pub height: f64,
    /// The edge of one of its tiles.
    pub tile: f64,
    /// The distance from the middle over which the tiles fade.
    pub tiles_fade: f64,
}

/// The extent of the motion and the sizes that follow from it, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenery {
    /// The box that contains the framed motion, not rounded.
    pub bounds: Bounds,
    /// The height of the ground, or where it would be.
    pub ground: f64,
    /// The edge of one of its tiles.
    pub tile: f64,
    /// The default edge of a tile.
    pub usual_tile: f64,
    /// The default distance between grid lines.
    pub spacing: f64,
    /// The size of the visible scene, m: of the motion and, if the camera frames part of a fall, of the air below.
    pub size: f64,
}

impl Scenery {
    /// The sizes for a camera that frames the bounds `framed` and sees a width of `view` (m). `framed` may be only a
    /// part of `whole`, the bounds of the run.
    pub(super) fn new(scene: &Scene, framed: Bounds, whole: Bounds, view: f64, part: Part) -> Scenery {
        let around = scene.environment.ground.as_ref();
        let framed_size = size(framed);
        let ground =
            around.and_then(|ground| ground.height).unwrap_or_else(|| just_under(whole.min.y, framed_size));
        let deep = || two_digits_up((framed.max.y - ground).max(framed_size));
        // A camera that follows a body is nearly always high above the ground, and sees far.
        let (depth, far) = match part {
            Part::Whole => (0.0, 1.0),
            Part::Start(_) => (deep(), 1.0),
            Part::AroundBody(_) => (deep(), 2.0),
        };
        let size = far * framed_size.max(depth);
        // A camera close to a long motion sees little of it. Then the tiles fit its picture.
        let fit = framed_size.min(two_digits_up(view));
        let usual_tile = tile(fit.max(depth));
        let given_tile = around.and_then(|ground| ground.tile).or(ruled_tile(scene, usual_tile));
        Scenery {
            bounds: framed,
            ground,
            tile: given_tile.unwrap_or(usual_tile),
            spacing: given_tile.unwrap_or(tile(fit)),
            usual_tile,
            size,
        }
    }
}

/// The spacing of a grid on the ground, if tiles of that size would do. Its lines then lie on the edges of tiles.
fn ruled_tile(scene: &Scene, usual: f64) -> Option<f64> {
    let spacing = scene.grid.filter(|grid| grid.plane == GridPlane::Ground)?.spacing?;
    (0.1 * usual..10.0 * usual).contains(&spacing).then_some(spacing)
}

/// The width of a clearly visible line in a picture `view` wide, m.
pub(super) fn stroke(view: f64, output: Output) -> f64 {
    STROKE.max(LEAST_STROKE / f64::from(output.width)) * view
}

/// The diagonal of a box, rounded up.
fn size(bounds: Bounds) -> f64 {
    two_digits_up(framing::rounded_outward(bounds).diagonal())
}

/// The width of lines, as part of the picture's width: four pixels of 1280.
const STROKE: f64 = 0.0031;
/// The least width of lines, pixels.
const LEAST_STROKE: f64 = 1.5;

impl Stage {
    /// The surroundings of a scene for a camera. `whole` contains the whole run.
    pub(super) fn new(scene: &Scene, scenery: Scenery, whole: Bounds, camera: &Placed) -> Stage {
        let bounds = framing::rounded_outward(scenery.bounds);
        let (center, size, far) = (bounds.middle(), size(scenery.bounds), scenery.size);
        let distance = camera.location().distance(center);
        let around = scene.environment.ground.as_ref();
        let ground = around.filter(|_| !scene.output.transparent).map(|_| StageGround {
            height: scenery.ground,
            tile: scenery.tile,
            // Given tiles may be larger than the whole motion.
            tiles_fade: (4.5 * far).max(38.0 * scenery.tile),
        });
        Stage {
            size,
            center,
            ground,
            tile: scenery.usual_tile,
            tiles_fade: 4.5 * far,
            // From far away, more of the ground is visible.
            fade: 11.0 * far.max(distance / 2.0),
            preset: scene.environment.preset,
            ambient: Some(ambient(&scene.environment)).filter(|ambient| *ambient != [1.0; 3]),
            sky: match scene.environment.sky {
                Sky::Gradient => None,
                Sky::Plain(color) => Some(color),
            },
            transparent: scene.output.transparent,
            fog: scene.environment.fog,
            scenery,
            whole,
        }
    }
}

/// The ambient light, linear: of the preset, or from a plain sky.
fn ambient(environment: &Environment) -> [f64; 3] {
    match environment.sky {
        Sky::Gradient => environment.preset.ambient(),
        // A light gray plain sky is as bright as the usual one. Even a black sky leaves a little light.
        Sky::Plain(color) => color.linear().map(|c| (0.03 + 1.6 * c).min(1.0)),
    }
}

/// A positive number rounded up to two digits.
fn two_digits_up(number: f64) -> f64 {
    let step = framing::decimal_step(number) / 10.0;
    (number / step - 1e-6).ceil() * step
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
