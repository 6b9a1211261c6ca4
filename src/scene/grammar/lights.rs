//! The grammar of `[light.NAME]`.

use super::Kind::{Boolean, Color, Table};
use super::key::table;
use super::kind::{AXIS, NON_NEGATIVE, POSITIVE, VARYING_POINT};
use super::{KeySpec, Rule};

table! {
    light: "a light", Rule::ExactlyOne(&["point", "area", "sun"]);
    POINT: Any = KeySpec::new("point", Table(&point::TABLE), "A lamp without size: hard shadows"),
    AREA: Any = KeySpec::new("area", Table(&area::TABLE), "A lamp with a size: soft shadows"),
    SUN: Any = KeySpec::new("sun", Table(&sun::TABLE), "Light from so far away that all its rays are parallel")
        .also(&["directional", "parallel"]),
    COLOR: value::Color = KeySpec::new("color", Color, "Its color").default_word("white").also(&["colour"]),
    INTENSITY: f64 = KeySpec::new(
        "intensity",
        NON_NEGATIVE,
        "Its brightness: 1 makes a white surface that faces it white",
    )
    .default_number(1.0)
    .also(&["brightness", "power", "strength"]),
    SHADOWS: bool = KeySpec::new("shadows", Boolean, "Whether it casts shadows and highlights, or only brightens")
        .default_flag(true)
        .also(&["shadow"]),
}

table! {
    point: "a point light", Rule::Any;
    LOCATION: Option<value::VaryingPoint> = KeySpec::new("location", VARYING_POINT, "Its position; numbers, or formulas of `t` and of measures such as `ball.x`")
    .unit("m")
    .required()
    .also(&["position", "pos"]),
}

table! {
    area: "an area light", Rule::Any;
    LOCATION: Option<value::VaryingPoint> = KeySpec::new("location", VARYING_POINT, "Its position; numbers, or formulas of `t` and of measures such as `ball.x`")
        .unit("m")
        .required()
        .also(&["position", "pos"]),
    SIZE: Option<f64> = KeySpec::new("size", POSITIVE, "Its diameter").unit("m").required().also(&["radius", "width"]),
}

table! {
    sun: "a sun", Rule::Any;
    DIRECTION: Option<value::Axis> = KeySpec::new("direction", AXIS, "The direction in which its light travels")
    .required()
    .also(&["to"]),
}
