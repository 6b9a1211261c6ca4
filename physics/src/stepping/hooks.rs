//! The callbacks of the physics engine: which bodies touch each other, and with which friction and surface velocities.

use rapier3d_f64::prelude::{
    ColliderHandle, ColliderSet, ContactModificationContext, PairFilterContext, PhysicsHooks, SolverFlags,
};

use super::bounce::Bounce;
use super::mixing::Mixing;
use super::rolling::Rolling;
use super::sliding;

/// What the physics engine asks about pairs of colliders during a step. It asks only about colliders with active hooks.
pub(super) struct Hooks<'a> {
    pub(super) mixing: &'a Mixing,
    pub(super) rolling: &'a Rolling,
    pub(super) bounce: Bounce<'a>,
}

impl PhysicsHooks for Hooks<'_> {
    fn filter_contact_pair(&self, context: &PairFilterContext<'_>) -> Option<SolverFlags> {
        let one = body_of(context.colliders, context.collider1)?;
        let two = body_of(context.colliders, context.collider2)?;
        self.mixing.touch(one, two).then_some(SolverFlags::COMPUTE_RIGID_IMPULSES)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let one = body_of(context.colliders, context.collider1);
        let two = body_of(context.colliders, context.collider2);
        let (Some(one), Some(two)) = (one, two) else { return };
        if let (Some(manifold), Some(friction)) = (context.rigid_mut(), self.mixing.friction(one, two)) {
            *manifold.friction = friction;
        }
        self.bounce.modify(context, [one, two]);
        self.bounce.rebounds.suspend(context);
        self.rolling.modify(context);
        sliding::modify(context, self.bounce.dt);
    }
}

/// Returns the index of a collider's body, which the collider stores as user data.
fn body_of(colliders: &ColliderSet, collider: ColliderHandle) -> Option<usize> {
    Some(colliders.get(collider)?.user_data as usize)
}
