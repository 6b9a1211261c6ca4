//! Detects common mistakes in formulas, such as a unit behind a number or a reference to a body's location, and suggests corrections.

use std::ops::Range;

use super::Expander;
use crate::diagnostic::{Code, Diagnostic, Edit, Span};
use crate::scene::expression::Formula;
use crate::scene::source::{Node, Table, Value};
use crate::scene::units;

/// A formula that uses the location of a body. Such a formula is an error.
pub(super) struct OfBody {
    text: String,
    span: Span,
}

impl Expander<'_> {
    /// Returns true, and reports an error, if the text is a number with a unit, such as `5 cm`.
    pub(super) fn has_unit(&mut self, text: &str, span: Span) -> bool {
        if let Some(number) = units::percentage(text) {
            if self.reported.insert(span) {
                let error = Diagnostic::error(Code::NumberWithUnit, "a number stands alone, without `%`");
                self.diagnostics
                    .push(error.at(span, "a percentage is a number from 0 to 1").fix(span, number));
            }
            return true;
        }
        let Some((number, unit)) = units::quantity(text) else { return false };
        if !self.reported.insert(span) {
            return true;
        }
        let of = self.unit;
        let error = Diagnostic::error(
            Code::NumberWithUnit,
            format!("a number stands alone, without the unit `{unit}`"),
        );
        let is_angle = units::factor(unit, "degrees").is_some();
        self.diagnostics.push(match units::converted(number, unit, of) {
            // Which unit a variable has depends on the formulas that use it. Most angles in formulas are arguments of sines.
            Some(degrees) if of.is_empty() && is_angle => {
                let degrees = units::converted(number, unit, "degrees").unwrap_or(degrees);
                error
                    .at(span, "sine, cosine and tangent take radians")
                    .fix(span, format!("\"rad({degrees})\""))
            }
            Some(converted) => {
                let label = if of.is_empty() {
                    "numbers are in SI units".to_owned()
                } else {
                    format!("this key is in {of}")
                };
                error.at(span, label).fix(span, converted)
            }
            None => error.at(span, format!("this key is in {of}, and `{unit}` measures something else")),
        });
        true
    }

    /// Warns if a formula probably uses degrees in place of radians, or the reverse.
    pub(super) fn look_at_angles(&mut self, formula: &Formula, span: Span) {
        let text = formula.text();
        let (range, message, label, corrected) =
            if let Some(range) = formula.degrees_for_radians(|name| self.scope.value(name)) {
                let angle = &text[range.clone()];
                let corrected = format!("rad({angle})");
                (
                    range,
                    "sine, cosine and tangent take radians",
                    format!("did you mean `{corrected}`?"),
                    corrected,
                )
            } else if self.unit == "degrees" && formula.is_in_radians() {
                let degrees = text.strip_prefix("rad(").and_then(|rest| rest.strip_suffix(')'));
                let degrees = degrees.filter(|inner| !inner.contains(['(', ')']));
                let corrected = degrees.map_or_else(|| format!("deg({text})"), str::to_owned);
                (0..text.len(), "this angle is in degrees", format!("did you mean `{corrected}`?"), corrected)
            } else {
                return;
            };
        if !self.warned.insert(span) {
            return;
        }
        let place = super::place::in_string(self.raw(span), text, &range, span);
        let warning = Diagnostic::warning(Code::AngleUnit, message).at(place, label);
        self.diagnostics.push(if place == span {
            warning
        } else {
            warning.fix(place, corrected).fix_is_said()
        });
    }

    /// Recognizes that a body's initial `location` or `orientation` uses the time `t`. Returns the source span of that key, and the key of
    /// a motion that was probably meant.
    pub(super) fn motion_meant(&self, name: &str, span: Span) -> Option<(Span, &'static str)> {
        let path = self.path.strip_prefix("body.").filter(|_| name == "t")?;
        let (key, motion) =
            [("location", "motion.formula.location"), ("orientation", "motion.formula.orientation")]
                .into_iter()
                .find(|(key, _)| {
                    path.split_once('[').is_some_and(|(way, _)| way.ends_with(&format!(".{key}")))
                })?;
        let line = self.sources.line_before(span);
        let (before, after) = line.split_once(key)?;
        let is_key = before.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | ' '));
        let at = span.place_before(line.len() - before.len()).grown(0, key.len());
        (is_key && after.trim_start().starts_with('=')).then_some((at, motion))
    }

    /// Returns true if a formula uses the location of a body, which is an error. Stores the formula; the error is reported after all bodies
    /// are expanded, because the suggested correction contains the locations of bodies.
    pub(super) fn asks_for_body(&mut self, text: &str, span: Span) -> bool {
        let asks = text.contains('.') && members(text).next().is_some();
        if asks && self.reported.insert(span) {
            self.of_bodies.push(OfBody { text: text.to_owned(), span });
        }
        asks
    }

    /// Reports all formulas that use locations of bodies. Suggests replacing each reference by the initial coordinate.
    pub(super) fn report_of_bodies(&mut self, root: &Table) {
        let bodies = root.get("body").and_then(|entry| entry.node.as_table());
        for OfBody { text, span } in std::mem::take(&mut self.of_bodies) {
            let mut corrected = text.clone();
            let mut all_known = true;
            for (range, name, member) in members(&text).collect::<Vec<_>>().into_iter().rev() {
                let body = bodies.and_then(|bodies| bodies.get(name)).and_then(|entry| entry.node.table());
                let place = body.and_then(|body| coordinate(&body, member));
                match place {
                    Some(place) => {
                        let alone = range == (0..text.len());
                        corrected.replace_range(range, &if alone { place } else { format!("({place})") });
                    }
                    None => all_known = false,
                }
            }
            let (range, name, _) = members(&text).next().unwrap_or((0..0, "", ""));
            let place = super::place::in_string(self.raw(span), &text, &range, span);
            let message = "a formula cannot ask where a body is";
            let help = "formulas of bodies know `t` and `[variables]`; labels, plots, cameras and lights know bodies, too";
            let error = Diagnostic::error(Code::FormulaOfBody, message).help(help);
            if !all_known {
                self.diagnostics.push(error.at(place, ""));
                continue;
            }
            let label = format!("where `{name}` is at the start can be written as a number");
            let corrected =
                if corrected.parse::<f64>().is_ok() { corrected } else { format!("\"{corrected}\"") };
            let mut error = error.at(place, label);
            error.fix.get_or_insert_default().edits.push(Edit { span, text: corrected });
            self.diagnostics.push(error);
        }
    }
}

/// Replaces a decimal comma by a decimal point: `0,5` → `0.5`. `None` if the text is no number with a comma.
pub(super) fn without_decimal_comma(text: &str) -> Option<String> {
    let (whole, part) = text.trim().split_once(',')?;
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (is_digits(whole.strip_prefix('-').unwrap_or(whole)) && is_digits(part))
        .then(|| format!("{whole}.{part}"))
}

/// Returns a body's constant coordinate as the text of a number. `None` if it depends on the time. `member` is the axis: `x`, `y` or `z`.
fn coordinate(body: &Table, member: &str) -> Option<String> {
    let axis = ["x", "y", "z"].iter().position(|axis| *axis == member)?;
    let inner = |table: &Table, key: &str| table.get(key).and_then(|entry| entry.node.as_table()).cloned();
    let motion = inner(body, "motion");
    let location = match &motion {
        None => body.get("location").map(|entry| entry.node.clone()),
        Some(motion) => {
            let formula = inner(motion, "formula")?;
            formula.get("location").or(body.get("location")).map(|entry| entry.node.clone())
        }
    };
    let Some(Node { value: Value::Array(items), .. }) = location else {
        return Some("0".to_owned());
    };
    Some(units::written(items.get(axis)?.as_number()?))
}

/// Finds the references to a property of a body in a formula, such as `ball.x`. Each item is the byte range, the body's name and the
/// property.
pub(super) fn members(text: &str) -> impl Iterator<Item = (Range<usize>, &str, &str)> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '[' | ']');
    text.match_indices('.').filter_map(move |(at, _)| {
        let begin = text[..at].trim_end_matches(is_part).len();
        let rest = &text[at + 1..];
        let end = at + 1 + rest.find(|c| !is_part(c)).unwrap_or(rest.len());
        let (body, member) = (&text[begin..at], &text[at + 1..end]);
        let letter = |word: &str| word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        (letter(body) && letter(member)).then_some((begin..end, body, member))
    })
}
