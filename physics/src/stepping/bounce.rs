//! Impacts with restitution.
//!
//! The physics engine gives the points of a contact their velocities of separation one after the other, in a single pass. This is right for
//! one point. With four points, a cylinder that falls flat would gain energy and begin to spin. So when an impact begins, a single point
//! replaces all points: the centre of pressure, where one impulse has the same effect as the impulses at all points together.
//!
//! The engine limits friction by the normal impulse before restitution, which is too small by the factor 1 + e. So the coefficient of
//! friction gets this factor when an impact begins.
//!
//! If bodies meet only in the next step, the engine begins their impact already in this step. The normal impulse before restitution is then
//! too small, by a part that depends on the gap, and so is friction. So the points of such a contact are left out until the bodies meet in the
//! present step.
//!
//! If a joint holds one of the bodies, the rebound comes in the next step; see [`super::rebound`].

use glam::DVec3;
use rapier3d_f64::prelude::{ContactModificationContext, SolverContact};

use super::contact_body::ContactBody;
use super::rebound::Rebounds;

/// The number of sweeps over the points of a contact that find their impulses.
const IMPULSE_SWEEPS: usize = 100;

/// Corrects contacts in which an impact with restitution begins.
pub(super) struct Bounce<'a> {
    pub(super) rebounds: &'a Rebounds,
    /// The length of the step, s.
    pub(super) dt: f64,
    /// Bodies that approach more slowly than this are at rest, m/s.
    pub(super) slow: f64,
}

/// The engine stops the points of a contact early: those that would meet the other body in this step, and those that would meet it in the next
/// step. So a point meets the other body if this multiple of its path takes it there. The factor also covers rounding errors.
const PATH_REACH_FACTOR: f64 = 2.001;

impl Bounce<'_> {
    /// Corrects a contact of two bodies if an impact with restitution begins there.
    pub(super) fn modify(&self, context: &mut ContactModificationContext<'_>, touching: [usize; 2]) {
        let bodies = context.bodies;
        let sides = [context.rigid_body1, context.rigid_body2]
            .map(|body| bodies.get(body?).map(|body| ContactBody::new(body, self.dt)));
        let (Some(contact), [Some(one), Some(two)]) = (context.rigid_mut(), sides) else { return };
        let (restitution, normal) = (*contact.restitution, *contact.normal);
        let is_delayed = self.rebounds.is_delayed(touching);
        if is_delayed {
            *contact.restitution = 0.0;
        }
        let is_new = contact.manifold.points.iter().all(|point| point.data.impulse == 0.0);
        let place = |point: &SolverContact| 0.5 * (point.anchor1 + point.anchor2);
        let approach =
            |point: &SolverContact| (one.velocity(place(point)) - two.velocity(place(point))).dot(normal);
        // A contact keeps the impulse of an impact while the bodies move apart, and the engine would begin the step with that impulse.
        let leaves = |point: &SolverContact| point.dist > approach(point) * self.dt;
        if *contact.user_data != 0 && contact.solver_contacts.iter().all(leaves) {
            contact.solver_contacts.clear();
            return;
        }
        if restitution <= 0.0 || !is_new {
            return;
        }
        let meets = |point: &SolverContact| {
            let approach = approach(point);
            approach > self.slow && point.dist < PATH_REACH_FACTOR * approach * self.dt
        };
        // If no point meets the other body in this step, the points that meet it in the next step are left out for now.
        let waits = |point: &SolverContact| meets(point) && leaves(point);
        if !contact.solver_contacts.iter().any(|point| meets(point) && !waits(point)) {
            contact.solver_contacts.retain(|point| !waits(point));
            return;
        }
        let meeting: Vec<SolverContact> =
            contact.solver_contacts.iter().copied().filter(|point| meets(point)).collect();
        let Some(first) = meeting.first() else { return };
        *contact.friction *= 1.0 + restitution;
        if is_delayed {
            *contact.user_data = self.rebounds.mark();
            return;
        }
        if meeting.len() == 1 {
            return;
        }
        let response = |i: usize, j: usize| {
            let places = [place(&meeting[i]), place(&meeting[j])];
            (one.response(normal, places) + two.response(normal, places)).dot(normal)
        };
        let impulses = impulses(&meeting.iter().map(approach).collect::<Vec<_>>(), response);
        let total: f64 = impulses.iter().sum();
        let mut centre = *first;
        (centre.anchor1, centre.anchor2, centre.dist) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for (point, impulse) in meeting.iter().zip(&impulses) {
            let weight = impulse / total;
            centre.anchor1 += weight * point.anchor1;
            centre.anchor2 += weight * point.anchor2;
            centre.dist += weight * point.dist;
        }
        contact.solver_contacts.retain(|point| !meets(point));
        contact.solver_contacts.insert(0, centre);
    }
}

/// Returns the impulses at the points of a contact that stop the approach there. `approach` holds the velocity of approach at each point.
/// `response` returns the velocity at the first point that a unit impulse at the second point causes. No impulse is negative: a point at
/// which the bodies separate without an impulse gets none, nor does a point at which no impulse has an effect. Source: the projected Gauss–Seidel method, K. Erleben, *Numerical methods for
/// linear complementarity problems in physics-based animation*, SIGGRAPH 2013.
pub(super) fn impulses(approach: &[f64], response: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let mut impulses = vec![0.0; approach.len()];
    for _ in 0..IMPULSE_SWEEPS {
        for i in 0..approach.len() {
            let stopped: f64 = impulses.iter().enumerate().map(|(j, impulse)| impulse * response(i, j)).sum();
            let own = response(i, i);
            if own > 0.0 {
                impulses[i] = (impulses[i] + (approach[i] - stopped) / own).max(0.0);
            }
        }
    }
    impulses
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two points approach at 2 m/s and 1 m/s, and each responds to its own impulse only.
    #[test]
    fn a_point_that_cannot_move_gets_no_impulse() {
        let response =
            |inverse_masses: [f64; 2]| move |i: usize, j: usize| if i == j { inverse_masses[i] } else { 0.0 };
        assert_eq!(impulses(&[2.0, 1.0], response([0.5, 4.0])), [4.0, 0.25]);
        assert_eq!(impulses(&[2.0, 1.0], response([0.0, 4.0])), [0.0, 0.25]);
    }
}
