//! Systems other than Linux: nothing is enforced.

use std::path::PathBuf;

use super::LaunchError;

/// Restricts nothing: this system has no Landlock.
///
/// # Errors
/// None.
pub(super) fn restrict(_read: &[PathBuf], _write: &[PathBuf]) -> Result<(), LaunchError> {
    Ok(())
}

/// What this system enforces, in a few words.
pub fn enforced() -> String {
    "none: only Linux has Landlock".to_owned()
}
