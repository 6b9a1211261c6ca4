//! Groups of bodies that cannot meet within a step, so each group can be advanced separately.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::super::sets::Sets;
use super::super::{Model, State};
use super::approach::Approach;
use super::closest_points::nearest;
use super::collider::{CONTACT_TOLERANCE, Collider, ContactScale, SPEED_ROUNDING, is_passive};
use super::crowd::Crowd;
use super::lasting_contact::LastingContact;
use super::laws::LawBook;
use super::pairs::{Pair, way};
use super::path::{Path, pose};

/// Two bodies belong to the same group if they could meet by moving this many times as far as they move in the step without impacts. The
/// margin is needed because impacts can make bodies faster.
const PATH_MARGIN_FACTOR: f64 = 2.0;

/// A group of bodies that may meet each other within a step, but no movable body of another group.
pub(crate) struct Group {
    /// The indices of the group's bodies, in ascending order.
    pub(crate) bodies: Vec<usize>,
    /// True if bodies of the group touch, now or within the step.
    pub(crate) is_busy: bool,
    pairs: Vec<Pair>,
}

/// The division of all movable bodies into groups for one step, with the data that is needed to repeat the step.
pub(crate) struct Parting {
    pub(crate) groups: Vec<Group>,
    /// The pairs whose two bodies belong to different groups.
    between: Vec<Pair>,
    /// The distance that each body moves in the step without impacts, m. `taken` is the distance that each body has really moved, m.
    free: Vec<f64>,
    taken: Vec<f64>,
    /// The number of impacts before the step. `crowd` is the crowd before the step.
    impacts: usize,
    crowd: Crowd,
    /// The record of the laws before the step.
    laws: LawBook,
}

/// The group of bodies that is being advanced, while the other groups wait.
#[derive(Clone, Default)]
pub(super) struct Focus {
    pub(super) bodies: Vec<usize>,
    /// The distance that each body of the group has moved in this step, m.
    taken: Vec<f64>,
    /// The bodies of other groups that are in the crowd. They are set aside meanwhile.
    others: BTreeSet<usize>,
}

impl Sets {
    /// Merges the sets of two bodies, if both bodies can move.
    fn unite_moving(&mut self, [a, b]: [usize; 2], model: &Model) {
        if model.can_move(a) && model.can_move(b) {
            self.unite(a, b);
        }
    }

    /// Returns true if two movable bodies are already in the same set, or if one of the two cannot move.
    fn are_one(&mut self, [a, b]: [usize; 2], model: &Model) -> bool {
        !(model.can_move(a) && model.can_move(b)) || self.first(a) == self.first(b)
    }
}

impl Collider {
    /// Divides the bodies into groups for a step of `duration` seconds. `after` is the state at the end of the step without any impacts.
    /// `held` are sets of bodies that are held at rest together. The two bodies of each pair in `met` are in the same group in any case.
    pub(crate) fn part<'a>(
        &mut self,
        model: &Model,
        (before, after): (&State, &State),
        duration: f64,
        closed: &[Arc<LastingContact>],
        held: impl Iterator<Item = &'a BTreeSet<usize>>,
        met: &[[usize; 2]],
    ) -> Parting {
        self.follow(model, (before, after), duration);
        let Collider { solids, pairs, paths, fastest, crowd, .. } = self;
        let free: Vec<f64> = (0..model.len()).map(|i| way(solids[i].as_ref(), &paths[i])).collect();
        let mut sets = Sets::new(model.len());
        let mut is_busy = vec![false; model.len()];
        for island in held {
            island.iter().zip(island.iter().skip(1)).for_each(|(&a, &b)| sets.unite(a, b));
        }
        met.iter().for_each(|pair| sets.unite_moving(*pair, model));
        crowd.bodies().for_each(|&body| is_busy[body] = true);
        for contact in closed {
            sets.unite_moving(contact.bodies, model);
            contact.bodies.iter().for_each(|&body| is_busy[body] = true);
        }
        for pair in &mut pairs.list {
            let [a, b] = pair.bodies;
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { continue };
            if is_passive(pair.bodies, model) {
                continue;
            }
            let (ways, scale) = (free[a] + free[b], ContactScale::of(pair.bodies, [x, y], (model, before)));
            let touch = scale.tolerance(CONTACT_TOLERANCE);
            let meet = touch + (PATH_MARGIN_FACTOR - 1.0) * ways;
            let is_settled = |body: usize| is_busy[body] || !model.can_move(body);
            if pair.free > meet || is_settled(a) && is_settled(b) && sets.are_one([a, b], model) {
                continue;
            }
            let poses = [a, b].map(|i| pose(i, model, before));
            let Some(near) = nearest(x, &poses[0], y, &poses[1], f64::INFINITY) else { continue };
            pair.free = near.gap - ways;
            if pair.free <= meet {
                sets.unite_moving(pair.bodies, model);
            }
            if pair.free > touch || is_busy[a] && is_busy[b] {
                continue;
            }
            let speed = (before.velocity[b] - before.velocity[a]).length();
            let slight = 2.0 * SPEED_ROUNDING * fastest.max(speed);
            let approach =
                Approach { solids: [x, y], paths: [&paths[a], &paths[b]], slight, touch: scale.touch() };
            if approach.first(duration).is_some() {
                (is_busy[a], is_busy[b]) = (true, true);
            }
        }
        let mut groups: Vec<Group> = Vec::new();
        let mut group_of: Vec<Option<usize>> = vec![None; model.len()];
        for body in (0..model.len()).filter(|&body| model.can_move(body)) {
            let first = sets.first(body);
            let group = *group_of[first].get_or_insert_with(|| {
                groups.push(Group { bodies: Vec::new(), is_busy: false, pairs: Vec::new() });
                groups.len() - 1
            });
            group_of[body] = Some(group);
            groups[group].bodies.push(body);
            groups[group].is_busy |= is_busy[body];
        }
        let mut between = Vec::new();
        for pair in &pairs.list {
            match pair.bodies.map(|body| group_of[body]) {
                [Some(a), Some(b)] if a != b => between.push(pair.clone()),
                [Some(group), _] | [_, Some(group)] => groups[group].pairs.push(pair.clone()),
                [None, None] => {}
            }
        }
        let (impacts, crowd, laws) = (self.impacts.len(), self.crowd.without_course(), self.laws.clone());
        Parting { groups, between, taken: free.clone(), free, impacts, crowd, laws }
    }

    /// Restricts the collider to one group, which is advanced next.
    pub(crate) fn focus(&mut self, group: &mut Group) {
        self.pairs.list = std::mem::take(&mut group.pairs);
        let (bodies, taken) = (group.bodies.clone(), vec![0.0; group.bodies.len()]);
        let others = self.crowd.focus(&bodies);
        self.focus = Some(Focus { bodies, taken, others });
    }

    /// Records how far the bodies of the group have moved in a piece of the step that took `duration` seconds.
    pub(crate) fn note_ways(&mut self, model: &Model, before: &State, after: &State, duration: f64) {
        let Some(Focus { bodies, taken, .. }) = self.focus.as_mut().filter(|_| duration > 0.0) else {
            return;
        };
        for (&i, taken) in bodies.iter().zip(taken) {
            *taken += way(self.solids[i].as_ref(), &Path::of(i, model, before, after, duration));
        }
    }

    /// Ends the restriction to a group, after this group has been advanced. Stores in `parting_ways` the distances that the group's bodies
    /// have moved, m.
    pub(crate) fn unfocus(&mut self, group: &mut Group, parting_ways: &mut [f64]) {
        let Some(Focus { bodies, taken, others }) = self.focus.take() else { return };
        self.crowd.unfocus(others);
        group.pairs = std::mem::take(&mut self.pairs.list);
        bodies.iter().zip(taken).for_each(|(&i, taken)| parting_ways[i] = taken);
    }

    /// Combines the groups after all of them have been advanced.
    ///
    /// # Errors
    ///
    /// If bodies of two groups may have met. The collider is then restored so that the step can be repeated, and the error lists the pairs
    /// that may have met, as far as they are known.
    pub(crate) fn unite(
        &mut self,
        model: &Model,
        state: &State,
        mut parting: Parting,
    ) -> Result<(), Vec<[usize; 2]>> {
        let more: Vec<f64> =
            parting.taken.iter().zip(&parting.free).map(|(taken, free)| taken - free).collect();
        let is_enough = self.pairs.go_farther(&more);
        let mut met = Vec::new();
        let Collider { solids, pairs, .. } = self;
        for pair in &mut parting.between {
            let [a, b] = pair.bodies;
            pair.free -= more[a] + more[b];
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { continue };
            let touch = ContactScale::of(pair.bodies, [x, y], (model, state)).tolerance(CONTACT_TOLERANCE);
            if !is_passive(pair.bodies, model) && pair.free <= touch {
                met.push(pair.bodies);
            }
        }
        let groups = parting.groups.into_iter().flat_map(|group| group.pairs);
        pairs.list = parting.between.into_iter().chain(groups).collect();
        pairs.list.sort_by_key(|pair| pair.bodies);
        if is_enough && met.is_empty() {
            self.impacts[parting.impacts..].sort_by(|a, b| a.time.total_cmp(&b.time));
            return Ok(());
        }
        self.impacts.truncate(parting.impacts);
        self.pairs.expect(parting.taken);
        (self.crowd, self.laws) = (parting.crowd, parting.laws);
        Err(met)
    }
}

impl Parting {
    /// Returns the groups with contacts in this step, and the distance that each body has moved, m.
    pub(crate) fn busy(&mut self) -> (impl Iterator<Item = &mut Group>, &mut [f64]) {
        (self.groups.iter_mut().filter(|group| group.is_busy), &mut self.taken)
    }
}
