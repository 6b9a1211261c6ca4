//! Finds the values that the expansion leaves unchanged.

use super::index;
use crate::scene::grammar::{Collection, Kind, TableSpec};
use crate::scene::source::{Entry, Node, Table, Value};

/// Returns true if a table contains formulas or names of several bodies, which the expansion has to replace.
pub(super) fn has_work(table: &Table, spec: &TableSpec) -> bool {
    let is_open =
        |entry: &Entry| spec.key(&entry.name.text).is_some_and(|key| !is_settled(&entry.node, &key.kind));
    table.entries.iter().any(is_open)
}

pub(super) fn is_list(node: &Node) -> bool {
    matches!(node.value, Value::Array(_))
}

/// Returns true if a value contains neither formulas nor names of several bodies. All copies of a body share one instance of such a value.
pub(super) fn is_settled(node: &Node, kind: &Kind) -> bool {
    let is_number = |item: &Node| !matches!(item.value, Value::String(_) | Value::Invalid);
    match (kind, &node.value) {
        (
            Kind::Number(_)
            | Kind::Timed(_)
            | Kind::Varying(_)
            | Kind::Sampled(_)
            | Kind::OfBody(_)
            | Kind::Integer(..),
            Value::String(_),
        ) => false,
        (Kind::Reference(_), Value::String(text)) => !index::is_formula(text),
        (
            Kind::TimedNumbers(..)
            | Kind::VaryingNumbers(..)
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
