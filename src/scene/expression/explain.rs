//! Evaluates a formula step by step and finds the first operation whose value is not finite.

use super::error::{ExpressionError, error};
use super::operation::{Binary, Ternary, Unary};
use super::parser::Id;
use super::resolve::{Resolved, Value};
use crate::diagnostic::Code;

impl Resolved {
    /// Returns the value of the formula. `inputs` are the numbers for the slots of the scope, followed by the random numbers.
    ///
    /// # Errors
    /// If any operation has a non-finite value, even if the result is finite: `min(1/0, 5)` is an error. The error describes the first of
    /// these operations.
    ///
    /// # Panics
    /// If there are fewer inputs than [`Resolved::inputs`].
    pub fn value(&self, inputs: &[f64]) -> Result<f64, ExpressionError> {
        match self.as_constant() {
            Some(value) => Ok(value),
            None => {
                let values = self.values(inputs);
                self.culprit(&values).map_or_else(|| Ok(values[self.root]), Err)
            }
        }
    }

    /// Computes the values of all subexpressions, including those that the result does not depend on.
    pub(super) fn values(&self, inputs: &[f64]) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let value = match node.value {
                Value::Constant(value) => value,
                Value::Slot(slot) => inputs[slot],
                Value::Unary(operation, a) => operation.apply(values[a]),
                Value::Binary(operation, a, b) => operation.apply(values[a], values[b]),
                Value::Ternary(operation, a, b, c) => operation.apply(values[a], values[b], values[c]),
                Value::If(a, b, c) => values[if values[a] == 0.0 { c } else { b }],
            };
            values.push(value);
        }
        values
    }

    /// Explains why the value of the formula is not finite, with the position in the text. `None` if all steps have finite values.
    ///
    /// # Panics
    /// If there are fewer inputs than [`Resolved::inputs`].
    pub fn explain_non_finite(&self, inputs: &[f64]) -> Option<ExpressionError> {
        self.culprit(&self.values(inputs))
    }

    /// Explains the first non-finite value among the subexpressions that the result depends on. `None` if all of them are finite.
    fn culprit(&self, values: &[f64]) -> Option<ExpressionError> {
        let mut is_used = vec![false; self.nodes.len()];
        is_used[self.root] = true;
        let mut first = None;
        for id in (0..=self.root).rev() {
            if !is_used[id] {
                continue;
            }
            if !values[id].is_finite() {
                first = Some(id);
            }
            match self.nodes[id].value {
                Value::Constant(_) | Value::Slot(_) => {}
                Value::Unary(_, a) => is_used[a] = true,
                Value::Binary(_, a, b) => [a, b].into_iter().for_each(|id| is_used[id] = true),
                Value::Ternary(_, a, b, c) => [a, b, c].into_iter().for_each(|id| is_used[id] = true),
                Value::If(a, b, c) => {
                    is_used[a] = true;
                    is_used[if values[a] == 0.0 { c } else { b }] = true;
                }
            }
        }
        // Operands have smaller ids than the operations that use them. Therefore, the operands of the first non-finite subexpression are
        // finite.
        first.map(|id| self.explain(id, values))
    }

    fn explain(&self, id: Id, values: &[f64]) -> ExpressionError {
        let node = &self.nodes[id];
        let here = node.range.clone();
        let not_finite = |message: String| error(Code::NotFinite, here.clone(), message);
        let by_zero = |divisor: Id, message: &str| {
            error(Code::DivisionByZero, self.nodes[divisor].range.clone(), message).label("this is 0")
        };
        let is_none = values[id].is_nan();
        let verdict = if is_none { "is not a number" } else { "is larger than any number" };
        let figure = |id: Id| figure(values[id]);
        match node.value {
            Value::Constant(_) | Value::Slot(_) | Value::If(..) => not_finite(format!("this {verdict}")),
            Value::Unary(operation, a) => match operation {
                Unary::Sqrt => not_finite(format!("the square root of {} {verdict}", figure(a))),
                Unary::Ln | Unary::Log2 | Unary::Log10 if values[a] == 0.0 => {
                    not_finite("the logarithm of 0 is not a number".to_owned())
                }
                Unary::Ln | Unary::Log2 | Unary::Log10 => {
                    not_finite(format!("the logarithm of {} {verdict}", figure(a)))
                }
                Unary::Asin | Unary::Acos if is_none => {
                    let word = if operation == Unary::Asin { "sine" } else { "cosine" };
                    not_finite(format!("no angle has the {word} {}", figure(a)))
                }
                Unary::Square => not_finite(format!("{}^2 {verdict}", figure(a))),
                Unary::Cube => not_finite(format!("{}^3 {verdict}", figure(a))),
                _ => {
                    let word = format!("{operation:?}").to_lowercase();
                    not_finite(format!("{word}({}) {verdict}", figure(a)))
                }
            },
            Value::Binary(operation, a, b) => match operation {
                Binary::Divide if values[b] == 0.0 => by_zero(b, "a division by zero"),
                Binary::Modulo if values[b] == 0.0 => by_zero(b, "the rest of a division by zero"),
                Binary::Power if values[a] == 0.0 => {
                    by_zero(a, "a negative power of zero is a division by zero")
                }
                Binary::Power if is_none => {
                    not_finite(format!("{}^{} is not a number", in_parentheses(values[a]), figure(b)))
                        .help("a negative number has only whole powers")
                }
                Binary::Power => not_finite(format!("{}^{} {verdict}", in_parentheses(values[a]), figure(b))),
                _ => match sign(operation) {
                    Some(sign) => not_finite(format!("{} {sign} {} {verdict}", figure(a), figure(b))),
                    None => {
                        let word = format!("{operation:?}").to_lowercase();
                        not_finite(format!("{word}({}, {}) {verdict}", figure(a), figure(b)))
                    }
                },
            },
            Value::Ternary(Ternary::Lerp, ..) => not_finite(format!("this {verdict}")),
            Value::Ternary(Ternary::Smoothstep, low, ..) => {
                by_zero(low, "the bounds of `smoothstep` are the same number").label("")
            }
        }
    }
}

fn sign(operation: Binary) -> Option<char> {
    match operation {
        Binary::Add => Some('+'),
        Binary::Subtract => Some('-'),
        Binary::Multiply => Some('*'),
        Binary::Divide => Some('/'),
        _ => None,
    }
}

/// Formats a number as it would be written in a formula. Very large and very small numbers get an exponent.
fn figure(number: f64) -> String {
    if number == 0.0 || (1e-5..1e15).contains(&number.abs()) {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

fn in_parentheses(number: f64) -> String {
    if number.is_sign_negative() { format!("({})", figure(number)) } else { figure(number) }
}
