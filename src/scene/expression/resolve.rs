//! Resolves the names in a formula: each becomes a constant or the index of an input.

use crate::diagnostic::Code;
use std::ops::Range;

use super::error::{ExpressionError, error};
use super::fold::Builder;
use super::function::{Function, Work};
use super::operation::{Binary, Ternary, Unary};
use super::parser::{Formula, Id, Subexpression};
use super::scope::{Binding, Scope};
use crate::scene::units;

/// The distribution of a random number in a formula: uniform or normal.
///
/// A formula draws no random numbers by itself. The caller passes a number for each `uniform` and `normal`, in the order of the text,
/// after the inputs for the variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Draw {
    /// A uniformly distributed number from 0 to 1.
    Uniform,
    /// A normally distributed number with mean 0 and standard deviation 1.
    Normal,
}

/// A formula whose names have been resolved to constants and inputs.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// The nodes of the expression tree. Operands come before the operations that use them. Some nodes may be unused.
    pub(super) nodes: Vec<Node>,
    pub(super) root: Id,
    pub(super) slots: usize,
    draws: Vec<Draw>,
}

/// A subexpression of a resolved formula, with its byte range in the text.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) value: Value,
    pub(super) range: Range<usize>,
}

/// A subexpression of a resolved formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Constant(f64),
    Slot(usize),
    Unary(Unary, Id),
    Binary(Binary, Id, Id),
    Ternary(Ternary, Id, Id, Id),
    /// A conditional: the second operand if the first is not 0, otherwise the third. A program computes only the one that is chosen.
    If(Id, Id, Id),
}

impl Formula {
    /// Resolves the names in the formula to the constants and slots of the scope.
    ///
    /// # Errors
    /// If a name is unknown, or if the formula uses random numbers and the scope does not allow them.
    pub fn resolve(&self, scope: &Scope) -> Result<Resolved, Vec<ExpressionError>> {
        let mut resolver =
            Resolver { scope, builder: Builder::default(), draws: Vec::new(), errors: Vec::new() };
        let mut ids: Vec<Id> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let id = resolver.node(self.text(), &node.part, &node.range, &ids);
            ids.push(id);
        }
        if !resolver.errors.is_empty() {
            return Err(resolver.errors);
        }
        Ok(Resolved {
            nodes: resolver.builder.nodes,
            root: ids.last().copied().unwrap_or(0),
            slots: scope.slots(),
            draws: resolver.draws,
        })
    }
}

impl Resolved {
    /// Returns the distributions of the random numbers that an evaluation needs. The numbers follow the inputs for the variables in this
    /// order.
    pub fn draws(&self) -> &[Draw] {
        &self.draws
    }

    /// Returns the number of inputs of an evaluation: one for each slot of the scope, and one for each random number.
    pub fn inputs(&self) -> usize {
        self.slots + self.draws.len()
    }

    /// Makes a formula whose value is a constant. It accepts `slots` inputs and uses none of them.
    pub(in crate::scene) fn of_number(value: f64, slots: usize) -> Resolved {
        Resolved {
            nodes: vec![Node { value: Value::Constant(value), range: 0..0 }],
            root: 0,
            slots,
            draws: Vec::new(),
        }
    }

    /// Returns the value of the formula if the formula is a constant.
    pub fn as_constant(&self) -> Option<f64> {
        match self.nodes.get(self.root)?.value {
            Value::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// Returns a formula with the same inputs and random numbers, but another expression tree.
    pub(super) fn with_nodes(&self, nodes: Vec<Node>, root: Id) -> Resolved {
        Resolved { nodes, root, slots: self.slots, draws: self.draws.clone() }
    }

    /// Returns the same formula with its random numbers replaced by the numbers `drawn`. An evaluation then needs only the inputs for the
    /// variables.
    #[must_use]
    pub fn with_draws(&self, drawn: &[f64]) -> Resolved {
        let mut builder = Builder::default();
        let mut ids: Vec<Id> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let range = node.range.clone();
            let id = match node.value {
                Value::Constant(value) => builder.constant(value, range),
                Value::Slot(slot) => match slot.checked_sub(self.slots).and_then(|draw| drawn.get(draw)) {
                    Some(value) => builder.constant(*value, range),
                    None => builder.slot(slot, range),
                },
                Value::Unary(operation, a) => builder.unary(operation, ids[a], range),
                Value::Binary(operation, a, b) => builder.binary(operation, ids[a], ids[b], range),
                Value::Ternary(operation, a, b, c) => {
                    builder.ternary(operation, [ids[a], ids[b], ids[c]], range)
                }
                Value::If(a, b, c) => builder.choice(ids[a], ids[b], ids[c], range),
            };
            ids.push(id);
        }
        let root = ids.get(self.root).copied().unwrap_or(0);
        Resolved { nodes: builder.nodes, root, slots: self.slots, draws: Vec::new() }
    }
}

struct Resolver<'a> {
    scope: &'a Scope,
    builder: Builder,
    draws: Vec<Draw>,
    errors: Vec<ExpressionError>,
}

impl Resolver<'_> {
    /// Resolves a subexpression and returns its new id. `ids` are the new ids of the subexpressions before it.
    fn node(&mut self, text: &str, part: &Subexpression, range: &Range<usize>, ids: &[Id]) -> Id {
        let here = range.clone();
        match part {
            Subexpression::Number(number) => self.builder.constant(*number, here),
            Subexpression::Name(name) => self.name(&text[name.clone()], here),
            Subexpression::Unary(operation, a) => self.builder.unary(*operation, ids[*a], here),
            Subexpression::Binary(operation, a, b) => self.builder.binary(*operation, ids[*a], ids[*b], here),
            Subexpression::And(a, b) => {
                let (b, no) = (self.truth(ids[*b], range), self.builder.constant(0.0, here.clone()));
                self.builder.choice(ids[*a], b, no, here)
            }
            Subexpression::Or(a, b) => {
                let (b, yes) = (self.truth(ids[*b], range), self.builder.constant(1.0, here.clone()));
                self.builder.choice(ids[*a], yes, b, here)
            }
            Subexpression::Call(function, values) => {
                let values: Vec<Id> = values.iter().map(|value| ids[*value]).collect();
                self.call(function, &values, range)
            }
        }
    }

    /// Adds a subexpression that is 1 where the value of `id` is not 0, and 0 elsewhere.
    fn truth(&mut self, id: Id, range: &Range<usize>) -> Id {
        let zero = self.builder.constant(0.0, range.clone());
        self.builder.binary(Binary::NotEqual, id, zero, range.clone())
    }

    fn name(&mut self, name: &str, range: Range<usize>) -> Id {
        match self.scope.get(name) {
            Some(Binding::Constant(value)) => self.builder.constant(value, range),
            Some(Binding::Slot(slot)) => self.builder.slot(slot, range),
            None => {
                self.errors.push(unknown(name, range.clone(), self.scope));
                self.builder.constant(0.0, range)
            }
        }
    }

    fn call(&mut self, function: &Function, values: &[Id], range: &Range<usize>) -> Id {
        let here = range.clone();
        match (function.work, values) {
            (Work::One(operation), &[a]) => self.builder.unary(operation, a, here),
            (Work::Two(operation), &[a, b]) => self.builder.binary(operation, a, b, here),
            (Work::Three(operation), &[a, b, c]) => self.builder.ternary(operation, [a, b, c], here),
            (Work::Clamp, &[x, low, high]) => {
                let above = self.builder.binary(Binary::Max, x, low, here.clone());
                self.builder.binary(Binary::Min, above, high, here)
            }
            (Work::If, &[condition, then, otherwise]) => {
                self.builder.choice(condition, then, otherwise, here)
            }
            (Work::Uniform, &[low, high]) => {
                let draw = self.draw(Draw::Uniform, range);
                self.builder.ternary(Ternary::Lerp, [low, high, draw], here)
            }
            (Work::Normal, &[mean, deviation]) => {
                let draw = self.draw(Draw::Normal, range);
                let off = self.builder.binary(Binary::Multiply, deviation, draw, here.clone());
                self.builder.binary(Binary::Add, mean, off, here)
            }
            (Work::Chain(operation), [first, rest @ ..]) => rest
                .iter()
                .fold(*first, |so_far, next| self.builder.binary(operation, so_far, *next, range.clone())),
            // Unreachable, because the parser has checked the number of arguments.
            _ => self.builder.constant(0.0, here),
        }
    }

    fn draw(&mut self, draw: Draw, range: &Range<usize>) -> Id {
        if !self.scope.is_random() {
            let message = "there are no random numbers here";
            self.errors.push(error(Code::FormulaSyntax, range.clone(), message));
        }
        self.draws.push(draw);
        self.builder.slot(self.scope.slots() + self.draws.len() - 1, range.clone())
    }
}

fn unknown(name: &str, range: Range<usize>, scope: &Scope) -> ExpressionError {
    if let Some(function) = Function::named(name) {
        let message = format!("`{name}` is a function, and its values stand in parentheses");
        return error(Code::FormulaSyntax, range, message).label(format!("write `{}`", function.usage()));
    }
    let error = error(Code::UnknownName, range, format!("there is no variable `{name}`"));
    match name {
        "t" => error.label("this number is set once, before the time begins"),
        "i" => error.label("only copies have this index: write a `repeat`"),
        "j" | "k" if !scope.has_fields() => {
            error.label("only a body with a `repeat` of so many directions has this index")
        }
        "inf" | "nan" => error.label("the numbers of a scene are finite"),
        _ => {
            let label = scope.suggest(name);
            let near = label.strip_prefix("did you mean `").and_then(|rest| rest.strip_suffix("`?"));
            let near = near.map(str::to_owned);
            if let (None, Some(factor)) = (&near, units::of_several_letters(name)) {
                let number = units::written(factor);
                return error.label(format!("a unit is a number: {number} in SI units")).fix(number);
            }
            let error = error.label(label);
            match near {
                Some(near) => error.fix(near),
                None => error
                    .help("where a number stands, a string is a formula, with the names of `[variables]`"),
            }
        }
    }
}
