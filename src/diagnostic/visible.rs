//! Makes texts safe to print in a terminal by escaping invisible characters.
//!
//! File names and words of a scene may contain any character. Control characters can move the cursor or start a line, and characters that
//! set the writing direction can disguise a text as another one.

use std::path::Path;

/// Escapes all invisible characters of a text as in Rust (`\n`, `\u{202e}`), so that the result is one line.
pub fn visible(text: &str) -> String {
    escaped(text, is_invisible)
}

/// Escapes invisible characters as [`visible`] does, but keeps line breaks and tabs.
pub fn visible_lines(text: &str) -> String {
    escaped(text, |c| is_invisible(c) && !matches!(c, '\n' | '\t'))
}

/// Returns the path of a file as one line, with invisible characters escaped.
pub fn visible_path(path: &Path) -> String {
    visible(&path.display().to_string())
}

/// Returns true for a character that controls the terminal, ends a line, sets the writing direction, or has no width.
///
/// Returns false for the joiners U+200C and U+200D, which Persian and emoji need.
pub fn is_invisible(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{61c}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
            | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

fn escaped(text: &str, special: impl Fn(char) -> bool) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if special(c) { out.extend(c.escape_debug()) } else { out.push(c) }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_commands_a_terminal_becomes_visible() {
        let hostile = "a\u{1b}[2Jb\u{9b}31m\nc\u{202e}d\u{2067}\u{200f}e\r\t\u{7f}";
        assert_eq!(visible(hostile), r"a\u{1b}[2Jb\u{9b}31m\nc\u{202e}d\u{2067}\u{200f}e\r\t\u{7f}");
        assert_eq!(visible_lines("a\tb\u{1b}\nc\u{2028}"), "a\tb\\u{1b}\nc\\u{2028}");
        for harmless in ["", "bällchen 球.toml", "שלום", "👩\u{200d}🚀", r"C:\x"] {
            assert_eq!(visible(harmless), harmless);
        }
    }
}
