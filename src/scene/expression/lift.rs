//! Turns the constants of formulas into inputs. Formulas that differ only in their constants, such as those of copies, then share one
//! program.

use std::collections::HashMap;

use super::operation::{Binary, whole_exponent};
use super::parser::Id;
use super::resolve::{Node, Resolved, Value};

/// The distinct constants of formulas. A program takes them as inputs, after the inputs for the formulas' variables.
#[derive(Default)]
pub struct Constants {
    values: Vec<f64>,
    /// The index in `values` of each constant. The key is the bits of the constant.
    places: HashMap<u64, usize>,
}

impl Constants {
    /// Returns the constants, in the order in which a program takes them as inputs.
    pub fn into_values(self) -> Box<[f64]> {
        self.values.into()
    }

    fn place(&mut self, value: f64) -> usize {
        let next = self.values.len();
        let place = *self.places.entry(value.to_bits()).or_insert(next);
        if place == next {
            self.values.push(value);
        }
        place
    }
}

impl Resolved {
    /// Returns the same formula with its constants as inputs, placed after the inputs for the variables, and without unused subexpressions.
    /// The values of both formulas have the same bits, because instructions on constants and on inputs do the same arithmetic.
    ///
    /// Small whole exponents stay constants, because each of them is computed by its own sequence of products.
    pub fn lifted(&self, constants: &mut Constants) -> Resolved {
        let (is_used, is_exponent) = self.uses();
        let mut nodes: Vec<Node> = Vec::new();
        let mut ids: Vec<Id> = vec![0; self.nodes.len()];
        for (id, node) in self.nodes.iter().enumerate().filter(|(id, _)| is_used[*id]) {
            let value = match node.value {
                Value::Constant(value) if is_exponent[id] => Value::Constant(value),
                Value::Constant(value) => Value::Slot(self.slots + constants.place(value)),
                Value::Slot(slot) => Value::Slot(slot),
                Value::Unary(operation, a) => Value::Unary(operation, ids[a]),
                Value::Binary(operation, a, b) => Value::Binary(operation, ids[a], ids[b]),
                Value::Ternary(operation, a, b, c) => Value::Ternary(operation, ids[a], ids[b], ids[c]),
                Value::If(a, b, c) => Value::If(ids[a], ids[b], ids[c]),
            };
            ids[id] = nodes.len();
            nodes.push(Node { value, range: node.range.clone() });
        }
        let mut lifted = self.with_nodes(nodes, ids[self.root]);
        lifted.slots = self.slots + constants.values.len();
        lifted
    }

    /// Returns, for each subexpression by its id, true if the value of the formula depends on it.
    pub(super) fn parts_in_use(&self) -> Vec<bool> {
        self.uses().0
    }

    /// Returns two lists with an item for each subexpression: true if the value of the formula depends on it, and true if it is a whole
    /// exponent.
    fn uses(&self) -> (Vec<bool>, Vec<bool>) {
        let mut is_used = vec![false; self.nodes.len()];
        let mut is_exponent = vec![false; self.nodes.len()];
        is_used[self.root] = true;
        for id in (0..=self.root).rev() {
            if !is_used[id] {
                continue;
            }
            let value = self.nodes[id].value;
            if let Value::Binary(Binary::Power, _, exponent) = value
                && let Value::Constant(number) = self.nodes[exponent].value
            {
                is_exponent[exponent] |= whole_exponent(number).is_some();
            }
            for operand in operands(value) {
                is_used[operand] = true;
            }
        }
        (is_used, is_exponent)
    }

    /// Appends an encoding of the formula to `words`. Formulas with the same encoding have the same program.
    pub fn spell(&self, words: &mut Vec<u64>) {
        for node in &self.nodes {
            let (kind, operation) = match node.value {
                Value::Constant(_) => (0, 0),
                Value::Slot(_) => (1, 0),
                Value::Unary(operation, _) => (2, operation as u64),
                Value::Binary(operation, ..) => (3, operation as u64),
                Value::Ternary(operation, ..) => (4, operation as u64),
                Value::If(..) => (5, 0),
            };
            words.push(kind << 32 | operation);
            match node.value {
                Value::Constant(value) => words.push(value.to_bits()),
                Value::Slot(slot) => words.push(slot as u64),
                value => words.extend(operands(value).map(|operand| operand as u64)),
            }
        }
        // No subexpression is encoded by a first word of `u64::MAX`, so this word marks the end of the subexpressions.
        words.extend([u64::MAX, self.root as u64]);
    }

    /// Returns the range of each subexpression in the text of the formula: its start and end, in bytes.
    pub fn ranges(&self) -> Box<[[u32; 2]]> {
        #[allow(clippy::cast_possible_truncation, reason = "a formula is at most ten thousand bytes long")]
        let range = |node: &Node| [node.range.start as u32, node.range.end as u32];
        self.nodes.iter().map(range).collect()
    }

    /// Returns the same formula, with its subexpressions at other ranges of a text: see [`Resolved::ranges`].
    #[must_use]
    pub fn at(&self, ranges: &[[u32; 2]]) -> Resolved {
        let nodes = self
            .nodes
            .iter()
            .zip(ranges)
            .map(|(node, [start, end])| Node { value: node.value, range: *start as usize..*end as usize });
        self.with_nodes(nodes.collect(), self.root)
    }
}

fn operands(value: Value) -> impl Iterator<Item = Id> {
    let operands = match value {
        Value::Constant(_) | Value::Slot(_) => [None; 3],
        Value::Unary(_, a) => [Some(a), None, None],
        Value::Binary(_, a, b) => [Some(a), Some(b), None],
        Value::Ternary(_, a, b, c) | Value::If(a, b, c) => [Some(a), Some(b), Some(c)],
    };
    operands.into_iter().flatten()
}
