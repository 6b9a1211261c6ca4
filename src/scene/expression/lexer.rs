//! Splits the text of a formula into tokens.

use crate::diagnostic::Code;
use std::ops::Range;

use super::corrections;
use super::error::{ExpressionError, syntax};

/// A token of a formula: a number, a name, an operator or a separator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64),
    /// A name. Its text is found by the token's range.
    Name,
    Or,
    And,
    Not,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    Plus,
    Minus,
    Star,
    Slash,
    Percent,
    Caret,
    Open,
    Close,
    Comma,
    /// The end of the formula's text.
    End,
}

/// Splits the text of a formula into tokens, one at a time.
pub(super) struct Lexer<'a> {
    text: &'a str,
    place: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Lexer<'a> {
        Lexer { text, place: 0 }
    }

    /// Reads the next token. Returns the token and its byte range in the text.
    pub(super) fn next(&mut self) -> Result<(Token, Range<usize>), ExpressionError> {
        let rest = &self.text[self.place..];
        let rest = rest.trim_start();
        let start = self.text.len() - rest.len();
        let mut next = rest.bytes();
        let (first, second) = (next.next(), next.next());
        let (token, length) = match (first, second) {
            (None, _) => (Token::End, 0),
            (Some(b'0'..=b'9'), _) | (Some(b'.'), Some(b'0'..=b'9')) => number(rest, start)?,
            (Some(b'a'..=b'z' | b'A'..=b'Z' | b'_'), _) => name(rest),
            (Some(b'*'), Some(b'*')) => return Err(corrections::symbol(rest, start)),
            (Some(b'<'), Some(b'=')) => (Token::LessEqual, 2),
            (Some(b'>'), Some(b'=')) => (Token::GreaterEqual, 2),
            (Some(b'='), Some(b'=')) => (Token::Equal, 2),
            (Some(b'!'), Some(b'=')) => (Token::NotEqual, 2),
            (Some(b'<'), Some(b'>')) => return Err(corrections::symbol(rest, start)),
            (Some(b'<'), _) => (Token::Less, 1),
            (Some(b'>'), _) => (Token::Greater, 1),
            (Some(b'+'), _) => (Token::Plus, 1),
            (Some(b'-'), _) => (Token::Minus, 1),
            (Some(b'*'), _) => (Token::Star, 1),
            (Some(b'/'), _) => (Token::Slash, 1),
            (Some(b'%'), _) => (Token::Percent, 1),
            (Some(b'^'), _) => (Token::Caret, 1),
            (Some(b'('), _) => (Token::Open, 1),
            (Some(b')'), _) => (Token::Close, 1),
            (Some(b','), _) => (Token::Comma, 1),
            _ if rest.starts_with('°') => return Err(corrections::degrees(self.text, start)),
            _ => return Err(corrections::symbol(rest, start)),
        };
        self.place = start + length;
        Ok((token, start..self.place))
    }
}

fn name(rest: &str) -> (Token, usize) {
    let length = rest.bytes().take_while(|&byte| byte.is_ascii_alphanumeric() || byte == b'_').count();
    let token = match &rest[..length] {
        "or" => Token::Or,
        "and" => Token::And,
        "not" => Token::Not,
        _ => Token::Name,
    };
    (token, length)
}

/// Reads the number at the beginning of `rest`, such as `1`, `1.5`, `.5`, `1e-3` or `1_000`. Returns the token and its length in bytes.
fn number(rest: &str, start: usize) -> Result<(Token, usize), ExpressionError> {
    let bytes = rest.as_bytes();
    let digits = |from: usize| {
        let is_part = |&&byte: &&u8| byte.is_ascii_digit() || byte == b'_';
        bytes[from..].iter().take_while(is_part).count()
    };
    let mut length = digits(0);
    if bytes.get(length) == Some(&b'.') {
        length += 1;
        length += digits(length);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        // In `2e`, the `e` may be the constant e: the number is 2, and the parser reports that an operator is missing.
        if bytes.get(length + 1 + sign).is_some_and(u8::is_ascii_digit) {
            length += 1 + sign;
            length += digits(length);
        }
    }
    let text = &rest[..length];
    let range = start..start + length;
    if bytes.get(length) == Some(&b'.') {
        return Err(syntax(start..start + length + 1, "a number has one decimal point"));
    }
    let lonely = |at: usize| {
        let is_digit =
            |at: Option<usize>| at.and_then(|at| text.as_bytes().get(at)).is_some_and(u8::is_ascii_digit);
        !is_digit(at.checked_sub(1)) || !is_digit(Some(at + 1))
    };
    if text.match_indices('_').any(|(at, _)| lonely(at)) {
        return Err(syntax(range, "an underscore in a number stands between two digits"));
    }
    let parsed = if text.contains('_') { text.replace('_', "").parse::<f64>() } else { text.parse::<f64>() };
    match parsed {
        Ok(number) if number.is_finite() => Ok((Token::Number(number), length)),
        Ok(_) => Err(super::error::error(Code::NumberTooLarge, range, "this number is too large")
            .help("the largest number is about 1.8e308")),
        Err(_) => Err(syntax(range, format!("`{text}` is not a number"))),
    }
}
