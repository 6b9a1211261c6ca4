//! A tree with formulas → the same tree with their values.
//!
//! The description of the language says where numbers stand; a string there is a formula. Each is replaced by its value, which
//! keeps the place of the string, so that all that comes after sees numbers only. What has no value becomes
//! [`Value::Invalid`], after it has been said why.

pub(super) mod place;
mod random;
#[cfg(test)]
mod tests;
mod variables;

use std::collections::HashSet;
use std::fmt::Write as _;

use self::random::Stream;
use super::expression::{Draw, ExpressionError, Formula, Resolved, Scope};
use super::grammar::{Kind, SCENE, TableSpec};
use super::source::{Node, Table, Value};
use crate::diagnostic::{Diagnostic, Sources, Span};

/// Replaces every formula of a scene by its value.
pub(super) fn expand(root: &mut Table, sources: &Sources, diagnostics: &mut Vec<Diagnostic>) {
    let mut expander = Expander {
        sources,
        scope: Scope::default(),
        broken: HashSet::new(),
        seed: 0,
        path: String::new(),
        diagnostics,
    };
    if let Some(entry) = root.get_mut("seed") {
        // It comes before the variables, which may be random.
        expander.integer(&mut entry.node);
        if let Value::Integer(seed) = entry.node.value {
            expander.seed = seed.unsigned_abs();
        }
    }
    expander.scope = Scope::default().with_draws();
    if let Some(Value::Table(table)) = root.get_mut("variables").map(|entry| &mut entry.node.value) {
        expander.variables(table);
    }
    expander.table(root, &SCENE);
}

/// What is known while formulas are evaluated.
struct Expander<'a> {
    sources: &'a Sources,
    scope: Scope,
    /// The variables that have no value, which has been said.
    broken: HashSet<String>,
    /// What random numbers follow from, with the path of their place.
    seed: u64,
    /// The path of the value that is looked at: `body.ball.location[1]`.
    path: String,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl Expander<'_> {
    fn table(&mut self, table: &mut Table, spec: &'static TableSpec) {
        for entry in &mut table.entries {
            if let Some(key) = spec.key(&entry.name.text) {
                self.below(&entry.name.text, |this| this.value(&mut entry.node, &key.kind));
            }
        }
    }

    /// Does what is to be done with the value of a key.
    fn below(&mut self, key: &str, work: impl FnOnce(&mut Self)) {
        let length = self.path.len();
        if length > 0 {
            self.path.push('.');
        }
        let is_plain = key.chars().all(|c| c.is_alphanumeric() || matches!(c, '-' | '_'));
        if is_plain {
            self.path.push_str(key);
        } else {
            // A name with a dot in it is not the way to another table.
            let _ = write!(self.path, "{key:?}");
        }
        work(self);
        self.path.truncate(length);
    }

    fn value(&mut self, node: &mut Node, kind: &'static Kind) {
        match (kind, &mut node.value) {
            (Kind::Number(_), Value::String(_)) => self.number(node),
            (Kind::Integer(..), Value::String(_)) => self.integer(node),
            (Kind::Numbers(..) | Kind::Direction(_) | Kind::Color, Value::Array(_)) => {
                self.items(node, Expander::number);
            }
            (Kind::List { of, .. }, Value::Array(_)) => self.items(node, |this, item| this.value(item, of)),
            (Kind::Table(spec), Value::Table(inner)) => self.table(inner, spec),
            (Kind::Named(spec), Value::Table(tables)) => {
                for entry in &mut tables.entries {
                    if let Value::Table(inner) = &mut entry.node.value {
                        self.below(&entry.name.text, |this| this.table(inner, spec));
                    }
                }
            }
            (Kind::Either(kinds), _) => {
                if let Some(kind) = kinds.iter().find(|kind| kind.takes(&node.value)) {
                    self.value(node, kind);
                }
            }
            _ => {}
        }
    }

    /// Looks at the items of a list. Where one has no value, the list has none: enough has been said of it.
    fn items(&mut self, node: &mut Node, look: impl Fn(&mut Self, &mut Node)) {
        let Value::Array(items) = &mut node.value else { return };
        let mut is_whole = true;
        for (number, item) in items.iter_mut().enumerate() {
            let length = self.path.len();
            let _ = write!(self.path, "[{number}]");
            look(self, item);
            self.path.truncate(length);
            is_whole &= !matches!(item.value, Value::Invalid);
        }
        if !is_whole {
            node.value = Value::Invalid;
        }
    }

    /// Replaces a formula by its value; what is no string stays as it is.
    fn number(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        node.value = self.evaluate(text, node.span).map_or(Value::Invalid, Value::Float);
    }

    /// Like [`Expander::number`], where only a whole number will do.
    fn integer(&mut self, node: &mut Node) {
        /// The largest whole number up to which all are exact.
        const LARGEST: f64 = 9_007_199_254_740_992.0;
        if !matches!(node.value, Value::String(_)) {
            return;
        }
        self.number(node);
        let Value::Float(value) = node.value else { return };
        #[allow(clippy::cast_possible_truncation, reason = "it is whole, and 64 bits hold it")]
        if value.trunc() == value && value.abs() <= LARGEST {
            node.value = Value::Integer(value as i64);
        } else {
            let message = format!("expected a whole number, found {value}");
            let error = Diagnostic::error("wrong-type", message).at(node.span, "the value of this formula");
            self.diagnostics.push(error.help("`round`, `floor` and `ceil` give whole numbers"));
            node.value = Value::Invalid;
        }
    }

    /// The value of a formula that stands somewhere; none after what is wrong has been said.
    fn evaluate(&mut self, text: &str, span: Span) -> Option<f64> {
        let formula = self.keep(Formula::parse(text), text, span)?;
        self.value_of(&formula, span)
    }

    /// The value of a formula that has been read.
    fn value_of(&mut self, formula: &Formula, span: Span) -> Option<f64> {
        if !self.broken.is_empty() && formula.names().any(|(name, _)| self.broken.contains(name)) {
            return None;
        }
        let resolved = self.keep(formula.resolve(&self.scope), formula.text(), span)?;
        let drawn = self.drawn(&resolved);
        let value = resolved.value(&drawn).map_err(|error| vec![error]);
        self.keep(value, formula.text(), span)
    }

    /// The random numbers of a formula at this place: those of another place do not follow from them.
    fn drawn(&self, resolved: &Resolved) -> Vec<f64> {
        if resolved.draws().is_empty() {
            return Vec::new();
        }
        let mut stream = Stream::new(self.seed, &self.path);
        let draw = |draw: &Draw| match draw {
            Draw::Uniform => stream.uniform(),
            Draw::Normal => stream.normal(),
        };
        resolved.draws().iter().map(draw).collect()
    }

    /// Keeps what is wrong with a formula, at its place in the scene.
    fn keep<T>(&mut self, found: Result<T, Vec<ExpressionError>>, text: &str, span: Span) -> Option<T> {
        let errors = match found {
            Ok(value) => return Some(value),
            Err(errors) => errors,
        };
        for error in errors {
            let place = place::in_string(self.raw(span), text, &error.range, span);
            let diagnostic = Diagnostic::error(error.code, error.message).at(place, error.label);
            self.diagnostics.push(match error.help {
                Some(help) => diagnostic.help(help),
                None => diagnostic,
            });
        }
        None
    }

    /// What is written at a place.
    fn raw(&self, span: Span) -> &str {
        self.sources.get(span.source).text.get(span.start..span.end).unwrap_or_default()
    }
}
