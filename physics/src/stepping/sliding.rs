//! The velocities of surfaces that friction must know: the direction of sliding, and the arc of a point that rotates.
//!
//! The physics engine first finds the impulse of friction that would stop the sliding, and then shortens this impulse to the limit of
//! Coulomb friction. But the impulse that stops the sliding has another direction than the sliding if a body yields more easily in one
//! direction than in another. A plank that slides obliquely would turn aside by up to 30°. So a sliding surface gets an additional
//! velocity with which the engine finds the right direction. The engine asks for this velocity by a callback.
//!
//! On a turntable, the engine takes a body that friction holds along the tangent, and not along the arc: the body would creep outwards by
//! the part ½ ω² Δt of its distance from the axis in each second. So a point that rotates gets the mean velocity on its arc.

use glam::DVec3;
use rapier3d_f64::prelude::{ContactModificationContext, SolverContact};

use super::super::motion::Twist;
use super::contact_body::ContactBody;
use super::touch::{Push, Touch};

/// The sliding at the contacts of each body.
pub(super) struct Sliding {
    /// Whether the friction on a body could get a wrong direction: not for balls, which yield equally in all directions.
    watched: Vec<bool>,
    /// The largest speed of sliding at contacts with friction of each watched body in the last step, m/s; infinite if nothing pressed on the
    /// body.
    pub(super) speed: Vec<f64>,
}

impl Sliding {
    /// `watched` tells which bodies yield to friction more easily in some directions than in others.
    pub(super) fn new(watched: Vec<bool>) -> Sliding {
        Sliding { speed: vec![f64::INFINITY; watched.len()], watched }
    }

    /// Forgets the contacts of the last step.
    pub(super) fn begin(&mut self) {
        self.speed.fill(f64::INFINITY);
    }

    /// Notes a contact of the last step. `mean` is the mean twist of each body in that step.
    pub(super) fn see(&mut self, touch: &Touch<'_>, push: &Push, mean: &[Twist]) {
        let bodies = touch.bodies;
        if !bodies.iter().any(|&body| self.watched[body]) {
            return;
        }
        let velocity = |side: usize| {
            let (velocity, turning) = mean[bodies[side]];
            velocity + turning.cross(push.arms[side])
        };
        // Without friction, its direction does not matter.
        let has_friction = push.friction != DVec3::ZERO;
        let sliding = || (velocity(0) - velocity(1)).reject_from_normalized(touch.normal());
        let speed = if has_friction { sliding().length() } else { 0.0 };
        for body in bodies {
            let fastest = &mut self.speed[body];
            *fastest = if fastest.is_finite() { fastest.max(speed) } else { speed };
        }
    }

    /// Returns true if a contact of a body may slide in the next step faster than `slow`, m/s, if the body itself moves faster than that.
    pub(super) fn may_slide(&self, body: usize, slow: f64) -> bool {
        self.watched[body] && self.speed[body] > slow
    }
}

/// Gives the points of a contact the velocities on their arcs in a step of `dt`, s. Gives friction the direction opposite to the sliding, unless
/// friction can stop the sliding within the step.
pub(super) fn modify(context: &mut ContactModificationContext<'_>, dt: f64) {
    let bodies = context.bodies;
    let sides = [context.rigid_body1, context.rigid_body2]
        .map(|body| bodies.get(body?).map(|body| ContactBody::new(body, dt)));
    let (Some(contact), [Some(one), Some(two)]) = (context.rigid_mut(), sides) else { return };
    let normal = *contact.normal;
    let count = contact.solver_contacts.len() as f64;
    let mean = |points: &[SolverContact], of: fn(&SolverContact) -> DVec3| {
        points.iter().map(of).sum::<DVec3>() / count
    };
    // The engine applies friction at the centre of all points.
    let place = mean(contact.solver_contacts, |point| 0.5 * (point.anchor1 + point.anchor2));
    let approach = one.velocity(place) - two.velocity(place);
    let arc = (one.arc(place, dt) - two.arc(place, dt)).reject_from_normalized(normal);
    contact.solver_contacts.iter_mut().for_each(|point| point.tangent_velocity += arc);
    let sliding = (approach + mean(contact.solver_contacts, |point| point.tangent_velocity))
        .reject_from_normalized(normal);
    let Some(direction) = sliding.try_normalize() else { return };
    let response = |impulse: DVec3| one.response(impulse, [place; 2]) + two.response(impulse, [place; 2]);
    let yielding = response(direction).reject_from_normalized(normal);
    let along = yielding.dot(direction);
    let before: f64 = contact.manifold.points.iter().map(|point| point.data.impulse).sum();
    let pressing = before.max(approach.dot(normal) / response(normal).dot(normal));
    if *contact.friction * pressing * along < sliding.length() {
        let aside = sliding.length() * (yielding / along - direction);
        contact.solver_contacts.iter_mut().for_each(|point| point.tangent_velocity += aside);
    }
}
