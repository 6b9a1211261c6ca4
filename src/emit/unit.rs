//! Chooses the length of one POV-Ray unit.

use crate::decimal::decimal_step;
use crate::picture::{Lens, Plan, rounded_outward};
use crate::scene::{Emitter, Scene};
use crate::simulate::Bounds;

/// The smallest half thickness of a body, POV-Ray units. POV-Ray 3.7 draws edges and shadows of thinner bodies wrongly, since it treats
/// points closer than 0.001 as one (measured).
const MIN_HALF_THICKNESS: f64 = 0.01;

/// The length unit of a scene's scripts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    /// The length of one POV-Ray unit, m.
    pub(super) length: f64,
    /// The index of a body that may be too thin for POV-Ray to draw in this unit. The indices of particle emitters follow those of bodies.
    pub(super) too_thin: Option<usize>,
}

impl Unit {
    /// Returns the unit that the scene sets, or else a unit in which POV-Ray can draw the scene.
    pub(super) fn of(scene: &Scene, plan: &Plan) -> Unit {
        let thinnest = thinnest(scene);
        // If the view of an orthographic camera is wider than some hundred units, POV-Ray mistakes rounding errors for intersections.
        let reach = reach(plan).metres.max(300.0 * parallel(plan));
        let length = scene.povray.unit.unwrap_or_else(|| unit(reach, thinnest.map(|(_, half)| half)));
        let too_thin =
            thinnest.filter(|(_, half)| half / length < MIN_HALF_THICKNESS * 0.99).map(|(id, _)| id);
        Unit { length, too_thin }
    }
}

/// Returns the index of the thinnest body, or of the emitter whose particles are even thinner, and half the thickness, m. `None` if nothing
/// has a size.
fn thinnest(scene: &Scene) -> Option<(usize, f64)> {
    let halves =
        scene.bodies.iter().enumerate().filter_map(|(id, body)| Some((id, body.drawn().half_thickness()?)));
    let largest = |emitter: &Emitter| emitter.radius * emitter.sizes.iter().copied().fold(0.0, f64::max);
    let particles = scene.emitters.iter().enumerate();
    let particles = particles.map(|(number, emitter)| (scene.bodies.len() + number, largest(emitter)));
    halves.chain(particles.filter(|(_, radius)| *radius > 0.0)).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The largest coordinate of a scene, and what causes it.
pub(super) struct LargestCoordinate {
    /// The largest coordinate in a script of the scene, m, measured from the world's origin.
    pub(super) metres: f64,
    /// True if the position of the camera causes the largest coordinate, and not the bodies.
    pub(super) by_camera: bool,
}

/// Computes the largest coordinate in the scripts of a scene, from the motion of all bodies and the camera.
pub(super) fn reach(plan: &Plan) -> LargestCoordinate {
    let Bounds { min, max } = rounded_outward(plan.stage().whole);
    let farthest = |points: [glam::DVec3; 2], least: f64| {
        points.into_iter().map(|point| point.abs().max_element()).fold(least, f64::max)
    };
    let bodies = farthest([min, max], (max - min).length());
    let placed = plan.placed();
    let camera = farthest([placed.location(), placed.look_at()], parallel(plan));
    LargestCoordinate { metres: bodies.max(camera), by_camera: camera > 1e3 * bodies }
}

/// Returns the larger edge of an orthographic camera's view, m. It is 0 for a perspective camera.
fn parallel(plan: &Plan) -> f64 {
    match plan.placed().lens() {
        Lens::Perspective { .. } | Lens::Spherical => 0.0,
        Lens::Orthographic { width } => width * plan.placed().height_to_width().max(1.0),
    }
}

/// Computes the length of one POV-Ray unit, m. `reach` is the largest coordinate of the scene, m. `thinnest` is half the thickness of the
/// thinnest body, m.
///
/// Coordinates stay below 10⁵ units, far from the 10⁷ at which POV-Ray 3.7 stops looking for intersections.
fn unit(reach: f64, thinnest: Option<f64>) -> f64 {
    const MAX_COORDINATE: f64 = 1e5;
    let thinnest = thinnest.unwrap_or(MIN_HALF_THICKNESS);
    // Both are powers of ten: `far` is the smallest unit that suits the largest coordinate, and `thin` is the largest unit that suits the
    // thinnest body. The largest coordinate has priority.
    let far = 1.0 / decimal_step(MAX_COORDINATE / reach);
    let thin = decimal_step(thinnest / MIN_HALF_THICKNESS);
    if thinnest >= MIN_HALF_THICKNESS && reach <= MAX_COORDINATE {
        1.0
    } else if reach > MAX_COORDINATE {
        far
    } else {
        thin.max(far)
    }
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
                reach / unit <= 1.000_001e5 && thinnest / unit >= MIN_HALF_THICKNESS * 0.99,
                "{reach} {thinnest}: {unit}"
            );
            assert!((libm::log10(unit) - libm::log10(unit).round()).abs() < 1e-9, "{unit} is a power of ten");
        }
    }
}
