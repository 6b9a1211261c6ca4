//! Words of a scene as words of a script: nothing that a name or a title says can become code.

use std::collections::HashSet;

/// A text as it can stand in a `//` comment: in one line, without control characters.
pub(crate) fn comment(text: &str) -> String {
    escaped(text, |c| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'))
}

/// A text as it can stand between the quotes of a string.
pub(crate) fn string(text: &str) -> String {
    // POV-Ray's strings hold about 255 bytes.
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

/// Identifiers for names, each once.
#[derive(Default)]
pub(crate) struct Identifiers(HashSet<String>);

impl Identifiers {
    /// A new identifier like `Prefix_name`: letters, digits and underscores, never one of POV-Ray's words, since
    /// those are lowercase.
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
