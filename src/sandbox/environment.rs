//! The environment variables that a program in the sandbox receives. A script may read them, and other variables may hold passwords and keys.

use std::ffi::{OsStr, OsString};

use crate::system;

/// The variables that programs need: where programs, libraries, fonts and settings are, language and time zone.
/// Windows needs its own folders in some of them to start a program.
const PASSED_VARIABLES: &[&str] = &[
    "APPDATA",
    "COMSPEC",
    "DYLD_FALLBACK_LIBRARY_PATH",
    "DYLD_LIBRARY_PATH",
    "FONTCONFIG_FILE",
    "FONTCONFIG_PATH",
    "FONTCONFIG_SYSROOT",
    "HOME",
    "LANG",
    "LANGUAGE",
    "LD_LIBRARY_PATH",
    "LD_PRELOAD",
    "LOCALAPPDATA",
    "LOCALE_ARCHIVE",
    "LOCPATH",
    "NIX_LD",
    "NIX_LD_LIBRARY_PATH",
    "OMP_NUM_THREADS",
    "PATH",
    "PATHEXT",
    "PROGRAMDATA",
    "SNAP",
    "SYSTEMDRIVE",
    "SYSTEMROOT",
    "TZ",
    "TZDIR",
    "USERPROFILE",
    "WINDIR",
];

/// The beginnings of the names of further such variables: of the locale, and of POV-Ray.
const PASSED_PREFIXES: &[&str] = &["LC_", "POV"];

/// Returns the variables of this process that the program receives.
pub(super) fn passed_on() -> impl Iterator<Item = (OsString, OsString)> {
    std::env::vars_os().filter(|(name, _)| is_needed(name))
}

fn is_needed(name: &OsStr) -> bool {
    PASSED_VARIABLES.iter().any(|known| system::is_variable(name, known))
        || PASSED_PREFIXES.iter().any(|beginning| name.as_encoded_bytes().starts_with(beginning.as_bytes()))
}
