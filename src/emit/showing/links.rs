//! Springs and joints in POV-Ray's words: coils, rods, ropes and pins.

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::picture::{Link, LinkForm, Plan};
use crate::simulate::Frame;

/// Appends the springs and joints as they are in a frame.
pub(super) fn write(out: &mut String, plan: &Plan, frame: &Frame, style: Style) {
    plan.links(frame).iter().for_each(|its| link(out, its, style));
}

fn link(out: &mut String, link: &Link<'_>, style: Style) {
    let (name, color) = (text::comment(link.name), color(link.color, style));
    // That one is never seen is said once for the run.
    let is_seen = |radius: f64| style.can_tell(DVec3::ZERO, DVec3::X * radius);
    match &link.form {
        LinkForm::Pin { at, radius } => {
            out.push_str("sphere { ");
            style.point(out, *at);
            out.push_str(", ");
            style.length(out, *radius);
            out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}, its end\n"));
        }
        LinkForm::Rod { ends: [from, to], radius } if is_seen(*radius) && style.can_tell(*from, *to) => {
            out.push_str("cylinder { ");
            bar(out, [*from, *to], *radius, style);
            out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}\n"));
        }
        LinkForm::Coil { ends: [from, to], radius, wire, turns }
            if is_seen(*radius) && style.can_tell(*from, *to) =>
        {
            out.push_str("Coil(");
            bar(out, [*from, *to], *radius, style);
            out.push_str(", ");
            style.length(out, *wire);
            out.push_str(&format!(", {turns}, {color}) // {name}\n"));
        }
        LinkForm::Rope { points, radius } if is_seen(*radius) => {
            rope(out, points, *radius, &color, &name, style);
        }
        LinkForm::Rod { .. } | LinkForm::Coil { .. } | LinkForm::Rope { .. } => {}
    }
}

/// Appends two points and a radius.
fn bar(out: &mut String, [from, to]: [DVec3; 2], radius: f64, style: Style) {
    style.point(out, from);
    out.push_str(", ");
    style.point(out, to);
    out.push_str(", ");
    style.length(out, radius);
}

/// Appends a rope: a cylinder from each point to the next, and a ball at each point between them.
fn rope(out: &mut String, points: &[DVec3], radius: f64, color: &str, name: &str, style: Style) {
    if points.windows(2).all(|pair| !style.can_tell(pair[0], pair[1])) {
        return;
    }
    out.push_str(&format!("union {{ // {name}\n"));
    let mut last = points[0];
    for (number, point) in points.iter().enumerate().skip(1) {
        if !style.can_tell(last, *point) {
            continue;
        }
        out.push_str("  cylinder { ");
        bar(out, [last, *point], radius, style);
        out.push_str(" }\n");
        if number + 1 < points.len() {
            out.push_str("  sphere { ");
            style.point(out, *point);
            out.push_str(", ");
            style.length(out, radius);
            out.push_str(" }\n");
        }
        last = *point;
    }
    out.push_str(&format!(
        "  pigment {{ color srgb {color} }}\n  finish {{ ambient 0.1 diffuse 0.7 }}\n}}\n"
    ));
}
