//! The plots of a scene: curves, bars and histograms of measures, drawn in the picture.

use std::sync::Arc;

use super::{Color, Corner, Measure, MeasureFormula, RunMeasure};

/// A plot in the picture: curves of measures against the time or another measure, or bars of their present values.
#[derive(Clone, Debug)]
pub struct Plot {
    /// The name of the plot, unique among plots.
    pub name: String,
    /// The title above the plot.
    pub title: Option<String>,
    /// The measure across.
    pub x: MeasureFormula,
    /// The name of the horizontal axis, such as `t` or `ball.x`.
    pub x_name: String,
    /// What the plot draws.
    pub kind: PlotKind,
    /// The curves, at least one. Each bar is the present value of one of them.
    pub curves: Vec<Curve>,
    /// The position of the plot in the picture.
    pub place: PlotPlace,
    /// The width of the plot as a fraction of the picture's width. `None` for a width at which it is easy to read.
    pub width: Option<f64>,
    /// The lowest and the highest value of the horizontal axis. `None` for the values of the curves.
    pub x_range: Option<[f64; 2]>,
    /// The lowest and the highest value of the vertical axis. `None` for the values of the curves.
    pub range: Option<[f64; 2]>,
    /// Whether the horizontal and the vertical axis are logarithmic.
    pub is_logarithmic: [bool; 2],
    /// Whether the names of the curves stand at their ends, where they have room.
    pub has_names_at_ends: bool,
    /// Whether the future part of each curve is drawn in a pale color.
    pub ahead: bool,
}

/// What a plot draws.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlotKind {
    /// Curves of measures, against the time or another measure.
    Curves,
    /// A bar for each measure, as high as its present value.
    Bars {
        /// Whether the measures are the same one of each copy of a body. The bars then have one color.
        are_copies: bool,
    },
    /// How many of several bodies have values within equal ranges, at the present moment. The only curve of the plot has the formula.
    Histogram {
        /// The indices of the bodies in the scene, in ascending order.
        bodies: Arc<[usize]>,
        /// The number of ranges.
        bins: u8,
    },
}

/// The position of a plot in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotPlace {
    /// In a corner, or at the middle of an edge, in front of the bodies.
    Corner(Corner),
    /// At the left side of the picture. A camera without a given position shows the bodies in the rest of the picture.
    Left,
    /// At the right side of the picture. A camera without a given position shows the bodies in the rest of the picture.
    Right,
}

/// A curve of a plot.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The name of the curve in the legend.
    pub name: String,
    /// The measure upwards.
    pub y: MeasureFormula,
    /// The color of the curve. `None` for that of its body, or one of its own.
    pub color: Option<Color>,
}

impl PlotKind {
    /// The noun for one of the things that the plot draws.
    pub fn noun(&self) -> &'static str {
        match self {
            PlotKind::Curves => "curve",
            PlotKind::Bars { .. } => "bar",
            PlotKind::Histogram { .. } => "histogram",
        }
    }
}

impl Plot {
    /// Returns whether a point has a place on the axes: a logarithmic axis has none for zero and negative values.
    pub fn has_place(&self, at: [f64; 2]) -> bool {
        self.is_logarithmic.into_iter().zip(at).all(|(is_logarithmic, value)| !is_logarithmic || value > 0.0)
    }

    /// Returns whether the measure across is the time.
    pub fn is_over_time(&self) -> bool {
        self.x.single == Some(Measure::Run(RunMeasure::Time))
    }

    /// The maximum number of curves in a plot. More could not be told apart.
    pub const MAX_CURVES: usize = Color::OF_CURVES.len();
    /// The maximum number of bars of a plot. Between more, their names would have no room.
    pub const MAX_BARS: usize = 24;
    /// The largest number of bins of a histogram.
    pub const MAX_BINS: u8 = 200;
    /// The largest value that an axis can have.
    pub const MAX_VALUE: f64 = 1e290;
    /// The word for names at the ends of curves, and that for names above the plot.
    pub const PLACES_OF_NAMES: [&'static str; 2] = ["ends", "top"];
    /// The words for logarithmic axes, each with whether the horizontal and the vertical axis are.
    pub const LOGARITHMIC: [(&'static str, [bool; 2]); 3] =
        [("x", [true, false]), ("y", [false, true]), ("xy", [true, true])];
    /// The largest width of a plot at a side of the picture, as a fraction of the picture's width.
    pub const MAX_WIDTH_AT_SIDE: f64 = 0.4;
}
