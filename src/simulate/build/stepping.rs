//! Builds the time-stepping engine for a scene.

use super::{add_ground, contacts, free_world, lists_contacts};
use crate::physics::{Link, LinkKind, PairCounter, TimeStepping};
use crate::scene::{Joint, JointKind, Scene};

/// Builds a time-stepping engine with all bodies, forces, joints and contacts of a scene. `pair_counter` counts the evaluated interactions
/// between pairs of bodies.
pub(super) fn stepping(scene: &Scene, pair_counter: &PairCounter) -> TimeStepping {
    let mut world = free_world(scene);
    add_ground(&mut world, scene);
    world.watch(pair_counter);
    let links: Vec<Link> = scene.joints.iter().filter_map(link).collect();
    let mut stepping = TimeStepping::new(world, &contacts(scene), &links);
    stepping.show_contacts(lists_contacts(scene));
    stepping
}

/// Converts a joint into a link of the time-stepping engine. `None` for pulleys and gears, which the scene's check refuses with this
/// engine.
fn link(joint: &Joint) -> Option<Link> {
    let kind = match &joint.kind {
        JointKind::Ball(ball) => LinkKind::Ball(*ball),
        JointKind::Hinge(hinge) => LinkKind::Hinge(hinge.clone()),
        JointKind::Slider(slider) => LinkKind::Slider(slider.clone()),
        JointKind::Fixed(fixed) => LinkKind::Fixed(*fixed),
        JointKind::Rod(rod) => LinkKind::Rod(*rod),
        JointKind::Rope(rope) => LinkKind::Rope(*rope),
        JointKind::Pulley(_) | JointKind::Gear(_) => return None,
    };
    Some(Link { kind, collides: joint.collides })
}
