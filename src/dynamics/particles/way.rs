//! The path of a particle within one step.

use glam::DVec3;

/// Values below this fraction of the coordinates are rounding errors.
const ROUNDING: f64 = 2e-15;

/// The state of a particle at the two ends of a step, or of a part of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leap {
    /// The two times, s.
    pub(super) times: [f64; 2],
    /// The two places, m.
    pub(super) places: [DVec3; 2],
    /// The two velocities, m/s.
    pub(super) velocities: [DVec3; 2],
}

/// The path between the two ends: polynomials of the time since the beginning of the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    place: [DVec3; 4],
    velocity: [DVec3; 3],
    /// An upper bound for the second derivative of the place, m/s².
    pub(super) bend: f64,
}

impl Leap {
    pub(super) fn span(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    /// The mean acceleration in the step, m/s².
    pub(super) fn acceleration(&self) -> DVec3 {
        (self.velocities[1] - self.velocities[0]) / self.span()
    }

    /// A box around the path: its lowest and its highest corner.
    pub(super) fn bounds(&self) -> [DVec3; 2] {
        let [from, to] = self.places;
        let way = to - from;
        let aside = |velocity: DVec3| (self.span() * velocity - way).abs();
        // The Hermite polynomials of the velocities are at most 4/27, and s (1 − s) is at most 1/4.
        let margin = 0.25 * aside(self.velocities[0]) + 0.25 * aside(self.velocities[1]);
        [from.min(to) - margin, from.max(to) + margin]
    }

    /// The path: a parabola for a step with constant acceleration, by a method of order 2 or higher or by Euler–Cromer;
    /// else the cubic polynomial through the places and velocities.
    ///
    /// A part of a step of Euler–Cromer is a shorter step of Euler–Cromer. So the path is x + v t + a t², although the
    /// velocity is v + a t.
    pub(super) fn way(&self) -> Way {
        let (h, a) = (self.span(), self.acceleration());
        let ([x, y], [v, w]) = (self.places, self.velocities);
        let rounding = ROUNDING * x.abs().max(y.abs()).max_element();
        let is_way = |way: DVec3| (y - x - way).abs().max_element() <= rounding;
        let rest = y - x - 0.5 * h * (v + w);
        if is_way(0.5 * h * (v + w)) {
            Way { place: [x, v, 0.5 * a, DVec3::ZERO], velocity: [v, a, DVec3::ZERO], bend: a.length() }
        } else if is_way(h * w) {
            Way { place: [x, v, a, DVec3::ZERO], velocity: [v, a, DVec3::ZERO], bend: 2.0 * a.length() }
        } else {
            let rest = rest * (6.0 / (h * h));
            let (first, last) = (a + rest, a - rest);
            let third = (last - first) / h;
            Way {
                place: [x, v, 0.5 * first, third / 6.0],
                velocity: [v, first, 0.5 * third],
                bend: first.length().max(last.length()),
            }
        }
    }
}

impl Way {
    /// The place of the particle at time `t` after the beginning, s.
    pub(super) fn place(&self, t: f64) -> DVec3 {
        let [a, b, c, d] = self.place;
        a + t * (b + t * (c + t * d))
    }

    /// The derivative of the place at time `t` after the beginning, m/s.
    pub(super) fn rate(&self, t: f64) -> DVec3 {
        let [_, b, c, d] = self.place;
        b + t * (2.0 * c + t * (3.0 * d))
    }

    /// The velocity at time `t` after the beginning, m/s. By Euler–Cromer, it differs slightly from the derivative of
    /// the place.
    pub(super) fn velocity(&self, t: f64) -> DVec3 {
        let [a, b, c] = self.velocity;
        a + t * (b + t * c)
    }
}
