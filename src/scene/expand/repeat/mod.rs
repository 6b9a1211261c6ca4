//! The key `repeat`: makes many bodies from one table.
//!
//! A copy is named after its body and its indices: `brick[3,0]`. The random numbers of a copy depend on this name, so adding copies does
//! not change the random numbers of existing copies.

mod curve;
mod pattern;
mod scatter;

use std::fmt::Write as _;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use self::pattern::Pattern;
use self::scatter::Scatter;
use super::Expander;
use super::groups::Group;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::{Bound, MAX_COPIES, TableSpec};
use crate::scene::read;
use crate::scene::source::{CopiedTable, Entry, Name, Node, Table, Value};
use crate::scene::timed::TimeFormula;
use crate::scene::view::View;

/// The variables that hold the indices of a copy along the first, second and third direction of the pattern.
pub(super) const INDEX_VARIABLES: [&str; 3] = ["i", "j", "k"];

/// The maximum cost of all copies with formulas, in units of about ten bytes of memory. Copies of this cost take a few seconds to make, and
/// fit into the memory of a typical computer.
const MAX_WORK: u64 = 100_000_000;

/// The cost of making one copy, not counting its formulas.
const WORK_OF_COPY: u64 = 100;

/// Returns the cost of evaluating a formula once: parsing its text and storing its value.
pub(super) fn work_of_value(text: &str) -> u64 {
    25 + text.len() as u64
}

/// Returns the cost of a formula that depends on the time. Such a formula is stored as compiled programs for its value and its derivatives.
pub(super) fn work_of_motion(formula: &TimeFormula) -> u64 {
    100 + 10 * formula.operations()
}

/// The offset (m) and the rotation of a copy, relative to the location and orientation of its body.
pub(super) struct CopyPose {
    offset: DVec3,
    turn: DQuat,
}

impl Expander<'_> {
    /// Replaces every body that has a `repeat` by its copies.
    pub(super) fn repeat(&mut self, bodies: &mut Table, spec: &'static TableSpec) {
        if !bodies.entries.iter().any(has_repeat) {
            return;
        }
        let mut all = Vec::with_capacity(bodies.entries.len());
        for entry in std::mem::take(&mut bodies.entries) {
            if has_repeat(&entry) {
                let name = entry.name.text.clone();
                self.with_key("body", |this| this.copies(entry, &name, spec, &mut all));
            } else {
                all.push(entry);
            }
        }
        self.unique(&all, "bodies");
        bodies.entries = all.into();
    }

    /// Appends all copies of the repeated body `entry` to `all`.
    fn copies(&mut self, entry: Entry, name: &str, spec: &'static TableSpec, all: &mut Vec<Entry>) {
        let Entry { name: Name { span: named, .. }, node: Node { span, value } } = entry;
        let Value::Table(mut table) = value else { return };
        let Some(place) = table.entries.iter().position(|entry| &*entry.name.text == "repeat") else {
            return;
        };
        let mut repeat = table.entries.remove(place);
        if let Some(key) = spec.key("repeat") {
            self.with_key(name, |this| {
                this.with_key("repeat", |this| this.value(&mut repeat.node, &key.kind));
            });
        }
        let pattern = self.with_key(name, |this| this.with_key("repeat", |this| this.pattern(&repeat, spec)));
        let counts = pattern.as_ref().map(Pattern::counts);
        let counts = counts.filter(|counts| self.is_affordable(counts, "bodies", name, repeat.node.span));
        let mut is_known = counts.is_some();
        // If the number of copies is wrong, make one copy to find the other errors in the table.
        let mut counts = counts.unwrap_or_else(|| vec![1]);
        self.collisions(&counts, name, repeat.name.span);

        let number = counts.iter().product();
        let first = all.len();
        all.reserve(number);
        let node = |value| Node { span, value };
        let mut sizes = Vec::new();
        let mut keeper = CopyCompressor::default();
        let scope = self.scope.clone();
        let before = self.work;
        for index in indices(&counts) {
            if all.len() == first + 1 && !self.is_workable(number, before, name, repeat.node.span) {
                (counts, is_known) = (vec![1], false);
                break;
            }
            let name: Arc<str> = copy_name(name, &index[..counts.len()]).into();
            self.count_as(&index[..counts.len()]);
            let mut table = table.clone();
            self.copy = Some(name.clone());
            self.with_key(&name, |this| this.table(&mut table, spec));
            self.copy = None;
            match &pattern {
                Some(Pattern::Count(_)) | None => {}
                Some(Pattern::Scatter(_)) => sizes.push(self.geometer.of(&table, spec).radius),
                Some(pattern) if is_known => self.place(&mut table, &pattern.place(index), &repeat, spec),
                Some(_) => {}
            }
            all.push(Entry { name: Name { span: named, text: name }, node: node(keeper.keep(table)) });
        }
        self.scope = scope;
        self.formulas.clear();
        let copies = &mut all[first..];
        let names = copies.iter().map(|copy| copy.name.text.clone()).collect();
        self.groups.add(name, Group { counts, is_known, names });
        if let (Some(Pattern::Scatter(scatter)), true) = (&pattern, is_known) {
            self.scatter(scatter, &sizes, copies, name, &repeat, spec);
        }
        // The first copy keeps its `repeat` key, which the validation checks later.
        if let Some(Entry { node: Node { value: Value::Table(table), .. }, .. }) = all.get_mut(first) {
            table.entries.push(repeat);
        }
    }

    /// Returns true if this many copies are within the limit for the scene, and counts them. Reports an error if not. `counts` is the
    /// number of copies along each direction, and `what` is the plural noun for the message, such as "bodies".
    pub(super) fn is_affordable(&mut self, counts: &[usize], what: &str, name: &str, span: Span) -> bool {
        let most = usize::try_from(MAX_COPIES).unwrap_or(usize::MAX);
        let number = counts.iter().fold(1usize, |product, count| product.saturating_mul(*count));
        let all = self.copies.saturating_add(number);
        if all <= most {
            self.copies = all;
            return true;
        }
        let message = format!("{all} {what} are too many: `repeat` makes at most {MAX_COPIES}");
        let label = format!("{number} copies of `{name}`");
        self.diagnostics.push(Diagnostic::error(Code::TooManyCopies, message).at(span, label));
        false
    }

    /// Returns true if the formulas of `number` copies are within the limit of cost. Reports an error if not. `before` is the total cost
    /// before the first copy; the cost since then serves as the estimate for every copy.
    pub(super) fn is_workable(&mut self, number: usize, before: u64, name: &str, span: Span) -> bool {
        let one = self.work - before;
        if one == 0 || (one + WORK_OF_COPY).saturating_mul(number as u64) <= MAX_WORK.saturating_sub(before) {
            return true;
        }
        let one = one + WORK_OF_COPY;
        let most = MAX_WORK.saturating_sub(before) / one;
        let message = format!("{number} copies of `{name}` have too many formulas");
        let label = format!("at most {most} copies of this body are made");
        let help = "copies share the values that are numbers: write a formula only where they differ";
        let error = Diagnostic::error(Code::TooManyCopies, message).at(span, label);
        self.diagnostics.push(error.help(help));
        false
    }

    /// Sets the variables `i`, `j` and `k` of formulas to the indices of a copy.
    pub(super) fn count_as(&mut self, index: &[usize]) {
        for (letter, number) in INDEX_VARIABLES.iter().zip(index) {
            #[allow(clippy::cast_precision_loss, reason = "there are few enough of them")]
            self.scope.constant(*letter, *number as f64);
        }
    }

    /// Reports variables of the scene that are named `i`, `j` or `k`, like an index of the copies of `name`.
    pub(super) fn collisions(&mut self, counts: &[usize], name: &str, span: Span) {
        for letter in INDEX_VARIABLES.into_iter().take(counts.len()) {
            let Some(&variable) = self.variable_spans.get(letter) else { continue };
            if !self.reported.insert(variable) {
                continue;
            }
            let message = format!("the variable `{letter}` has the name of an index");
            let error = Diagnostic::error(Code::IndexName, message).at(variable, "give it another name");
            let label = format!("`{letter}` counts the copies of `{name}`");
            self.diagnostics.push(error.at(span, label));
        }
    }

    /// Reports a body, force or joint that has the same name as a copy.
    pub(super) fn unique(&mut self, all: &[Entry], what: &str) {
        let mut names = std::collections::HashMap::with_capacity(all.len());
        for Entry { name: Name { span, text }, .. } in all {
            if let Some(other) = names.insert(text, *span) {
                let message = format!("two {what} are called `{text}`");
                let (copy, own) = if other > *span { (*span, other) } else { (other, *span) };
                let error = Diagnostic::error(Code::SameName, message).at(own, "one is here");
                self.diagnostics.push(error.at(copy, "a `repeat` makes the other"));
            }
        }
    }

    /// Scatters copies at random. `sizes` are their bounding radii, m (`None` for an unbounded copy).
    fn scatter(
        &mut self,
        scatter: &Scatter,
        sizes: &[Option<f64>],
        copies: &mut [Entry],
        name: &str,
        repeat: &Entry,
        spec: &'static TableSpec,
    ) {
        let stream = |n: usize| self.stream(&format!(".{:?}.repeat", copies[n].name.text));
        let places = match scatter.places(sizes, stream) {
            Ok(places) => places,
            Err(full) => {
                self.diagnostics.push(full.diagnostic(name, copies.len(), repeat.node.span));
                return;
            }
        };
        let mut keeper = CopyCompressor::default();
        for (copy, place) in copies.iter_mut().zip(places) {
            if let Some(table) = copy.node.table() {
                let mut table = table.into_owned();
                self.place(&mut table, &place, repeat, spec);
                copy.node.value = keeper.keep(table);
            }
        }
    }

    /// Moves a copy by the offset, and turns it by the rotation, that the pattern gives.
    fn place(&mut self, copy: &mut Table, place: &CopyPose, repeat: &Entry, spec: &'static TableSpec) {
        let CopyPose { offset, turn } = *place;
        let has_turned = turn != DQuat::IDENTITY;
        if has_turned && is_whole(copy, "orientation") {
            let turn = turn * self.geometer.of(copy, spec).orientation;
            let quaternion = numbers(&turn.normalize().to_array(), repeat.node.span);
            let name = Name { span: repeat.name.span, text: "quaternion".into() };
            let table = Table { entries: vec![Entry { name, node: quaternion }].into() };
            put(copy, "orientation", Value::Table(table), repeat);
        }
        if is_whole(copy, "location") {
            let own = View::new(spec, Some(copy)).get(&body::LOCATION);
            let location = numbers(&(own + offset).to_array(), repeat.node.span);
            // A location with an error stays as it is, because the validation reports it.
            if copy.get("location").is_none_or(|own| read::vector(&own.node, Bound::Any).is_some()) {
                put(copy, "location", location.value, repeat);
            }
        }
    }
}

/// Stores the tables of copies compactly, as their differences from a few template tables.
#[derive(Default)]
struct CopyCompressor {
    templates: Vec<Arc<Table>>,
}

impl CopyCompressor {
    /// Returns the compact value for the table of a copy. If no template has the same keys, stores the whole table and uses it as a
    /// further template.
    fn keep(&mut self, table: Table) -> Value {
        /// The maximum number of templates. Copies that have different keys need different templates.
        const MAX_TEMPLATES: usize = 4;
        if self.templates.iter().any(|template| template.entries.is_same(&table.entries)) {
            return Value::Table(table);
        }
        if let Some(copied) = self.templates.iter().find_map(|template| CopiedTable::new(&table, template)) {
            return Value::Copied(copied);
        }
        if self.templates.len() < MAX_TEMPLATES {
            self.templates.push(Arc::new(table.clone()));
        }
        Value::Table(table)
    }
}

/// Returns true if an entry is a table with the key `repeat`.
fn has_repeat(entry: &Entry) -> bool {
    entry.node.as_table().is_some_and(|table| table.get("repeat").is_some())
}

/// Returns true if a key is missing or its value is valid.
fn is_whole(table: &Table, key: &str) -> bool {
    table.get(key).is_none_or(|entry| !matches!(entry.node.value, Value::Invalid))
}

/// Replaces the value of a key. A key that is missing is added with the source span of the `repeat`.
fn put(table: &mut Table, key: &str, value: Value, repeat: &Entry) {
    match table.get_mut(key) {
        Some(entry) => entry.node.value = value,
        None => table.entries.push(Entry {
            name: Name { span: repeat.name.span, text: key.into() },
            node: Node { span: repeat.node.span, value },
        }),
    }
}

/// Makes a list node from numbers. The list and all its items get the same source span.
fn numbers(numbers: &[f64], span: Span) -> Node {
    let node = |number: &f64| Node { span, value: Value::Float(*number) };
    Node { span, value: Value::Array(numbers.iter().map(node).collect()) }
}

/// Returns the name of a copy, such as `brick[3,0]`, from the name of the body and the indices.
pub(super) fn copy_name(name: &str, index: &[usize]) -> String {
    let mut text = format!("{name}[");
    for (direction, number) in index.iter().enumerate() {
        let _ = write!(text, "{}{number}", if direction == 0 { "" } else { "," });
    }
    text.push(']');
    text
}

/// Iterates over all indices of a grid; the last index varies fastest. With fewer than three counts, the missing indices are 0.
pub(super) fn indices(counts: &[usize]) -> impl Iterator<Item = [usize; 3]> + use<> {
    let count = |direction: usize| counts.get(direction).copied().unwrap_or(1);
    let [ni, nj, nk] = [count(0), count(1), count(2)];
    (0..ni).flat_map(move |i| (0..nj).flat_map(move |j| (0..nk).map(move |k| [i, j, k])))
}

#[cfg(test)]
mod tests;
