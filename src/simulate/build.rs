//! Scene → world.

use glam::DVec3;

use crate::dynamics::{Anchor, ConstantForce, Drag, Spring, UniformGravity};
use crate::dynamics::{BodyId, World};
use crate::scene::{Force, ForceKind, Scene, SpringEnd};

/// The world of a scene in its initial state. Bodies are added in the order of the scene, so the number of a body
/// is the same in both.
pub fn world(scene: &Scene) -> World {
    let mut world = World::new();
    world.set_integrator(scene.simulation.method);
    world.set_step(scene.simulation.step);
    let ids: Vec<BodyId> = scene.bodies.iter().map(|body| world.add(body.start)).collect();
    if scene.simulation.gravity != DVec3::ZERO {
        world.add_force(UniformGravity { acceleration: scene.simulation.gravity });
    }
    scene.forces.iter().for_each(|force| add_force(&mut world, force, &ids));
    world
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
        ForceKind::Spring { between, stiffness, damping, rest_length } => {
            let between = between.map(|end| match end {
                SpringEnd::Body(body) => Anchor::Body(ids[body]),
                SpringEnd::Point(point) => Anchor::Point(point),
            });
            world.add_force(Spring {
                between,
                stiffness: *stiffness,
                damping: *damping,
                rest_length: *rest_length,
            });
        }
    }
}
