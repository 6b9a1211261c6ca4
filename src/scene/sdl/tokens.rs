//! Splits SDL into the tokens of POV-Ray 3.7.
//!
//! The rules are those of POV-Ray's own tokenizer, even where these are surprising: comments nest, a number ends at the first character
//! that cannot continue it (`1einclude` is the number `1e` and the word `include`), and a backslash in a string escapes any character.

use std::ops::Range;

/// A token of SDL, POV-Ray's scene description language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Token<'a> {
    /// A reserved word or an identifier.
    Word(&'a str),
    /// A number. A sign before it is a token of its own.
    Number,
    /// The content of a string as written, without the quotes.
    Text(&'a str),
    /// Any other single character.
    Symbol(char),
}

/// A comment or string that is not closed at the end of the text. The value is the byte range of its opening mark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unclosed {
    /// A comment that begins with `/*` at this range.
    Comment(Range<usize>),
    /// A string that begins with `"` at this range.
    Text(Range<usize>),
}

/// Iterates over the tokens of a text, each with its byte range.
#[derive(Clone, Debug)]
pub struct Tokens<'a> {
    text: &'a str,
    at: usize,
    unclosed: Option<Unclosed>,
}

impl<'a> Tokens<'a> {
    /// Makes an iterator over the tokens of a text.
    pub fn of(text: &'a str) -> Tokens<'a> {
        Tokens { text, at: 0, unclosed: None }
    }

    /// Returns the comment or string that is not closed at the end of the text, if any. Known only after all tokens have been read.
    pub fn unclosed(&self) -> Option<&Unclosed> {
        self.unclosed.as_ref()
    }

    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Skips white space, control characters and comments before the next token.
    fn skip_blanks(&mut self) {
        loop {
            let rest = self.rest();
            let trimmed = rest.trim_start_matches(|c: char| c.is_ascii_whitespace() || c.is_ascii_control());
            self.at += rest.len() - trimmed.len();
            if let Some(comment) = trimmed.strip_prefix("//") {
                self.at += 2 + comment.find(['\n', '\r']).unwrap_or(comment.len());
            } else if let Some(comment) = trimmed.strip_prefix("/*") {
                let start = self.at;
                self.at += 2 + length_of_comment(comment).unwrap_or_else(|| {
                    self.unclosed = Some(Unclosed::Comment(start..start + 2));
                    comment.len()
                });
            } else {
                return;
            }
        }
    }
}

impl<'a> Iterator for Tokens<'a> {
    type Item = (Token<'a>, Range<usize>);

    fn next(&mut self) -> Option<(Token<'a>, Range<usize>)> {
        self.skip_blanks();
        let (rest, start) = (self.rest(), self.at);
        let first = rest.chars().next()?;
        let (token, length) = match first {
            '"' => match length_of_text(&rest[1..]) {
                Some(length) => (Token::Text(&rest[1..=length]), length + 2),
                None => {
                    self.unclosed = Some(Unclosed::Text(start..start + 1));
                    self.at = self.text.len();
                    return None;
                }
            },
            'a'..='z' | 'A'..='Z' | '_' => {
                let is_of_a_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
                let length = rest.find(|c: char| !is_of_a_word(c)).unwrap_or(rest.len());
                (Token::Word(&rest[..length]), length)
            }
            _ => match length_of_number(rest.as_bytes()) {
                0 => (Token::Symbol(first), first.len_utf8()),
                length => (Token::Number, length),
            },
        };
        self.at += length;
        Some((token, start..start + length))
    }
}

/// Returns the length, in bytes, of a comment from after its `/*` to the end of its `*/`. `None` if the comment is not closed.
fn length_of_comment(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (1usize, 0);
    while depth > 0 {
        match bytes.get(at..at + 2)? {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
    }
    Some(at)
}

/// Returns the length, in bytes, of a string's content between its quotes. `text` begins after the opening quote. `None` if the string is
/// not closed.
fn length_of_text(text: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return Some(at),
            _ => {}
        }
    }
    None
}

/// Returns the length, in bytes, of the number at the beginning of a text. 0 if the text does not begin with a number.
fn length_of_number(text: &[u8]) -> usize {
    let digits = |from: usize| text[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut length = digits(0);
    if text.get(length) == Some(&b'.') && (length > 0 || digits(1) > 0) {
        length += 1;
        length += digits(length);
    }
    if length > 0 && matches!(text.get(length), Some(b'e' | b'E')) {
        length += 1;
        if matches!(text.get(length), Some(b'+' | b'-' | b'0'..=b'9')) {
            length += 1;
            length += digits(length);
        }
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<Token<'_>> {
        Tokens::of(text).map(|(token, _)| token).collect()
    }

    #[test]
    fn a_text_is_cut_as_povray_cuts_it() {
        use Token::{Number, Symbol, Text, Word};
        for (text, expected) in [
            ("", vec![]),
            ("sphere{<0,.5,1e-3>", {
                let mut all = vec![Word("sphere"), Symbol('{'), Symbol('<'), Number, Symbol(',')];
                all.extend([Number, Symbol(','), Number, Symbol('>')]);
                all
            }),
            ("1einclude", vec![Number, Word("include")]),
            ("1.5E+include", vec![Number, Word("include")]),
            ("2x.y", vec![Number, Word("x"), Symbol('.'), Word("y")]),
            ("a /* b /* c */ d */ e", vec![Word("a"), Word("e")]),
            ("/*/ a */ b", vec![Word("b")]),
            ("/* a **/ b", vec![Word("b")]),
            ("a // b\nc // d\re", vec![Word("a"), Word("c"), Word("e")]),
            (r#""a\"b" c "d\\" e"#, vec![Text(r#"a\"b"#), Word("c"), Text(r"d\\"), Word("e")]),
            ("\"// a /*\" b", vec![Text("// a /*"), Word("b")]),
            ("inc\u{1}lude é_1", vec![Word("inc"), Word("lude"), Symbol('é'), Word("_1")]),
            ("#\t/* */\nif", vec![Symbol('#'), Word("if")]),
        ] {
            assert_eq!(tokens(text), expected, "{text:?}");
        }
    }

    #[test]
    fn what_is_not_closed_is_told() {
        let unclosed = |text: &str| {
            let mut tokens = Tokens::of(text);
            while tokens.next().is_some() {}
            tokens.unclosed().cloned()
        };
        assert_eq!(unclosed("a /* b /* */"), Some(Unclosed::Comment(2..4)));
        assert_eq!(unclosed("a /*/"), Some(Unclosed::Comment(2..4)));
        assert_eq!(unclosed(r#"a "b\""#), Some(Unclosed::Text(2..3)));
        for whole in ["", "a // \"", "/* \" */ a", "\"/*\"", "*/"] {
            assert_eq!(unclosed(whole), None, "{whole:?}");
        }
    }

    proptest::proptest! {
        #[test]
        fn every_text_is_cut_on_the_bounds_of_its_characters(text in r#"([ -~é\n\r\x00]|"|/\*|\*/|//|\\|[0-9.e+]){0,60}"#) {
            let mut end = 0;
            for (token, range) in Tokens::of(&text) {
                assert!(range.start >= end && range.end > range.start, "{text:?} at {range:?}");
                end = range.end;
                let written = text.get(range.clone()).unwrap_or_else(|| panic!("{text:?} at {range:?}"));
                if let Token::Word(word) = token {
                    assert_eq!(word, written);
                }
            }
        }
    }
}
