//! Escapes texts of a scene for scripts, so that no name or title can become code.

use std::collections::HashSet;

/// Escapes a text for a `//` comment: the result is one line without control characters.
pub(crate) fn comment(text: &str) -> String {
    escaped(text, |c| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'))
}

/// Escapes a text for an SDL string literal. The result has no quotes around it.
pub(crate) fn string(text: &str) -> String {
    // POV-Ray limits strings to about 255 bytes, so longer texts are cut off.
    const MOST_BYTES: usize = 250;
    let mut out = String::new();
    for c in text.chars() {
        let next = match c {
            '"' | '\\' => format!("\\{c}"),
            c if c.is_control() => " ".to_owned(),
            c => c.to_string(),
        };
        if out.len() + next.len() > MOST_BYTES {
            break;
        }
        out.push_str(&next);
    }
    out
}

fn escaped(text: &str, special: impl Fn(char) -> bool) -> String {
    let escape = |c: char| if special(c) { c.escape_default().collect() } else { c.to_string() };
    text.chars().map(escape).collect()
}

/// The set of SDL identifiers in use, which keeps new identifiers unique.
#[derive(Default)]
pub(crate) struct Identifiers(HashSet<String>);

impl Identifiers {
    /// Makes a new identifier like `Prefix_name` from letters, digits and underscores. It is never a keyword of POV-Ray, since keywords
    /// are lowercase.
    pub(crate) fn add(&mut self, prefix: &str, name: &str) -> String {
        const MOST_CHARACTERS: usize = 60;
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let stem: String = name.chars().take(MOST_CHARACTERS).map(plain).collect();
        let stem = format!("{prefix}_{stem}");
        let mut identifier = stem.clone();
        let mut number = 1;
        while !self.0.insert(identifier.clone()) {
            number += 1;
            identifier = format!("{stem}_{number}");
        }
        identifier
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_stays_in_its_line() {
        assert_eq!(comment("*/ #fopen"), "*/ #fopen");
        assert_eq!(comment("a\n#write(F, 1)\r\u{2028}\0é"), "a\\n#write(F, 1)\\r\\u{2028}\\u{0}é");
    }

    #[test]
    fn a_string_does_not_end_early() {
        assert_eq!(string("a\"b\\"), "a\\\"b\\\\");
        assert_eq!(string("line\nbreak"), "line break");
        assert!(string(&"\\".repeat(400)).len() <= 250);
    }

    #[test]
    fn identifiers_are_words_and_differ() {
        let mut identifiers = Identifiers::default();
        assert_eq!(identifiers.add("Material", "brass"), "Material_brass");
        assert_eq!(identifiers.add("Material", "a b"), "Material_a_b");
        assert_eq!(identifiers.add("Material", "a-b"), "Material_a_b_2");
        assert_eq!(identifiers.add("Material", "é}"), "Material___");
        assert!(identifiers.add("Material", &"x".repeat(999)).len() < 255);
    }
}
