//! Scene → world.

use std::sync::Arc;

use glam::DVec3;

use crate::dynamics::{Anchor, ConstantForce, Coulomb, Drag, Gravitation, Lorentz, Spring, UniformGravity};
use crate::dynamics::{BodyId, Motion, Pose, Track, World};
use crate::scene::motion::{BodyMotion, TimedOrientation};
use crate::scene::timed::TimedVector;
use crate::scene::{Body, Force, ForceKind, Scene, SpringEnd};

/// The world of a scene in its initial state. Bodies are added in the order of the scene, so the number of a body
/// is the same in both.
pub fn world(scene: &Scene) -> World {
    let mut world = World::new();
    world.set_integrator(scene.simulation.method);
    // What is given at every time needs no steps to get there.
    let is_given = scene.bodies.iter().all(|body| body.start.fixed || body.motion.is_some());
    world.set_step(if is_given { f64::INFINITY } else { scene.simulation.step });
    let ids: Vec<BodyId> = scene.bodies.iter().map(|body| add(&mut world, body)).collect();
    if scene.simulation.gravity != DVec3::ZERO {
        world.add_force(UniformGravity { acceleration: scene.simulation.gravity });
    }
    scene.forces.iter().for_each(|force| add_force(&mut world, force, &ids));
    world
}

fn add(world: &mut World, body: &Body) -> BodyId {
    let id = world.add(body.start);
    match &body.motion {
        Some(BodyMotion::Track(track)) => world.drive(id, Shared(track.clone())),
        Some(BodyMotion::Formula { location, orientation }) => {
            world.drive(id, ByFormula { location: location.clone(), orientation: orientation.clone() });
        }
        None => {}
    }
    id
}

/// A motion that several worlds follow.
struct Shared(Arc<Track>);

impl Motion for Shared {
    fn at(&self, t: f64) -> Pose {
        self.0.at(t)
    }
}

/// A motion by formulas of the time.
struct ByFormula {
    location: TimedVector,
    orientation: TimedOrientation,
}

impl Motion for ByFormula {
    fn at(&self, t: f64) -> Pose {
        let (orientation, angular_velocity) = self.orientation.at(t);
        Pose {
            location: self.location.at(t),
            velocity: self.location.rate(t),
            acceleration: self.location.curvature(t),
            orientation,
            angular_velocity,
        }
    }
}

fn add_force(world: &mut World, force: &Force, ids: &[BodyId]) {
    let named = |on: &[usize]| on.iter().map(|&body| ids[body]).collect();
    match &force.kind {
        ForceKind::Constant { on, force, torque } => {
            world.add_force(ConstantForce { bodies: named(on), force: *force, torque: *torque });
        }
        &ForceKind::Drag { ref on, linear, quadratic, wind } => {
            world.add_force(Drag { bodies: named(on), linear, quadratic, wind });
        }
        &ForceKind::Gravitation { ref on, ref against, constant, softening } => {
            let against = against.as_deref().map(named);
            world.add_force(Gravitation { bodies: named(on), against, constant, softening });
        }
        &ForceKind::Coulomb { ref on, ref against, constant, softening } => {
            let against = against.as_deref().map(named);
            world.add_force(Coulomb { bodies: named(on), against, constant, softening });
        }
        &ForceKind::Lorentz { ref on, electric, magnetic } => {
            world.add_force(Lorentz { bodies: named(on), electric, magnetic });
        }
        &ForceKind::Spring { ref links, stiffness, damping, .. } => {
            for link in links {
                let between = link.between.map(|end| match end {
                    SpringEnd::Body(body) => Anchor::Body(ids[body]),
                    SpringEnd::Point(point) => Anchor::Point(point),
                });
                world.add_force(Spring { between, stiffness, damping, rest_length: link.rest_length });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Dynamics;

    /// A chain of three balls from a point, with 1 m from each to the next; the last is 0.5 m farther than that.
    #[test]
    fn a_chain_is_a_spring_from_each_end_to_the_next() {
        let scene = |rest_length: &str| {
            let ball = |name: &str, x: f64| {
                format!("[body.{name}]\nshape.sphere.radius = 0.1\nlocation = [{x}, 0, 0]\n")
            };
            let bodies = ball("a", 1.0) + &ball("b", 2.0) + &ball("c", 3.5);
            let spring = "[force.chain.spring]\nbetween = [[0, 0, 0], 'a', 'b', 'c']\nstiffness = 4\n";
            Scene::parse(&(bodies + spring + rest_length)).unwrap()
        };
        let mut world = world(&scene(""));
        assert_eq!(world.forces(), [DVec3::ZERO; 3], "each begins at its own rest length");
        let mut world = self::world(&scene("rest_length = 1"));
        assert_eq!(world.forces(), [DVec3::ZERO, 2.0 * DVec3::X, -2.0 * DVec3::X]);
    }
}
