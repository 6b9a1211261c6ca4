//! The sparse factorisation A = L D Lᵀ of a symmetric matrix, row by row.
//!
//! Source: T. A. Davis, *Algorithm 849: a concise sparse Cholesky factorization package*, ACM TOMS 31 (2005) 587. It is our
//! own, and not that of a crate, since rows must be left out while it runs (those that others imply, and those that do not
//! hold at present), and since the order of its sums must not depend on the processor.

use super::structure::Structure;

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
    /// The first later row in which a column of L has an entry: the elimination tree.
    parent: Vec<usize>,
    /// Where each column of L begins.
    start: Vec<usize>,
    /// How many entries each column of L has by now.
    filled: Vec<usize>,
    lower_rows: Vec<usize>,
    lower: Vec<f64>,
    /// 1/D; 0 for a row that is left out.
    inverse: Vec<f64>,
    // Room to work in.
    work: Vec<f64>,
    mark: Vec<usize>,
    path: Vec<usize>,
}

/// Where the values of a column stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    pub(super) first: usize,
    pub(super) end: usize,
}

const NONE: usize = usize::MAX;

impl Factor {
    /// Room for the matrix J M⁻¹ Jᵀ of a structure. Its columns hold the blocks of the neighbours in their order.
    pub(super) fn new(structure: &Structure) -> Factor {
        let n = structure.rows;
        let mut factor = Factor { columns: Vec::with_capacity(n), ..Factor::default() };
        for (place, neighbours) in structure.places.iter().zip(&structure.neighbours) {
            for row in 0..place.rows {
                let first = factor.rows.len();
                for neighbour in neighbours {
                    let other = &structure.places[neighbour.place];
                    let end = (other.row + other.rows).min(place.row + row + 1);
                    factor.rows.extend(other.row..end);
                }
                factor.columns.push(Column { first, end: factor.rows.len() });
            }
        }
        factor.values = vec![0.0; factor.rows.len()];
        factor.plan(n);
        factor
    }

    /// Finds the pattern of L.
    fn plan(&mut self, n: usize) {
        self.parent = vec![NONE; n];
        self.mark = vec![NONE; n];
        let mut count = vec![0; n];
        for k in 0..n {
            self.mark[k] = k;
            let Column { first, end } = self.columns[k];
            for p in first..end {
                let mut i = self.rows[p];
                while self.mark[i] != k {
                    if self.parent[i] == NONE {
                        self.parent[i] = k;
                    }
                    count[i] += 1;
                    self.mark[i] = k;
                    i = self.parent[i];
                }
            }
        }
        self.start = Vec::with_capacity(n + 1);
        let mut total = 0;
        for entries in count {
            self.start.push(total);
            total += entries;
        }
        self.start.push(total);
        self.lower_rows = vec![0; total];
        self.lower = vec![0.0; total];
        self.filled = vec![0; n];
        self.inverse = vec![0.0; n];
        self.work = vec![0.0; n];
        self.path = vec![0; n];
    }

    /// Factorises the values. `held` says which rows take part; where `choose` is set, those that others imply are taken out
    /// of it.
    pub(super) fn compute(&mut self, held: &mut [bool], choose: bool) {
        let n = held.len();
        self.mark.fill(NONE);
        for (k, held) in held.iter_mut().enumerate() {
            let mut top = n;
            self.work[k] = 0.0;
            self.mark[k] = k;
            self.filled[k] = 0;
            let Column { first, end } = self.columns[k];
            // The pattern of row k of L: the ways up the tree from the entries of column k.
            for p in first..end {
                let mut i = self.rows[p];
                self.work[i] += self.values[p];
                let mut length = 0;
                while self.mark[i] != k {
                    self.path[length] = i;
                    length += 1;
                    self.mark[i] = k;
                    i = self.parent[i];
                }
                while length > 0 {
                    length -= 1;
                    top -= 1;
                    self.path[top] = self.path[length];
                }
            }
            let diagonal = self.work[k];
            let mut pivot = diagonal;
            self.work[k] = 0.0;
            for at in top..n {
                let i = self.path[at];
                let value = self.work[i];
                self.work[i] = 0.0;
                let (begin, end) = (self.start[i], self.start[i] + self.filled[i]);
                for p in begin..end {
                    self.work[self.lower_rows[p]] -= self.lower[p] * value;
                }
                let scaled = value * self.inverse[i];
                pivot -= scaled * value;
                self.lower_rows[end] = k;
                self.lower[end] = scaled;
                self.filled[i] += 1;
            }
            if choose && pivot <= IMPLIED * diagonal {
                *held = false;
            }
            // A pivot that rounding has made negative would turn a force around.
            self.inverse[k] = if *held && pivot > 0.0 { 1.0 / pivot } else { 0.0 };
        }
    }

    /// Solves A x = b for the rows that take part; the other entries of x are 0.
    pub(super) fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        for i in 0..n {
            let value = x[i];
            for p in self.start[i]..self.start[i] + self.filled[i] {
                x[self.lower_rows[p]] -= self.lower[p] * value;
            }
        }
        for i in (0..n).rev() {
            let mut value = x[i] * self.inverse[i];
            for p in self.start[i]..self.start[i] + self.filled[i] {
                value -= self.lower[p] * x[self.lower_rows[p]];
            }
            // Of a row that is left out, the column of L is zero, and so is what stands here.
            x[i] = value;
        }
    }
}
