//! The command `jabuka new`: writes a scene to start from.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::diagnostic::{nearest, visible, visible_path};
use crate::starter::{Example, write_scene, write_starter};

use super::{Failure, shell, terminal};

/// Write an example scene with comments, to start from
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file to create, which must not exist; `.toml` is added if it is missing
    name: PathBuf,
    /// Start from this example, such as `newtons_cradle`: see `jabuka list scenes`
    #[arg(long, value_name = "SCENE")]
    like: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let example = arguments.like.as_deref().map(example).transpose()?;
    let written = match example {
        Some(example) => write_scene(&arguments.name, example),
        None => write_starter(&arguments.name),
    };
    let path = written.map_err(|(path, error)| {
        let name = visible_path(&path);
        let what = if path == arguments.name { "scene" } else { "file" };
        terminal::error(&match error.kind() {
            ErrorKind::AlreadyExists => format!("error: the {what} `{name}` is there already\n"),
            _ => format!("error: cannot write the {what} `{name}`: {error}\n"),
        });
        Failure::Errors
    })?;
    terminal::result(&format!(
        "{}: a scene to start from; `jabuka preview {}` shows it\n",
        visible_path(&path),
        shell::path(&path)
    ));
    Ok(())
}

/// Finds the example that the user names, also by its path in the project: `scenes/atom.toml`.
fn example(name: &str) -> Result<&'static Example, Failure> {
    let stem =
        Path::new(name).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if let Some(example) = Example::all().find(|example| example.name == stem) {
        return Ok(example);
    }
    let names = || Example::all().map(|example| example.name);
    let holding: Vec<String> = names()
        .filter(|example| !stem.is_empty() && example.contains(&*stem))
        .map(|name| format!("`{name}`"))
        .collect();
    let meant = match holding.as_slice() {
        [] => nearest(&stem, names()).map(|near| format!("`{near}`")),
        names => Some(names.join(" or ")),
    };
    let meant = meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
    terminal::error(&format!(
        "error: there is no example scene `{}`{meant}\n`jabuka list scenes` shows all\n",
        visible(name)
    ));
    Err(Failure::Errors)
}
