//! The grammar of the keys that visualize physics: arrows, axes, ghosts, trails and the look of springs.

use super::Kind::{Boolean, Choice, Color, Either, Integer, List, Table, Text};
use super::key::table;
use super::kind::{POSITIVE, VECTOR};
use super::marks::LEG;
use super::{KeySpec, Kind, Rule};

static AXES_KINDS: [Kind; 2] = [Boolean, Table(&axes::TABLE)];
static TRAIL_KINDS: [Kind; 2] = [Boolean, Table(&trail::TABLE)];
static COIL_KINDS: [Kind; 2] = [Boolean, Table(&coil::TABLE)];
static ARROW_KINDS: [Kind; 2] = [Boolean, Table(&arrow::TABLE)];

// The keys for additional objects that are drawn with a body.

pub(super) const ARROWS: KeySpec = KeySpec::new(
    "arrows",
    Table(&arrows::TABLE),
    "Arrows: from its surface for its velocity, acceleration and net force, parallel ones side by side; \
     from their points of action for its weight and contact forces",
)
.also(&["vectors", "arrow"]);
pub(super) const JOINT_ARROWS: KeySpec = KeySpec::new(
    "arrows",
    Table(&joint_arrows::TABLE),
    "Arrows for its action on its second end, starting there; the action on the first end is opposite",
)
.also(&["vectors", "arrow"]);
pub(super) const ARROW_OF_FORCE: KeySpec = KeySpec::new(
    "arrow",
    ARROW,
    "An arrow at each of its bodies, for this force alone, without the other forces; teal",
)
.default_flag(false)
.also(&["arrows", "vector"]);
pub(super) const AXES: KeySpec =
    KeySpec::new("axes", Either(&AXES_KINDS), "Its own axes x, y, z, which rotate with it")
        .default_flag(false)
        .also(&["triad", "frame"]);
pub(super) const GHOSTS: KeySpec = KeySpec::new(
    "ghosts",
    Table(&ghosts::TABLE),
    "Its earlier poses at regular intervals, drawn paler, as in a stroboscopic photo",
)
.also(&["ghost", "strobe", "stroboscope", "onion_skin"]);
pub(super) const TRAIL: KeySpec = KeySpec::new("trail", Either(&TRAIL_KINDS), "A line along its past path")
    .default_flag(false)
    .also(&["trails", "path", "trace", "track", "tail", "trajectory"]);
// The keys for the look of a spring.
pub(super) const LINE: KeySpec = KeySpec::new(
    "line",
    Choice(|| vec!["coil", "straight", "none"]),
    "Its form between its ends; not drawn if they leave no room",
)
.default_word("coil")
.also(&["look", "drawn", "draw", "visible", "style"]);
pub(super) const COIL: KeySpec = KeySpec::new(
    "coil",
    Either(&COIL_KINDS),
    "The size and color of its coil or line; `false` hides it, as `line = \"none\"` does",
)
.default_flag(true);

const COLOR: KeySpec = KeySpec::new("color", Color, "Its color").also(&["colour"]);

table! {
    arrows: "a body's arrows", Rule::Any;
    VELOCITY: Any = KeySpec::new("velocity", ARROW, "Its velocity, blue").default_flag(false).also(&["v"]),
    ACCELERATION: Any = KeySpec::new("acceleration", ARROW, "The net force on it divided by its mass, orange")
        .default_flag(false)
        .also(&["a"]),
    FORCE: Any = KeySpec::new("force", ARROW, "The net force on it, magenta")
        .default_flag(false)
        .also(&["f", "forces"]),
    WEIGHT: Any = KeySpec::new("weight", ARROW, "Its weight, green, from its center")
        .default_flag(false)
        .also(&["gravity"]),
    NORMAL: Any = KeySpec::new(
        "normal",
        ARROW,
        "The normal force of each touching body, red, from the contact; needs `simulation.contacts`",
    )
    .default_flag(false)
    .also(&["normal_force", "contact", "contacts", "reaction"]),
    FRICTION: Any = KeySpec::new(
        "friction",
        ARROW,
        "The friction of each touching body, yellow, from the contact; needs `simulation.contacts`",
    )
    .default_flag(false)
    .also(&["friction_force"]),
}

table! {
    joint_arrows: "a joint's arrows", Rule::Any;
    FORCE: Any = KeySpec::new("force", ARROW, "Its force, magenta")
        .default_flag(false)
        .also(&["f", "forces", "reaction"]),
    TORQUE: Any = KeySpec::new("torque", ARROW, "Its torque, along the torque's axis, green")
        .default_flag(false)
        .also(&["moment", "torques"]),
}

const ARROW: Kind = Either(&ARROW_KINDS);

table! {
    arrow: "an arrow", Rule::Any;
    SCALE: Option<f64> = KeySpec::new("scale", POSITIVE, "Its length per m/s, m/s², N or N·m")
        .unit("m")
        .default(
            "the same for all arrows of its kind, chosen to make the longest easy to see; all forces are of one kind",
        )
        .also(&["length", "factor", "size"]),
    COLOR: Option<value::Color> = super::COLOR.default("that of its kind"),
    LABEL: Option<value::Text> = KeySpec::new("label", Text, "The text at its tip, with values as in a label: `\"v = ${speed:.1}\"`")
        .default("none")
        .also(&["text", "name", "caption"]),
    COMPONENTS: Any = KeySpec::new(
        "components",
        LEG,
        "A direction: its components along and across the direction are drawn, too, as thinner arrows. The direction is given as a leg of an \
         angle: `[1, 0, 0]`, `\"ball.velocity\"`, the name of a body, or a point",
    )
    .default("none")
    .also(&["component", "along", "split"]),
    COMPONENT_LABELS: Any = KeySpec::new(
        "component_labels",
        List { of: &Text, min: 2, max: 2 },
        "The texts at the tips of both components",
    )
    .default("none")
    .also(&["component_texts", "component_names"]),
}

table! {
    axes: "a body's axes", Rule::Any;
    LENGTH: Option<f64> = KeySpec::new("length", POSITIVE, "The length of each")
    .unit("m")
    .default("twice the body's extent")
    .also(&["size", "scale"]),
}

table! {
    ghosts: "ghosts", Rule::Any;
    EVERY: Option<f64> = KeySpec::new("every", POSITIVE, "The interval; the first ghost is at 0")
        .unit("s")
        .required()
        .also(&["interval", "period", "step", "dt"]),
    ARROWS: bool = KeySpec::new("arrows", Boolean, "Whether each has the arrows of the body").default_flag(true),
}

table! {
    trail: "a trail", Rule::Any;
    DURATION: Option<f64> = KeySpec::new("duration", POSITIVE, "How far back it goes; it tapers towards its end")
        .unit("s")
        .default("the whole past")
        .also(&["length", "time"]),
    WIDTH: Option<f64> = KeySpec::new("width", POSITIVE, "Its width")
        .unit("m")
        .default("three thousandths of the picture's")
        .also(&["thickness", "radius"]),
    COLOR: Option<value::Color> = super::COLOR.default("that of the body, along its way"),
    AT: DVec3 = KeySpec::new(
        "at",
        VECTOR,
        "The point of the body that draws it, in the body's own axes, relative to its center of mass",
    )
    .unit("m")
    .default_numbers(&[0.0, 0.0, 0.0])
    .also(&["point", "offset", "of"]),
}

table! {
    coil: "a coil", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius, also that of a straight line")
        .unit("m")
        .default("by its length and the bodies at its ends"),
    TURNS: Option<u32> = KeySpec::new("turns", Integer(1, 200), "The number of its turns").default("The number of turns"),
    COLOR: Option<value::Color> = super::COLOR.default("steel"),
}
