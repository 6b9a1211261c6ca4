//! The grammar of `[joint.NAME]`.

use super::Kind::{Choice, Color, Direction, Either, List, Number, Reference, Table, Timed};
use super::contact::JOINT_COLLIDES;
use super::forces;
use super::key::table;
use super::kind::{POSITIVE, VECTOR};
use super::repeat::LINKS;
use super::showing::JOINT_ARROWS;
use super::{Bound, Collection, KeySpec, Kind, Rule, TableSpec};

table! {
    joint: "a joint", Rule::ExactlyOne(&["ball", "hinge", "slider", "fixed", "rod", "rope", "pulley", "gear"]);
    BALL: Any = KeySpec::new(
        "ball",
        Table(&ball::TABLE),
        "A ball-and-socket joint: a common point of both bodies, with free rotation",
    )
    .also(&["spherical", "socket", "point", "pin"]),
    HINGE: Any = KeySpec::new(
        "hinge",
        Table(&hinge::TABLE),
        "Both bodies share one axis of rotation, like a door and its frame",
    )
    .also(&["revolute", "axle", "pivot"]),
    SLIDER: Any = KeySpec::new(
        "slider",
        Table(&slider::TABLE),
        "The second body slides along an axis of the first, without rotation between them",
    )
    .also(&["prismatic", "rail"]),
    FIXED: Any = KeySpec::new(
        "fixed",
        Table(&fixed::TABLE),
        "The two move as one body; if they touch at the start, no rods are drawn",
    )
    .also(&["weld", "rigid", "glue"]),
    ROD: Any = KeySpec::new("rod", Table(&rod::TABLE), "A massless rod keeps the distance of two points constant")
        .also(&["distance", "link", "bar", "stick"]),
    ROPE: Any = KeySpec::new("rope", Table(&rope::TABLE), "The distance of two points is at most the rope's length")
        .also(&["string", "cable", "thread", "cord"]),
    PULLEY: Any = KeySpec::new(
        "pulley",
        Table(&pulley::TABLE),
        "A rope that runs over points, fixed or on bodies, from one end to the other",
    ),
    GEAR: Any = KeySpec::new("gear", Table(&gear::TABLE), "Couples two hinges or sliders at a ratio").also(&["gears"]),
    REPEAT: Option<u32> = LINKS,
}

static AN_END: Kind = Either(&[Reference(Collection::Body), VECTOR, Table(&forces::end::TABLE)]);

const fn between(meaning: &'static str) -> KeySpec {
    KeySpec::new("between", List { of: &AN_END, min: 2, max: 2 }, meaning)
        .unit("m")
        .required()
        .also(&["bodies", "ends", "connects"])
}

const PAIR: &str =
    "The two joined things: each the name of a body, a point of a body, or a point of the world";

const POINTS: &str =
    "Its two ends: each the name of a body (its center), a point of a body, or a point of the world";

const AT: KeySpec = KeySpec::new(
    "at",
    VECTOR,
    "The joint's position in the world at the start; not needed if an end gives it",
)
.unit("m")
.also(&["point", "location", "position", "anchor"]);

const fn axis(meaning: &'static str) -> KeySpec {
    KeySpec::new("axis", Direction(3), meaning).required().also(&["direction", "normal"])
}

const LOOK: KeySpec = KeySpec::new(
    "look",
    Either(&LOOK_KINDS),
    "Its look: `\"none\"`, or the size and color of its rod or pin",
)
.default("steel, sized to fit its bodies")
.also(&["draw", "drawn", "visible", "line"]);
static LOOK_KINDS: [Kind; 2] = [Choice(|| vec!["none"]), Table(&look::TABLE)];

table! {
    look: "the look of a joint", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "The radius of the rod or of the pin")
        .unit("m")
        .default("a fraction of the smaller body's size")
        .also(&["thickness", "width", "size"]),
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "Its color").default("that of steel").also(&["colour"]),
}

table! {
    ball: "a ball joint", Rule::Any;
    BETWEEN: Any = between(PAIR),
    AT: Option<DVec3> = super::AT.default("the end that is a point of the world"),
    COLLIDES: bool = JOINT_COLLIDES,
    LOOK: Any = super::LOOK,
    ARROWS: Any = JOINT_ARROWS,
}

table! {
    hinge: "a hinge", Rule::Any;
    BETWEEN: Any = between(PAIR),
    AT: Option<DVec3> = super::AT.default("the end that is a point of the world"),
    AXIS: Option<value::Axis> = axis("The axis of rotation, in the world at the start"),
    LIMITS: Any = limits(
        "The smallest and the largest rotation angle of the second relative to the first; 0 at the start",
    )
    .unit("degrees")
    .also(&["limit", "range", "min_max"]),
    MOTOR: Any = motor(&turning::TABLE, "The motor"),
    COLLIDES: bool = JOINT_COLLIDES,
    LOOK: Any = super::LOOK,
    ARROWS: Any = JOINT_ARROWS,
}

table! {
    slider: "a slider", Rule::Any;
    BETWEEN: Any = between(PAIR),
    AT: Option<DVec3> = super::AT.default("the center of the second"),
    AXIS: Option<value::Axis> = axis("The axis along which the second moves, in the world at the start; fixed to the first"),
    LIMITS: Any = limits("The smallest and the largest displacement of the second along the axis; 0 at the start")
        .unit("m")
        .also(&["limit", "range", "min_max"]),
    MOTOR: Any = motor(&moving::TABLE, "The motor"),
    COLLIDES: bool = JOINT_COLLIDES,
    LOOK: Any = super::LOOK,
    ARROWS: Any = JOINT_ARROWS,
}

table! {
    fixed: "a fixed joint", Rule::Any;
    BETWEEN: Any = between(PAIR),
    AT: Option<DVec3> = super::AT.default("the center of the second"),
    COLLIDES: bool = JOINT_COLLIDES,
    LOOK: Any = super::LOOK,
    ARROWS: Any = JOINT_ARROWS,
}

table! {
    rod: "a rod", Rule::Any;
    BETWEEN: Any = between(POINTS),
    LENGTH: Option<f64> = KeySpec::new("length", POSITIVE, "The constant distance of its ends")
        .unit("m")
        .default("their distance at the start")
        .also(&["distance", "l"]),
    COLLIDES: bool = JOINT_COLLIDES,
    LOOK: Any = super::LOOK,
    ARROWS: Any = JOINT_ARROWS,
}

static NUMBER: Kind = Number(Bound::Any);

const fn limits(meaning: &'static str) -> KeySpec {
    KeySpec::new("limits", List { of: &NUMBER, min: 2, max: 2 }, meaning).default("none")
}

const fn motor(table: &'static TableSpec, meaning: &'static str) -> KeySpec {
    KeySpec::new("motor", Table(table), meaning).default("none").also(&["drive", "engine", "actuator"])
}

table! {
    turning: "the motor of a hinge", Rule::ExactlyOne(&["speed", "angle"]);
    SPEED: Option<f64> = KeySpec::new("speed", NUMBER_ANY, "The speed to keep, as far as the torque allows")
        .unit("rad/s")
        .also(&["rate", "angular_velocity", "velocity", "omega"]),
    TORQUE: Option<f64> = KeySpec::new("torque", POSITIVE, "With `speed`: the largest torque")
        .unit("N·m")
        .default("none; required with `speed`")
        .also(&["max_torque", "strength"]),
    ANGLE: Option<value::Timed> = KeySpec::new(
        "angle",
        Timed(Bound::Any),
        "The angle to keep, a formula of the time; 0 at the start. Exact without `stiffness`",
    )
    .unit("degrees")
    .also(&["target", "position"]),
    STIFFNESS: Option<f64> = super::STIFFNESS.unit("N·m/rad"),
    DAMPING: f64 = super::DAMPING.unit("N·m·s/rad"),
}

table! {
    moving: "the motor of a slider", Rule::ExactlyOne(&["speed", "position"]);
    SPEED: Option<f64> = KeySpec::new("speed", NUMBER_ANY, "The speed to keep, as far as the force allows")
        .unit("m/s")
        .also(&["rate", "velocity"]),
    FORCE: Option<f64> = KeySpec::new("force", POSITIVE, "With `speed`: the largest force")
        .unit("N")
        .default("none; required with `speed`")
        .also(&["max_force", "strength"]),
    POSITION: Option<value::Timed> = KeySpec::new(
        "position",
        Timed(Bound::Any),
        "The position along the axis to keep, a formula of the time; 0 at the start. Exact without \
         `stiffness`",
    )
    .unit("m")
    .also(&["target", "location", "angle"]),
    STIFFNESS: Option<f64> = super::STIFFNESS.unit("N/m"),
    DAMPING: f64 = super::DAMPING.unit("N·s/m"),
}

const NUMBER_ANY: Kind = Number(Bound::Any);

const STIFFNESS: KeySpec =
    KeySpec::new("stiffness", POSITIVE, "Makes the motor yield like a spring of this stiffness")
        .default("none: the motor does not yield")
        .also(&["k"]);

const DAMPING: KeySpec = KeySpec::new(
    "damping",
    Number(Bound::NonNegative),
    "With `stiffness`: the damping parallel to that spring",
)
.default_number(0.0)
.also(&["damper", "d"]);

table! {
    rope: "a rope", Rule::Any;
    BETWEEN: Any = between(POINTS),
    LENGTH: Option<f64> = KeySpec::new("length", POSITIVE, "The largest distance of its ends")
        .unit("m")
        .default("their distance at the start")
        .also(&["distance", "max_length", "l"]),
    COLLIDES: bool = JOINT_COLLIDES,
    LOOK: Any = super::LOOK,
    ARROWS: Any = JOINT_ARROWS,
}

table! {
    pulley: "a pulley", Rule::Any;
    BETWEEN: Any = between(POINTS),
    OVER: Any = KeySpec::new(
        "over",
        List { of: &AN_END, min: 1, max: 1000 },
        "The points over which it runs, from the first end to the second; a point on a body moves with it",
    )
    .unit("m")
    .required()
    .also(&["wheels", "through", "via", "anchors"]),
    RATIO: f64 = KeySpec::new(
        "ratio",
        POSITIVE,
        "How much the last part counts: how far the first end moves out for each meter that the second moves in",
    )
    .default_number(1.0),
    LENGTH: Option<f64> = KeySpec::new(
        "length",
        POSITIVE,
        "The length of all its parts, the last one counted `ratio` times",
    )
    .unit("m")
    .default("as at the start"),
    COLLIDES: bool = JOINT_COLLIDES,
    LOOK: Any = super::LOOK,
    ARROWS: Any = JOINT_ARROWS,
}

static A_JOINT: Kind = Reference(Collection::Joint);

table! {
    gear: "a gear", Rule::Any;
    JOINTS: Any = KeySpec::new(
        "joints",
        List { of: &A_JOINT, min: 2, max: 2 },
        "The names of the two coupled hinges or sliders; `[\"axle[i]\", \"axle[i+1]\"]` couples copies \
         in a row",
    )
    .required()
    .also(&["between", "hinges", "axles"]),
    RATIO: Option<f64> = KeySpec::new(
        "ratio",
        NUMBER_ANY,
        "The motion of the second per unit motion of the first; negative for opposite directions, as \
         with meshing wheels",
    )
    .required()
    .also(&["factor"]),
    COLLIDES: bool = JOINT_COLLIDES,
    ARROWS: Any = JOINT_ARROWS,
}
