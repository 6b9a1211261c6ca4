//! The grammar of the keys that draw measurements into the image: labels, the scale bar and the grid.

use super::Kind::{Boolean, Choice, Color, Either, Named, Number, Reference, Table, Text};
use super::key::table;
use super::kind::POSITIVE;
use super::{Bound, Collection, KeySpec, Kind, Rule};
use crate::scene::{Corner, GridPlane, Side};

fn corners() -> Vec<&'static str> {
    Corner::ALL.iter().map(|corner| corner.name()).collect()
}

fn sides() -> Vec<&'static str> {
    Side::ALL.iter().map(|side| side.name()).collect()
}

fn planes() -> Vec<&'static str> {
    GridPlane::ALL.iter().map(|plane| plane.name()).collect()
}

static SCALE_BAR_KINDS: [Kind; 2] = [Boolean, Table(&scale_bar::TABLE)];
static GRID_KINDS: [Kind; 2] = [Boolean, Table(&grid::TABLE)];

pub(super) const LABEL: KeySpec =
    KeySpec::new("label", Named(&label::TABLE), "Texts in the picture, with [values of the moment](#labels)")
        .also(&["labels", "text", "caption"]);
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
    CORNER: value::Text = KeySpec::new("corner", Choice(corners), "Its corner of the picture; several stand below each other")
        .default_word("top-left")
        .also(&["place", "position", "location", "at"]),
    SIZE: Option<f64> = KeySpec::new(
        "size",
        Number(Bound::From(0.01, 0.5)),
        "The height of its lines, as part of the picture's height",
    )
    .default("0.055, and at least 13 pixels")
    .also(&["font_size", "fontsize", "text_size", "height"]),
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "Its color")
        .default("dark, or light on a dark background")
        .also(&["colour"]),
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
    PLANE: value::Text = KeySpec::new("plane", Choice(planes), "Its plane: on the ground, or upright behind the motion")
        .default_word("ground"),
}
