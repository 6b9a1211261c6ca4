//! Lanes: groups of three numbers that are integrated together, such as a velocity with its position.

use glam::DVec3;

use super::nodes::{BINOMIALS, NODES, OF_PLACE, OF_VALUE, PER_DISTANCE, POWERS, PRODUCTS, TERMS, Weights};

/// A compensated sum: its value, and the rounding error that the value lacks. Source: W. Kahan, Commun. ACM 8 (1965) 40.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    pub(super) value: DVec3,
    pub(super) rest: DVec3,
}

impl Sum {
    fn of(value: DVec3) -> Sum {
        Sum { value, rest: DVec3::ZERO }
    }

    pub(super) fn add(&mut self, more: DVec3) {
        let more = more + self.rest;
        let sum = self.value + more;
        self.rest = more - (sum - self.value);
        self.value = sum;
    }

    /// Returns the sum plus a small term, without changing the sum.
    fn with(self, more: DVec3) -> DVec3 {
        self.value + (self.rest + more)
    }
}

/// A value whose slope at the fraction h of a step is s₀ + b₁ h + … + b₇ h⁷. If the value is a velocity, `place` is the position that
/// belongs to it.
#[derive(Clone, Copy, Default)]
pub(super) struct Lane {
    pub(super) place: Sum,
    pub(super) value: Sum,
    /// The slope s₀ at the start of the step.
    pub(super) slope: DVec3,
    /// The coefficients b₁ to b₇ of the slope's polynomial.
    pub(super) b: [DVec3; TERMS],
    /// The coefficients of the same polynomial in Newton's form: as factors of h, h (h − h₁), h (h − h₁) (h − h₂) and so on.
    g: [DVec3; TERMS],
    /// The coefficients b that were predicted from the last step.
    expected: [DVec3; TERMS],
    /// The coefficients b of the last step, and the prediction that was made for them.
    last: [DVec3; TERMS],
    last_expected: [DVec3; TERMS],
}

/// The slope of a value at the end of a step, and its first two derivatives with respect to the fraction of the step.
pub(super) struct End {
    pub(super) slope: DVec3,
    pub(super) rate: DVec3,
    pub(super) curvature: DVec3,
}

impl Lane {
    pub(super) fn of(place: DVec3, value: DVec3) -> Lane {
        Lane { place: Sum::of(place), value: Sum::of(value), ..Lane::default() }
    }

    /// Predicts the coefficients, on the assumption that the polynomial of the last step continues. `ratio` is the length of this step,
    /// divided by that of the last step. A ratio of 0 sets the coefficients to zero.
    #[allow(clippy::needless_range_loop, reason = "the sums are those of the formulas, over two indices")]
    pub(super) fn expect(&mut self, ratio: f64) {
        let mut power = ratio;
        for k in 0..TERMS {
            let mut sum = DVec3::ZERO;
            for j in k..TERMS {
                sum += BINOMIALS[j][k] * self.last[j];
            }
            self.expected[k] = power * sum;
            power *= ratio;
            // The error of the last prediction is likely to occur again, so it is added.
            self.b[k] = if ratio > 0.0 {
                self.expected[k] + (self.last[k] - self.last_expected[k])
            } else {
                DVec3::ZERO
            };
        }
        for j in 0..TERMS {
            let mut sum = self.b[j];
            for k in j + 1..TERMS {
                sum += PRODUCTS[k][j] * self.b[k];
            }
            self.g[j] = sum;
        }
    }

    /// Returns the weighted sum of the initial slope and the seven coefficients.
    #[inline(always)]
    fn weigh(&self, weights: &Weights) -> DVec3 {
        let [b1, b2, b3, b4, b5, b6, b7] = self.b;
        let [w0, w1, w2, w3, w4, w5, w6, w7] = *weights;
        ((w7 * b7 + w6 * b6) + (w5 * b5 + w4 * b4)) + ((w3 * b3 + w2 * b2) + w1 * b1) + w0 * self.slope
    }

    /// Returns the value at a node of a step of `dt`, s.
    #[inline(always)]
    pub(super) fn value_at(&self, node: usize, dt: f64) -> DVec3 {
        self.value.with(dt * self.weigh(&OF_VALUE[node]))
    }

    /// Returns the position at a node of a step of `dt`, s.
    #[inline(always)]
    pub(super) fn place_at(&self, node: usize, dt: f64) -> DVec3 {
        let bend = dt * dt * self.weigh(&OF_PLACE[node]);
        self.place.with((dt * NODES[node]) * self.value.value + bend)
    }

    /// Updates the coefficients with the slope at node N. Returns the change of the last coefficient that the node affects.
    #[allow(clippy::needless_range_loop, reason = "the sums are those of the formulas, over two indices")]
    #[inline(always)]
    pub(super) fn refine<const N: usize>(&mut self, slope: DVec3) -> DVec3 {
        let mut divided = (slope - self.slope) * PER_DISTANCE[N][0];
        for j in 1..N {
            divided = (divided - self.g[j - 1]) * PER_DISTANCE[N][j];
        }
        let change = divided - self.g[N - 1];
        self.g[N - 1] = divided;
        for j in 0..N - 1 {
            self.b[j] += POWERS[N - 1][j] * change;
        }
        self.b[N - 1] += change;
        change
    }

    /// Advances the value, and the position if `has_place` is true, to the end of a step of `dt`, s.
    pub(super) fn finish(&mut self, dt: f64, has_place: bool) {
        if has_place {
            let bend = dt * dt * self.weigh(&OF_PLACE[8]) + dt * self.value.rest;
            self.place.add(dt * self.value.value + bend);
        }
        self.value.add(dt * self.weigh(&OF_VALUE[8]));
        (self.last, self.last_expected) = (self.b, self.expected);
    }

    /// Returns the slope and its first two derivatives at the end of the step.
    pub(super) fn end(&self) -> End {
        let [mut slope, mut rate, mut curvature] = [self.slope, DVec3::ZERO, DVec3::ZERO];
        let mut number = 1.0;
        for b in self.b {
            slope += b;
            rate += number * b;
            curvature += number * (number - 1.0) * b;
            number += 1.0;
        }
        End { slope, rate, curvature }
    }
}
