//! The sandbox on systems other than Linux: nothing is enforced.

use std::path::Path;

use super::{Launch, LaunchError};

/// Restricts nothing, since this system has no Landlock.
///
/// # Errors
/// None.
pub(super) fn restrict(_program: &Path, _launch: &Launch) -> Result<(), LaunchError> {
    Ok(())
}

/// Describes in a few words what this system enforces.
pub fn enforced() -> String {
    "none: only Linux has Landlock".to_owned()
}
