//! Writes arrows for velocity, acceleration and force, and the axes of bodies, in SDL.

use super::super::{sdl::Style, text};
use super::Names;
use super::color;
use crate::picture::{Arrow, ArrowOwner, Axes, Plan};
use crate::simulate::{Frame, Ghost};

/// Appends the arrows and axes of all bodies and joints. The arrows and axes of one body are written one after another.
pub(super) fn write(out: &mut String, plan: &Plan, frame: &Frame, names: Names<'_>, style: Style) {
    let mut arrows = plan.arrows_in_front(frame).into_iter().peekable();
    for its in plan.axes(frame) {
        let is_before = |arrow: &Arrow| matches!(arrow.owner, ArrowOwner::Body(body) if body <= its.body);
        while let Some(before) = arrows.next_if(is_before) {
            arrow(out, &before, names, style);
        }
        axes(out, &its, names, style);
    }
    arrows.for_each(|left| arrow(out, &left, names, style));
}

/// Appends the arrows of a ghost (an earlier pose of a body), if the body's ghosts have arrows. The arrows show the body's quantities at
/// the time of the ghost.
pub(super) fn write_ghost(
    out: &mut String,
    plan: &Plan,
    frame: &Frame,
    ghost: &Ghost,
    names: Names<'_>,
    style: Style,
) {
    plan.ghost_arrows_in_front(frame, ghost).iter().for_each(|its| arrow(out, its, names, style));
}

fn axes(out: &mut String, axes: &Axes, names: Names<'_>, style: Style) {
    out.push_str("object { Axes scale ");
    style.length(out, axes.length);
    out.push(' ');
    style.matrix(out, axes.orientation, axes.location);
    out.push_str(&format!(" no_shadow }} // {}, axes\n", text::comment(&names.bodies[axes.body])));
}

fn arrow(out: &mut String, arrow: &Arrow, names: Names<'_>, style: Style) {
    // An arrow that is too short for POV-Ray is left out. A warning of the run tells about arrows that are too short in all frames.
    if !style.can_tell(arrow.from, arrow.to) {
        return;
    }
    out.push_str("Arrow(");
    style.point(out, arrow.from);
    out.push_str(", ");
    style.point(out, arrow.to);
    out.push_str(", ");
    style.length(out, arrow.radius);
    let name = match arrow.owner {
        ArrowOwner::Body(body) => &*names.bodies[body],
        ArrowOwner::Joint { joint, .. } => &names.joints[joint],
    };
    let (color, name) = (color(arrow.color, style), text::comment(name));
    out.push_str(&format!(", {color}) // {name}, {}\n", arrow.quantity.name()));
}
