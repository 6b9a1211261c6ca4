//! The rules by which the engine mixes two surfaces.

use std::collections::BTreeSet;

use rapier3d_f64::prelude::{
    ActiveHooks, CoefficientCombineRule, ColliderBuilder, ColliderHandle, ColliderSet,
    ContactModificationContext, PairFilterContext, PhysicsHooks, SolverFlags,
};

use super::super::contact::{Contacts, Surface};

/// Which bodies pass through each other, and how surfaces mix.
///
/// The engine supports the scene's rules for mixing, the larger restitution and the geometric mean of the frictions. It does not support
/// surfaces without a value, for which the other's value counts. Pairs where this matters need a callback at every step, which costs
/// time. So callbacks are avoided where possible.
pub(super) struct Mixing {
    surfaces: Vec<Surface>,
    apart: BTreeSet<(usize, usize)>,
    /// The friction of each body in the engine.
    known: Vec<f64>,
    /// The bodies that need a callback for some pair.
    asked: Vec<bool>,
}

impl Mixing {
    /// Prepares the mixing for the given contacts. `moves` says which bodies move by forces; a pair touches only if one of its bodies
    /// does.
    pub(super) fn new(contacts: &Contacts, moves: &[bool]) -> Mixing {
        let surfaces: Vec<Surface> =
            contacts.surfaces.iter().map(|surface| surface.unwrap_or_default()).collect();
        let is_there = |i: &usize| contacts.surfaces[*i].is_some();
        let movers = || (0..surfaces.len()).filter(is_there).filter(|i| moves[*i]);
        let neither = Surface::default().meet(&Surface::default()).friction;
        // If all moving bodies have the same value, each other body gets the value whose mean with it is right.
        let common = movers().next().map(|i| surfaces[i]);
        let common = common.filter(|first| movers().all(|i| surfaces[i].friction == first.friction));
        let known = |i: usize| {
            let own = surfaces[i].friction.unwrap_or(neither);
            match &common {
                Some(mover) if !moves[i] => {
                    let wanted = mover.meet(&surfaces[i]).friction;
                    let other = mover.friction.unwrap_or(neither);
                    if other > 0.0 { wanted * wanted / other } else { own }
                }
                _ => own,
            }
        };
        let known: Vec<f64> = (0..surfaces.len()).map(known).collect();
        let all_speak = (0..surfaces.len()).filter(is_there).all(|i| surfaces[i].friction.is_some());
        let is_known = common.is_some() || all_speak;
        let asked = surfaces.iter().map(|surface| !is_known && surface.friction.is_none()).collect();
        Mixing { surfaces, apart: contacts.apart.clone(), known, asked }
    }

    /// Sets the surface of a collider.
    pub(super) fn describe(&self, body: usize, collider: ColliderBuilder) -> ColliderBuilder {
        let mut hooks = ActiveHooks::empty();
        if self.asked[body] {
            hooks |= ActiveHooks::MODIFY_SOLVER_CONTACTS;
        }
        if self.apart.iter().any(|&(one, two)| one == body || two == body) {
            hooks |= ActiveHooks::FILTER_CONTACT_PAIRS;
        }
        collider
            .friction(self.known[body])
            .friction_combine_rule(CoefficientCombineRule::GeometricMean)
            // An unset value counts as 0, which is never above the other's.
            .restitution(self.surfaces[body].restitution.unwrap_or(0.0))
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .active_hooks(hooks)
    }
}

/// The body of a collider, whose index is stored in the collider.
pub(super) fn body_of(colliders: &ColliderSet, collider: ColliderHandle) -> Option<usize> {
    Some(colliders.get(collider)?.user_data as usize)
}

impl PhysicsHooks for Mixing {
    fn filter_contact_pair(&self, context: &PairFilterContext<'_>) -> Option<SolverFlags> {
        let one = body_of(context.colliders, context.collider1)?;
        let two = body_of(context.colliders, context.collider2)?;
        let are_apart = self.apart.contains(&(one.min(two), one.max(two)));
        (!are_apart).then_some(SolverFlags::COMPUTE_RIGID_IMPULSES)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let one = body_of(context.colliders, context.collider1);
        let two = body_of(context.colliders, context.collider2);
        let (Some(one), Some(two), Some(manifold)) = (one, two, context.rigid_mut()) else { return };
        *manifold.friction = self.surfaces[one].meet(&self.surfaces[two]).friction;
    }
}
