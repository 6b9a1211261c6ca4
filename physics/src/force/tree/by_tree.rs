//! Forces and potential of pairs of bodies, computed by Barnes–Hut trees.

use super::super::super::BodyId;
use super::super::pairs::Pairs;
use super::super::{Loads, Moment};
use super::{Potential, Pull, Tree};

/// Computes the sums of [`Pairs`] by trees. All strengths must have the same sign, because nodes are expanded about their centres of mass.
pub(in super::super) struct ByTree<'a> {
    /// The bodies and their force law.
    pub(in super::super) pairs: Pairs<'a>,
    /// The opening angle: the largest ratio of size to distance at which a node acts as a whole.
    pub(in super::super) angle: f64,
    /// The number of interactions that the progress counter counts for each body.
    pub(in super::super) each: u64,
}

impl ByTree<'_> {
    /// Adds the forces on all bodies to the loads.
    pub(in super::super) fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let counter = moment.model.pair_counter();
        let done = |bodies: usize| counter.add(bodies * self.each as usize);
        let mut pull = |bodies: &[BodyId], tree: &Tree, sources: Option<&Tree>| {
            let pulls = tree.sums::<Pull>(sources, self.pairs.softening, &done);
            for (body, pull) in bodies.iter().zip(pulls) {
                let i = body.index();
                loads.force[i] += self.pairs.constant * self.pairs.strength[i] * pull;
            }
        };
        let bodies = moment.model.present(self.pairs.bodies);
        let tree = self.tree(&bodies, moment);
        let Some(against) = self.pairs.against else { return pull(&bodies, &tree, None) };
        let against = moment.model.present(against);
        let others = self.tree(&against, moment);
        pull(&bodies, &tree, Some(&others));
        pull(&against, &others, Some(&tree));
    }

    /// Returns the potential energy of all pairs in which at least one body can move, J.
    pub(in super::super) fn potential(&self, moment: &Moment) -> f64 {
        let counter = moment.model.pair_counter();
        let done = |bodies: usize| counter.add(bodies * self.each as usize);
        let movable = |bodies: &[BodyId]| -> (Vec<BodyId>, Vec<BodyId>) {
            let present = moment.model.present(bodies);
            present.iter().partition(|body| moment.model.movable()[body.index()])
        };
        // The sum Σ sᵢ φᵢ over `bodies`, where φ is the potential of `others`, or that of `bodies` themselves if `others` is `None`.
        let sum = |bodies: &[BodyId], others: Option<&[BodyId]>, done: &(dyn Fn(usize) + Sync)| -> f64 {
            let others = others.map(|others| self.tree(others, moment));
            let sums =
                self.tree(bodies, moment).sums::<Potential>(others.as_ref(), self.pairs.softening, &done);
            bodies.iter().zip(sums).map(|(body, sum)| self.pairs.strength[body.index()] * sum).sum()
        };
        let (free, held) = movable(self.pairs.bodies);
        let total = match self.pairs.against {
            None => 0.5 * sum(&free, None, &done) + sum(&held, Some(&free), &done),
            Some(against) => {
                let (their_free, their_held) = movable(against);
                let theirs = [their_free.as_slice(), their_held.as_slice()].concat();
                // The progress counter must count the bodies of the other group as well, although no sum runs over them.
                counter.add(theirs.len() * self.each as usize);
                sum(&free, Some(&theirs), &done) + sum(&held, Some(&their_free), &done)
            }
        };
        self.pairs.constant * total
    }

    /// Adds the share of each body in the potential energy to `shares`, J.
    pub(in super::super) fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        let model = moment.model;
        // The bodies that forces move, those with given motions, and fixed ones.
        let by_kind = |bodies: &[BodyId]| -> [Vec<BodyId>; 3] {
            let mut kinds = [Vec::new(), Vec::new(), Vec::new()];
            for body in model.present(bodies).iter() {
                let (can_move, movable) = (model.can_move(body.index()), model.movable()[body.index()]);
                kinds[if can_move { 0 } else { 2 - usize::from(movable) }].push(*body);
            }
            kinds
        };
        // Adds a part of the potential of `others` (of the bodies themselves for `None`) to the shares of `bodies`.
        let mut add = |part: f64, bodies: &[BodyId], others: Option<&[BodyId]>| {
            let others = others.map(|others| self.tree(others, moment));
            let tree = self.tree(bodies, moment);
            let sums = tree.sums::<Potential>(others.as_ref(), self.pairs.softening, &|_| {});
            for (body, sum) in bodies.iter().map(|body| body.index()).zip(sums) {
                shares[body] += part * self.pairs.constant * self.pairs.strength[body] * sum;
            }
        };
        let [free, guided, fixed] = by_kind(self.pairs.bodies);
        match self.pairs.against {
            None => {
                add(0.5, &free, None);
                add(0.5, &guided, None);
                add(1.0, &free, Some(&[guided.as_slice(), &fixed].concat()));
                add(1.0, &guided, Some(&fixed));
            }
            Some(against) => {
                let [their_free, their_guided, their_fixed] = by_kind(against);
                add(0.5, &free, Some(&their_free));
                add(0.5, &their_free, Some(&free));
                add(1.0, &free, Some(&[their_guided.as_slice(), &their_fixed].concat()));
                add(1.0, &their_free, Some(&[guided.as_slice(), &fixed].concat()));
                add(0.5, &guided, Some(&their_guided));
                add(0.5, &their_guided, Some(&guided));
                add(1.0, &guided, Some(&their_fixed));
                add(1.0, &their_guided, Some(&fixed));
            }
        }
    }

    fn tree(&self, bodies: &[BodyId], moment: &Moment) -> Tree {
        let body = |body: &BodyId| {
            let i = body.index();
            (moment.state.location[i], self.pairs.strength[i])
        };
        Tree::new(bodies.iter().map(body), self.angle)
    }
}
