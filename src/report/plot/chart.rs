//! Draws charts of several curves with logarithmic axes, such as errors over costs.

use super::axis::Axis;
use super::{FAINT_TEXT_COLOR, GRID_COLOR, Picture, TEXT_COLOR};
use crate::scene::Color;
use crate::svg::Anchor;

/// The width of a plot, pixels.
const PLOT_WIDTH: f64 = 1100.0;
/// The height of the margin above the first charts, for the title and the legend, pixels.
const TOP_MARGIN: f64 = 92.0;
/// The width of the margin at the left of the first chart in a row, pixels.
const LEFT_MARGIN: f64 = 90.0;
/// The horizontal and the vertical gap between two charts, pixels.
const CHART_GAP: [f64; 2] = [100.0, 96.0];
/// The width and the height of a chart, pixels.
const CHART_SIZE: [f64; 2] = [430.0, 330.0];
/// The number of charts in a row.
const CHARTS_PER_ROW: usize = 2;
/// The width of a letter in the legend, pixels.
const LEGEND_LETTER_WIDTH: f64 = 9.0;
/// The length of the line before a curve's name in the legend, pixels.
const LEGEND_LINE_LENGTH: f64 = 26.0;

/// A curve of a chart, through points of costs and errors.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The name of the curve in the legend. Curves with the same name have the same color in all charts.
    pub name: String,
    /// The points of the curve: horizontal and vertical value.
    pub points: Vec<[f64; 2]>,
}

/// A chart: several curves over common axes, both logarithmic.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The title above the chart.
    pub title: String,
    /// The labels of the horizontal and the vertical axis.
    pub axes: [String; 2],
    /// The curves of the chart.
    pub curves: Vec<Curve>,
}

impl Picture {
    /// Draws charts side by side under a common title, with a legend of the curves' names.
    #[must_use]
    pub fn of_charts(title: &str, charts: &[Chart]) -> Picture {
        let rows = f64::from(u8::try_from(charts.len().div_ceil(CHARTS_PER_ROW)).unwrap_or(u8::MAX));
        let height = TOP_MARGIN + rows * (CHART_SIZE[1] + CHART_GAP[1]);
        let mut picture = Picture { width: PLOT_WIDTH, height, items: Vec::new() };
        let mut names: Vec<&str> = Vec::new();
        for curve in charts.iter().flat_map(|chart| &chart.curves) {
            if !names.contains(&curve.name.as_str()) {
                names.push(&curve.name);
            }
        }
        picture.text([LEFT_MARGIN, 26.0], title.to_owned(), Anchor::Start, TEXT_COLOR, true);
        let [mut x, mut y] = [LEFT_MARGIN, 52.0];
        for (name, color) in names.iter().zip(Color::OF_CURVES.into_iter().cycle()) {
            let width = LEGEND_LINE_LENGTH
                + 22.0
                + LEGEND_LETTER_WIDTH * f64::from(u8::try_from(name.len()).unwrap_or(u8::MAX));
            if x + width > PLOT_WIDTH {
                [x, y] = [LEFT_MARGIN, y + 22.0];
            }
            picture.line(vec![[x, y], [x + LEGEND_LINE_LENGTH, y]], 3.0, color.bytes());
            picture.text(
                [x + LEGEND_LINE_LENGTH + 7.0, y],
                (*name).to_owned(),
                Anchor::Start,
                TEXT_COLOR,
                false,
            );
            x += width;
        }
        let mut corner = [LEFT_MARGIN, TOP_MARGIN + 26.0];
        for (place, chart) in charts.iter().enumerate() {
            picture.chart(chart, corner, &names);
            corner[0] += CHART_SIZE[0] + CHART_GAP[0];
            if place % CHARTS_PER_ROW == CHARTS_PER_ROW - 1 {
                corner = [LEFT_MARGIN, corner[1] + CHART_SIZE[1] + CHART_GAP[1]];
            }
        }
        picture
    }

    fn chart(&mut self, chart: &Chart, [left, top]: [f64; 2], names: &[&str]) {
        let points = || chart.curves.iter().flat_map(|curve| &curve.points);
        let across = Axis::logarithmic(points().map(|[x, _]| x));
        let up = Axis::logarithmic(points().map(|[_, y]| y));
        let [right, bottom] = [left + CHART_SIZE[0], top + CHART_SIZE[1]];
        let x = |value: f64| left + across.part(value) * CHART_SIZE[0];
        let y = |value: f64| bottom - up.part(value) * CHART_SIZE[1];
        self.text([left, top - 18.0], chart.title.clone(), Anchor::Start, TEXT_COLOR, false);
        for (value, label) in up.ticks() {
            self.rule(vec![[left, y(value)], [right, y(value)]], GRID_COLOR);
            self.text([left - 10.0, y(value)], label, Anchor::End, FAINT_TEXT_COLOR, false);
        }
        for (value, label) in across.ticks() {
            self.rule(vec![[x(value), top], [x(value), bottom]], GRID_COLOR);
            self.text([x(value), bottom + 16.0], label, Anchor::Middle, FAINT_TEXT_COLOR, false);
        }
        self.rule(vec![[left, top], [left, bottom], [right, bottom]], FAINT_TEXT_COLOR);
        let [below, beside] = &chart.axes;
        self.text(
            [right, bottom + 40.0],
            format!("{beside}, over {below}"),
            Anchor::End,
            FAINT_TEXT_COLOR,
            false,
        );
        for curve in &chart.curves {
            let number = names.iter().position(|name| *name == curve.name).unwrap_or_default();
            let color = Color::OF_CURVES[number % Color::OF_CURVES.len()].bytes();
            let points: Vec<[f64; 2]> = curve.points.iter().map(|point| [x(point[0]), y(point[1])]).collect();
            for [x, y] in &points {
                self.line(vec![[x - 3.0, *y], [x + 3.0, *y]], 6.0, color);
            }
            self.line(points, 2.0, color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Item, svg};
    use super::*;

    fn chart(name: &str) -> Chart {
        let curve = Curve { name: name.to_owned(), points: vec![[1.0, 1.0], [10.0, 1e-4], [100.0, 1e-8]] };
        let axes = ["cost", "error"].map(str::to_owned);
        Chart { title: "Fall < rise".to_owned(), axes, curves: vec![curve] }
    }

    #[test]
    fn curves_of_a_name_have_one_color_and_stay_within_their_axes() {
        let picture = Picture::of_charts("Three", &[chart("one"), chart("two"), chart("one")]);
        let curves: Vec<_> = picture
            .items
            .iter()
            .filter_map(|item| match item {
                Item::Line { points, color, .. } if points.len() == 3 && *color != FAINT_TEXT_COLOR => {
                    Some((points.clone(), *color))
                }
                _ => None,
            })
            .collect();
        assert_eq!(curves.len(), 3);
        assert!(curves[0].1 == curves[2].1 && curves[0].1 != curves[1].1);
        // A power law is a straight line between logarithmic axes.
        let points = &curves[0].0;
        assert!((points[0][1] + points[2][1] - 2.0 * points[1][1]).abs() < 1e-9);
        assert_eq!(
            (points[0], points[2][0] - points[0][0]),
            ([LEFT_MARGIN, TOP_MARGIN + 26.0], CHART_SIZE[0])
        );
        assert!(svg(&picture).contains("Fall &lt; rise"));
    }
}
