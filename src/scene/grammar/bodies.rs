//! The grammar of `[body.NAME]`: the keys that describe a body.

use super::Kind::{Boolean, Direction, Either, Number, Numbers, Reference, Sdl, Table};
use super::contact::{COLLIDES, COLLISION_GROUP, FRICTION, RESTITUTION, ROLLING_FRICTION};
use super::key::table;
use super::kind::{ANY, AXIS, POSITIVE, VECTOR};
use super::materials;
use super::motion;
use super::repeat;
use super::repeat::COUNT;
use super::shapes;
use super::showing;
use super::{Bound, Collection, KeySpec, Rule};
use crate::scene::sdl::Where;

table! {
    body: "a body", Rule::AtMostOne(&[&["mass", "density"], &["fixed", "motion"]]);
    SHAPE: Any = KeySpec::new("shape", Table(&shapes::shape::TABLE), "Its shape, centered at its location, with its axis along y")
        .required(),
    MASS: f64 = KeySpec::new("mass", POSITIVE, "Its mass").unit("kg").default_number(1.0).also(&["m", "weight"]),
    DENSITY: Option<f64> = KeySpec::new("density", POSITIVE, "Its density, which sets its mass")
        .unit("kg/m³")
        .default("from `mass`"),
    CHARGE: f64 = KeySpec::new("charge", ANY, "Its electric charge, for the forces `coulomb` and `lorentz`")
        .unit("C")
        .default_number(0.0)
        .also(&["q", "electric_charge"]),
    MAGNETIC_MOMENT: DVec3 = KeySpec::new(
        "magnetic_moment",
        VECTOR,
        "Its magnetic moment in its own axes, for the force `dipoles`",
    )
    .unit("A·m²")
    .default_numbers(&[0.0, 0.0, 0.0])
    .also(&["dipole_moment", "magnetization", "dipole"]),
    INERTIA: Option<DVec3> = KeySpec::new(
        "inertia",
        Numbers(3, Bound::Positive),
        "Its principal moments of inertia about its own x, y, z axes",
    )
    .unit("kg·m²")
    .default("those of a uniform solid of its shape"),
    LOCATION: DVec3 = KeySpec::new("location", VECTOR, "Its center of mass at the start")
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["position", "pos", "center", "translate", "origin"]),
    ORIENTATION: Any = KeySpec::new(
        "orientation",
        Either(&[VECTOR, Table(&orientation::TABLE)]),
        "Its initial orientation: a list of three angles is short for `orientation.euler`",
    )
    .unit("degrees")
    .default("not turned")
    .also(&["rotation", "rotate", "angle", "attitude"]),
    MOTION: Any = KeySpec::new(
        "motion",
        Table(&motion::motion::TABLE),
        "A prescribed motion: the body follows it, unaffected by forces",
    )
    .default("none: forces move it")
    .also(&["path", "trajectory", "animation", "keyframes", "kinematic"]),
    VELOCITY: DVec3 = KeySpec::new("velocity", VECTOR, "Its velocity at the start")
        .unit("m/s")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["v", "speed", "initial_velocity"]),
    ANGULAR_VELOCITY: DVec3 = KeySpec::new("angular_velocity", VECTOR, "Its angular velocity at the start, in world axes")
        .unit("rad/s")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["spin", "omega", "initial_angular_velocity"]),
    START: Option<f64> = KeySpec::new(
        "start",
        ANY,
        "When it appears. Its `location` and `velocity` are those at that time, or at t = 0 if that is \
         later",
    )
    .unit("s")
    .default("the start of the run")
    .also(&["birth", "born", "begin", "appears", "t0"]),
    END: Option<f64> = KeySpec::new(
        "end",
        ANY,
        "When it disappears. An absent body neither acts nor is acted on, and its joints hold nothing",
    )
    .unit("s")
    .default("it stays")
    .also(&["death", "dies", "until", "vanishes", "t1"]),
    FORCE: DVec3 = KeySpec::new("force", VECTOR, "A constant force at its center, in world axes")
        .unit("N")
        .default_numbers(&[0.0, 0.0, 0.0]),
    TORQUE: DVec3 = KeySpec::new("torque", VECTOR, "A constant torque, in world axes")
        .unit("N·m")
        .default_numbers(&[0.0, 0.0, 0.0]),
    FIXED: bool = KeySpec::new(
        "fixed",
        Boolean,
        "Whether it never moves, whatever acts on it; a plane is always fixed",
    )
    .default_flag(false)
    .also(&["static", "anchored"]),
    RESTITUTION: Option<f64> = super::RESTITUTION.default("0"),
    FRICTION: Option<f64> = super::FRICTION.default("the other body's; 0.5 if neither has one"),
    ROLLING_FRICTION: Option<f64> = super::ROLLING_FRICTION.default("0"),
    COLLIDES: Option<bool> = super::COLLIDES,
    COLLISION_GROUP: Option<value::SharedText> = super::COLLISION_GROUP,
    MATERIAL: Any = KeySpec::new(
        "material",
        Either(&[Reference(Collection::Material), Table(&materials::material::TABLE)]),
        "Its look: a `[material.NAME]`, or else a name of [the library](materials.md), or a table of a \
         material's keys",
    )
    .default("the next palette color, in file order")
    .also(&["texture"]),
    LOOK: Any = KeySpec::new("look", Table(&look::TABLE), "How its picture differs from its mechanics"),
    REPEAT: Any = KeySpec::new(
        "repeat",
        Either(&[COUNT, Table(&repeat::repeat::TABLE)]),
        "Makes copies: their number, or their arrangement; their `location` is relative to their \
         position in it",
    )
    .default("one body")
    .also(&["array", "copies", "instances", "clone", "duplicate"]),
    ARROWS: Any = showing::ARROWS,
    AXES: Any = showing::AXES,
    GHOSTS: Any = showing::GHOSTS,
    TRAIL: Any = showing::TRAIL,
}

// The bounds of a scale are wide enough for any use, and keep the square of every drawn length finite.
static SCALE_KINDS: [super::Kind; 2] =
    [Number(Bound::From(1e-9, 1e9)), Table(&materials::mapped_number::TABLE)];
static VISIBLE_KINDS: [super::Kind; 2] = [Boolean, super::Kind::Text];

table! {
    look: "a body's look", Rule::Any;
    SCALE: Any = KeySpec::new(
        "scale",
        Either(&SCALE_KINDS),
        "Draw it this many times its true size, about its center of mass; or `{ map = { … } }`, with the numbers `to = [1, 2]` unless given",
    )
    .default_number(1.0)
    .also(&["size", "magnification", "enlarge"]),
    VISIBLE: Any = KeySpec::new(
        "visible",
        Either(&VISIBLE_KINDS),
        "Whether it is drawn; a formula of measures, such as `\"speed > 1\"`, draws it while it is not 0",
    )
    .default_flag(true)
    .also(&["show", "shown", "visibility", "draw", "drawn"]),
    SDL_BEFORE: Option<value::SharedText> = KeySpec::new(
        "sdl_before",
        Sdl(Where::Inside),
        "SDL at the end of its object, before its placing matrix: moves with the body",
    )
    .default("none")
    .also(&["sdl", "pre_sdl"]),
    SDL_AFTER: Option<value::SharedText> = KeySpec::new("sdl_after", Sdl(Where::Inside), "SDL after that matrix: fixed in the world")
        .default("none")
        .also(&["post_sdl"]),
}

table! {
    orientation: "an orientation", Rule::AtMostOne(&[&["euler", "axis", "quaternion"], &["euler", "angle", "quaternion"]]);
    EULER: DVec3 = KeySpec::new(
        "euler",
        VECTOR,
        "Rotations about the world's x, then y, then z, as by POV-Ray's `rotate <x, y, z>`",
    )
    .unit("degrees")
    .default_numbers(&[0.0, 0.0, 0.0]),
    AXIS: Option<value::Axis> = KeySpec::new("axis", super::AXIS, "The axis of rotation; goes with `angle`").default("none"),
    ANGLE: Option<f64> = KeySpec::new("angle", ANY, "The angle of rotation about `axis`, by the right-hand rule")
        .unit("degrees")
        .default("none"),
    QUATERNION: value::Quaternion = KeySpec::new("quaternion", Direction(4), "A quaternion [x, y, z, w] of any length")
        .default_numbers(&[0.0, 0.0, 0.0, 1.0]),
}
