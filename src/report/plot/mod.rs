//! Plots an assessment: the energy drift, the error and the distance of neighboring runs over time.
//!
//! A picture is a list of lines and texts with positions in pixels. An SVG and a PNG are made from the same list.

mod axis;
mod chart;
#[cfg(feature = "render")]
mod png;
mod svg;

use super::verdict::{Curves, Verdict};
use super::{Assessment, Separation, text};
use crate::svg::{Anchor, Rgb};
use axis::Axis;

pub use chart::{Chart, Curve};
#[cfg(feature = "render")]
pub use png::png;
pub use svg::svg;

/// The color behind a plot.
const BACKGROUND_COLOR: Rgb = [255, 255, 255];
/// The color of titles.
const TEXT_COLOR: Rgb = [52, 50, 46];
/// The color of less important texts and lines.
const FAINT_TEXT_COLOR: Rgb = [122, 118, 110];
/// The color of grid lines.
const GRID_COLOR: Rgb = [228, 226, 221];
/// The color of the curve of the drift of the energy.
const ENERGY_COLOR: Rgb = [192, 67, 43];
/// The color of the curve of the error of the worst point.
const ERROR_COLOR: Rgb = [38, 98, 158];
/// The color of the curve of the distance between neighboring runs.
const NEIGHBORS_COLOR: Rgb = [46, 125, 79];

/// The width of a plot, pixels.
const PLOT_WIDTH: f64 = 1100.0;
/// The width of the margin at the left of the panels, pixels.
const LEFT_MARGIN: f64 = 120.0;
/// The width of the margin at the right of the panels, pixels.
const RIGHT_MARGIN: f64 = 40.0;
/// The height of the margin above the first panel, pixels.
const TOP_MARGIN: f64 = 92.0;
/// The height of a panel, pixels.
const PANEL_HEIGHT: f64 = 220.0;
/// The vertical gap between two panels, pixels.
const PANEL_GAP: f64 = 66.0;

/// A line or a text of a picture. Positions are in pixels, from the upper left corner of the picture.
#[derive(Clone, Debug, PartialEq)]
enum Item {
    Line {
        points: Vec<[f64; 2]>,
        width: f64,
        color: Rgb,
    },
    /// A text in one line. `at` is the position of its anchor, at half the height of the letters.
    Text {
        at: [f64; 2],
        text: String,
        anchor: Anchor,
        large: bool,
        color: Rgb,
    },
}

/// A picture as a list of lines and texts. Its width and height are in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: f64,
    height: f64,
    items: Vec<Item>,
}

/// A panel of the plot, which shows one curve over time.
struct Panel<'a> {
    title: String,
    times: &'a [f64],
    values: Vec<f64>,
    is_logarithmic: bool,
    /// The value at which the panel has a horizontal line, such as the requested accuracy.
    mark: Option<f64>,
    color: Rgb,
}

impl Picture {
    /// Draws the plot of an assessment, under a title. `None` if nothing is integrated.
    pub fn of(assessment: &Assessment, title: &str) -> Option<Picture> {
        let verdict = assessment.verdict.as_ref()?;
        let panels = panels(assessment, verdict);
        let count = f64::from(u8::try_from(panels.len()).unwrap_or(u8::MAX));
        let height = TOP_MARGIN + count * (PANEL_HEIGHT + PANEL_GAP) - PANEL_GAP + 40.0;
        let mut picture = Picture { width: PLOT_WIDTH, height, items: Vec::new() };
        let method = match (assessment.timestep, assessment.tolerance) {
            (Some(step), _) => format!("{}, step {} s", assessment.integrator, text::digits(step, 4)),
            (None, tolerance) => {
                let tolerance = text::digits(tolerance.unwrap_or_default(), 3);
                format!("{}, tolerance {tolerance}", assessment.integrator)
            }
        };
        picture.text([LEFT_MARGIN, 28.0], title.to_owned(), Anchor::Start, TEXT_COLOR, true);
        picture.text([PLOT_WIDTH - RIGHT_MARGIN, 28.0], method, Anchor::End, FAINT_TEXT_COLOR, false);
        let times = Axis::linear(0.0, assessment.end);
        let mut top = TOP_MARGIN;
        for (place, panel) in panels.iter().enumerate() {
            picture.panel(panel, &times, top, place + 1 == panels.len());
            if let (1, Some(until)) = (place, verdict.trusted.until.filter(|_| !verdict.trusted.to_the_end)) {
                let x = picture.across(&times, until);
                picture.rule(vec![[x, top], [x, top + PANEL_HEIGHT]], FAINT_TEXT_COLOR);
            }
            top += PANEL_HEIGHT + PANEL_GAP;
        }
        Some(picture)
    }

    fn across(&self, times: &Axis, time: f64) -> f64 {
        LEFT_MARGIN + times.part(time) * (self.width - LEFT_MARGIN - RIGHT_MARGIN)
    }

    /// Draws a thin line along one axis or both, aligned to pixels.
    fn rule(&mut self, points: Vec<[f64; 2]>, color: Rgb) {
        let onto_pixels = |point: [f64; 2]| point.map(|place| place.floor() + 0.5);
        self.line(points.into_iter().map(onto_pixels).collect(), 1.0, color);
    }

    fn line(&mut self, points: Vec<[f64; 2]>, width: f64, color: Rgb) {
        self.items.push(Item::Line { points, width, color });
    }

    fn text(&mut self, at: [f64; 2], text: String, anchor: Anchor, color: Rgb, large: bool) {
        self.items.push(Item::Text { at, text, anchor, large, color });
    }

    fn panel(&mut self, panel: &Panel<'_>, times: &Axis, top: f64, is_last: bool) {
        let (left, right, bottom) = (LEFT_MARGIN, self.width - RIGHT_MARGIN, top + PANEL_HEIGHT);
        let axis = match panel.is_logarithmic {
            true => Axis::logarithmic(panel.values.iter().chain(&panel.mark)),
            false => Axis::around(panel.values.iter()),
        };
        let y = |value: f64| bottom - axis.part(value) * PANEL_HEIGHT;
        self.text([left, top - 18.0], panel.title.clone(), Anchor::Start, TEXT_COLOR, false);
        for (value, label) in axis.ticks() {
            self.rule(vec![[left, y(value)], [right, y(value)]], GRID_COLOR);
            self.text([left - 10.0, y(value)], label, Anchor::End, FAINT_TEXT_COLOR, false);
        }
        for (value, label) in times.ticks() {
            let x = self.across(times, value);
            self.rule(vec![[x, top], [x, bottom]], GRID_COLOR);
            let label = if is_last { format!("{label} s") } else { label };
            self.text([x, bottom + 16.0], label, Anchor::Middle, FAINT_TEXT_COLOR, false);
        }
        self.rule(vec![[left, top], [left, bottom], [right, bottom]], FAINT_TEXT_COLOR);
        if let Some(mark) = panel.mark {
            self.rule(vec![[left, y(mark)], [right, y(mark)]], FAINT_TEXT_COLOR);
        }
        let points = panel.times.iter().zip(&panel.values);
        // A logarithmic axis cannot show zero, so points with the value 0 are left out.
        let points =
            points.filter(|(_, value)| value.is_finite() && (!panel.is_logarithmic || **value > 0.0));
        let points = points.map(|(time, value)| [self.across(times, *time), y(*value).clamp(top, bottom)]);
        let points: Vec<[f64; 2]> = points.collect();
        self.line(thinned(&points), 2.0, panel.color);
    }
}

fn panels<'a>(assessment: &Assessment, verdict: &'a Verdict) -> Vec<Panel<'a>> {
    let Curves { times, drift, error, neighbours } = &verdict.curves;
    let parting = match verdict.neighbours {
        Separation::Chaotic { doubling_time, .. } => {
            format!(": chaotic, it doubles every {} s", text::digits(doubling_time, 2))
        }
        Separation::Sudden { time } => format!(": torn apart by t = {} s", text::digits(time, 3)),
        Separation::Unclear { .. } => ": perhaps chaotic".to_owned(),
        Separation::Regular { .. } => ": regular so far".to_owned(),
        Separation::Unknown => String::new(),
    };
    let wanted = text::digits(assessment.accuracy, 2);
    vec![
        Panel {
            title: format!("Drift of the energy, % of the {}", verdict.drift_scale.name()),
            times,
            values: drift.iter().map(|part| part * 100.0).collect(),
            is_logarithmic: false,
            mark: None,
            color: ENERGY_COLOR,
        },
        Panel {
            title: format!(
                "Error of the worst point, as a part of the size of the scene ({} m); the line marks {wanted}",
                text::digits(verdict.size, 3)
            ),
            times,
            values: error.clone(),
            is_logarithmic: true,
            mark: Some(assessment.accuracy),
            color: ERROR_COLOR,
        },
        Panel {
            title: format!("Distance of a twin that begins a hair elsewhere{parting}"),
            times,
            values: neighbours.clone(),
            is_logarithmic: true,
            mark: None,
            color: NEIGHBORS_COLOR,
        },
    ]
}

/// Removes invisible points of a curve. Within the width of a pixel, the first, highest, lowest and last point remain.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    let mut rest = points;
    while let Some(first) = rest.first() {
        let count = rest.partition_point(|point| point[0] < first[0] + 1.0).max(1);
        let (here, later) = rest.split_at(count);
        rest = later;
        let by_height = |a: &usize, b: &usize| here[*a][1].total_cmp(&here[*b][1]);
        let lowest = (0..count).min_by(by_height).unwrap_or(0);
        let highest = (0..count).max_by(by_height).unwrap_or(0);
        let mut places = vec![0, lowest, highest, count - 1];
        places.sort_unstable();
        places.dedup();
        kept.extend(places.into_iter().map(|place| here[place]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_keeps_its_peaks() {
        let points: Vec<[f64; 2]> = (0..10_000)
            .map(|k| [f64::from(k) * 0.01, if k == 5_003 { 9.0 } else { f64::from(k % 7) }])
            .collect();
        let kept = thinned(&points);
        assert!(kept.len() <= 4 * 101, "{}", kept.len());
        assert!(kept.contains(&points[5_003]) && kept.contains(&points[0]) && kept.contains(&points[9_999]));
        assert!(kept.is_sorted_by(|a, b| a[0] <= b[0]));
    }
}
