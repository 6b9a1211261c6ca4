//! Finds bodies whose initial velocity is changed by joints.

use glam::DVec3;

use super::super::Frame;
use crate::dynamics::BodySnapshot;
use crate::scene::Scene;

/// The first body whose initial velocity differs from the scene's, because the given velocity contradicts its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Corrected {
    /// The name of the body.
    pub body: String,
    /// The initial velocity that the joints allow, m/s.
    pub velocity: DVec3,
    /// The initial angular velocity that the joints allow, rad/s.
    pub angular_velocity: DVec3,
    /// The number of other bodies with a changed initial velocity.
    pub others: usize,
}

impl Corrected {
    /// Compares the velocities in the first frame with the scene. `None` if the joints changed no velocity.
    pub(super) fn find(scene: &Scene, frame: &Frame) -> Option<Corrected> {
        // The relative tolerance: rounding errors are far smaller, and larger changes may be visible.
        const NOTICEABLE: f64 = 1e-6;
        if scene.joints.is_empty() {
            return None;
        }
        let differs = |now: DVec3, given: DVec3| now.distance(given) > NOTICEABLE * given.length().max(1e-3);
        let is_other = |&&BodySnapshot { id, velocity, angular_velocity, .. }: &&BodySnapshot| {
            let body = &scene.bodies[id];
            let is_free = !body.start.fixed && body.motion.is_none();
            let start = &body.start;
            // A body without a given velocity may correctly start with the velocity of its guide or motor.
            let is_given = start.velocity != DVec3::ZERO || start.angular_velocity != DVec3::ZERO;
            is_free
                && is_given
                && (differs(velocity, start.velocity) || differs(angular_velocity, start.angular_velocity))
        };
        let mut others = frame.bodies.iter().filter(is_other);
        let first = others.next()?;
        Some(Corrected {
            body: scene.bodies[first.id].name.to_string(),
            velocity: first.velocity,
            angular_velocity: first.angular_velocity,
            others: others.count(),
        })
    }
}
