//! The command `jabuka new`: writes a scene to start from.

use std::io::ErrorKind;
use std::path::PathBuf;

use jabuka::diagnostic::visible_path;
use jabuka::starter::write_starter;

use super::{Failure, terminal};

/// Write an example scene with comments, to start from
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file to create, which must not exist; `.toml` is added if it is missing
    name: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = write_starter(&arguments.name).map_err(|error| {
        let name = visible_path(&arguments.name);
        terminal::error(&match error.kind() {
            ErrorKind::AlreadyExists => format!("error: the scene `{name}` is there already\n"),
            _ => format!("error: cannot write the scene `{name}`: {error}\n"),
        });
        Failure::Errors
    })?;
    terminal::result(&format!(
        "{}: a scene to start from; `jabuka compile` makes scripts of it\n",
        visible_path(&path)
    ));
    Ok(())
}
