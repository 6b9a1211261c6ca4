//! The grammar of the keys for collisions. They take effect only if `simulation.contacts` is set.

use super::Kind::{Boolean, Number, Text};
use super::kind::NON_NEGATIVE;
use super::{Bound, KeySpec};

pub(super) const RESTITUTION: KeySpec = KeySpec::new(
    "restitution",
    Number(Bound::From(0.0, 1.0)),
    "The ratio of the rebound speed to the approach speed: 0 for no bounce, 1 for no loss. Of the two \
     bodies' values, the larger counts",
)
.also(&["bounciness", "bounce", "elasticity", "e", "cor", "coefficient_of_restitution"]);

pub(super) const FRICTION: KeySpec = KeySpec::new(
    "friction",
    NON_NEGATIVE,
    "The coefficient of friction (Coulomb). Of the two bodies' values, the geometric mean counts",
)
.also(&["mu", "static_friction", "dynamic_friction", "kinetic_friction", "friction_coefficient"]);

pub(super) const ROLLING_FRICTION: KeySpec = KeySpec::new(
    "rolling_friction",
    NON_NEGATIVE,
    "The ratio of the largest rolling resistance torque to the normal force. Of the two bodies' values, the larger counts",
)
.unit("m")
.also(&["rolling_resistance"]);

pub(super) const COLLIDES: KeySpec =
    KeySpec::new("collides", Boolean, "Whether it collides with other bodies")
        .default("true; false for `axes`")
        .also(&["collision", "collisions", "collide", "collider", "contact", "contacts", "solid"]);

pub(super) const COLLISION_GROUP: KeySpec = KeySpec::new(
    "collision_group",
    Text,
    "Any name; bodies of the same group do not collide with each other",
)
.default("none")
.also(&["group", "collision_layer", "layer"]);

pub(super) const JOINT_COLLIDES: KeySpec = KeySpec::new(
    "collides",
    Boolean,
    "Whether the two joined bodies can collide with each other; needs `simulation.contacts`",
)
.default_flag(false)
.also(&["collision", "collisions", "collide", "contact", "contacts"]);
