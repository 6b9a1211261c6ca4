//! Writes the things that are drawn beside the bodies in SDL: springs, joints, arrows, axes, areas, thin lines.

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::picture::{Form, Line, Thing};

/// Appends the SDL text of a thing. A thing that is too short or too thin for POV-Ray is left out; a warning of the run tells about
/// things that are too small in all frames.
pub(super) fn write(out: &mut String, thing: &Thing<'_>, style: Style) {
    let (name, color) = (text::comment(&thing.name), color(thing.color, style));
    let is_seen = |radius: f64| style.can_tell(DVec3::ZERO, DVec3::X * radius);
    match &thing.form {
        Form::Ball { at, radius } => {
            out.push_str("sphere { ");
            style.point(out, *at);
            out.push_str(", ");
            style.length(out, *radius);
            out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}\n"));
        }
        Form::Rod { ends: [from, to], radius } if is_seen(*radius) && style.can_tell(*from, *to) => {
            out.push_str("cylinder { ");
            bar(out, [*from, *to], *radius, style);
            out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}\n"));
        }
        Form::Coil { ends: [from, to], radius, wire, turns }
            if is_seen(*radius) && style.can_tell(*from, *to) =>
        {
            out.push_str("Coil(");
            bar(out, [*from, *to], *radius, style);
            out.push_str(", ");
            style.length(out, *wire);
            out.push_str(&format!(", {turns}, {color}) // {name}\n"));
        }
        Form::Rope { points, radius } if is_seen(*radius) => {
            rope(out, points, *radius, &color, &name, style);
        }
        Form::Arrow { from, to, radius } if style.can_tell(*from, *to) => {
            out.push_str("Arrow(");
            bar(out, [*from, *to], *radius, style);
            out.push_str(&format!(", {color}) // {name}\n"));
        }
        Form::Axes { location, orientation, length } => {
            out.push_str("object { Axes scale ");
            style.length(out, *length);
            out.push(' ');
            style.matrix(out, *orientation, *location);
            out.push_str(&format!(" no_shadow }} // {name}\n"));
        }
        Form::Area { points, opacity, is_liquid } => {
            area(out, points, (*opacity, *is_liquid), &color, &name, style);
        }
        Form::Lines { lines } => thin(out, lines, &color, &name, style),
        Form::Rod { .. } | Form::Coil { .. } | Form::Rope { .. } | Form::Arrow { .. } => {}
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

/// Appends a translucent area. Points that POV-Ray takes for one are left out.
fn area(
    out: &mut String,
    points: &[DVec3],
    (opacity, is_liquid): (f64, bool),
    color: &str,
    name: &str,
    style: Style,
) {
    let Some((first, rest)) = points.split_first() else { return };
    let mut seen = vec![*first];
    for point in rest {
        if seen.iter().rev().take(1).chain([first]).all(|other| style.can_tell(*other, *point)) {
            seen.push(*point);
        }
    }
    if seen.len() < 3 {
        return;
    }
    out.push_str(&format!("Area(array[{}] {{ // {name}\n", seen.len()));
    for (number, point) in seen.iter().enumerate() {
        out.push_str("  ");
        style.point(out, *point);
        out.push_str(if number + 1 < seen.len() { ",\n" } else { "\n}, " });
    }
    style.number(out, 1.0 - opacity);
    out.push_str(&format!(", {}, {color})\n", u8::from(is_liquid)));
}

/// Appends thin straight lines, which shine and cast no shadow. Lines without a length are left out: POV-Ray refuses them.
fn thin(out: &mut String, lines: &[Line], color: &str, name: &str, style: Style) {
    let lines: Vec<&Line> = lines.iter().filter(|line| style.can_tell(line.from, line.to)).collect();
    if lines.is_empty() {
        return;
    }
    // POV-Ray warns about a union of one object.
    let kind = if lines.len() > 1 { "union" } else { "object" };
    out.push_str(&format!("{kind} {{ // {name}\n"));
    for line in lines {
        out.push_str("  cylinder { ");
        bar(out, [line.from, line.to], line.radius, style);
        out.push_str(" }\n");
    }
    out.push_str(&format!(
        "  pigment {{ color srgb {color} }} finish {{ ambient 0 diffuse 0 emission 1 }} no_shadow no_reflection\n}}\n"
    ));
}
