//! The grammar of `[joint.NAME]`.

use super::Kind::{Choice, Color, Direction, Either, List, Number, Reference, Table, Timed};
use super::contact::JOINT_COLLIDES;
use super::forces::END;
use super::kind::{POSITIVE, VECTOR};
use super::repeat::LINKS;
use super::showing::JOINT_ARROWS;
use super::{Bound, Collection, KeySpec, Kind, Rule, TableSpec};

pub(super) static JOINT: TableSpec = TableSpec {
    noun: "a joint",
    rule: Rule::ExactlyOne(&["ball", "hinge", "slider", "fixed", "rod", "rope", "pulley", "gear"]),
    keys: &[
        KeySpec::new(
            "ball",
            Table(&BALL),
            "A ball-and-socket joint: a common point of both bodies, with free rotation",
        )
        .also(&["spherical", "socket", "point", "pin"]),
        KeySpec::new(
            "hinge",
            Table(&HINGE),
            "Both bodies share one axis of rotation, like a door and its frame",
        )
        .also(&["revolute", "axle", "pivot"]),
        KeySpec::new(
            "slider",
            Table(&SLIDER),
            "The second body slides along an axis of the first, without rotation between them",
        )
        .also(&["prismatic", "rail"]),
        KeySpec::new(
            "fixed",
            Table(&FIXED),
            "The two move as one body; if they touch at the start, no rods are drawn",
        )
        .also(&["weld", "rigid", "glue"]),
        KeySpec::new("rod", Table(&ROD), "A massless rod keeps the distance of two points constant")
            .also(&["distance", "link", "bar", "stick"]),
        KeySpec::new("rope", Table(&ROPE), "The distance of two points is at most the rope's length")
            .also(&["string", "cable", "thread", "cord"]),
        KeySpec::new(
            "pulley",
            Table(&PULLEY),
            "A rope that runs over points, fixed or on bodies, from one end to the other",
        ),
        KeySpec::new("gear", Table(&GEAR), "Couples two hinges or sliders at a ratio").also(&["gears"]),
        LINKS,
    ],
};

static AN_END: Kind = Either(&[Reference(Collection::Body), VECTOR, Table(&END)]);

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
static LOOK_KINDS: [Kind; 2] = [Choice(|| vec!["none"]), Table(&LOOK_TABLE)];

static LOOK_TABLE: TableSpec = TableSpec {
    noun: "the look of a joint",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("radius", POSITIVE, "The radius of the rod or of the pin")
            .unit("m")
            .default("a fraction of the smaller body's size")
            .also(&["thickness", "width", "size"]),
        KeySpec::new("color", Color, "Its color").default("that of steel").also(&["colour"]),
    ],
};

static BALL: TableSpec = TableSpec {
    noun: "a ball joint",
    rule: Rule::Any,
    keys: &[
        between(PAIR),
        AT.default("the end that is a point of the world"),
        JOINT_COLLIDES,
        LOOK,
        JOINT_ARROWS,
    ],
};

static HINGE: TableSpec = TableSpec {
    noun: "a hinge",
    rule: Rule::Any,
    keys: &[
        between(PAIR),
        AT.default("the end that is a point of the world"),
        axis("The axis of rotation, in the world at the start"),
        limits(
            "The smallest and the largest rotation angle of the second relative to the first; 0 at the start",
        )
        .unit("degrees")
        .also(&["limit", "range", "min_max"]),
        motor(&TURNING, "The motor"),
        JOINT_COLLIDES,
        LOOK,
        JOINT_ARROWS,
    ],
};

static SLIDER: TableSpec = TableSpec {
    noun: "a slider",
    rule: Rule::Any,
    keys: &[
        between(PAIR),
        AT.default("the center of the second"),
        axis("The axis along which the second moves, in the world at the start; fixed to the first"),
        limits("The smallest and the largest displacement of the second along the axis; 0 at the start")
            .unit("m")
            .also(&["limit", "range", "min_max"]),
        motor(&MOVING, "The motor"),
        JOINT_COLLIDES,
        LOOK,
        JOINT_ARROWS,
    ],
};

static FIXED: TableSpec = TableSpec {
    noun: "a fixed joint",
    rule: Rule::Any,
    keys: &[between(PAIR), AT.default("the center of the second"), JOINT_COLLIDES, LOOK, JOINT_ARROWS],
};

static ROD: TableSpec = TableSpec {
    noun: "a rod",
    rule: Rule::Any,
    keys: &[
        between(POINTS),
        KeySpec::new("length", POSITIVE, "The constant distance of its ends")
            .unit("m")
            .default("their distance at the start")
            .also(&["distance", "l"]),
        JOINT_COLLIDES,
        LOOK,
        JOINT_ARROWS,
    ],
};

static NUMBER: Kind = Number(Bound::Any);

const fn limits(meaning: &'static str) -> KeySpec {
    KeySpec::new("limits", List { of: &NUMBER, min: 2, max: 2 }, meaning).default("none")
}

const fn motor(table: &'static TableSpec, meaning: &'static str) -> KeySpec {
    KeySpec::new("motor", Table(table), meaning).default("none").also(&["drive", "engine", "actuator"])
}

static TURNING: TableSpec = TableSpec {
    noun: "the motor of a hinge",
    rule: Rule::ExactlyOne(&["speed", "angle"]),
    keys: &[
        KeySpec::new("speed", NUMBER_ANY, "The speed to keep, as far as the torque allows")
            .unit("rad/s")
            .also(&["rate", "angular_velocity", "velocity", "omega"]),
        KeySpec::new("torque", POSITIVE, "With `speed`: the largest torque")
            .unit("N·m")
            .default("none; required with `speed`")
            .also(&["max_torque", "strength"]),
        KeySpec::new(
            "angle",
            Timed(Bound::Any),
            "The angle to keep, a formula of the time; 0 at the start. Exact without `stiffness`",
        )
        .unit("degrees")
        .also(&["target", "position"]),
        STIFFNESS.unit("N·m/rad"),
        DAMPING.unit("N·m·s/rad"),
    ],
};

static MOVING: TableSpec = TableSpec {
    noun: "the motor of a slider",
    rule: Rule::ExactlyOne(&["speed", "position"]),
    keys: &[
        KeySpec::new("speed", NUMBER_ANY, "The speed to keep, as far as the force allows")
            .unit("m/s")
            .also(&["rate", "velocity"]),
        KeySpec::new("force", POSITIVE, "With `speed`: the largest force")
            .unit("N")
            .default("none; required with `speed`")
            .also(&["max_force", "strength"]),
        KeySpec::new(
            "position",
            Timed(Bound::Any),
            "The position along the axis to keep, a formula of the time; 0 at the start. Exact without \
             `stiffness`",
        )
        .unit("m")
        .also(&["target", "location", "angle"]),
        STIFFNESS.unit("N/m"),
        DAMPING.unit("N·s/m"),
    ],
};

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

static ROPE: TableSpec = TableSpec {
    noun: "a rope",
    rule: Rule::Any,
    keys: &[
        between(POINTS),
        KeySpec::new("length", POSITIVE, "The largest distance of its ends")
            .unit("m")
            .default("their distance at the start")
            .also(&["distance", "max_length", "l"]),
        JOINT_COLLIDES,
        LOOK,
        JOINT_ARROWS,
    ],
};

static PULLEY: TableSpec = TableSpec {
    noun: "a pulley",
    rule: Rule::Any,
    keys: &[
        between(POINTS),
        KeySpec::new(
            "over",
            List { of: &AN_END, min: 1, max: 1000 },
            "The points over which it runs, from the first end to the second; a point on a body moves with it",
        )
        .unit("m")
        .required()
        .also(&["wheels", "through", "via", "anchors"]),
        KeySpec::new(
            "ratio",
            POSITIVE,
            "How much the last part counts: how far the first end moves out for each meter that the second moves in",
        )
        .default_number(1.0),
        KeySpec::new(
            "length",
            POSITIVE,
            "The length of all its parts, the last one counted `ratio` times",
        )
        .unit("m")
        .default("as at the start"),
        JOINT_COLLIDES,
        LOOK,
        JOINT_ARROWS,
    ],
};

static A_JOINT: Kind = Reference(Collection::Joint);

static GEAR: TableSpec = TableSpec {
    noun: "a gear",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "joints",
            List { of: &A_JOINT, min: 2, max: 2 },
            "The names of the two coupled hinges or sliders; `[\"axle[i]\", \"axle[i+1]\"]` couples copies \
             in a row",
        )
        .required()
        .also(&["between", "hinges", "axles"]),
        KeySpec::new(
            "ratio",
            NUMBER_ANY,
            "The motion of the second per unit motion of the first; negative for opposite directions, as \
             with meshing wheels",
        )
        .required()
        .also(&["factor"]),
        JOINT_COLLIDES,
        JOINT_ARROWS,
    ],
};
