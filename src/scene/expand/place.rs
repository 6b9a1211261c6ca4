//! Places in a formula → places in the text of the scene.

use std::ops::Range;

use crate::diagnostic::Span;

/// The place of a part of a string. `raw` is what is written there, with its quotes, and `text` the string.
///
/// The place of a range of a string. If the string has escapes, its bytes are not those of the text, and the place is the whole
/// string.
pub(crate) fn in_string(raw: &str, text: &str, range: &Range<usize>, whole: Span) -> Span {
    match offset(raw, text) {
        Some(offset) if !range.is_empty() => {
            let start = whole.start + offset;
            Span { start: start + range.start, end: start + range.end, ..whole }
        }
        _ => whole,
    }
}

/// The start of the string within the written text, if the text holds it literally.
fn offset(raw: &str, text: &str) -> Option<usize> {
    // An argument of `--set` needs no quotes; a string of several lines may begin on the next one.
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
