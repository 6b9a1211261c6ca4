//! Reads sums, means and extremes over several bodies, such as `sum(gas.kinetic)`, in formulas of measures.

use std::sync::Arc;

use super::Reader;
use super::dotted::dotted_at;
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::{Aggregate, Aggregation, Measure, MeasureFormula};

/// The bodies of the aggregate that is being read.
pub(super) struct Each {
    /// The name of the function, such as `sum`.
    function: &'static str,
    /// The name that means all of them, such as `gas` or `brick[*,0]`. `None` before the first name is read.
    name: Option<String>,
}

/// A formula that has a value for each of several bodies.
pub(in crate::scene::check) struct OfEach {
    /// The name that means all of the bodies, such as `gas`.
    pub(in crate::scene::check) name: String,
    /// The indices of the bodies in the scene, in ascending order.
    pub(in crate::scene::check) bodies: Arc<[usize]>,
    pub(in crate::scene::check) formula: MeasureFormula,
}

/// A call of a function with the name of an aggregation: byte ranges in a formula.
struct Call {
    how: Aggregation,
    begin: usize,
    /// The position behind the opening parenthesis.
    open: usize,
    /// The position of the closing parenthesis.
    close: usize,
}

impl Reader<'_, '_, '_> {
    /// Replaces each aggregate in a formula, such as `sum(gas.kinetic)`, by a name of the same length, so error positions stay valid.
    /// Returns the formula, and the measure for each of these names. The formula begins at the byte `start` of the text.
    pub(super) fn without_aggregates(
        &mut self,
        formula: &str,
        start: usize,
    ) -> Option<(String, Vec<(String, Measure)>)> {
        let mut plain = formula.to_owned();
        let mut found: Vec<(String, Measure)> = Vec::new();
        // From right to left, so an inner aggregate comes before the one around it.
        for call in calls(formula).into_iter().rev() {
            let Call { how, begin, open, close } = call;
            let inside = plain[open..close].to_owned();
            if !self.names_several(&inside) {
                // The functions `max` and `min` also take ordinary numbers.
                if matches!(how, Aggregation::Sum | Aggregation::Mean) {
                    self.report_single(how.name(), &inside, start + begin..start + open - 1, start + open);
                    return None;
                }
                continue;
            }
            if let Some(comma) = top_level_comma(&inside) {
                let message = format!("`{}` of several bodies takes one value", how.name());
                let error = Diagnostic::error(Code::LabelSyntax, message);
                self.report(error, start + open + comma..start + open + comma + 1, "needs no second value");
                return None;
            }
            let number = self.aggregate(how, &inside, start + open, &found)?;
            let name = self.free_name(found.len(), close + 1 - begin);
            plain.replace_range(begin..=close, &name);
            found.push((name, Measure::Aggregate(number)));
        }
        Some((plain, found))
    }

    /// Reads the formula inside an aggregate. Returns the index of the aggregate in the scene.
    fn aggregate(
        &mut self,
        how: Aggregation,
        inside: &str,
        start: usize,
        inner: &[(String, Measure)],
    ) -> Option<usize> {
        let used = inner.iter().filter(|(name, _)| inside.contains(name.as_str())).cloned().collect();
        let outer = self.each.replace(Each { function: how.name(), name: None });
        let formula = self.plain_formula(inside, start, used);
        let each = std::mem::replace(&mut self.each, outer);
        let (formula, Some(name)) = (formula?, each.and_then(|each| each.name)) else {
            // The name of copies stood where another name is meant, such as that of a force.
            self.report_single(how.name(), "", start..start + inside.len(), start);
            return None;
        };
        let bodies = self.bodies_of(&name)?;
        self.context.aggregates.push(Aggregate { how, bodies, formula });
        Some(self.context.aggregates.len() - 1)
    }

    /// Reads a formula that has a value for each of several bodies, with an optional unit, such as `gas.speed:km/h`.
    /// `function` is what takes the formula, for messages.
    pub(in crate::scene::check) fn of_each(
        &mut self,
        function: &'static str,
        range: std::ops::Range<usize>,
    ) -> Option<OfEach> {
        let text = &self.text[range.clone()];
        if !self.names_several(text) {
            self.report_single(function, text, range.clone(), range.start);
            return None;
        }
        self.each = Some(Each { function, name: None });
        let formula = self.formula_with_unit(range.clone());
        let each = self.each.take();
        let (formula, Some(name)) = (formula?, each.and_then(|each| each.name)) else {
            self.report_single(function, "", range.clone(), range.start);
            return None;
        };
        Some(OfEach { bodies: self.bodies_of(&name)?, name, formula })
    }

    /// Returns the indices of the copies that a name means, in ascending order.
    fn bodies_of(&self, name: &str) -> Option<Arc<[usize]>> {
        let numbers = &self.context.names.bodies;
        let copies = self.context.groups.several(name)?;
        let mut bodies: Vec<usize> = copies.filter_map(|copy| numbers.get(&**copy).copied()).collect();
        bodies.sort_unstable();
        Some(bodies.into())
    }

    /// Returns whether a name means each body of the aggregate that is being read. Reports a name of other bodies than those named
    /// before it.
    pub(super) fn is_of_each(&mut self, name: &str, begin: usize) -> Option<bool> {
        if self.context.groups.several(name).is_none() {
            return Some(false);
        }
        let Some(each) = &mut self.each else { return Some(false) };
        // `gas` and `gas[*]` mean the same.
        let original = self.context.groups.original(name).filter(|original| {
            name[original.len()..].bytes().all(|byte| matches!(byte, b'[' | b']' | b'*' | b',' | b' '))
        });
        let name_of_all = original.unwrap_or(name);
        let before = each.name.get_or_insert_with(|| name_of_all.to_owned());
        if before == name_of_all {
            return Some(true);
        }
        let message = format!("`{}` is over the copies of one body", each.function);
        let label = format!("`{before}` comes before");
        let help = "write one for each: `sum(a.mass) + sum(b.mass)`";
        self.report(
            Diagnostic::error(Code::LabelSyntax, message).help(help),
            begin..begin + name.len(),
            &label,
        );
        None
    }

    /// Returns whether a formula names the measure of several bodies, such as `gas.speed` or `brick[*,0].x`.
    pub(in crate::scene::check) fn names_several(&self, formula: &str) -> bool {
        let mut dots = formula.match_indices('.');
        dots.any(|(at, _)| {
            let dotted = dotted_at(formula, at);
            dotted.is_some_and(|dotted| self.context.groups.several(&formula[dotted.body]).is_some())
        })
    }

    /// Reports a sum, a mean or a histogram that names no repeated body.
    fn report_single(&mut self, function: &str, inside: &str, place: std::ops::Range<usize>, start: usize) {
        // A wrong name is the more likely mistake.
        for (at, _) in inside.match_indices('.') {
            let Some(dotted) = dotted_at(inside, at) else { continue };
            let name = &inside[dotted.body.clone()];
            let is_first = !inside[..dotted.body.start].ends_with('.');
            if is_first
                && !matches!(name, "joint" | "force")
                && self.subject(name, start + dotted.body.start).is_none()
            {
                return;
            }
        }
        let message = format!("`{function}` is over the copies of a body");
        let example = match function {
            "histogram" => "histogram = \"gas.speed\"".to_owned(),
            function => format!("{function}(gas.speed)"),
        };
        let help = format!("`repeat` makes copies of a body; of those of `gas`, it is `{example}`");
        let error = Diagnostic::error(Code::LabelSyntax, message).help(help);
        self.report(error, place, "names no body with copies");
    }

    /// Returns a name of this length for formulas that is no variable of the scene.
    fn free_name(&self, number: usize, length: usize) -> String {
        let mut letters = 'a'..='z';
        let name = letters.find_map(|letter| {
            let name = format!("{:_<length$}", format!("_{letter}{number}"));
            self.variables().all(|(variable, _)| variable != name).then_some(name)
        });
        name.unwrap_or_default()
    }
}

/// Returns the calls of `sum`, `mean`, `max` and `min` in a formula, in the order in which they begin. A call without an end is left out.
fn calls(formula: &str) -> Vec<Call> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
    let call = |(at, _): (usize, &str)| {
        let before = formula[..at].trim_end();
        let word = &before[before.trim_end_matches(is_part).len()..];
        let (_, how, _) = Aggregation::ALL.into_iter().find(|(name, ..)| *name == word)?;
        let close = at + closing(&formula[at..])?;
        Some(Call { how, begin: before.len() - word.len(), open: at + 1, close })
    };
    formula.match_indices('(').filter_map(call).collect()
}

/// Returns the position of the parenthesis that closes the one at the beginning of a text.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    text.bytes().position(|byte| {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => {}
        }
        depth == 0
    })
}

/// Returns the position of the first comma outside of all parentheses and brackets.
fn top_level_comma(text: &str) -> Option<usize> {
    let mut depth = 0_i32;
    text.bytes().position(|byte| {
        match byte {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            _ => {}
        }
        depth == 0 && byte == b','
    })
}
