//! Writes springs and joints in SDL: coils, rods, ropes and pins.

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::picture::{Link, LinkShape, Plan};
use crate::simulate::Frame;

/// Appends the SDL text of the springs and joints that a frame shows.
pub(super) fn write(out: &mut String, plan: &Plan, frame: &Frame, style: Style) {
    plan.links(frame).iter().for_each(|its| link(out, its, style));
}

fn link(out: &mut String, link: &Link<'_>, style: Style) {
    let (name, color) = (text::comment(link.name), color(link.color, style));
    // A spring or joint that is too thin for POV-Ray is left out. A warning of the run tells about those that are too thin in all frames.
    let is_seen = |radius: f64| style.can_tell(DVec3::ZERO, DVec3::X * radius);
    match &link.form {
        LinkShape::Pin { at, radius } => {
            out.push_str("sphere { ");
            style.point(out, *at);
            out.push_str(", ");
            style.length(out, *radius);
            out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}, its end\n"));
        }
        LinkShape::Rod { ends: [from, to], radius } if is_seen(*radius) && style.can_tell(*from, *to) => {
            out.push_str("cylinder { ");
            bar(out, [*from, *to], *radius, style);
            out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}\n"));
        }
        LinkShape::Coil { ends: [from, to], radius, wire, turns }
            if is_seen(*radius) && style.can_tell(*from, *to) =>
        {
            out.push_str("Coil(");
            bar(out, [*from, *to], *radius, style);
            out.push_str(", ");
            style.length(out, *wire);
            out.push_str(&format!(", {turns}, {color}) // {name}\n"));
        }
        LinkShape::Rope { points, radius } if is_seen(*radius) => {
            rope(out, points, *radius, &color, &name, style);
        }
        LinkShape::Rod { .. } | LinkShape::Coil { .. } | LinkShape::Rope { .. } => {}
    }
}

/// Appends the two ends and the radius of a cylinder.
fn bar(out: &mut String, [from, to]: [DVec3; 2], radius: f64, style: Style) {
    style.point(out, from);
    out.push_str(", ");
    style.point(out, to);
    out.push_str(", ");
    style.length(out, radius);
}

/// Appends a rope: a cylinder between each two neighboring points, and a ball at each inner point. A straight rope is a single cylinder,
/// since POV-Ray warns about a union of one object.
fn rope(out: &mut String, points: &[DVec3], radius: f64, color: &str, name: &str, style: Style) {
    let mut seen: Vec<DVec3> = Vec::with_capacity(points.len());
    for &point in points {
        if seen.last().is_none_or(|last| style.can_tell(*last, point)) {
            seen.push(point);
        }
    }
    let look = format!("  pigment {{ color srgb {color} }}\n  finish {{ ambient 0.1 diffuse 0.7 }}\n}}\n");
    match *seen.as_slice() {
        [] | [_] => return,
        [from, to] => {
            out.push_str("cylinder { ");
            bar(out, [from, to], radius, style);
            out.push_str(&format!(" // {name}\n"));
        }
        _ => {
            out.push_str(&format!("union {{ // {name}\n"));
            for (number, pair) in seen.windows(2).enumerate() {
                if number > 0 {
                    out.push_str("  sphere { ");
                    style.point(out, pair[0]);
                    out.push_str(", ");
                    style.length(out, radius);
                    out.push_str(" }\n");
                }
                out.push_str("  cylinder { ");
                bar(out, [pair[0], pair[1]], radius, style);
                out.push_str(" }\n");
            }
        }
    }
    out.push_str(&look);
}
