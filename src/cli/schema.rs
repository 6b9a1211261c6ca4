//! The command `jabuka schema`: prints the JSON Schema of scenes, for editors.

use crate::scene::grammar;

use super::{Failure, terminal};

/// Print a JSON Schema of scenes, with which editors check and complete scene files
#[derive(clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_: &Arguments) -> Result<(), Failure> {
    terminal::json(&format!("{:#}\n", grammar::schema()));
    Ok(())
}
