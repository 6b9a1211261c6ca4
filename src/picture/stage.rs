//! What surrounds the bodies: ground, sky and haze, each as given or as it follows from the motion.

use glam::DVec3;

use super::camera::Placed;
use super::framing;
use super::scope::Part;
use crate::scene::{Color, Environment, GridPlane, Output, Preset, Scene, Sky};
use crate::simulate::Bounds;

/// What surrounds the bodies. Lengths are in metres.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The diagonal of the box in which everything takes place.
    pub size: f64,
    /// The middle of that box.
    pub center: DVec3,
    /// The ground, if one is seen.
    pub ground: Option<StageGround>,
    /// The edge of a tile of a checkered plane.
    pub tile: f64,
    /// The distance from the middle over which its tiles fade.
    pub tiles_fade: f64,
    /// The distance from the middle over which ground and checkered planes fade into the horizon.
    pub fade: f64,
    /// The surroundings, where nothing else is given.
    pub preset: Preset,
    /// The ambient light, linear; none: as materials expect it.
    pub ambient: Option<[f64; 3]>,
    /// The color of a plain sky; none is the usual sky of the preset.
    pub sky: Option<Color>,
    /// Whether there is nothing behind the bodies.
    pub transparent: bool,
    /// Whether the ground fades into haze.
    pub fog: bool,
    /// Where everything takes place, for what is measured there.
    pub scenery: Scenery,
    /// The box of the whole run, not rounded, also where the camera frames only its start.
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

/// Where everything takes place, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenery {
    /// The box in which everything takes place, not rounded.
    pub bounds: Bounds,
    /// The height of the ground, or where it would be.
    pub ground: f64,
    /// The edge of one of its tiles.
    pub tile: f64,
    /// The edge of a tile where none is given.
    pub usual_tile: f64,
    /// The distance between the lines of a grid where none is given.
    pub spacing: f64,
    /// The size of what is seen, m: of the motion, and of the air below it where the camera frames only a part of a fall.
    pub size: f64,
}

impl Scenery {
    /// What is measured where a camera frames the bounds `framed` and sees a width of `view` (m). The whole run takes
    /// place within `whole`, of which `framed` may be only a part.
    pub(super) fn new(scene: &Scene, framed: Bounds, whole: Bounds, view: f64, part: Part) -> Scenery {
        let around = scene.environment.ground.as_ref();
        let framed_size = size(framed);
        let ground =
            around.and_then(|ground| ground.height).unwrap_or_else(|| just_under(whole.min.y, framed_size));
        let deep = || two_digits_up((framed.max.y - ground).max(framed_size));
        // A camera that goes along with a body is nearly always high above the ground, and looks far.
        let (depth, far) = match part {
            Part::Whole => (0.0, 1.0),
            Part::Start(_) => (deep(), 1.0),
            Part::AroundBody(_) => (deep(), 2.0),
        };
        let size = far * framed_size.max(depth);
        // A camera near to a long motion sees little of it: then tiles are as large as fits its picture.
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

/// The spacing of a grid on the ground, whose lines are to be the edges of tiles, if it is fit for that.
fn ruled_tile(scene: &Scene, usual: f64) -> Option<f64> {
    let spacing = scene.grid.filter(|grid| grid.plane == GridPlane::Ground)?.spacing?;
    (0.1 * usual..10.0 * usual).contains(&spacing).then_some(spacing)
}

/// The width of a line that is well seen in a picture that shows a width of `view`, m.
pub(super) fn stroke(view: f64, output: Output) -> f64 {
    STROKE.max(LEAST_STROKE / f64::from(output.width)) * view
}

/// The diagonal of a box, rounded up.
fn size(bounds: Bounds) -> f64 {
    two_digits_up(framing::rounded_outward(bounds).diagonal())
}

/// The width of lines, as part of the picture's: four pixels of 1280.
const STROKE: f64 = 0.0031;
/// The least width of lines, pixels.
const LEAST_STROKE: f64 = 1.5;

impl Stage {
    /// The surroundings of a scene that a camera sees, whose whole run takes place within bounds.
    pub(super) fn new(scene: &Scene, scenery: Scenery, whole: Bounds, camera: &Placed) -> Stage {
        let bounds = framing::rounded_outward(scenery.bounds);
        let (center, size, far) = (bounds.middle(), size(scenery.bounds), scenery.size);
        let distance = camera.location().distance(center);
        let around = scene.environment.ground.as_ref();
        let ground = around.filter(|_| !scene.output.transparent).map(|_| StageGround {
            height: scenery.ground,
            tile: scenery.tile,
            // Tiles that are given may be larger than all that moves.
            tiles_fade: (4.5 * far).max(38.0 * scenery.tile),
        });
        Stage {
            size,
            center,
            ground,
            tile: scenery.usual_tile,
            tiles_fade: 4.5 * far,
            // From far away, more of the ground is to be seen.
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
