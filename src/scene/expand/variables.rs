//! Evaluates `[variables]`: named numbers that may refer to each other in any order.

use std::collections::HashMap;
use std::ops::Range;

use super::{Expander, place};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::expression::{Formula, Scope};
use crate::scene::grammar::scene::variable;
use crate::scene::source::{Node, Table, Value};
use crate::scene::view::value_of_variable;

/// A variable whose value is a formula.
struct Variable {
    name: String,
    /// The source span of the variable's value.
    span: Span,
    formula: Formula,
    /// The other variables that the formula uses. Each item is the variable's index and the byte range of its name in the formula.
    needs: Vec<(usize, Range<usize>)>,
    state: State,
}

/// The state of a variable in the depth-first evaluation.
#[derive(Clone, Copy, PartialEq)]
enum State {
    Untouched,
    /// The variables that the formula uses are being evaluated. Reaching a variable in this state means a cycle.
    Begun,
    Done,
}

/// Sets the value of a variable that is a formula.
fn set_value(variable: &mut Node, value: Option<f64>) {
    match &mut variable.value {
        Value::String(_) => variable.value = value.map_or(Value::Invalid, Value::Float),
        Value::Table(table) => {
            if let Some(entry) = table.get_mut(variable::VALUE.spec.name) {
                set_value(&mut entry.node, value);
            }
        }
        _ => {}
    }
}

impl Expander<'_> {
    /// Evaluates all variables, makes them available to formulas, and writes their values into the table.
    pub(super) fn variables(&mut self, table: &mut Table) {
        let mut variables = self.read(table);
        self.connect(&mut variables);
        for start in 0..variables.len() {
            self.visit(start, &mut variables);
        }
        for entry in &mut table.entries {
            let value = self.scope.value(&entry.name.text).filter(|value| !value.is_nan());
            set_value(&mut entry.node, value);
            if let Value::Table(slider) = &mut entry.node.value {
                self.with_key("variables", |this| {
                    this.with_key(&entry.name.text, |this| this.table(slider, &variable::TABLE));
                });
            }
        }
    }

    /// Adds the names of all variables, and the values of those that are plain numbers, to the scope of formulas. Returns the variables
    /// that are formulas.
    fn read(&mut self, table: &Table) -> Vec<Variable> {
        let mut variables = Vec::new();
        for entry in &table.entries {
            let name = entry.name.text.to_string();
            if let Err(why) = Scope::is_free(&name) {
                let message = format!("`{}` cannot be the name of a variable", name.escape_debug());
                let error = Diagnostic::error(Code::BadVariableName, message);
                self.diagnostics.push(error.at(entry.name.span, why));
                continue;
            }
            self.variable_spans.insert(name.clone(), entry.name.span);
            let node = value_of_variable(&entry.node);
            let span = node.span;
            let value = match &node.value {
                Value::String(text) if self.has_unit(text, span) => None,
                Value::String(text) => match self.ok_or_report(Formula::parse(text), text, span) {
                    Some(formula) => {
                        let (needs, state) = (Vec::new(), State::Untouched);
                        variables.push(Variable { name: name.clone(), span, formula, needs, state });
                        // The name is added now with the value NaN. Otherwise a formula that uses it would get the suggestion of a similar
                        // name.
                        Some(f64::NAN)
                    }
                    None => None,
                },
                // The validation reports other errors in a variable's value.
                _ => node.as_number().filter(|number| number.is_finite()),
            };
            if value.is_none() {
                self.broken.insert(name.clone());
            }
            self.scope.constant(name, value.unwrap_or(f64::NAN));
        }
        variables
    }

    fn connect(&mut self, variables: &mut [Variable]) {
        let numbers: HashMap<String, usize> =
            variables.iter().enumerate().map(|(number, variable)| (variable.name.clone(), number)).collect();
        for variable in variables {
            let needs = variable.formula.names();
            variable.needs = needs.filter_map(|(name, range)| Some((*numbers.get(name)?, range))).collect();
        }
    }

    /// Evaluates a variable after all variables that its formula uses. Chains of variables may be long, so an explicit stack replaces
    /// recursion.
    fn visit(&mut self, start: usize, variables: &mut [Variable]) {
        // The stack of variables. Each item is a variable's index and the number of its `needs` visited so far.
        let mut way = vec![(start, 0)];
        while let Some((current, seen)) = way.last_mut() {
            let variable = &mut variables[*current];
            if variable.state == State::Done {
                way.pop();
                continue;
            }
            variable.state = State::Begun;
            if let Some(&(next, _)) = variable.needs.get(*seen) {
                *seen += 1;
                match variables[next].state {
                    State::Untouched => way.push((next, 0)),
                    State::Begun => self.cycle(&way, next, variables),
                    State::Done => {}
                }
                continue;
            }
            variable.state = State::Done;
            let (name, span) = (variable.name.clone(), variable.span);
            let value = if self.broken.contains(&name) {
                None
            } else {
                let mut value = None;
                let formula = &variable.formula;
                self.with_key("variables", |this| {
                    this.with_key(&name, |this| value = this.value_of(formula, span));
                });
                value
            };
            match value {
                Some(value) => self.scope.constant(name, value),
                None => _ = self.broken.insert(name),
            }
            way.pop();
        }
    }

    /// Reports a cycle of variables that depend on each other: those on the stack `way` from `first` to the end.
    fn cycle(&mut self, way: &[(usize, usize)], first: usize, variables: &[Variable]) {
        /// The maximum number of a cycle's variables shown in the message.
        const MAX_SHOWN_VARIABLES: usize = 6;
        let begin = way.iter().position(|(variable, _)| *variable == first).unwrap_or(0);
        let cycle = &way[begin..];
        if cycle.iter().any(|(variable, _)| self.broken.contains(&variables[*variable].name)) {
            // Another cycle through one of these variables is probably the same mistake, so only the first is reported.
            return;
        }
        let name = |variable: usize| format!("`{}`", variables[variable].name);
        let mut names: Vec<String> =
            cycle.iter().take(MAX_SHOWN_VARIABLES).map(|(variable, _)| name(*variable)).collect();
        if cycle.len() > MAX_SHOWN_VARIABLES {
            names.push("…".to_owned());
        }
        names.push(name(first));
        let message = match cycle.len() {
            1 => format!("the variable {} needs itself", name(first)),
            _ => format!("variables need each other: {}", names.join(" → ")),
        };
        let mut error = Diagnostic::error(Code::CyclicVariables, message);
        for (variable, seen) in cycle.iter().take(MAX_SHOWN_VARIABLES) {
            let Variable { span, formula, needs, .. } = &variables[*variable];
            let (next, range) = &needs[seen - 1];
            let place = place::in_string(self.raw(*span), formula.text(), range, *span);
            let next = if next == variable { "itself".to_owned() } else { name(*next) };
            error = error.at(place, format!("{} needs {next}", name(*variable)));
        }
        self.diagnostics.push(error);
        self.broken.extend(cycle.iter().map(|(variable, _)| variables[*variable].name.clone()));
    }
}
