//! Copies forces and joints that have a `repeat`, or that connect bodies whose names contain the index `i`.
//!
//! `between = ["hook[i]", "bob[i]"]` makes a copy for each `i` for which both bodies exist.

use std::sync::Arc;

use super::Expander;
use super::groups::{body_of, split};
use super::index;
use super::repeat::copy_name;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::expression::Formula;
use crate::scene::grammar::{Collection, Kind, MAX_COPIES, SCENE, TableSpec};
use crate::scene::source::{Entry, Name, Node, Table, Value};

/// The name of a copied body or joint in `between`, and how many copies it has.
struct NamedCopies<'a> {
    /// The position of the name in the scene's text.
    span: Span,
    /// The name without the index.
    name: &'a str,
    /// The number of copies.
    copies: usize,
}

impl Expander<'_> {
    /// Replaces each repeated force and each repeated joint by its copies.
    pub(super) fn repeat_links(&mut self, root: &mut Table) {
        for (key, what) in [("force", "forces"), ("joint", "joints")] {
            let Some(Kind::Named(spec)) = SCENE.key(key).map(|key| &key.kind) else { continue };
            let Some(Value::Table(tables)) = root.get_mut(key).map(|entry| &mut entry.node.value) else {
                continue;
            };
            if !tables.entries.iter().any(|entry| is_many(entry, spec)) {
                continue;
            }
            let entries: Vec<Entry> = std::mem::take(&mut tables.entries).into_iter().collect();
            let mut copies: Vec<Vec<Entry>> = entries.iter().map(|_| Vec::new()).collect();
            // A gear couples copies of other joints, so the other joints are copied first.
            let (gears, others): (Vec<_>, Vec<_>) =
                entries.into_iter().zip(&mut copies).partition(|(entry, _)| is_gear(entry));
            for (entry, copies) in others.into_iter().chain(gears) {
                if is_many(&entry, spec) {
                    self.with_key(key, |this| this.copies_of_link(entry, what, spec, copies));
                } else {
                    copies.push(entry);
                }
            }
            let all: Vec<Entry> = copies.into_iter().flatten().collect();
            self.unique(&all, what);
            tables.entries = all.into();
        }
    }

    fn copies_of_link(&mut self, entry: Entry, what: &str, spec: &'static TableSpec, all: &mut Vec<Entry>) {
        let Entry { name: Name { span: named, text: name }, node: Node { span, value } } = entry;
        let Value::Table(mut table) = value else { return };
        let place = table.entries.iter().position(|entry| &*entry.name.text == "repeat");
        let mut repeat = place.map(|place| table.entries.remove(place));
        if let (Some(repeat), Some(key)) = (&mut repeat, spec.key("repeat")) {
            self.with_key(&name, |this| {
                this.with_key("repeat", |this| this.value(&mut repeat.node, &key.kind));
            });
        }
        let (count, because, letter) = match &repeat {
            Some(repeat) => (count_of(&repeat.node), repeat.node.span, repeat.name.span),
            None if let Some(repeat) = misplaced_repeat(&table, spec) => {
                (count_of(&repeat.node), repeat.node.span, repeat.name.span)
            }
            None => {
                let mut ends = Vec::new();
                ends_of_i(&table, spec, &mut ends);
                let span = ends.first().map_or(named, |(end, _)| end.span);
                (self.count_of_ends(&ends), span, span)
            }
        };
        // If the number of copies is wrong, make one copy to find the other errors in the table.
        let count = count.filter(|count| self.is_affordable(&[*count], what, &name, because)).unwrap_or(1);
        self.collisions(&[count], &name, letter);
        let (scope, before, first) = (self.scope.clone(), self.work, all.len());
        for number in 0..count {
            if number == 1 && !self.is_workable(count, before, &name, because) {
                break;
            }
            let copy: Arc<str> = copy_name(&name, &[number]).into();
            self.count_as(&[number]);
            let mut table = table.clone();
            self.copy = Some(copy.clone());
            self.with_key(&copy, |this| this.table(&mut table, spec));
            self.copy = None;
            all.push(Entry {
                name: Name { span: named, text: copy },
                node: Node { span, value: Value::Table(table) },
            });
        }
        self.scope = scope;
        self.formulas.clear();
        self.groups.add_link(&name);
        if what == "joints" {
            self.groups.add_joint(&name, count);
        }
        // The first copy keeps its `repeat` key, which the validation checks later.
        if let (Some(Entry { node: Node { value: Value::Table(table), .. }, .. }), Some(repeat)) =
            (all.get_mut(first), repeat)
        {
            table.entries.push(repeat);
        }
    }

    /// Counts the values of `i`, from 0 upward, for which all bodies and joints named in `ends` exist. Returns `None` after reporting that
    /// two bodies of a pair have different numbers of copies.
    fn count_of_ends(&mut self, ends: &[(&Node, Collection)]) -> Option<usize> {
        let ends: Vec<(&Node, Collection, &str, Vec<Formula>)> = ends
            .iter()
            .filter_map(|(node, of)| {
                let (original, formulas) = index::of_i(node.as_str()?)?;
                Some((*node, *of, original, formulas))
            })
            .collect();
        let plain = ends.iter().filter(|(.., formulas)| matches!(&formulas[..], [one] if one.text() == "i"));
        let mut sizes = plain.filter_map(|(node, of, original, _)| {
            let copies = self.groups.counts(*of, original)?.iter().product();
            Some(NamedCopies { span: node.span, name: original, copies })
        });
        if let Some(one) = sizes.next()
            && let Some(other) = sizes.find(|other| other.copies != one.copies)
        {
            self.uneven(&one, &other);
            return None;
        }
        drop(sizes);
        let scope = self.scope.clone();
        let most = usize::try_from(MAX_COPIES).unwrap_or(usize::MAX);
        let count = (0..=most).find(|number| {
            self.count_as(&[*number]);
            !ends.iter().all(|(_, of, original, formulas)| self.has_copy(*of, original, formulas))
        });
        self.scope = scope;
        // If not even the copy for `i = 0` has all its bodies, that copy is made, and the validation reports its missing body.
        count.map(|count| count.max(1))
    }

    /// Returns true if the repeated body or joint `original` has a copy with the indices that the formulas give for the current `i`.
    fn has_copy(&self, of: Collection, original: &str, formulas: &[Formula]) -> bool {
        let Some(counts) = self.groups.counts(of, original) else { return false };
        let is_in_range = |(formula, count): (&Formula, &usize)| {
            let value = formula.resolve(&self.scope).ok().and_then(|resolved| resolved.value(&[]).ok());
            #[allow(clippy::cast_precision_loss, reason = "there are few enough of them")]
            value.is_some_and(|value| value >= 0.0 && value < *count as f64)
        };
        formulas.len() == counts.len() && formulas.iter().zip(counts).all(is_in_range)
    }

    /// Reports two bodies with different numbers of copies.
    fn uneven(&mut self, first: &NamedCopies<'_>, second: &NamedCopies<'_>) {
        let NamedCopies { span: here, name: one, copies: many } = *first;
        let NamedCopies { span: there, name: other, copies: more } = *second;
        let message =
            format!("pairs take as many of each: `{one}` has {many} copies, and `{other}` has {more}");
        let help = format!("to leave the others out, write `repeat = {}`", many.min(more));
        let error = Diagnostic::error(Code::WrongLength, message).at(there, format!("{more} copies"));
        self.diagnostics.push(error.at(here, format!("{many} copies")).help(help));
    }

    /// Reports an error if an end of a joint names several bodies, and suggests one joint for each `i`.
    pub(super) fn are_single(&mut self, list: &mut Node) {
        let Value::Array(items) = &list.value else { return };
        let is_several = |item: &&Node| self.groups.means_several(item);
        let Some(several) = items.iter().find(is_several) else { return };
        let name = body_of(several).unwrap_or_default();
        let message = format!("`{name}` is several bodies, and each end of a joint is one");
        let error = Diagnostic::error(Code::WrongLength, message).at(several.span, "which of them?");
        let line = |item: &Node| {
            let raw = self.raw(item.span);
            match body_of(item).filter(|_| is_several(&item)) {
                Some(name) => raw.replacen(&format!("\"{name}\""), &format!("\"{}\"", by_index(name)), 1),
                None => raw.to_owned(),
            }
        };
        let pairs = format!("[{}]", items.iter().map(line).collect::<Vec<_>>().join(", "));
        let error = error.help(format!("for pairs, write `between = {pairs}`")).fix(list.span, pairs);
        if self.reported.insert(list.span) {
            self.diagnostics.push(error.fix_is_said());
        }
        list.value = Value::Invalid;
    }
}

/// Rewrites a name of several bodies as the name of the copy with index `i`: `bob` and `bob[*]` → `bob[i]`.
fn by_index(name: &str) -> String {
    match split(name) {
        Some((original, inside)) => format!("{original}[{}]", inside.replacen('*', "i", 1)),
        None => format!("{name}[i]"),
    }
}

/// Returns true if a force or a joint has to be copied: it has a `repeat` (even one in the wrong table), or it names bodies or joints by
/// the index `i`.
fn is_many(entry: &Entry, spec: &'static TableSpec) -> bool {
    let Some(table) = entry.node.as_table() else { return false };
    let mut ends = Vec::new();
    ends_of_i(table, spec, &mut ends);
    table.get("repeat").is_some() || misplaced_repeat(table, spec).is_some() || !ends.is_empty()
}

/// Finds a misplaced `repeat` in an inner table of the force or joint, such as `[joint.NAME.rope]`, which has no such key. The validation
/// reports the mistake. Copies are made as if the `repeat` were in the right place, so that formulas with the index `i` cause no further
/// errors.
fn misplaced_repeat<'t>(table: &'t Table, spec: &'static TableSpec) -> Option<&'t Entry> {
    table.entries.iter().find_map(|entry| match &spec.key(&entry.name.text)?.kind {
        Kind::Table(inner) if inner.key("repeat").is_none() => entry.node.as_table()?.get("repeat"),
        _ => None,
    })
}

/// Returns true if the entry is a gear, a joint that couples two other joints.
fn is_gear(entry: &Entry) -> bool {
    entry.node.as_table().is_some_and(|table| table.get("gear").is_some())
}

/// Finds all names of bodies and joints in a table that depend on the index `i`, such as `bob[i]`. Appends them to `found`.
fn ends_of_i<'t>(table: &'t Table, spec: &'static TableSpec, found: &mut Vec<(&'t Node, Collection)>) {
    fn look<'t>(node: &'t Node, kind: &'static Kind, found: &mut Vec<(&'t Node, Collection)>) {
        match (kind, &node.value) {
            (Kind::Reference(of), Value::String(name))
                if index::is_formula(name) && index::of_i(name).is_some() =>
            {
                found.push((node, *of));
            }
            (Kind::List { of, .. }, Value::Array(items)) => {
                items.iter().for_each(|item| look(item, of, found));
            }
            (Kind::Table(spec), Value::Table(table)) => ends_of_i(table, spec, found),
            (Kind::Either(kinds), value) => {
                kinds.iter().filter(|kind| kind.takes(value)).for_each(|kind| look(node, kind, found));
            }
            _ => {}
        }
    }
    for entry in &table.entries {
        if let Some(key) = spec.key(&entry.name.text) {
            look(&entry.node, &key.kind, found);
        }
    }
}

/// Returns the number of copies that `repeat` gives. `None` if the value is no valid number, which the validation reports.
fn count_of(repeat: &Node) -> Option<usize> {
    match repeat.value {
        Value::Integer(count @ 1..=MAX_COPIES) => usize::try_from(count).ok(),
        _ => None,
    }
}
