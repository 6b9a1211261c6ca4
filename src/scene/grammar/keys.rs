//! The grammar of the whole scene and of its main tables.
//!
//! To add a key, describe it here, read it in `scene/check`, and add a scene that uses it.

use super::Kind::{
    Asset, Boolean, Choice, Color, Direction, Either, Identifier, Include, Integer, List, Named, Number,
    Numbers, Partial, Reference, Sdl, Table, Text, Variables,
};
use super::camera::CAMERA;
use super::contact::{COLLIDES, COLLISION_GROUP, FRICTION, RESTITUTION, ROLLING_FRICTION};
use super::emitters::EMITTER;
use super::forces::FORCE;
use super::joints::JOINT;
use super::labels;
use super::lights::LIGHT;
use super::motion::MOTION;
use super::repeat::{COUNT, REPEAT};
use super::shapes::SHAPE;
use super::showing;
use super::{Bound, Collection, KeySpec, Kind, Rule, TableSpec};
use crate::dynamics::{METHODS, Method};
use crate::scene::sdl::Where;
use crate::scene::{ContactLaw, Finish, Layout, MATERIALS, Preset};

pub(super) const ANY: Kind = Number(Bound::Any);
pub(super) const POSITIVE: Kind = Number(Bound::Positive);
pub(super) const NON_NEGATIVE: Kind = Number(Bound::NonNegative);
pub(super) const VECTOR: Kind = Numbers(3, Bound::Any);
pub(super) const AXIS: Kind = Direction(3);

fn integrators() -> Vec<&'static str> {
    Method::all().map(|method| method.name).collect()
}

fn contact_laws() -> Vec<&'static str> {
    ContactLaw::ALL.iter().map(|law| law.name()).collect()
}

fn finishes() -> Vec<&'static str> {
    Finish::ALL.iter().map(|finish| finish.name()).collect()
}

fn presets() -> Vec<&'static str> {
    Preset::ALL.iter().map(|preset| preset.name()).collect()
}

fn library() -> Vec<&'static str> {
    MATERIALS.iter().map(|material| material.name).collect()
}

/// The grammar of a whole scene. All other tables are reached from it.
pub static SCENE: TableSpec = TableSpec {
    noun: "a scene",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("title", Text, "The title of the scene, at the head of every script")
            .default("none")
            .also(&["name"]),
        KeySpec::new(
            "include",
            List { of: &Text, min: 0, max: usize::MAX },
            "Scene files to read first; this file's values override theirs",
        )
        .default_numbers(&[])
        .also(&["includes", "import"]),
        KeySpec::new("seed", Integer(0, 4_294_967_295), "The seed of the random numbers in formulas")
            .default_number(0.0)
            .also(&["random_seed"]),
        KeySpec::new("variables", Variables, "Named numbers for formulas").default("none").also(&[
            "variable",
            "vars",
            "constants",
            "parameters",
            "let",
        ]),
        KeySpec::new("simulation", Table(&SIMULATION), "The duration, timestep and method of the simulation"),
        KeySpec::new("body", Named(&BODY), "The rigid bodies").also(&["bodies", "object"]),
        KeySpec::new("force", Named(&FORCE), "Forces on or between bodies").also(&["forces"]),
        KeySpec::new("joint", Named(&JOINT), "Joints between bodies").also(&[
            "joints",
            "constraint",
            "constraints",
        ]),
        KeySpec::new("emitter", Named(&EMITTER), "Sources of particles, such as drops and sparks").also(&[
            "emitters",
            "particles",
            "particle",
            "particle_system",
        ]),
        KeySpec::new("material", Named(&MATERIAL), "The looks of bodies").also(&["materials", "texture"]),
        KeySpec::new("camera", Table(&CAMERA), "The main camera"),
        KeySpec::new(
            "view",
            Named(&CAMERA),
            "Additional cameras, for `--view`; missing keys are as in `[camera]`",
        )
        .also(&["views", "cameras"]),
        KeySpec::new("light", Named(&LIGHT), "The lights; without any, a warm lamp and a weak fill")
            .also(&["lights"]),
        KeySpec::new(
            "defaults",
            Table(&DEFAULTS),
            "Defaults for missing keys of bodies, forces, materials and lights",
        )
        .also(&["default"]),
        KeySpec::new(
            "environment",
            Either(&[Choice(presets), Table(&ENVIRONMENT)]),
            "Ground, sky, fog and default lights: a name is short for `environment.preset`",
        )
        .default("\"daylight\"")
        .also(&["world"]),
        labels::LABEL,
        labels::SCALE_BAR,
        labels::GRID,
        KeySpec::new("povray", Table(&POVRAY), "Passed to POV-Ray unchanged"),
        KeySpec::new("output", Table(&OUTPUT), "The images to render").also(&["render"]),
    ],
};

static DEFAULTS: TableSpec = TableSpec {
    noun: "the defaults",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("body", Partial(&BODY), "For every `[body.NAME]`; the body's own keys override them")
            .default("none")
            .also(&["bodies"]),
        KeySpec::new("force", Partial(&FORCE), "For every `[force.NAME]`").default("none").also(&["forces"]),
        KeySpec::new("material", Partial(&MATERIAL), "For every `[material.NAME]`")
            .default("none")
            .also(&["materials"]),
        KeySpec::new("light", Partial(&LIGHT), "For every `[light.NAME]`").default("none").also(&["lights"]),
    ],
};

static SIMULATION: TableSpec = TableSpec {
    noun: "the simulation",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "duration",
            NON_NEGATIVE,
            "The time of the last frame, rounded to a whole frame; the first is at 0",
        )
        .unit("s")
        .default_number(10.0)
        .also(&[
            "time",
            "length",
            "end",
            "t_end",
            "end_time",
            "stop",
            "t_max",
            "tmax",
            "total_time",
            "runtime",
        ]),
        KeySpec::new("frame_rate", POSITIVE, "Frames per second: frame k shows the time k / frame_rate")
            .unit("frames/s")
            .default_number(25.0)
            .also(&["fps", "rate"]),
        KeySpec::new(
            "step",
            POSITIVE,
            "The longest timestep; the actual one divides the time between frames evenly. Adaptive \
             integrators choose their own and use `tolerance` instead",
        )
        .unit("s")
        .default_fraction(1.0, 240.0)
        .also(&["dt", "timestep", "time_step", "delta"]),
        KeySpec::new(
            "tolerance",
            POSITIVE,
            "The error per step of an adaptive integrator: for `dop853`, relative to the size of positions \
             and velocities; for `gauss-radau`, the ε of IAS15",
        )
        .default_number(1e-9)
        .also(&["tol", "rtol", "atol", "accuracy", "epsilon"]),
        KeySpec::new("integrator", Choice(integrators), "The integration method")
            .default_word(METHODS[0].name)
            .also(&["method", "solver"]),
        KeySpec::new("gravity", VECTOR, "The acceleration of every movable body")
            .unit("m/s²")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["g"]),
        KeySpec::new(
            "contacts",
            Choice(contact_laws),
            "Makes bodies collide, with each other and with the ground, by default at height 0; \
             `\"event-driven\"` finds the time of each impact, for few bodies; `\"time-stepping\"` solves \
             all contacts of a timestep together, for many",
        )
        .default("bodies pass through each other")
        .also(&["contact", "collisions", "collision", "collide", "collides"]),
    ],
};

static BODY: TableSpec = TableSpec {
    noun: "a body",
    rule: Rule::AtMostOne(&[&["mass", "density"], &["fixed", "motion"]]),
    keys: &[
        KeySpec::new("shape", Table(&SHAPE), "Its shape, centred at its location, with its axis along y")
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
        KeySpec::new("location", VECTOR, "Its centre of mass at the start")
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
        KeySpec::new("force", VECTOR, "A constant force at its centre, in world axes")
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
        RESTITUTION.default("the other body's; 0 if neither has one"),
        FRICTION.default("the other body's; 0.5 if neither has one"),
        ROLLING_FRICTION.default("the other body's; 0 if neither has one"),
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
            "Draw it this many times its true size, about its centre of mass",
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

static MATERIAL: TableSpec = TableSpec {
    noun: "a material",
    rule: Rule::AtMostOne(&[&["color", "texture", "sdl"], &["finish", "like", "texture", "sdl"]]),
    keys: &[
        KeySpec::new(
            "color",
            Color,
            "Its color: [red, green, blue] in sRGB from 0 to 1, \"#rrggbb\", \"#rgb\", or a CSS name",
        )
        .default("white, or that of the `like` material")
        .also(&["colour", "rgb", "pigment", "diffuse"]),
        KeySpec::new(
            "like",
            Choice(library),
            "A material of [the library](materials.md), which `color` tints",
        )
        .default("given by `color` and `finish`")
        .also(&["base", "kind", "extends"]),
        KeySpec::new("finish", Choice(finishes), "How its surface reflects light").default_word("glossy"),
        KeySpec::new("texture", Identifier, "The name of a texture from an include file")
            .default("given by `color` and `finish`"),
        KeySpec::new(
            "sdl",
            Sdl(Where::Inside),
            "SDL for the inside of an object: `texture { … }`, `interior { … }`",
        )
        .default("given by `color` and `finish`"),
    ],
};

fn layouts() -> Vec<&'static str> {
    Layout::ALL.iter().map(|layout| layout.name()).collect()
}

static ENVIRONMENT: TableSpec = TableSpec {
    noun: "the environment",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "preset",
            Choice(presets),
            "A matching set of sky, ground, default lights and ambient light; each can be replaced",
        )
        .default("\"daylight\""),
        KeySpec::new("ground", Either(&[Boolean, Table(&GROUND)]), "The checkered ground")
            .default("true; false in space, or if a body is a plane")
            .also(&["floor"]),
        KeySpec::new(
            "sky",
            Either(&[Boolean, Color]),
            "The sky: that of the preset, a plain color, or none (black)",
        )
        .default_flag(true)
        .also(&["background"]),
        KeySpec::new("fog", Boolean, "Haze into which the ground fades towards the horizon")
            .default_flag(true)
            .also(&["haze"]),
    ],
};

static GROUND: TableSpec = TableSpec {
    noun: "the ground",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("height", ANY, "Its height")
            .unit("m")
            .default("just under the lowest point of the motion; with `simulation.contacts`, 0")
            .also(&["y", "level"]),
        KeySpec::new("tile", POSITIVE, "The edge of one tile").unit("m").default(
            "the `spacing` of a grid on it; else 1, 2 or 5 times a power of ten, by the size of the motion",
        ),
        RESTITUTION.default("that of the body on it; 0 if neither has one"),
        FRICTION.default("that of the body on it; 0.5 if neither has one"),
        ROLLING_FRICTION.default("that of the body on it; 0 if neither has one"),
    ],
};

static POVRAY: TableSpec = TableSpec {
    noun: "the part for POV-Ray",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "include",
            List { of: &Include, min: 0, max: usize::MAX },
            "Include files: POV-Ray's own, or files beside the scene, which are copied into the scripts",
        )
        .default_numbers(&[])
        .also(&["includes"]),
        KeySpec::new(
            "assets",
            List { of: &Asset, min: 0, max: usize::MAX },
            "Files beside the scene that SDL reads, such as images, height fields and fonts; they are \
             copied to the folder `assets` beside the scripts. SDL refers to them by the names in this list",
        )
        .default_numbers(&[])
        .also(&["files", "images", "textures", "maps"]),
        KeySpec::new("sdl", Sdl(Where::Top), "SDL for every script, before the bodies").default("none"),
        KeySpec::new(
            "templates",
            Text,
            "A folder with templates that replace those built in; needs `--trust`",
        )
        .default("those built in"),
        KeySpec::new("unit", POSITIVE, "The length of one POV-Ray unit")
            .unit("m")
            .default("1; a power of ten for scenes too small or too large for POV-Ray"),
        KeySpec::new("digits", Integer(4, 17), "Significant digits of the numbers in scripts")
            .default_number(9.0),
    ],
};

static OUTPUT: TableSpec = TableSpec {
    noun: "the output",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "size",
            List { of: &Integer(1, 65535), min: 2, max: 2 },
            "Width and height of the images",
        )
        .unit("pixels")
        .default_numbers(&[1280.0, 720.0])
        .also(&["resolution", "width", "height"]),
        KeySpec::new(
            "layout",
            Choice(layouts),
            "Whether every script is complete; else shared parts are in `common.inc`",
        )
        .default_word("self-contained"),
        KeySpec::new(
            "transparent",
            Boolean,
            "Whether the background is transparent (alpha), without sky and ground",
        )
        .default_flag(false)
        .also(&["alpha"]),
        KeySpec::new(
            "video_rate",
            Number(Bound::From(0.01, 1000.0)),
            "Frames per second of the film: slow motion below `frame_rate`, time lapse above it",
        )
        .unit("frames/s")
        .default("`simulation.frame_rate`, or 25 if that is not from 1 to 120")
        .also(&["film_rate", "playback_rate", "fps"]),
    ],
};
