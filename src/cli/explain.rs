//! The command `jabuka explain`: explains the code of an error or a warning.

use jabuka::explain::{Explanation, explanations};

use super::{Failure, terminal};

/// Explain the code of an error or a warning, with examples
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The code to explain, such as `unknown-key` in `error[unknown-key]`; without it, all codes are listed
    code: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(code) = &arguments.code else {
        let rows: Vec<_> = explanations().map(|entry| (entry.code.name(), entry.title())).collect();
        terminal::rows(&rows);
        return Ok(());
    };
    let explanation = Explanation::of(code).map_err(|near| terminal::unknown("code", code, near))?;
    terminal::result(&explanation.to_string());
    Ok(())
}
