//! Builds the world of a scene.

mod forces;
mod joints;
#[cfg(feature = "time-stepping")]
mod stepping;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;

pub(crate) use self::forces::forces;
use self::joints::constraint;
use crate::physics::{
    Accuracy, BodyId, ContactPolicy, Contacts, Dynamics, Force, PairCounter, RigidBody, Shape,
    UniformGravity, World,
};
use crate::scene::{Body, BodyMeasure, ContactLaw, Scene};

/// Builds the dynamics that a scene asks for: a plain world, a world that an adaptive method advances, or, for many bodies in contact, the
/// time-stepping engine.
/// `pair_counter` counts the evaluated interactions between pairs of bodies.
pub(super) fn dynamics(scene: &Scene, pair_counter: &PairCounter) -> Box<dyn Dynamics> {
    #[cfg(feature = "time-stepping")]
    if is_for_many_bodies(scene) {
        return Box::new(stepping::stepping(scene, pair_counter));
    }
    let mut world = world(scene);
    world.watch(pair_counter);
    match scene.simulation.method.take_over {
        Some(ahead) if !is_given(scene) => {
            let accuracy =
                Accuracy { tolerance: scene.simulation.tolerance, end: scene.simulation.timeline.end() };
            ahead(world, accuracy)
        }
        _ => Box::new(world),
    }
}

/// Returns true if the engine for many bodies simulates a scene.
fn is_for_many_bodies(scene: &Scene) -> bool {
    cfg!(feature = "time-stepping") && scene.is_for_many_bodies()
}

/// Returns true if a run lists its contacts. The engine for many bodies lists them only if the scene shows contact forces, since there are
/// tens of thousands in a pile.
pub fn lists_contacts(scene: &Scene) -> bool {
    let shows = |body: &Body| body.showing.loads[1..].iter().any(Option::is_some);
    !is_for_many_bodies(scene)
        || scene.bodies.iter().any(shows)
        || scene.shows_of_bodies(BodyMeasure::is_contact_force)
}

/// Builds the world of a scene in its initial state. A body has the same index in the scene and in the world. A ground that stops bodies
/// becomes an additional body, after all bodies of the scene.
pub fn world(scene: &Scene) -> World {
    let mut world = free_world(scene);
    scene.joints.iter().for_each(|joint| world.add_shared_constraint(constraint(&joint.kind)));
    if scene.simulation.contacts.is_some() {
        add_ground(&mut world, scene);
        world.collide(contacts(scene));
    }
    if scene.simulation.contacts == Some(ContactLaw::TimeStepping) {
        world.set_contact_policy(ContactPolicy::TimeStepping);
    }
    world
}

/// Builds the world of a scene with its bodies and forces, but without joints and contacts.
fn free_world(scene: &Scene) -> World {
    let mut world = World::new();
    world.set_integrator(scene.simulation.method);
    // Prescribed motion is a function of time, so it needs no intermediate steps.
    world.set_step(if is_given(scene) { f64::INFINITY } else { scene.simulation.step });
    world.reserve(scene.bodies.len());
    scene.bodies.iter().for_each(|body| add(&mut world, body));
    world.add_shapes(scene.bodies.iter().map(|body| body.shape.clone()));
    forces_of(scene).for_each(|force| world.add_shared_force(force));
    scene.joints.iter().filter_map(|joint| joint.servo.clone()).for_each(|servo| world.add_force(servo));
    world
}

/// Returns the gravity and the named forces of a scene, in the order in which a world adds them up.
pub(super) fn forces_of(scene: &Scene) -> impl Iterator<Item = Arc<dyn Force>> {
    let acceleration = scene.simulation.gravity;
    let gravity = (acceleration != DVec3::ZERO).then(|| Arc::new(UniformGravity { acceleration }) as Arc<_>);
    gravity.into_iter().chain(scene.forces.iter().flat_map(|force| forces(&force.kind)))
}

/// True if every body is fixed or has a prescribed motion.
fn is_given(scene: &Scene) -> bool {
    scene.bodies.iter().all(|body| body.start.fixed || body.motion.is_some())
}

/// Adds the ground to the world as a fixed plane. The ground is a body of the world, but not of the scene.
fn add_ground(world: &mut World, scene: &Scene) {
    let Some(height) = scene.ground_that_stops().map(|(height, _)| height) else { return };
    let plane = Shape::Plane { normal: DVec3::Y };
    world.add(RigidBody::new(&plane, 1.0).with_location(DVec3::Y * height).with_fixed(true));
    world.add_shapes([plane]);
}

/// Collects the contact surface of each body of a scene, and the pairs of bodies that may pass through each other: bodies joined by a joint
/// that does not let them collide, and bodies of one group.
fn contacts(scene: &Scene) -> Contacts {
    let surface = |body: &Body| body.collider.as_ref().map(|collider| collider.surface);
    let ground = scene.ground_that_stops().map(|(_, surface)| Some(surface));
    let surfaces = scene.bodies.iter().map(surface).chain(ground).collect();
    let mut apart = BTreeSet::new();
    for joint in scene.joints.iter().filter(|joint| !joint.collides) {
        if let [Some(one), Some(two)] = joint.kind.between().map(|end| end.body().map(BodyId::index)) {
            apart.insert((one.min(two), one.max(two)));
        }
    }
    let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (id, body) in scene.bodies.iter().enumerate() {
        if let Some(group) = body.collider.as_ref().and_then(|collider| collider.group.as_deref()) {
            groups.entry(group).or_default().push(id);
        }
    }
    let moves = |id: usize| !scene.bodies[id].start.fixed && scene.bodies[id].motion.is_none();
    for group in groups.values() {
        for (place, &one) in group.iter().enumerate() {
            // Two bodies that no force moves never collide, so their pair need not be listed.
            let others = group[place + 1..].iter().filter(|&&two| moves(one) || moves(two));
            apart.extend(others.map(|&two| (one, two)));
        }
    }
    Contacts { surfaces, apart }
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

    /// A chain of springs from a fixed point through three balls. Neighbors are 1 m apart, except the last two, which are 1.5 m apart.
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

    #[test]
    fn joined_bodies_and_those_of_one_group_pass_through_each_other() {
        let text = "simulation = { contacts = 'event-driven', integrator = 'rk4' }
            defaults.body.location = [0, 5, 0]
            [body.wall]\nshape.box.size = [1, 1, 1]\nfixed = true\ncollision_group = 'car'
            [body.a]\nshape.sphere.radius = 1\ncollision_group = 'car'
            [body.rail]\nshape.box.size = [1, 1, 1]\nfixed = true\ncollision_group = 'car'
            [body.b]\nshape.sphere.radius = 1\nrestitution = 0.5
            [body.ghost]\nshape.sphere.radius = 1\ncollides = false
            [joint.j.ball]\nbetween = ['a', 'b']\nat = [0, 5, 0]
            [joint.k.ball]\nbetween = ['wall', 'b']\nat = [0, 5, 0]\ncollides = true
            [environment]\nground.friction = 0.3
            ";
        let Contacts { surfaces, apart } = contacts(&Scene::parse(text).unwrap());
        assert_eq!(apart.into_iter().collect::<Vec<_>>(), [(0, 1), (1, 2), (1, 3)]);
        assert_eq!(surfaces.len(), 6, "the ground is one");
        assert_eq!(surfaces[3].unwrap().restitution, Some(0.5));
        assert_eq!(surfaces[4], None);
        assert_eq!(surfaces[5].unwrap().friction, Some(0.3));
        let none = text.replace("ground.friction = 0.3", "ground = false");
        assert_eq!(contacts(&Scene::parse(&none).unwrap()).surfaces.len(), 5);
    }
}
