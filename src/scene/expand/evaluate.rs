//! Parses and evaluates formulas, and reports their errors.

use std::sync::Arc;

use super::repeat::{self, INDEX_VARIABLES};
use super::{Expander, corrections, place};
use crate::diagnostic::{Diagnostic, Span};
use crate::physics::random::Stream;
use crate::scene::expression::{Draw, ExpressionError, Formula, Resolved};

impl Expander<'_> {
    /// Reports those errors in a formula of `[defaults]` that occur in every table to which the default applies, such as unknown names.
    /// Does not evaluate the formula.
    pub(super) fn check_default_formula(&mut self, text: &str, span: Span) {
        let mut scope = self.scope.clone();
        INDEX_VARIABLES.into_iter().for_each(|index| scope.constant(index, 0.0));
        if let Some(formula) = self.ok_or_report(Formula::parse(text), text, span) {
            self.ok_or_report(formula.resolve(&scope), text, span);
        }
    }

    /// Evaluates the formula `text` at the source span `span`. Returns `None` after reporting an error.
    pub(super) fn evaluate(&mut self, text: &str, span: Span) -> Option<f64> {
        let formula = self.parsed(text, span)?;
        self.look_at_angles(&formula, span);
        self.value_of(&formula, span)
    }

    /// Parses the formula at a source span, or returns it from the cache that all copies of a body, force or joint share. Returns `None`
    /// after reporting an error.
    pub(super) fn parsed(&mut self, text: &str, span: Span) -> Option<Arc<Formula>> {
        if let Some(known) = self.formulas.get(&span) {
            return Some(known.clone());
        }
        let formula = Arc::new(self.ok_or_report(Formula::parse(text), text, span)?);
        if self.copy.is_some() {
            self.formulas.insert(span, formula.clone());
        }
        Some(formula)
    }

    /// Evaluates a parsed formula. Returns `None` if an error has been reported, here or for a variable in the formula.
    pub(super) fn value_of(&mut self, formula: &Formula, span: Span) -> Option<f64> {
        if !self.broken.is_empty() && formula.names().any(|(name, _)| self.broken.contains(name)) {
            return None;
        }
        self.work += repeat::work_of_value(formula.text());
        let resolved = self.ok_or_report(formula.resolve(&self.scope), formula.text(), span)?;
        let drawn = self.drawn(&resolved);
        let value = resolved.value(&drawn).map_err(|mut error| {
            error.message.push_str(&self.in_copy());
            vec![error]
        });
        self.ok_or_report(value, formula.text(), span)
    }

    /// Draws the random numbers of a formula, in the order of their use. Each value of the scene has its own, independent random stream,
    /// derived from the path of its key.
    pub(super) fn drawn(&self, resolved: &Resolved) -> Vec<f64> {
        if resolved.draws().is_empty() {
            return Vec::new();
        }
        let mut stream = self.stream("");
        let draw = |draw: &Draw| match draw {
            Draw::Uniform => stream.uniform(),
            Draw::Normal => stream.normal(),
        };
        resolved.draws().iter().map(draw).collect()
    }

    /// Returns the random stream for the path of the current value, with `below` appended to the path.
    pub(super) fn stream(&self, below: &str) -> Stream {
        Stream::new(self.seed, &format!("{}{below}", self.path))
    }

    /// Returns the name of the current copy as the end of an error message. Empty outside of copies.
    pub(super) fn in_copy(&self) -> String {
        self.copy.as_ref().map_or_else(String::new, |name| format!(", in `{name}`"))
    }

    /// Returns the value of `found`, or reports its errors at their positions in the scene's text and returns `None`. `text` is the
    /// formula and `span` is its source span.
    pub(super) fn ok_or_report<T>(
        &mut self,
        found: Result<T, Vec<ExpressionError>>,
        text: &str,
        span: Span,
    ) -> Option<T> {
        let errors = match found {
            Ok(value) => return Some(value),
            Err(errors) => errors,
        };
        if !self.reported.insert(span) {
            return None;
        }
        for error in errors {
            let place = place::in_string(self.raw(span), text, &error.range, span);
            let is_said = error.label.starts_with("did you mean");
            let mut diagnostic = Diagnostic::error(error.code, error.message).at(place, error.label);
            if let Some((key, motion)) = self.motion_meant(&text[error.range.clone()], span) {
                diagnostic = diagnostic.fix(key, motion);
            } else if let Some(number) = corrections::without_decimal_comma(text) {
                diagnostic = diagnostic.fix(span, number);
            } else if let Some(fix) = error.fix.filter(|_| place != span) {
                diagnostic = diagnostic.fix(place, fix);
                if is_said {
                    diagnostic = diagnostic.fix_is_said();
                }
            }
            self.diagnostics.push(match error.help {
                Some(help) => diagnostic.help(help),
                None => diagnostic,
            });
        }
        None
    }

    /// Returns the source text of a span, as it is written in the scene.
    pub(super) fn raw(&self, span: Span) -> &str {
        self.sources.raw(span)
    }
}
