//! Builds the tree of a resolved formula and computes its constant parts.

use std::ops::Range;

use super::operation::{Binary, Ternary, Unary};
use super::parser::Id;
use super::resolve::{Node, Value};

/// A tree under construction.
///
/// A constant part with a non-finite value stays an operation, so that an evaluation can name the operation that
/// failed.
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
            // The product has the same bits as the power.
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
            // Copy the branch, so that the last node is the root.
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
