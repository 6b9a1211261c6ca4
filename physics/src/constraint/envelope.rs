//! A symmetric positive definite matrix stored by its envelope, and its Cholesky factorization.
//!
//! Row i of the lower triangle is stored from its first nonzero column up to the diagonal. The factor has the same envelope. Source: A.
//! George & J. W. H. Liu, *Computer Solution of Large Sparse Positive Definite Systems* (1981), chapter 4.

use std::collections::BTreeSet;

/// The lower triangle of a symmetric matrix, stored by its envelope.
#[derive(Clone, Debug, Default)]
pub(super) struct Envelope {
    /// The first stored column of each row.
    first: Vec<usize>,
    /// The index in `values` at which each row would begin if it were stored from column 0 on. It may be negative.
    start: Vec<isize>,
    values: Vec<f64>,
}

impl Envelope {
    /// Creates a matrix of zeros. `first` holds the first stored column of each row, at most the index of the row.
    pub(super) fn new(first: Vec<usize>) -> Envelope {
        let (mut start, mut length) = (Vec::with_capacity(first.len()), 0);
        for (row, &column) in first.iter().enumerate() {
            start.push(length as isize - column as isize);
            length += row + 1 - column;
        }
        Envelope { first, start, values: vec![0.0; length] }
    }

    /// Returns about how many multiplications a factorization takes.
    pub(super) fn work(&self) -> f64 {
        let width = |(row, &first): (usize, &usize)| (row + 1 - first) as f64;
        0.5 * self.first.iter().enumerate().map(width).map(|width| width * width).sum::<f64>()
    }

    /// Sets all entries to zero.
    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a number to an entry of the lower triangle within the envelope.
    pub(super) fn add(&mut self, row: usize, column: usize, number: f64) {
        let at = self.start[row] + column as isize;
        self.values[at as usize] += number;
    }

    /// Returns the stored entries of a row from column `from` up to, but not including, column `to`.
    fn part(&self, row: usize, from: usize, to: usize) -> &[f64] {
        let start = self.start[row];
        &self.values[(start + from as isize) as usize..(start + to as isize) as usize]
    }

    /// Replaces the matrix by its factor L, with A = L Lᵀ. Returns false if the matrix is not positive definite.
    pub(super) fn factorise(&mut self) -> bool {
        for row in 0..self.first.len() {
            let first = self.first[row];
            for column in first..=row {
                let from = first.max(self.first[column]);
                let sum = dot(self.part(row, from, column), self.part(column, from, column));
                let at = (self.start[row] + column as isize) as usize;
                let left = self.values[at] - sum;
                if column < row {
                    let diagonal = (self.start[column] + column as isize) as usize;
                    self.values[at] = left / self.values[diagonal];
                } else if left > 0.0 {
                    self.values[at] = left.sqrt();
                } else {
                    return false;
                }
            }
        }
        true
    }

    /// Solves A x = b with the factor. `x` holds b before the call.
    pub(super) fn solve(&self, x: &mut [f64]) {
        for row in 0..self.first.len() {
            let first = self.first[row];
            let sum = dot(self.part(row, first, row), &x[first..row]);
            x[row] = (x[row] - sum) / self.part(row, row, row + 1)[0];
        }
        for row in (0..self.first.len()).rev() {
            let first = self.first[row];
            x[row] /= self.part(row, row, row + 1)[0];
            let found = x[row];
            for (value, entry) in x[first..row].iter_mut().zip(self.part(row, first, row)) {
                *value -= found * entry;
            }
        }
    }
}

/// Returns the dot product of two lists of equal length. Four partial sums let the processor work on several terms at once; their order is
/// fixed, so the result has the same bits everywhere.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4).zip(b.chunks_exact(4)), a.len() / 4 * 4);
    for (a, b) in fours {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = a[others..].iter().zip(&b[others..]).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Returns the nodes of a graph in an order that keeps neighbors close together (reverse Cuthill–McKee). Each component starts at its node
/// with the fewest neighbors.
pub(super) fn narrow_order(graph: &[BTreeSet<usize>]) -> Vec<usize> {
    let mut starts: Vec<usize> = (0..graph.len()).collect();
    starts.sort_by_key(|&node| graph[node].len());
    let mut is_known = vec![false; graph.len()];
    let mut order = Vec::with_capacity(graph.len());
    for start in starts {
        if std::mem::replace(&mut is_known[start], true) {
            continue;
        }
        let mut next = order.len();
        order.push(start);
        while next < order.len() {
            let mut new: Vec<usize> =
                graph[order[next]].iter().copied().filter(|&node| !is_known[node]).collect();
            new.sort_by_key(|&node| graph[node].len());
            new.iter().for_each(|&node| is_known[node] = true);
            order.extend(new);
            next += 1;
        }
    }
    order.reverse();
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The product of the factor with its transpose is the matrix, and a solution satisfies its equations, for a band matrix with an
    /// irregular envelope.
    #[test]
    fn a_factor_solves_its_equations() {
        let first: Vec<usize> = (0..23_usize).map(|row| row.saturating_sub(1 + row * 7 % 9)).collect();
        let mut matrix = Envelope::new(first.clone());
        let mut dense = vec![vec![0.0; 23]; 23];
        let places =
            first.iter().enumerate().flat_map(|(row, &first)| (first..=row).map(move |column| (row, column)));
        for (row, column) in places {
            let entry = if row == column { 20.0 } else { libm::sin((row * 31 + column * 17) as f64) };
            matrix.add(row, column, entry);
            dense[row][column] = entry;
            dense[column][row] = entry;
        }
        let right: Vec<f64> = (0..23).map(|row| libm::cos(f64::from(row))).collect();
        let mut found = right.clone();
        assert!(matrix.factorise());
        matrix.solve(&mut found);
        for (row, right) in dense.iter().zip(&right) {
            let left: f64 = row.iter().zip(&found).map(|(a, x)| a * x).sum();
            assert!((left - right).abs() < 1e-14, "{left} {right}");
        }
    }

    /// A matrix with a negative eigenvalue has no factor.
    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        let mut matrix = Envelope::new(vec![0, 0]);
        [(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)].into_iter().for_each(|(i, j, entry)| matrix.add(i, j, entry));
        assert!(!matrix.factorise());
    }

    /// The nodes of a chain with shuffled names are ordered along the chain.
    #[test]
    fn neighbors_in_a_chain_stay_neighbors() {
        let name = |place: usize| place * 7 % 11;
        let mut graph = vec![BTreeSet::new(); 11];
        for place in 0..10 {
            graph[name(place)].insert(name(place + 1));
            graph[name(place + 1)].insert(name(place));
        }
        let order = narrow_order(&graph);
        assert_eq!(order.len(), 11);
        assert!(order.windows(2).all(|pair| graph[pair[0]].contains(&pair[1])));
    }
}
