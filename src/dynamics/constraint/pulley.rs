//! A pulley: a rope that runs over two points.

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Law, Members, Scale, parts};

/// A massless, frictionless rope that runs from one end over two points to the other end. The rope can be slack. Each end stays at least a
/// hundredth of the rope's length away from the point over which its part of the rope runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulley {
    /// The two ends of the rope.
    pub between: [Anchor; 2],
    /// The two points over which the rope runs, in the order of the ends.
    pub over: [Anchor; 2],
    /// The length that the first part of the rope gains for each meter that the second part loses. It is positive.
    pub ratio: f64,
    /// ℓ: the length of the first part of the rope plus `ratio` times that of the second part, m.
    pub length: f64,
}

impl Pulley {
    /// The smallest distance of an end of the rope from the point over which it runs, as a fraction of the rope's length.
    pub const NEAREST: f64 = 0.01;

    fn anchors(&self) -> [Anchor; 4] {
        [self.over[0], self.between[0], self.over[1], self.between[1]]
    }
}

impl Constraint for Pulley {
    fn ends(&self) -> Vec<Anchor> {
        self.anchors().to_vec()
    }

    fn rows(&self) -> usize {
        3
    }

    fn law(&self, _: usize) -> Law {
        Law::Inequality
    }

    /// Writes c = ℓ − |d₁| − r |d₂| ≥ 0, where d₁ and d₂ are the vectors from the points to the ends of the rope, and r is the ratio. Two
    /// more constraint rows keep |d₁| and |d₂| above the smallest distance.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let [a, b, c, d] = End::all(&self.anchors(), members);
        let [first, second] = [[a, b], [c, d]];
        let ways = [(&first, 1.0), (&second, self.ratio)];
        let ways = ways.map(|(ends, factor)| (parts::EndToEndVector::new(ends, self.length), factor));
        let sum = |value: fn(&parts::EndToEndVector<'_>) -> f64| -> f64 {
            ways.iter().map(|(way, factor)| factor * value(way)).sum()
        };
        let scale =
            ways.iter().fold(Scale::length(self.length, self.length), |scale, (way, _)| scale.max(way.scale));
        equations.row(0, self.length - sum(|way| way.length), -sum(|way| way.bias), scale);
        for (i, (way, factor)) in ways.iter().enumerate() {
            way.write(-factor, 0, equations);
            equations.row(
                1 + i,
                way.length - Pulley::NEAREST * self.length,
                way.bias,
                way.scale.at_least(self.length),
            );
            way.write(1.0, 1 + i, equations);
        }
    }
}
