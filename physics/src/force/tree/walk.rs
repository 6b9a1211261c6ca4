//! Sums forces or potentials at the bodies of a tree. Groups of neighbouring bodies traverse the tree of the sources together.

use std::ops::Range;

use glam::DVec3;

use super::kernel::{Kernel, LANES, Lanes, Source};
use super::{Body, MAX_GROUP_BODIES, Tree};
use crate::threads;

/// The number of tree nodes, and of ranges of bodies, that a group collects before it adds their contributions.
const BATCH_SIZE: usize = 64;
/// The number of blocks of [`LANES`] positions that hold a full group.
const BLOCKS_PER_GROUP: usize = MAX_GROUP_BODIES / LANES;

impl Tree {
    /// Returns, for each body of this tree, the sum of the contributions of all bodies of `sources`, in input order. Without `sources`,
    /// the bodies of this tree act on each other. `done` is called with the number of bodies of each completed group.
    ///
    /// The order of a sum depends on the two trees alone, so the bits do not depend on the number of threads.
    pub(super) fn sums<K: Kernel>(
        &self,
        sources: Option<&Tree>,
        softening: f64,
        done: &(impl Fn(usize) + Sync),
    ) -> Vec<K::Sum> {
        let mut by_tree = vec![K::Sum::default(); self.bodies.len()];
        if !self.bodies.is_empty() {
            let each = |bodies: Range<usize>, sums: &mut [K::Sum]| {
                let own = if sources.is_none() { bodies.clone() } else { 0..0 };
                let mut group = Group::<K>::new(&self.bodies[bodies], softening);
                group.walk(sources.unwrap_or(self), &own);
                group.finish(sums);
                done(sums.len());
            };
            self.each_group(0, &mut by_tree, &each);
        }
        let mut as_given = by_tree.clone();
        for (body, sum) in self.bodies.iter().zip(by_tree) {
            as_given[body.number] = sum;
        }
        as_given
    }

    /// Calls `see` for each group within the node `number`, in parallel, with the range of its bodies and the memory for their sums.
    fn each_group<S: Send>(
        &self,
        number: usize,
        sums: &mut [S],
        see: &(impl Fn(Range<usize>, &mut [S]) + Sync),
    ) {
        let node = &self.nodes[number];
        if sums.len() <= MAX_GROUP_BODIES {
            see(node.first..node.end, sums);
            return;
        }
        let first = &self.nodes[number + 1];
        let (left, right) = sums.split_at_mut(first.end - first.first);
        threads::join(|| self.each_group(number + 1, left, see), || self.each_group(first.next, right, see));
    }
}

/// A group of neighbouring bodies, and the sums at their positions.
struct Group<'a, K: Kernel> {
    bodies: &'a [Body],
    low: DVec3,
    high: DVec3,
    at: [[Lanes; 3]; BLOCKS_PER_GROUP],
    sums: [[Lanes; 3]; BLOCKS_PER_GROUP],
    softening: f64,
    kernel: std::marker::PhantomData<K>,
}

impl<K: Kernel> Group<'_, K> {
    fn new(bodies: &[Body], softening: f64) -> Group<'_, K> {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for body in bodies {
            (low, high) = (low.min(body.at), high.max(body.at));
        }
        let mut at = [[[0.0; LANES]; 3]; BLOCKS_PER_GROUP];
        for k in 0..bodies.len().next_multiple_of(LANES) {
            // Lanes beyond the last body repeat that body's position. Their sums are never read.
            let place = bodies[k.min(bodies.len() - 1)].at.to_array();
            for (lanes, place) in at[k / LANES].iter_mut().zip(place) {
                lanes[k % LANES] = place;
            }
        }
        let sums = [[[0.0; LANES]; 3]; BLOCKS_PER_GROUP];
        let softening = softening * softening;
        Group { bodies, low, high, at, sums, softening, kernel: std::marker::PhantomData }
    }

    /// Adds the contributions of a whole tree. If the group belongs to the same tree, `own` is the range of the group's bodies; otherwise
    /// it is empty.
    fn walk(&mut self, tree: &Tree, own: &Range<usize>) {
        if !own.is_empty() {
            self.add_own();
        }
        let (mut far, mut count) = ([Source::default(); BATCH_SIZE], 0);
        let (mut near, mut runs) = ([(0, 0); BATCH_SIZE], 0);
        let mut next = 0;
        while let Some(node) = tree.nodes.get(next) {
            let number = std::mem::replace(&mut next, node.next);
            if node.moments.mass == 0.0 || own.contains(&node.first) && node.end <= own.end {
                continue;
            }
            let centre = node.moments.centre;
            let gap = (self.low - centre).max(centre - self.high).max(DVec3::ZERO);
            if gap.length_squared() > node.opening {
                far[count] = Source::from(&node.moments);
                count += 1;
                if count == BATCH_SIZE {
                    self.add_far(&far);
                    count = 0;
                }
            } else if node.next > number + 1 {
                next = number + 1;
            } else if runs > 0 && near[runs - 1].1 == node.first {
                near[runs - 1].1 = node.end;
            } else {
                if runs == BATCH_SIZE {
                    self.add_near(tree, &near);
                    runs = 0;
                }
                near[runs] = (node.first, node.end);
                runs += 1;
            }
        }
        self.add_far(&far[..count]);
        self.add_near(tree, &near[..runs]);
    }

    /// Adds the contributions of distant nodes, which act as wholes.
    fn add_far(&mut self, nodes: &[Source]) {
        let softening = self.softening;
        for (at, sums) in self.blocks() {
            for node in nodes {
                let (d, square) = way(at, node.centre, softening);
                K::far(node, d, square, sums);
            }
        }
    }

    /// Adds the contributions of near bodies one by one. `runs` holds ranges of bodies of `tree`: for each, the first index and the end.
    fn add_near(&mut self, tree: &Tree, runs: &[(usize, usize)]) {
        let softening = self.softening;
        for (at, sums) in self.blocks() {
            for &(first, end) in runs {
                for body in &tree.bodies[first..end] {
                    let (d, square) = way(at, body.at.into(), softening);
                    K::near(body.mass, d, square, sums);
                }
            }
        }
    }

    /// Adds the contributions of the group's bodies to each other's sums.
    fn add_own(&mut self) {
        let (bodies, softening) = (self.bodies, self.softening);
        for (block, (at, sums)) in self.blocks().enumerate() {
            for (number, body) in bodies.iter().enumerate() {
                let (d, mut square) = way(at, body.at.into(), softening);
                if number / LANES == block {
                    // A body does not act on itself: at an infinite distance, its contribution is zero.
                    square[number % LANES] = f64::INFINITY;
                }
                K::near(body.mass, d, square, sums);
            }
        }
    }

    /// Returns the blocks of positions that hold bodies, with their sums.
    fn blocks(&mut self) -> impl Iterator<Item = (&[Lanes; 3], &mut [Lanes; 3])> {
        self.at.iter().zip(&mut self.sums).take(self.bodies.len().div_ceil(LANES))
    }

    fn finish(&self, sums: &mut [K::Sum]) {
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum = K::sum(&self.sums[k / LANES], k % LANES);
        }
    }
}

/// Returns the vectors from a source to several positions, and their squared lengths plus the squared softening length.
#[inline(always)]
fn way(at: &[Lanes; 3], source: [f64; 3], softening: f64) -> ([Lanes; 3], Lanes) {
    let (mut d, mut square) = ([[0.0; LANES]; 3], [softening; LANES]);
    for k in 0..LANES {
        for axis in 0..3 {
            d[axis][k] = at[axis][k] - source[axis];
        }
        square[k] += d[0][k] * d[0][k] + d[1][k] * d[1][k] + d[2][k] * d[2][k];
    }
    (d, square)
}
