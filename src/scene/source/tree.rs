//! The tree of a scene as written.

use std::borrow::Cow;
use std::sync::Arc;

use super::{CopiedTable, Shared};
use crate::diagnostic::Span;
use crate::scene::drawn::DrawnFormula;
use crate::scene::law::BodyFormula;
use crate::scene::timed::TimeFormula;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its place.
    pub span: Span,
    /// Its value.
    pub value: Value,
}

/// A value as TOML knows it.
#[derive(Clone, Debug)]
pub enum Value {
    /// Text; where a number is wanted, a formula.
    String(Arc<str>),
    /// A whole number that 64 bits hold.
    Integer(i64),
    /// Any other number, also one that is not finite.
    Float(f64),
    /// A formula of the time, in place of a string.
    Formula(Arc<TimeFormula>),
    /// A formula with random numbers that are drawn later, in place of a string.
    Drawn(Arc<DrawnFormula>),
    /// A formula of quantities of a body, in place of a string.
    OfBody(Arc<BodyFormula>),
    /// `true` or `false`.
    Boolean(bool),
    /// A date or a time, for which a scene has no use.
    Datetime,
    /// A list.
    Array(Shared<Node>),
    /// A table.
    Table(Table),
    /// A table that is the copy of another: see [`Node::table`].
    Copied(CopiedTable),
    /// An unreadable value, which has been reported already.
    Invalid,
}

/// A table: its entries in the order of the file. Its clones share them.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The entries; names are unique.
    pub entries: Shared<Entry>,
}

/// One entry of a table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Its key.
    pub name: Name,
    /// Its value.
    pub node: Node,
}

/// A key and where it stands.
#[derive(Clone, Debug)]
pub struct Name {
    /// Its place.
    pub span: Span,
    /// The key, without quotes.
    pub text: Arc<str>,
}

impl Table {
    /// The entry with the given name.
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| &*entry.name.text == name)
    }

    /// Like [`Table::get`], to change it.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut Entry> {
        let place = self.entries.iter().position(|entry| &*entry.name.text == name)?;
        self.entries.get_mut(place)
    }
}

impl Node {
    /// The table that the value is, if it is one, and not the copy of another.
    pub fn as_table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The table that the value is, also where it is the copy of another, if it is one.
    pub fn table(&self) -> Option<Cow<'_, Table>> {
        match &self.value {
            Value::Table(table) => Some(Cow::Borrowed(table)),
            Value::Copied(copied) => Some(Cow::Owned(copied.table())),
            _ => None,
        }
    }

    /// The text that the value is, if it is one.
    pub fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// The number that the value is, if it is one.
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
