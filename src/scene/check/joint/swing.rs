//! Sets the initial velocity of bodies that rotate about a fixed joint.

use glam::DVec3;

use crate::physics::Anchor;
use crate::scene::check::end;
use crate::scene::{Body, Joint, JointKind};

/// Sets the initial velocity of each body that has zero velocity and is connected by a hinge or a ball joint to a fixed body or point. The
/// velocity is ω × r, where ω is the body's angular velocity, and r points from the joint to the body's location.
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
