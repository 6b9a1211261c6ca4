//! Sets the initial velocity of bodies that turn about a fixed point.

use glam::DVec3;

use crate::dynamics::Anchor;
use crate::scene::check::end;
use crate::scene::{Body, Joint, JointKind};

/// Gives a body with an angular velocity and no velocity the velocity ω × r about its joint, if a hinge or a ball
/// joint fastens it to something fixed.
pub(in crate::scene::check) fn swing(joints: &[Joint], bodies: &mut [Body]) {
    for joint in joints {
        let between = match &joint.kind {
            JointKind::Ball(ball) => ball.between,
            JointKind::Hinge(hinge) => hinge.between,
            _ => continue,
        };
        for [held, other] in [between, [between[1], between[0]]] {
            let stands_still = match other {
                Anchor::Point(_) => true,
                Anchor::Body { id, .. } => bodies[id.index()].start.fixed,
            };
            let Some(id) = held.body().filter(|_| stands_still) else { continue };
            let point = end::place(held, bodies);
            let body = &mut bodies[id.index()];
            let is_free = !body.start.fixed && body.motion.is_none();
            if is_free && body.start.velocity == DVec3::ZERO {
                body.start.velocity = body.start.angular_velocity.cross(body.start.location - point);
            }
        }
    }
}
