//! The grammar of the marks that name what is measured: angles, dimension lines, swept areas, fields.

use super::Kind::{Boolean, Choice, Color, Either, Integer, List, Named, Reference, Table, Text};
use super::forces::end;
use super::key::table;
use super::kind::{AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::{Collection, KeySpec, Kind, Rule};
use crate::scene::FieldStyle;

pub(super) const ANGLE: KeySpec =
    KeySpec::new("angle", Named(&angle::TABLE), "Angles, drawn as arcs between two directions")
        .also(&["angles", "arc"]);
pub(super) const DISTANCE: KeySpec = KeySpec::new(
    "distance",
    Named(&distance::TABLE),
    "Dimension lines: distances, drawn as lines with their length",
)
.also(&["distances", "dimension", "dimensions", "length"]);

pub(super) const AREA: KeySpec = KeySpec::new(
    "area",
    Named(&area::TABLE),
    "Areas that the line from a center to a body sweeps, drawn as sectors",
)
.also(&["areas", "sector", "sectors"]);

pub(super) const FIELD: KeySpec = KeySpec::new(
    "field",
    Named(&field::TABLE),
    "The fields of forces, drawn in a plane as arrows, as field lines or as lines of equal potential",
)
.also(&["fields", "vector_field"]);

fn styles() -> Vec<&'static str> {
    FieldStyle::ALL.iter().map(|style| style.name()).collect()
}

/// A point: the center of a body, a point of a body, or a point of the world.
static POINT_KINDS: [Kind; 3] = [Reference(Collection::Body), VECTOR, Table(&end::TABLE)];
const POINT: Kind = Either(&POINT_KINDS);
static LEG_KINDS: [Kind; 3] = [Text, AXIS, Table(&leg::TABLE)];
pub(super) const LEG: Kind = Either(&LEG_KINDS);

table! {
    angle: "an angle", Rule::Any;
    AT: Any = KeySpec::new(
        "at",
        POINT,
        "Its vertex: the name of a body (its center), a point of a body, or a point of the world",
    )
    .unit("m")
    .required()
    .also(&["vertex", "center", "location", "position"]),
    FROM: Any = KeySpec::new(
        "from",
        LEG,
        "Its first leg: a direction `[1, 0, 0]`, the name of a body that it points to, a point \
         `{ body = \"bob\", at = [0, 0.1, 0] }` or `{ point = [0, 2, 0] }`, or a vector of a body: `\"ball.velocity\"`",
    )
    .required()
    .also(&["start", "begin"]),
    TO: Any = KeySpec::new("to", LEG, "Its second leg, likewise").required().also(&["end"]),
    AXIS: Option<value::Axis> = KeySpec::new(
        "axis",
        super::AXIS,
        "The axis about which it counts, counterclockwise from the first leg as seen from the tip of the axis, from −180° to 180°",
    )
    .default("none: the angle between the legs, from 0° to 180°")
    .also(&["about", "normal"]),
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "The radius of its arc")
        .unit("m")
        .default("a tenth of the picture's width")
        .also(&["size"]),
    TEXT: Option<value::Text> = KeySpec::new(
        "text",
        Text,
        "Its text, with values as in a label: `\"α = ${angle.alpha:.0}°\"`",
    )
    .default("its name; as a Greek letter if the name spells one")
    .also(&["label", "name"]),
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "Its color")
        .default("that of texts")
        .also(&["colour"]),
}

table! {
    /// The grammar of a leg that points to a point.
    leg: "a leg of an angle", Rule::ExactlyOne(&["body", "point"]);
    BODY: Option<value::Text> = KeySpec::new("body", Reference(Collection::Body), "The body that it points to"),
    POINT: Option<DVec3> = KeySpec::new("point", VECTOR, "The point of the world that it points to").unit("m"),
    AT: DVec3 = KeySpec::new("at", VECTOR, "With `body`, the point in the body's own axes, relative to its center of mass")
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["offset"]),
}

table! {
    distance: "a distance", Rule::Any;
    BETWEEN: Any = KeySpec::new(
        "between",
        List { of: &POINT, min: 2, max: 2 },
        "Its ends: each the name of a body (its center), a point of a body, or a point of the world",
    )
    .unit("m")
    .required()
    .also(&["bodies", "ends", "points"]),
    ALONG: Option<value::Axis> = KeySpec::new("along", AXIS, "The direction in which it is measured, such as `[0, 1, 0]` for a height")
        .default("from end to end")
        .also(&["direction", "axis"]),
    OFFSET: DVec3 = KeySpec::new("offset", VECTOR, "The way from its ends to its line")
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["aside", "shift"]),
    TEXT: Option<value::Text> = KeySpec::new("text", Text, "Its text, with values as in a label: `\"h = ${distance.h:.2} m\"`")
        .default("the distance with its unit")
        .also(&["label", "name"]),
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "Its color")
        .default("that of texts")
        .also(&["colour"]),
}

table! {
    area: "a swept area", Rule::Any;
    BODY: Option<value::Text> = KeySpec::new("body", Reference(Collection::Body), "The body that the line leads to")
        .required()
        .also(&["to", "of", "planet"]),
    CENTER: Any = KeySpec::new(
        "center",
        POINT,
        "Where the line begins: the name of a body (its center), a point of a body, or a point of the world. The path of `body` is \
         that relative to the center",
    )
    .unit("m")
    .required()
    .also(&["centre", "about", "around", "focus", "sun"]),
    EVERY: Option<f64> = KeySpec::new("every", POSITIVE, "The time of each sector. The sectors follow each other")
        .unit("s")
        .default("a single sector, from `from` until `until`")
        .also(&["interval", "period", "step"]),
    FROM: Option<f64> = KeySpec::new("from", NON_NEGATIVE, "When the first sector begins")
        .unit("s")
        .default("the start of the run")
        .also(&["start", "begin", "since", "t0"]),
    UNTIL: Option<f64> = KeySpec::new("until", NON_NEGATIVE, "When the last sector ends at the latest")
        .unit("s")
        .default("the end of the run")
        .also(&["end", "t1"]),
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "The color of the sectors; every second one is paler")
        .default("one of the palette of plots")
        .also(&["colour"]),
}

table! {
    field: "a field", Rule::Any;
    FORCE: Option<value::Text> = KeySpec::new(
        "force",
        Reference(Collection::Force),
        "The force whose field is drawn: the force on a body of 1 kg and 1 C at rest; of magnets, their magnetic field",
    )
    .required()
    .also(&["of", "from", "source"]),
    SHOW: value::Text = KeySpec::new(
        "show",
        Choice(styles),
        "How it is drawn: as arrows on a grid, as field lines, or as lines of equal potential",
    )
    .default_word("arrows")
    .also(&["as", "draw", "kind", "style", "type"]),
    MAGNETIC: bool = KeySpec::new("magnetic", Boolean, "Whether the magnetic field of a `lorentz` force is drawn instead of the electric one")
        .default_flag(false)
        .also(&["part"]),
    NORMAL: Option<value::Axis> = KeySpec::new("normal", super::AXIS, "The normal of the plane in which it is drawn")
        .default("the axis nearest to the view of the camera")
        .also(&["plane", "axis"]),
    AT: Option<DVec3> = KeySpec::new("at", VECTOR, "A point of the plane")
        .unit("m")
        .default("the middle of the bodies that cause the force")
        .also(&["location", "point", "through"]),
    SPACING: Option<f64> = KeySpec::new("spacing", POSITIVE, "The distance between arrows")
        .unit("m")
        .default("an eighteenth of the picture's width")
        .also(&["step", "every"]),
    SCALE: Option<f64> = KeySpec::new("scale", POSITIVE, "The length of an arrow for a field of 1 N, or of 1 T, in m")
        .default("lengths grow with the root of the field, so that weak parts are seen, too"),
    COUNT: i64 = KeySpec::new(
        "count",
        Integer(1, 200),
        "The number of field lines at the strongest source; of a field without sources, the number of lines across the picture",
    )
    .default_number(16.0)
    .also(&["lines", "number", "density"]),
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "Its color").default("one of the palette of plots").also(&["colour"]),
}
