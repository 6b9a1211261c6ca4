//! The surroundings of the bodies: ground, sky and haze, as the scene gives them, or chosen to fit the motion.

use glam::DVec3;

use super::camera::Placed;
use super::framed_run::{FramedPart, FramedRun};
use super::framing;
use crate::decimal::decimal_step;
use crate::scene::{Color, Environment, GridPlane, Output, Preset, Scene, Sky};
use crate::simulate::Bounds;

/// The surroundings of the bodies. Lengths are in meters.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The diagonal of the box around the framed motion, rounded up.
    pub size: f64,
    /// The center of the box around the framed motion.
    pub center: DVec3,
    /// The ground below the bodies. `None` if no ground is drawn.
    pub ground: Option<StageGround>,
    /// The edge length of a tile on checkered planes.
    pub tile: f64,
    /// The distance from the center over which the tiles of checkered planes fade.
    pub tiles_fade: f64,
    /// The distance from the center over which the ground and checkered planes fade into the horizon.
    pub fade: f64,
    /// The preset that determines everything the scene does not give.
    pub preset: Preset,
    /// The ambient light, as a linear color. `None` for the default of the materials.
    pub ambient: Option<[f64; 3]>,
    /// The color of a plain sky. `None` for the sky of the preset.
    pub sky: Option<Color>,
    /// True if the background is transparent.
    pub transparent: bool,
    /// True if the ground fades into haze.
    pub fog: bool,
    /// The extent of the motion, and the sizes derived from it.
    pub scenery: Scenery,
    /// The exact box around the whole run, even if the camera frames only the start.
    pub whole: Bounds,
}

/// The ground. Lengths are in meters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageGround {
    /// The height of the ground (y coordinate).
    pub height: f64,
    /// The edge length of a tile on the ground.
    pub tile: f64,
    /// The distance from the center over which the tiles of the ground fade.
    pub tiles_fade: f64,
}

/// The extent of the motion and the sizes derived from it, in meters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenery {
    /// The exact box around the framed motion.
    pub bounds: Bounds,
    /// The height of the ground (y coordinate), even if the ground is not drawn.
    pub ground: f64,
    /// The edge length of a tile on the ground.
    pub tile: f64,
    /// The default edge length of a tile.
    pub usual_tile: f64,
    /// The default distance between two grid lines.
    pub spacing: f64,
    /// The size of the visible scene. It includes the motion and, if the camera frames a part of a fall, the air below.
    pub size: f64,
}

impl Scenery {
    /// Computes the sizes for a camera that frames a part of a run, and sees a width of `view` (m).
    pub(super) fn new(scene: &Scene, framed_run: &FramedRun, view: f64) -> Scenery {
        let (framed, whole) = (framed_run.span.bounds, framed_run.whole);
        let around = scene.environment.ground.as_ref();
        let framed_size = size(framed);
        // A camera close to a long motion sees only a part of it, so the tiles must fit the picture, and bodies that rest must not hover.
        let fit = framed_size.min(two_digits_up(view));
        let ground = around.and_then(|ground| ground.height).unwrap_or_else(|| just_under(whole.min.y, fit));
        let deep = || two_digits_up((framed.max.y - ground).max(framed_size));
        // A camera that goes along with the motion may be high above the ground.
        let along = framed_run.track.as_ref().map(|track| two_digits_up((track.height() - ground).max(view)));
        let depth = along.unwrap_or_else(|| if framed_run.part == FramedPart::Whole { 0.0 } else { deep() });
        let usual_tile = tile(fit.max(depth));
        let given_tile = around.and_then(|ground| ground.tile).or(ruled_tile(scene, usual_tile));
        let size = match along {
            // The tiles reach along the motion, and as far beyond as they are clearly seen from the height of the camera.
            Some(height) => {
                let extent = framed.max - framed.min;
                let clear = (usual_tile * height * CLEAR_TILES).sqrt();
                (extent.x.max(extent.z) / 2.0 + clear) / TILES_FADE
            }
            None => framed_size.max(depth),
        };
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

/// The spacing of a grid on the ground, if it is also suitable as the size of tiles. The grid lines then coincide with the edges of tiles.
fn ruled_tile(scene: &Scene, usual: f64) -> Option<f64> {
    let spacing = scene.grid.filter(|grid| grid.plane == GridPlane::Ground)?.spacing?;
    (0.1 * usual..10.0 * usual).contains(&spacing).then_some(spacing)
}

/// The widths of lines in a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineWidths {
    /// The width of a clearly visible line, m.
    pub(super) stroke: f64,
    /// The width of the thinnest line without gaps, m.
    pub(super) thinnest: f64,
}

impl LineWidths {
    /// The widths in a picture with a width in view of `view` (m).
    pub(super) fn new(view: f64, output: Output) -> LineWidths {
        let thinnest = THINNEST_LINE / f64::from(output.width);
        LineWidths { stroke: STROKE.max(thinnest) * view, thinnest: thinnest * view }
    }

    /// The widths in a picture with a width in view `scale` times as large.
    pub(super) fn scaled(self, scale: f64) -> LineWidths {
        LineWidths { stroke: self.stroke * scale, thinnest: self.thinnest * scale }
    }
}

/// The diagonal of a box, rounded up to two digits.
fn size(bounds: Bounds) -> f64 {
    two_digits_up(framing::rounded_outward(bounds).diagonal())
}

/// The distance over which tiles fade, relative to the size of the visible scene. Farther tiles are too flat to be drawn without moiré.
const TILES_FADE: f64 = 3.5;
/// The focal length at which a tile is about a pixel high at the end of the clearly seen ground, pixels: that of a picture of 440 pixels.
const CLEAR_TILES: f64 = 600.0;
/// The width of a clearly visible line, relative to the width of the picture: four pixels of 1280.
const STROKE: f64 = 0.0031;
/// The width of the thinnest line without gaps, pixels. POV-Ray breaks thinner ones into dots.
const THINNEST_LINE: f64 = 1.5;

impl Stage {
    /// Computes the surroundings of a scene for a camera. `whole` is the box around the whole run.
    pub(super) fn new(scene: &Scene, scenery: Scenery, whole: Bounds, camera: &Placed) -> Stage {
        let bounds = framing::rounded_outward(scenery.bounds);
        let (center, size, far) = (bounds.middle(), size(scenery.bounds), scenery.size);
        let distance = camera.location().distance(center);
        let around = scene.environment.ground.as_ref();
        let ground = around.filter(|_| !scene.output.transparent).map(|_| StageGround {
            height: scenery.ground,
            tile: scenery.tile,
            // Given tiles may be larger than the whole motion.
            tiles_fade: (TILES_FADE * far).max(38.0 * scenery.tile),
        });
        Stage {
            size,
            center,
            ground,
            tile: scenery.usual_tile,
            tiles_fade: TILES_FADE * far,
            // A distant camera sees more of the ground.
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

/// The ambient light of the preset or of a plain sky, as a linear color.
fn ambient(environment: &Environment) -> [f64; 3] {
    match environment.sky {
        Sky::Gradient => environment.preset.ambient(),
        // A light gray plain sky is as bright as the default one. Even a black sky gives a little light.
        Sky::Plain(color) => color.linear().map(|c| (0.03 + 1.6 * c).min(1.0)),
    }
}

/// Rounds a positive number up to two digits.
fn two_digits_up(number: f64) -> f64 {
    let step = decimal_step(number) / 10.0;
    (number / step - 1e-6).ceil() * step
}

/// A rounded height slightly below the lowest point of the motion, m.
fn just_under(lowest: f64, size: f64) -> f64 {
    let step = decimal_step(size) / 100.0;
    (lowest / step - 0.1).floor() * step
}

/// The edge length of a tile for a scene of the given size: 1, 2 or 5 times a power of ten, near a twelfth of the size.
fn tile(size: f64) -> f64 {
    let wanted = size / 12.0;
    let decade = decimal_step(wanted);
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
