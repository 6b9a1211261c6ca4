//! Converts byte ranges within a formula to spans in the text of the scene.

use std::ops::Range;

use crate::diagnostic::Span;

/// Returns the span, in the text of the scene, of a byte range within a string. `raw` is the string as written, with its quotes, and
/// `text` is its value.
///
/// If the string has escapes, the offsets in `raw` and `text` differ, and the result is `whole`, the span of the entire string.
pub(crate) fn in_string(raw: &str, text: &str, range: &Range<usize>, whole: Span) -> Span {
    match offset(raw, text) {
        Some(offset) if !range.is_empty() => whole.part(offset + range.start..offset + range.end),
        _ => whole,
    }
}

/// Returns the offset of the string's value within the written text, in bytes. `None` if the string has escapes.
fn offset(raw: &str, text: &str) -> Option<usize> {
    // An argument of `--set` needs no quotes. TOML drops a line break directly after triple quotes.
    ["", "\"", "'", "\"\"\"\r\n", "'''\r\n", "\"\"\"\n", "'''\n", "\"\"\"", "'''"].into_iter().find_map(
        |open| {
            let close = open.trim_end();
            let inner = raw.strip_prefix(open)?.strip_suffix(close)?;
            (inner == text).then_some(open.len())
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_string_as_it_is_begins_behind_its_quotes() {
        for (raw, text, expected) in [
            ("\"1 + x\"", "1 + x", Some(1)),
            ("'1 + x'", "1 + x", Some(1)),
            ("1 + x", "1 + x", Some(0)),
            ("\"\"\"1 + x\"\"\"", "1 + x", Some(3)),
            ("'''\n1 +\n x'''", "1 +\n x", Some(4)),
            ("\"\"\"\r\n1 + x\"\"\"", "1 + x", Some(5)),
            ("\"1\\t+ x\"", "1\t+ x", None),
            ("\"\\u0031\"", "1", None),
            ("\"\"", "", Some(1)),
            ("\"", "", None),
        ] {
            assert_eq!(offset(raw, text), expected, "{raw}");
        }
    }
}
