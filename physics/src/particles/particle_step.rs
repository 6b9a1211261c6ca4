//! The path of a particle within one step, as polynomials of time.

use glam::DVec3;

/// Differences count as rounding errors if they are below this fraction of the coordinates.
const COORDINATE_ROUNDING: f64 = 2e-15;

/// A step of a particle, or a part of a step: the times, positions and velocities at its beginning and its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct ParticleStep {
    /// The times at the beginning and at the end, s.
    pub(super) times: [f64; 2],
    /// The positions of the particle at the beginning and at the end, m.
    pub(super) places: [DVec3; 2],
    /// The velocities of the particle at the beginning and at the end, m/s.
    pub(super) velocities: [DVec3; 2],
}

/// The path of a particle within a step. The position and the velocity are polynomials of the time since the beginning of the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct ParticlePath {
    place: [DVec3; 4],
    velocity: [DVec3; 3],
    /// An upper bound for the magnitude of the second derivative of the position, m/s².
    pub(super) bend: f64,
}

impl ParticleStep {
    pub(super) fn span(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    /// Returns the mean acceleration in the step, m/s².
    pub(super) fn acceleration(&self) -> DVec3 {
        (self.velocities[1] - self.velocities[0]) / self.span()
    }

    /// Returns a box around the path, as its lowest and its highest corner, m.
    pub(super) fn bounds(&self) -> [DVec3; 2] {
        let [from, to] = self.places;
        let way = to - from;
        let aside = |velocity: DVec3| (self.span() * velocity - way).abs();
        // On a cubic path, the Hermite polynomials that multiply the velocities are at most 4/27. On a parabola, s (1 − s) is at most 1/4.
        let margin = 0.25 * aside(self.velocities[0]) + 0.25 * aside(self.velocities[1]);
        [from.min(to) - margin, from.max(to) + margin]
    }

    /// Returns the path of the particle. It is a parabola for a step with constant acceleration by Euler–Cromer or by a method of order 2
    /// or higher. Otherwise, it is the cubic polynomial that matches the positions and velocities at both ends.
    ///
    /// A part of a step of Euler–Cromer is a shorter step of Euler–Cromer. So the path is x + v t + a t², although the velocity is v + a
    /// t.
    pub(super) fn way(&self) -> ParticlePath {
        let (h, a) = (self.span(), self.acceleration());
        let ([x, y], [v, w]) = (self.places, self.velocities);
        let rounding = COORDINATE_ROUNDING * x.abs().max(y.abs()).max_element();
        let is_way = |way: DVec3| (y - x - way).abs().max_element() <= rounding;
        let rest = y - x - 0.5 * h * (v + w);
        if is_way(0.5 * h * (v + w)) {
            ParticlePath {
                place: [x, v, 0.5 * a, DVec3::ZERO],
                velocity: [v, a, DVec3::ZERO],
                bend: a.length(),
            }
        } else if is_way(h * w) {
            ParticlePath {
                place: [x, v, a, DVec3::ZERO],
                velocity: [v, a, DVec3::ZERO],
                bend: 2.0 * a.length(),
            }
        } else {
            let rest = rest * (6.0 / (h * h));
            let (first, last) = (a + rest, a - rest);
            let third = (last - first) / h;
            ParticlePath {
                place: [x, v, 0.5 * first, third / 6.0],
                velocity: [v, first, 0.5 * third],
                bend: first.length().max(last.length()),
            }
        }
    }
}

impl ParticlePath {
    /// Returns the position of the particle at time `t` (s) after the beginning of the step, m.
    pub(super) fn place(&self, t: f64) -> DVec3 {
        let [a, b, c, d] = self.place;
        a + t * (b + t * (c + t * d))
    }

    /// Returns the time derivative of the position at time `t` (s) after the beginning of the step, m/s.
    pub(super) fn rate(&self, t: f64) -> DVec3 {
        let [_, b, c, d] = self.place;
        b + t * (2.0 * c + t * (3.0 * d))
    }

    /// Returns the velocity of the particle at time `t` (s) after the beginning of the step, m/s. With Euler–Cromer, it differs slightly
    /// from the derivative of the position.
    pub(super) fn velocity(&self, t: f64) -> DVec3 {
        let [a, b, c] = self.velocity;
        a + t * (b + t * c)
    }
}
