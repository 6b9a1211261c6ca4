//! The tree of a scene as written.

use std::borrow::Cow;
use std::sync::Arc;

use super::{CopiedTable, Shared};
use crate::diagnostic::Span;
use crate::scene::drawn::DrawnFormula;
use crate::scene::law::BodyFormula;
use crate::scene::timed::TimeFormula;

/// A value and its place in the text.
#[derive(Clone, Debug)]
pub struct Node {
    /// The place of the value in the text.
    pub span: Span,
    /// The value.
    pub value: Value,
}

/// A value in TOML, or a formula in place of a string.
#[derive(Clone, Debug)]
pub enum Value {
    /// Text, or a formula that has not been evaluated.
    String(Arc<str>),
    /// A whole number of at most 64 bits.
    Integer(i64),
    /// Any other number, which may be infinite or not a number.
    Float(f64),
    /// A formula of the time, in place of a string.
    Formula(Arc<TimeFormula>),
    /// A formula with random numbers that are drawn later, in place of a string.
    Drawn(Arc<DrawnFormula>),
    /// A formula of quantities of a body, in place of a string.
    OfBody(Arc<BodyFormula>),
    /// `true` or `false`.
    Boolean(bool),
    /// A date or a time. No key of a scene takes one.
    Datetime,
    /// A list.
    Array(Shared<Node>),
    /// A table.
    Table(Table),
    /// A table that is stored as its differences from a template: see [`Node::table`].
    Copied(CopiedTable),
    /// An unreadable value. The error has been reported.
    Invalid,
}

/// A table: its entries in the order of the file. Clones share the entries.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The entries. Names are unique.
    pub entries: Shared<Entry>,
}

/// An entry of a table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key of the entry.
    pub name: Name,
    /// The value of the entry.
    pub node: Node,
}

/// A key and its place in the text.
#[derive(Clone, Debug)]
pub struct Name {
    /// The place of the key in the text.
    pub span: Span,
    /// The key, without quotes.
    pub text: Arc<str>,
}

impl Table {
    /// The entry with the given name. `None` if there is no such entry.
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| &*entry.name.text == name)
    }

    /// Like [`Table::get`], but mutable.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut Entry> {
        let place = self.entries.iter().position(|entry| &*entry.name.text == name)?;
        self.entries.get_mut(place)
    }
}

impl Node {
    /// The value as a table. `None` for other values and for a [`Value::Copied`].
    pub fn as_table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The value as a table. Rebuilds the table of a [`Value::Copied`]. `None` for other values.
    pub fn table(&self) -> Option<Cow<'_, Table>> {
        match &self.value {
            Value::Table(table) => Some(Cow::Borrowed(table)),
            Value::Copied(copied) => Some(Cow::Owned(copied.table())),
            _ => None,
        }
    }

    /// The value as text. `None` for other values.
    pub fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// The value as a number. `None` for other values.
    #[allow(
        clippy::cast_precision_loss,
        reason = "a scene's whole numbers are small; TOML's own floats round too"
    )]
    pub fn as_number(&self) -> Option<f64> {
        match self.value {
            Value::Integer(number) => Some(number as f64),
            Value::Float(number) => Some(number),
            _ => None,
        }
    }

    /// The type of the value, in words: `a string`.
    pub fn in_words(&self) -> &'static str {
        match &self.value {
            Value::String(_) => "a string",
            Value::Integer(_) | Value::Float(_) => "a number",
            Value::Formula(_) | Value::Drawn(_) | Value::OfBody(_) => "a formula",
            Value::Boolean(_) => "a boolean",
            Value::Datetime => "a date or time",
            Value::Array(_) => "a list",
            Value::Table(_) | Value::Copied(_) => "a table",
            Value::Invalid => "something unreadable",
        }
    }
}
