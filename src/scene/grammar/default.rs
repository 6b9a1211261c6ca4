//! The default values of keys that a scene leaves out.

use serde_json::{Value, json};

/// The default for a missing key: a value, or a description in words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DefaultValue {
    /// The key has no default: it is required, or its value is a table that may be empty.
    Nothing,
    /// The default is a number.
    Number(f64),
    /// The default is a number that the documentation shows as a fraction: dividend and divisor.
    Fraction(f64, f64),
    /// The default is a list of numbers.
    Numbers(&'static [f64]),
    /// The default is `true` or `false`.
    Flag(bool),
    /// The default is one of the words that the key accepts.
    Word(&'static str),
    /// A description of how the default is determined, such as "among all of `on`".
    Words(&'static str),
}

impl DefaultValue {
    pub(in crate::scene) fn number(self) -> Option<f64> {
        match self {
            DefaultValue::Number(number) => Some(number),
            DefaultValue::Fraction(dividend, divisor) => Some(dividend / divisor),
            _ => None,
        }
    }

    pub(in crate::scene) fn integer(self) -> Option<i64> {
        self.number().and_then(whole)
    }

    /// Returns the default as N numbers. `None` if the default is no list of this length.
    pub(in crate::scene) fn numbers<const N: usize>(self) -> Option<[f64; N]> {
        self.list()?.try_into().ok()
    }

    /// Returns the default as a list of whole numbers, of any length. `None` if the default is no list of whole numbers.
    pub(in crate::scene) fn integers(self) -> Option<Vec<i64>> {
        self.list()?.iter().map(|number| whole(*number)).collect()
    }

    pub(in crate::scene) fn flag(self) -> Option<bool> {
        match self {
            DefaultValue::Flag(flag) => Some(flag),
            _ => None,
        }
    }

    pub(in crate::scene) fn word<'a>(self) -> Option<&'a str> {
        match self {
            DefaultValue::Word(word) => Some(word),
            _ => None,
        }
    }

    fn list(self) -> Option<&'static [f64]> {
        match self {
            DefaultValue::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// Returns the default as the documentation shows it. Empty if the key has no default.
    pub fn in_words(self) -> String {
        match self {
            DefaultValue::Nothing => String::new(),
            DefaultValue::Number(number) => written(number),
            DefaultValue::Fraction(dividend, divisor) => format!("{dividend}/{divisor}"),
            DefaultValue::Numbers(numbers) => {
                format!("[{}]", numbers.iter().map(|number| written(*number)).collect::<Vec<_>>().join(", "))
            }
            DefaultValue::Flag(flag) => flag.to_string(),
            DefaultValue::Word(words) | DefaultValue::Words(words) => words.to_owned(),
        }
    }

    /// Returns the default as a JSON value. `None` if the key has no default, or only a description in words.
    pub fn to_json(self) -> Option<Value> {
        match self {
            DefaultValue::Nothing | DefaultValue::Words(_) => None,
            DefaultValue::Word(word) => Some(word.into()),
            DefaultValue::Fraction(dividend, divisor) => Some(json!(dividend / divisor)),
            // Parsing the text, in place of converting the `f64`, turns a whole number into JSON without a decimal point.
            written => serde_json::from_str(&written.in_words()).ok(),
        }
    }
}

/// Formats a number as the shortest decimal that parses back to the same number. Very large and very small numbers get an exponent.
fn written(number: f64) -> String {
    match number.abs() {
        size if size == 0.0 || (1e-4..1e9).contains(&size) => number.to_string(),
        _ => format!("{number:e}"),
    }
}

fn whole(number: f64) -> Option<i64> {
    #[allow(clippy::cast_possible_truncation, reason = "what is cut off is looked at")]
    let whole = number as i64;
    #[allow(clippy::cast_precision_loss, reason = "what is lost is looked at")]
    let is_whole = whole as f64 == number;
    is_whole.then_some(whole)
}
