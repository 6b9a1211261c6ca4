//! The velocities of round bodies that roll, and of the bodies that joints hold to them.
//!
//! The physics engine keeps a contact as one point of each body, and moves both points with their bodies during a step. When a round body
//! rotates, its surface stays where it is, but the point leaves the other body: by ρ (1 − cos φ) for a radius ρ and an angle φ. The engine
//! takes this for a gap. At the end of the step it gives the bodies the velocity that would close the gap, about ½ ρ ω² Δt. Positions do not
//! follow this velocity, because the next step finds the true contact first. So a ball that rolls on a floor stays at its height, but has
//! a velocity into the floor.
//!
//! This velocity is wrong, and snapshots must not have it. They get a velocity between that of the engine and the true displacement in the
//! step, divided by its duration. The engine keeps its own velocity, because its contact forces and friction rely on it.

use glam::DVec3;
use rapier3d_f64::prelude::{ContactPair, PhysicsWorld, RigidBodyHandle, TypedShape};

use super::joint::Joints;

/// Bodies that rotate by a larger angle in a step, rad, get a corrected velocity.
const ANGLE: f64 = 0.005;
/// Smaller differences of velocities are rounding errors, relative to the velocity.
const ROUNDING: f64 = 1e-9;

/// Finds the bodies whose velocities are corrected.
pub(super) struct Rolling {
    handles: Vec<RigidBodyHandle>,
    /// For each body, the largest radius of its round colliders, m; 0 without any.
    radius: Vec<f64>,
    /// For each body, the number of its group: the bodies that joints hold together, directly or through others.
    group: Vec<usize>,
    /// For each group, whether it has more than one body.
    is_joined: Vec<bool>,
    /// For each group, the largest wrong velocity that it can have in this step, m/s; 0 if no body of the group rolls.
    largest: Vec<f64>,
}

impl Rolling {
    /// Finds the bodies with round colliders in the physics engine, and the groups of bodies that joints hold together.
    pub(super) fn new(engine: &PhysicsWorld, handles: &[RigidBodyHandle], joints: &Joints) -> Rolling {
        let radius = |handle: &RigidBodyHandle| {
            let colliders = engine.bodies.get(*handle).map_or(&[][..], |body| body.colliders());
            let colliders = colliders.iter().filter_map(|collider| engine.colliders.get(*collider));
            colliders.map(|collider| radius(&collider.shape().as_typed_shape())).fold(0.0, f64::max)
        };
        let group = joints.groups(handles.len());
        let mut is_joined = vec![false; handles.len()];
        for (_, group) in group.iter().enumerate().filter(|(i, group)| i != *group) {
            is_joined[*group] = true;
        }
        let largest = vec![0.0; handles.len()];
        Rolling {
            handles: handles.to_vec(),
            radius: handles.iter().map(radius).collect(),
            group,
            is_joined,
            largest,
        }
    }

    /// Finds the groups that roll in a step of `dt` seconds. `turning` returns the angular velocity of a body, rad/s.
    pub(super) fn begin(&mut self, engine: &PhysicsWorld, dt: f64, turning: impl Fn(usize) -> DVec3) {
        self.largest.fill(0.0);
        for (i, radius) in self.radius.iter().enumerate().filter(|(_, radius)| **radius > 0.0) {
            let squared = turning(i).length_squared();
            let group = self.group[i];
            if squared * dt * dt > ANGLE * ANGLE
                && (!self.is_joined[group] || touches(engine, self.handles[i]))
            {
                // Twice the estimate: the angular velocity changes in the step.
                self.largest[group] = self.largest[group].max(radius * squared * dt);
            }
        }
    }

    /// Returns the corrected velocity of a body, m/s. `velocity` is that of the engine at the end of a step, and `displacement` is the body's
    /// displacement in the step, divided by its duration.
    pub(super) fn corrected(&self, body: usize, velocity: DVec3, displacement: DVec3) -> DVec3 {
        let largest = self.largest[self.group[body]];
        if largest > 0.0 { between(velocity, displacement, largest) } else { velocity }
    }
}

/// Returns a velocity between that of the engine and that of the displacement, m/s. Only the component along their difference changes:
/// the displacement replaces it, but may not reverse it. A body that rebounds has a larger difference than `largest`, and keeps the
/// velocity of the engine. A body that the engine pushes out of another one keeps it, too.
fn between(velocity: DVec3, displacement: DVec3, largest: f64) -> DVec3 {
    let difference = displacement - velocity;
    let squared = difference.length_squared();
    // Rounding errors must not change the velocity of a body in free flight.
    if squared <= ROUNDING * ROUNDING * velocity.length_squared() || squared > largest * largest {
        return velocity;
    }
    let direction = difference / squared.sqrt();
    let [now, moved] = [velocity, displacement].map(|vector| vector.dot(direction));
    velocity + (now.max(moved.min(0.0)) - now) * direction
}

/// Returns true if a body touches another.
fn touches(engine: &PhysicsWorld, body: RigidBodyHandle) -> bool {
    let colliders = engine.bodies.get(body).map_or(&[][..], |body| body.colliders());
    let mut pairs = colliders.iter().flat_map(|collider| engine.narrow_phase.contact_pairs_with(*collider));
    pairs.any(ContactPair::has_any_active_contact)
}

/// Returns the radius of a round shape, m, or the largest radius of its round parts; 0 for other shapes.
fn radius(shape: &TypedShape<'_>) -> f64 {
    match shape {
        TypedShape::Compound(compound) => {
            let parts = compound.shapes().iter().map(|(_, shape)| radius(&shape.as_typed_shape()));
            parts.fold(0.0, f64::max)
        }
        TypedShape::Ball(ball) => ball.radius,
        TypedShape::Capsule(capsule) => capsule.radius,
        TypedShape::RoundCuboid(cuboid) => cuboid.border_radius,
        TypedShape::Cylinder(cylinder) => cylinder.radius,
        TypedShape::Cone(cone) => cone.radius,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_into_a_contact_that_the_body_does_not_follow_is_removed() {
        let rolling = between(DVec3::new(9.0, -0.1, 0.0), DVec3::new(9.0, 0.0, 0.0), 0.2);
        assert_eq!(rolling, DVec3::new(9.0, 0.0, 0.0));
        let sinking = between(DVec3::new(9.0, -0.1, 0.0), DVec3::new(9.0, -0.04, 0.0), 0.2);
        assert!((sinking - DVec3::new(9.0, -0.04, 0.0)).length() < 1e-15);
    }

    #[test]
    fn a_rebound_and_a_body_that_is_pushed_out_keep_the_velocity_of_the_engine() {
        let rebound = DVec3::new(1.0, 2.0, 0.0);
        assert_eq!(between(rebound, DVec3::new(1.0, 0.0, 0.0), 0.2), rebound);
        let pushed = DVec3::new(1.0, 0.0, 0.0);
        assert_eq!(between(pushed, DVec3::new(1.0, 0.1, 0.0), 0.2), pushed);
    }
}
