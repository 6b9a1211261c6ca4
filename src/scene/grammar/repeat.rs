//! The grammar of `repeat`, which makes copies of bodies, forces and joints.

use super::Kind::{Boolean, Either, Formulas, Integer, List, Numbers, Table};
use super::kind::{ANY, AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::{Bound, KeySpec, Kind, Rule, TableSpec};

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

pub(super) static REPEAT: TableSpec = TableSpec {
    noun: "a repeat",
    rule: Rule::ExactlyOne(&["count", "grid", "ring", "line", "curve", "scatter"]),
    keys: &[
        KeySpec::new(
            "count",
            COUNT,
            "The number of copies, `ball[0]`, `ball[1]`, …, with the index `i` for formulas; `repeat = 9` \
             is short for it",
        )
        .also(&["n", "number", "copies", "times"]),
        KeySpec::new(
            "grid",
            Table(&GRID),
            "Copies in rows, layers and columns: `brick[3,0]`, in formulas `i`, `j`, `k`",
        )
        .also(&["array", "lattice"]),
        KeySpec::new("ring", Table(&RING), "Copies on a circle around `location`")
            .also(&["circle", "around"]),
        KeySpec::new("line", Table(&LINE), "Copies evenly spaced on a straight line, including both ends")
            .also(&["row"]),
        KeySpec::new("curve", Table(&CURVE), "Copies evenly spaced along a curve")
            .also(&["path", "spline", "spiral"]),
        KeySpec::new(
            "scatter",
            Table(&SCATTER),
            "Copies at random positions in a volume around `location`, without overlap",
        )
        .also(&["random", "fill"]),
    ],
};

static GRID: TableSpec = TableSpec {
    noun: "a grid",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("count", List { of: &COUNT, min: 1, max: 3 }, "The numbers of copies along x, y and z")
            .required()
            .also(&["counts", "size", "n"]),
        KeySpec::new(
            "spacing",
            Either(&[ANY, List { of: &ANY, min: 1, max: 3 }]),
            "The distance between copies along x, y and z; one number is for all; the first copy is at \
             `location`",
        )
        .unit("m")
        .default("0: formulas of `i`, `j` and `k` place them")
        .also(&["distance", "step", "pitch"]),
    ],
};

static RING: TableSpec = TableSpec {
    noun: "a ring",
    rule: Rule::Any,
    keys: &[
        count(),
        KeySpec::new("radius", POSITIVE, "The radius of the circle through the copies' centers")
            .unit("m")
            .required()
            .also(&["r", "diameter"]),
        KeySpec::new(
            "axis",
            AXIS,
            "The axis of the circle, by the right-hand rule; the first copy is towards x, or towards y if x \
             is the axis",
        )
        .default_numbers(&[0.0, 1.0, 0.0])
        .also(&["normal"]),
        KeySpec::new(
            "turned",
            Boolean,
            "Whether each copy is rotated about the axis by its angle on the circle",
        )
        .default_flag(true)
        .also(&["align", "rotate"]),
    ],
};

static LINE: TableSpec = TableSpec {
    noun: "a line",
    rule: Rule::Any,
    keys: &[
        count(),
        KeySpec::new("from", VECTOR, "The position of the first copy, relative to `location`")
            .unit("m")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["start"]),
        KeySpec::new("to", VECTOR, "The position of the last copy, relative to `location`")
            .unit("m")
            .required()
            .also(&["end"]),
    ],
};

static CURVE: TableSpec = TableSpec {
    noun: "a curve",
    rule: Rule::ExactlyOne(&["at", "points"]),
    keys: &[
        count(),
        KeySpec::new(
            "at",
            Formulas(3),
            "The curve, relative to `location`, by formulas of `u` from 0 to 1; copies are evenly spaced \
             for any parametrization",
        )
        .unit("m")
        .also(&["formula", "xyz"]),
        KeySpec::new(
            "points",
            List { of: &VECTOR, min: 2, max: usize::MAX },
            "Points of a smooth curve (Catmull–Rom spline), relative to `location`",
        )
        .unit("m")
        .also(&["through", "vertices"]),
        KeySpec::new("closed", Boolean, "Whether it ends where it begins, with a single copy there")
            .default_flag(false)
            .also(&["loop", "cyclic"]),
        KeySpec::new(
            "turned",
            Boolean,
            "Whether each copy is rotated so that its x axis follows the curve, with y upwards",
        )
        .default_flag(true)
        .also(&["align", "follow"]),
    ],
};

static SCATTER: TableSpec = TableSpec {
    noun: "a scatter",
    rule: Rule::Any,
    keys: &[
        count(),
        KeySpec::new("within", Table(&VOLUME), "The volume, which contains each copy entirely")
            .required()
            .also(&["in", "volume", "region"]),
        KeySpec::new("gap", NON_NEGATIVE, "The least distance between the bounding balls of two copies")
            .unit("m")
            .default_number(0.0)
            .also(&["distance", "spacing"]),
        KeySpec::new("turned", Boolean, "Whether each copy has a random orientation, uniformly distributed")
            .default_flag(false)
            .also(&["rotate"]),
    ],
};

static VOLUME: TableSpec = TableSpec {
    noun: "a volume",
    rule: Rule::ExactlyOne(&["box", "sphere", "cylinder"]),
    keys: &[
        KeySpec::new("box", Table(&BOX), "A box").also(&["cube", "cuboid"]),
        KeySpec::new("sphere", Table(&SPHERE), "A ball").also(&["ball"]),
        KeySpec::new("cylinder", Table(&CYLINDER), "A cylinder around the y axis").also(&["disc", "disk"]),
    ],
};

static BOX: TableSpec = TableSpec {
    noun: "a box to scatter in",
    rule: Rule::Any,
    keys: &[KeySpec::new(
        "size",
        Numbers(3, Bound::NonNegative),
        "Its edges along x, y, z; 0 for a flat box",
    )
    .unit("m")
    .required()],
};

static SPHERE: TableSpec = TableSpec {
    noun: "a ball to scatter in",
    rule: Rule::Any,
    keys: &[KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required()],
};

static CYLINDER: TableSpec = TableSpec {
    noun: "a cylinder to scatter in",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required(),
        KeySpec::new("height", NON_NEGATIVE, "Its height; 0 makes it a disc").unit("m").required(),
    ],
};
