//! The grammar of the keys that draw measurements into the image: labels, plots, the scale bar and the grid.

use super::Kind::{
    Boolean, Choice, Color, Either, File, Integer, List, Named, Number, Reference, Table, Text,
};
use super::key::table;
use super::kind::{ANY, POSITIVE};
use super::{Bound, Collection, KeySpec, Kind, Rule};
use crate::scene::{Corner, GridPlane, Label, Plot, Side};

pub(super) fn corners() -> Vec<&'static str> {
    Corner::ALL.iter().map(|corner| corner.name()).collect()
}

fn places() -> Vec<&'static str> {
    corners().into_iter().chain([Label::CENTER]).collect()
}

fn sides() -> Vec<&'static str> {
    Side::ALL.iter().map(|side| side.name()).collect()
}

fn sides_of_plots() -> Vec<&'static str> {
    vec!["left", "right"]
}

fn planes() -> Vec<&'static str> {
    GridPlane::ALL.iter().map(|plane| plane.name()).collect()
}

static SCALE_BAR_KINDS: [Kind; 2] = [Boolean, Table(&scale_bar::TABLE)];
static GRID_KINDS: [Kind; 2] = [Boolean, Table(&grid::TABLE)];

pub(super) const LABEL: KeySpec =
    KeySpec::new("label", Named(&label::TABLE), "Texts in the picture, with [values of the moment](#labels)")
        .also(&["labels", "text", "caption"]);
pub(super) const PLOT: KeySpec = KeySpec::new(
    "plot",
    Named(&plot::TABLE),
    "Plots in the picture: curves of [measures](#labels) against the time",
)
.also(&["plots", "graph", "graphs", "chart", "diagram"]);
pub(super) const SCALE_BAR: KeySpec = KeySpec::new(
    "scale_bar",
    Either(&SCALE_BAR_KINDS),
    "A bar that shows a length at the center of the motion",
)
.default_flag(false)
.also(&["scalebar", "ruler", "scale"]);
pub(super) const GRID: KeySpec =
    KeySpec::new("grid", Either(&GRID_KINDS), "Lines with numbers in meters, to read positions from")
        .default_flag(false)
        .also(&["grids", "graph_paper"]);

table! {
    label: "a label", Rule::AtMostOne(&[&["body", "corner"]]);
    TEXT: Option<value::Text> = KeySpec::new(
        "text",
        Text,
        "The words; `${t:.2}` becomes the time with 2 decimals, and likewise for any formula",
    )
    .required()
    .also(&["content", "value", "caption"]),
    BODY: Option<value::Text> = KeySpec::new("body", Reference(Collection::Body), "The body that it labels")
        .default("none: the label stands in a corner")
        .also(&["on", "of", "attach", "attached_to"]),
    SIDE: value::Text = KeySpec::new("side", Choice(sides), "With `body`, its side of the body").default_word("above"),
    GHOSTS: bool = KeySpec::new(
        "ghosts",
        Boolean,
        "With `body`, whether each ghost has a label, too, with values of the ghost's time",
    )
    .default_flag(false),
    CORNER: value::Text = KeySpec::new(
        "corner",
        Choice(places),
        "Its corner of the picture, or its center; several stand below each other",
    )
        .default_word("top-left")
        .also(&["place", "position", "location", "at"]),
    SIZE: Option<f64> = KeySpec::new(
        "size",
        Number(Bound::From(0.01, 0.5)),
        "The height of its lines, as part of the picture's height",
    )
    .default("0.055, in the center 0.1, of the picture's shorter side, and at least 13 pixels")
    .also(&["font_size", "fontsize", "text_size", "height"]),
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "Its color")
        .default("dark, or light on a dark background")
        .also(&["colour"]),
    FONT: Option<value::Text> = KeySpec::new("font", File, "The file of its font, a TrueType font, relative to the scene's file")
        .default("DejaVu Sans")
        .also(&["typeface", "font_family", "font_file"]),
    FROM: Option<f64> = KeySpec::new("from", ANY, "When it appears")
        .unit("s")
        .default("the start of the run")
        .also(&["start", "begin", "appears", "since", "t0"]),
    UNTIL: Option<f64> = KeySpec::new("until", ANY, "When it disappears; the frame of this time does not show it, unless it is the last")
        .unit("s")
        .default("it stays")
        .also(&["end", "to", "vanishes", "disappears", "t1"]),
}

fn logarithmic_axes() -> Vec<&'static str> {
    Plot::LOGARITHMIC.iter().map(|(axes, _)| *axes).collect()
}

fn places_of_names() -> Vec<&'static str> {
    Plot::PLACES_OF_NAMES.to_vec()
}

static LOG_KINDS: [Kind; 2] = [Boolean, Choice(logarithmic_axes)];
static TEXTS: [Kind; 2] = [Text, List { of: &Text, min: 1, max: Plot::MAX_CURVES }];
static TEXTS_OF_BARS: [Kind; 2] = [Text, List { of: &Text, min: 1, max: Plot::MAX_BARS }];
const NUMBER: Kind = Number(Bound::Any);
/// A list of two numbers: the ends of a range.
pub(super) const TWO_NUMBERS: Kind = List { of: &NUMBER, min: 2, max: 2 };

table! {
    plot: "a plot", Rule::AtMostOne(&[&["y", "bars", "histogram"], &["corner", "side"]]);
    Y: Any = KeySpec::new(
        "y",
        Either(&TEXTS),
        "The measures to draw, each a curve: `\"ball.speed\"`, or a formula of measures, or a list of them",
    )
    .default("none: `bars` or `histogram` stands in its place")
    .also(&["ys", "curves", "series", "values", "of"]),
    BARS: Any = KeySpec::new(
        "bars",
        Either(&TEXTS_OF_BARS),
        "The measures to draw as bars, as high as their values at the moment of the picture; `\"ball.speed\"` of a repeated body is a bar for each copy",
    )
    .default("none: `y` or `histogram` stands in its place")
    .also(&["bar", "columns", "bar_chart"]),
    HISTOGRAM: Option<value::Text> = KeySpec::new(
        "histogram",
        Text,
        "The measure of copies whose distribution to draw: how many of them have values within equal ranges at the moment of the picture",
    )
    .default("none: `y` or `bars` stands in its place")
    .also(&["hist", "distribution"]),
    BINS: Option<i64> = KeySpec::new("bins", Integer(1, Plot::MAX_BINS as i64), "With `histogram`, the number of ranges")
        .default("the square root of the number of copies, from 5 to 30")
        .also(&["bin_count", "buckets", "classes"]),
    X: value::Text = KeySpec::new("x", Text, "The measure across: the time, or any other for a phase plot").default_word("t"),
    X_NAME: Option<value::Text> = KeySpec::new("x_name", Text, "The name of the measure across")
        .default("the formula")
        .also(&["xlabel", "x_label"]),
    NAMES: Any = KeySpec::new("names", Either(&TEXTS_OF_BARS), "The names of the curves, one for each")
        .default("the formulas")
        .also(&["name", "labels"]),
    COLORS: Any = KeySpec::new(
        "colors",
        List { of: &Color, min: 1, max: Plot::MAX_BARS },
        "The colors of the curves, one for each",
    )
    .default("those of their bodies, and others that one can tell apart")
    .also(&["color", "colours"]),
    LEGEND: value::Text = KeySpec::new(
        "legend",
        Choice(places_of_names),
        "Where the names of curves stand: above the plot, or at their right ends if there is room for all of them",
    )
        .default_word("top")
        .also(&["key", "legend_position"]),
    TITLE: Option<value::Text> = KeySpec::new("title", Text, "Its title")
        .default("none")
        .also(&["caption", "text"]),
    CORNER: Option<value::Text> = KeySpec::new("corner", Choice(corners), "Its corner of the picture; several stand below each other")
        .default("none: it stands at a `side`; top-right where that has no default")
        .also(&["place", "position", "location", "at"]),
    SIDE: Option<value::Text> = KeySpec::new(
        "side",
        Choice(sides_of_plots),
        "Its side of the picture, instead of a corner: a camera without a location shows the bodies beside it",
    )
    .default("right, so that it hides nothing; none if a plot has a `corner` or a `width` above 0.4, `[camera]` has a place, or the picture is higher than wide"),
    WIDTH: Option<f64> = KeySpec::new("width", Number(Bound::From(0.1, 1.0)), "Its width, as part of the picture's width; at a side at most 0.4; with 1, it fills the picture")
        .default("0.36, and more in small pictures")
        .also(&["size"]),
    RANGE: Option<Vec<f64>> = KeySpec::new("range", TWO_NUMBERS, "The lowest and the highest value of its vertical axis")
        .default("that of the curves")
        .also(&["y_range", "ylim", "limits"]),
    X_RANGE: Option<Vec<f64>> = KeySpec::new("x_range", TWO_NUMBERS, "The lowest and the highest value of its horizontal axis")
        .default("the whole run, or that of the curves")
        .also(&["xlim", "t_range"]),
    LOG: Any = KeySpec::new("log", Either(&LOG_KINDS), "Whether the vertical axis is logarithmic, or which axes are; values that are not positive are left out")
        .default_flag(false)
        .also(&["logarithmic", "log_scale", "logscale", "scale"]),
    AHEAD: bool = KeySpec::new("ahead", Boolean, "Whether the rest of each curve is drawn, too, in a pale color")
        .default_flag(false)
        .also(&["whole", "future"]),
}

table! {
    scale_bar: "the scale bar", Rule::Any;
    LENGTH: Option<f64> = KeySpec::new("length", POSITIVE, "The length to show")
        .unit("m")
        .default("1, 2 or 5 times a power of ten, about a fifth of the picture's width")
        .also(&["size", "width"]),
    CORNER: value::Text = KeySpec::new("corner", Choice(corners), "Its corner of the picture")
        .default_word("bottom-left")
        .also(&["place", "position", "location", "at"]),
}

table! {
    grid: "the grid", Rule::Any;
    SPACING: Option<f64> = KeySpec::new("spacing", POSITIVE, "The distance between lines")
        .unit("m")
        .default("that of the ground's tiles")
        .also(&["step", "every", "tile", "size"]),
    PLANE: value::Text = KeySpec::new("plane", Choice(planes), "Its plane: on the ground, upright behind the motion, or a coordinate plane through the origin")
        .default_word("ground"),
}
