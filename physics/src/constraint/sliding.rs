//! The forces at sliding contacts. Friction is μ times the normal force, and the normal force depends on friction in turn, so both are
//! found together.

use super::friction::FrictionPair;
use super::row_modes::Mode;
use super::solver::Solver;

impl Solver {
    /// Solves A λ = b for the active constraint rows, including sliding friction. `unknown` holds b before the call and λ after it.
    /// Friction is μ n, where n are the normal forces, and n = c + K n, where c are the normal forces without friction. A small dense
    /// system gives n. Returns true if it has a solution.
    pub(super) fn solve_sliding(&mut self) -> bool {
        let slides = |grip: &&FrictionPair| self.modes[grip.row] == Mode::Slid;
        let mut normals: Vec<usize> = self.grips.iter().filter(slides).map(|grip| grip.normal).collect();
        normals.dedup();
        let mut pushes: Vec<Vec<(usize, f64)>> = vec![Vec::new(); normals.len()];
        for grip in self.grips.iter().filter(slides) {
            if let Ok(at) = normals.binary_search(&grip.normal) {
                let push = grip.coefficient * grip.push;
                pushes[at].extend([(grip.row, push.x), (grip.row + 1, push.y)]);
            }
        }
        self.solve();
        let base = self.unknown.clone();
        // Each column holds the changes of all multipliers λ under a normal force of 1 at one sliding contact.
        let mut columns = Vec::with_capacity(normals.len());
        for pushed in &pushes {
            let mut push = vec![0.0; base.len()];
            pushed.iter().for_each(|&(row, value)| push[row] = value);
            self.unknown.fill(0.0);
            self.factor.subtract_product(&push, &mut self.unknown);
            self.solve();
            columns.push(self.unknown.clone());
        }
        let n = normals.len();
        let mut matrix = vec![0.0; n * n];
        for (i, &normal) in normals.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                matrix[i * n + j] = f64::from(u8::from(i == j)) - column[normal];
            }
        }
        let mut loads: Vec<f64> = normals.iter().map(|&normal| base[normal]).collect();
        let is_solved = eliminate(&mut matrix, &mut loads);
        self.unknown.clone_from(&base);
        for ((load, column), pushed) in loads.iter().zip(&columns).zip(&pushes) {
            self.unknown.iter_mut().zip(column).for_each(|(value, change)| *value += load * change);
            pushed.iter().for_each(|&(row, push)| self.unknown[row] += load * push);
        }
        is_solved
    }
}

/// Solves a dense linear system by Gaussian elimination with partial pivoting. `matrix` is stored row by row. `right` holds the right-hand
/// side before the call and the solution after it. Returns true if there is a finite solution.
fn eliminate(matrix: &mut [f64], right: &mut [f64]) -> bool {
    let n = right.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| matrix[i * n + k].abs().total_cmp(&matrix[j * n + k].abs()));
        let Some(pivot) = pivot.filter(|&row| matrix[row * n + k] != 0.0) else { return false };
        for column in 0..n {
            matrix.swap(k * n + column, pivot * n + column);
        }
        right.swap(k, pivot);
        for row in k + 1..n {
            let factor = matrix[row * n + k] / matrix[k * n + k];
            for column in k..n {
                matrix[row * n + column] -= factor * matrix[k * n + column];
            }
            right[row] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        for column in k + 1..n {
            right[k] -= matrix[k * n + column] * right[column];
        }
        right[k] /= matrix[k * n + k];
    }
    right.iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elimination_swaps_rows_where_it_must() {
        let mut right = [5.0, 4.0, 5.0];
        assert!(eliminate(&mut [0.0, 2.0, 1.0, 1.0, 1.0, 1.0, 2.0, 0.0, 3.0], &mut right));
        assert_eq!(right, [1.0, 2.0, 1.0]);
        assert!(!eliminate(&mut [1.0, 2.0, 2.0, 4.0], &mut [1.0, 1.0]));
    }
}
