//! The grammar of prescribed motion: a motion that the scene gives as a function of time.

use super::Kind::{Choice, Either, File, List, Number, Table, Text, Timed, TimedNumbers};
use super::bodies::ORIENTATION;
use super::kind::{AXIS, VECTOR};
use super::{Bound, KeySpec, Kind, Rule, TableSpec};

/// A vector of three components, each a number or a formula of the time.
pub(super) const TIMED_VECTOR: Kind = TimedNumbers(3, Bound::Any);

pub(super) static MOTION: TableSpec = TableSpec {
    noun: "a motion",
    rule: Rule::ExactlyOne(&["formula", "keyframes", "trajectory"]),
    keys: &[
        KeySpec::new("formula", Table(&FORMULA), "By formulas of the time `t`").also(&["formulas", "path"]),
        KeySpec::new("keyframes", Table(&KEYFRAMES), "Through positions at given times")
            .also(&["keys", "frames"]),
        KeySpec::new(
            "trajectory",
            Table(&TRAJECTORY),
            "From a CSV file of another run or program; the body exists while the file has rows for it",
        )
        .also(&["csv", "file", "recording", "data"]),
    ],
};

static FORMULA: TableSpec = TableSpec {
    noun: "a motion by formulas",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("location", TIMED_VECTOR, "Its center of mass; formulas of `t`")
            .unit("m")
            .default("that of the body")
            .also(&["position", "pos"]),
        KeySpec::new(
            "orientation",
            Either(&[TIMED_VECTOR, Table(&TURNING)]),
            "Its orientation, by formulas of `t`: a list of three angles is short for `orientation.euler`",
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
        KeySpec::new("euler", TIMED_VECTOR, "Rotations about the world's x, then y, then z")
            .unit("degrees")
            .default("none"),
        KeySpec::new("axis", AXIS, "The axis of rotation; goes with `angle`").default("none"),
        KeySpec::new("angle", Timed(Bound::Any), "The angle of rotation about `axis`; a formula of `t`")
            .unit("degrees")
            .default("none"),
    ],
};

fn smoothness() -> Vec<&'static str> {
    vec!["smooth", "linear"]
}

/// The key that selects the interpolation between keyframes, for bodies and cameras.
pub(super) const BETWEEN_KEYFRAMES: KeySpec = KeySpec::new(
    "interpolation",
    Choice(smoothness),
    "The motion between keyframes: `smooth` starts and ends at rest, and may overshoot the keyframes; `linear` is straight \
     at constant speed, and does not",
)
.default_word("smooth")
.also(&["mode", "easing"]);

static KEYFRAMES: TableSpec = TableSpec {
    noun: "a motion by keyframes",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "at",
            List { of: &Table(&KEYFRAME), min: 1, max: 100_000 },
            "The keyframes, in order of time",
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
        KeySpec::new("time", Number(Bound::Any), "The time of the keyframe")
            .unit("s")
            .required()
            .also(&["t"]),
        KeySpec::new("location", VECTOR, "Its center of mass")
            .unit("m")
            .default("that of the previous keyframe, or of the body")
            .also(&["position", "pos"]),
        KeySpec::new("orientation", Either(&[VECTOR, Table(&ORIENTATION)]), "Its orientation, as for a body")
            .unit("degrees")
            .default("that of the previous keyframe, or of the body")
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
        KeySpec::new(
            "file",
            File,
            "The CSV file, beside the scene: a row for each time and body. A body exists from its first row \
             to its last, except in gaps: the file then has rows of other bodies, and none of this one for \
             more than 1.5 times its usual (median) interval",
        )
        .required()
        .also(&["csv", "path"]),
        KeySpec::new("body", Text, "The body's name in the file")
            .default("its name in the scene")
            .also(&["name"]),
        KeySpec::new("interpolation", Choice(polynomials), "The interpolation between rows")
            .default_word("cubic")
            .also(&["mode"]),
        KeySpec::new("columns", Table(&COLUMNS), "The names of the columns in the file"),
    ],
};

const NAMES: Kind = List { of: &Text, min: 3, max: 3 };

const NAMES_OR_NONE: Kind = List { of: &Text, min: 0, max: 3 };

static COLUMNS: TableSpec = TableSpec {
    noun: "names of columns",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("time", Text, "The column of the time").default("\"t\", or else \"time\"").also(&["t"]),
        KeySpec::new("body", Text, "The column of the body's name; without it, all rows belong to the body")
            .default("\"body\""),
        KeySpec::new("location", NAMES, "The columns of its center of mass").default("[\"x\", \"y\", \"z\"]"),
        KeySpec::new(
            "orientation",
            List { of: &Text, min: 4, max: 4 },
            "The columns of its orientation, a quaternion",
        )
        .default("[\"qx\", \"qy\", \"qz\", \"qw\"], if present"),
        KeySpec::new(
            "velocity",
            NAMES_OR_NONE,
            "The columns of its velocity, for cubic interpolation; `[]`: none",
        )
        .default("[\"vx\", \"vy\", \"vz\"], if present"),
        KeySpec::new(
            "angular_velocity",
            NAMES_OR_NONE,
            "The columns of its angular velocity, for cubic interpolation; `[]`: none",
        )
        .default("[\"wx\", \"wy\", \"wz\"], if present"),
    ],
};
