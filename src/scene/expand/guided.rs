//! Formulas of the time that follow a body which moves by formulas itself, such as `crank.x + 1`.
//!
//! The name of a coordinate stands for the formula of that coordinate, in parentheses. So velocities and accelerations follow as for any
//! other formula. Each coordinate is replaced once, however many formulas follow it.

use std::collections::HashMap;

use super::Expander;
use super::corrections::members;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::expression::Formula;
use crate::scene::source::{Table, Value};
use crate::scene::units;

/// The longest formula that may result, bytes. A formula that names two bodies, each of which names two, and so on, grows quickly.
const MAX_LENGTH: usize = 10_000;
/// The largest number of bodies that follow one after the other. A formula has at most some hundred parentheses in each other.
const MAX_CHAIN: usize = 50;

/// The coordinates of each body that moves by formulas of the time. Copies of bodies are left out, and so are bodies with random numbers,
/// which each formula would draw anew.
#[derive(Default)]
pub(super) struct GuidedBodies {
    /// The texts of the three formulas of each body, as they are written.
    written: HashMap<String, [String; 3]>,
    /// What is known of the coordinates that formulas have followed.
    followed: HashMap<(String, usize), Result<String, Obstacle>>,
}

/// The reason why a formula cannot follow what it names.
#[derive(Clone, Debug)]
enum Obstacle {
    /// It names something else than the coordinate of a body that moves by formulas.
    Other,
    /// What it follows is wrong itself, which is reported there.
    Elsewhere,
    /// The bodies with these names follow each other.
    Circle(Vec<String>),
    /// The formula would be too long.
    Length,
    /// Too many bodies follow one after the other.
    Chain,
}

impl GuidedBodies {
    /// Finds these bodies in a scene, before its repeated bodies are copied.
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
        GuidedBodies { written: guided.collect(), followed: HashMap::new() }
    }

    /// Replaces each coordinate of a body in a formula by its formula. `chain` are the bodies whose formulas lead here. `is_right` tells whether
    /// a formula without names of bodies has no mistake.
    fn replace(
        &mut self,
        text: &str,
        chain: &mut Vec<String>,
        is_right: &dyn Fn(&str) -> bool,
    ) -> Result<String, Obstacle> {
        let mut replaced = String::new();
        let mut at = 0;
        for (range, name, member) in members(text) {
            let axis = ["x", "y", "z"].iter().position(|axis| *axis == member).ok_or(Obstacle::Other)?;
            let inner = self.coordinate(name, axis, chain, is_right)?;
            replaced.push_str(&text[at..range.start]);
            replaced.push('(');
            replaced.push_str(&inner);
            replaced.push(')');
            at = range.end;
            if replaced.len() > MAX_LENGTH {
                return Err(Obstacle::Length);
            }
        }
        replaced.push_str(&text[at..]);
        Ok(replaced)
    }

    /// Returns the formula of a coordinate of a body, without names of bodies.
    fn coordinate(
        &mut self,
        name: &str,
        axis: usize,
        chain: &mut Vec<String>,
        is_right: &dyn Fn(&str) -> bool,
    ) -> Result<String, Obstacle> {
        let key = (name.to_owned(), axis);
        if let Some(known) = self.followed.get(&key) {
            return known.clone();
        }
        let written = self.written.get(name).ok_or(Obstacle::Other)?[axis].clone();
        if let Some(first) = chain.iter().position(|known| known == name) {
            return Err(Obstacle::Circle(chain[first..].to_vec()));
        }
        if chain.len() >= MAX_CHAIN {
            return Err(Obstacle::Chain);
        }
        chain.push(name.to_owned());
        let replaced = self.replace(&written, chain, is_right);
        chain.pop();
        let replaced = replaced.and_then(|it| if is_right(&it) { Ok(it) } else { Err(Obstacle::Elsewhere) });
        // The bodies of a circle have the same one, and what follows a wrong body is not wrong itself.
        let kept = match &replaced {
            Ok(text) => Ok(text.clone()),
            Err(Obstacle::Circle(names)) if names.iter().any(|known| known == name) => {
                Err(Obstacle::Circle(names.clone()))
            }
            Err(_) => Err(Obstacle::Elsewhere),
        };
        self.followed.insert(key, kept);
        replaced
    }
}

impl Expander<'_> {
    /// Returns a formula of the time in which each coordinate of a body that moves by formulas is replaced by its formula. `None` if the
    /// formula names nothing else than variables, or something that no formula of the time can name; the latter is reported elsewhere.
    /// Reports what cannot be followed, and then returns an empty text.
    pub(super) fn following(&mut self, text: &str, span: Span) -> Option<String> {
        members(text).next()?;
        let mut guided = std::mem::take(&mut self.guided);
        let is_known =
            |name: &str| name == "t" || self.broken.contains(name) || self.scope.value(name).is_some();
        let is_right = |text: &str| {
            Formula::parse(text).is_ok_and(|formula| formula.names().all(|(name, _)| is_known(name)))
        };
        let replaced = guided.replace(text, &mut Vec::new(), &is_right);
        self.guided = guided;
        let own = own_body(&self.path).map(str::to_owned);
        let message = match replaced {
            Ok(replaced) if self.is_right_itself(text, span) => return Some(replaced),
            Ok(_) | Err(Obstacle::Elsewhere) => return Some(String::new()),
            Err(Obstacle::Other) => return None,
            Err(Obstacle::Length) => {
                format!(
                    "with the formulas of the bodies that it names, this formula has over {MAX_LENGTH} bytes"
                )
            }
            Err(Obstacle::Chain) => format!("more than {MAX_CHAIN} bodies follow one after the other"),
            Err(Obstacle::Circle(names)) => match names.as_slice() {
                // A body outside of the circle is not to blame.
                names if !own.is_some_and(|own| names.contains(&own)) => {
                    return Some(String::new());
                }
                [only] => format!("the motion of `{only}` follows itself"),
                names => {
                    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                    format!("the motions of {} follow each other", names.join(" and "))
                }
            },
        };
        if self.reported.insert(span) {
            let error = Diagnostic::error(Code::FormulaOfBody, message);
            self.diagnostics.push(error.at(span, "write a formula of `t` here"));
        }
        Some(String::new())
    }

    /// Returns whether a formula is right if its names of bodies are. Otherwise, reports its mistakes at their places.
    fn is_right_itself(&mut self, text: &str, span: Span) -> bool {
        let mut plain = text.to_owned();
        for (range, ..) in members(text) {
            plain.replace_range(range.clone(), &format!("{:<1$}", "t", range.len()));
        }
        let Some(formula) = self.ok_or_report(Formula::parse(&plain), text, span) else { return false };
        self.scope.slot("t");
        let resolved = formula.resolve(&self.scope);
        self.scope.remove_slot("t");
        self.ok_or_report(resolved, text, span).is_some()
    }
}

/// Returns the name of the body whose key has this path, such as `body.crank.motion.formula.location[0]`.
fn own_body(path: &str) -> Option<&str> {
    path.strip_prefix("body.")?.split('.').next()
}
