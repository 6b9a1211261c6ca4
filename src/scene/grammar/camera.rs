//! The grammar of `[camera]`: the keys that describe a camera.

use super::Kind::{Choice, Integer, List, Number, Reference, Table, Varying};
use super::key::table;
use super::kind::{AXIS, NON_NEGATIVE, POSITIVE, VARYING_POINT, VECTOR};
use super::motion::BETWEEN_KEYFRAMES;
use super::{Bound, Collection, KeySpec, Rule};
use crate::scene::{Auto, Projection};

fn projections() -> Vec<&'static str> {
    Projection::NAMES.to_vec()
}

fn autos() -> Vec<&'static str> {
    Auto::ALL.map(Auto::name).to_vec()
}

table! {
    camera: "the camera", Rule::Any;
    LOCATION: Option<value::VaryingPoint> = KeySpec::new("location", VARYING_POINT, "The camera's position; numbers, or formulas of `t` and of measures such as `ball.x`")
        .unit("m")
        .default(
            "fits the whole motion into the picture, clear of labels in corners; of eight or more bodies, up to a third that \
             fly far away are left out; if bodies would be too small, goes along with the motion; of wide fixed bodies, such as a floor, only the part near \
             the motion is shown"
        )
        .also(&["position", "pos", "eye", "from"]),
    LOOK_AT: Option<value::VaryingPoint> = KeySpec::new(
        "look_at",
        VARYING_POINT,
        "The point in the middle of the picture; numbers, or formulas of `t` and of measures such as `ball.x`",
    )
    .unit("m")
    .default("the center of the motion")
    .also(&["target", "lookat", "to"]),
    UP: Option<value::Axis> = KeySpec::new("up", AXIS, "The direction that points up in the picture; also the axis of `orbit`")
        .default("the vertical, `[0, 1, 0]`")
        .also(&["sky", "up_vector"]),
    ROLL: value::Varying = KeySpec::new(
        "roll",
        Varying(Bound::Any),
        "The angle by which the camera is turned about its line of sight, clockwise as seen from behind it; a number, or a formula of `t` and \
         of measures",
    )
    .unit("degrees")
    .default_number(0.0)
    .also(&["tilt", "bank"]),
    AUTO: Option<value::Text> = KeySpec::new(
        "auto",
        Choice(autos),
        "What a camera without `location` shows: the whole motion, or what moves at each time, by a smooth move along with it",
    )
    .default("the whole motion; if bodies would be too small, `\"track\"`")
    .also(&["automatic", "mode", "framing"]),
    KEYFRAMES: Any = KeySpec::new(
        "keyframes",
        Table(&keyframes::TABLE),
        "Positions at given times; replaces `location` and `look_at`",
    )
    .default("none")
    .also(&["motion", "path"]),
    FOLLOW: Any = KeySpec::new("follow", Table(&follow::TABLE), "A body to follow").default("none").also(&[
        "track",
        "tracking",
        "following",
    ]),
    ORBIT: Any = KeySpec::new("orbit", Table(&orbit::TABLE), "Circles around `look_at`, about `up`")
        .default("none")
        .also(&["rotate", "turntable"]),
    ANGLE: value::Varying = KeySpec::new(
        "angle",
        Varying(Bound::From(0.001, 179.999)),
        "The horizontal field of view, in perspective; a number, or a formula of `t` and of measures",
    )
    .unit("degrees")
    .default_number(40.0)
    .also(&["fov", "field_of_view"]),
    PROJECTION: Option<value::Text> = KeySpec::new(
        "projection",
        Choice(projections),
        "The projection: perspective, orthographic (parallel rays), or spherical (a picture of all directions, for 360° viewers)",
    )
    .default("perspective")
    .also(&["type", "kind"]),
    STEREO: Option<f64> = KeySpec::new(
        "stereo",
        POSITIVE,
        "The distance between two eyes; adds the views `left` and `right`. What `look_at` shows lies in the plane of the screen",
    )
    .unit("m")
    .default("one eye")
    .also(&["eye_distance", "interocular", "baseline", "eye_separation"]),
    WIDTH: Option<f64> = KeySpec::new("width", POSITIVE, "The width in view of an orthographic camera")
        .unit("m")
        .default("fits the whole motion into the picture"),
    APERTURE: Option<f64> = KeySpec::new(
        "aperture",
        POSITIVE,
        "The diameter of the lens; a larger one blurs things out of focus more",
    )
    .unit("m")
    .default("everything is sharp")
    .also(&["blur"]),
    FOCUS: Option<DVec3> = KeySpec::new("focus", VECTOR, "With `aperture`, the point that is sharp")
        .unit("m")
        .default("`look_at`")
        .also(&["focal_point"]),
    BLUR_SAMPLES: u32 = KeySpec::new(
        "blur_samples",
        Integer(4, 10_000),
        "With `aperture`, the number of rays per pixel: more is smoother",
    )
    .default_number(60.0),
    SHUTTER: Option<f64> = KeySpec::new(
        "shutter",
        NON_NEGATIVE,
        "Exposure time, starting at the time of a frame and ending by the next frame; blurs moving \
         things. Films usually expose for half the time between frames",
    )
    .unit("s")
    .default("0: everything is sharp")
    .also(&["motion_blur", "exposure", "exposure_time", "shutter_speed"]),
    SAMPLES: u32 = KeySpec::new(
        "samples",
        Integer(2, 256),
        "With `shutter`, the number of moments averaged in an image: more is smoother and slower",
    )
    .default_number(16.0)
    .also(&["shutter_samples", "motion_blur_samples"]),
}

table! {
    keyframes: "a camera's keyframes", Rule::Any;
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
    keyframe: "a camera's keyframe", Rule::Any;
    TIME: Option<f64> = KeySpec::new("time", Number(Bound::Any), "The time of the keyframe")
        .unit("s")
        .required()
        .also(&["t"]),
    LOCATION: Option<DVec3> = KeySpec::new("location", VECTOR, "The camera's position")
        .unit("m")
        .required()
        .also(&["position", "pos"]),
    LOOK_AT: Option<DVec3> = KeySpec::new("look_at", VECTOR, "The point in the middle of the picture")
        .unit("m")
        .default("that of the previous keyframe, or of the camera")
        .also(&["target"]),
}

table! {
    follow: "a camera's `follow`", Rule::Any;
    BODY: Option<value::Text> = KeySpec::new("body", Reference(Collection::Body), "The body to keep in the middle of the picture")
        .required()
        .also(&["name", "target"]),
    DISTANCE: Option<f64> = KeySpec::new("distance", Number(Bound::Positive), "The camera's distance from it")
        .unit("m")
        .default("the initial distance of `location` from it, or 11 times its width")
        .also(&["offset"]),
    LAG: f64 = KeySpec::new(
        "lag",
        Number(Bound::NonNegative),
        "The camera's delay in seconds; smooths sudden motion of the body",
    )
    .unit("s")
    .default_number(0.0)
    .also(&["delay", "damping", "smooth", "smoothness"]),
}

table! {
    orbit: "an orbit", Rule::Any;
    PERIOD: Option<f64> = KeySpec::new(
    "period",
    Number(Bound::Any),
    "The time of one revolution; negative for the other direction",
)
.unit("s")
.required()
.also(&["duration", "time"]),
}
