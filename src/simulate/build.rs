//! Scene → world.

use glam::DVec3;

use crate::dynamics::{Dynamics, Effort, UniformGravity, World};
use crate::scene::{Body, Scene};

/// What advances a scene, chosen by what the scene says; the interactions of pairs are counted meanwhile. An engine with steppers
/// of its own is made here, beside the world.
pub(super) fn dynamics(scene: &Scene, effort: &Effort) -> Box<dyn Dynamics> {
    let mut world = world(scene);
    world.watch(effort);
    Box::new(world)
}

/// The world of a scene in its initial state. Bodies are added in the order of the scene, so the number of a body
/// is the same in both.
pub fn world(scene: &Scene) -> World {
    let mut world = World::new();
    world.set_integrator(scene.simulation.method);
    // What is given at every time needs no steps to get there.
    let is_given = scene.bodies.iter().all(|body| body.start.fixed || body.motion.is_some());
    world.set_step(if is_given { f64::INFINITY } else { scene.simulation.step });
    world.reserve(scene.bodies.len());
    scene.bodies.iter().for_each(|body| add(&mut world, body));
    world.add_shapes(scene.bodies.iter().map(|body| body.shape.clone()));
    if scene.simulation.gravity != DVec3::ZERO {
        world.add_force(UniformGravity { acceleration: scene.simulation.gravity });
    }
    scene.forces.iter().flat_map(|force| force.kind.acting()).for_each(|force| world.add_shared_force(force));
    scene.joints.iter().for_each(|joint| world.add_shared_constraint(joint.kind.constraint()));
    scene.joints.iter().filter_map(|joint| joint.servo.clone()).for_each(|servo| world.add_force(servo));
    world
}

fn add(world: &mut World, body: &Body) {
    let id = world.add(body.start);
    if !body.presence.is_always() {
        world.limit(id, &body.presence);
    }
    if let Some(motion) = &body.motion {
        world.follow(id, motion.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
