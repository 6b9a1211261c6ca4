//! Resolves the names of a formula: each becomes a number or a slot.

use crate::diagnostic::Code;
use std::ops::Range;

use super::error::{ExpressionError, error};
use super::fold::Builder;
use super::function::{Function, Work};
use super::operation::{Binary, Ternary, Unary};
use super::parser::{Formula, Id, Part};
use super::scope::{Binding, Scope};
use crate::scene::units;

/// A random number for one `uniform` or `normal` in a formula.
///
/// A formula draws no random numbers by itself. For each `uniform` and `normal`, in the order of the text, the caller
/// passes one number after the inputs for the names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Draw {
    /// A number from 0 to 1, with uniform distribution.
    Uniform,
    /// A number with normal distribution, mean 0 and standard deviation 1.
    Normal,
}

/// A formula with resolved names.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// The nodes. Operands come before the operations that use them. Unused nodes may stand between.
    pub(super) nodes: Vec<Node>,
    pub(super) root: Id,
    pub(super) slots: usize,
    draws: Vec<Draw>,
}

/// A part of a resolved formula, and its range in the text.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) value: Value,
    pub(super) range: Range<usize>,
}

/// A part of a resolved formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Constant(f64),
    Slot(usize),
    Unary(Unary, Id),
    Binary(Binary, Id, Id),
    Ternary(Ternary, Id, Id, Id),
    /// The second part if the first is not 0, else the third. A program computes only one of the two.
    If(Id, Id, Id),
}

impl Formula {
    /// Resolves the names of the formula.
    ///
    /// # Errors
    /// Unknown names, and random numbers if the scope does not allow them.
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
    /// The random numbers that an evaluation needs, after the inputs for the names.
    pub fn draws(&self) -> &[Draw] {
        &self.draws
    }

    /// The number of inputs of an evaluation: one for each slot of the scope, then one for each draw.
    pub fn inputs(&self) -> usize {
        self.slots + self.draws.len()
    }

    /// A number as a formula with `slots` slots, none of which it uses.
    pub(in crate::scene) fn of_number(value: f64, slots: usize) -> Resolved {
        Resolved {
            nodes: vec![Node { value: Value::Constant(value), range: 0..0 }],
            root: 0,
            slots,
            draws: Vec::new(),
        }
    }

    /// The value of the formula, if it is a constant.
    pub fn as_constant(&self) -> Option<f64> {
        match self.nodes.get(self.root)?.value {
            Value::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// A formula with the same slots and draws, but another tree.
    pub(super) fn with_nodes(&self, nodes: Vec<Node>, root: Id) -> Resolved {
        Resolved { nodes, root, slots: self.slots, draws: self.draws.clone() }
    }

    /// The same formula with fixed random numbers: an evaluation then needs only the inputs for the names.
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
    /// Resolves a part. `ids` are the resolved ids of the earlier parts.
    fn node(&mut self, text: &str, part: &Part, range: &Range<usize>, ids: &[Id]) -> Id {
        let here = range.clone();
        match part {
            Part::Number(number) => self.builder.constant(*number, here),
            Part::Name(name) => self.name(&text[name.clone()], here),
            Part::Unary(operation, a) => self.builder.unary(*operation, ids[*a], here),
            Part::Binary(operation, a, b) => self.builder.binary(*operation, ids[*a], ids[*b], here),
            Part::And(a, b) => {
                let (b, no) = (self.truth(ids[*b], range), self.builder.constant(0.0, here.clone()));
                self.builder.choice(ids[*a], b, no, here)
            }
            Part::Or(a, b) => {
                let (b, yes) = (self.truth(ids[*b], range), self.builder.constant(1.0, here.clone()));
                self.builder.choice(ids[*a], yes, b, here)
            }
            Part::Call(function, values) => {
                let values: Vec<Id> = values.iter().map(|value| ids[*value]).collect();
                self.call(function, &values, range)
            }
        }
    }

    /// Emits a part that is 1 where a value is not 0, and 0 elsewhere.
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
            // Unreachable: the parser checks the number of arguments.
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
        "i" | "j" | "k" => error.label("only a body with a `repeat` of so many directions has this index"),
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
