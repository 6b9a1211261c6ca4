//! Evaluates the indices in the names of copies, such as `bob[i]`, `link[i+1]` or `brick[i,n-1]`.

use std::ops::Range;

use super::groups::split;
use super::{Expander, place};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::expression::Formula;
use crate::scene::grammar::Collection;
use crate::scene::source::{Node, Value};

/// Returns true if the name is that of a copy and at least one index is a formula: `bob[i]`, but not `bob[3]` or `bob[*]`.
pub(super) fn is_formula(name: &str) -> bool {
    let is_plain = |part: &str| part == "*" || part.parse::<usize>().is_ok();
    split(name).is_some_and(|(_, inside)| parts(inside).any(|range| !is_plain(inside[range].trim())))
}

/// Returns the name of the repeated body or joint and the formulas of its indices: `link` and `i+1` for `link[i+1]`. `None` if no index
/// depends on `i`.
pub(super) fn of_i(name: &str) -> Option<(&str, Vec<Formula>)> {
    let (original, inside) = split(name)?;
    let formulas: Vec<Formula> =
        parts(inside).map(|range| Formula::parse(inside[range].trim()).ok()).collect::<Option<_>>()?;
    let is_of_i = formulas.iter().any(|formula| formula.names().any(|(name, _)| name == "i"));
    is_of_i.then_some((original, formulas))
}

/// Returns the byte ranges of the indices in a list such as `mod(i, 3), j`. A comma within parentheses does not separate two indices.
fn parts(inside: &str) -> impl Iterator<Item = Range<usize>> {
    let (mut depth, mut start) = (0usize, 0);
    let mut ends = inside.char_indices().chain([(inside.len(), ',')]);
    std::iter::from_fn(move || {
        for (at, letter) in ends.by_ref() {
            match letter {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                ',' if depth == 0 || at == inside.len() => {
                    let range = start..at;
                    start = at + 1;
                    return Some(range);
                }
                _ => {}
            }
        }
        None
    })
}

impl Expander<'_> {
    /// Replaces the index formulas in the name of a copy by their values: `bob[i+1]` → `bob[4]`. The validation later checks that the copy
    /// exists.
    pub(super) fn index(&mut self, node: &mut Node, of: Collection) {
        let Value::String(name) = &node.value else { return };
        let name = name.clone();
        let Some((original, inside)) = split(&name) else { return };
        if self.is_default || !is_formula(&name) || self.groups.counts(of, original).is_none() {
            return;
        }
        let mut numbers = Vec::new();
        for range in parts(inside) {
            let part = &inside[range.clone()];
            let text = part.trim();
            if text == "*" {
                numbers.push(text.to_owned());
                continue;
            }
            let start = original.len() + 1 + range.start + part.len() - part.trim_start().len();
            let place = place::in_string(self.raw(node.span), &name, &(start..start + text.len()), node.span);
            if place == node.span {
                // Several index formulas may share the span of the whole name, so no cached formula of that span can be reused.
                self.formulas.remove(&place);
            }
            let Some(value) = self.evaluate(text, place) else {
                node.value = Value::Invalid;
                return;
            };
            if value.trunc() != value {
                let message = format!("expected a whole number, found {value}{}", self.in_copy());
                if self.reported.insert(place) {
                    let error = Diagnostic::error(Code::WrongType, message).at(place, "an index is whole");
                    let help = "`round`, `floor` and `ceil` give whole numbers";
                    self.diagnostics.push(error.help(help));
                }
                node.value = Value::Invalid;
                return;
            }
            // Adding 0 turns -0 into 0, because "-0" is not a valid index.
            numbers.push((value + 0.0).to_string());
        }
        node.value = Value::String(format!("{original}[{}]", numbers.join(",")).into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_numbers_stars_or_formulas() {
        for name in ["ball", "ball[0]", "brick[3,0]", "brick[*,2]", "[x]y"] {
            assert!(!is_formula(name), "{name}");
        }
        for name in ["ball[i]", "brick[3,i+1]", "ball[mod(i,3)]", "ball[-1]"] {
            assert!(is_formula(name), "{name}");
        }
        let inside = "mod(i, 3), j";
        let parts: Vec<&str> = parts(inside).map(|range| &inside[range]).collect();
        assert_eq!(parts, ["mod(i, 3)", " j"]);
    }
}
