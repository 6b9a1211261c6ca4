//! The keys of cameras.

use super::Kind::{Choice, Integer, List, Number, Reference, Table, Timed};
use super::keys::{NON_NEGATIVE, POSITIVE, VECTOR};
use super::motion::{BETWEEN_KEYFRAMES, TIMED_VECTOR};
use super::{Bound, Collection, Key, Rule, TableSpec};

fn projections() -> Vec<&'static str> {
    vec!["perspective", "orthographic"]
}

pub(super) static CAMERA: TableSpec = TableSpec {
    noun: "the camera",
    rule: Rule::Any,
    keys: &[
        Key::new("location", TIMED_VECTOR, "Where the camera is; numbers, or formulas of `t`")
            .unit("m")
            .default("so that the whole motion is in the picture, without the few of many bodies that fly far away; if bodies were too small then, along with the only body if there is ground, or so that the start of the motion is in the picture")
            .also(&["position", "pos", "eye", "from"]),
        Key::new("look_at", TIMED_VECTOR, "The point in the middle of the picture; numbers, or formulas of `t`")
            .unit("m")
            .default("the middle of the motion")
            .also(&["target", "lookat", "to"]),
        Key::new(
            "keyframes",
            Table(&CAMERA_KEYFRAMES),
            "Places that it goes through at given times, in place of `location` and `look_at`",
        )
        .default("none")
        .also(&["motion", "path"]),
        Key::new("follow", Table(&FOLLOW), "A body that it goes along with")
            .default("none")
            .also(&["track", "tracking", "following"]),
        Key::new("orbit", Table(&ORBIT), "That it goes around what it looks at, about the vertical")
            .default("none")
            .also(&["rotate", "turntable"]),
        Key::new(
            "angle",
            Timed(Bound::From(0.001, 179.999)),
            "The horizontal field of view, in perspective; a number, or a formula of `t`",
        )
            .unit("degrees")
            .default_number(40.0)
            .also(&["fov", "field_of_view"]),
        Key::new("projection", Choice(projections), "How it sees: as eyes do, or by parallel rays")
            .default("perspective")
            .also(&["type", "kind"]),
        Key::new("width", POSITIVE, "The width that an orthographic camera sees")
            .unit("m")
            .default("so that the whole motion is in the picture"),
        Key::new(
            "aperture",
            POSITIVE,
            "The diameter of the lens: the larger, the more is blurred that is not in focus",
        )
        .unit("m")
        .default("everything is sharp")
        .also(&["blur"]),
        Key::new("focus", VECTOR, "With `aperture`, the point that is sharp")
            .unit("m")
            .default("`look_at`")
            .also(&["focal_point"]),
        Key::new(
            "blur_samples",
            Integer(4, 10_000),
            "With `aperture`, the number of rays for a pixel: more is smoother",
        )
        .default_number(60.0),
        Key::new(
            "shutter",
            NON_NEGATIVE,
            "How long the shutter is open from the time of a frame on, at most until the next frame: what moves \
             meanwhile is blurred; half the time between frames is usual in films",
        )
        .unit("s")
        .default("0: everything is sharp")
        .also(&["motion_blur", "exposure", "exposure_time", "shutter_speed"]),
        Key::new(
            "samples",
            Integer(2, 256),
            "With `shutter`, the number of moments that an image is the mean of: more is smoother and takes longer",
        )
        .default_number(16.0)
        .also(&["shutter_samples", "motion_blur_samples"]),
    ],
};

static CAMERA_KEYFRAMES: TableSpec = TableSpec {
    noun: "a camera's keyframes",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "at",
            List { of: &Table(&CAMERA_KEYFRAME), min: 1, max: 100_000 },
            "The places, in the order of their times",
        )
        .required()
        .also(&["keys", "poses", "frames"]),
        BETWEEN_KEYFRAMES,
    ],
};

static CAMERA_KEYFRAME: TableSpec = TableSpec {
    noun: "a camera's keyframe",
    rule: Rule::Any,
    keys: &[
        Key::new("time", Number(Bound::Any), "When it is there").unit("s").required().also(&["t"]),
        Key::new("location", VECTOR, "Where the camera is").unit("m").required().also(&["position", "pos"]),
        Key::new("look_at", VECTOR, "The point in the middle of the picture")
            .unit("m")
            .default("that of the keyframe before, or of the camera")
            .also(&["target"]),
    ],
};

static FOLLOW: TableSpec = TableSpec {
    noun: "what a camera follows",
    rule: Rule::Any,
    keys: &[
        Key::new("body", Reference(Collection::Body), "The body, which stays in the middle of the picture")
            .required()
            .also(&["name", "target"]),
        Key::new("distance", Number(Bound::Positive), "How far the camera stays from it")
            .unit("m")
            .default("as far as `location` is from it at the start, or 11 times its width")
            .also(&["offset"]),
        Key::new(
            "lag",
            Number(Bound::NonNegative),
            "The time by which the camera is behind, so that it follows softly what turns or stops",
        )
        .unit("s")
        .default_number(0.0)
        .also(&["delay", "damping", "smooth", "smoothness"]),
    ],
};

static ORBIT: TableSpec = TableSpec {
    noun: "an orbit",
    rule: Rule::Any,
    keys: &[Key::new(
        "period",
        Number(Bound::Any),
        "The time of a turn; a negative one is that of a turn the other way",
    )
    .unit("s")
    .required()
    .also(&["duration", "time"])],
};
