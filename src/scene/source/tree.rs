//! The tree of values into which the text of a scene is parsed.

use std::borrow::Cow;
use std::sync::Arc;

use super::{CopiedTable, Shared};
use crate::diagnostic::Span;
use crate::scene::force_formula::BodyFormula;
use crate::scene::sampled_number::SampledFormula;
use crate::scene::timed::TimeFormula;

/// A value with its position in the text.
#[derive(Clone, Debug)]
pub struct Node {
    /// The byte range of the value in the text.
    pub span: Span,
    /// The parsed value.
    pub value: Value,
}

/// A TOML value, or a parsed formula that has replaced a string.
#[derive(Clone, Debug)]
pub enum Value {
    /// A string. Where the grammar expects a number, the string is a formula that has not been parsed yet.
    String(Arc<str>),
    /// A whole number that fits into 64 bits.
    Integer(i64),
    /// A floating-point number, which may be infinite or NaN.
    Float(f64),
    /// A parsed formula of the time `t`. It replaces a string.
    Formula(Arc<TimeFormula>),
    /// A parsed formula that each particle evaluates with its own random numbers. It replaces a string.
    Sampled(Arc<SampledFormula>),
    /// A parsed formula of quantities of a body, such as its velocity. It replaces a string.
    OfBody(Arc<BodyFormula>),
    /// A Boolean value, `true` or `false`.
    Boolean(bool),
    /// A date or a time. No key of a scene accepts this type.
    Datetime,
    /// A list of values.
    Array(Shared<Node>),
    /// A table of named values.
    Table(Table),
    /// A table that is stored as its differences from a template. [`Node::table`] rebuilds it.
    Copied(CopiedTable),
    /// A value with an error that has been reported.
    Invalid,
}

/// A table whose entries are in the order of the file. Clones share the memory of the entries.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The entries of the table. Their names are unique.
    pub entries: Shared<Entry>,
}

/// An entry of a table: a key with its value.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key of the entry, with its position in the text.
    pub name: Name,
    /// The value of the entry, with its position in the text.
    pub node: Node,
}

/// A key with its position in the text.
#[derive(Clone, Debug)]
pub struct Name {
    /// The byte range of the key in the text.
    pub span: Span,
    /// The text of the key, without quotes.
    pub text: Arc<str>,
}

impl Table {
    /// Returns the entry with this name. `None` if the table has no such entry.
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| &*entry.name.text == name)
    }

    /// Returns mutable access to the entry with this name. `None` if the table has no such entry.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut Entry> {
        let place = self.entries.iter().position(|entry| &*entry.name.text == name)?;
        self.entries.get_mut(place)
    }
}

impl Node {
    /// Returns the value as a table. `None` for other values, including [`Value::Copied`].
    pub fn as_table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// Returns the value as a table, rebuilt from a template for [`Value::Copied`]. `None` for other values.
    pub fn table(&self) -> Option<Cow<'_, Table>> {
        match &self.value {
            Value::Table(table) => Some(Cow::Borrowed(table)),
            Value::Copied(copied) => Some(Cow::Owned(copied.table())),
            _ => None,
        }
    }

    /// Returns the value if it is a string, otherwise `None`.
    pub fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// Returns the value if it is a string, otherwise `None`. The clone shares its memory with the original.
    pub(in crate::scene) fn as_shared_text(&self) -> Option<Arc<str>> {
        match &self.value {
            Value::String(text) => Some(text.clone()),
            _ => None,
        }
    }

    /// Returns the value if it is `true` or `false`, otherwise `None`.
    pub(in crate::scene) fn as_boolean(&self) -> Option<bool> {
        match self.value {
            Value::Boolean(value) => Some(value),
            _ => None,
        }
    }

    /// Returns the value if it is an integer or a float, otherwise `None`.
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

    /// Describes the type of the value in words, such as "a string".
    pub fn in_words(&self) -> &'static str {
        match &self.value {
            Value::String(_) => "a string",
            Value::Integer(_) | Value::Float(_) => "a number",
            Value::Formula(_) | Value::Sampled(_) | Value::OfBody(_) => "a formula",
            Value::Boolean(_) => "a boolean",
            Value::Datetime => "a date or time",
            Value::Array(_) => "a list",
            Value::Table(_) | Value::Copied(_) => "a table",
            Value::Invalid => "something unreadable",
        }
    }
}
