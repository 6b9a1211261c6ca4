//! Makes the constraints of a world, and the links of the time-stepping engine, from the joints of a scene.

use std::sync::Arc;

use crate::physics::Constraint;
#[cfg(feature = "time-stepping")]
use crate::physics::{Link, LinkKind};
#[cfg(feature = "time-stepping")]
use crate::scene::Joint;
use crate::scene::JointKind;

/// Returns a joint of a scene as a constraint of a world.
pub(super) fn constraint(kind: &JointKind) -> Arc<dyn Constraint> {
    match kind {
        JointKind::Ball(ball) => Arc::new(*ball),
        JointKind::Hinge(hinge) => Arc::new(hinge.clone()),
        JointKind::Slider(slider) => Arc::new(slider.clone()),
        JointKind::Fixed(fixed) => Arc::new(*fixed),
        JointKind::Rod(rod) => Arc::new(*rod),
        JointKind::Rope(rope) => Arc::new(*rope),
        JointKind::Pulley(pulley) => Arc::new(pulley.clone()),
        JointKind::Gear(gear) => Arc::new(*gear),
    }
}

/// Converts a joint into a link of the time-stepping engine. `None` for pulleys and gears, which the scene's check refuses with this
/// engine.
#[cfg(feature = "time-stepping")]
pub(super) fn link(joint: &Joint) -> Option<Link> {
    let kind = match &joint.kind {
        JointKind::Ball(ball) => LinkKind::Ball(*ball),
        JointKind::Hinge(hinge) => LinkKind::Hinge(hinge.clone()),
        JointKind::Slider(slider) => LinkKind::Slider(slider.clone()),
        JointKind::Fixed(fixed) => LinkKind::Fixed(*fixed),
        JointKind::Rod(rod) => LinkKind::Rod(*rod),
        JointKind::Rope(rope) => LinkKind::Rope(*rope),
        JointKind::Pulley(_) | JointKind::Gear(_) => return None,
    };
    Some(Link { kind, collides: joint.collides })
}
