//! Replaces the formulas in a scene's tree by their values.
//!
//! Where the grammar expects a number, a string is a formula. The computed value keeps the source span of the string, so later code
//! handles numbers only. A formula with an error is reported and becomes [`Value::Invalid`].

mod defaults;
mod geometry;
mod groups;
mod habits;
mod include;
mod index;
mod links;
mod merge;
mod of_body;
pub(super) mod place;
mod repeat;
#[cfg(test)]
mod tests;
mod variables;

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::sync::Arc;

pub(super) use self::geometry::{Geometer, Geometry};
pub(super) use self::groups::Groups;
pub(super) use self::include::include;
pub(crate) use self::place::in_string;
use self::repeat::INDICES;
use super::drawn::DrawnFormula;
use super::expression::{Draw, ExpressionError, Formula, Resolved, Scope};
use super::grammar::{Collection, Kind, SCENE, TableSpec};
use super::source::{Entry, Node, Table, Value};
use super::timed::{Formulas, TimeFormula};
use crate::diagnostic::{Code, Diagnostic, Sources, Span};
use crate::random::Stream;

/// Fills in `[defaults]`, replaces repeated bodies, forces and joints by their copies, and replaces every formula by its value.
pub(super) fn expand(
    root: &mut Table,
    geometer: &mut dyn Geometer,
    sources: &Sources,
    diagnostics: &mut Vec<Diagnostic>,
) -> Expansion {
    let mut expander = Expander {
        geometer,
        sources,
        scope: Scope::default(),
        formulas: HashMap::new(),
        timed_formulas: Formulas::default(),
        work: 0,
        broken: HashSet::new(),
        seed: 0,
        path: String::new(),
        copy: None,
        copies: 0,
        names: 0,
        groups: Groups::default(),
        of_defaults: HashSet::new(),
        is_default: false,
        variable_spans: HashMap::new(),
        told: HashSet::new(),
        unit: "",
        of_bodies: Vec::new(),
        warned: HashSet::new(),
        diagnostics,
    };
    if let Some(entry) = root.get_mut("seed") {
        // Variables may be random, so the seed is read before them.
        expander.integer(&mut entry.node);
        if let Value::Integer(seed) = entry.node.value {
            expander.seed = seed.unsigned_abs();
        }
    }
    expander.scope = Scope::default().with_draws();
    if let Some(Value::Table(table)) = root.get_mut("variables").map(|entry| &mut entry.node.value) {
        expander.variables(table);
    }
    expander.defaults(root);
    if let Some(Value::Table(bodies)) = root.get_mut("body").map(|entry| &mut entry.node.value)
        && let Some(Kind::Named(spec)) = SCENE.key("body").map(|key| &key.kind)
    {
        expander.repeat(bodies, spec);
    }
    expander.repeat_links(root);
    expander.table(root, &SCENE);
    expander.report_of_bodies(root);
    Expansion { groups: expander.groups, of_defaults: expander.of_defaults }
}

/// Results of the expansion that the expanded tree itself does not hold.
#[derive(Default)]
pub(super) struct Expansion {
    /// The copies of repeated bodies, forces and joints.
    pub(super) groups: Groups,
    /// The source spans of all keys and values in `[defaults]`.
    pub(super) of_defaults: HashSet<Span>,
}

/// The state of the expansion of a scene.
struct Expander<'a> {
    /// Reads the size and orientation of bodies before they are checked.
    geometer: &'a mut dyn Geometer,
    sources: &'a Sources,
    scope: Scope,
    /// The parsed formulas of the body, force or joint that is being copied, by source span. All copies share them.
    formulas: HashMap<Span, Arc<Formula>>,
    /// The parsed formulas that depend on the time.
    timed_formulas: Formulas,
    /// The cost of the formulas so far, in the units of [`repeat::work_of_value`]. It limits how many copies are made.
    work: u64,
    /// The variables whose value is unknown because of an error, which has been reported.
    broken: HashSet<String>,
    /// The seed of the random numbers of the scene. Each formula has its own random stream, derived from the seed and from the path of its
    /// key.
    seed: u64,
    /// The path of the value that is being expanded, such as `body.ball.location[1]`.
    path: String,
    /// The name of the copy that is being expanded, such as `brick[3,0]`. `None` outside of copies.
    copy: Option<Arc<str>>,
    /// The number of copies made so far.
    copies: usize,
    /// The number of list items made so far from names that mean several bodies.
    names: usize,
    groups: Groups,
    of_defaults: HashSet<Span>,
    /// True within `[defaults]`. A default formula is evaluated only in the bodies, forces and so on that use it.
    is_default: bool,
    /// The source span of each variable's name.
    variable_spans: HashMap<String, Span>,
    /// The source spans whose errors have been reported. All copies of a body share the span of a formula, so its error is reported once.
    told: HashSet<Span>,
    /// The unit of the key that is being expanded. Empty for a key without a unit.
    unit: &'static str,
    /// The source spans of formulas that have been warned about because of the unit of an angle.
    warned: HashSet<Span>,
    /// The formulas that use the locations of bodies. Their errors are reported at the end of the expansion.
    of_bodies: Vec<habits::OfBody>,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl Expander<'_> {
    fn table(&mut self, table: &mut Table, spec: &'static TableSpec) {
        for number in 0..table.entries.len() {
            let entry = &table.entries[number];
            let Some(key) = spec.key(&entry.name.text).filter(|key| !is_settled(&entry.node, &key.kind))
            else {
                continue;
            };
            let entry = &mut table.entries[number];
            // A nested list, such as a vector in a list of points, has the unit of its key.
            let unit = std::mem::replace(&mut self.unit, key.unit);
            self.below(&entry.name.text, |this| this.value(&mut entry.node, &key.kind));
            self.unit = unit;
        }
    }

    /// Calls `work` while `key` is appended to the current path.
    fn below<T>(&mut self, key: &str, work: impl FnOnce(&mut Self) -> T) -> T {
        let length = self.path.len();
        if length > 0 {
            self.path.push('.');
        }
        let is_plain = key.chars().all(|c| c.is_alphanumeric() || matches!(c, '-' | '_'));
        if is_plain {
            self.path.push_str(key);
        } else {
            // Other names are quoted: a dot in a name does not lead to an inner table.
            let _ = write!(self.path, "{key:?}");
        }
        let done = work(self);
        self.path.truncate(length);
        done
    }

    fn value(&mut self, node: &mut Node, kind: &'static Kind) {
        match (kind, &mut node.value) {
            (Kind::Number(_), Value::String(_)) => self.number(node),
            (Kind::Timed(_), Value::String(_)) => self.timed(node),
            (Kind::Drawn(_), Value::String(_)) => self.drawn_later(node),
            (Kind::OfBody(names), Value::String(_)) => self.of_body(node, names),
            (Kind::ListOfBody(_, names), Value::Array(_)) => {
                self.items(node, |this, item| this.of_body(item, names));
            }
            (Kind::TimedNumbers(..), Value::Array(_)) => self.items(node, Expander::timed),
            (Kind::Integer(..), Value::String(_)) => self.integer(node),
            (Kind::Colors, Value::Array(items)) if items.iter().any(is_list) => {
                self.items(node, |this, item| this.value(item, &Kind::Color));
            }
            // In a list of colors, strings are names of colors, not formulas.
            (Kind::Colors, Value::Array(items)) if items.iter().all(|item| item.as_str().is_some()) => {}
            (Kind::Numbers(..) | Kind::Direction(_) | Kind::Color | Kind::Colors, Value::Array(_)) => {
                self.items(node, Expander::number);
            }
            (Kind::List { of, max, .. }, Value::Array(_)) => {
                self.items(node, |this, item| this.value(item, of));
                if of.names(Collection::Body) {
                    match max {
                        2 => self.are_single(node),
                        _ => self.spread(node),
                    }
                }
            }
            (Kind::Reference(of), Value::String(_)) => self.index(node, *of),
            (Kind::Table(spec), Value::Table(inner)) => self.table(inner, spec),
            (Kind::Partial(spec), Value::Table(inner)) => {
                self.is_default = true;
                self.table(inner, spec);
                self.is_default = false;
            }
            (Kind::Named(spec), Value::Table(tables)) => {
                for entry in &mut tables.entries {
                    if entry.node.as_table().is_some_and(|inner| has_work(inner, spec))
                        && let Value::Table(inner) = &mut entry.node.value
                    {
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

    /// Expands each item of a list by `look`. If an item becomes invalid after a reported error, the whole list becomes
    /// [`Value::Invalid`].
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

    /// Replaces a formula (a string) by its value. Leaves values of other types unchanged.
    fn number(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        if self.is_hopeless(node.span)
            || self.has_unit(text, node.span)
            || self.asks_for_body(text, node.span, false)
        {
            node.value = Value::Invalid;
            return;
        }
        if self.is_default {
            self.look_over(text, node.span);
            node.value = Value::Invalid;
            return;
        }
        node.value = self.evaluate(text, node.span).map_or(Value::Invalid, Value::Float);
    }

    /// Returns true if another copy has reported an error in this formula. The formula is then not evaluated again.
    fn is_hopeless(&self, span: Span) -> bool {
        self.copy.is_some() && self.told.contains(&span)
    }

    /// Replaces a formula by its value, as [`Expander::number`] does, but keeps a formula that depends on the time as a compiled program.
    fn timed(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        if self.is_hopeless(node.span)
            || self.has_unit(text, node.span)
            || self.asks_for_body(text, node.span, true)
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

    fn time_formula(&mut self, formula: &Formula, text: Arc<str>, span: Span) -> Option<Arc<TimeFormula>> {
        if !self.broken.is_empty() && formula.names().any(|(name, _)| self.broken.contains(name)) {
            return None;
        }
        self.scope.slot("t");
        let resolved = formula.resolve(&self.scope);
        self.scope.remove_slot("t");
        let resolved = self.keep(resolved, formula.text(), span)?;
        let resolved = resolved.with_draws(&self.drawn(&resolved));
        let read = self.timed_formulas.read(text, span, &resolved).map_err(|error| vec![error]);
        let read = self.keep(read, formula.text(), span)?;
        self.work += repeat::work_of_motion(&read);
        Some(read)
    }

    /// Replaces a formula by its value, as [`Expander::number`] does, but keeps a formula with random numbers or the time as a compiled
    /// program. Each particle then evaluates the program with its own random numbers.
    fn drawn_later(&mut self, node: &mut Node) {
        let Value::String(text) = &node.value else { return };
        let (text, span) = (text.clone(), node.span);
        node.value = Value::Invalid;
        if self.has_unit(&text, span) || self.asks_for_body(&text, span, true) {
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
        let Some(resolved) = self.keep(resolved, &text, span) else { return };
        let changes = formula.names().any(|(name, _)| name == "t") || !resolved.draws().is_empty();
        if !changes {
            node.value = self.value_of(&formula, span).map_or(Value::Invalid, Value::Float);
            return;
        }
        let program = resolved.compile().map_err(|error| vec![error]);
        let program = self.keep(program, &text, span);
        let drawn = program.map(|program| Arc::new(DrawnFormula::new(text, program)));
        node.value = drawn.map_or(Value::Invalid, Value::Drawn);
    }

    /// Replaces a formula by its value, as [`Expander::number`] does, and reports an error if that value is not a whole number.
    fn integer(&mut self, node: &mut Node) {
        /// The largest number (2⁵³) up to which an `f64` represents all whole numbers.
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
            let message = format!("expected a whole number, found {value}{}", self.in_copy());
            let error =
                Diagnostic::error(Code::WrongType, message).at(node.span, "the value of this formula");
            if self.told.insert(node.span) {
                self.diagnostics.push(error.help("`round`, `floor` and `ceil` give whole numbers"));
            }
            node.value = Value::Invalid;
        }
    }

    /// Reports those errors in a formula of `[defaults]` that occur for every copy, such as unknown names. Evaluates nothing.
    fn look_over(&mut self, text: &str, span: Span) {
        let mut scope = self.scope.clone();
        INDICES.into_iter().for_each(|index| scope.constant(index, 0.0));
        if let Some(formula) = self.keep(Formula::parse(text), text, span) {
            self.keep(formula.resolve(&scope), text, span);
        }
    }

    /// Evaluates the formula `text` at the source span `span`. Returns `None` after reporting an error.
    fn evaluate(&mut self, text: &str, span: Span) -> Option<f64> {
        let formula = self.parsed(text, span)?;
        self.look_at_angles(&formula, span);
        self.value_of(&formula, span)
    }

    /// Parses the formula at a source span, or returns it from the cache that all copies share. Returns `None` after reporting an error.
    fn parsed(&mut self, text: &str, span: Span) -> Option<Arc<Formula>> {
        if let Some(known) = self.formulas.get(&span) {
            return Some(known.clone());
        }
        let formula = Arc::new(self.keep(Formula::parse(text), text, span)?);
        if self.copy.is_some() {
            self.formulas.insert(span, formula.clone());
        }
        Some(formula)
    }

    /// Evaluates a parsed formula. Returns `None` if an error has been reported, here or for a variable in the formula.
    fn value_of(&mut self, formula: &Formula, span: Span) -> Option<f64> {
        if !self.broken.is_empty() && formula.names().any(|(name, _)| self.broken.contains(name)) {
            return None;
        }
        self.work += repeat::work_of_value(formula.text());
        let resolved = self.keep(formula.resolve(&self.scope), formula.text(), span)?;
        let drawn = self.drawn(&resolved);
        let value = resolved.value(&drawn).map_err(|mut error| {
            error.message.push_str(&self.in_copy());
            vec![error]
        });
        self.keep(value, formula.text(), span)
    }

    /// Draws the random numbers of a formula, in the order of their use. Each path of a key has its own, independent random stream.
    fn drawn(&self, resolved: &Resolved) -> Vec<f64> {
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
    fn stream(&self, below: &str) -> Stream {
        Stream::new(self.seed, &format!("{}{below}", self.path))
    }

    /// Returns the name of the current copy as the end of an error message. Empty outside of copies.
    fn in_copy(&self) -> String {
        self.copy.as_ref().map_or_else(String::new, |name| format!(", in `{name}`"))
    }

    /// Returns the value of `found`, or reports its errors at their positions in the scene's text and returns `None`. `text` is the
    /// formula and `span` is its source span.
    fn keep<T>(&mut self, found: Result<T, Vec<ExpressionError>>, text: &str, span: Span) -> Option<T> {
        let errors = match found {
            Ok(value) => return Some(value),
            Err(errors) => errors,
        };
        if !self.told.insert(span) {
            return None;
        }
        for error in errors {
            let place = place::in_string(self.raw(span), text, &error.range, span);
            let is_said = error.label.starts_with("did you mean");
            let mut diagnostic = Diagnostic::error(error.code, error.message).at(place, error.label);
            if let Some((key, motion)) = self.motion_meant(&text[error.range.clone()], span) {
                diagnostic = diagnostic.fix(key, motion);
            } else if let Some(number) = habits::without_decimal_comma(text) {
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
    fn raw(&self, span: Span) -> &str {
        self.sources.get(span.source).text.get(span.start..span.end).unwrap_or_default()
    }
}

/// Returns true if a table contains formulas or names of several bodies, which the expansion has to replace.
fn has_work(table: &Table, spec: &TableSpec) -> bool {
    let is_open =
        |entry: &Entry| spec.key(&entry.name.text).is_some_and(|key| !is_settled(&entry.node, &key.kind));
    table.entries.iter().any(is_open)
}

fn is_list(node: &Node) -> bool {
    matches!(node.value, Value::Array(_))
}

/// Returns true if a value contains neither formulas nor names of several bodies. All copies of a body share one instance of each of these
/// values.
fn is_settled(node: &Node, kind: &Kind) -> bool {
    let is_number = |item: &Node| !matches!(item.value, Value::String(_) | Value::Invalid);
    match (kind, &node.value) {
        (
            Kind::Number(_) | Kind::Timed(_) | Kind::Drawn(_) | Kind::OfBody(_) | Kind::Integer(..),
            Value::String(_),
        ) => false,
        (Kind::Reference(_), Value::String(text)) => !index::is_formula(text),
        (
            Kind::TimedNumbers(..)
            | Kind::ListOfBody(..)
            | Kind::Numbers(..)
            | Kind::Direction(_)
            | Kind::Color,
            Value::Array(items),
        ) => items.iter().all(is_number),
        (Kind::Colors, Value::Array(items)) => !items.iter().any(|item| is_list(item) || is_number(item)),
        (Kind::List { of, .. }, Value::Array(items)) => {
            let is_whole = |item: &Node| !matches!(item.value, Value::Invalid) && is_settled(item, of);
            !of.names(Collection::Body) && items.iter().all(is_whole)
        }
        (Kind::Table(spec) | Kind::Partial(spec), Value::Table(inner)) => !has_work(inner, spec),
        (Kind::Named(spec), Value::Table(tables)) => {
            let is_open = |entry: &Entry| entry.node.as_table().is_some_and(|inner| has_work(inner, spec));
            !tables.entries.iter().any(is_open)
        }
        (Kind::Either(kinds), value) => {
            kinds.iter().find(|kind| kind.takes(value)).is_none_or(|kind| is_settled(node, kind))
        }
        _ => true,
    }
}
