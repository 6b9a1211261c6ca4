//! The sparse factorization A = L D Lᵀ of a symmetric matrix, row by row.
//!
//! Source: T. A. Davis, *Algorithm 849: a concise sparse Cholesky factorization package*, ACM TOMS 31 (2005) 587. No crate is used, for
//! two reasons. Redundant and inactive rows must be left out at run time. And the order of the sums must not depend on the processor.

use std::collections::BTreeMap;
use std::ops::Range;

use super::structure::Structure;
use super::{Direction, Member};

/// A constraint row counts as redundant (implied by other rows) if its pivot is below this fraction of its diagonal entry. The pivot is the
/// response of the row to a unit impulse while the other rows hold. A smaller pivot is only a rounding error.
pub(crate) const PIVOT_TOLERANCE: f64 = 1e-11;

/// A symmetric matrix and its L D Lᵀ factors, with fixed sparsity patterns.
#[derive(Clone, Debug, Default)]
pub(super) struct Factor {
    lines: Vec<Line>,
    /// The entries of the matrix on and above the diagonal, column by column.
    matrix: Vec<Entry>,
    /// For each direction of the Jacobian, the index of its first coupling in `couplings`. The last entry is the number of couplings.
    coupling_start: Vec<usize>,
    couplings: Vec<Coupling>,
    /// The positions of the entries of L, row by row. Within a row, an entry precedes the entries that depend on it.
    crossings: Vec<Crossing>,
    /// The entries of L below the diagonal, column by column.
    lower: Vec<Entry>,
    /// The diagonal of D⁻¹; 0 for constraint rows that are left out.
    inverse: Vec<f64>,
    /// For each soft constraint row (see [`RELATIVE_SOFTNESS`]), the row that is softened by the same amount; `None` for other rows. A
    /// normal row is paired with itself. The two tangents of a contact are paired with each other, so the result does not depend on their
    /// directions.
    soft: Vec<Option<usize>>,
    /// The softness of each soft constraint row, relative to the standard value [`RELATIVE_SOFTNESS`]: a row with weight 2 yields twice as
    /// much.
    weights: Vec<f64>,
    /// Working memory, one entry per matrix row. All entries are zero between two factorizations.
    work: Vec<f64>,
}

/// Where the entries of one row of the matrix and of its factors are stored.
#[derive(Clone, Debug)]
struct Line {
    /// The column of the matrix with this row's index, as a range of `Factor::matrix`.
    column: Range<usize>,
    /// The row of the factor L, as a range of `Factor::crossings`.
    crossings: Range<usize>,
    /// The column of the factor L with this row's index, as a range of `Factor::lower`.
    below: Range<usize>,
}

/// An entry of a column of a sparse matrix: the index of its row, and its value.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    row: usize,
    value: f64,
}

/// A product that contributes to an entry of the matrix J M⁻¹ Jᵀ: it couples two directions of the same body, one in the row of the
/// entry's column and one in an earlier row.
#[derive(Clone, Copy, Debug)]
struct Coupling {
    /// The index of the matrix entry in `Factor::matrix`.
    entry: usize,
    /// The index of the earlier row's direction in the Jacobian.
    other: usize,
}

/// The position of an entry of the factor L within its row.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    column: usize,
    /// The index in `Factor::lower` at which the entry's column starts.
    first: usize,
    /// The index of the entry in `Factor::lower`.
    at: usize,
}

/// The softness of soft constraint rows. The diagonal entry of a soft row grows by this fraction of the mean of its own and its partner's
/// diagonal entries. Redundant rows can then all be active, and share the load with the smallest sum of squares. Iterative refinement
/// removes the remaining error.
const RELATIVE_SOFTNESS: f64 = 1e-7;

/// Stands for the index of a column where there is none.
const NO_INDEX: usize = usize::MAX;

/// Returns the largest singular value of a 2 × 2 matrix.
fn norm([[a, b], [c, d]]: [[f64; 2]; 2]) -> f64 {
    let (even, odd) = (libm::hypot(a + d, b - c), libm::hypot(a - d, b + c));
    0.5 * (even + odd)
}

impl Factor {
    /// Allocates the sparse matrix J M⁻¹ Jᵀ for a layout of constraints. The blocks of each column are in the order of the neighbors.
    pub(super) fn new(structure: &Structure) -> Factor {
        let mut factor = Factor::default();
        let mut couplings = vec![Vec::new(); structure.directions];
        let mut columns = Vec::with_capacity(structure.rows);
        for (place, neighbours) in structure.places.iter().zip(&structure.neighbours) {
            for row in 0..place.rows {
                let first = factor.matrix.len();
                let own = place.direction + row * place.bodies.len();
                for neighbour in neighbours {
                    let other = &structure.places[neighbour.place];
                    let end = (other.row + other.rows).min(place.row + row + 1);
                    for other_row in 0..end - other.row {
                        let before = other.direction + other_row * other.bodies.len();
                        for &(theirs, mine) in &neighbour.shared {
                            let coupling = Coupling { entry: factor.matrix.len(), other: before + theirs };
                            couplings[own + mine].push(coupling);
                        }
                        factor.matrix.push(Entry { row: other.row + other_row, value: 0.0 });
                    }
                }
                columns.push(first..factor.matrix.len());
            }
        }
        for of_direction in couplings {
            factor.coupling_start.push(factor.couplings.len());
            factor.couplings.extend(of_direction);
        }
        factor.coupling_start.push(factor.couplings.len());
        factor.plan(columns);
        factor
    }

    /// Computes the sparsity pattern of the factor L. Each matrix entry causes entries of L in its row, for all its ancestors in the
    /// elimination tree.
    fn plan(&mut self, columns: Vec<Range<usize>>) {
        let n = columns.len();
        // The elimination tree: the parent of a column of L is the first later row in which the column has an entry.
        let mut parent = vec![NO_INDEX; n];
        let mut mark = vec![NO_INDEX; n];
        let mut count = vec![0; n];
        let mut path = vec![0; n];
        for (k, column) in columns.into_iter().enumerate() {
            mark[k] = k;
            let mut top = n;
            for entry in &self.matrix[column.clone()] {
                let mut i = entry.row;
                let mut length = 0;
                while mark[i] != k {
                    if parent[i] == NO_INDEX {
                        parent[i] = k;
                    }
                    path[length] = i;
                    length += 1;
                    mark[i] = k;
                    i = parent[i];
                }
                while length > 0 {
                    length -= 1;
                    top -= 1;
                    path[top] = path[length];
                }
            }
            let first = self.crossings.len();
            for &column in &path[top..] {
                self.crossings.push(Crossing { column, first: 0, at: count[column] });
                count[column] += 1;
            }
            self.lines.push(Line { column, crossings: first..self.crossings.len(), below: 0..0 });
        }
        let mut first = 0;
        for (line, entries) in self.lines.iter_mut().zip(count) {
            line.below = first..first + entries;
            first += entries;
        }
        self.lower = vec![Entry::default(); first];
        for (row, line) in self.lines.iter().enumerate() {
            for crossing in &mut self.crossings[line.crossings.clone()] {
                crossing.first = self.lines[crossing.column].below.start;
                crossing.at += crossing.first;
                self.lower[crossing.at].row = row;
            }
        }
        self.inverse = vec![0.0; n];
        self.work = vec![0.0; n];
    }

    /// Computes the entries of the matrix J M⁻¹ Jᵀ.
    pub(super) fn assemble(&mut self, jacobian: &[Direction], members: &[Member]) {
        self.matrix.iter_mut().for_each(|entry| entry.value = 0.0);
        for (direction, couplings) in jacobian.iter().zip(self.coupling_start.windows(2)) {
            let weighed = members[direction.member].weigh(direction);
            for &Coupling { entry, other } in &self.couplings[couplings[0]..couplings[1]] {
                self.matrix[entry].value += jacobian[other].dot(&weighed);
            }
        }
    }

    /// Returns the diagonal entry of the matrix in a row.
    pub(super) fn diagonal(&self, row: usize) -> f64 {
        self.matrix[self.lines[row].column.end - 1].value
    }

    /// Factorizes the matrix for the active rows, which `held` selects. With `choose`, redundant rows are deselected in `held`.
    pub(super) fn compute(&mut self, held: &mut [bool], choose: bool) {
        let Factor { lines, matrix, crossings, lower, inverse, soft, weights, work, .. } = self;
        for ((k, line), held) in lines.iter().enumerate().zip(held) {
            // The last entry of a column is its diagonal entry.
            let Some((diagonal, before)) = matrix[line.column.clone()].split_last() else { continue };
            for entry in before {
                work[entry.row] = entry.value;
            }
            let (diagonal, mut pivot) = (diagonal.value, diagonal.value);
            let partner = soft.get(k).copied().flatten();
            if let Some(partner) = partner {
                let give = 0.5 * (diagonal + matrix[lines[partner].column.end - 1].value);
                pivot += RELATIVE_SOFTNESS * give * weights[k];
            }
            for &Crossing { column, first, at } in &crossings[line.crossings.clone()] {
                let value = std::mem::take(&mut work[column]);
                for entry in &lower[first..at] {
                    work[entry.row] -= entry.value * value;
                }
                let scaled = value * inverse[column];
                pivot -= scaled * value;
                lower[at].value = scaled;
            }
            if choose && partner.is_none() && pivot <= PIVOT_TOLERANCE * diagonal {
                *held = false;
            }
            // Rounding can make a pivot negative, which would reverse a force.
            inverse[k] = if *held && pivot > 0.0 { 1.0 / pivot } else { 0.0 };
        }
    }

    /// Sets which constraint rows are soft (see [`RELATIVE_SOFTNESS`]): each soft row names the row that is softened by the same amount. By
    /// default, no row is soft.
    pub(super) fn soften(&mut self, soft: Vec<Option<usize>>) {
        self.weights = vec![1.0; soft.len()];
        self.soft = soft;
    }

    /// Sets the softness weights of the given constraint rows. All other weights become 1.
    pub(super) fn weigh(&mut self, weights: impl IntoIterator<Item = (usize, f64)>) {
        self.weights.fill(1.0);
        weights.into_iter().for_each(|(row, weight)| self.weights[row] = weight);
    }

    /// Returns true if any constraint row is soft (see [`RELATIVE_SOFTNESS`]). Solutions then need iterative refinement.
    pub(super) fn is_soft(&self) -> bool {
        self.soft.iter().any(Option::is_some)
    }

    /// Computes, for each pair of rows, the sum of the norms of its 2 × 2 blocks with all pairs. A pair is given by its first row and the
    /// [unit](super::solver::Solver::unit) of its rates; the pairs are in ascending order. Since a norm (the largest singular value) counts,
    /// the result does not depend on the directions of the two tangents to which a pair of rows belongs.
    pub(super) fn pair_sizes(&self, pairs: &[(usize, f64)]) -> Vec<f64> {
        let mut sizes = vec![0.0; pairs.len()];
        for (i, &(first, unit)) in pairs.iter().enumerate() {
            let mut blocks = BTreeMap::<usize, [[f64; 2]; 2]>::new();
            for (side, line) in self.lines[first..first + 2].iter().enumerate() {
                for entry in &self.matrix[line.column.clone()] {
                    let Some(j) = pairs.partition_point(|&(other, _)| other <= entry.row).checked_sub(1)
                    else {
                        continue;
                    };
                    let at = entry.row - pairs[j].0;
                    if at < 2 {
                        let block = blocks.entry(j).or_default();
                        block[side][at] = entry.value;
                        if i == j {
                            block[at][side] = entry.value;
                        }
                    }
                }
            }
            for (j, block) in blocks {
                let (norm, other) = (norm(block), pairs[j].1);
                sizes[i] += norm * unit / other;
                if i != j {
                    sizes[j] += norm * other / unit;
                }
            }
        }
        sizes
    }

    /// Returns true if this constraint row is soft: its diagonal entry is slightly enlarged (see [`RELATIVE_SOFTNESS`]).
    pub(super) fn is_row_soft(&self, row: usize) -> bool {
        self.soft.get(row).is_some_and(Option::is_some)
    }

    /// Subtracts the product of the matrix A and the vector x from `out`, in all rows.
    pub(super) fn subtract_product(&self, x: &[f64], out: &mut [f64]) {
        for (k, line) in self.lines.iter().enumerate() {
            for entry in &self.matrix[line.column.clone()] {
                out[entry.row] -= entry.value * x[k];
                if entry.row != k {
                    out[k] -= entry.value * x[entry.row];
                }
            }
        }
    }

    /// Solves A x = b as [`solve`](Self::solve) does, for rows that are coupled to no others. `rows` are in ascending order.
    /// `x` holds several right-hand sides.
    pub(super) fn solve_rows<const LANES: usize>(&self, x: &mut [[f64; LANES]], rows: &[usize]) {
        for &i in rows {
            let values = x[i];
            if values == [0.0; LANES] {
                continue;
            }
            for entry in &self.lower[self.lines[i].below.clone()] {
                for (x, value) in x[entry.row].iter_mut().zip(values) {
                    *x -= entry.value * value;
                }
            }
        }
        for &i in rows.iter().rev() {
            let mut values = x[i].map(|value| value * self.inverse[i]);
            for entry in &self.lower[self.lines[i].below.clone()] {
                for (value, x) in values.iter_mut().zip(x[entry.row]) {
                    *value -= entry.value * x;
                }
            }
            x[i] = values;
        }
    }

    /// Solves A x = b for the active constraint rows. `x` holds b before the call; its entries for inactive rows become 0.
    #[inline(always)]
    pub(super) fn solve(&self, x: &mut [f64]) {
        for (i, line) in self.lines.iter().enumerate() {
            let value = x[i];
            for entry in &self.lower[line.below.clone()] {
                x[entry.row] -= entry.value * value;
            }
        }
        for ((i, line), inverse) in self.lines.iter().enumerate().zip(&self.inverse).rev() {
            let mut value = x[i] * inverse;
            for entry in &self.lower[line.below.clone()] {
                value -= entry.value * x[entry.row];
            }
            // An inactive row has a zero column in L, so its solution is zero as well.
            x[i] = value;
        }
    }
}
