//! The grammar of `repeat`, which makes copies of bodies, forces and joints.

use super::Kind::{Boolean, Either, Formulas, Integer, List, Numbers, Table};
use super::key::table;
use super::kind::{ANY, AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::{Bound, KeySpec, Kind, Rule};

/// The maximum number of copies in a scene. More copies would exceed the memory of a typical computer.
pub const MAX_COPIES: i64 = 500_000;

/// The type of a number of copies.
pub(super) const COUNT: Kind = Integer(1, MAX_COPIES);

/// The key that makes copies of a force or a joint.
pub(super) const LINKS: KeySpec = KeySpec::new(
    "repeat",
    COUNT,
    "The number of copies, `rod[0]`, `rod[1]`, …; formulas and names of bodies may contain their index `i`: \
     `bob[i]`, `link[i+1]`",
)
.default("one; if names of bodies contain `i`, as many as there are such bodies")
.also(&["copies", "times"]);

/// Describes the required key `count`, the number of copies in a pattern.
const fn count() -> KeySpec {
    KeySpec::new("count", COUNT, "The number of copies").required().also(&["n", "number", "copies"])
}

table! {
    repeat: "a repeat", Rule::ExactlyOne(&["count", "grid", "ring", "line", "curve", "scatter"]);
    COUNT: Option<i64> = KeySpec::new(
        "count",
        super::COUNT,
        "The number of copies, `ball[0]`, `ball[1]`, …, with the index `i` for formulas; `repeat = 9` \
         is short for it",
    )
    .also(&["n", "number", "copies", "times"]),
    GRID: Any = KeySpec::new(
        "grid",
        Table(&grid::TABLE),
        "Copies in rows, layers and columns: `brick[3,0]`, in formulas `i`, `j`, `k`",
    )
    .also(&["array", "lattice"]),
    RING: Any = KeySpec::new("ring", Table(&ring::TABLE), "Copies on a circle around `location`")
        .also(&["circle", "around"]),
    LINE: Any = KeySpec::new("line", Table(&line::TABLE), "Copies evenly spaced on a straight line, including both ends")
        .also(&["row"]),
    CURVE: Any = KeySpec::new("curve", Table(&curve::TABLE), "Copies evenly spaced along a curve")
        .also(&["path", "spline", "spiral"]),
    SCATTER: Any = KeySpec::new(
        "scatter",
        Table(&scatter::TABLE),
        "Copies at random positions in a volume around `location`, without overlap",
    )
    .also(&["random", "fill"]),
}

table! {
    grid: "a grid", Rule::Any;
    COUNT: Option<Vec<i64>> = KeySpec::new("count", List { of: &super::COUNT, min: 1, max: 3 }, "The numbers of copies along x, y and z")
        .required()
        .also(&["counts", "size", "n"]),
    SPACING: Any = KeySpec::new(
        "spacing",
        Either(&[ANY, List { of: &ANY, min: 1, max: 3 }]),
        "The distance between copies along x, y and z; one number is for all; the first copy is at \
         `location`",
    )
    .unit("m")
    .default("0: formulas of `i`, `j` and `k` place them")
    .also(&["distance", "step", "pitch"]),
}

table! {
    ring: "a ring", Rule::Any;
    COUNT: Option<i64> = count(),
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "The radius of the circle through the copies' centers")
        .unit("m")
        .required()
        .also(&["r", "diameter"]),
    AXIS: value::Axis = KeySpec::new(
        "axis",
        super::AXIS,
        "The axis of the circle, by the right-hand rule; the first copy is towards x, or towards y if x \
         is the axis",
    )
    .default_numbers(&[0.0, 1.0, 0.0])
    .also(&["normal"]),
    TURNED: bool = KeySpec::new(
        "turned",
        Boolean,
        "Whether each copy is rotated about the axis by its angle on the circle",
    )
    .default_flag(true)
    .also(&["align", "rotate"]),
}

table! {
    line: "a line", Rule::Any;
    COUNT: Option<i64> = count(),
    FROM: DVec3 = KeySpec::new("from", VECTOR, "The position of the first copy, relative to `location`")
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["start"]),
    TO: Option<DVec3> = KeySpec::new("to", VECTOR, "The position of the last copy, relative to `location`")
        .unit("m")
        .required()
        .also(&["end"]),
}

table! {
    curve: "a curve", Rule::ExactlyOne(&["at", "points"]);
    COUNT: Option<i64> = count(),
    AT: Any = KeySpec::new(
        "at",
        Formulas(3),
        "The curve, relative to `location`, by formulas of `u` from 0 to 1; copies are evenly spaced \
         for any parametrization",
    )
    .unit("m")
    .also(&["formula", "xyz"]),
    POINTS: Any = KeySpec::new(
        "points",
        List { of: &VECTOR, min: 2, max: usize::MAX },
        "Points of a smooth curve (Catmull–Rom spline), relative to `location`",
    )
    .unit("m")
    .also(&["through", "vertices"]),
    CLOSED: bool = KeySpec::new("closed", Boolean, "Whether it ends where it begins, with a single copy there")
        .default_flag(false)
        .also(&["loop", "cyclic"]),
    TURNED: bool = KeySpec::new(
        "turned",
        Boolean,
        "Whether each copy is rotated so that its x axis follows the curve, with y upwards",
    )
    .default_flag(true)
    .also(&["align", "follow"]),
}

table! {
    scatter: "a scatter", Rule::Any;
    COUNT: Option<i64> = count(),
    WITHIN: Any = KeySpec::new("within", Table(&volume::TABLE), "The volume, which contains each copy entirely")
        .required()
        .also(&["in", "volume", "region"]),
    GAP: f64 = KeySpec::new("gap", NON_NEGATIVE, "The least distance between the bounding balls of two copies")
        .unit("m")
        .default_number(0.0)
        .also(&["distance", "spacing"]),
    TURNED: bool = KeySpec::new("turned", Boolean, "Whether each copy has a random orientation, uniformly distributed")
        .default_flag(false)
        .also(&["rotate"]),
}

table! {
    volume: "a volume", Rule::ExactlyOne(&["box", "sphere", "cylinder"]);
    BOX: Any = KeySpec::new("box", Table(&cuboid::TABLE), "A box").also(&["cube", "cuboid"]),
    SPHERE: Any = KeySpec::new("sphere", Table(&sphere::TABLE), "A ball").also(&["ball"]),
    CYLINDER: Any = KeySpec::new("cylinder", Table(&cylinder::TABLE), "A cylinder around the y axis").also(&["disc", "disk"]),
}

table! {
    cuboid: "a box to scatter in", Rule::Any;
    SIZE: Option<DVec3> = KeySpec::new(
    "size",
    Numbers(3, Bound::NonNegative),
    "Its edges along x, y, z; 0 for a flat box",
)
.unit("m")
.required(),
}

table! {
    sphere: "a ball to scatter in", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required(),
}

table! {
    cylinder: "a cylinder to scatter in", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required(),
    HEIGHT: Option<f64> = KeySpec::new("height", NON_NEGATIVE, "Its height; 0 makes it a disc").unit("m").required(),
}
