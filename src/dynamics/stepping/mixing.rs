//! How surfaces behave together, as the engine is told.

use std::collections::BTreeSet;

use rapier3d_f64::prelude::{
    ActiveHooks, CoefficientCombineRule, ColliderBuilder, ColliderHandle, ColliderSet,
    ContactModificationContext, PairFilterContext, PhysicsHooks, SolverFlags,
};

use super::super::contact::{Contacts, Surface};

/// Which bodies pass through each other, and how surfaces mix.
///
/// The engine knows the rules for mixing that scenes have, the larger restitution and the geometric mean of the frictions, but not
/// the one for a surface that says nothing: there the other's value counts. Pairs of which that matters are asked about at every step,
/// which costs time. So all are avoided that can be.
pub(super) struct Mixing {
    surfaces: Vec<Surface>,
    apart: BTreeSet<(usize, usize)>,
    /// The friction that the engine knows of each body.
    known: Vec<f64>,
    /// The bodies of which some pair is mixed here.
    asked: Vec<bool>,
}

impl Mixing {
    /// Prepares the mixing for the given contacts. `moves` says which bodies move by forces; a pair touches only if one of its
    /// bodies does.
    pub(super) fn new(contacts: &Contacts, moves: &[bool]) -> Mixing {
        let surfaces: Vec<Surface> =
            contacts.surfaces.iter().map(|surface| surface.unwrap_or_default()).collect();
        let is_there = |i: &usize| contacts.surfaces[*i].is_some();
        let movers = || (0..surfaces.len()).filter(is_there).filter(|i| moves[*i]);
        let neither = Surface::default().meet(&Surface::default()).friction;
        // Where all that moves says the same, each of the others gets the value whose mean with that is what it should be.
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

    /// Says of a collider how it behaves.
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
            // What says nothing counts as 0, which the other's value is never below.
            .restitution(self.surfaces[body].restitution.unwrap_or(0.0))
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .active_hooks(hooks)
    }
}

/// The body of a collider: its number is with the collider.
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
