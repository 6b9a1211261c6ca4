//! Springs, as coils between the surfaces of what they are fastened to; joints, as rods and pins.

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::picture::{Coil, Plan};
use crate::simulate::Frame;

/// Appends the coils as they are in a frame.
pub(super) fn write(out: &mut String, plan: &Plan, frame: &Frame, style: Style) {
    plan.coils(frame).iter().for_each(|its| coil(out, its, style));
}

fn coil(out: &mut String, coil: &Coil<'_>, style: Style) {
    let (name, color) = (text::comment(coil.name), color(coil.color, style));
    for point in coil.fixed.into_iter().flatten() {
        out.push_str("sphere { ");
        style.point(out, point);
        out.push_str(", ");
        style.length(out, coil.knob);
        out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}, its end\n"));
    }
    // That one is never seen is said once for the run.
    let is_wound = style.can_tell(DVec3::ZERO, DVec3::X * coil.radius);
    let Some([begin, end]) = coil.span.filter(|[begin, end]| is_wound && style.can_tell(*begin, *end)) else {
        return;
    };
    if coil.turns == 0 {
        out.push_str("cylinder { ");
        style.point(out, begin);
        out.push_str(", ");
        style.point(out, end);
        out.push_str(", ");
        style.length(out, coil.radius);
        out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}\n"));
        return;
    }
    out.push_str("Coil(");
    style.point(out, begin);
    out.push_str(", ");
    style.point(out, end);
    for length in [coil.radius, coil.wire] {
        out.push_str(", ");
        style.length(out, length);
    }
    out.push_str(&format!(", {}, {color}) // {name}\n", coil.turns));
}
