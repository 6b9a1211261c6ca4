//! The sparse factorisation A = L D Lᵀ of a symmetric matrix, row by row.
//!
//! Source: T. A. Davis, *Algorithm 849: a concise sparse Cholesky factorization package*, ACM TOMS 31 (2005) 587. It is our
//! own, and not that of a crate, since rows must be left out while it runs (those that others imply, and those that do not
//! hold at present), and since the order of its sums must not depend on the processor.

use super::structure::Structure;
use super::{Direction, Member};

/// Below this part of its own diagonal, what is left of a row has come from rounding: other rows imply it.
const IMPLIED: f64 = 1e-11;

/// A matrix and its factors; both keep their patterns.
#[derive(Clone, Debug, Default)]
pub(super) struct Factor {
    /// The entries on and above the diagonal, column by column.
    pub(super) columns: Vec<Column>,
    /// Their values.
    pub(super) values: Vec<f64>,
    rows: Vec<usize>,
    /// Where the couplings of each direction of the Jacobian begin in `couplings`; one more for the end.
    coupling_start: Vec<usize>,
    couplings: Vec<Coupling>,
    /// Where the entries of each row of L begin in `entries`; one more for the end.
    entry_start: Vec<usize>,
    /// The entries of L, row by row; in a row, those on which others depend come first.
    entries: Vec<Entry>,
    /// Where each column of L begins in `lower`; one more for the end.
    start: Vec<usize>,
    /// L, column by column: the rows of its entries, and their values.
    lower_rows: Vec<usize>,
    lower: Vec<f64>,
    /// 1/D; 0 for a row that is left out.
    inverse: Vec<f64>,
    /// Room to work in; all zero between two calls.
    work: Vec<f64>,
}

/// Where the values of a column stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    pub(super) first: usize,
    pub(super) end: usize,
}

/// A product of two directions of a body: that of the row of a column, and that of a row before it.
#[derive(Clone, Copy, Debug)]
struct Coupling {
    /// The value to which it belongs.
    value: usize,
    /// The direction in the row before.
    other: usize,
}

/// An entry of L.
#[derive(Clone, Copy, Debug)]
struct Entry {
    column: usize,
    /// Its place in `lower`.
    at: usize,
}

const NONE: usize = usize::MAX;

impl Factor {
    /// Room for the matrix J M⁻¹ Jᵀ of a structure. Its columns hold the blocks of the neighbours in their order.
    pub(super) fn new(structure: &Structure) -> Factor {
        let n = structure.rows;
        let mut factor = Factor { columns: Vec::with_capacity(n), ..Factor::default() };
        let mut couplings = vec![Vec::new(); structure.directions];
        for (place, neighbours) in structure.places.iter().zip(&structure.neighbours) {
            for row in 0..place.rows {
                let first = factor.rows.len();
                let own = place.direction + row * place.bodies.len();
                for neighbour in neighbours {
                    let other = &structure.places[neighbour.place];
                    let end = (other.row + other.rows).min(place.row + row + 1);
                    for other_row in 0..end - other.row {
                        let before = other.direction + other_row * other.bodies.len();
                        for &(theirs, mine) in &neighbour.shared {
                            let coupling = Coupling { value: factor.rows.len(), other: before + theirs };
                            couplings[own + mine].push(coupling);
                        }
                        factor.rows.push(other.row + other_row);
                    }
                }
                factor.columns.push(Column { first, end: factor.rows.len() });
            }
        }
        for of_direction in couplings {
            factor.coupling_start.push(factor.couplings.len());
            factor.couplings.extend(of_direction);
        }
        factor.coupling_start.push(factor.couplings.len());
        factor.values = vec![0.0; factor.rows.len()];
        factor.plan(n);
        factor
    }

    /// Finds the pattern of L. A row has an entry wherever a way up the elimination tree leads from an entry of the matrix.
    fn plan(&mut self, n: usize) {
        // The first later row in which a column of L has an entry: the elimination tree.
        let mut parent = vec![NONE; n];
        let mut mark = vec![NONE; n];
        let mut count = vec![0; n];
        let mut path = vec![0; n];
        for k in 0..n {
            self.entry_start.push(self.entries.len());
            mark[k] = k;
            let Column { first, end } = self.columns[k];
            let mut top = n;
            for p in first..end {
                let mut i = self.rows[p];
                let mut length = 0;
                while mark[i] != k {
                    if parent[i] == NONE {
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
            for &column in &path[top..] {
                self.entries.push(Entry { column, at: count[column] });
                count[column] += 1;
            }
        }
        self.entry_start.push(self.entries.len());
        let mut total = 0;
        for entries in count {
            self.start.push(total);
            total += entries;
        }
        self.start.push(total);
        self.lower_rows = vec![0; total];
        self.lower = vec![0.0; total];
        for k in 0..n {
            for entry in &mut self.entries[self.entry_start[k]..self.entry_start[k + 1]] {
                entry.at += self.start[entry.column];
                self.lower_rows[entry.at] = k;
            }
        }
        self.inverse = vec![0.0; n];
        self.work = vec![0.0; n];
    }

    /// Sets the values to J M⁻¹ Jᵀ; `member_of` are the bodies to which the directions belong.
    pub(super) fn assemble(&mut self, jacobian: &[Direction], member_of: &[usize], members: &[Member]) {
        self.values.fill(0.0);
        let couplings = self.coupling_start.windows(2).map(|pair| &self.couplings[pair[0]..pair[1]]);
        for ((direction, &member), couplings) in jacobian.iter().zip(member_of).zip(couplings) {
            let weighed = members[member].weigh(direction);
            for &Coupling { value, other } in couplings {
                self.values[value] += jacobian[other].dot(&weighed);
            }
        }
    }

    /// Factorises the values. `held` says which rows take part; where `choose` is set, those that others imply are taken out
    /// of it.
    pub(super) fn compute(&mut self, held: &mut [bool], choose: bool) {
        let Factor { columns, values, rows, entry_start, entries, start, lower_rows, lower, inverse, work, .. } =
            self;
        for (k, held) in held.iter_mut().enumerate() {
            let Column { first, end } = columns[k];
            for (&row, value) in rows[first..end].iter().zip(&values[first..end]) {
                work[row] = *value;
            }
            let diagonal = std::mem::take(&mut work[k]);
            let mut pivot = diagonal;
            for &Entry { column, at } in &entries[entry_start[k]..entry_start[k + 1]] {
                let value = std::mem::take(&mut work[column]);
                let begin = start[column];
                for (&row, factor) in lower_rows[begin..at].iter().zip(&lower[begin..at]) {
                    work[row] -= factor * value;
                }
                let scaled = value * inverse[column];
                pivot -= scaled * value;
                lower[at] = scaled;
            }
            if choose && pivot <= IMPLIED * diagonal {
                *held = false;
            }
            // A pivot that rounding has made negative would turn a force around.
            inverse[k] = if *held && pivot > 0.0 { 1.0 / pivot } else { 0.0 };
        }
    }

    /// Solves A x = b for the rows that take part; the other entries of x are 0.
    pub(super) fn solve(&self, x: &mut [f64]) {
        let columns = || self.start.windows(2).map(|pair| pair[0]..pair[1]);
        for (i, column) in columns().enumerate() {
            let value = x[i];
            for (&row, factor) in self.lower_rows[column.clone()].iter().zip(&self.lower[column]) {
                x[row] -= factor * value;
            }
        }
        for ((i, column), inverse) in columns().enumerate().zip(&self.inverse).rev() {
            let mut value = x[i] * inverse;
            for (&row, factor) in self.lower_rows[column.clone()].iter().zip(&self.lower[column]) {
                value -= factor * x[row];
            }
            // Of a row that is left out, the column of L is zero, and so is what stands here.
            x[i] = value;
        }
    }
}
