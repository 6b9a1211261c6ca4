//! The sandbox on systems other than Linux: nothing is enforced.

use std::path::PathBuf;

use super::LaunchError;

/// Restricts nothing, since this system has no Landlock.
///
/// # Errors
/// None.
pub(super) fn restrict(_read: &[PathBuf], _write: &[PathBuf]) -> Result<(), LaunchError> {
    Ok(())
}

/// Describes in a few words what this system enforces.
pub fn enforced() -> String {
    "none: only Linux has Landlock".to_owned()
}
