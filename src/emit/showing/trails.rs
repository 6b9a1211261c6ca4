//! Lines along the ways of bodies.

use super::super::{sdl::Style, text};
use super::color;
use crate::picture::{Plan, Trail};
use crate::simulate::Frame;

/// Appends the trails up to a frame of bodies whose names are given.
pub(super) fn write(out: &mut String, plan: &Plan, frame: &Frame, names: &[String], style: Style) {
    for its in plan.trails(frame) {
        if its.points.iter().all(|point| style.can_write(*point)) {
            trail(out, &its, &names[its.body], style);
        }
    }
}

fn trail(out: &mut String, trail: &Trail, name: &str, style: Style) {
    out.push_str(&format!("union {{ // {}, trail\n", text::comment(name)));
    for (number, pair) in trail.points.windows(2).enumerate() {
        let (from, to) = (trail.radius_at(number), trail.radius_at(number + 1));
        out.push_str(if trail.tapers { "  cone { " } else { "  cylinder { " });
        style.point(out, pair[0]);
        out.push_str(", ");
        if trail.tapers {
            style.length(out, from);
            out.push_str(", ");
        }
        style.point(out, pair[1]);
        out.push_str(", ");
        style.length(out, to);
        out.push_str(" open } sphere { ");
        style.point(out, pair[1]);
        out.push_str(", ");
        style.length(out, to);
        out.push_str(" }\n");
    }
    let color = color(trail.color, style);
    out.push_str(&format!(
        "  pigment {{ color srgb {color} }} finish {{ ambient 0 emission 0.75 diffuse 0.25 }} no_shadow no_reflection\n}}\n"
    ));
}
