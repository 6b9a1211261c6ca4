//! A gear: it keeps the coordinates of two joints proportional.

use super::super::Anchor;
use super::coordinate::{Coordinate, CoordinateRow};
use super::member::End;
use super::{Constraint, Equations, Members};

/// A gear: it couples the free coordinates of two joints at a fixed ratio. The coordinate of a hinge is its angle, that of a slider its
/// displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    /// The free coordinates of the two coupled joints.
    pub joints: [Coordinate; 2],
    /// The gear ratio: the change of the second coordinate per unit change of the first. It is not 0.
    pub ratio: f64,
}

impl Gear {
    fn anchors(&self) -> [Anchor; 4] {
        let [[a, b], [c, d]] = self.joints.map(|joint| joint.between);
        [a, b, c, d]
    }
}

impl Constraint for Gear {
    fn ends(&self) -> Vec<Anchor> {
        self.anchors().to_vec()
    }

    fn rows(&self) -> usize {
        1
    }

    /// Writes c = Δq₂ − r Δq₁ with the gear ratio r. The changes Δq are measured from the start of the step, so full turns need not be
    /// counted.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let measure = |members: &Members<'_>| {
            let [a, b, c, d] = End::all(&self.anchors(), members);
            [self.joints[0].measure(&[a, b]), self.joints[1].measure(&[c, d])]
        };
        let (now, before) = (measure(members), measure(&members.at_origin()));
        let moved = |i: usize| self.joints[i].difference(now[i].value, before[i].value);
        let violation = moved(1) - self.ratio * moved(0);
        let terms = &[(-self.ratio, now[0]), (1.0, now[1])];
        CoordinateRow { row: 0, terms, violation, rate: 0.0, curvature: 0.0 }.write(equations);
    }
}
