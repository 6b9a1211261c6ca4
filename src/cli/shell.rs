//! Quotes words of commands that users may copy into a shell.

use std::path::Path;

use crate::diagnostic::is_invisible;
use crate::system::{SHELL, Shell};

/// Quotes a path as one word of a command for the shells of this system. The shell never reads the word as an option.
pub(super) fn path(path: &Path) -> String {
    match SHELL {
        Shell::Unix => for_unix(path),
        Shell::Windows => for_windows(&path.to_string_lossy()),
    }
}

/// Quotes a path for cmd and PowerShell. `"` cannot be in a path there.
fn for_windows(path: &str) -> String {
    let prefix = if path.starts_with('-') { ".\\" } else { "" };
    let plain = |c: char| c.is_alphanumeric() || "\\/._-+:".contains(c);
    match !path.is_empty() && path.chars().all(plain) {
        true => format!("{prefix}{path}"),
        false => format!("\"{prefix}{}\"", path.replace('"', "\\\"")),
    }
}

/// Quotes a path for bash and zsh. Invisible characters are escaped.
fn for_unix(path: &Path) -> String {
    let bytes = path.as_os_str().as_encoded_bytes();
    let prefix = if bytes.starts_with(b"-") { "./" } else { "" };
    let plain = |c: char| c.is_alphanumeric() || "/._-+,:@%".contains(c);
    match path.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(plain) => format!("{prefix}{text}"),
        Some(text) if !text.chars().any(is_invisible) => {
            format!("'{prefix}{}'", text.replace('\'', r"'\''"))
        }
        _ => format!("$'{prefix}{}'", bytes.utf8_chunks().map(|chunk| ansi_c(&chunk)).collect::<String>()),
    }
}

/// Quotes a text as one word of a command for the shells of this system.
pub(super) fn word(text: &str) -> String {
    path(Path::new(text))
}

/// Escapes a part of a word that is enclosed in `$'` and `'`. Bytes that are not UTF-8 become octal escapes.
fn ansi_c(chunk: &std::str::Utf8Chunk<'_>) -> String {
    let octal = |bytes: &[u8]| bytes.iter().map(|byte| format!("\\{byte:03o}")).collect::<String>();
    let character = |c: char| match c {
        '\n' => r"\n".to_owned(),
        '\'' | '\\' => format!("\\{c}"),
        c if is_invisible(c) => octal(c.to_string().as_bytes()),
        c => c.to_string(),
    };
    chunk.valid().chars().map(character).collect::<String>() + &octal(chunk.invalid())
}

#[cfg(all(test, unix))]
mod tests {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::process::Command;

    use super::*;

    #[test]
    fn bash_reads_a_word_as_the_path_it_was() {
        for bytes in [
            &b"out/film-job"[..],
            b"",
            b" a  b",
            b"it's",
            b"$(touch PWNED)",
            b"`x`",
            b"a\nb",
            b"\"\\",
            b"-x",
            b"-x y",
            b"~",
            b"*",
            b"!x",
            b"\xff\x1b[31m",
            "ü\u{202e}7".as_bytes(),
            b"a;b",
            b"#",
            b"{a,b}",
        ] {
            let word = for_unix(Path::new(OsStr::from_bytes(bytes)));
            assert!(!word.chars().any(is_invisible), "{word}");
            let output = Command::new("bash").arg("-c").arg(format!("printf '%s' {word}")).output().unwrap();
            let read = output.stdout.strip_prefix(b"./").filter(|_| bytes.starts_with(b"-"));
            assert_eq!(read.unwrap_or(&output.stdout), bytes, "{word}");
        }
        assert_eq!(for_unix(Path::new("out/bällchen-job")), "out/bällchen-job");
    }

    #[test]
    fn words_for_windows_are_in_double_quotes_where_needed() {
        for (path, word) in [
            ("C:\\out\\bällchen", "C:\\out\\bällchen"),
            ("a b", "\"a b\""),
            ("it's", "\"it's\""),
            ("", "\"\""),
            ("-x", ".\\-x"),
            ("-x y", "\".\\-x y\""),
        ] {
            assert_eq!(for_windows(path), word);
        }
    }
}
