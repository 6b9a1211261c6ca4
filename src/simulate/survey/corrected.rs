//! Bodies whose start differs from the scene.

use glam::DVec3;

use super::super::Frame;
use crate::dynamics::BodySnapshot;
use crate::scene::Scene;

/// A body whose initial velocity differs from the scene's, because joints hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct Corrected {
    /// Its name.
    pub body: String,
    /// Its initial velocity, m/s.
    pub velocity: DVec3,
    /// Its initial angular velocity, rad/s.
    pub angular_velocity: DVec3,
    /// The number of other such bodies.
    pub others: usize,
}

impl Corrected {
    /// Compares the first frame with the scene.
    pub(super) fn find(scene: &Scene, frame: &Frame) -> Option<Corrected> {
        // Rounding errors are far smaller, and larger changes may be visible.
        const NOTICEABLE: f64 = 1e-6;
        if scene.joints.is_empty() {
            return None;
        }
        let differs = |now: DVec3, given: DVec3| now.distance(given) > NOTICEABLE * given.length().max(1e-3);
        let is_other = |&&BodySnapshot { id, velocity, angular_velocity, .. }: &&BodySnapshot| {
            let body = &scene.bodies[id];
            let is_free = !body.start.fixed && body.motion.is_none();
            let start = &body.start;
            // A body without a given velocity may get one from its guide or motor.
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
