//! Every key of the scene language.
//!
//! To add one: describe it here, read it in `scene/check`, and add a scene that uses it.

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
use super::{Bound, Collection, Key, Kind, Rule, TableSpec};
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

/// A whole scene.
pub static SCENE: TableSpec = TableSpec {
    noun: "a scene",
    rule: Rule::Any,
    keys: &[
        Key::new("title", Text, "What the scene shows; it stands at the head of every script")
            .default("none")
            .also(&["name"]),
        Key::new(
            "include",
            List { of: &Text, min: 0, max: usize::MAX },
            "Scene files that belong to this one, as if they stood here; what this file says itself counts",
        )
        .default_numbers(&[])
        .also(&["includes", "import"]),
        Key::new(
            "seed",
            Integer(0, 4_294_967_295),
            "The seed of the random numbers in formulas: another seed gives other numbers",
        )
        .default_number(0.0)
        .also(&["random_seed"]),
        Key::new("variables", Variables, "Numbers by name, for formulas").default("none").also(&[
            "variable",
            "vars",
            "constants",
            "parameters",
            "let",
        ]),
        Key::new("simulation", Table(&SIMULATION), "The duration, time step and method of the simulation"),
        Key::new("body", Named(&BODY), "The rigid bodies").also(&["bodies", "object"]),
        Key::new("force", Named(&FORCE), "The forces that are not a single body's own").also(&["forces"]),
        Key::new("joint", Named(&JOINT), "What holds bodies together").also(&[
            "joints",
            "constraint",
            "constraints",
        ]),
        Key::new("emitter", Named(&EMITTER), "What sends out particles, such as drops and sparks").also(&[
            "emitters",
            "particles",
            "particle",
            "particle_system",
        ]),
        Key::new("material", Named(&MATERIAL), "What bodies look like").also(&["materials", "texture"]),
        Key::new("camera", Table(&CAMERA), "From where the scene is seen"),
        Key::new(
            "view",
            Named(&CAMERA),
            "Cameras beside the main one, for `--view`; what a view does not say is as in `[camera]`",
        )
        .also(&["views", "cameras"]),
        Key::new("light", Named(&LIGHT), "The lights; without any, a warm lamp and a weak fill")
            .also(&["lights"]),
        Key::new(
            "defaults",
            Table(&DEFAULTS),
            "Defaults for missing keys of bodies, forces, materials and lights",
        )
        .also(&["default"]),
        Key::new(
            "environment",
            Either(&[Choice(presets), Table(&ENVIRONMENT)]),
            "Ground, sky, fog and the usual lights: a name is short for `environment.preset`",
        )
        .default("\"daylight\"")
        .also(&["world"]),
        labels::LABEL,
        labels::SCALE_BAR,
        labels::GRID,
        Key::new("povray", Table(&POVRAY), "What goes to POV-Ray as it is"),
        Key::new("output", Table(&OUTPUT), "The images that the scripts are meant for").also(&["render"]),
    ],
};

static DEFAULTS: TableSpec = TableSpec {
    noun: "the defaults",
    rule: Rule::Any,
    keys: &[
        Key::new("body", Partial(&BODY), "Of every `[body.NAME]`: what it says itself counts, key by key")
            .default("none")
            .also(&["bodies"]),
        Key::new("force", Partial(&FORCE), "Of every `[force.NAME]`").default("none").also(&["forces"]),
        Key::new("material", Partial(&MATERIAL), "Of every `[material.NAME]`")
            .default("none")
            .also(&["materials"]),
        Key::new("light", Partial(&LIGHT), "Of every `[light.NAME]`").default("none").also(&["lights"]),
    ],
};

static SIMULATION: TableSpec = TableSpec {
    noun: "the simulation",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "duration",
            NON_NEGATIVE,
            "The time of the last frame, to the nearest whole frame; the first is at 0",
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
        Key::new("frame_rate", POSITIVE, "Frames per second: frame k shows the time k / frame_rate")
            .unit("frames/s")
            .default_number(25.0)
            .also(&["fps", "rate"]),
        Key::new(
            "step",
            POSITIVE,
            "The longest timestep; the real one divides the time between frames evenly. Adaptive integrators choose their own, and take \
             `tolerance` in its place",
        )
        .unit("s")
        .default_fraction(1.0, 240.0)
        .also(&["dt", "timestep", "time_step", "delta"]),
        Key::new(
            "tolerance",
            POSITIVE,
            "The error that a step of an adaptive integrator may have: of `dop853`, by the size of places and velocities; of `gauss-radau`, the ε \
             of IAS15",
        )
        .default_number(1e-9)
        .also(&["tol", "rtol", "atol", "accuracy", "epsilon"]),
        Key::new("integrator", Choice(integrators), "The method that advances the world")
            .default_word(METHODS[0].name)
            .also(&["method", "solver"]),
        Key::new("gravity", VECTOR, "The acceleration of every body that can move")
            .unit("m/s²")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["g"]),
        Key::new(
            "contacts",
            Choice(contact_laws),
            "Bodies stop each other where they touch, and a ground that is not given lies at height 0; \
             `\"event-driven\"` finds the time of each impact, for few bodies; `\"time-stepping\"` solves all contacts of a step \
             together, for many",
        )
        .default("bodies pass through each other")
        .also(&["contact", "collisions", "collision", "collide", "collides"]),
    ],
};

static BODY: TableSpec = TableSpec {
    noun: "a body",
    rule: Rule::AtMostOne(&[&["mass", "density"], &["fixed", "motion"]]),
    keys: &[
        Key::new("shape", Table(&SHAPE), "Its form, centred at its location, with its axis along y")
            .required(),
        Key::new("mass", POSITIVE, "Its mass").unit("kg").default_number(1.0).also(&["m", "weight"]),
        Key::new("density", POSITIVE, "Its mass, as mass per volume of its shape")
            .unit("kg/m³")
            .default("from `mass`"),
        Key::new("charge", ANY, "Its electric charge, for the forces `coulomb` and `lorentz`")
            .unit("C")
            .default_number(0.0)
            .also(&["q", "electric_charge"]),
        Key::new("magnetic_moment", VECTOR, "Its magnetic moment in its own axes, for the force `dipoles`")
            .unit("A·m²")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["dipole_moment", "magnetization", "dipole"]),
        Key::new(
            "inertia",
            Numbers(3, Bound::Positive),
            "Its principal moments of inertia about its own x, y, z",
        )
        .unit("kg·m²")
        .default("that of a solid of its shape"),
        Key::new("location", VECTOR, "Its centre of mass at the start")
            .unit("m")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["position", "pos", "center", "translate", "origin"]),
        Key::new(
            "orientation",
            Either(&[VECTOR, Table(&ORIENTATION)]),
            "How it is turned at the start: a list of three angles is short for `orientation.euler`",
        )
        .unit("degrees")
        .default("not turned")
        .also(&["rotation", "rotate", "angle", "attitude"]),
        Key::new("motion", Table(&MOTION), "A motion that is given: the body follows it, whatever acts on it")
            .default("forces move it")
            .also(&["path", "trajectory", "animation", "keyframes", "kinematic"]),
        Key::new("velocity", VECTOR, "Its velocity at the start")
            .unit("m/s")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["v", "speed"]),
        Key::new("angular_velocity", VECTOR, "Its angular velocity at the start, in world axes")
            .unit("rad/s")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["spin", "omega"]),
        Key::new("start", ANY, "When it comes: before, it is not there. Its `location` and `velocity` are those of then, or of t = 0 if that is later")
            .unit("s")
            .default("it is there from the beginning")
            .also(&["birth", "born", "begin", "appears", "t0"]),
        Key::new("end", ANY, "When it goes: after, it is not there. Nothing acts on what is not there, nor comes from it")
            .unit("s")
            .default("it stays")
            .also(&["death", "dies", "until", "vanishes", "t1"]),
        Key::new("force", VECTOR, "A constant force at its centre, in world axes")
            .unit("N")
            .default_numbers(&[0.0, 0.0, 0.0]),
        Key::new("torque", VECTOR, "A constant torque, in world axes").unit("N·m").default_numbers(&[0.0, 0.0, 0.0]),
        Key::new("fixed", Boolean, "Whether it stays where it is, whatever acts on it; a plane always does")
            .default_flag(false)
            .also(&["static", "anchored"]),
        RESTITUTION.default("the other body's; with neither's, 0"),
        FRICTION.default("the other body's; with neither's, 0.5"),
        ROLLING_FRICTION.default("the other body's; with neither's, 0"),
        COLLIDES,
        COLLISION_GROUP,
        Key::new(
            "material",
            Either(&[Reference(Collection::Material), Table(&MATERIAL)]),
            "What it looks like: a `[material.NAME]`, or else a name of [the library](materials.md); or its keys, here",
        )
        .default("the next color of the palette, in the order of the file")
        .also(&["texture"]),
        Key::new("look", Table(&BODY_LOOK), "How it differs in pictures from what it is in mechanics"),
        Key::new(
            "repeat",
            Either(&[COUNT, Table(&REPEAT)]),
            "Many from one: a number of copies, or how they stand; their `location` is counted from where that puts them",
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
        // Wider than any use, and narrow enough for every drawn length to have a square.
        Key::new(
            "scale",
            Number(Bound::From(1e-9, 1e9)),
            "Draw it this many times its true size, about its centre of mass",
        )
        .default_number(1.0)
            .also(&["size", "magnification", "enlarge"]),
        Key::new(
            "sdl_before",
            Sdl(Where::Inside),
            "POV-Ray's own words at the end of its object, before the matrix that places it: they move with the body",
        )
        .default("none")
        .also(&["sdl", "pre_sdl"]),
        Key::new(
            "sdl_after",
            Sdl(Where::Inside),
            "POV-Ray's own words after that matrix: they stay where they are in the world",
        )
        .default("none")
        .also(&["post_sdl"]),
    ],
};

pub(super) static ORIENTATION: TableSpec = TableSpec {
    noun: "an orientation",
    rule: Rule::AtMostOne(&[&["euler", "axis", "quaternion"], &["euler", "angle", "quaternion"]]),
    keys: &[
        Key::new(
            "euler",
            VECTOR,
            "Turned about the world's x, then y, then z, as POV-Ray's `rotate <x, y, z>` does",
        )
        .unit("degrees")
        .default_numbers(&[0.0, 0.0, 0.0]),
        Key::new("axis", AXIS, "The axis that it is turned about; goes with `angle`").default("none"),
        Key::new("angle", ANY, "By how much it is turned about `axis`, by the right-hand rule")
            .unit("degrees")
            .default("none"),
        Key::new("quaternion", Direction(4), "A quaternion [x, y, z, w]; its length does not matter")
            .default_numbers(&[0.0, 0.0, 0.0, 1.0]),
    ],
};

static MATERIAL: TableSpec = TableSpec {
    noun: "a material",
    rule: Rule::AtMostOne(&[&["color", "texture", "sdl"], &["finish", "like", "texture", "sdl"]]),
    keys: &[
        Key::new(
            "color",
            Color,
            "Its color: [red, green, blue] in sRGB from 0 to 1, \"#rrggbb\", \"#rgb\", or a name of CSS",
        )
        .default("white, or that of what it is `like`")
        .also(&["colour", "rgb", "pigment", "diffuse"]),
        Key::new("like", Choice(library), "A material of [the library](materials.md), which `color` tints")
            .default("from `color` and `finish`")
            .also(&["base", "kind", "extends"]),
        Key::new("finish", Choice(finishes), "How its surface throws light back").default_word("glossy"),
        Key::new("texture", Identifier, "A texture that an include file declares, by its name")
            .default("from `color` and `finish`"),
        Key::new(
            "sdl",
            Sdl(Where::Inside),
            "POV-Ray's own words, to stand inside an object: `texture { … }`, `interior { … }`",
        )
        .default("from `color` and `finish`"),
    ],
};

fn layouts() -> Vec<&'static str> {
    Layout::ALL.iter().map(|layout| layout.name()).collect()
}

static ENVIRONMENT: TableSpec = TableSpec {
    noun: "the environment",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "preset",
            Choice(presets),
            "Sky, ground, usual lights and ambient light that go together; each can be replaced",
        )
        .default("\"daylight\""),
        Key::new("ground", Either(&[Boolean, Table(&GROUND)]), "The checkered ground")
            .default("true, and false in space and where a body is a plane")
            .also(&["floor"]),
        Key::new(
            "sky",
            Either(&[Boolean, Color]),
            "The sky: that of the preset, a plain color, or none (black)",
        )
        .default_flag(true)
        .also(&["background"]),
        Key::new("fog", Boolean, "Haze in which the ground fades towards the horizon")
            .default_flag(true)
            .also(&["haze"]),
    ],
};

static GROUND: TableSpec = TableSpec {
    noun: "the ground",
    rule: Rule::Any,
    keys: &[
        Key::new("height", ANY, "Its height")
            .unit("m")
            .default("just under the lowest point of the motion; with `simulation.contacts`, 0")
            .also(&["y", "level"]),
        Key::new("tile", POSITIVE, "The edge of one tile")
            .unit("m")
            .default("the `spacing` of a grid on it; else 1, 2 or 5 times a power of ten, after the size of the motion"),
        RESTITUTION.default("that of the body on it; with neither's, 0"),
        FRICTION.default("that of the body on it; with neither's, 0.5"),
        ROLLING_FRICTION.default("that of the body on it; with neither's, 0"),
    ],
};

static POVRAY: TableSpec = TableSpec {
    noun: "the part for POV-Ray",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "include",
            List { of: &Include, min: 0, max: usize::MAX },
            "Include files: POV-Ray's own, or files beside the scene, which go into the scripts",
        )
        .default_numbers(&[])
        .also(&["includes"]),
        Key::new(
            "assets",
            List { of: &Asset, min: 0, max: usize::MAX },
            "Files beside the scene that POV-Ray's own words read, as images, height fields and fonts; copies of \
             them stand in the folder `assets` beside the scripts, and the words call them as this list does",
        )
        .default_numbers(&[])
        .also(&["files", "images", "textures", "maps"]),
        Key::new("sdl", Sdl(Where::Top), "POV-Ray's own words, to stand in every script before the bodies")
            .default("none"),
        Key::new(
            "templates",
            Text,
            "A folder with templates of your own, which take the place of those built in; needs `--trust`",
        )
        .default("those built in"),
        Key::new("unit", POSITIVE, "The length of one unit of POV-Ray's")
            .unit("m")
            .default("1, and a power of ten for scenes that POV-Ray finds too small or too large"),
        Key::new("digits", Integer(4, 17), "Significant digits of the numbers in scripts").default_number(9.0),
    ],
};

static OUTPUT: TableSpec = TableSpec {
    noun: "the output",
    rule: Rule::Any,
    keys: &[
        Key::new("size", List { of: &Integer(1, 65535), min: 2, max: 2 }, "Width and height of the images")
            .unit("pixels")
            .default_numbers(&[1280.0, 720.0])
            .also(&["resolution", "width", "height"]),
        Key::new(
            "layout",
            Choice(layouts),
            "Whether every script is complete, or what all share stands in `common.inc`",
        )
        .default_word("self-contained"),
        Key::new(
            "transparent",
            Boolean,
            "Whether the images have no background: no sky and no ground, but transparency (alpha)",
        )
        .default_flag(false)
        .also(&["alpha"]),
        Key::new(
            "video_rate",
            Number(Bound::From(0.01, 1000.0)),
            "Frames per second of the film: below `frame_rate` it is in slow motion, above it in time lapse",
        )
        .unit("frames/s")
        .default("`simulation.frame_rate`, or 25 where that is not from 1 to 120")
        .also(&["film_rate", "playback_rate", "fps"]),
    ],
};
