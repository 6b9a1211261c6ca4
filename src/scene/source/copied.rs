//! Stores a table as its differences from a template, because the copies of a body differ in few values.

use std::iter::Peekable;
use std::slice::Iter;
use std::sync::Arc;

use super::{Entry, Node, Table, Value};
use crate::scene::timed::TimeFormula;

/// A table that is stored as its differences from a template table.
#[derive(Clone, Debug)]
pub struct CopiedTable {
    template: Arc<Table>,
    /// The values that differ from the template, sorted by `place`.
    changes: Box<[Change]>,
}

/// A value that differs from the template. `place` is the index of the value among all values of the template, in the order of the file.
/// Tables and lists count as values, too.
#[derive(Clone, Debug)]
enum Change {
    Number { place: u32, value: f64 },
    Formula { place: u32, formula: Arc<TimeFormula> },
    Any { place: u32, value: Box<Value> },
}

impl Change {
    fn place(&self) -> u32 {
        match self {
            Change::Number { place, .. } | Change::Formula { place, .. } | Change::Any { place, .. } => {
                *place
            }
        }
    }

    fn value(&self) -> Value {
        match self {
            Change::Number { value, .. } => Value::Float(*value),
            Change::Formula { formula, .. } => Value::Formula(formula.clone()),
            Change::Any { value, .. } => (**value).clone(),
        }
    }
}

impl CopiedTable {
    /// Stores a table as its differences from a template. Returns `None` if the keys or the source spans differ.
    pub fn new(table: &Table, template: &Arc<Table>) -> Option<CopiedTable> {
        let mut changes = Vec::new();
        let is_alike = compare_tables(table, template, &mut 0, &mut changes);
        is_alike.then(|| CopiedTable { template: template.clone(), changes: changes.into() })
    }

    /// Rebuilds the table from the template and the differences.
    pub fn table(&self) -> Table {
        copy_table(&self.template, &mut 0, &mut self.changes.iter().peekable())
    }
}

/// Appends the values that differ from the template to `changes`. Returns true if the tables have the same keys at the same positions in
/// the text. `next` is the index of the next value.
fn compare_tables(table: &Table, template: &Table, next: &mut u32, changes: &mut Vec<Change>) -> bool {
    if table.entries.is_same(&template.entries) {
        *next += values_of(template);
        return true;
    }
    table.entries.len() == template.entries.len()
        && table.entries.iter().zip(&template.entries).all(|(entry, old)| {
            entry.name.text == old.name.text
                && entry.name.span == old.name.span
                && entry.node.span == old.node.span
                && compare(&entry.node.value, &old.node.value, next, changes)
        })
}

fn compare(value: &Value, old: &Value, next: &mut u32, changes: &mut Vec<Change>) -> bool {
    let place = *next;
    *next += 1;
    match (value, old) {
        (Value::Table(table), Value::Table(old)) => return compare_tables(table, old, next, changes),
        (Value::Array(items), Value::Array(old)) if items.is_same(old) => {
            *next += old.iter().map(values).sum::<u32>();
        }
        (Value::Array(items), Value::Array(old))
            if items.len() == old.len() && items.iter().zip(old).all(|(item, old)| item.span == old.span) =>
        {
            return items.iter().zip(old).all(|(item, old)| compare(&item.value, &old.value, next, changes));
        }
        (Value::Float(value), Value::Float(old)) if value.to_bits() == old.to_bits() => {}
        (Value::Integer(value), Value::Integer(old)) if value == old => {}
        (Value::Boolean(value), Value::Boolean(old)) if value == old => {}
        (Value::String(value), Value::String(old)) if value == old => {}
        (Value::Formula(value), Value::Formula(old)) if Arc::ptr_eq(value, old) => {}
        (Value::Invalid, Value::Invalid) | (Value::Datetime, Value::Datetime) => {}
        (value, old) => {
            *next += values_within(old);
            changes.push(match value {
                Value::Float(value) => Change::Number { place, value: *value },
                Value::Formula(formula) => Change::Formula { place, formula: formula.clone() },
                value => Change::Any { place, value: Box::new(value.clone()) },
            });
        }
    }
    true
}

/// Returns the number of values nested within a value, not counting the value itself.
fn values_within(value: &Value) -> u32 {
    match value {
        Value::Table(table) => values_of(table),
        Value::Array(items) => items.iter().map(values).sum(),
        _ => 0,
    }
}

fn values_of(table: &Table) -> u32 {
    table.entries.iter().map(|entry| values(&entry.node)).sum()
}

fn values(node: &Node) -> u32 {
    1 + values_within(&node.value)
}

/// Rebuilds a table from the template and the remaining changes. Inner tables and lists without changes share memory with the template.
/// `next` is the index of the next value.
fn copy_table(template: &Table, next: &mut u32, changes: &mut Peekable<Iter<'_, Change>>) -> Table {
    let end = *next + values_of(template);
    if changes.peek().is_none_or(|change| change.place() >= end) {
        *next = end;
        return template.clone();
    }
    let entry = |entry: &Entry| Entry {
        name: entry.name.clone(),
        node: Node { span: entry.node.span, value: copy(&entry.node.value, next, changes) },
    };
    Table { entries: template.entries.iter().map(entry).collect() }
}

fn copy(template: &Value, next: &mut u32, changes: &mut Peekable<Iter<'_, Change>>) -> Value {
    let place = *next;
    *next += 1;
    if let Some(change) = changes.next_if(|change| change.place() == place) {
        *next += values_within(template);
        return change.value();
    }
    match template {
        Value::Table(table) => Value::Table(copy_table(table, next, changes)),
        Value::Array(items) => {
            let end = *next + items.iter().map(values).sum::<u32>();
            if changes.peek().is_none_or(|change| change.place() >= end) {
                *next = end;
                return Value::Array(items.clone());
            }
            let item = |item: &Node| Node { span: item.span, value: copy(&item.value, next, changes) };
            Value::Array(items.iter().map(item).collect())
        }
        value => value.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;
    use crate::diagnostic::Sources;

    fn table(text: &str) -> Table {
        let mut sources = Sources::default();
        let id = sources.add("scene.toml", text);
        match parse(text, id, &mut Vec::new()).value {
            Value::Table(table) => table,
            other => panic!("{other:?}"),
        }
    }

    /// Formats a table for comparisons, with `Debug`.
    fn shown(table: &Table) -> String {
        format!("{table:?}")
    }

    #[test]
    fn a_copy_is_the_table_that_it_was_made_from() {
        let template = Arc::new(table("a = 1\nb = [1, 2]\nc = { d = 'x', e = [3] }\nf = true\n"));
        for (text, changes) in [
            ("a = 1\nb = [1, 2]\nc = { d = 'x', e = [3] }\nf = true\n", 0),
            ("a = 2\nb = [1, 3]\nc = { d = 'y', e = [4] }\nf = 1.25\n", 5),
            // In this text, single values replace a list and an inner list, and the value after them changes, too.
            ("a = 1\nb = 123456\nc = { d = 'x', e = 333 }\nf = 1.25\n", 3),
        ] {
            let table = table(text);
            let copied = CopiedTable::new(&table, &template).unwrap();
            assert_eq!(copied.changes.len(), changes, "{text}");
            assert_eq!(shown(&copied.table()), shown(&table));
        }
    }

    #[test]
    fn a_table_with_other_keys_or_at_other_places_is_no_copy() {
        let template = Arc::new(table("a = 1\nb = { c = 2 }\n"));
        for text in ["a = 1\n", "a = 1\nb = { d = 2 }\n", "a = 10\nb = { c = 2 }\n", "b = 1\na = { c = 2 }\n"]
        {
            assert!(CopiedTable::new(&table(text), &template).is_none(), "{text}");
        }
    }
}
