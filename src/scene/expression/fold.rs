//! Builds the expression tree of a formula and computes constant subexpressions (constant folding).

use std::ops::Range;

use super::operation::{Binary, Ternary, Unary};
use super::parser::Id;
use super::resolve::{Node, Value};

/// Builds the expression tree of a formula.
///
/// A constant subexpression with a non-finite value stays an operation, so that the error of a later evaluation can name that operation.
#[derive(Default)]
pub(super) struct Builder {
    pub(super) nodes: Vec<Node>,
}

impl Builder {
    pub(super) fn constant(&mut self, value: f64, range: Range<usize>) -> Id {
        self.push(Value::Constant(value), range)
    }

    pub(super) fn slot(&mut self, slot: usize, range: Range<usize>) -> Id {
        self.push(Value::Slot(slot), range)
    }

    pub(super) fn unary(&mut self, operation: Unary, a: Id, range: Range<usize>) -> Id {
        let folded = self.known(a).map(|a| operation.apply(a));
        self.folded(folded, Value::Unary(operation, a), range)
    }

    pub(super) fn binary(&mut self, operation: Binary, a: Id, b: Id, range: Range<usize>) -> Id {
        let folded = self.known(a).zip(self.known(b)).map(|(a, b)| operation.apply(a, b));
        let value = match (operation, self.known(b)) {
            // For an input x, the product x·x has the same bits as x^2, and compiles to a single instruction.
            (Binary::Power, Some(2.0)) if matches!(self.nodes[a].value, Value::Slot(_)) => {
                Value::Binary(Binary::Multiply, a, a)
            }
            (Binary::Power, Some(2.0)) => Value::Unary(Unary::Square, a),
            (Binary::Power, Some(3.0)) => Value::Unary(Unary::Cube, a),
            _ => Value::Binary(operation, a, b),
        };
        self.folded(folded, value, range)
    }

    pub(super) fn ternary(&mut self, operation: Ternary, [a, b, c]: [Id; 3], range: Range<usize>) -> Id {
        let known = self.known(a).zip(self.known(b)).zip(self.known(c));
        let folded = known.map(|((a, b), c)| operation.apply(a, b, c));
        self.folded(folded, Value::Ternary(operation, a, b, c), range)
    }

    pub(super) fn choice(&mut self, condition: Id, then: Id, otherwise: Id, range: Range<usize>) -> Id {
        match self.known(condition) {
            // The chosen branch is copied to the end, because the last node must be the root of the tree.
            Some(0.0) => self.push(self.nodes[otherwise].value, range),
            Some(_) => self.push(self.nodes[then].value, range),
            None => self.push(Value::If(condition, then, otherwise), range),
        }
    }

    fn known(&self, id: Id) -> Option<f64> {
        match self.nodes[id].value {
            Value::Constant(value) => Some(value),
            _ => None,
        }
    }

    fn folded(&mut self, folded: Option<f64>, value: Value, range: Range<usize>) -> Id {
        match folded.filter(|value| value.is_finite()) {
            Some(value) => self.push(Value::Constant(value), range),
            None => self.push(value, range),
        }
    }

    fn push(&mut self, value: Value, range: Range<usize>) -> Id {
        self.nodes.push(Node { value, range });
        self.nodes.len() - 1
    }
}
