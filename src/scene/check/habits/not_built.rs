//! What people look for, and what jabuka does not do yet.

use crate::scene::grammar::TableSpec;

/// Something that is not built yet.
pub(in crate::scene::check) struct NotBuilt {
    /// The table that it is looked for in, by the noun of its description.
    of: &'static str,
    /// What it is called.
    words: &'static [&'static str],
    /// What holds today, and what to write instead.
    pub(super) help: &'static str,
    /// Whether the scene is right without the line.
    pub(super) can_go: bool,
}

/// What such a key stands for; none where the language has it.
pub(in crate::scene::check) fn not_built(word: &str, spec: &TableSpec) -> Option<&'static NotBuilt> {
    let folded = word.to_lowercase();
    let is_it = |thing: &&NotBuilt| thing.of == spec.noun && thing.words.contains(&folded.as_str());
    if spec.key(word).is_some() { None } else { NOT_BUILT.iter().find(is_it) }
}

static NOT_BUILT: &[NotBuilt] = &[
    NotBuilt {
        of: "a body",
        words: &[
            "restitution",
            "bounciness",
            "bounce",
            "elasticity",
            "friction",
            "rolling_friction",
            "static_friction",
            "collision",
            "collider",
            "collides",
            "collision_group",
            "contact",
            "contacts",
        ],
        help: "bodies do not touch each other yet: nothing bounces or rubs; leave the line out",
        can_go: true,
    },
    NotBuilt {
        of: "a body",
        words: &["start", "end", "lifetime", "birth", "death", "appears", "spawn"],
        help: "bodies are there from the first frame to the last; leave the line out",
        can_go: true,
    },
    NotBuilt {
        of: "the simulation",
        words: &["contacts", "contact", "collisions", "collision", "collide"],
        help: "bodies do not touch each other yet: nothing bounces or rubs; leave the line out",
        can_go: true,
    },
    NotBuilt {
        of: "the simulation",
        words: &["tolerance", "tol", "rtol", "atol", "adaptive"],
        help: "no integrator chooses its own steps yet: `step` is the longest one; leave the line out",
        can_go: true,
    },
    NotBuilt {
        of: "a joint",
        words: &[
            "rope",
            "string",
            "cable",
            "gear",
            "gears",
            "pulley",
            "universal",
            "cylindrical",
            "screw",
            "spring",
            "motor",
        ],
        help: "there are `ball`, `hinge`, `slider`, `fixed` and `rod`; springs are forces, `[force.NAME.spring]`",
        can_go: false,
    },
    NotBuilt {
        of: "a hinge",
        words: &["limits", "limit", "motor", "damping", "friction", "stiffness"],
        help: "joints move freely yet, without limits and motors; leave the line out",
        can_go: true,
    },
    NotBuilt {
        of: "a slider",
        words: &["limits", "limit", "motor", "damping", "friction", "stiffness"],
        help: "joints move freely yet, without limits and motors; leave the line out",
        can_go: true,
    },
    NotBuilt {
        of: "a scene",
        words: &["emitter", "emitters", "particles", "particle_system", "fountain"],
        help: "there are no emitters yet: `repeat` in a body makes many of it, all there from the start",
        can_go: false,
    },
    NotBuilt {
        of: "a scene",
        words: &["plot", "plots", "graph", "graphs", "chart", "diagram"],
        help: "there are no plots in pictures yet: `[label.NAME]` shows numbers, `jabuka preview` has plots, \
               and `jabuka export` writes tables",
        can_go: false,
    },
    NotBuilt {
        of: "a scene",
        words: &["contact", "contacts", "collision", "collisions"],
        help: "bodies do not touch each other yet: nothing bounces or rubs; leave it out",
        can_go: false,
    },
    NotBuilt {
        of: "a force",
        words: &["formula", "custom", "expression", "central", "potential", "field_formula"],
        help: "forces by formulas are not built yet; there are `constant`, `drag`, `spring`, `gravitation`, \
               `coulomb` and `lorentz`",
        can_go: false,
    },
    NotBuilt {
        of: "a force",
        words: &[
            "lennard_jones",
            "lennard-jones",
            "lj",
            "van_der_waals",
            "morse",
            "yukawa",
            "buoyancy",
            "magnus",
        ],
        help: "this force is not built yet; there are `constant`, `drag`, `spring`, `gravitation`, `coulomb` \
               and `lorentz`",
        can_go: false,
    },
    NotBuilt {
        of: "a spring",
        words: &["line", "style"],
        help: "a spring is drawn as a coil, or not at all with `coil = false`; leave the line out",
        can_go: true,
    },
    NotBuilt {
        of: "a trail",
        words: &["at", "point", "offset"],
        help: "a trail is that of the centre of mass; leave the line out",
        can_go: true,
    },
];
