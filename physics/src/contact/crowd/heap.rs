//! Heaps: many touching bodies, which Moreau's scheme advances from their first event until they rest.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::super::super::{Model, State};
use super::super::collider::Collider;
use super::super::lasting_contact::LastingContact;

/// The largest number of touching pairs of bodies that are not yet a heap. In a heap, it would take too long to decide repeatedly which of
/// many contacts push and slide.
const MAX_PAIRS_WITHOUT_HEAP: usize = 6;

impl Collider {
    /// Returns the heap that contains some of these bodies, and remembers its members. `places` are the contacts. Empty if there is no
    /// heap.
    pub(crate) fn heap_of(
        &mut self,
        bodies: &[usize],
        places: &[Arc<LastingContact>],
        model: &Model,
    ) -> Vec<usize> {
        let heap = heap(bodies, places, model);
        self.crowd.heaps.extend(&heap);
        heap
    }

    /// Adds touching bodies to the crowd again if they were advanced as a heap before. `places` are the lasting contacts. A body that has just
    /// been hit has no lasting contacts yet, since it rebounds first.
    pub(crate) fn crowd_known_heaps(&mut self, model: &Model, state: &State, places: &[Arc<LastingContact>]) {
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

/// Returns true if contacts connect enough pairs of bodies for a heap. The contacts are in the order of their bodies.
pub(super) fn is_heap<'a>(places: impl IntoIterator<Item = &'a Arc<LastingContact>>) -> bool {
    let (mut pairs, mut last) = (0, None);
    for place in places {
        if last != Some(place.bodies) {
            pairs += 1;
            last = Some(place.bodies);
        }
    }
    pairs > MAX_PAIRS_WITHOUT_HEAP
}

/// Returns all movable bodies that contacts connect with the given bodies, in ascending order. Empty if they form no heap.
fn heap(bodies: &[usize], places: &[Arc<LastingContact>], model: &Model) -> Vec<usize> {
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
