//! Features that users look for and that jabuka lacks or offers in another way.

use crate::scene::grammar::{SCENE, TableSpec};

/// A feature that users look for under a key which jabuka does not have.
pub(in crate::scene::check) struct NotBuilt {
    /// The noun of the table in which users look for the missing feature, such as `a body`.
    of: &'static str,
    /// The keys of the feature in other programs.
    words: &'static [&'static str],
    /// The help text of the diagnostic: what jabuka offers instead.
    pub(super) help: &'static str,
    /// The key that the feature will have in the table or at the top level. Empty if no key is planned.
    pub(super) comes_with: &'static str,
    /// Whether the suggested fix removes the line with the unknown key.
    pub(super) is_removable: bool,
}

/// Returns the missing feature that has this key in other programs. `None` if jabuka has the feature, or if the key is not in the list.
pub(in crate::scene::check) fn not_built(word: &str, spec: &TableSpec) -> Option<&'static NotBuilt> {
    let folded = word.to_lowercase();
    let is_it = |thing: &&NotBuilt| thing.of == spec.noun && thing.words.contains(&folded.as_str());
    let is_built = |key: &str| !key.is_empty() && (spec.key(key).is_some() || SCENE.key(key).is_some());
    NOT_BUILT.iter().find(is_it).filter(|thing| !is_built(thing.comes_with))
}

/// Returns whether `word` is a planned value of `key` that this version does not support yet.
pub(in crate::scene::check) fn is_word_to_come(key: &str, word: &str) -> bool {
    key == "contacts" && word == "time-stepping"
}

/// The names of a playback speed in other programs.
const SLOW_MOTION: &[&str] = &[
    "slow_motion",
    "slowmo",
    "slow_mo",
    "slowmotion",
    "slowdown",
    "playback_speed",
    "time_scale",
    "timescale",
];
/// The help text for the words of [`SLOW_MOTION`].
const SLOW_MOTION_HELP: &str = "`speed = 0.25` in [output] shows everything at a quarter of its speed, and `speed = [[0, 1], [2, 0.1], [3, 1]]` slows \
     down around t = 2 s";

static NOT_BUILT: &[NotBuilt] = &[
    NotBuilt {
        of: "a body",
        words: &["start", "end", "lifetime", "birth", "death", "appears", "spawn"],
        help: "bodies are there from the first frame to the last; leave the line out",
        comes_with: "start",
        is_removable: true,
    },
    NotBuilt {
        of: "a joint",
        words: &["universal", "cylindrical", "screw", "spring", "motor", "belt"],
        help: "there are `ball`, `hinge`, `slider`, `fixed`, `rod`, `rope`, `pulley` and `gear`; springs are forces, \
               `[force.NAME.spring]`, and a motor is a key of a hinge or a slider",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "a hinge",
        words: &["damping", "friction"],
        help: "a joint has no friction of its own; `motor = { speed = 0, torque = 2 }` holds it with 2 N·m",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "a hinge",
        words: &["spring"],
        help: "a spring at a hinge is a motor that gives way: `motor = { angle = 0, stiffness = 10, damping = 1 }`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "a slider",
        words: &["spring"],
        help: "a spring at a slider is a motor that gives way: `motor = { position = 0, stiffness = 10, damping = 1 }`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "a slider",
        words: &["damping", "friction"],
        help: "a joint has no friction of its own; `motor = { speed = 0, force = 2 }` holds it with 2 N",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "a scene",
        words: &["emitter", "emitters", "particles", "particle_system", "fountain"],
        help: "there are no emitters yet: `repeat` in a body makes many of it, all there from the start",
        comes_with: "emitter",
        is_removable: false,
    },
    NotBuilt {
        of: "a scene",
        words: &["contact", "contacts", "collision", "collisions"],
        help: "it is a key of [simulation]: `contacts = \"event-driven\"`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "the simulation",
        words: &["seed", "random_seed", "rng_seed"],
        help: "it is a key of the scene: write `seed = 1` above the first table",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "a force",
        words: &["morse", "yukawa", "magnus"],
        help: "this force is not built yet; there are `constant`, `drag`, `spring`, `gravitation`, `coulomb`, \
               `lorentz`, `lennard_jones`, `buoyancy`, `dipoles`, `j2` and `formula`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "a scene",
        words: &["units", "unit", "unit_system"],
        help: "all numbers are in SI units: metres, kilograms, seconds; leave the line out",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "a body",
        words: &["emissive", "emission", "glow", "glowing", "luminous", "emits"],
        help: "write `material.glow = 1`, or `material = \"sun\"`; `[light.NAME]` with `point.location` lights other \
               bodies; leave the line out",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "a body",
        words: &["opacity", "alpha", "transparency", "transparent"],
        help: "write `material.transparency = 0.5`, or `material = \"glass\"`; leave the line out",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "a body",
        words: &["air_resistance", "air_drag", "drag", "air", "damping", "linear_damping"],
        help: "the resistance of air is a force: `[force.air.drag]` with `linear` or `quadratic`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "the simulation",
        words: &["air_resistance", "air_drag", "drag", "air", "damping", "linear_damping"],
        help: "the resistance of air is a force: `[force.air.drag]` with `linear` or `quadratic`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "the environment",
        words: &["air_resistance", "air_drag", "drag", "air", "damping", "linear_damping"],
        help: "the resistance of air is a force: `[force.air.drag]` with `linear` or `quadratic`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "the camera",
        words: &["zoom"],
        help: "a smaller `angle` shows things larger: it is 40 degrees without it; leave the line out",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "the camera",
        words: &["right", "direction"],
        help: "`location`, `look_at`, `up` and `roll` place the camera; leave the line out",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "the output",
        words: &["video", "film", "file", "filename", "format", "fps_video"],
        help: "`jabuka render SCENE --video FILE.mp4` makes a film; leave the line out",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "a scene",
        words: SLOW_MOTION,
        help: SLOW_MOTION_HELP,
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "the simulation",
        words: SLOW_MOTION,
        help: SLOW_MOTION_HELP,
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "the output",
        words: SLOW_MOTION,
        help: SLOW_MOTION_HELP,
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "the output",
        words: &["quality", "antialias", "antialiasing"],
        help: "`jabuka render` takes `--quality`; leave the line out",
        comes_with: "",
        is_removable: true,
    },
    NotBuilt {
        of: "a body",
        words: &["pivot", "hinge", "joint", "attached_to", "parent", "constraint"],
        help: "what holds a body is a table of its own: `[joint.NAME.hinge]`, `ball`, `slider`, `rod`, `rope` or `fixed`",
        comes_with: "",
        is_removable: false,
    },
    NotBuilt {
        of: "a scene",
        words: &["rope", "string", "cable", "motor", "gear", "pulley"],
        help: "it is a joint: `[joint.NAME.rope]`, `pulley`, `gear`, or the key `motor` of a hinge; a soft spring is \
               a force, `[force.NAME.spring]`",
        comes_with: "",
        is_removable: false,
    },
];
