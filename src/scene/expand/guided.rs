//! Formulas of the time that follow a body which moves by formulas itself, such as `crank.x + 1`.
//!
//! The name of a coordinate stands for the formula of that coordinate, in parentheses. So velocities and accelerations follow as for any
//! other formula.

use std::collections::HashMap;

use super::Expander;
use super::corrections::members;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::source::{Table, Value};
use crate::scene::units;

/// The longest formula that may result, bytes. A formula that names two bodies, each of which names two, and so on, grows quickly.
const MAX_LENGTH: usize = 10_000;

/// The coordinates of each body that moves by formulas of the time, as the texts of formulas. Copies of bodies are left out, and so are
/// bodies with random numbers, which each formula would draw anew.
#[derive(Default)]
pub(super) struct GuidedBodies(HashMap<String, [String; 3]>);

/// The reason why a formula cannot follow what it names.
enum Obstacle {
    /// It names something else than the coordinate of a body that moves by formulas.
    Other,
    /// The bodies with these names follow each other.
    Circle(Vec<String>),
    /// The formula would be too long.
    Length,
}

impl GuidedBodies {
    /// Finds the bodies of a scene that is not expanded yet.
    pub(super) fn of(root: &Table) -> GuidedBodies {
        let inner =
            |table: &Table, key: &str| table.get(key).and_then(|entry| entry.node.as_table()).cloned();
        let Some(bodies) = inner(root, "body") else { return GuidedBodies::default() };
        let coordinates = |body: &Table| {
            let formula = inner(&inner(body, "motion")?, "formula")?;
            let location = formula.get("location").or(body.get("location"))?;
            let Value::Array(items) = &location.node.value else { return None };
            let texts = items.iter().map(|item| match &item.value {
                Value::String(text) if text.contains("uniform(") || text.contains("normal(") => None,
                Value::String(text) => Some(text.to_string()),
                _ => item.as_number().map(units::written),
            });
            <[String; 3]>::try_from(texts.collect::<Option<Vec<String>>>()?).ok()
        };
        let guided = bodies.entries.iter().filter_map(|entry| {
            let body = entry.node.as_table().filter(|body| body.get("repeat").is_none())?;
            Some((entry.name.text.to_string(), coordinates(body)?))
        });
        GuidedBodies(guided.collect())
    }

    /// Replaces each coordinate of a body by its formula. `chain` are the bodies whose formulas lead here.
    fn replace<'a>(&'a self, text: &str, chain: &mut Vec<&'a str>) -> Result<String, Obstacle> {
        let mut replaced = String::new();
        let mut at = 0;
        for (range, name, member) in members(text) {
            let axis = ["x", "y", "z"].iter().position(|axis| *axis == member).ok_or(Obstacle::Other)?;
            let (name, coordinates) = self.0.get_key_value(name).ok_or(Obstacle::Other)?;
            if let Some(first) = chain.iter().position(|known| known == name) {
                return Err(Obstacle::Circle(chain[first..].iter().map(|name| (*name).to_owned()).collect()));
            }
            chain.push(name);
            let inner = self.replace(&coordinates[axis], chain)?;
            chain.pop();
            replaced.push_str(&text[at..range.start]);
            replaced.push_str(&format!("({inner})"));
            at = range.end;
            if replaced.len() > MAX_LENGTH {
                return Err(Obstacle::Length);
            }
        }
        replaced.push_str(&text[at..]);
        Ok(replaced)
    }
}

impl Expander<'_> {
    /// Returns a formula of the time in which each coordinate of a body that moves by formulas is replaced by its formula. `None` if the
    /// formula names nothing else than variables, or something that no formula of the time can name; the latter is reported elsewhere.
    /// Reports bodies that follow each other, and then returns an empty text.
    pub(super) fn following(&mut self, text: &str, span: Span) -> Option<String> {
        members(text).next()?;
        let obstacle = match self.guided.replace(text, &mut Vec::new()) {
            Ok(replaced) => return Some(replaced),
            Err(obstacle) => obstacle,
        };
        let message = match obstacle {
            Obstacle::Other => return None,
            Obstacle::Length => {
                format!(
                    "with the formulas of the bodies that it names, this formula has over {MAX_LENGTH} bytes"
                )
            }
            Obstacle::Circle(names) => match names.as_slice() {
                [only] => format!("the motion of `{only}` follows itself"),
                names => {
                    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                    format!("the motions of {} follow each other", names.join(" and "))
                }
            },
        };
        if self.reported.insert(span) {
            let error = Diagnostic::error(Code::FormulaOfBody, message);
            self.diagnostics.push(error.at(span, "one of them needs a formula of `t` alone"));
        }
        Some(String::new())
    }
}
