//! Defaults of missing keys.

use serde_json::{Value, json};

/// The default of a missing key: a value, or a description.
#[derive(Clone, Copy, Debug)]
pub enum DefaultValue {
    /// No default: the key is required, or a table that may be empty.
    Nothing,
    /// A number.
    Number(f64),
    /// A number, shown as a fraction.
    Fraction(f64, f64),
    /// A list of numbers.
    Numbers(&'static [f64]),
    /// `true` or `false`.
    Flag(bool),
    /// One of the words that the key takes.
    Word(&'static str),
    /// A description of how it is determined.
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

    /// The default as N numbers.
    pub(in crate::scene) fn numbers<const N: usize>(self) -> Option<[f64; N]> {
        self.list()?.try_into().ok()
    }

    /// A list of whole numbers of any length.
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

    /// As shown in the reference; empty if there is no default.
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

    /// As a JSON value, if it is a value.
    pub fn to_json(self) -> Option<Value> {
        match self {
            DefaultValue::Nothing | DefaultValue::Words(_) => None,
            DefaultValue::Word(word) => Some(word.into()),
            DefaultValue::Fraction(dividend, divisor) => Some(json!(dividend / divisor)),
            // Written this way, a whole number has no decimal point.
            written => serde_json::from_str(&written.in_words()).ok(),
        }
    }
}

/// The shortest decimal that reads back as the same number.
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
