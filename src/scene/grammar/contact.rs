//! The keys that say how bodies collide. All of them need `simulation.contacts`.

use super::Kind::{Boolean, Number, Text};
use super::keys::NON_NEGATIVE;
use super::{Bound, Key};

pub(super) const RESTITUTION: Key = Key::new(
    "restitution",
    Number(Bound::From(0.0, 1.0)),
    "The speed of a rebound by that of the approach: 0 does not bounce, 1 loses nothing. Of two values the larger counts",
)
.also(&["bounciness", "bounce", "elasticity", "cor", "coefficient_of_restitution"]);

pub(super) const FRICTION: Key = Key::new(
    "friction",
    NON_NEGATIVE,
    "Coulomb's coefficient: the largest friction by the normal force. Of two values the geometric mean counts",
)
.also(&["mu", "static_friction", "dynamic_friction", "kinetic_friction", "friction_coefficient"]);

pub(super) const ROLLING_FRICTION: Key = Key::new(
    "rolling_friction",
    NON_NEGATIVE,
    "The largest torque against rolling by the normal force. Of two values the larger counts",
)
.unit("m")
.also(&["rolling_resistance"]);

pub(super) const COLLIDES: Key =
    Key::new("collides", Boolean, "Whether it stops other bodies and is stopped by them")
        .default("true; axes do not")
        .also(&["collision", "collisions", "collide", "collider", "contact", "contacts", "solid"]);

pub(super) const COLLISION_GROUP: Key =
    Key::new("collision_group", Text, "A name of your choice; bodies of one group pass through each other")
        .default("none")
        .also(&["group", "collision_layer", "layer"]);

pub(super) const JOINT_COLLIDES: Key = Key::new(
    "collides",
    Boolean,
    "Whether the two bodies that it joins can collide with each other; needs `simulation.contacts`",
)
.default_flag(false)
.also(&["collision", "collisions", "collide", "contact", "contacts"]);
