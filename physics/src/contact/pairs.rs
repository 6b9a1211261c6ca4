//! The list of body pairs that can touch soon.
//!
//! The list holds all pairs whose boxes, enlarged by margins, overlap. It remains valid until a body has moved farther than its margin.
//! Each pair has a lower bound of its gap, which shrinks by the distances that both bodies move. The pair is examined again only when this
//! bound reaches zero. Source for the list: L. Verlet, Phys. Rev. 159 (1967) 98.

use glam::DVec3;

use super::super::{Model, State};
use super::path::{Path, pose};
use super::solid::Solid;
use super::{ContactProperties, Contacts};

/// The margin around the box of a body, as a multiple of the distance that the body moves in a step.
const BOX_MARGIN_FACTOR: f64 = 8.0;

/// Two bodies that may touch soon.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// The indices of the two bodies, the smaller one first.
    pub(super) bodies: [usize; 2],
    /// The restitution and the friction of the two surfaces.
    pub(super) law: ContactProperties,
    /// A lower bound of the gap of the two bodies, m.
    pub(super) free: f64,
}

/// The list of body pairs that can touch soon, and how long it remains valid.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// The pairs, in the order of their bodies' indices.
    pub(super) list: Vec<Pair>,
    /// The distance that each body may still move before the list must be rebuilt, m.
    left: Vec<f64>,
    /// If the list was not valid for a whole step: the distances that the bodies moved in this step, m, which the next list must allow
    /// for.
    expected: Vec<f64>,
    is_known: bool,
}

impl Pairs {
    /// Marks the list as invalid. Must be called when bodies have changed.
    pub(super) fn forget(&mut self) {
        self.is_known = false;
    }

    /// Returns the list if it contains all pairs whose boxes overlap when enlarged by these margins, m.
    pub(super) fn within(&self, margins: &[f64]) -> Option<&[Pair]> {
        let is_long = self.is_known && margins.iter().zip(&self.left).all(|(margin, left)| margin <= left);
        is_long.then_some(&self.list[..])
    }

    /// Marks the list as invalid, because its margins are too small for the distances `ways` that the bodies move, m. The next list will
    /// allow for these distances.
    pub(super) fn expect(&mut self, ways: Vec<f64>) {
        self.expected = ways;
        self.is_known = false;
    }

    /// Returns the restitution and friction of two bodies; `None` if the pair is not in the list.
    pub(super) fn law(&self, bodies: [usize; 2]) -> Option<ContactProperties> {
        let at = self.list.binary_search_by_key(&bodies, |pair| pair.bodies).ok()?;
        Some(self.list[at].law)
    }

    /// Subtracts the distances moved in a step from the gaps and margins. Rebuilds the list first if its margins are too small for this
    /// step.
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
                    (BOX_MARGIN_FACTOR * way(i)).max(least).max(if size.is_finite() {
                        0.25 * size
                    } else {
                        0.0
                    })
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

    /// Subtracts the distances that the bodies move in a step from the lower bounds of the gaps.
    pub(super) fn take_ways_off(&mut self, solids: &[Option<Solid>], paths: &[Path]) {
        let way = |i: usize| way(solids[i].as_ref(), &paths[i]);
        for pair in &mut self.list {
            let [a, b] = pair.bodies;
            pair.free -= way(a) + way(b);
        }
    }

    /// Subtracts from the margins the further distances `more` that the bodies have moved, m. Returns true if the list is still valid.
    pub(super) fn go_farther(&mut self, more: &[f64]) -> bool {
        self.left.iter_mut().zip(more).for_each(|(left, more)| *left -= more.max(0.0));
        self.left.iter().all(|left| *left >= 0.0)
    }
}

/// Returns an upper bound of the distance that any point of a body's core moves within a step, m.
pub(super) fn way(solid: Option<&Solid>, path: &Path) -> f64 {
    let reach = solid.map_or(0.0, Solid::reach);
    path.reach + if path.turn > 0.0 { path.turn * reach } else { 0.0 }
}

/// Returns all pairs of bodies whose boxes overlap when enlarged by a margin for each body, m.
pub(super) fn near(
    contacts: &Contacts,
    solids: &[Option<Solid>],
    margins: &[f64],
    (model, state): (&Model, &State),
) -> Vec<Pair> {
    let mut pairs = Vec::new();
    sweep(
        solids,
        |i| margins[i],
        (model, state),
        |bodies| {
            if let Some(law) = law(contacts, bodies, model) {
                pairs.push(Pair { bodies, law, free: 0.0 });
            }
            true
        },
    );
    pairs.sort_by_key(|pair| pair.bodies);
    pairs
}

/// The number of overlapping pairs per body after which the search for overlaps ends. Without an overlap, the number of pairs whose boxes
/// overlap is proportional to the number of bodies.
const MAX_OVERLAPS_PER_BODY: usize = 8;

/// Finds pairs of bodies that overlap and do not pass through each other. `depth` returns the overlap of a pair of near bodies, m, or
/// `None`. Returns all such pairs, in no special order, and false; or, if there are very many, some of them and true. So many bodies in one
/// place take time and memory in proportion to their number.
pub(super) fn overlapping(
    contacts: &Contacts,
    solids: &[Option<Solid>],
    (model, state): (&Model, &State),
    depth: impl Fn([usize; 2]) -> Option<f64>,
) -> (Vec<([usize; 2], f64)>, bool) {
    let most = MAX_OVERLAPS_PER_BODY * solids.iter().flatten().count().max(MAX_OVERLAPS_PER_BODY);
    let mut found = Vec::new();
    sweep(
        solids,
        |_| 0.0,
        (model, state),
        |bodies| {
            let depth = law(contacts, bodies, model).and_then(|_| depth(bodies));
            found.extend(depth.map(|depth| (bodies, depth)));
            found.len() < most
        },
    );
    let is_crowded = found.len() >= most;
    (found, is_crowded)
}

/// Calls `show` for each pair of present bodies whose boxes overlap when enlarged by a margin for each body, m, the smaller index first.
/// Ends when `show` returns false.
fn sweep(
    solids: &[Option<Solid>],
    margin: impl Fn(usize) -> f64,
    (model, state): (&Model, &State),
    mut show: impl FnMut([usize; 2]) -> bool,
) {
    let mut boxes: Vec<(usize, [DVec3; 2])> = Vec::new();
    for (i, solid) in solids.iter().enumerate() {
        let (Some(solid), true) = (solid, model.is_present(i)) else { continue };
        let [low, high] = solid.bounds(&pose(i, model, state));
        boxes.push((i, [low - margin(i), high + margin(i)]));
    }
    // The boxes are swept along the axis on which they are spread the most.
    let spread = |axis: usize| {
        let ends = boxes.iter().map(|(_, [low, _])| low[axis]).filter(|low| low.is_finite());
        let (least, most) = ends.fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(x), most.max(x)));
        most - least
    };
    let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
    boxes.sort_by(|(i, a), (j, b)| a[0][axis].total_cmp(&b[0][axis]).then(i.cmp(j)));
    for (place, (i, [low, high])) in boxes.iter().enumerate() {
        for (j, [other_low, other_high]) in &boxes[place + 1..] {
            if other_low[axis] > high[axis] {
                break;
            }
            let is_near = low.cmple(*other_high).all() && other_low.cmple(*high).all();
            if is_near && !show([*i.min(j), *i.max(j)]) {
                return;
            }
        }
    }
}

/// Returns the restitution and friction of two bodies. `None` if they pass through each other or if neither can move.
fn law(contacts: &Contacts, bodies: [usize; 2], model: &Model) -> Option<ContactProperties> {
    let [a, b] = bodies;
    let is_moved = |i: usize| model.can_move(i);
    if !(is_moved(a) || is_moved(b)) || contacts.apart.contains(&(a, b)) {
        return None;
    }
    let surface = |i: usize| contacts.surfaces.get(i).copied().flatten();
    Some(surface(a)?.meet(&surface(b)?))
}
