//! Replaces the formulas in a scene's tree by their values.
//!
//! Where the grammar expects a number, a string is a formula. The computed number replaces the string and keeps its source span, so later
//! code handles numbers only. A formula with an error is reported and becomes [`Value::Invalid`].

mod corrections;
mod defaults;
mod evaluate;
mod formula;
mod geometry;
mod groups;
mod guided;
mod include;
mod index;
mod links;
mod merge;
mod of_body;
pub(super) mod place;
mod repeat;
mod settled;
#[cfg(test)]
mod tests;
mod variables;

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::sync::Arc;

pub(super) use self::geometry::{Geometer, Geometry};
pub(super) use self::groups::Groups;
use self::guided::GuidedBodies;
pub(super) use self::include::include;
pub(crate) use self::place::in_string;
use self::settled::{has_work, is_list, is_settled};
use super::expression::{Formula, Scope};
use super::grammar::{Collection, Kind, SCENE, TableSpec};
use super::source::{Node, Table, Value};
use super::timed::Formulas;
use crate::diagnostic::{Diagnostic, Sources, Span};

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
        reported: HashSet::new(),
        unit: "",
        guided: GuidedBodies::default(),
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
    expander.guided = GuidedBodies::of(root);
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
    /// True while the table `[defaults]` is expanded. Its formulas are not evaluated there, but in each body, force and so on that uses
    /// them.
    is_default: bool,
    /// The source span of each variable's name.
    variable_spans: HashMap<String, Span>,
    /// The source spans whose errors have been reported. All copies of a body share the span of a formula, so its error is reported once.
    reported: HashSet<Span>,
    /// The unit of the key that is being expanded. Empty for a key without a unit.
    unit: &'static str,
    /// The source spans of formulas that have been warned about because of the unit of an angle.
    warned: HashSet<Span>,
    /// The bodies that move by formulas of the time, which other such formulas can follow.
    guided: GuidedBodies,
    /// The formulas that use the locations of bodies. Their errors are reported at the end of the expansion.
    of_bodies: Vec<corrections::OfBody>,
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
            self.with_key(&entry.name.text, |this| this.value(&mut entry.node, &key.kind));
            self.unit = unit;
        }
    }

    /// Calls `work` while `key` is appended to the current path.
    fn with_key<T>(&mut self, key: &str, work: impl FnOnce(&mut Self) -> T) -> T {
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
            (Kind::Varying(_), Value::String(_)) => self.varying(node),
            (Kind::Sampled(_), Value::String(_)) => self.drawn_later(node),
            (Kind::OfBody(names), Value::String(_)) => self.of_body(node, names),
            (Kind::ListOfBody(_, names), Value::Array(_)) => {
                self.items(node, |this, item| this.of_body(item, names));
            }
            (Kind::TimedNumbers(..), Value::Array(_)) => self.items(node, Expander::timed),
            (Kind::VaryingNumbers(..), Value::Array(_)) => {
                // The formulas of measures beside a wrong one are checked later.
                self.each_item(node, Expander::varying);
            }
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
                        self.with_key(&entry.name.text, |this| this.table(inner, spec));
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

    /// Expands each item of a list with the function `look`. If an item becomes invalid after a reported error, the whole list becomes
    /// [`Value::Invalid`].
    fn items(&mut self, node: &mut Node, look: impl Fn(&mut Self, &mut Node)) {
        self.each_item(node, look);
        let Value::Array(items) = &node.value else { return };
        if items.iter().any(|item| matches!(item.value, Value::Invalid)) {
            node.value = Value::Invalid;
        }
    }

    /// Expands each item of a list with the function `look`.
    fn each_item(&mut self, node: &mut Node, look: impl Fn(&mut Self, &mut Node)) {
        let Value::Array(items) = &mut node.value else { return };
        for (number, item) in items.iter_mut().enumerate() {
            let length = self.path.len();
            let _ = write!(self.path, "[{number}]");
            look(self, item);
            self.path.truncate(length);
        }
    }
}
