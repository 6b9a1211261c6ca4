//! Lists the pairs of bodies that can touch soon.
//!
//! A list holds the pairs of nearby boxes until a body has moved farther than the margin of its box. Each pair has a
//! lower bound of its gap, reduced by the distances that both move. Only when it is used up, the pair is examined
//! again. Source for the list: L. Verlet, Phys. Rev. 159 (1967) 98.

use glam::DVec3;

use super::super::{Model, State};
use super::path::{Path, pose};
use super::solid::Solid;
use super::{Contacts, Meeting};

/// The margin of boxes, in distances moved per step.
const WAYS: f64 = 8.0;

/// Two bodies that may touch.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// Their numbers, the smaller one first.
    pub(super) bodies: [usize; 2],
    /// The behavior of their surfaces.
    pub(super) law: Meeting,
    /// A lower bound of their gap, m.
    pub(super) free: f64,
}

/// The nearby pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// In the order of the numbers of their bodies.
    pub(super) list: Vec<Pair>,
    /// The distance that each body may still move before the list is rebuilt, m.
    left: Vec<f64>,
    /// The distances that bodies moved in the repeated step, if the list was too short for it, m.
    expected: Vec<f64>,
    is_known: bool,
}

impl Pairs {
    /// Called when bodies have changed: the list must be rebuilt.
    pub(super) fn forget(&mut self) {
        self.is_known = false;
    }

    /// The list, if it contains all pairs whose boxes overlap after adding a margin to each.
    pub(super) fn within(&self, margins: &[f64]) -> Option<&[Pair]> {
        let is_long = self.is_known && margins.iter().zip(&self.left).all(|(margin, left)| margin <= left);
        is_long.then_some(&self.list[..])
    }

    /// The list was too short for these distances, m: it must be rebuilt.
    pub(super) fn expect(&mut self, ways: Vec<f64>) {
        self.expected = ways;
        self.is_known = false;
    }

    /// The contact law of two bodies of the list.
    pub(super) fn law(&self, bodies: [usize; 2]) -> Option<Meeting> {
        let at = self.list.binary_search_by_key(&bodies, |pair| pair.bodies).ok()?;
        Some(self.list[at].law)
    }

    /// Subtracts the distances of a step, and rebuilds the list if it is too short for it.
    pub(super) fn follow(
        &mut self,
        contacts: &Contacts,
        solids: &[Option<Solid>],
        paths: &[Path],
        (model, before): (&Model, &State),
    ) {
        let way = |i: usize| way(solids[i].as_ref(), &paths[i]);
        let is_enough = self.is_known && (0..paths.len()).all(|i| way(i) <= self.left[i]);
        if !is_enough {
            let expected = std::mem::take(&mut self.expected);
            let margins: Vec<f64> = (0..paths.len())
                .map(|i| {
                    let size = solids[i].as_ref().map_or(0.0, Solid::size);
                    let least = expected.get(i).map_or(0.0, |way| 2.0 * way);
                    (WAYS * way(i)).max(least).max(if size.is_finite() { 0.25 * size } else { 0.0 })
                })
                .collect();
            self.list = near(contacts, solids, &margins, (model, before));
            self.left = margins;
            self.is_known = true;
        }
        for (left, i) in self.left.iter_mut().zip(0..) {
            *left -= way(i);
        }
        self.take_ways_off(solids, paths);
    }

    /// Subtracts the distances of a step from the gaps.
    pub(super) fn take_ways_off(&mut self, solids: &[Option<Solid>], paths: &[Path]) {
        let way = |i: usize| way(solids[i].as_ref(), &paths[i]);
        for pair in &mut self.list {
            let [a, b] = pair.bodies;
            pair.free -= way(a) + way(b);
        }
    }

    /// Adds to the expected distances of bodies, m. Returns whether the list is still long enough.
    pub(super) fn go_farther(&mut self, more: &[f64]) -> bool {
        self.left.iter_mut().zip(more).for_each(|(left, more)| *left -= more.max(0.0));
        self.left.iter().all(|left| *left >= 0.0)
    }
}

/// The longest path of a point of a body's core within a step, m.
pub(super) fn way(solid: Option<&Solid>, path: &Path) -> f64 {
    let reach = solid.map_or(0.0, Solid::reach);
    path.reach + if path.turn > 0.0 { path.turn * reach } else { 0.0 }
}

/// All pairs whose boxes overlap after adding a margin to each.
pub(super) fn near(
    contacts: &Contacts,
    solids: &[Option<Solid>],
    margins: &[f64],
    (model, state): (&Model, &State),
) -> Vec<Pair> {
    let mut boxes: Vec<(usize, [DVec3; 2])> = Vec::new();
    for (i, solid) in solids.iter().enumerate() {
        let (Some(solid), true) = (solid, model.is_present(i)) else { continue };
        let [low, high] = solid.bounds(&pose(i, model, state));
        boxes.push((i, [low - margins[i], high + margins[i]]));
    }
    // Swept along the axis of their largest spread.
    let spread = |axis: usize| {
        let ends = boxes.iter().map(|(_, [low, _])| low[axis]).filter(|low| low.is_finite());
        let (least, most) = ends.fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(x), most.max(x)));
        most - least
    };
    let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
    boxes.sort_by(|(i, a), (j, b)| a[0][axis].total_cmp(&b[0][axis]).then(i.cmp(j)));
    let mut pairs = Vec::new();
    for (place, (i, [low, high])) in boxes.iter().enumerate() {
        for (j, [other_low, other_high]) in &boxes[place + 1..] {
            if other_low[axis] > high[axis] {
                break;
            }
            if low.cmple(*other_high).all() && other_low.cmple(*high).all() {
                let bodies = [*i.min(j), *i.max(j)];
                if let Some(law) = law(contacts, bodies, model) {
                    pairs.push(Pair { bodies, law, free: 0.0 });
                }
            }
        }
    }
    pairs.sort_by_key(|pair| pair.bodies);
    pairs
}

/// The contact law of two bodies; none if they do not collide or if forces move neither.
fn law(contacts: &Contacts, bodies: [usize; 2], model: &Model) -> Option<Meeting> {
    let [a, b] = bodies;
    let is_moved = |i: usize| model.can_move(i);
    if !(is_moved(a) || is_moved(b)) || contacts.apart.contains(&(a, b)) {
        return None;
    }
    let surface = |i: usize| contacts.surfaces.get(i).copied().flatten();
    Some(surface(a)?.meet(&surface(b)?))
}
