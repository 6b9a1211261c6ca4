//! The keys that only draw. They must not change the digest, so that a change of a color needs no new simulation.
//!
//! Some keys that draw are not in these lists, because they also change the shape of a body or the recording. `smooth` of a mesh is part of
//! its shape. Ghosts and shutters add times at which the run is recorded. A drawn contact force needs recorded contacts.

/// The tables whose keys all only draw, by their nouns. Emitters are among them, since particles move no body.
pub(super) const TABLES_THAT_DRAW: &[&str] = &[
    "a body's axes",
    "a body's look",
    "a box of emission",
    "a camera's `follow`",
    "a camera's keyframe",
    "a camera's keyframes",
    "a coil",
    "a disc",
    "a joint's arrows",
    "a label",
    "a light",
    "a material",
    "a plot",
    "a point light",
    "a sun",
    "a trail",
    "an area light",
    "an arrow",
    "an emitter",
    "an orbit",
    "the ball of a particle",
    "the grid",
    "the look of a joint",
    "the origin of particles",
    "the output",
    "the part for POV-Ray",
    "the scale bar",
    "the shape of a particle",
];

/// The keys that only draw, by the nouns of their tables. These tables also have keys that act on the run.
pub(super) const KEYS_THAT_DRAW: &[(&str, &[&str])] = &[
    ("a ball joint", &["look", "arrows"]),
    ("a body", &["material", "look", "axes", "trail"]),
    ("a body's arrows", &["velocity", "acceleration", "force", "weight"]),
    ("a fixed joint", &["look", "arrows"]),
    ("a gear", &["arrows"]),
    ("a hinge", &["look", "arrows"]),
    ("a pulley", &["look", "arrows"]),
    ("a rod", &["look", "arrows"]),
    ("a rope", &["look", "arrows"]),
    (
        "a scene",
        &["title", "emitter", "material", "light", "label", "plot", "scale_bar", "grid", "povray", "output"],
    ),
    ("a shape in SDL", &["object"]),
    ("a slider", &["look", "arrows"]),
    ("a spring", &["line", "coil"]),
    ("ghosts", &["arrows"]),
    (
        "the camera",
        &[
            "location",
            "look_at",
            "keyframes",
            "follow",
            "orbit",
            "angle",
            "projection",
            "width",
            "aperture",
            "focus",
            "blur_samples",
        ],
    ),
    ("the defaults", &["material", "light"]),
    ("the environment", &["sky", "fog"]),
    ("the ground", &["tile"]),
];
