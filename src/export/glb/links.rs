//! Makes nodes for springs and joints: one node for each part, stretched from end to end.
//!
//! A part has the size 0 while its bodies are absent or its ends coincide.

use glam::{DQuat, DVec3};

use super::motion::{NodePose, Recorder, SampledMotion};
use crate::export::ExportError;
use crate::picture::{Form, FormKind, Plan};
use crate::scene::Color;
use crate::simulate::{Recorded, Selection};
use crate::surface::BaseShape;

/// The number of straight pieces of a rope.
const PIECES_PER_ROPE: usize = 24;

/// The node of a part of a spring or a joint: its name, base shape and color.
pub(super) struct LinkNode {
    pub(super) name: String,
    pub(super) form: BaseShape,
    pub(super) color: Color,
}

/// Records the motion of springs and joints, and appends it to `motion`. Returns their nodes in the same order.
pub(super) fn nodes(
    run: &Recorded<'_>,
    selection: &Selection,
    motion: &mut SampledMotion,
) -> Result<Vec<LinkNode>, ExportError> {
    let scene = run.scene();
    let plan = Plan::new(scene, &scene.camera, run.survey());
    let mut nodes = Vec::new();
    let mut counts = Vec::new();
    for link in plan.planned_links() {
        let (form, count) = match link.kind {
            FormKind::Ball => (BaseShape::BALL, 1),
            FormKind::Coil { turns, wire } => (BaseShape::coil(turns, wire), 1),
            FormKind::Rod => (BaseShape::CYLINDER, 1),
            FormKind::Rope => (BaseShape::CYLINDER, PIECES_PER_ROPE),
        };
        let node = || LinkNode { name: format!("link {}", link.name), form: form.clone(), color: link.color };
        nodes.extend((0..count).map(|_| node()));
        counts.push(count);
    }
    if nodes.is_empty() {
        return Ok(nodes);
    }
    let mut placed: Vec<Placed> = nodes.iter().map(|_| Placed::default()).collect();
    let mut ways = Recorder::new(motion.times().len());
    for exposure in run.exposures(selection) {
        let frame = exposure?.frame;
        let mut rest = placed.as_mut_slice();
        for (link, &count) in plan.each_link(&frame).zip(&counts) {
            let (its, others) = rest.split_at_mut(count);
            rest = others;
            place(its, link.map(|link| link.form));
        }
        let poses = placed.iter().map(|placed| (placed.pose, placed.size));
        ways.add_sized(poses, frame.time, |i| nodes[i].name.clone(), &mut motion.budget)?;
    }
    motion.append(ways);
    Ok(nodes)
}

/// The pose and size of a spring's or joint's part in the current frame.
struct Placed {
    pose: NodePose,
    /// The scale along the part's own axes, m. The y axis is the axis of the base shape.
    size: DVec3,
}

impl Default for Placed {
    fn default() -> Placed {
        let pose = NodePose { location: DVec3::ZERO, orientation: DQuat::IDENTITY };
        Placed { pose, size: DVec3::ZERO }
    }
}

impl Placed {
    /// Stretches a base shape of radius 1 with y from −1 to 1 from one point to another. The shape turns the shortest way from its
    /// previous orientation, so that it does not spin about its axis.
    fn stretch(&mut self, [from, to]: [DVec3; 2], radius: f64) {
        let half = (to - from) / 2.0;
        if let Some(along) = half.try_normalize() {
            let before = self.pose.orientation * DVec3::Y;
            let turn = DQuat::from_rotation_arc(before, along);
            self.pose.orientation = (turn * self.pose.orientation).normalize();
        }
        self.pose.location = from + half;
        self.size = DVec3::new(radius, half.length(), radius);
    }
}

/// Sets the poses and sizes of a part's nodes in a frame. Without a `form`, the part is not drawn: its nodes keep their locations and get
/// the size 0.
fn place(nodes: &mut [Placed], form: Option<Form>) {
    nodes.iter_mut().for_each(|node| node.size = DVec3::ZERO);
    let [first, ..] = nodes else { return };
    match form {
        // No spring or joint has these forms.
        None | Some(Form::Arrow { .. } | Form::Axes { .. } | Form::Area { .. } | Form::Lines { .. }) => {}
        Some(Form::Ball { at, radius }) => {
            first.pose.location = at;
            first.size = DVec3::splat(radius);
        }
        Some(Form::Coil { ends, radius, .. } | Form::Rod { ends, radius }) => {
            first.stretch(ends, radius);
        }
        Some(Form::Rope { points, radius }) => {
            for (node, ends) in nodes.iter_mut().zip(chain(&points)) {
                node.stretch(ends, radius);
            }
        }
    }
}

/// Yields the ends of a rope's pieces, one piece for each node. Each piece covers an equal number of the rope's segments. A straight rope
/// is divided evenly.
fn chain(points: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> {
    let last = points.len() - 1;
    #[allow(clippy::cast_precision_loss, reason = "a rope has few points")]
    let at = move |number: usize| {
        let place = (number * last) as f64 / PIECES_PER_ROPE as f64;
        let before = (number * last / PIECES_PER_ROPE).min(last - 1);
        points[before].lerp(points[before + 1], place - before as f64)
    };
    (0..PIECES_PER_ROPE).map(move |piece| [at(piece), at(piece + 1)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rope_is_a_chain_of_pieces_from_end_to_end() {
        for points in [vec![DVec3::ZERO, DVec3::X], vec![DVec3::ZERO, DVec3::NEG_Y, DVec3::X, DVec3::X * 2.0]]
        {
            let pieces: Vec<[DVec3; 2]> = chain(&points).collect();
            assert_eq!((pieces.len(), pieces[0][0]), (PIECES_PER_ROPE, DVec3::ZERO));
            assert!(pieces[PIECES_PER_ROPE - 1][1].abs_diff_eq(points[points.len() - 1], 1e-12));
            assert!(pieces.windows(2).all(|pair| pair[0][1] == pair[1][0]));
        }
    }

    /// A pendulum that passes straight above its pivot does not flip.
    #[test]
    fn a_rod_that_turns_all_around_does_not_spin() {
        let mut placed = Placed::default();
        let mut last = None;
        for step in 0..=100 {
            let (sin, cos) = libm::sincos(f64::from(step) * 0.1);
            placed.stretch([DVec3::ZERO, DVec3::new(sin, -cos, 0.0) * 2.0], 0.1);
            let now = placed.pose.orientation;
            let turned = last.map_or(1.0, |last: DQuat| last.dot(now).abs());
            assert!(turned > libm::cos(0.051), "{step}: {turned}");
            last = Some(now);
        }
        assert!((placed.size - DVec3::new(0.1, 1.0, 0.1)).length() < 1e-12);
    }
}
