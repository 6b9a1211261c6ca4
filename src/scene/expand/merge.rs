//! Fills in the missing keys of a table from another table, such as `[defaults.body]` or an included file.

use std::sync::Arc;

use crate::scene::grammar::{Kind, Rule, TableSpec};
use crate::scene::source::{Entry, Node, Table, Value};

/// Fills in the missing keys of `own` from `base`, a table of the same kind. A key of `base` is dropped if a key of `own` excludes it:
/// `shape.box` in `own` drops `shape.sphere` of `base`.
///
/// Entries of `base` come first, in their order.
pub(super) fn merge(own: &mut Table, base: &Table, spec: &'static TableSpec) {
    let base_entries = base.entries.iter().filter(|entry| !is_replaced(&entry.name.text, own, spec));
    let base_entries: Vec<Entry> = base_entries.cloned().collect();
    let kind = |name: &str| spec.key(name).map(|key| &key.kind);
    merge_entries(own, base_entries, |name, own, base| {
        if let Some(kind) = kind(name) {
            merge_values(own, base, kind);
        }
    });
}

/// Returns true if `own` lacks the key `name`, but has another key that excludes it, such as `shape.box` for `shape.sphere`.
pub(super) fn is_replaced(name: &str, own: &Table, spec: &'static TableSpec) -> bool {
    let groups = match &spec.rule {
        Rule::Any => &[][..],
        Rule::AtMostOne(groups) => *groups,
        Rule::ExactlyOne(names) => std::slice::from_ref(names),
    };
    own.get(name).is_none()
        && groups.iter().any(|group| group.contains(&name) && group.iter().any(|key| own.get(key).is_some()))
}

fn merge_values(own: &mut Node, base: &Node, kind: &'static Kind) {
    let Value::Table(base) = &base.value else { return };
    let Value::Table(own) = &mut own.value else { return };
    match kind {
        Kind::Named(spec) => {
            merge_entries(own, base.entries.to_vec(), |_, own, base| {
                if let (Value::Table(own), Value::Table(base)) = (&mut own.value, &base.value) {
                    merge(own, base, spec);
                }
            });
        }
        Kind::Variables(_) => merge_entries(own, base.entries.to_vec(), |_, _, _| {}),
        Kind::Partial(spec) => merge(own, base, spec),
        kind => {
            if let Some(spec) = kind.table() {
                merge(own, base, spec);
            }
        }
    }
}

/// Puts the entries of `base` before those of `own`. Where both tables have a key, keeps the entry of `own`, and `both` merges the two
/// values.
fn merge_entries(own: &mut Table, base: Vec<Entry>, both: impl Fn(&str, &mut Node, &Node)) {
    let mut numbers: std::collections::HashMap<Arc<str>, usize> =
        own.entries.iter().enumerate().map(|(number, entry)| (entry.name.text.clone(), number)).collect();
    let mut rest: Vec<Option<Entry>> = std::mem::take(&mut own.entries).into_iter().map(Some).collect();
    for entry in base {
        let same = numbers.remove(&entry.name.text).and_then(|number| rest[number].take());
        own.entries.push(match same {
            Some(mut same) => {
                both(&same.name.text, &mut same.node, &entry.node);
                same
            }
            None => entry,
        });
    }
    own.entries.extend(rest.into_iter().flatten());
}
