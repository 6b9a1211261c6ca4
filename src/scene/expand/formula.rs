//! Replaces a formula by its value, or by a compiled program if its value depends on the time or on random numbers of particles.

use std::sync::Arc;

use super::{Expander, corrections, repeat};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::RunMeasure;
use crate::scene::expression::Formula;
use crate::scene::sampled_number::SampledFormula;
use crate::scene::source::{Node, Value};
use crate::scene::timed::TimeFormula;

impl Expander<'_> {
    /// Replaces a formula (a string) by its value. Leaves values of other types unchanged.
    pub(super) fn number(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        if self.has_reported_error(node.span)
            || self.has_unit(text, node.span)
            || self.asks_for_body(text, node.span)
        {
            node.value = Value::Invalid;
            return;
        }
        if self.is_default {
            self.check_default_formula(text, node.span);
            node.value = Value::Invalid;
            return;
        }
        node.value = self.evaluate(text, node.span).map_or(Value::Invalid, Value::Float);
    }

    /// Returns true if another copy has reported an error in this formula. The formula is then not evaluated again.
    pub(super) fn has_reported_error(&self, span: Span) -> bool {
        self.copy.is_some() && self.reported.contains(&span)
    }

    /// Replaces a formula by its value, as [`Expander::number`] does, but keeps a formula that depends on the time as a compiled program.
    pub(super) fn timed(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        if let Some(followed) = self.following(text, node.span) {
            node.value = if followed.is_empty() { Value::Invalid } else { Value::String(followed.into()) };
        }
        let Value::String(text) = &node.value else { return };
        if self.has_reported_error(node.span)
            || self.has_unit(text, node.span)
            || self.asks_for_body(text, node.span)
        {
            node.value = Value::Invalid;
            return;
        }
        let (text, span) = (text.clone(), node.span);
        let Some(formula) = self.parsed(&text, span) else {
            node.value = Value::Invalid;
            return;
        };
        let changes = formula.names().any(|(name, _)| name == "t");
        self.look_at_angles(&formula, span);
        match self.time_formula(&formula, text, span) {
            Some(_) if !changes => self.number(node),
            found => node.value = found.map_or(Value::Invalid, Value::Formula),
        }
    }

    /// Replaces a formula by its value or a compiled program, as [`Expander::timed`] does, but leaves a formula of measures as it is written.
    pub(super) fn varying(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        if !self.names_measures(text) {
            self.timed(node);
        }
    }

    /// Returns whether a formula names a measure, such as `ball.x` or `kinetic`.
    fn names_measures(&self, text: &str) -> bool {
        let is_of_run = |name: &str| RunMeasure::ALL.iter().any(|(known, ..)| *known == name);
        let is_measure = |name: &str| name != "t" && is_of_run(name) && self.scope.value(name).is_none();
        corrections::members(text).next().is_some()
            || Formula::parse(text).is_ok_and(|formula| formula.names().any(|(name, _)| is_measure(name)))
    }

    fn time_formula(&mut self, formula: &Formula, text: Arc<str>, span: Span) -> Option<Arc<TimeFormula>> {
        if !self.broken.is_empty() && formula.names().any(|(name, _)| self.broken.contains(name)) {
            return None;
        }
        self.scope.slot("t");
        let resolved = formula.resolve(&self.scope);
        self.scope.remove_slot("t");
        let resolved = self.ok_or_report(resolved, formula.text(), span)?;
        let resolved = resolved.with_draws(&self.drawn(&resolved));
        let read = self.timed_formulas.read(text, span, &resolved).map_err(|error| vec![error]);
        let read = self.ok_or_report(read, formula.text(), span)?;
        self.work += repeat::work_of_motion(&read);
        Some(read)
    }

    /// Replaces a formula by its value, as [`Expander::number`] does, but keeps a formula with random numbers or the time as a compiled
    /// program. Each particle then evaluates the program with its own random numbers.
    pub(super) fn drawn_later(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        let (text, span) = (text.clone(), node.span);
        node.value = Value::Invalid;
        if self.has_unit(&text, span) || self.asks_for_body(&text, span) {
            return;
        }
        let Some(formula) = self.parsed(&text, span) else { return };
        if formula.names().any(|(name, _)| self.broken.contains(name)) {
            return;
        }
        self.look_at_angles(&formula, span);
        self.scope.slot("t");
        let resolved = formula.resolve(&self.scope);
        self.scope.remove_slot("t");
        let Some(resolved) = self.ok_or_report(resolved, &text, span) else { return };
        let changes = formula.names().any(|(name, _)| name == "t") || !resolved.draws().is_empty();
        if !changes {
            node.value = self.value_of(&formula, span).map_or(Value::Invalid, Value::Float);
            return;
        }
        let program = resolved.compile().map_err(|error| vec![error]);
        let program = self.ok_or_report(program, &text, span);
        let drawn = program.map(|program| Arc::new(SampledFormula::new(text, program)));
        node.value = drawn.map_or(Value::Invalid, Value::Sampled);
    }

    /// Replaces a formula by its value, as [`Expander::number`] does, and reports an error if that value is not a whole number.
    pub(super) fn integer(&mut self, node: &mut Node) {
        /// The largest number (2⁵³) up to which an `f64` represents all whole numbers.
        const MAX_EXACT_INTEGER: f64 = 9_007_199_254_740_992.0;
        if !matches!(node.value, Value::String(_)) {
            return;
        }
        self.number(node);
        let Value::Float(value) = node.value else { return };
        #[allow(clippy::cast_possible_truncation, reason = "it is whole, and 64 bits hold it")]
        if value.trunc() == value && value.abs() <= MAX_EXACT_INTEGER {
            node.value = Value::Integer(value as i64);
        } else {
            let message = format!("expected a whole number, found {value}{}", self.in_copy());
            let error =
                Diagnostic::error(Code::WrongType, message).at(node.span, "the value of this formula");
            if self.reported.insert(node.span) {
                self.diagnostics.push(error.help("`round`, `floor` and `ceil` give whole numbers"));
            }
            node.value = Value::Invalid;
        }
    }
}
