//! The formulas for the force and the potential of a single body and of a tree node.

use glam::DVec3;

use super::Moments;

/// The number of positions for which sums are computed side by side, so that the compiler can vectorize the loop.
pub(super) const LANES: usize = 4;

/// One number for each of several positions.
pub(super) type Lanes = [f64; LANES];

/// The centre of mass and the moments of a tree node, scaled for the formulas.
#[derive(Clone, Copy, Default)]
pub(super) struct Source {
    pub(super) centre: [f64; 3],
    mass: f64,
    /// 3 Q, where Q holds the second moments: xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
    /// 3/2 tr Q, where Q holds the second moments.
    trace: f64,
}

impl From<&Moments> for Source {
    fn from(moments: &Moments) -> Source {
        let second = moments.second.map(|q| 3.0 * q);
        let trace = 0.5 * (second[0] + second[1] + second[2]);
        Source { centre: moments.centre.into(), mass: moments.mass, second, trace }
    }
}

impl Source {
    /// Returns 3 Q d.
    #[inline(always)]
    fn turn(&self, d: [f64; 3]) -> [f64; 3] {
        let [xx, yy, zz, xy, xz, yz] = self.second;
        let [x, y, z] = d;
        [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
    }
}

/// A quantity that bodies and tree nodes contribute to at given positions: the force or the potential. `d` is the vector from the source
/// to each position, and `square` is d² + ε².
///
/// With the softening ε, a node's potential is ψ = M/R − tr Q / 2R³ + 3 dᵀQd / 2R⁵, where R² = d² + ε². This is the Taylor expansion of Σ m
/// / √(|d − s|² + ε²) up to second order in s, the position of a mass m relative to the centre of mass. The terms of first order add up to
/// zero.
pub(super) trait Kernel {
    /// The type of the quantity at one position.
    type Sum: Copy + Default + Send;

    /// Adds to `sums` the contribution of a single mass. The contribution is zero where `square` is infinite.
    fn near(mass: f64, d: [Lanes; 3], square: Lanes, sums: &mut [Lanes; 3]);

    /// Adds to `sums` the contribution of a tree node that acts as a whole.
    fn far(node: &Source, d: [Lanes; 3], square: Lanes, sums: &mut [Lanes; 3]);

    /// Returns the quantity at the position of one lane.
    fn sum(sums: &[Lanes; 3], lane: usize) -> Self::Sum;
}

/// The kernel of the force: Σ m d / (d² + ε²)^(3/2), which is −∇ψ.
pub(super) struct Pull;

impl Kernel for Pull {
    type Sum = DVec3;

    #[inline(always)]
    fn near(mass: f64, d: [Lanes; 3], square: Lanes, sums: &mut [Lanes; 3]) {
        for k in 0..LANES {
            let weight = mass / (square[k] * square[k].sqrt());
            sums[0][k] += weight * d[0][k];
            sums[1][k] += weight * d[1][k];
            sums[2][k] += weight * d[2][k];
        }
    }

    #[inline(always)]
    fn far(node: &Source, d: [Lanes; 3], square: Lanes, sums: &mut [Lanes; 3]) {
        for k in 0..LANES {
            let d = [d[0][k], d[1][k], d[2][k]];
            let inverse = 1.0 / square[k];
            let third = inverse * inverse.sqrt();
            let fifth = third * inverse;
            let turned = node.turn(d);
            let along = d[0] * turned[0] + d[1] * turned[1] + d[2] * turned[2];
            let weight = node.mass * third + fifth * (2.5 * along * inverse - node.trace);
            sums[0][k] += weight * d[0] - fifth * turned[0];
            sums[1][k] += weight * d[1] - fifth * turned[1];
            sums[2][k] += weight * d[2] - fifth * turned[2];
        }
    }

    fn sum(sums: &[Lanes; 3], lane: usize) -> DVec3 {
        DVec3::new(sums[0][lane], sums[1][lane], sums[2][lane])
    }
}

/// The kernel of the potential: ψ = Σ m / √(d² + ε²).
pub(super) struct Potential;

impl Kernel for Potential {
    type Sum = f64;

    #[inline(always)]
    fn near(mass: f64, _: [Lanes; 3], square: Lanes, [sums, ..]: &mut [Lanes; 3]) {
        for k in 0..LANES {
            sums[k] += mass / square[k].sqrt();
        }
    }

    #[inline(always)]
    fn far(node: &Source, d: [Lanes; 3], square: Lanes, [sums, ..]: &mut [Lanes; 3]) {
        for k in 0..LANES {
            let d = [d[0][k], d[1][k], d[2][k]];
            let inverse = 1.0 / square[k];
            let first = inverse.sqrt();
            let turned = node.turn(d);
            let along = d[0] * turned[0] + d[1] * turned[1] + d[2] * turned[2];
            sums[k] += first * (node.mass + inverse * (0.5 * along * inverse - node.trace * (1.0 / 3.0)));
        }
    }

    fn sum(sums: &[Lanes; 3], lane: usize) -> f64 {
        sums[0][lane]
    }
}
