//! Finds bodies whose initial velocity is changed by joints.

use glam::DVec3;

use super::super::Frame;
use crate::physics::BodySnapshot;
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
        /// The largest relative change of a velocity that counts as none. Rounding errors are far smaller, and larger changes may be
        /// visible.
        const RELATIVE_TOLERANCE: f64 = 1e-6;
        if scene.joints.is_empty() {
            return None;
        }
        let differs =
            |now: DVec3, given: DVec3| now.distance(given) > RELATIVE_TOLERANCE * given.length().max(1e-3);
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
        let body = &scene.bodies[first.id];
        let size = body.shape.bounding_radius().unwrap_or(1.0);
        let speed = first.velocity.length() + size * first.angular_velocity.length();
        Some(Corrected {
            body: body.name.to_string(),
            velocity: without_rounding(first.velocity, speed),
            angular_velocity: without_rounding(first.angular_velocity, speed / size),
            others: others.count(),
        })
    }
}

/// Sets the components of a vector to 0 that are rounding errors, compared with a speed of the same kind.
fn without_rounding(vector: DVec3, speed: f64) -> DVec3 {
    /// The largest rounding error, relative to the speed.
    const RELATIVE_ROUNDING: f64 = 1e-12;
    DVec3::from_array(
        vector.to_array().map(|part| if part.abs() <= RELATIVE_ROUNDING * speed { 0.0 } else { part }),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_errors_are_left_out_of_the_advice() {
        let vector = DVec3::new(1.18e-31, 2.0, -4e-16);
        assert_eq!(without_rounding(vector, 2.0), DVec3::new(0.0, 2.0, 0.0));
        let small = DVec3::new(1e-9, 2e-9, 0.0);
        assert_eq!(without_rounding(small, 2e-9), small, "all is small");
    }
}
