//! Writes the grid of coordinate lines in SDL.

use super::super::sdl::Style;
use super::color;
use crate::picture::Grid;

/// Returns the lines of a grid as SDL text. The text is empty if the grid has no lines.
pub(super) fn lines(grid: &Grid, style: Style) -> String {
    if grid.lines.is_empty() {
        return String::new();
    }
    // POV-Ray warns about a union of one object.
    let kind = if grid.lines.len() > 1 { "union" } else { "object" };
    let mut out = format!("{kind} {{ // grid\n");
    for line in &grid.lines {
        out.push_str("  cylinder { ");
        style.point(&mut out, line.from);
        out.push_str(", ");
        style.point(&mut out, line.to);
        out.push_str(", ");
        style.length(&mut out, line.radius);
        out.push_str(" }\n");
    }
    let color = color(grid.color, style);
    out.push_str(&format!(
        "  pigment {{ color srgb {color} }} finish {{ ambient 0 diffuse 0 emission 1 }} no_shadow no_reflection\n}}\n"
    ));
    out
}
