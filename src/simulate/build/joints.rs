//! Makes the constraints of a world from the joints of a scene.

use std::sync::Arc;

use crate::physics::Constraint;
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
