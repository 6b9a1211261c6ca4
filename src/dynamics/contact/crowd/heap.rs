//! Heaps: many touching bodies. Time-stepping advances them from their first event until they rest.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::super::super::{Model, State};
use super::super::closed::Closed;
use super::super::collider::Collider;

/// More touching pairs than this make a heap: finding again and again which of them push and slide takes long.
const PAIRS: usize = 6;

impl Collider {
    /// The heap of some bodies, which touch at some places; none if there is no heap.
    pub(in crate::dynamics) fn heap_of(
        &mut self,
        bodies: &[usize],
        places: &[Arc<Closed>],
        model: &Model,
    ) -> Vec<usize> {
        let heap = heap(bodies, places, model);
        self.crowd.heaps.extend(&heap);
        heap
    }

    /// Adds touching bodies that were advanced as a heap before to the crowd again. Bodies just hit are left out: they
    /// rebound first.
    pub(in crate::dynamics) fn crowd_known_heaps(
        &mut self,
        model: &Model,
        state: &State,
        places: &[Arc<Closed>],
    ) {
        if !is_heap(places) || self.crowd.heaps.is_empty() {
            return;
        }
        let is_known = |body: &usize| self.crowd.heaps.contains(body) && !self.crowd.bodies.contains(body);
        let known: BTreeSet<usize> = places.iter().flat_map(|place| place.bodies).filter(is_known).collect();
        let before = self.crowd.bodies.clone();
        for body in known {
            if !self.crowd.bodies.contains(&body) {
                self.crowd.bodies.extend(heap(&[body], places, model));
            }
        }
        if !model.constraints().is_empty() {
            let all: Vec<usize> = std::mem::take(&mut self.crowd.bodies).into_iter().collect();
            self.gather(model, state, &all);
        }
        self.let_stay(&before);
    }
}

/// Whether the bodies that touch at some places form a heap if they all hold each other. The places are in the order of
/// their bodies.
pub(super) fn is_heap<'a>(places: impl IntoIterator<Item = &'a Arc<Closed>>) -> bool {
    let (mut pairs, mut last) = (0, None);
    for place in places {
        if last != Some(place.bodies) {
            pairs += 1;
            last = Some(place.bodies);
        }
    }
    pairs > PAIRS
}

/// All bodies connected by touches to some bodies, in rising order; none if they are no heap.
fn heap(bodies: &[usize], places: &[Arc<Closed>], model: &Model) -> Vec<usize> {
    if !is_heap(places) {
        return Vec::new();
    }
    let can_move = |body: &usize| model.inverse_mass()[*body] != 0.0;
    let mut all: BTreeSet<usize> = bodies.iter().copied().filter(can_move).collect();
    loop {
        let touching = places.iter().filter(|place| place.bodies.iter().any(|body| all.contains(body)));
        let more: BTreeSet<usize> = touching
            .clone()
            .flat_map(|place| place.bodies)
            .filter(can_move)
            .chain(all.iter().copied())
            .collect();
        if more.len() == all.len() {
            return if is_heap(touching) { all.into_iter().collect() } else { Vec::new() };
        }
        all = more;
    }
}
