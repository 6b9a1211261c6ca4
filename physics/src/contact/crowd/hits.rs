//! Adds bodies to the crowd at the beginning of a step if they may hit it within the step.

use super::super::super::{Model, State};
use super::super::closest_points::nearest;
use super::super::collider::Collider;
use super::super::pairs::{Pair, near};
use super::super::path::pose;

/// The largest number of bodies in a small crowd. Each hit of a small crowd by another body is found at its exact time. The crowd's motion
/// is then computed again, at little cost.
const SMALL_CROWD_BODIES: usize = 6;

/// Bodies join a crowd if they could reach it by moving this many times as far as they move in a step at their present speed, plus
/// [`SIZE_MARGIN_FRACTION`] times their size. The margin is needed because impacts can make bodies faster within a step.
const PATH_MARGIN_FACTOR: f64 = 2.0;
/// The part of the margin that does not depend on speed, as a fraction of the body's size.
const SIZE_MARGIN_FRACTION: f64 = 0.02;

impl Collider {
    /// Adds bodies that may hit the crowd within `dt` seconds, then bodies that may hit these, and so on. The motion of a large crowd is then
    /// computed once in a step, not after each hit.
    pub(super) fn expect_hits(&mut self, model: &Model, state: &State, dt: f64) {
        if self.crowd.bodies.len() <= SMALL_CROWD_BODIES {
            return;
        }
        let way = |i: usize| {
            let Some(solid) = self.solids[i].as_ref().filter(|solid| solid.reach().is_finite()) else {
                return 0.0;
            };
            let speed =
                state.velocity[i].length() + model.angular_velocity(i, state).length() * solid.reach();
            PATH_MARGIN_FACTOR * speed * dt + SIZE_MARGIN_FRACTION * solid.size()
        };
        let ways: Vec<f64> = (0..self.solids.len()).map(way).collect();
        let mut pairs = match self.pairs.within(&ways) {
            Some(known) => known.to_vec(),
            None => near(&self.contacts, &self.solids, &ways, (model, state)),
        };
        // Bodies of other groups are not advanced at present.
        let is_here =
            |body: &usize| self.focus.as_ref().is_none_or(|focus| focus.bodies.binary_search(body).is_ok());
        let can_move = |body: &usize| model.inverse_mass()[*body] != 0.0;
        pairs.retain(|pair| pair.bodies.iter().all(|body| is_here(body) && can_move(body)));
        loop {
            let is_in = |body: &usize| self.crowd.bodies.contains(body);
            // `halves` are pairs with one body in the crowd, `others` pairs with none.
            let (halves, others): (Vec<Pair>, Vec<Pair>) = pairs
                .into_iter()
                .filter(|pair| !pair.bodies.iter().all(is_in))
                .partition(|pair| pair.bodies.iter().any(is_in));
            let new: Vec<usize> = halves
                .iter()
                .filter(|pair| self.can_meet(pair, model, state, &ways))
                .flat_map(|pair| pair.bodies)
                .collect();
            if new.is_empty() {
                return;
            }
            self.crowd.bodies.extend(new);
            pairs = others;
        }
    }

    /// Returns true if two bodies can close the gap between them. `ways` holds the distance that each body can move, m.
    fn can_meet(&self, pair: &Pair, model: &Model, state: &State, ways: &[f64]) -> bool {
        let [Some(x), Some(y)] = pair.bodies.map(|body| self.solids[body].as_ref()) else { return false };
        let [p, q] = pair.bodies.map(|body| pose(body, model, state));
        let within = ways[pair.bodies[0]] + ways[pair.bodies[1]];
        nearest(x, &p, y, &q, f64::INFINITY).is_some_and(|near| near.gap <= within)
    }
}
