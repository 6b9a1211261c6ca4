//! The keys of `[emitter.NAME]`.

use super::Kind::{Boolean, Colors, Drawn, Integer, List, Number, Reference, Table};
use super::contact::{FRICTION, RESTITUTION};
use super::keys::{ANY, AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::{Bound, Collection, Key, Rule, TableSpec};

pub(super) static EMITTER: TableSpec = TableSpec {
    noun: "an emitter",
    rule: Rule::ExactlyOne(&["rate", "burst"]),
    keys: &[
        Key::new("shape", Table(&SHAPE), "The form of each particle").required(),
        Key::new("rate", POSITIVE, "How many are born per second, one after another at even intervals")
            .unit("1/s")
            .also(&["frequency", "emission_rate", "per_second", "birth_rate"]),
        Key::new("burst", Integer(1, 1_000_000), "How many are born at once")
            .also(&["count", "number", "amount"]),
        Key::new("every", POSITIVE, "The time from one burst to the next")
            .unit("s")
            .default("there is one burst, at `start`")
            .also(&["interval", "period"]),
        Key::new("start", ANY, "When the first is born; before 0, some are there when the run begins")
            .unit("s")
            .default_number(0.0)
            .also(&["begin", "t0"]),
        Key::new("end", ANY, "When the last is born")
            .unit("s")
            .default("they are born until the run ends")
            .also(&["stop", "until", "t1"]),
        Key::new("lifetime", Drawn(Bound::Positive), "How long each is there")
            .unit("s")
            .default("it stays")
            .also(&["life", "duration", "age", "lives"]),
        Key::new("from", Table(&FROM), "Where they are born: each place of it is as likely")
            .also(&["origin", "at", "location", "position", "source"]),
        Key::new(
            "direction",
            AXIS,
            "The direction in which they leave; in the axes of the body that sends them out, if one does",
        )
        .default("up; from a surface, straight away from it")
        .also(&["towards", "axis"]),
        Key::new(
            "spread",
            Number(Bound::From(0.0, 180.0)),
            "How far they leave from that direction at most, each way as likely: 180 is to all sides",
        )
        .unit("degrees")
        .default_number(0.0)
        .also(&["cone", "cone_angle", "spread_angle"]),
        Key::new(
            "speed",
            Drawn(Bound::Any),
            "How fast they leave; the velocity of the body that sends them out is added",
        )
        .unit("m/s")
        .default_number(0.0)
        .also(&["velocity", "v", "initial_speed"]),
        Key::new("seed", Integer(0, 4_294_967_295), "What their random numbers follow from")
            .default("the `seed` of the scene")
            .also(&["random_seed"]),
        Key::new("mass", POSITIVE, "The mass of each").unit("kg").default_number(1.0).also(&["m", "weight"]),
        Key::new("charge", ANY, "The electric charge of each, for the forces `coulomb` and `lorentz`")
            .unit("C")
            .default_number(0.0)
            .also(&["q", "electric_charge"]),
        Key::new("color", Colors, "Their color; of several, the first at birth and the last at death")
            .default("white")
            .also(&["colors", "colour", "colours"]),
        Key::new(
            "size",
            List { of: &NON_NEGATIVE, min: 1, max: 64 },
            "The factors by which they are drawn larger, from birth to death: `[1, 0]` lets them vanish",
        )
        .default_numbers(&[1.0])
        .also(&["sizes", "scale"]),
        Key::new(
            "glow",
            NON_NEGATIVE,
            "How brightly they shine by themselves: 1 shows their color as it is, more is nearer to white",
        )
        .default_number(0.0)
        .also(&["emission", "brightness", "luminous"]),
        Key::new(
            "streak",
            NON_NEGATIVE,
            "Draws each as a streak: as long as its way in this time, as a camera sees sparks",
        )
        .unit("s")
        .default_number(0.0)
        .also(&["trail", "tail", "exposure"]),
        Key::new(
            "collides",
            Boolean,
            "Whether bodies and the ground stop them: they bounce, slide and rest. Needs `simulation.contacts`",
        )
        .default_flag(false)
        .also(&["collision", "collisions", "collide", "contact", "contacts"]),
        RESTITUTION.default("that of the body; with neither's, 0"),
        FRICTION.default("that of the body; with neither's, 0.5"),
    ],
};

static SHAPE: TableSpec = TableSpec {
    noun: "the shape of a particle",
    rule: Rule::ExactlyOne(&["sphere"]),
    keys: &[Key::new("sphere", Table(&SPHERE), "A ball").also(&["ball"])],
};

static SPHERE: TableSpec = TableSpec {
    noun: "the ball of a particle",
    rule: Rule::Any,
    keys: &[Key::new("radius", POSITIVE, "Its radius").unit("m").required().also(&["r", "size", "diameter"])],
};

static FROM: TableSpec = TableSpec {
    noun: "the origin of particles",
    rule: Rule::ExactlyOne(&["point", "disc", "box", "surface"]),
    keys: &[
        Key::new("point", VECTOR, "A point").unit("m").also(&["location", "position"]),
        Key::new("disc", Table(&DISC), "A flat disc").also(&["disk", "circle"]),
        Key::new("box", Table(&BOX), "All of a box").also(&["cube", "volume"]),
        Key::new(
            "surface",
            Reference(Collection::Body),
            "The surface of a body: a sphere, box, cylinder, capsule, cone, torus, mesh or heightfield",
        )
        .also(&["surface_of", "mesh"]),
        Key::new(
            "body",
            Reference(Collection::Body),
            "The body that sends them out: the place is in its axes, from its centre",
        )
        .default("the place is in the world")
        .also(&["on", "attached_to", "follow"]),
    ],
};

static DISC: TableSpec = TableSpec {
    noun: "a disc",
    rule: Rule::Any,
    keys: &[
        Key::new("location", VECTOR, "Its middle")
            .unit("m")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["center", "centre", "point", "position"]),
        Key::new("radius", POSITIVE, "Its radius").unit("m").required().also(&["r"]),
        Key::new("normal", AXIS, "What stands on it").default("the direction of the emitter"),
    ],
};

static BOX: TableSpec = TableSpec {
    noun: "a box of births",
    rule: Rule::Any,
    keys: &[
        Key::new("location", VECTOR, "Its middle")
            .unit("m")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["center", "centre", "point", "position"]),
        Key::new("size", super::Kind::Numbers(3, Bound::Positive), "The full lengths of its edges")
            .unit("m")
            .required()
            .also(&["edges", "dimensions"]),
    ],
};
