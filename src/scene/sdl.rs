//! POV-Ray's language, as far as its files can be told from its text.

/// A file that a script includes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Include {
    /// The file of this name, as it stands between the quotes.
    Literal(String),
    /// One whose name only POV-Ray knows, once it has computed it: `#include concat("wall_", str(N, 0, 0), ".inc")`.
    Computed,
}

/// What a script includes, in the order of its text: every `#include` outside of comments and strings, also one that
/// POV-Ray would not come to.
pub fn includes(text: &str) -> Vec<Include> {
    let mut found = Vec::new();
    let mut pieces = Pieces::of(text).peekable();
    while let Some(piece) = pieces.next() {
        if !matches!(piece, Piece::Character('#')) {
            continue;
        }
        while pieces.next_if(Piece::is_blank).is_some() {}
        let mut word = String::new();
        while let Some(Piece::Character(c)) = pieces.next_if(Piece::is_of_a_word) {
            word.push(c);
        }
        if word != "include" {
            continue;
        }
        while pieces.next_if(Piece::is_blank).is_some() {}
        found.push(match pieces.peek() {
            // What a backslash means in the name of a file differs between systems.
            Some(Piece::String(name)) if !name.contains('\\') => Include::Literal((*name).to_owned()),
            _ => Include::Computed,
        });
    }
    found
}

/// A piece of a text of POV-Ray's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Piece<'a> {
    /// A character outside of strings and comments; a comment is a blank, which is what it is to POV-Ray.
    Character(char),
    /// A string, without its quotes, as it is written.
    String(&'a str),
}

impl Piece<'_> {
    fn is_blank(&self) -> bool {
        matches!(self, Piece::Character(c) if c.is_whitespace() || c.is_control())
    }

    fn is_of_a_word(&self) -> bool {
        matches!(self, Piece::Character(c) if c.is_ascii_alphanumeric() || *c == '_')
    }
}

/// The pieces of a text, one after another.
pub(crate) struct Pieces<'a> {
    rest: &'a str,
}

impl<'a> Pieces<'a> {
    pub(crate) fn of(text: &'a str) -> Pieces<'a> {
        Pieces { rest: text }
    }
}

impl<'a> Iterator for Pieces<'a> {
    type Item = Piece<'a>;

    fn next(&mut self) -> Option<Piece<'a>> {
        if let Some(comment) = self.rest.strip_prefix("//") {
            self.rest = comment.find(['\n', '\r']).map_or("", |end| &comment[end..]);
            return Some(Piece::Character(' '));
        }
        if let Some(comment) = self.rest.strip_prefix("/*") {
            self.rest = after_comment(comment);
            return Some(Piece::Character(' '));
        }
        if let Some(text) = self.rest.strip_prefix('"') {
            let length = length_of_string(text);
            self.rest = text.get(length + 1..).unwrap_or_default();
            return Some(Piece::String(&text[..length]));
        }
        let c = self.rest.chars().next()?;
        self.rest = &self.rest[c.len_utf8()..];
        Some(Piece::Character(c))
    }
}

/// What follows a block comment that has just begun; POV-Ray's nest.
pub(crate) fn after_comment(mut text: &str) -> &str {
    let mut depth = 1;
    while depth > 0 {
        let (open, close) = (text.find("/*"), text.find("*/"));
        let at = match (open, close) {
            (Some(open), Some(close)) if open < close => {
                depth += 1;
                open
            }
            (_, Some(close)) => {
                depth -= 1;
                close
            }
            (_, None) => return "",
        };
        text = &text[at + 2..];
    }
    text
}

/// The length of a string that has just begun, up to its closing quote or the end of the text.
fn length_of_string(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices() {
        if c == '"' && !escaped {
            return at;
        }
        escaped = c == '\\' && !escaped;
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn literal(name: &str) -> Include {
        Include::Literal(name.to_owned())
    }

    #[test]
    fn every_include_is_found() {
        for text in [
            "#include \"a.inc\"",
            "sphere { 0, 1 }#include\"a.inc\"",
            "#  include // a comment\n \"a.inc\"",
            "#/* a /* b */ c */include/**/\"a.inc\" // #include \"b.inc\"",
            "/* #include \"b.inc\" */ #include \"a.inc\"",
            "#declare Text = \"#include \\\"b.inc\\\"\"; #include \"a.inc\"",
            "#if (0)\r#include \"a.inc\"\r#end",
            "#\u{1}include \"a.inc\"",
        ] {
            assert_eq!(includes(text), [literal("a.inc")], "{text:?}");
        }
        let several = "#include \"é.inc\" #include concat(\"a\", \".inc\") #include \"b/c.inc\"";
        assert_eq!(includes(several), [literal("é.inc"), Include::Computed, literal("b/c.inc")]);
    }

    #[test]
    fn a_name_that_is_no_plain_string_is_computed() {
        for text in ["#include Name", "#include", "#include concat(\"a\")", "#include \"a\\\\b.inc\""] {
            assert_eq!(includes(text), [Include::Computed], "{text:?}");
        }
    }

    #[test]
    fn other_words_are_no_includes() {
        for text in
            ["", "include \"a.inc\"", "#included \"a.inc\"", "#", "\"#include", "/* #include", "# 1 include"]
        {
            assert_eq!(includes(text), [], "{text:?}");
        }
    }
}
