//! TOML text → tree.

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use super::{Entry, Name, Node, Table, Value};
use crate::diagnostic::{Diagnostic, SourceId, Span};

/// Parses a text as far as it goes: what cannot be read becomes a diagnostic, and the rest a tree.
pub fn parse(text: &str, source: SourceId, diagnostics: &mut Vec<Diagnostic>) -> Node {
    let (document, errors) = DeTable::parse_recoverable(text);
    diagnostics.extend(errors.iter().map(|error| syntax_error(error, text, source)));
    let span = Span::new(source, 0..text.len());
    Node { span, value: Value::Table(Reader { source, diagnostics }.table(document.get_ref())) }
}

/// Parses a text that is one value, as it would stand after `key = `.
pub(super) fn parse_value(text: &str, source: SourceId) -> Result<Node, Error> {
    let value = DeValue::parse(text)?;
    // A number that is too large is refused later, at its place; here it only becomes `Invalid`.
    Ok(Reader { source, diagnostics: &mut Vec::new() }.node(&value))
}

fn syntax_error(error: &Error, text: &str, source: SourceId) -> Diagnostic {
    let range = error.span().unwrap_or(text.len()..text.len());
    let mut message = error.message().to_owned();
    if let Some(first) = message.get_mut(..1) {
        first.make_ascii_lowercase();
    }
    let code = if message.starts_with("duplicate key") { "duplicate-key" } else { "toml-syntax" };
    Diagnostic::error(code, message).at(Span::new(source, range), "")
}

struct Reader<'a> {
    source: SourceId,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl Reader<'_> {
    fn table(&mut self, table: &DeTable<'_>) -> Table {
        let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
            let text: &std::borrow::Cow<'_, str> = key.get_ref();
            let name = Name { span: Span::new(self.source, key.span()), text: text.clone().into_owned() };
            Entry { name, node: self.node(value) }
        };
        Table { entries: table.iter().map(entry).collect() }
    }

    fn node(&mut self, value: &Spanned<DeValue<'_>>) -> Node {
        let span = Span::new(self.source, value.span());
        let value = match value.get_ref() {
            DeValue::String(text) => Value::String(text.clone().into_owned()),
            DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
                Ok(number) => Value::Integer(number),
                Err(_) => self.too_large(span),
            },
            DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
                // `1e999` is a typing error, while `inf` was meant; that one is refused where it is read.
                Ok(number) if number.is_infinite() && !digits.as_str().contains("inf") => {
                    self.too_large(span)
                }
                Ok(number) => Value::Float(number),
                Err(_) => Value::Invalid,
            },
            DeValue::Boolean(value) => Value::Boolean(*value),
            DeValue::Datetime(_) => Value::Datetime,
            DeValue::Array(items) => Value::Array(items.iter().map(|item| self.node(item)).collect()),
            DeValue::Table(table) => Value::Table(self.table(table)),
        };
        Node { span, value }
    }

    fn too_large(&mut self, span: Span) -> Value {
        let message = "this number is too large";
        let help = "the largest whole number is 2^63 - 1, the largest other number about 1.8e308";
        self.diagnostics.push(Diagnostic::error("number-too-large", message).at(span, "").help(help));
        Value::Invalid
    }
}
