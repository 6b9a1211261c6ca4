//! The grammar of `[light.NAME]`.

use super::Kind::{Boolean, Color, Table};
use super::kind::{AXIS, NON_NEGATIVE, POSITIVE};
use super::motion::TIMED_VECTOR;
use super::{KeySpec, Rule, TableSpec};

pub(super) static LIGHT: TableSpec = TableSpec {
    noun: "a light",
    rule: Rule::ExactlyOne(&["point", "area", "sun"]),
    keys: &[
        KeySpec::new("point", Table(&POINT_LIGHT), "A lamp without size: hard shadows"),
        KeySpec::new("area", Table(&AREA_LIGHT), "A lamp with a size: soft shadows"),
        KeySpec::new("sun", Table(&SUN), "Light from so far away that all its rays are parallel")
            .also(&["directional", "parallel"]),
        KeySpec::new("color", Color, "Its color").default_word("white").also(&["colour"]),
        KeySpec::new(
            "intensity",
            NON_NEGATIVE,
            "Its brightness: 1 makes a white surface that faces it white",
        )
        .default_number(1.0)
        .also(&["brightness", "power", "strength"]),
        KeySpec::new("shadows", Boolean, "Whether it casts shadows and highlights, or only brightens")
            .default_flag(true)
            .also(&["shadow"]),
    ],
};

static POINT_LIGHT: TableSpec = TableSpec {
    noun: "a point light",
    rule: Rule::Any,
    keys: &[KeySpec::new("location", TIMED_VECTOR, "Its position; numbers, or formulas of `t`")
        .unit("m")
        .required()
        .also(&["position", "pos"])],
};

static AREA_LIGHT: TableSpec = TableSpec {
    noun: "an area light",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("location", TIMED_VECTOR, "Its position; numbers, or formulas of `t`")
            .unit("m")
            .required()
            .also(&["position", "pos"]),
        KeySpec::new("size", POSITIVE, "Its diameter").unit("m").required().also(&["radius", "width"]),
    ],
};

static SUN: TableSpec = TableSpec {
    noun: "a sun",
    rule: Rule::Any,
    keys: &[KeySpec::new("direction", AXIS, "The direction in which its light travels")
        .required()
        .also(&["to"])],
};
