//! The grammar of `[body.NAME]`: the keys that describe a body.

use super::Kind::{Boolean, Direction, Either, Number, Numbers, Reference, Sdl, Table};
use super::contact::{COLLIDES, COLLISION_GROUP, FRICTION, RESTITUTION, ROLLING_FRICTION};
use super::kind::{ANY, AXIS, POSITIVE, VECTOR};
use super::materials::MATERIAL;
use super::motion::MOTION;
use super::repeat::{COUNT, REPEAT};
use super::shapes::SHAPE;
use super::showing;
use super::{Bound, Collection, KeySpec, Rule, TableSpec};
use crate::scene::sdl::Where;

pub(super) static BODY: TableSpec = TableSpec {
    noun: "a body",
    rule: Rule::AtMostOne(&[&["mass", "density"], &["fixed", "motion"]]),
    keys: &[
        KeySpec::new("shape", Table(&SHAPE), "Its shape, centered at its location, with its axis along y")
            .required(),
        KeySpec::new("mass", POSITIVE, "Its mass").unit("kg").default_number(1.0).also(&["m", "weight"]),
        KeySpec::new("density", POSITIVE, "Its density, which sets its mass")
            .unit("kg/m³")
            .default("from `mass`"),
        KeySpec::new("charge", ANY, "Its electric charge, for the forces `coulomb` and `lorentz`")
            .unit("C")
            .default_number(0.0)
            .also(&["q", "electric_charge"]),
        KeySpec::new(
            "magnetic_moment",
            VECTOR,
            "Its magnetic moment in its own axes, for the force `dipoles`",
        )
        .unit("A·m²")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["dipole_moment", "magnetization", "dipole"]),
        KeySpec::new(
            "inertia",
            Numbers(3, Bound::Positive),
            "Its principal moments of inertia about its own x, y, z axes",
        )
        .unit("kg·m²")
        .default("those of a uniform solid of its shape"),
        KeySpec::new("location", VECTOR, "Its center of mass at the start")
            .unit("m")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["position", "pos", "center", "translate", "origin"]),
        KeySpec::new(
            "orientation",
            Either(&[VECTOR, Table(&ORIENTATION)]),
            "Its initial orientation: a list of three angles is short for `orientation.euler`",
        )
        .unit("degrees")
        .default("not turned")
        .also(&["rotation", "rotate", "angle", "attitude"]),
        KeySpec::new(
            "motion",
            Table(&MOTION),
            "A prescribed motion: the body follows it, unaffected by forces",
        )
        .default("none: forces move it")
        .also(&["path", "trajectory", "animation", "keyframes", "kinematic"]),
        KeySpec::new("velocity", VECTOR, "Its velocity at the start")
            .unit("m/s")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["v", "speed", "initial_velocity"]),
        KeySpec::new("angular_velocity", VECTOR, "Its angular velocity at the start, in world axes")
            .unit("rad/s")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["spin", "omega", "initial_angular_velocity"]),
        KeySpec::new(
            "start",
            ANY,
            "When it appears. Its `location` and `velocity` are those at that time, or at t = 0 if that is \
             later",
        )
        .unit("s")
        .default("the start of the run")
        .also(&["birth", "born", "begin", "appears", "t0"]),
        KeySpec::new(
            "end",
            ANY,
            "When it disappears. An absent body neither acts nor is acted on, and its joints hold nothing",
        )
        .unit("s")
        .default("it stays")
        .also(&["death", "dies", "until", "vanishes", "t1"]),
        KeySpec::new("force", VECTOR, "A constant force at its center, in world axes")
            .unit("N")
            .default_numbers(&[0.0, 0.0, 0.0]),
        KeySpec::new("torque", VECTOR, "A constant torque, in world axes")
            .unit("N·m")
            .default_numbers(&[0.0, 0.0, 0.0]),
        KeySpec::new(
            "fixed",
            Boolean,
            "Whether it never moves, whatever acts on it; a plane is always fixed",
        )
        .default_flag(false)
        .also(&["static", "anchored"]),
        RESTITUTION.default("0"),
        FRICTION.default("the other body's; 0.5 if neither has one"),
        ROLLING_FRICTION.default("0"),
        COLLIDES,
        COLLISION_GROUP,
        KeySpec::new(
            "material",
            Either(&[Reference(Collection::Material), Table(&MATERIAL)]),
            "Its look: a `[material.NAME]`, or else a name of [the library](materials.md), or a table of a \
             material's keys",
        )
        .default("the next palette color, in file order")
        .also(&["texture"]),
        KeySpec::new("look", Table(&BODY_LOOK), "How its picture differs from its mechanics"),
        KeySpec::new(
            "repeat",
            Either(&[COUNT, Table(&REPEAT)]),
            "Makes copies: their number, or their arrangement; their `location` is relative to their \
             position in it",
        )
        .default("one body")
        .also(&["array", "copies", "instances", "clone", "duplicate"]),
        showing::ARROWS,
        showing::AXES,
        showing::GHOSTS,
        showing::TRAIL,
    ],
};

static BODY_LOOK: TableSpec = TableSpec {
    noun: "a body's look",
    rule: Rule::Any,
    keys: &[
        // These bounds are wide enough for any use, and keep the square of every drawn length finite.
        KeySpec::new(
            "scale",
            Number(Bound::From(1e-9, 1e9)),
            "Draw it this many times its true size, about its center of mass",
        )
        .default_number(1.0)
        .also(&["size", "magnification", "enlarge"]),
        KeySpec::new(
            "sdl_before",
            Sdl(Where::Inside),
            "SDL at the end of its object, before its placing matrix: moves with the body",
        )
        .default("none")
        .also(&["sdl", "pre_sdl"]),
        KeySpec::new("sdl_after", Sdl(Where::Inside), "SDL after that matrix: fixed in the world")
            .default("none")
            .also(&["post_sdl"]),
    ],
};

pub(super) static ORIENTATION: TableSpec = TableSpec {
    noun: "an orientation",
    rule: Rule::AtMostOne(&[&["euler", "axis", "quaternion"], &["euler", "angle", "quaternion"]]),
    keys: &[
        KeySpec::new(
            "euler",
            VECTOR,
            "Rotations about the world's x, then y, then z, as by POV-Ray's `rotate <x, y, z>`",
        )
        .unit("degrees")
        .default_numbers(&[0.0, 0.0, 0.0]),
        KeySpec::new("axis", AXIS, "The axis of rotation; goes with `angle`").default("none"),
        KeySpec::new("angle", ANY, "The angle of rotation about `axis`, by the right-hand rule")
            .unit("degrees")
            .default("none"),
        KeySpec::new("quaternion", Direction(4), "A quaternion [x, y, z, w] of any length")
            .default_numbers(&[0.0, 0.0, 0.0, 1.0]),
    ],
};
