//! Reads formulas that depend on a body's current quantities, such as its velocity. A force, for example, can be given by these formulas.

use std::sync::Arc;

use super::{Expander, place};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::expression::Formula;
use crate::scene::force_formula::BodyFormula;
use crate::scene::source::{Node, Value};

impl Expander<'_> {
    /// Parses a formula of a body's quantities and keeps it, because the simulation evaluates it at every step. `names` are the quantities
    /// that the formula may use. Leaves values other than strings unchanged.
    pub(super) fn of_body(&mut self, node: &mut Node, names: &'static [&'static str]) {
        let Value::String(text) = &node.value else { return };
        let (text, span) = (text.clone(), node.span);
        node.value = Value::Invalid;
        if self.has_reported_error(span) || self.has_unit(&text, span) || self.asks_for_body(&text, span) {
            return;
        }
        let Some(formula) = self.parsed(&text, span) else { return };
        if formula.names().any(|(name, _)| self.broken.contains(name))
            || self.is_ambiguous(&formula, node, names)
        {
            return;
        }
        self.look_at_angles(&formula, span);
        self.scope.set_fields(names);
        let resolved = formula.resolve(&self.scope);
        self.scope.set_fields(&[]);
        let Some(resolved) = self.ok_or_report(resolved, &text, span) else { return };
        let resolved = resolved.with_draws(&self.drawn(&resolved));
        self.work += super::repeat::work_of_value(&text);
        node.value = Value::OfBody(Arc::new(BodyFormula::new(text, span, resolved)));
    }

    /// Returns true, and reports an error, if a formula uses a name that is both a quantity of the body and a variable of the scene.
    fn is_ambiguous(&mut self, formula: &Formula, node: &Node, names: &[&str]) -> bool {
        let mut both = formula.names().filter(|(name, _)| names.contains(name));
        let Some((name, range)) = both.find(|(name, _)| self.scope.value(name).is_some()) else {
            return false;
        };
        if self.reported.insert(node.span) {
            let at = place::in_string(self.raw(node.span), formula.text(), &range, node.span);
            let message = format!("`{name}` is a variable of the scene and a quantity of the body");
            let error = Diagnostic::error(Code::BadVariableName, message).at(at, "which of the two?");
            let help =
                format!("give the variable another name: in formulas of a force, `{name}` is the body's");
            let error = error.help(help);
            let variable = self.variable_spans.get(name);
            let error = variable.iter().fold(error, |error, span| error.at(**span, "the variable"));
            self.diagnostics.push(error);
        }
        true
    }
}
