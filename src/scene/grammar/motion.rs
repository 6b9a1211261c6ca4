//! The keys of motion that is given.

use super::Kind::{Choice, Either, File, List, Number, Table, Text, Timed, TimedNumbers};
use super::keys::{AXIS, ORIENTATION, VECTOR};
use super::{Bound, Key, Kind, Rule, TableSpec};

/// A vector that may change with time.
pub(super) const TIMED_VECTOR: Kind = TimedNumbers(3, Bound::Any);

pub(super) static MOTION: TableSpec = TableSpec {
    noun: "a motion",
    rule: Rule::ExactlyOne(&["formula", "keyframes", "trajectory"]),
    keys: &[
        Key::new("formula", Table(&FORMULA), "By formulas of the time `t`").also(&["formulas", "path"]),
        Key::new("keyframes", Table(&KEYFRAMES), "Through some places at given times")
            .also(&["keys", "frames"]),
        Key::new(
            "trajectory",
            Table(&TRAJECTORY),
            "As a CSV file has it, from another run or another program; the body is there while it has rows",
        )
        .also(&["csv", "file", "recording", "data"]),
    ],
};

static FORMULA: TableSpec = TableSpec {
    noun: "a motion by formulas",
    rule: Rule::Any,
    keys: &[
        Key::new("location", TIMED_VECTOR, "Its centre of mass; formulas of `t`")
            .unit("m")
            .default("that of the body")
            .also(&["position", "pos"]),
        Key::new(
            "orientation",
            Either(&[TIMED_VECTOR, Table(&TURNING)]),
            "How it is turned, by formulas of `t`: a list of three angles is short for `orientation.euler`",
        )
        .unit("degrees")
        .default("that of the body")
        .also(&["rotation", "rotate"]),
    ],
};

static TURNING: TableSpec = TableSpec {
    noun: "a turning",
    rule: Rule::AtMostOne(&[&["euler", "axis"], &["euler", "angle"]]),
    keys: &[
        Key::new("euler", TIMED_VECTOR, "Turned about the world's x, then y, then z")
            .unit("degrees")
            .default("none"),
        Key::new("axis", AXIS, "The axis that it is turned about; goes with `angle`").default("none"),
        Key::new("angle", Timed(Bound::Any), "By how much it is turned about `axis`; a formula of `t`")
            .unit("degrees")
            .default("none"),
    ],
};

fn smoothness() -> Vec<&'static str> {
    vec!["smooth", "linear"]
}

/// How keyframes of bodies and of cameras are joined.
pub(super) const BETWEEN_KEYFRAMES: Key = Key::new(
    "interpolation",
    Choice(smoothness),
    "How it gets from one to the next: smoothly, beginning and ending at rest, or straight and evenly",
)
.default_word("smooth")
.also(&["mode", "easing"]);

static KEYFRAMES: TableSpec = TableSpec {
    noun: "a motion by keyframes",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "at",
            List { of: &Table(&KEYFRAME), min: 1, max: 100_000 },
            "The places, in the order of their times",
        )
        .required()
        .also(&["keys", "poses", "frames"]),
        BETWEEN_KEYFRAMES,
    ],
};

static KEYFRAME: TableSpec = TableSpec {
    noun: "a keyframe",
    rule: Rule::Any,
    keys: &[
        Key::new("time", Number(Bound::Any), "When it is there").unit("s").required().also(&["t"]),
        Key::new("location", VECTOR, "Its centre of mass")
            .unit("m")
            .default("that of the keyframe before, or of the body")
            .also(&["position", "pos"]),
        Key::new("orientation", Either(&[VECTOR, Table(&ORIENTATION)]), "How it is turned, as at a body")
            .unit("degrees")
            .default("that of the keyframe before, or of the body")
            .also(&["rotation", "rotate"]),
    ],
};

fn polynomials() -> Vec<&'static str> {
    vec!["cubic", "linear"]
}

static TRAJECTORY: TableSpec = TableSpec {
    noun: "a motion from a file",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "file",
            File,
            "The CSV file, beside the scene: a row for each time and body. A body is there from its first row to its last, \
             but for gaps: there the file has rows of others, and none of it for more than 1.5 times its usual (median) interval",
        )
            .required()
            .also(&["csv", "path"]),
        Key::new("body", Text, "The name that the body has in the file")
            .default("its name here")
            .also(&["name"]),
        Key::new("interpolation", Choice(polynomials), "How it gets from one row to the next")
            .default_word("cubic")
            .also(&["mode"]),
        Key::new("columns", Table(&COLUMNS), "What the columns are called in the file"),
    ],
};

const NAMES: Kind = List { of: &Text, min: 3, max: 3 };

static COLUMNS: TableSpec = TableSpec {
    noun: "names of columns",
    rule: Rule::Any,
    keys: &[
        Key::new("time", Text, "The column with the time").default("\"t\", or else \"time\"").also(&["t"]),
        Key::new(
            "body",
            Text,
            "The column with the name of the body; where there is none, all rows are the body's",
        )
        .default("\"body\""),
        Key::new("location", NAMES, "The columns with its centre of mass").default("[\"x\", \"y\", \"z\"]"),
        Key::new(
            "orientation",
            List { of: &Text, min: 4, max: 4 },
            "The columns with its orientation, a quaternion",
        )
        .default("[\"qx\", \"qy\", \"qz\", \"qw\"], if they are there"),
        Key::new("velocity", NAMES, "The columns with its velocity, for cubic interpolation")
            .default("[\"vx\", \"vy\", \"vz\"], if they are there"),
        Key::new("angular_velocity", NAMES, "The columns with its angular velocity, for cubic interpolation")
            .default("[\"wx\", \"wy\", \"wz\"], if they are there"),
    ],
};
