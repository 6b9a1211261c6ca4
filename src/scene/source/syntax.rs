//! Rewrites the syntax errors of the TOML parser in the style of jabuka's other messages.

use toml::de::Error;

use crate::diagnostic::{Code, Diagnostic, SourceId, Span};

/// The parser's message for a key with too many parts, which has no position. The module `brackets` reports this error with its position.
pub(super) const DEEP_KEY: &str = "recursion limit";

/// Converts an error of the TOML parser to a diagnostic. An unknown message is passed on unchanged.
pub(super) fn diagnose(error: &Error, text: &str, source: SourceId) -> Diagnostic {
    let range = error.span();
    let found = range.clone().and_then(|range| text.get(range)).unwrap_or_default();
    let (what, expected) = error.message().split_once(", expected ").unwrap_or((error.message(), ""));
    let code = if what == "duplicate key" { Code::DuplicateKey } else { Code::TomlSyntax };
    let next = range.clone().and_then(|range| text.get(range.start..)?.chars().next());
    let (message, help) = words(what, expected, found, next);
    let label = match (what, expected) {
        (_, "" | "nothing") => String::new(),
        ("string values must be quoted" | "missing value for key", _) if found.is_empty() => {
            "expected a value".to_owned()
        }
        ("string values must be quoted" | "invalid boolean" | "missing escaped value", _) => String::new(),
        ("unexpected key or value", _) => "expected the end of the line".to_owned(),
        (what, _) if what.ends_with("string") && !is_unclosed(expected) => String::new(),
        (_, expected) => format!("expected {expected}"),
    };
    let diagnostic = Diagnostic::error(code, message);
    let diagnostic = match range {
        Some(range) => diagnostic.at(Span::new(source, range), label),
        None => diagnostic,
    };
    if help.is_empty() { diagnostic } else { diagnostic.help(help) }
}

fn is_unclosed(expected: &str) -> bool {
    matches!(expected, "`\"`" | "`'`" | "'''")
}

/// Returns the message and the advice for a syntax error. `found` is the faulty text, and `next` is the first character at the error.
fn words(what: &str, expected: &str, found: &str, next: Option<char>) -> (String, String) {
    let (message, help): (&str, &str) = match what {
        "string values must be quoted" | "missing value for key" if found.is_empty() => {
            ("a value is missing", "")
        }
        "string values must be quoted" => {
            let help = "text stands in quotes, and a comma between the values of a list";
            return (format!("`{found}` is not a value"), help.to_owned());
        }
        "invalid boolean" => {
            return (format!("`{found}` is not a value"), "there are `true` and `false`".to_owned());
        }
        "duplicate key" => {
            return (format!("`{found}` is given twice"), "leave one of them out, or rename it".to_owned());
        }
        what if what.starts_with("cannot extend value") => {
            return (format!("`{found}` is a value already, so it cannot be a table"), String::new());
        }
        "missing escaped value" => (
            "a string contains an unknown escape",
            "write `\\\\` for a backslash, or put the text in single quotes, where a backslash is itself",
        ),
        what if what.ends_with("string") && is_unclosed(expected) => ("the string is not closed", ""),
        what if what.ends_with("string") => {
            ("a string cannot contain this control character", "write `\\u` and four hexadecimal digits")
        }
        "invalid comment character" => ("a comment cannot contain this control character", ""),
        "unexpected key or value" if next == Some(',') => (
            "a comma where the line should end",
            "a decimal point is a point: `1.5`; a list stands in brackets",
        ),
        "unexpected key or value" => ("something follows where the line should end", ""),
        "extra `=`" => ("one `=` too many", ""),
        "invalid float" | "invalid exponent" => ("this is not a number", ""),
        "unexpected leading zero" => ("a number cannot begin with a zero that does not count", ""),
        "key with no value" => ("a key without a value", ""),
        "unquoted keys cannot be empty" => ("a key is missing", ""),
        "invalid unquoted key" => ("a key cannot contain this character, unless it stands in quotes", ""),
        "unclosed table" | "unclosed array table" => ("the header of a table is not closed", ""),
        "missing table open" | "missing array opening" => {
            ("a bracket is closed that has not been opened", "")
        }
        "missing comma between key-value pairs" => ("a comma is missing between the keys of a table", ""),
        "invalid key-value pair" => {
            ("a line of a scene is a key and its value, or the header of a table", "")
        }
        "missing comma between array elements" => ("a comma is missing between the values of a list", ""),
        "extra comma in array" => ("a value is missing between two commas", ""),
        what if what.starts_with("cannot recurse") => {
            ("lists or tables stand in each other more than 80 deep", "no key of a scene is so deep")
        }
        "invalid mantissa" | "invalid fraction" => {
            ("a digit is missing beside the decimal point", "write `0.5` and `2.0`")
        }
        what => (what, ""),
    };
    (message.to_owned(), help.to_owned())
}
