//! The grammar of the whole scene, and of the tables that have no file of their own.
//!
//! To add a key, describe it in the file of its table, read it in `scene/check`, and add a scene that uses it.

use super::Kind::{
    Asset, Boolean, Choice, Color, Either, Include, Integer, List, Named, Number, Numbers, Partial, Sdl,
    Table, Text, Variables,
};
use super::bodies;
use super::camera;
use super::contact::{FRICTION, RESTITUTION, ROLLING_FRICTION};
use super::emitters;
use super::forces;
use super::joints;
use super::key::table;
use super::kind::{ANY, NON_NEGATIVE, POSITIVE, VECTOR};
use super::labels;
use super::lights;
use super::marks;
use super::materials;
use super::{Bound, KeySpec, Rule};
use crate::physics::Method;
use crate::scene::sdl::Where;
use crate::scene::{ContactLaw, DecimalSign, Layout, Preset};

fn integrators() -> Vec<&'static str> {
    Method::all().map(|method| method.name).collect()
}

fn contact_laws() -> Vec<&'static str> {
    ContactLaw::ALL.iter().map(|law| law.name()).collect()
}

fn presets() -> Vec<&'static str> {
    Preset::ALL.iter().map(|preset| preset.name()).collect()
}

/// The smallest speed of a film, `output.speed`. Frames are then still much farther apart than rounding errors of times.
pub(in crate::scene) const SLOWEST_FILM: f64 = 1e-4;
/// The largest speed of a film.
pub(in crate::scene) const FASTEST_FILM: f64 = 1e6;

table! {
    /// The grammar of a whole scene. All other tables are reached from it.
    scene: "a scene", Rule::Any;
    TITLE: Option<value::Text> = KeySpec::new("title", Text, "The title of the scene, at the head of every script")
        .default("none")
        .also(&["name"]),
    INCLUDE: Any = KeySpec::new(
        "include",
        List { of: &Text, min: 0, max: usize::MAX },
        "Scene files to read first; this file's values override theirs",
    )
    .default_numbers(&[])
    .also(&["includes", "import"]),
    SEED: u32 = KeySpec::new("seed", Integer(0, 4_294_967_295), "The seed of the random numbers in formulas")
        .default_number(0.0)
        .also(&["random_seed"]),
    VARIABLES: Any = KeySpec::new("variables", Variables(&variable::TABLE), "Named numbers for formulas; one with `min` and `max` has a slider on the page of the preview").default("none").also(&[
        "variable",
        "vars",
        "constants",
        "parameters",
        "let",
    ]),
    SIMULATION: Any = KeySpec::new("simulation", Table(&simulation::TABLE), "The duration, timestep and method of the simulation"),
    BODY: Any = KeySpec::new("body", Named(&bodies::body::TABLE), "The rigid bodies").also(&["bodies", "object"]),
    FORCE: Any = KeySpec::new("force", Named(&forces::force::TABLE), "Forces on or between bodies").also(&["forces"]),
    JOINT: Any = KeySpec::new("joint", Named(&joints::joint::TABLE), "Joints between bodies").also(&[
        "joints",
        "constraint",
        "constraints",
    ]),
    EMITTER: Any = KeySpec::new("emitter", Named(&emitters::emitter::TABLE), "Sources of particles, such as drops and sparks").also(&[
        "emitters",
        "particles",
        "particle",
        "particle_system",
    ]),
    MATERIAL: Any = KeySpec::new("material", Named(&materials::material::TABLE), "The looks of bodies").also(&["materials", "texture"]),
    CAMERA: Any = KeySpec::new("camera", Table(&camera::camera::TABLE), "The main camera"),
    VIEW: Any = KeySpec::new(
        "view",
        Named(&camera::camera::TABLE),
        "Additional cameras, for `--view`; missing keys are as in `[camera]`",
    )
    .also(&["views", "cameras"]),
    LIGHT: Any = KeySpec::new("light", Named(&lights::light::TABLE), "The lights; without any, a warm lamp and a weak fill")
        .also(&["lights"]),
    DEFAULTS: Any = KeySpec::new(
        "defaults",
        Table(&defaults::TABLE),
        "Defaults for missing keys of bodies, forces, materials and lights",
    )
    .also(&["default"]),
    ENVIRONMENT: Any = KeySpec::new(
        "environment",
        Either(&[Choice(presets), Table(&environment::TABLE)]),
        "Ground, sky, fog and default lights: a name is short for `environment.preset`",
    )
    .default("\"daylight\"; \"space\" if a `gravitation` acts, without `simulation.gravity` and `simulation.contacts`")
    .also(&["world"]),
    LABEL: Any = labels::LABEL,
    PLOT: Any = labels::PLOT,
    ANGLE: Any = marks::ANGLE,
    DISTANCE: Any = marks::DISTANCE,
    AREA: Any = marks::AREA,
    FIELD: Any = marks::FIELD,
    SCALE_BAR: Any = labels::SCALE_BAR,
    GRID: Any = labels::GRID,
    POVRAY: Any = KeySpec::new("povray", Table(&povray::TABLE), "Passed to POV-Ray unchanged"),
    OUTPUT: Any = KeySpec::new("output", Table(&output::TABLE), "The images to render").also(&["render"]),
}

table! {
    variable: "a variable with a slider", Rule::Any;
    VALUE: Option<f64> = KeySpec::new("value", ANY, "Its value").required(),
    MIN: Option<f64> = KeySpec::new("min", ANY, "The lowest value of its slider").required().also(&["minimum", "from"]),
    MAX: Option<f64> = KeySpec::new("max", ANY, "The highest value of its slider").required().also(&["maximum", "to"]),
    STEP: Option<f64> = KeySpec::new("step", POSITIVE, "The distance between two values of its slider; with 1 from 0 to 1, the slider is a check box")
        .default("a hundredth of the range, or less"),
    UNIT: Option<value::Text> = KeySpec::new("unit", Text, "The unit that stands beside its value").default("none"),
    TITLE: Option<value::Text> = KeySpec::new("title", Text, "What stands beside its slider")
        .default("the name of the variable")
        .also(&["name", "label"]),
}

table! {
    defaults: "the defaults", Rule::Any;
    BODY: Any = KeySpec::new("body", Partial(&bodies::body::TABLE), "For every `[body.NAME]`; the body's own keys override them")
        .default("none")
        .also(&["bodies"]),
    FORCE: Any = KeySpec::new("force", Partial(&forces::force::TABLE), "For every `[force.NAME]`").default("none").also(&["forces"]),
    MATERIAL: Any = KeySpec::new("material", Partial(&materials::material::TABLE), "For every `[material.NAME]`")
        .default("none")
        .also(&["materials"]),
    LIGHT: Any = KeySpec::new("light", Partial(&lights::light::TABLE), "For every `[light.NAME]`").default("none").also(&["lights"]),
}

table! {
    simulation: "the simulation", Rule::Any;
    DURATION: f64 = KeySpec::new(
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
    FRAME_RATE: f64 = KeySpec::new("frame_rate", POSITIVE, "Frames per second: frame k shows the time k / frame_rate")
        .unit("frames/s")
        .default_number(25.0)
        .also(&["fps", "rate"]),
    STEP: f64 = KeySpec::new(
        "step",
        POSITIVE,
        "The longest timestep; the actual one divides the time between frames evenly. Adaptive \
         integrators choose their own and use `tolerance` instead",
    )
    .unit("s")
    .default_fraction(1.0, 240.0)
    .also(&["dt", "timestep", "time_step", "delta"]),
    TOLERANCE: f64 = KeySpec::new(
        "tolerance",
        POSITIVE,
        "The error per step of an adaptive integrator: for `dop853`, relative to the size of positions \
         and velocities; for `gauss-radau`, the ε of IAS15",
    )
    .default_number(1e-9)
    .also(&["tol", "rtol", "atol", "accuracy", "epsilon"]),
    INTEGRATOR: Option<value::Text> = KeySpec::new("integrator", Choice(integrators), "The integration method")
        .default("`velocity-verlet` with joints or event-driven contacts, else `euler-cromer`")
        .also(&["method", "solver"]),
    GRAVITY: DVec3 = KeySpec::new("gravity", VECTOR, "The acceleration of every movable body")
        .unit("m/s²")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["g"]),
    CONTACTS: Option<value::Text> = KeySpec::new(
        "contacts",
        Choice(contact_laws),
        "Makes bodies collide, with each other and with the ground, by default at height 0; \
         `\"event-driven\"` finds the time of each impact, for few bodies; `\"time-stepping\"` solves \
         all contacts of a timestep together, for many",
    )
    .default("bodies pass through each other")
    .also(&["contact", "collisions", "collision", "collide", "collides"]),
}

fn decimal_signs() -> Vec<&'static str> {
    DecimalSign::ALL.iter().map(|sign| sign.name()).collect()
}

fn layouts() -> Vec<&'static str> {
    Layout::ALL.iter().map(|layout| layout.name()).collect()
}

table! {
    environment: "the environment", Rule::Any;
    PRESET: Option<value::Text> = KeySpec::new(
        "preset",
        Choice(presets),
        "A matching set of sky, ground, default lights and ambient light; each can be replaced",
    )
    .default("\"daylight\"; \"space\" if a `gravitation` acts, without `[environment]`, `simulation.gravity` and `simulation.contacts`"),
    GROUND: Any = KeySpec::new("ground", Either(&[Boolean, Table(&ground::TABLE)]), "The checkered ground")
        .default("true; false in space, or if a body is a plane")
        .also(&["floor"]),
    SKY: Any = KeySpec::new(
        "sky",
        Either(&[Boolean, Color]),
        "The sky: that of the preset, a plain color, or none (black)",
    )
    .default_flag(true)
    .also(&["background"]),
    FOG: bool = KeySpec::new("fog", Boolean, "Haze into which the ground fades towards the horizon")
        .default_flag(true)
        .also(&["haze"]),
}

table! {
    ground: "the ground", Rule::Any;
    HEIGHT: Option<f64> = KeySpec::new("height", ANY, "Its height")
        .unit("m")
        .default("just under the lowest point of the motion; with `simulation.contacts`, 0")
        .also(&["y", "level"]),
    TILE: Option<f64> = KeySpec::new("tile", POSITIVE, "The edge of one tile").unit("m").default(
        "the `spacing` of a grid on it; else 1, 2 or 5 times a power of ten, by the size of the motion",
    ),
    RESTITUTION: Option<f64> = super::RESTITUTION.default("0"),
    FRICTION: Option<f64> = super::FRICTION.default("that of the body on it; 0.5 if neither has one"),
    ROLLING_FRICTION: Option<f64> = super::ROLLING_FRICTION.default("0"),
}

table! {
    povray: "the part for POV-Ray", Rule::Any;
    INCLUDE: Any = KeySpec::new(
        "include",
        List { of: &Include, min: 0, max: usize::MAX },
        "Include files: POV-Ray's own, or files beside the scene, which are copied into the scripts",
    )
    .default_numbers(&[])
    .also(&["includes"]),
    ASSETS: Any = KeySpec::new(
        "assets",
        List { of: &Asset, min: 0, max: usize::MAX },
        "Files beside the scene that SDL reads, such as images, height fields and fonts; they are \
         copied to the folder `assets` beside the scripts. SDL refers to them by the names in this list",
    )
    .default_numbers(&[])
    .also(&["files", "images", "textures", "maps"]),
    SDL: Option<value::Text> = KeySpec::new("sdl", Sdl(Where::Top), "SDL for every script, before the bodies").default("none"),
    TEMPLATES: Option<value::Text> = KeySpec::new(
        "templates",
        Text,
        "A folder with templates that replace those built in; needs `--trust`",
    )
    .default("those built in"),
    UNIT: Option<f64> = KeySpec::new("unit", POSITIVE, "The length of one POV-Ray unit")
        .unit("m")
        .default("1; a power of ten for scenes too small or too large for POV-Ray"),
    DIGITS: u32 = KeySpec::new("digits", Integer(4, 17), "Significant digits of the numbers in scripts")
        .default_number(9.0),
}

table! {
    output: "the output", Rule::Any;
    SIZE: Vec<i64> = KeySpec::new(
        "size",
        List { of: &Integer(1, 65535), min: 2, max: 2 },
        "Width and height of the images",
    )
    .unit("pixels")
    .default_numbers(&[1280.0, 720.0])
    .also(&["resolution", "width", "height"]),
    LAYOUT: value::Text = KeySpec::new(
        "layout",
        Choice(layouts),
        "Whether every script is complete; else shared parts are in `common.inc`",
    )
    .default_word("self-contained"),
    TRANSPARENT: bool = KeySpec::new(
        "transparent",
        Boolean,
        "Whether the background is transparent (alpha), without sky and ground",
    )
    .default_flag(false)
    .also(&["alpha"]),
    VIDEO_RATE: Option<f64> = KeySpec::new(
        "video_rate",
        Number(Bound::From(0.01, 1000.0)),
        "Frames per second of the film: slow motion below `frame_rate`, time lapse above it",
    )
    .unit("frames/s")
    .default("`simulation.frame_rate`, or 25 if that is not from 1 to 120")
    .also(&["film_rate", "playback_rate", "fps"]),
    SPEED: Any = KeySpec::new(
        "speed",
        Either(&[
            Number(Bound::From(SLOWEST_FILM, FASTEST_FILM)),
            List { of: &Numbers(2, Bound::NonNegative), min: 1, max: 10_000 },
        ]),
        "The speed of the film: 0.1 is slow motion by a factor of 10. A list of [time, speed] slows down around an \
         event: between two times of the simulation, the speed changes evenly",
    )
    .default("1")
    .also(&["speeds", "tempo"]),
    DECIMAL: value::Text = KeySpec::new(
        "decimal",
        Choice(decimal_signs),
        "The sign before the decimals of numbers in pictures. Tables always have points",
    )
    .default_word(".")
    .also(&["decimal_sign", "decimal_separator", "comma", "decimal_comma", "locale"]),
}
