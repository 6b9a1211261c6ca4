//! Three numbers that are advanced together: a place with its velocity, or something else with its slope.

use glam::DVec3;

use super::nodes::{BINOMIALS, NODES, OF_PLACE, OF_VALUE, PER_DISTANCE, POWERS, PRODUCTS, TERMS, Weights};

/// A sum, and what it has lost by rounding. Source: W. Kahan, Commun. ACM 8 (1965) 40.
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

    /// The sum with a little more.
    fn with(self, more: DVec3) -> DVec3 {
        self.value + (self.rest + more)
    }
}

/// A value whose slope within a step is s₀ + b₁ h + … + b₇ h⁷ at the part h of it, and, of a velocity, the place that it leads to.
#[derive(Clone, Copy, Default)]
pub(super) struct Lane {
    pub(super) place: Sum,
    pub(super) value: Sum,
    /// The slope at the beginning of the step.
    pub(super) slope: DVec3,
    /// The coefficients b.
    pub(super) b: [DVec3; TERMS],
    /// The same slope by the products of the nodes.
    g: [DVec3; TERMS],
    /// What the step before has led one to expect of b.
    expected: [DVec3; TERMS],
    /// b of the step that was made last, and what was expected of it.
    last: [DVec3; TERMS],
    last_expected: [DVec3; TERMS],
}

/// The slope at the end of a step, and its first two derivatives there, for a step of 1.
pub(super) struct End {
    pub(super) slope: DVec3,
    pub(super) rate: DVec3,
    pub(super) curvature: DVec3,
}

impl Lane {
    pub(super) fn of(place: DVec3, value: DVec3) -> Lane {
        Lane { place: Sum::of(place), value: Sum::of(value), ..Lane::default() }
    }

    /// Expects the step to go on like the one before, which was `1 / ratio` times as long; 0 where there was none.
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
            // What was wrong with the last guess will be wrong with this.
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

    /// What the slope at the beginning and the coefficients add up to.
    #[inline(always)]
    fn weigh(&self, weights: &Weights) -> DVec3 {
        let [b1, b2, b3, b4, b5, b6, b7] = self.b;
        let [w0, w1, w2, w3, w4, w5, w6, w7] = *weights;
        ((w7 * b7 + w6 * b6) + (w5 * b5 + w4 * b4)) + ((w3 * b3 + w2 * b2) + w1 * b1) + w0 * self.slope
    }

    /// The value at a node of a step of `dt`, s.
    #[inline(always)]
    pub(super) fn value_at(&self, node: usize, dt: f64) -> DVec3 {
        self.value.with(dt * self.weigh(&OF_VALUE[node]))
    }

    /// The place at a node of a step of `dt`, s.
    #[inline(always)]
    pub(super) fn place_at(&self, node: usize, dt: f64) -> DVec3 {
        let bend = dt * dt * self.weigh(&OF_PLACE[node]);
        self.place.with((dt * NODES[node]) * self.value.value + bend)
    }

    /// Takes in the slope at node N; returns by how much the last coefficient changes.
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

    /// Goes to the end of the step.
    pub(super) fn finish(&mut self, dt: f64, has_place: bool) {
        if has_place {
            let bend = dt * dt * self.weigh(&OF_PLACE[8]) + dt * self.value.rest;
            self.place.add(dt * self.value.value + bend);
        }
        self.value.add(dt * self.weigh(&OF_VALUE[8]));
        (self.last, self.last_expected) = (self.b, self.expected);
    }

    /// How the slope is at the end of the step.
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
