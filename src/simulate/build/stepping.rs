//! Builds the time-stepping engine for a scene.

use super::joints::link;
use super::{add_ground, contacts, free_world, lists_contacts};
use crate::physics::{Link, PairCounter, TimeStepping};
use crate::scene::Scene;

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
