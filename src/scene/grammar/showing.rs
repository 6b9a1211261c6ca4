//! The keys that show physics: arrows, axes, ghosts, trails and springs.

use super::Kind::{Boolean, Choice, Color, Either, Integer, Table};
use super::keys::{POSITIVE, VECTOR};
use super::{Key, Kind, Rule, TableSpec};

static AXES_KINDS: [Kind; 2] = [Boolean, Table(&AXES_TABLE)];
static TRAIL_KINDS: [Kind; 2] = [Boolean, Table(&TRAIL_TABLE)];
static COIL_KINDS: [Kind; 2] = [Boolean, Table(&COIL_TABLE)];
static ARROW_KINDS: [Kind; 2] = [Boolean, Table(&ARROW_TABLE)];

// The keys for the physics shown beside a body.

pub(super) const ARROWS: Key =
    Key::new("arrows", Table(&ARROWS_TABLE), "Arrows from its surface for its velocity, its acceleration and the force on it, where parallel ones stand side by side; and arrows for its weight and the forces of contacts, from where they act")
        .also(&["vectors", "arrow"]);
pub(super) const JOINT_ARROWS: Key = Key::new(
    "arrows",
    Table(&JOINT_ARROWS_TABLE),
    "Arrows for what it does to its second end, from that point on; to the first it does the opposite",
)
.also(&["vectors", "arrow"]);
pub(super) const AXES: Key =
    Key::new("axes", Either(&AXES_KINDS), "Its own axes x, y, z, which turn with it")
        .default_flag(false)
        .also(&["triad", "frame"]);
pub(super) const GHOSTS: Key = Key::new(
    "ghosts",
    Table(&GHOSTS_TABLE),
    "Its earlier poses at regular intervals, drawn paler, as a stroboscope shows them",
)
.also(&["ghost", "strobe", "stroboscope", "onion_skin"]);
pub(super) const TRAIL: Key =
    Key::new("trail", Either(&TRAIL_KINDS), "A line along the way that it has come")
        .default_flag(false)
        .also(&["trails", "path", "trace", "track", "tail", "trajectory"]);
// How a spring is drawn.
pub(super) const LINE: Key = Key::new(
    "line",
    Choice(|| vec!["coil", "straight", "none"]),
    "As what it is drawn between its ends; it is left out while they leave no room for it",
)
.default_word("coil")
.also(&["look", "drawn", "draw", "visible", "style"]);
pub(super) const COIL: Key = Key::new(
    "coil",
    Either(&COIL_KINDS),
    "The size and color of its coil or line; `false` hides it, as `line = \"none\"` does",
)
.default_flag(true);

const COLOR: Key = Key::new("color", Color, "Its color").also(&["colour"]);

static ARROWS_TABLE: TableSpec = TableSpec {
    noun: "a body's arrows",
    rule: Rule::Any,
    keys: &[
        Key::new("velocity", ARROW, "Its velocity, blue").default_flag(false).also(&["v"]),
        Key::new("acceleration", ARROW, "The sum of the forces on it by its mass, orange")
            .default_flag(false)
            .also(&["a"]),
        Key::new("force", ARROW, "The sum of the forces on it, magenta")
            .default_flag(false)
            .also(&["f", "forces"]),
        Key::new("weight", ARROW, "Its weight, green, from its centre").default_flag(false).also(&["gravity"]),
        Key::new(
            "normal",
            ARROW,
            "The normal force of each body that touches it, red, from where they touch; needs `simulation.contacts`",
        )
        .default_flag(false)
        .also(&["normal_force", "contact", "contacts", "reaction"]),
        Key::new(
            "friction",
            ARROW,
            "The friction of each body that touches it, yellow, from where they touch; needs `simulation.contacts`",
        )
        .default_flag(false)
        .also(&["friction_force"]),
    ],
};

static JOINT_ARROWS_TABLE: TableSpec = TableSpec {
    noun: "a joint's arrows",
    rule: Rule::Any,
    keys: &[
        Key::new("force", ARROW, "Its force, magenta").default_flag(false).also(&["f", "forces", "reaction"]),
        Key::new("torque", ARROW, "Its torque, along the axis of that, green")
            .default_flag(false)
            .also(&["moment", "torques"]),
    ],
};

const ARROW: Kind = Either(&ARROW_KINDS);

static ARROW_TABLE: TableSpec = TableSpec {
    noun: "an arrow",
    rule: Rule::Any,
    keys: &[
        Key::new("scale", POSITIVE, "Its length for each m/s, m/s², N or N·m")
            .unit("m")
            .default("the same for all of its kind, so that the longest is easily seen; weight, normal force and friction are of one kind")
            .also(&["length", "factor", "size"]),
        COLOR.default("that of its kind"),
    ],
};

static AXES_TABLE: TableSpec = TableSpec {
    noun: "a body's axes",
    rule: Rule::Any,
    keys: &[Key::new("length", POSITIVE, "The length of each")
        .unit("m")
        .default("twice as far as the body reaches")
        .also(&["size", "scale"])],
};

static GHOSTS_TABLE: TableSpec = TableSpec {
    noun: "ghosts",
    rule: Rule::Any,
    keys: &[
        Key::new("every", POSITIVE, "The time from one to the next; the first is at 0")
            .unit("s")
            .required()
            .also(&["interval", "period", "step", "dt"]),
        Key::new("arrows", Boolean, "Whether each has the arrows of the body").default_flag(true),
    ],
};

static TRAIL_TABLE: TableSpec = TableSpec {
    noun: "a trail",
    rule: Rule::Any,
    keys: &[
        Key::new("duration", POSITIVE, "How far back it goes; it becomes thin towards its end")
            .unit("s")
            .default("to the beginning")
            .also(&["length", "time"]),
        Key::new("width", POSITIVE, "Its width")
            .unit("m")
            .default("three thousandths of the picture's")
            .also(&["thickness", "radius"]),
        COLOR.default("that of the body"),
        Key::new(
            "at",
            VECTOR,
            "The point of the body that leaves it, in the body's own axes, from its centre of mass",
        )
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["point", "offset", "of"]),
    ],
};

static COIL_TABLE: TableSpec = TableSpec {
    noun: "a coil",
    rule: Rule::Any,
    keys: &[
        Key::new("radius", POSITIVE, "Its radius, also that of a straight line")
            .unit("m")
            .default("after its length and the bodies at its ends"),
        Key::new("turns", Integer(1, 200), "The number of its turns").default("after its length and radius"),
        COLOR.default("steel"),
    ],
};
