//! Places parallel arrows of one body side by side, so that no arrow hides another.

use glam::DMat3;

use super::arrows::{Arrow, HEAD};
use super::camera::Placed;
use crate::physics::BodySnapshot;
use crate::scene::Body;
use crate::simulate::surface;

/// The distance between two arrows placed side by side, in radii of an arrow's head.
const ARROW_GAP: f64 = 2.2;
/// The angles between two arrows, rad, up to which they are fully moved apart, and from which they are not moved at all.
const BLENDED_ANGLES: [f64; 2] = [0.12, 0.35];

/// Moves the overlapping arrows of a body sideways, as seen by a camera. The offset changes smoothly with the directions and lengths of
/// the arrows.
pub(super) fn apart(arrows: &mut [Arrow], body: &Body, at: &BodySnapshot, camera: &Placed) {
    let plain: Vec<Arrow> = arrows.to_vec();
    for (number, arrow) in arrows.iter_mut().enumerate() {
        let steps: f64 = plain
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != number)
            .map(|(other, one)| (if other < number { 0.5 } else { -0.5 }) * overlap(&plain[number], one))
            .sum();
        if steps == 0.0 {
            continue;
        }
        let along = (arrow.to - arrow.from).normalize_or_zero();
        let side = along.cross(camera.towards(arrow.from)).normalize_or_zero();
        let offset = side * (steps * ARROW_GAP * HEAD * arrow.radius);
        let drawn = body.drawn();
        let turn = DMat3::from_quat(at.orientation.conjugate());
        let reach = drawn.exit(turn * offset, turn * along);
        let reach = reach.unwrap_or_else(|| surface(&drawn, at.orientation, along));
        arrow.from = at.location + offset + along * reach;
        arrow.to += offset;
    }
}

/// The degree to which two arrows overlap, from 0 to 1.
fn overlap(one: &Arrow, other: &Arrow) -> f64 {
    let [a, b] = [one, other].map(|arrow| arrow.to - arrow.from);
    let angle = a.angle_between(b);
    if !angle.is_finite() {
        return 0.0;
    }
    let turned = ((BLENDED_ANGLES[1] - angle) / (BLENDED_ANGLES[1] - BLENDED_ANGLES[0])).clamp(0.0, 1.0);
    let grown = (a.length().min(b.length()) / (2.0 * HEAD * one.radius)).min(1.0);
    turned * turned * (3.0 - 2.0 * turned) * grown
}

#[cfg(test)]
mod tests {
    use super::super::Plan;
    use glam::DVec3;

    use super::*;
    use crate::scene::Scene;
    use crate::simulate::{Frame, Frames, survey};

    fn arrows(velocity: &str, mass: f64) -> (Vec<Arrow>, Plan, Frame) {
        let text = format!(
            "simulation = {{ duration = 0, gravity = [0, -10, 0] }}\n[body.ball]\nshape.sphere.radius = 0.5\nmass = {mass}\n\
             velocity = {velocity}\narrows = {{ velocity.scale = 0.2, acceleration.scale = 0.1, force.scale = 0.1 }}\n\
             [camera]\nlocation = [0, 0, 8]\nlook_at = [0, 0, 0]"
        );
        let scene = Scene::parse(&text).unwrap();
        let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
        let frame = Frames::at(&scene, 0.0).unwrap();
        (plan.arrows(&frame), plan, frame)
    }

    #[test]
    fn parallel_arrows_stand_side_by_side_and_keep_their_lengths() {
        let (arrows, ..) = arrows("[0, -8, 0]", 2.0);
        let [velocity, acceleration, force] = arrows[..] else { panic!("three are asked for") };
        let head = HEAD * velocity.radius;
        for (left, right) in [(velocity, acceleration), (acceleration, force)] {
            let apart = (left.to - right.to).reject_from(DVec3::Y).length();
            assert!((2.0 * head..3.0 * head).contains(&apart), "{apart} of {head}");
        }
        for (arrow, length) in [(velocity, 1.6), (acceleration, 1.0), (force, 2.0)] {
            // Each tip is where it would be if the arrow began at the lowest point of the ball.
            assert!((arrow.to.y + 0.5 + length).abs() < 1e-9, "{arrow:?}");
            // The start of each arrow is on the surface of the ball.
            assert!(arrow.from.length() > 0.5 - 1e-9 && arrow.from.length() < 0.5 + 1e-9, "{arrow:?}");
        }
    }

    #[test]
    fn arrows_that_point_elsewhere_or_are_short_stay_where_they_are() {
        let (crossed, ..) = arrows("[8, 0, 0]", 2.0);
        assert!(crossed[0].from.abs_diff_eq(DVec3::X * 0.5, 1e-9), "{:?}", crossed[0]);
        // The acceleration and the force are parallel, so they move apart. The velocity is perpendicular and has no effect on them.
        assert!((crossed[1].from.x + crossed[2].from.x).abs() < 1e-9);
        let (upward, ..) = arrows("[0, 8, 0]", 2.0);
        assert!(upward[0].from.abs_diff_eq(DVec3::Y * 0.5, 1e-9));
        let [just, none] = ["[0, -0.0001, 0]", "[0, 0.0001, 0]"].map(|velocity| arrows(velocity, 2.0).0);
        let last = |arrows: &[Arrow]| arrows.last().unwrap().to;
        assert!(last(&just).distance(last(&none)) < 1e-3, "where the velocity turns, nothing jumps");
    }
}
