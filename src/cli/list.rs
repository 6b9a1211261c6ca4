//! The command `jabuka list`: lists the available integrators, materials, shapes and so on.

use crate::catalog::{CATEGORIES, Category};
use crate::diagnostic::nearest;

use super::{Failure, terminal};

/// List the names that scenes can use (integrators, shapes, colors, …), and the example scenes
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The category to list, such as `shapes`; without it, all categories are listed
    category: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(name) = &arguments.category else {
        let rows: Vec<_> = CATEGORIES.iter().map(|category| (category.name, category.place)).collect();
        terminal::rows(&rows);
        return Ok(());
    };
    let category = Category::named(name).ok_or_else(|| {
        let names: Vec<&str> = CATEGORIES.iter().map(|category| category.name).collect();
        let failure = terminal::unknown("list of", name, nearest(name, names.iter().copied()));
        terminal::error(&format!("the lists: {}\n", names.join(", ")));
        failure
    })?;
    let entries = (category.entries)();
    terminal::rows(&entries.iter().map(|(name, what)| (&**name, what.as_str())).collect::<Vec<_>>());
    Ok(())
}
