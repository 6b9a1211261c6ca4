//! Names of files that Windows reads as something else.
//!
//! `con` or `nul.png` is a device there, `a.` and `a ` are the file `a`, and `a:b` is a hidden part of the file `a`. A file that is written
//! under such a name is lost, or replaces another one. On Windows, jabuka refuses these names wherever it opens, writes or removes a file.

use std::ffi::OsStr;
use std::io;

/// Checks that a name stands for a file of this very name on this system.
///
/// # Errors
/// If Windows is this system, and reads the name as something else.
pub(crate) fn check(name: &OsStr) -> io::Result<()> {
    match wrong_on_windows(&name.to_string_lossy()).filter(|_| cfg!(windows)) {
        Some(why) => {
            Err(io::Error::new(io::ErrorKind::InvalidFilename, format!("its name {why}; use another name")))
        }
        None => Ok(()),
    }
}

/// Names of devices. With an ending, they are devices, too: `nul.txt`.
const DEVICE_NAMES: [&str; 6] = ["con", "prn", "aux", "nul", "conin$", "conout$"];

/// Returns what is wrong with a name of a file or folder on Windows, as the end of a sentence that begins with the name. `None` if the
/// name stands for itself. `.` and `..` are no names, and pass.
fn wrong_on_windows(name: &str) -> Option<&'static str> {
    if name == "." || name == ".." {
        return None;
    }
    if name.ends_with(['.', ' ']) {
        return Some("ends in a dot or a space, which Windows leaves out");
    }
    if name.contains(':') {
        return Some("has a colon, after which Windows sees a part of another file");
    }
    if name.chars().any(|c| matches!(c, '<' | '>' | '"' | '|' | '?' | '*' | '/' | '\\') || c < ' ') {
        return Some("has a character that names of files cannot have on Windows");
    }
    // Windows leaves out spaces before the first dot.
    let stem = name.split('.').next().unwrap_or(name).trim_end_matches(' ').to_lowercase();
    let has_number = |port: &str| {
        let mut rest = stem.strip_prefix(port).unwrap_or_default().chars();
        matches!((rest.next(), rest.next()), (Some('0'..='9' | '¹' | '²' | '³'), None))
    };
    let is_device = DEVICE_NAMES.contains(&stem.as_str()) || has_number("com") || has_number("lpt");
    is_device.then_some("is a device on Windows")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_devices_and_names_that_windows_changes_are_wrong() {
        for name in [
            "con",
            "CON",
            "nul.png",
            "Aux.tar.gz",
            "prn ",
            "nul .txt",
            "com1",
            "COM9.toml",
            "lpt0",
            "com¹",
            "conin$",
            "a.",
            "a ",
            "a...",
            "...",
            "a:b",
            "c:",
            "a?",
            "a*b",
            "<a",
            "a>",
            "a|b",
            "\"a\"",
            "a\nb",
            "a\\b",
            "a/b",
        ] {
            assert!(wrong_on_windows(name).is_some(), "{name:?}");
        }
    }

    #[test]
    fn other_names_stand_for_themselves() {
        for name in [
            ".",
            "..",
            "a",
            "a.b",
            ".jabuka-x.tmp",
            " a",
            "console",
            "com",
            "com10",
            "con1",
            "nula.txt",
            "x.con",
            "b\u{e4}llchen",
            "\u{65e5}\u{672c}",
            "a'b",
            "a;b",
            "#",
            "%",
            "-x",
            "~",
            "a b.toml",
        ] {
            assert_eq!(wrong_on_windows(name), None, "{name:?}");
        }
    }
}
