//! Anderson acceleration of fixed-point iterations. Gauss–Seidel sweeps alone approach their limit slowly. The changes made by the last
//! few sweeps give a better estimate of this limit.
//!
//! Source: H. F. Walker & P. Ni, *Anderson acceleration for fixed-point iterations*, SIAM J. Numer. Anal. 49 (2011) 1715.

/// The number of recent sweeps from which the acceleration extrapolates.
const HISTORY_LENGTH: usize = 5;

/// If the squared change of a sweep exceeds that of the previous sweep by more than this factor, the acceleration discards its history.
const MAX_SQUARED_GROWTH: f64 = 2.0;

/// A difference between sweeps counts as linearly dependent on the older differences if the square of its independent part is below this
/// fraction of the largest squared difference.
const DEPENDENCE_TOLERANCE: f64 = 1e-14;

/// The accelerator of a fixed-point iteration, with the history of the last sweeps.
pub(crate) struct Anderson {
    /// The square root of each value's weight, one entry per value.
    scale: Vec<f64>,
    /// The values from which the next sweep starts.
    before: Vec<f64>,
    last: Sweep,
    /// The squared norm of the change that the last sweep made.
    length: f64,
    /// True before the first sweep.
    is_new: bool,
    /// The differences between successive recent sweeps, the oldest first.
    steps: Vec<Sweep>,
    /// The correction to add to the values after the last sweep, one entry per value.
    further: Vec<f64>,
}

/// The result of one sweep, or the difference between the results of two successive sweeps.
#[derive(Default)]
struct Sweep {
    /// The values after the sweep, one entry per unknown.
    found: Vec<f64>,
    /// The change of each value by the sweep, times the square root of the value's weight.
    change: Vec<f64>,
    /// For a difference: the dot products of its `change` with the changes of all older differences and with itself.
    products: Vec<f64>,
}

impl Anderson {
    /// Creates an accelerator from the values before the first sweep. The squared norm of a change is the sum of its components' squares,
    /// each times its entry of `weights`.
    pub(crate) fn from(values: &[f64], weights: &[f64]) -> Anderson {
        Anderson {
            scale: weights.iter().map(|weight| weight.sqrt()).collect(),
            before: values.to_vec(),
            last: Sweep::default(),
            length: f64::INFINITY,
            is_new: true,
            steps: Vec::with_capacity(HISTORY_LENGTH),
            further: Vec::with_capacity(values.len()),
        }
    }

    /// Takes the values that a sweep has found and returns the correction to add to them, one entry per value. The next sweep then starts
    /// nearer to the limit.
    pub(crate) fn go_further(&mut self, found: &[f64]) -> &[f64] {
        let mut step =
            if self.steps.len() == HISTORY_LENGTH { self.forget_oldest() } else { Sweep::default() };
        let change = found.iter().zip(&self.before).zip(&self.scale);
        overwrite(&mut step.change, change.map(|((found, before), scale)| scale * (found - before)));
        overwrite(&mut step.found, found.iter().copied());
        std::mem::swap(&mut step, &mut self.last);
        let length = product(&self.last.change, &self.last.change);
        if length > MAX_SQUARED_GROWTH * self.length {
            self.steps.clear();
        } else if !self.is_new {
            self.note(step);
        }
        (self.length, self.is_new) = (length, false);
        let parts = self.parts();
        overwrite(&mut self.further, found.iter().map(|_| 0.0));
        for (step, part) in self.steps.iter().zip(parts) {
            self.further.iter_mut().zip(&step.found).for_each(|(further, step)| *further -= part * step);
        }
        overwrite(&mut self.before, found.iter().zip(&self.further).map(|(found, further)| found + further));
        &self.further
    }

    fn forget_oldest(&mut self) -> Sweep {
        for step in &mut self.steps {
            step.products.remove(0);
        }
        self.steps.remove(0)
    }

    /// Stores the difference between the last sweep and `before`, the sweep before the last.
    fn note(&mut self, before: Sweep) {
        let Sweep { mut found, mut change, mut products } = before;
        found.iter_mut().zip(&self.last.found).for_each(|(before, now)| *before = now - *before);
        change.iter_mut().zip(&self.last.change).for_each(|(before, now)| *before = now - *before);
        overwrite(&mut products, self.steps.iter().map(|step| product(&step.change, &change)));
        products.push(product(&change, &change));
        self.steps.push(Sweep { found, change, products });
    }

    /// Computes the coefficients of the linear combination of stored differences that is nearest to the last change. The least-squares
    /// problem is solved by Cholesky factorization of its normal equations.
    fn parts(&self) -> [f64; HISTORY_LENGTH] {
        let n = self.steps.len();
        let largest = self.steps.iter().zip(0..).fold(0.0_f64, |most, (step, i)| most.max(step.products[i]));
        let mut factor = [[0.0; HISTORY_LENGTH]; HISTORY_LENGTH];
        let mut parts = [0.0; HISTORY_LENGTH];
        for i in 0..n {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
                let left = self.steps[i].products[j] - known;
                factor[i][j] = match i == j {
                    true if left > DEPENDENCE_TOLERANCE * largest => left.sqrt(),
                    // A linearly dependent difference gets the coefficient 0.
                    true => f64::INFINITY,
                    false => left / factor[j][j],
                };
            }
            let known: f64 = (0..i).map(|k| factor[i][k] * parts[k]).sum();
            parts[i] = (product(&self.steps[i].change, &self.last.change) - known) / factor[i][i];
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| factor[k][i] * parts[k]).sum();
            parts[i] = (parts[i] - known) / factor[i][i];
        }
        parts
    }
}

/// Computes the dot product. Four independent sums let the processor work in parallel.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_left), (b, b_left)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for ([a0, a1, a2, a3], [b0, b1, b2, b3]) in a.iter().zip(b) {
        sums[0] += a0 * b0;
        sums[1] += a1 * b1;
        sums[2] += a2 * b2;
        sums[3] += a3 * b3;
    }
    let left: f64 = a_left.iter().zip(b_left).map(|(a, b)| a * b).sum();
    sums[0] + sums[1] + (sums[2] + sums[3]) + left
}

fn overwrite(values: &mut Vec<f64>, new: impl Iterator<Item = f64>) {
    values.clear();
    values.extend(new);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear iteration multiplies the distances of three values from their limits by 0.99, 0.9 and −0.5. Without acceleration it would
    /// take two thousand sweeps. Three differences between sweeps determine the limit.
    #[test]
    fn a_linear_iteration_reaches_its_limit_in_a_few_sweeps() {
        let limit = [1.0, -2.0, 0.5];
        let sweep = |x: &mut [f64]| {
            for ((x, factor), limit) in x.iter_mut().zip([0.99, 0.9, -0.5]).zip(limit) {
                *x = limit + factor * (*x - limit);
            }
        };
        let mut x = [0.0; 3];
        let mut anderson = Anderson::from(&x, &[1.0, 4.0, 9.0]);
        for _ in 0..6 {
            sweep(&mut x);
            let further = anderson.go_further(&x).to_vec();
            x.iter_mut().zip(further).for_each(|(x, further)| *x += further);
        }
        for (x, limit) in x.iter().zip(limit) {
            assert!((x - limit).abs() < 1e-9, "{x} instead of {limit}");
        }
    }

    /// If a sweep changes no value, the correction is zero.
    #[test]
    fn what_is_at_its_limit_stays_there() {
        let mut anderson = Anderson::from(&[3.0], &[1.0]);
        for _ in 0..4 {
            assert_eq!(anderson.go_further(&[3.0]), [0.0]);
        }
    }
}
