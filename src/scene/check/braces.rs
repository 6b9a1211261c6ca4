//! Raw SDL whose braces do not match: POV-Ray would complain far from the cause, in the text around it.

use crate::diagnostic::{Diagnostic, Span};

/// The error of a text whose braces do not match, if they do not.
pub(super) fn unbalanced(text: &str, span: Span) -> Option<Diagnostic> {
    let message = match depth(text) {
        Err(()) => "the SDL closes a brace that it has not opened".to_owned(),
        Ok(0) => return None,
        Ok(1) => "the SDL opens a brace that it does not close".to_owned(),
        Ok(open) => format!("the SDL opens {open} braces that it does not close"),
    };
    Some(Diagnostic::error("unbalanced-sdl", message).at(span, ""))
}

/// How many braces are open at the end; an error where one is closed too many. Strings and comments do not count;
/// block comments nest, as POV-Ray's do.
fn depth(text: &str) -> Result<usize, ()> {
    let (mut open, mut comments) = (0usize, 0usize);
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let after = &rest[c.len_utf8()..];
        rest = after;
        if rest_starts(c, after, "/*") {
            comments += 1;
            rest = &after[1..];
        } else if comments > 0 {
            if rest_starts(c, after, "*/") {
                comments -= 1;
                rest = &after[1..];
            }
        } else if rest_starts(c, after, "//") {
            rest = after.find(['\n', '\r']).map_or("", |end| &after[end..]);
        } else if c == '"' {
            rest = after_string(after);
        } else if c == '{' {
            open += 1;
        } else if c == '}' {
            open = open.checked_sub(1).ok_or(())?;
        }
    }
    Ok(open)
}

/// Whether a character and what follows it begin with these two.
fn rest_starts(c: char, after: &str, two: &str) -> bool {
    two.starts_with(c) && after.starts_with(&two[1..])
}

/// What follows a string that has just begun.
fn after_string(mut text: &str) -> &str {
    loop {
        match text.find(['"', '\\']) {
            None => return "",
            Some(at) if text[at..].starts_with('"') => return &text[at + 1..],
            // A backslash and what it escapes.
            Some(at) => {
                let escaped = text[at + 1..].chars().next().map_or(0, char::len_utf8);
                text = &text[at + 1 + escaped..];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braces_in_strings_and_comments_do_not_count() {
        for text in
            ["", "a { b { } }", "\"{\" {}", "\"\\\"{\"", "// {\n{}", "/* { /* { */ } */ {}", "é { } // }"]
        {
            assert_eq!(depth(text), Ok(0), "{text}");
        }
        assert_eq!(depth("a { b {"), Ok(2));
        assert_eq!(depth("} {"), Err(()));
    }
}
