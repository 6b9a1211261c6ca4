//! The command `jabuka templates`: writes the built-in templates of scripts into a folder, so that users can change them.

use std::path::PathBuf;

use crate::diagnostic::{Code, Report, visible_path};

use super::{Failure, terminal};

/// Write the built-in templates into a folder, to change them and use them with `compile --templates`
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The folder for the templates
    folder: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = &arguments.folder;
    let written = crate::emit::write_templates(folder).map_err(|error| {
        let message = format!("cannot write templates into `{}`: {error}", visible_path(folder));
        terminal::report(&Report::of_error(Code::CannotWrite, message));
        Failure::Errors
    })?;
    terminal::result(&format!(
        "{}: {written} templates, and README.md, which says what they see\n",
        visible_path(folder)
    ));
    Ok(())
}
