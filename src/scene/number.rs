//! A number as a scene writes it.

use super::source::{Node, Value};

/// A number as a scene writes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number<'a> {
    /// Written as a number.
    Literal(f64),
    /// Written as a string: a formula that gives the number.
    Formula(&'a str),
}

impl<'a> Number<'a> {
    /// The number that a value is, if it can be one.
    pub fn of(node: &'a Node) -> Option<Number<'a>> {
        match &node.value {
            #[allow(
                clippy::cast_precision_loss,
                reason = "a scene's whole numbers are small; TOML's own floats round too"
            )]
            Value::Integer(number) => Some(Number::Literal(*number as f64)),
            Value::Float(number) => Some(Number::Literal(*number)),
            Value::String(formula) => Some(Number::Formula(formula)),
            _ => None,
        }
    }
}
