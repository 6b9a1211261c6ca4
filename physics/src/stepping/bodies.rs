//! Inserts the bodies of a world into the physics engine.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{
    ActiveEvents, ActiveHooks, ColliderBuilder, InteractionGroups, MassProperties, PhysicsWorld, Pose,
    RigidBodyBuilder, RigidBodyHandle,
};

use super::super::contact::Contacts;
use super::super::shape::Shape;
use super::super::{Model, State};
use super::mesh::MeshSolids;
use super::mixing::Mixing;
use super::rolling::ColliderSymmetries;
use super::shape::{Solid, Symmetry};
use super::{plane, shape};

/// Returns, for each present or absent body, whether forces move it.
pub(super) fn moving(model: &Model) -> Vec<bool> {
    (0..model.len()).map(|i| model.is_moved_by_forces(i)).collect()
}

/// Returns the thickness of the thinnest body that moves and touches others, m; 1 m if no body does. The physics engine measures its
/// tolerances in this length.
pub(super) fn typical_length(model: &Model, contacts: &Contacts, moves: &[bool]) -> f64 {
    let touches = |i: &usize| moves[*i] && contacts.surfaces.get(*i).is_some_and(Option::is_some);
    let thickness = |i: usize| Some(2.0 * model.shape(i)?.half_thickness()?);
    let thinnest = (0..model.len()).filter(touches).filter_map(thickness).min_by(f64::total_cmp);
    thinnest.filter(|length| *length > 0.0).unwrap_or(1.0)
}

/// Returns half of the thickness of each body, m; infinite for bodies without a shape.
pub(super) fn half_thickness(model: &Model) -> Vec<f64> {
    let of = |i: usize| model.shape(i).and_then(Shape::half_thickness).unwrap_or(f64::INFINITY);
    (0..model.len()).map(of).collect()
}

/// Returns the largest distance of each body's surface from its centre of mass, m; zero for bodies without a shape, and for planes.
pub(super) fn reach(model: &Model) -> Vec<f64> {
    let of = |i: usize| model.shape(i).and_then(Shape::bounding_radius).unwrap_or(0.0);
    (0..model.len()).map(of).collect()
}

/// Adds all bodies to the physics engine. Returns the handle and the colliders of each body. Absent bodies are disabled. `length` is the thickness of
/// the thinnest moving body, m.
pub(super) fn insert(
    engine: &mut PhysicsWorld,
    model: &mut Model,
    state: &mut State,
    contacts: &Contacts,
    mixing: &Mixing,
    length: f64,
) -> (Vec<RigidBodyHandle>, Vec<ColliderSymmetries>) {
    let (mut handles, mut all_symmetries) = (Vec::with_capacity(model.len()), Vec::new());
    let is_other = |i: usize| {
        let touches = contacts.surfaces.get(i).is_some_and(Option::is_some);
        touches && model.is_moved_by_forces(i) && model.shape(i).is_some_and(|shape| !plane::is_simple(shape))
    };
    let meets_others = (0..model.len()).any(is_other);
    let mut meshes = MeshSolids::default();
    for i in 0..model.len() {
        let is_present = model.is_present(i);
        if !is_present {
            model.bring(i, state);
        }
        let handle = engine.insert_body(body(model, state, i).enabled(is_present));
        let mut own = Vec::new();
        if contacts.surfaces.get(i).is_some_and(Option::is_some) {
            for (collider, symmetries) in colliders(model, state, i, (length, meets_others), &mut meshes) {
                let mut collider = mixing.describe(i, collider.user_data(i as u128));
                if model.shape(i).is_some_and(is_tubular) {
                    collider.active_hooks |= ActiveHooks::MODIFY_SOLVER_CONTACTS;
                }
                own.push((engine.insert_collider(collider, Some(handle)), symmetries));
            }
        }
        handles.push(handle);
        all_symmetries.push(own);
        if !is_present {
            model.take_away(i, state);
        }
    }
    (handles, all_symmetries)
}

/// Returns true for capsules, tori and compounds with such parts.
///
/// The physics engine keeps the points and normals of contacts that have hardly moved. At a narrow curved surface, friction then gains
/// energy: a chain of tori never comes to rest. Contacts for which the engine makes a call are found again in each step.
fn is_tubular(shape: &Shape) -> bool {
    match shape {
        Shape::Capsule { .. } | Shape::Torus { .. } => true,
        Shape::Compound(compound) => compound.parts().iter().any(|part| is_tubular(&part.shape)),
        _ => false,
    }
}

/// Returns the rigid body for the physics engine, still without its colliders. Its frame is that of the principal axes of inertia.
fn body(model: &Model, state: &State, i: usize) -> RigidBodyBuilder {
    let builder = if !model.movable()[i] {
        RigidBodyBuilder::fixed()
    } else if model.inverse_mass()[i] == 0.0 {
        RigidBodyBuilder::kinematic_position_based()
    } else {
        RigidBodyBuilder::dynamic()
    };
    let mass = MassProperties {
        local_com: DVec3::ZERO,
        inv_mass: model.inverse_mass()[i],
        inv_principal_inertia: model.inverse_inertia()[i],
        principal_inertia_local_frame: DQuat::IDENTITY,
    };
    builder
        .pose(pose(state, i))
        .linvel(state.velocity[i])
        .angvel(model.angular_velocity(i, state))
        .additional_mass_properties(mass)
        .can_sleep(false)
        .allow_fast_rotation(true)
        // The module `spin` computes the free rotation of bodies, including gyroscopic effects.
        .gyroscopic_forces_enabled(false)
}

/// Returns the pose of a body: its centre of mass and its principal axes, in world axes.
pub(super) fn pose(state: &State, i: usize) -> Pose {
    Pose::from_parts(state.location[i], state.orientation[i])
}

/// Returns the colliders of a body, without mass, each with the symmetries of its parts in the engine's frame of the body. `meets_others`
/// is true if any moving body is neither sphere nor box.
fn colliders(
    model: &Model,
    state: &State,
    i: usize,
    (length, meets_others): (f64, bool),
    meshes: &mut MeshSolids,
) -> Vec<(ColliderBuilder, Vec<Symmetry>)> {
    let Some(form) = model.shape(i) else { return Vec::new() };
    let from_body = Pose::from_parts(DVec3::ZERO, model.principal_axes(i).conjugate());
    let build = |(solid, groups): (Solid, InteractionGroups)| {
        let collider = ColliderBuilder::new(solid.shape).density(0.0).position(from_body * solid.pose);
        let collider = collider.active_events(ActiveEvents::COLLISION_EVENTS).collision_groups(groups);
        (collider, solid.symmetries.into_iter().map(|symmetry| symmetry.placed(from_body)).collect())
    };
    if let Shape::Plane { normal } = *form {
        let solids = plane::solids(normal, state.orientation[i], length, meets_others);
        return solids.into_iter().map(build).collect();
    }
    let groups = plane::groups_of(form);
    let solids = shape::solids(form, model.is_moved_by_forces(i), meshes);
    solids.into_iter().map(|solid| build((solid, groups))).collect()
}
