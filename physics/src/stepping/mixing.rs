//! The rules by which the physics engine combines the friction and the restitution of two surfaces in contact.

use rapier3d_f64::prelude::{ActiveHooks, CoefficientCombineRule, ColliderBuilder};

use super::super::contact::{Contacts, Surface};

/// The rules for pairs of bodies: which bodies pass through each other, and how the properties of two surfaces combine.
///
/// The physics engine supports the scene's rules: the larger of two restitutions and the geometric mean of two frictions. In the scene, a
/// surface may have no value; the value of the other surface then counts. The engine does not support this rule. Pairs with such a surface
/// may need a callback at every step, which costs time. So callbacks are avoided where possible.
pub(super) struct Mixing {
    surfaces: Vec<Surface>,
    pub(super) contacts: Contacts,
    /// For each body, whether it passes through any other one.
    is_apart: Vec<bool>,
    /// The coefficient of friction of each body that is set in the physics engine.
    known: Vec<f64>,
    /// For each body, whether some of its contact pairs need a callback to compute the friction.
    asked: Vec<bool>,
    /// Whether any body has a restitution.
    pub(super) has_restitution: bool,
}

impl Mixing {
    /// Prepares the rules for the given contacts. `moves` holds, for each body, whether forces move it. Two bodies touch only if forces
    /// move one of them.
    pub(super) fn new(contacts: &Contacts, moves: &[bool]) -> Mixing {
        let surfaces: Vec<Surface> =
            contacts.surfaces.iter().map(|surface| surface.unwrap_or_default()).collect();
        let is_there = |i: &usize| contacts.surfaces[*i].is_some();
        let movers = || (0..surfaces.len()).filter(is_there).filter(|i| moves[*i]);
        let neither = Surface::default().meet(&Surface::default()).friction;
        // If all moving bodies have the same friction, every other body gets the friction whose geometric mean with that value is right.
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
        let has_restitution = surfaces.iter().any(|surface| surface.restitution.is_some_and(|own| own > 0.0));
        let mut is_apart = vec![false; surfaces.len()];
        for i in contacts.apart.iter().flat_map(|&(one, two)| [one, two]) {
            is_apart.get_mut(i).into_iter().for_each(|is_apart| *is_apart = true);
        }
        Mixing { surfaces, contacts: contacts.clone(), is_apart, known, asked, has_restitution }
    }

    /// Sets the friction, the restitution and the callbacks of a body's collider.
    pub(super) fn describe(&self, body: usize, collider: ColliderBuilder) -> ColliderBuilder {
        let mut hooks = ActiveHooks::empty();
        if self.asked[body] {
            hooks |= ActiveHooks::MODIFY_SOLVER_CONTACTS;
        }
        if self.is_apart[body] {
            hooks |= ActiveHooks::FILTER_CONTACT_PAIRS;
        }
        collider
            .friction(self.known[body])
            .friction_combine_rule(CoefficientCombineRule::GeometricMean)
            // An unset restitution counts as 0. The physics engine takes the larger value, so the restitution of the other surface counts.
            .restitution(self.surfaces[body].restitution.unwrap_or(0.0))
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .active_hooks(hooks)
    }

    /// Returns whether two bodies touch each other when they meet.
    pub(super) fn touch(&self, one: usize, two: usize) -> bool {
        !self.contacts.apart.contains(&(one.min(two), one.max(two)))
    }

    /// Returns the friction between two bodies if the physics engine cannot compute it.
    pub(super) fn friction(&self, one: usize, two: usize) -> Option<f64> {
        let is_asked = self.asked[one] || self.asked[two];
        is_asked.then(|| self.surfaces[one].meet(&self.surfaces[two]).friction)
    }

    /// Returns the restitution between two bodies.
    pub(super) fn restitution(&self, [one, two]: [usize; 2]) -> f64 {
        self.surfaces[one].meet(&self.surfaces[two]).restitution
    }
}
