//! Differentiates a formula symbolically with respect to one of its inputs.

use std::f64::consts::{LN_2, LN_10};
use std::ops::Range;

use super::fold::Builder;
use super::operation::{Binary, Ternary, Unary};
use super::parser::Id;
use super::resolve::{Resolved, Value};

impl Resolved {
    /// Returns the derivative with respect to the input `slot`, as another formula. Where the formula has a kink or a jump, the result is
    /// a one-sided derivative.
    ///
    /// All random numbers of the formula must have been drawn before: see [`Resolved::with_draws`].
    #[must_use]
    pub fn derivative(&self, slot: usize) -> Resolved {
        let mut deriver = Deriver {
            builder: Builder::default(),
            slot,
            range: 0..0,
            slopes: Vec::with_capacity(self.nodes.len()),
        };
        // The derivative contains subexpressions of the formula. All nodes are copied first, so that these keep their ids.
        deriver.builder.nodes.clone_from(&self.nodes);
        for node in &self.nodes {
            deriver.range = node.range.clone();
            let slope = deriver.slope(node.value);
            deriver.slopes.push(slope);
        }
        let root = deriver.slopes.get(self.root).copied().flatten();
        let root = root.unwrap_or_else(|| deriver.builder.constant(0.0, 0..0));
        self.with_nodes(deriver.builder.nodes, root)
    }
}

impl Resolved {
    /// Returns the number of operations in the compiled program. A subexpression that is used several times counts each time, because the
    /// program computes it each time.
    #[must_use]
    pub(in crate::scene) fn operations(&self) -> u64 {
        let mut sizes: Vec<u64> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let of = |ids: &[Id]| ids.iter().fold(1, |sum: u64, id| sum.saturating_add(sizes[*id]));
            let size = match node.value {
                Value::Constant(_) | Value::Slot(_) => 1,
                Value::Unary(_, a) => of(&[a]),
                Value::Binary(_, a, b) => of(&[a, b]),
                Value::Ternary(_, a, b, c) | Value::If(a, b, c) => of(&[a, b, c]),
            };
            sizes.push(size);
        }
        sizes.get(self.root).copied().unwrap_or(0)
    }
}

struct Deriver {
    builder: Builder,
    slot: usize,
    /// The byte range, in the text of the formula, of the subexpression that is being differentiated.
    range: Range<usize>,
    /// The derivative of each subexpression, by its id. `None` for a derivative that is zero.
    slopes: Vec<Option<Id>>,
}

impl Deriver {
    fn slope(&mut self, value: Value) -> Option<Id> {
        match value {
            Value::Constant(_) => None,
            Value::Slot(slot) => (slot == self.slot).then(|| self.constant(1.0)),
            Value::Unary(operation, a) => {
                let slope = self.slopes[a]?;
                self.unary(operation, a, slope)
            }
            Value::Binary(operation, a, b) => self.binary(operation, a, b),
            Value::Ternary(operation, a, b, c) => self.ternary(operation, [a, b, c]),
            Value::If(condition, a, b) => {
                let (then, otherwise) = (self.slopes[a], self.slopes[b]);
                self.choice(condition, then, otherwise)
            }
        }
    }

    /// Differentiates a function of one argument by the chain rule: (f(u))' = f'(u) u'. `slope` is u'.
    fn unary(&mut self, operation: Unary, u: Id, slope: Id) -> Option<Id> {
        let outer = match operation {
            Unary::Not | Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc => {
                return None;
            }
            Unary::Negate | Unary::Degrees | Unary::Radians => return Some(self.apply(operation, slope)),
            Unary::Square => self.scaled(2.0, u),
            Unary::Cube => {
                let square = self.apply(Unary::Square, u);
                self.scaled(3.0, square)
            }
            Unary::Sin => self.apply(Unary::Cos, u),
            Unary::Cos => {
                let sin = self.apply(Unary::Sin, u);
                self.apply(Unary::Negate, sin)
            }
            Unary::Tan => {
                let square = self.square_of(Unary::Tan, u);
                self.plus(1.0, square)
            }
            Unary::Tanh => {
                let square = self.square_of(Unary::Tanh, u);
                self.minus(1.0, square)
            }
            Unary::Sinh => self.apply(Unary::Cosh, u),
            Unary::Cosh => self.apply(Unary::Sinh, u),
            Unary::Exp => self.apply(Unary::Exp, u),
            Unary::Abs => self.apply(Unary::Sign, u),
            Unary::Asin | Unary::Acos => {
                let square = self.apply(Unary::Square, u);
                let rest = self.minus(1.0, square);
                let root = self.apply(Unary::Sqrt, rest);
                let part = self.quotient(slope, root);
                return Some(if operation == Unary::Acos { self.apply(Unary::Negate, part) } else { part });
            }
            Unary::Atan => {
                let square = self.apply(Unary::Square, u);
                let sum = self.plus(1.0, square);
                return Some(self.quotient(slope, sum));
            }
            Unary::Ln => return Some(self.quotient(slope, u)),
            Unary::Log10 | Unary::Log2 => {
                let scaled = self.scaled(if operation == Unary::Log2 { LN_2 } else { LN_10 }, u);
                return Some(self.quotient(slope, scaled));
            }
            Unary::Sqrt => {
                let root = self.apply(Unary::Sqrt, u);
                let twice = self.scaled(2.0, root);
                return Some(self.quotient_or_zero(slope, twice));
            }
            Unary::Cbrt => {
                let square = self.square_of(Unary::Cbrt, u);
                let thrice = self.scaled(3.0, square);
                return Some(self.quotient_or_zero(slope, thrice));
            }
        };
        Some(self.product(outer, slope))
    }

    fn binary(&mut self, operation: Binary, u: Id, v: Id) -> Option<Id> {
        let (du, dv) = (self.slopes[u], self.slopes[v]);
        if du.is_none() && dv.is_none() {
            return None;
        }
        match operation {
            Binary::Add => self.sum(du, dv),
            Binary::Subtract => self.difference(du, dv),
            Binary::Multiply => {
                let (left, right) = (du.map(|du| self.product(du, v)), dv.map(|dv| self.product(u, dv)));
                self.sum(left, right)
            }
            // The quotient rule: (u/v)' = (u' − (u/v) v') / v.
            Binary::Divide => {
                let part = dv.map(|dv| {
                    let ratio = self.quotient(u, v);
                    self.product(ratio, dv)
                });
                self.difference(du, part).map(|top| self.quotient(top, v))
            }
            // The remainder is u − v floor(u/v), so its derivative is u' − floor(u/v) v'.
            Binary::Modulo => {
                let part = dv.map(|dv| {
                    let ratio = self.quotient(u, v);
                    let whole = self.apply(Unary::Floor, ratio);
                    self.product(whole, dv)
                });
                self.difference(du, part)
            }
            Binary::Power => self.power(u, v, du, dv),
            Binary::Less
            | Binary::LessEqual
            | Binary::Greater
            | Binary::GreaterEqual
            | Binary::Equal
            | Binary::NotEqual
            | Binary::Step => None,
            // The derivative of the angle: atan2(y, x)' = (x y' − y x') / (x² + y²).
            Binary::Atan2 => {
                let (left, right) = (du.map(|du| self.product(v, du)), dv.map(|dv| self.product(u, dv)));
                let top = self.difference(left, right)?;
                let (y, x) = (self.apply(Unary::Square, u), self.apply(Unary::Square, v));
                let sum = self.two(Binary::Add, x, y);
                Some(self.quotient(top, sum))
            }
            Binary::Hypot => {
                let (left, right) = (du.map(|du| self.product(u, du)), dv.map(|dv| self.product(v, dv)));
                let top = self.sum(left, right)?;
                let length = self.two(Binary::Hypot, u, v);
                Some(self.quotient_or_zero(top, length))
            }
            Binary::Min | Binary::Max => {
                let less =
                    self.two(if operation == Binary::Min { Binary::Less } else { Binary::Greater }, u, v);
                self.choice(less, du, dv)
            }
        }
    }

    /// Differentiates a power: (uᵛ)' = v uᵛ⁻¹ u' + uᵛ ln(u) v'. `du` is u' and `dv` is v'; `None` means zero.
    fn power(&mut self, u: Id, v: Id, du: Option<Id>, dv: Option<Id>) -> Option<Id> {
        let left = du.map(|du| {
            let one = self.constant(1.0);
            let less = self.two(Binary::Subtract, v, one);
            let power = self.two(Binary::Power, u, less);
            let scaled = self.product(v, power);
            self.product(scaled, du)
        });
        let right = dv.map(|dv| {
            let (power, log) = (self.two(Binary::Power, u, v), self.apply(Unary::Ln, u));
            let scaled = self.product(power, log);
            self.product(scaled, dv)
        });
        self.sum(left, right)
    }

    fn ternary(&mut self, operation: Ternary, [a, b, c]: [Id; 3]) -> Option<Id> {
        let [da, db, dc] = [a, b, c].map(|id| self.slopes[id]);
        if da.is_none() && db.is_none() && dc.is_none() {
            return None;
        }
        let whole = self.two(Binary::Subtract, b, a);
        let slope_of_whole = self.difference(db, da);
        match operation {
            // The linear interpolation is a + (b − a) c. Its derivative is a' + (b' − a') c + (b − a) c'.
            Ternary::Lerp => {
                let part = slope_of_whole.map(|slope| self.product(slope, c));
                let turn = dc.map(|dc| self.product(whole, dc));
                let sum = self.sum(part, turn);
                self.sum(da, sum)
            }
            // The derivative is 6 p (1 − p) p' with p = (c − a) / (b − a), and 0 where p is outside of 0 … 1.
            Ternary::Smoothstep => {
                let above = self.two(Binary::Subtract, c, a);
                let part = self.quotient(above, whole);
                let stretched = slope_of_whole.map(|slope| self.product(part, slope));
                let top = self.difference(dc, da);
                let top = self.difference(top, stretched)?;
                let slope = self.quotient(top, whole);
                let rest = self.minus(1.0, part);
                let product = self.product(part, rest);
                let zero = self.constant(0.0);
                let inside = self.two(Binary::Greater, product, zero);
                let six = self.scaled(6.0, product);
                let value = self.product(six, slope);
                self.choice(inside, Some(value), None)
            }
        }
    }

    fn constant(&mut self, value: f64) -> Id {
        self.builder.constant(value, self.range.clone())
    }

    fn apply(&mut self, operation: Unary, a: Id) -> Id {
        self.builder.unary(operation, a, self.range.clone())
    }

    fn two(&mut self, operation: Binary, a: Id, b: Id) -> Id {
        self.builder.binary(operation, a, b, self.range.clone())
    }

    fn product(&mut self, a: Id, b: Id) -> Id {
        self.two(Binary::Multiply, a, b)
    }

    fn quotient(&mut self, a: Id, b: Id) -> Id {
        self.two(Binary::Divide, a, b)
    }

    /// Returns the quotient a / b, or 0 where a is 0. With it, the derivative of √u, which is u'/(2√u), becomes 0 where both u and u' are
    /// 0.
    fn quotient_or_zero(&mut self, a: Id, b: Id) -> Id {
        let (quotient, zero) = (self.quotient(a, b), self.constant(0.0));
        self.builder.choice(a, quotient, zero, self.range.clone())
    }

    fn square_of(&mut self, operation: Unary, a: Id) -> Id {
        let value = self.apply(operation, a);
        self.apply(Unary::Square, value)
    }

    fn scaled(&mut self, factor: f64, a: Id) -> Id {
        let factor = self.constant(factor);
        self.product(factor, a)
    }

    fn plus(&mut self, number: f64, a: Id) -> Id {
        let number = self.constant(number);
        self.two(Binary::Add, number, a)
    }

    fn minus(&mut self, number: f64, a: Id) -> Id {
        let number = self.constant(number);
        self.two(Binary::Subtract, number, a)
    }

    /// Returns the sum of two derivatives. `None` means zero.
    fn sum(&mut self, a: Option<Id>, b: Option<Id>) -> Option<Id> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.two(Binary::Add, a, b)),
            (one, None) | (None, one) => one,
        }
    }

    fn difference(&mut self, a: Option<Id>, b: Option<Id>) -> Option<Id> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.two(Binary::Subtract, a, b)),
            (None, Some(b)) => Some(self.apply(Unary::Negate, b)),
            (a, None) => a,
        }
    }

    fn choice(&mut self, condition: Id, then: Option<Id>, otherwise: Option<Id>) -> Option<Id> {
        if then.is_none() && otherwise.is_none() {
            return None;
        }
        let then = then.unwrap_or_else(|| self.constant(0.0));
        let otherwise = otherwise.unwrap_or_else(|| self.constant(0.0));
        Some(self.builder.choice(condition, then, otherwise, self.range.clone()))
    }
}
