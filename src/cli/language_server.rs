//! The command `jabuka lsp`: a language server for editors.

use crate::language_server::serve;

use super::{Failure, terminal};

/// Serve an editor: errors as you type, fixes, explanations and completions
///
/// The command speaks the Language Server Protocol over standard input and output. An editor starts it.
#[derive(clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run() -> Result<(), Failure> {
    serve().map_err(|error| {
        terminal::error(&format!("error: the editor's connection failed: {error}\n"));
        Failure::Errors
    })
}
