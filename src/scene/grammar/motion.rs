//! The grammar of prescribed motion: a motion that the scene gives as a function of time.

use super::Kind::{Choice, Either, File, List, Number, Table, Text, Timed, TimedNumbers};
use super::bodies;
use super::key::table;
use super::kind::{AXIS, VECTOR};
use super::{Bound, KeySpec, Kind, Rule};

/// A vector of three components, each a number or a formula of the time.
pub(super) const TIMED_VECTOR: Kind = TimedNumbers(3, Bound::Any);

table! {
    motion: "a motion", Rule::ExactlyOne(&["formula", "keyframes", "trajectory"]);
    FORMULA: Any = KeySpec::new("formula", Table(&formula::TABLE), "By formulas of the time `t`").also(&["formulas", "path"]),
    KEYFRAMES: Any = KeySpec::new("keyframes", Table(&keyframes::TABLE), "Through positions at given times")
        .also(&["keys", "frames"]),
    TRAJECTORY: Any = KeySpec::new(
        "trajectory",
        Table(&trajectory::TABLE),
        "From a CSV file of another run or program; the body exists while the file has rows for it",
    )
    .also(&["csv", "file", "recording", "data"]),
}

table! {
    formula: "a motion by formulas", Rule::Any;
    LOCATION: Option<value::TimedVector> = KeySpec::new("location", TIMED_VECTOR, "Its center of mass; formulas of `t`")
        .unit("m")
        .default("that of the body")
        .also(&["position", "pos"]),
    ORIENTATION: Any = KeySpec::new(
        "orientation",
        Either(&[TIMED_VECTOR, Table(&turning::TABLE)]),
        "Its orientation, by formulas of `t`: a list of three angles is short for `orientation.euler`",
    )
    .unit("degrees")
    .default("that of the body")
    .also(&["rotation", "rotate"]),
}

table! {
    turning: "a turning", Rule::AtMostOne(&[&["euler", "axis"], &["euler", "angle"]]);
    EULER: Option<value::TimedVector> = KeySpec::new("euler", TIMED_VECTOR, "Rotations about the world's x, then y, then z")
        .unit("degrees")
        .default("none"),
    AXIS: Option<value::Axis> = KeySpec::new("axis", super::AXIS, "The axis of rotation; goes with `angle`").default("none"),
    ANGLE: Option<value::Timed> = KeySpec::new("angle", Timed(Bound::Any), "The angle of rotation about `axis`; a formula of `t`")
        .unit("degrees")
        .default("none"),
}

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

table! {
    keyframes: "a motion by keyframes", Rule::Any;
    AT: Any = KeySpec::new(
        "at",
        List { of: &Table(&keyframe::TABLE), min: 1, max: 100_000 },
        "The keyframes, in order of time",
    )
    .required()
    .also(&["keys", "poses", "frames"]),
    INTERPOLATION: value::Text = BETWEEN_KEYFRAMES,
}

table! {
    keyframe: "a keyframe", Rule::Any;
    TIME: Option<f64> = KeySpec::new("time", Number(Bound::Any), "The time of the keyframe")
        .unit("s")
        .required()
        .also(&["t"]),
    LOCATION: Option<DVec3> = KeySpec::new("location", VECTOR, "Its center of mass")
        .unit("m")
        .default("that of the previous keyframe, or of the body")
        .also(&["position", "pos"]),
    ORIENTATION: Any = KeySpec::new("orientation", Either(&[VECTOR, Table(&bodies::orientation::TABLE)]), "Its orientation, as for a body")
        .unit("degrees")
        .default("that of the previous keyframe, or of the body")
        .also(&["rotation", "rotate"]),
}

fn polynomials() -> Vec<&'static str> {
    vec!["cubic", "linear"]
}

table! {
    trajectory: "a motion from a file", Rule::Any;
    FILE: Option<value::Text> = KeySpec::new(
        "file",
        File,
        "The CSV file, beside the scene: a row for each time and body. Further columns, such as `epot`, are measures of \
         the body. A body exists from its first row \
         to its last, except in gaps: the file then has rows of other bodies, and none of this one for \
         more than 1.5 times its usual (median) interval",
    )
    .required()
    .also(&["csv", "path"]),
    BODY: Option<value::Text> = KeySpec::new("body", Text, "The body's name in the file")
        .default("its name in the scene")
        .also(&["name"]),
    INTERPOLATION: value::Text = KeySpec::new("interpolation", Choice(polynomials), "The interpolation between rows")
        .default_word("cubic")
        .also(&["mode"]),
    COLUMNS: Any = KeySpec::new("columns", Table(&columns::TABLE), "The names of the columns in the file"),
}

const NAMES: Kind = List { of: &Text, min: 3, max: 3 };

const NAMES_OR_NONE: Kind = List { of: &Text, min: 0, max: 3 };

table! {
    columns: "names of columns", Rule::Any;
    TIME: Option<value::Text> = KeySpec::new("time", Text, "The column of the time").default("\"t\", or else \"time\"").also(&["t"]),
    BODY: Option<value::Text> = KeySpec::new("body", Text, "The column of the body's name; without it, all rows belong to the body")
        .default("\"body\""),
    LOCATION: Any = KeySpec::new("location", NAMES, "The columns of its center of mass").default("[\"x\", \"y\", \"z\"]"),
    ORIENTATION: Any = KeySpec::new(
        "orientation",
        List { of: &Text, min: 4, max: 4 },
        "The columns of its orientation, a quaternion",
    )
    .default("[\"qx\", \"qy\", \"qz\", \"qw\"], if present"),
    VELOCITY: Any = KeySpec::new(
        "velocity",
        NAMES_OR_NONE,
        "The columns of its velocity, for cubic interpolation; `[]`: none",
    )
    .default("[\"vx\", \"vy\", \"vz\"], if present"),
    ANGULAR_VELOCITY: Any = KeySpec::new(
        "angular_velocity",
        NAMES_OR_NONE,
        "The columns of its angular velocity, for cubic interpolation; `[]`: none",
    )
    .default("[\"wx\", \"wy\", \"wz\"], if present"),
}
