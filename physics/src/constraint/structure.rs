//! The graph of constraints that share bodies, and the order in which a factorization eliminates them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::super::sets::Sets;
use super::{Constraint, Direction};

/// The layout of all constraints in the Jacobian: their rows and their directions. It changes only when bodies or constraints change.
#[derive(Clone, Debug, Default)]
pub(super) struct Structure {
    /// The active constraints, in the order of their elimination.
    pub(super) places: Vec<ConstraintBlock>,
    /// The indices of the bodies of all constraints, each once, in ascending order.
    pub(super) bodies: Vec<usize>,
    /// The total number of rows of all constraints.
    pub(super) rows: usize,
    /// The total number of directions (blocks of the Jacobian) of all constraints: one for each row and each body of its constraint.
    pub(super) directions: usize,
    /// The index of each constraint row's first direction. The last entry is the number of directions.
    pub(super) row_start: Vec<usize>,
    /// The size of the mechanisms, m: the largest lever or radius of gyration of a body that can move. It weighs angles against lengths.
    pub(super) length: f64,
    /// For each constraint, the constraints eliminated before it that share a movable body with it, and the constraint itself as the last
    /// entry.
    pub(super) neighbours: Vec<Vec<Neighbour>>,
    /// The mechanism of each member, if coupled constraints act on it: an index into `mechanisms`.
    pub(super) mechanism_of: Vec<Option<usize>>,
    pub(super) mechanisms: Vec<Mechanism>,
    /// For each member, the rows of the coupled constraints that act on it, in ascending order.
    pub(super) rows_of: Vec<Vec<usize>>,
}

/// Bodies that can move and are connected by coupled constraints.
#[derive(Clone, Debug, Default)]
pub(super) struct Mechanism {
    /// The members of these bodies, in ascending order.
    pub(super) members: Vec<usize>,
    /// The constraint rows that act on them, in ascending order.
    pub(super) rows: Vec<usize>,
}

/// The place of one constraint in the layout: its rows, directions and bodies.
#[derive(Clone, Debug)]
pub(super) struct ConstraintBlock {
    /// The index of the constraint in [`Solver::all`](super::solver::Solver::all): first the constraints of the model, then the contacts.
    pub(super) constraint: usize,
    /// The index of the constraint's first row.
    pub(super) row: usize,
    /// The number of the constraint's rows.
    pub(super) rows: usize,
    /// The index of the constraint's first direction in the Jacobian.
    pub(super) direction: usize,
    /// The bodies of the constraint, as indices into [`Structure::bodies`].
    pub(super) bodies: Vec<usize>,
}

impl ConstraintBlock {
    /// Returns the directions of the constraint in the Jacobian, with their bodies. All entries are zero.
    pub(super) fn directions(&self) -> impl Iterator<Item = Direction> {
        let rows = std::iter::repeat_n(&self.bodies, self.rows);
        rows.flatten().map(|&member| Direction { member, ..Direction::default() })
    }
}

/// A constraint that shares bodies with another one. The matrix J M⁻¹ Jᵀ therefore has blocks that couple the two constraints.
#[derive(Clone, Debug)]
pub(super) struct Neighbour {
    /// The index of the neighboring constraint in the order of elimination.
    pub(super) place: usize,
    /// The shared movable bodies, as pairs of indices: among the bodies of the neighbor, and among those of the constraint itself.
    pub(super) shared: Vec<(usize, usize)>,
}

impl Structure {
    /// Returns the range of a row's directions in the Jacobian.
    #[inline(always)]
    pub(super) fn directions_of(&self, row: usize) -> Range<usize> {
        self.row_start[row]..self.row_start[row + 1]
    }

    /// Returns the constraint to which a row belongs.
    pub(super) fn place_of_row(&self, row: usize) -> Option<&ConstraintBlock> {
        let after = self.places.partition_point(|place| place.row <= row);
        self.places[..after].last().filter(|place| row < place.row + place.rows)
    }

    /// Lays out the constraints whose bodies are all present. A body that no force can move does not couple its constraints. Constraints
    /// for which `is_coupled` is false are coupled to no other.
    pub(super) fn of(
        all: &[Arc<dyn Constraint>],
        is_there: impl Fn(usize) -> bool,
        can_move: impl Fn(usize) -> bool,
        is_coupled: impl Fn(usize) -> bool,
    ) -> Structure {
        let holds =
            |constraint: &Arc<dyn Constraint>| constraint.bodies().iter().all(|id| is_there(id.index()));
        let constraints: Vec<(usize, &Arc<dyn Constraint>)> =
            all.iter().enumerate().filter(|(_, constraint)| holds(constraint)).collect();
        let concerned: Vec<Vec<usize>> = constraints
            .iter()
            .map(|(_, constraint)| constraint.bodies().iter().map(|id| id.index()).collect())
            .collect();
        let mut members = BTreeMap::<usize, Vec<usize>>::new();
        for (i, bodies) in concerned.iter().enumerate() {
            bodies.iter().for_each(|body| members.entry(*body).or_default().push(i));
        }
        let bodies: Vec<usize> = members.keys().copied().collect();
        let number = |body: usize| bodies.partition_point(|&other| other < body);

        let mut structure = Structure { bodies: bodies.clone(), ..Structure::default() };
        let mut graph = vec![BTreeSet::new(); constraints.len()];
        for sharing in members.iter().filter(|(body, _)| can_move(**body)).map(|(_, sharing)| sharing) {
            let coupled: Vec<usize> =
                sharing.iter().copied().filter(|&i| is_coupled(constraints[i].0)).collect();
            for &i in &coupled {
                graph[i].extend(coupled.iter().copied().filter(|&j| j != i));
            }
        }
        let mut place_of = vec![0; constraints.len()];
        let order = elimination(graph.clone());
        for (place, &i) in order.iter().enumerate() {
            place_of[i] = place;
            let (constraint, rows) = (constraints[i].0, constraints[i].1.rows());
            let bodies: Vec<usize> = concerned[i].iter().map(|&body| number(body)).collect();
            let (row, direction) = (structure.rows, structure.directions);
            structure.rows += rows;
            structure.directions += rows * bodies.len();
            for i in 0..rows {
                structure.row_start.push(direction + i * bodies.len());
            }
            structure.places.push(ConstraintBlock { constraint, row, rows, direction, bodies });
        }
        structure.row_start.push(structure.directions);
        for (place, &i) in order.iter().enumerate() {
            let mut before: Vec<usize> = graph[i].iter().map(|&other| place_of[other]).collect();
            before.retain(|&other| other < place);
            before.sort_unstable();
            before.push(place);
            let own = &concerned[i];
            let neighbour = |other: usize| {
                let theirs = &concerned[order[other]];
                let shared = |(i, body): (usize, &usize)| {
                    own.iter().position(|mine| mine == body && can_move(*body)).map(|j| (i, j))
                };
                Neighbour { place: other, shared: theirs.iter().enumerate().filter_map(shared).collect() }
            };
            structure.neighbours.push(before.into_iter().map(neighbour).collect());
        }
        structure.find_mechanisms(&can_move, &is_coupled);
        structure
    }

    /// Groups the bodies that can move and are connected by coupled constraints.
    fn find_mechanisms(&mut self, can_move: impl Fn(usize) -> bool, is_coupled: impl Fn(usize) -> bool) {
        let mut sets = Sets::new(self.bodies.len());
        let moves = |member: &&usize| can_move(self.bodies[**member]);
        let coupled = || self.places.iter().filter(|place| is_coupled(place.constraint));
        for place in coupled() {
            let moving: Vec<usize> = place.bodies.iter().filter(moves).copied().collect();
            moving.windows(2).for_each(|both| sets.unite(both[0], both[1]));
        }
        let mut mechanisms: Vec<Mechanism> = Vec::new();
        let mut of = vec![None; self.bodies.len()];
        for place in coupled() {
            let Some(&first) = place.bodies.iter().find(moves) else { continue };
            let first = sets.first(first);
            let mechanism = *of[first].get_or_insert_with(|| {
                mechanisms.push(Mechanism::default());
                mechanisms.len() - 1
            });
            mechanisms[mechanism].rows.extend(place.row..place.row + place.rows);
        }
        let mut rows_of = vec![Vec::new(); self.bodies.len()];
        for place in coupled() {
            for member in &place.bodies {
                rows_of[*member].extend(place.row..place.row + place.rows);
            }
        }
        for member in 0..self.bodies.len() {
            of[member] = of[sets.first(member)];
            if let Some(mechanism) = of[member] {
                mechanisms[mechanism].members.push(member);
            }
        }
        (self.mechanism_of, self.mechanisms, self.rows_of) = (of, mechanisms, rows_of);
    }
}

/// Returns the nodes of a graph in the order of minimum degree. In this order, the factors of chains and trees are as sparse as the
/// matrix. Source: A. George & J. W. H. Liu, *The evolution of the minimum degree ordering algorithm*, SIAM Review 31 (1989) 1.
fn elimination(mut graph: Vec<BTreeSet<usize>>) -> Vec<usize> {
    let mut queue: BTreeSet<(usize, usize)> =
        graph.iter().enumerate().map(|(node, neighbours)| (neighbours.len(), node)).collect();
    let mut order = Vec::with_capacity(graph.len());
    while let Some((_, node)) = queue.pop_first() {
        order.push(node);
        let neighbours = std::mem::take(&mut graph[node]);
        for &i in &neighbours {
            queue.remove(&(graph[i].len(), i));
            graph[i].remove(&node);
            graph[i].extend(neighbours.iter().copied().filter(|&j| j != i));
            queue.insert((graph[i].len(), i));
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain is eliminated from its ends and a star from its tips, so each node has only one later neighbor.
    #[test]
    fn a_chain_and_a_star_are_eliminated_without_new_edges() {
        let chain = |n: usize| -> Vec<BTreeSet<usize>> {
            (0..n).map(|i| [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < n).collect()).collect()
        };
        let fill = |graph: &[BTreeSet<usize>]| {
            let order = elimination(graph.to_vec());
            let mut place = vec![0; graph.len()];
            order.iter().enumerate().for_each(|(i, &node)| place[node] = i);
            let mut graph = graph.to_vec();
            let mut largest = 0;
            for &node in &order {
                let later: Vec<usize> =
                    graph[node].iter().copied().filter(|&j| place[j] > place[node]).collect();
                largest = largest.max(later.len());
                for &i in &later {
                    graph[i].extend(later.iter().copied().filter(|&j| j != i));
                }
            }
            largest
        };
        assert_eq!(fill(&chain(100)), 1);
        let mut star = vec![BTreeSet::from([0]); 50];
        star[0] = (1..50).collect();
        assert_eq!(fill(&star), 1);
    }
}
