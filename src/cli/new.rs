//! The command `jabuka new`: writes a scene to start from.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::diagnostic::{nearest, visible, visible_path};
use crate::starter::{Example, FIRST_STARTER, write_scene};

use super::{Failure, shell, terminal};

/// Write an example scene with comments, to start from
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file to create, which must not exist; `.toml` is added if it is missing
    #[arg(required_unless_present = "list")]
    name: Option<PathBuf>,
    /// Start from this scene: one that `--list` shows, or one of the gallery, such as `newtons_cradle`
    #[arg(long, value_name = "SCENE", default_value = FIRST_STARTER)]
    like: String,
    /// List the scenes to start from, one for each kind
    #[arg(long, conflicts_with_all = ["name", "like"])]
    list: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(given) = &arguments.name else {
        list();
        return Ok(());
    };
    let written = write_scene(given, example(&arguments.like)?);
    let path = written.map_err(|(path, error)| {
        let name = visible_path(&path);
        let what = if path == *given { "scene" } else { "file" };
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

fn list() {
    let width = Example::starters().map(|starter| starter.name.len()).max().unwrap_or_default();
    for starter in Example::starters() {
        terminal::result(&format!("{:width$}  {}\n", starter.name, starter.about()));
    }
    terminal::result(
        "`jabuka new NAME --like pile` starts from one of these; `jabuka list scenes` shows the gallery\n",
    );
}

/// Finds the scene that the user names, also by its path in the project: `scenes/atom.toml`.
fn example(name: &str) -> Result<&'static Example, Failure> {
    let stem =
        Path::new(name).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let all = || Example::starters().chain(Example::gallery());
    if let Some(example) = all().find(|example| example.name == stem) {
        return Ok(example);
    }
    let names = || all().map(|example| example.name);
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
        "error: there is no scene `{}` to start from{meant}\n`jabuka new --list` and `jabuka list scenes` show all\n",
        visible(name)
    ));
    Err(Failure::Errors)
}
