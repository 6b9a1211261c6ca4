//! Writes plots in SDL.
//!
//! What all frames have in common, the panel with its numbers and the points of the curves, is a macro and arrays in the common part. A frame
//! draws the panel, the curves up to its time with a dot on each, and the bars of its values.

use std::fmt::Write as _;

use super::super::{sdl::Style, text};
use super::color;
use super::texts::{self, length, short};
use crate::picture::{PlannedPlot, PlotNow, Strip};
use crate::scene::Layout;
use crate::simulate::CurvePoint;

/// Appends the declarations of all plots to the common part. A script that contains everything has its
/// own arrays, with no more points than it draws.
pub(super) fn declare(out: &mut String, plots: &[PlannedPlot], layout: Layout, style: Style) {
    for (number, plot) in plots.iter().enumerate() {
        let [wide, high] = plot.size.map(short);
        let paper = color(plot.paper, style);
        let _ = writeln!(out, "// the plot {}", text::comment(&plot.name));
        let _ = writeln!(out, "#macro Plot_{number}()");
        let _ = writeln!(out, "Panel({}, {wide}, {high}, {paper})", corner(plot));
        if let Some(Strip { from, to, colors }) = &plot.strip {
            let [from, to] = [*from, *to].map(|at| point(Some(at)));
            let colors: Vec<String> = colors.iter().map(|it| color(*it, style)).collect();
            let _ = writeln!(out, "#local Colors = array[{}] {{ {} }}", colors.len(), colors.join(", "));
            let _ = writeln!(out, "Strip({}, {from}, {to}, Colors)", corner(plot));
        }
        for line in &plot.lines {
            let ([from, to], ink) =
                ([line.from, line.to].map(|at| point(Some(at))), color(line.color, style));
            let above = u8::from(line.is_axis);
            let _ = writeln!(out, "Ruled({}, {from}, {to}, {above}, {ink})", corner(plot));
        }
        plot.texts.iter().for_each(|text| texts::write_on_panel(out, text, style));
        out.push_str("#end\n");
        for (k, curve) in plot.curves.iter().enumerate().filter(|_| layout == Layout::Shared) {
            array(out, "declare", &name(number, k), &curve.points);
        }
    }
}

/// Appends the plots of a frame.
pub(super) fn write(out: &mut String, plots: &[PlannedPlot], now: &[PlotNow], layout: Layout, style: Style) {
    for (number, (plot, now)) in plots.iter().zip(now).enumerate() {
        let _ = writeln!(out, "Plot_{number}() // {}", text::comment(&plot.name));
        let corner = corner(plot);
        for bar in &now.bars {
            let ([from, to], ink) = ([bar.from, bar.to].map(|at| point(Some(at))), color(bar.color, style));
            let _ = writeln!(out, "Filled({corner}, {from}, {to}, {ink})");
        }
        for (k, (curve, now)) in plot.curves.iter().zip(&now.curves).enumerate() {
            let (layer, ink, all) = (k + 1, color(curve.color, style), curve.points.len());
            let mut curves = String::new();
            let mut draw = |count: usize, here: Option<[f64; 2]>, layer: usize, ink: &str| {
                let points = &curve.points[..count];
                let known = points.iter().filter(|point| point.at.is_some()).count();
                let is_beyond =
                    here.is_some() && point(here) != point(points.last().and_then(|last| last.at));
                // POV-Ray warns about a union of one object.
                if known > 0 && known + usize::from(is_beyond) > 1 {
                    let (name, here) = (name(number, k), point(here));
                    let _ = writeln!(curves, "Curve({corner}, {name}, {count}, {here}, {layer}, {ink})");
                }
            };
            if let Some(pale) = curve.pale {
                draw(all, None, 0, &color(pale, style));
            }
            draw(now.count, now.here, layer, &ink);
            if layout == Layout::SelfContained && !curves.is_empty() {
                let drawn = if curve.pale.is_some() { all } else { now.count };
                array(out, "local", &name(number, k), &curve.points[..drawn]);
            }
            out.push_str(&curves);
            if now.here.is_some() {
                let (here, radius) = (point(now.here), length(plot.dot));
                let _ = writeln!(out, "Dot({corner}, {here}, {radius}, {layer}, {ink})");
            }
        }
    }
}

/// The lower left corner of a panel, as an SDL vector.
fn corner(plot: &PlannedPlot) -> String {
    format!("<{}, {}, 0>", short(plot.left), texts::height(plot.bottom, short))
}

fn name(plot: usize, curve: usize) -> String {
    format!("Plot_{plot}_{curve}")
}

/// Appends the points of a curve as an SDL array, several in a line. SDL has no empty arrays.
fn array(out: &mut String, scope: &str, name: &str, points: &[CurvePoint]) {
    if points.is_empty() {
        return;
    }
    let items: Vec<String> = points.iter().map(|each| point(each.at)).collect();
    let lines: Vec<String> = items.chunks(8).map(|items| items.join(", ")).collect();
    let _ = writeln!(out, "#{scope} {name} = array[{}] {{\n{}\n}}", points.len(), lines.join(",\n"));
}

/// A position in a panel as an SDL vector. The height in front of the panel is 0 for a point, and 1 for a gap of a curve.
fn point(at: Option<[f64; 2]>) -> String {
    at.map_or_else(|| "<0, 0, 1>".to_owned(), |[x, y]| format!("<{}, {}, 0>", short(x), short(y)))
}
