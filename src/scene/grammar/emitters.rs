//! The grammar of `[emitter.NAME]`, which describes a source of particles.

use super::Kind::{Boolean, Colors, Integer, List, Number, Numbers, Reference, Sampled, Table};
use super::contact::{FRICTION, RESTITUTION};
use super::key::table;
use super::kind::{ANY, AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::{Bound, Collection, KeySpec, Rule};

table! {
    emitter: "an emitter", Rule::ExactlyOne(&["rate", "burst"]);
    SHAPE: Any = KeySpec::new("shape", Table(&shape::TABLE), "The form of each particle").required(),
    RATE: Option<f64> = KeySpec::new("rate", POSITIVE, "Particles per second, at even intervals").unit("1/s").also(&[
        "frequency",
        "emission_rate",
        "per_second",
        "birth_rate",
    ]),
    BURST: Option<u32> = KeySpec::new("burst", Integer(1, 1_000_000), "Particles emitted at once")
        .also(&["count", "number", "amount"]),
    EVERY: Option<f64> = KeySpec::new("every", POSITIVE, "The time from one burst to the next")
        .unit("s")
        .default("one burst, at `start`")
        .also(&["interval", "period"]),
    START: f64 = KeySpec::new(
        "start",
        ANY,
        "When the first is emitted; if before 0, some already exist when the run begins",
    )
    .unit("s")
    .default_number(0.0)
    .also(&["begin", "t0"]),
    END: Option<f64> = KeySpec::new("end", ANY, "When the last is emitted")
        .unit("s")
        .default("the end of the run")
        .also(&["stop", "until", "t1"]),
    LIFETIME: Option<value::Sampled> = KeySpec::new("lifetime", Sampled(Bound::Positive), "How long each exists")
        .unit("s")
        .default("it stays")
        .also(&["life", "duration", "age", "lives"]),
    FROM: Any = KeySpec::new("from", Table(&from::TABLE), "Where they are emitted; uniformly distributed")
        .also(&["origin", "at", "location", "position", "source"]),
    DIRECTION: Option<value::Axis> = KeySpec::new("direction", AXIS, "Their initial direction; in the axes of the emitting body, if any")
        .default("up; for a surface, its normal")
        .also(&["towards", "axis"]),
    SPREAD: f64 = KeySpec::new(
        "spread",
        Number(Bound::From(0.0, 180.0)),
        "The largest angle from that direction, uniform over the solid angle; 180 for all directions",
    )
    .unit("degrees")
    .default_number(0.0)
    .also(&["cone", "cone_angle", "spread_angle"]),
    SPEED: value::Sampled = KeySpec::new(
        "speed",
        Sampled(Bound::Any),
        "Their initial speed; the velocity of the emitting body is added",
    )
    .unit("m/s")
    .default_number(0.0)
    .also(&["velocity", "v", "initial_speed"]),
    SEED: Option<u32> = KeySpec::new("seed", Integer(0, 4_294_967_295), "The seed of their random numbers")
        .default("the `seed` of the scene")
        .also(&["random_seed"]),
    MASS: f64 = KeySpec::new("mass", POSITIVE, "The mass of each")
        .unit("kg")
        .default_number(1.0)
        .also(&["m", "weight"]),
    CHARGE: f64 = KeySpec::new("charge", ANY, "The electric charge of each, for the forces `coulomb` and `lorentz`")
        .unit("C")
        .default_number(0.0)
        .also(&["q", "electric_charge"]),
    COLOR: Option<value::Colors> = KeySpec::new("color", Colors, "Their color; of several, the first at birth and the last at death")
        .default("white")
        .also(&["colors", "colour", "colours"]),
    SIZE: Any = KeySpec::new(
        "size",
        List { of: &NON_NEGATIVE, min: 1, max: 64 },
        "Their drawn size as a factor, from birth to death: with `[1, 0]` they shrink to nothing",
    )
    .default_numbers(&[1.0])
    .also(&["sizes", "scale"]),
    GLOW: f64 = KeySpec::new(
        "glow",
        NON_NEGATIVE,
        "Their own glow: 1 shows their color unchanged, more is nearer to white",
    )
    .default_number(0.0)
    .also(&["emission", "brightness", "luminous"]),
    STREAK: f64 = KeySpec::new(
        "streak",
        NON_NEGATIVE,
        "Draws each as a streak along its path during this time, as a camera shows sparks",
    )
    .unit("s")
    .default_number(0.0)
    .also(&["trail", "tail", "exposure"]),
    COLLIDES: bool = KeySpec::new(
        "collides",
        Boolean,
        "Whether they collide with bodies and the ground: they bounce, slide and rest. Needs \
         `simulation.contacts`",
    )
    .default_flag(false)
    .also(&["collision", "collisions", "collide", "contact", "contacts"]),
    RESTITUTION: Option<f64> = super::RESTITUTION.default("0"),
    FRICTION: Option<f64> = super::FRICTION.default("that of the body; 0.5 if neither has one"),
}

table! {
    shape: "the shape of a particle", Rule::ExactlyOne(&["sphere"]);
    SPHERE: Any = KeySpec::new("sphere", Table(&sphere::TABLE), "A ball").also(&["ball"]),
}

table! {
    sphere: "the ball of a particle", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius")
    .unit("m")
    .required()
    .also(&["r", "size", "diameter"]),
}

table! {
    from: "the origin of particles", Rule::ExactlyOne(&["point", "disc", "box", "surface"]);
    POINT: Option<DVec3> = KeySpec::new("point", VECTOR, "A point").unit("m").also(&["location", "position"]),
    DISC: Any = KeySpec::new("disc", Table(&disc::TABLE), "A flat disc").also(&["disk", "circle"]),
    BOX: Any = KeySpec::new("box", Table(&cuboid::TABLE), "The volume of a box").also(&["cube", "volume"]),
    SURFACE: Option<value::Text> = KeySpec::new(
        "surface",
        Reference(Collection::Body),
        "The surface of a body: a sphere, box, cylinder, capsule, cone, torus, mesh or heightfield",
    )
    .also(&["surface_of", "mesh"]),
    BODY: Option<value::Text> = KeySpec::new(
        "body",
        Reference(Collection::Body),
        "The emitting body; the position is in its axes, from its center",
    )
    .default("none: the position is in the world")
    .also(&["on", "attached_to", "follow"]),
}

table! {
    disc: "a disc", Rule::Any;
    LOCATION: DVec3 = KeySpec::new("location", VECTOR, "Its middle")
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["center", "centre", "point", "position"]),
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required().also(&["r"]),
    NORMAL: Option<value::Axis> = KeySpec::new("normal", AXIS, "What stands on it").default("The normal of the disc"),
}

table! {
    cuboid: "a box of emission", Rule::Any;
    LOCATION: DVec3 = KeySpec::new("location", VECTOR, "Its middle")
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["center", "centre", "point", "position"]),
    SIZE: Option<DVec3> = KeySpec::new("size", Numbers(3, Bound::Positive), "The full lengths of its edges")
        .unit("m")
        .required()
        .also(&["edges", "dimensions"]),
}
