//! How a scene is read: the arguments that all commands which compile one have in common.

use std::path::{Path, PathBuf};

use jabuka::Scene;
use jabuka::diagnostic::Report;
use jabuka::scene::{Options, Override, View};
use jabuka::simulate::Selection;

use super::{Failure, say};

/// How a scene is read.
#[derive(clap::Args)]
pub(super) struct SceneArguments {
    /// Replace a value of the scene: a TOML value, or else a string; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    pub(super) set: Vec<Override>,
    /// Use the templates in this folder in place of those built in: see `jabuka templates`
    #[arg(long, value_name = "DIR")]
    pub(super) templates: Option<PathBuf>,
    /// Let the scene's SDL open, write and include files, and its paths leave its folder
    #[arg(long)]
    pub(super) trust: bool,
}

impl SceneArguments {
    /// Reads a scene, and says its warnings, or its errors.
    pub(super) fn read(&self, path: &Path) -> Result<Scene, Failure> {
        self.read_with(path, &[])
    }

    /// Reads a scene with further values replaced.
    pub(super) fn read_with(&self, path: &Path, overrides: &[Override]) -> Result<Scene, Failure> {
        let options = Options {
            overrides: self.set.iter().chain(overrides).cloned().collect(),
            templates: self.templates.clone(),
            trust: self.trust,
        };
        let scene = Scene::from_path_with(path, &options).map_err(|report| errors(&report))?;
        say::report(&scene.warnings);
        Ok(scene)
    }

    /// Whether none is given.
    pub(super) fn are_absent(&self) -> bool {
        self.set.is_empty() && self.templates.is_none() && !self.trust
    }
}

fn parse_set(argument: &str) -> Result<Override, String> {
    match argument.split_once('=') {
        Some((key, _)) if !key.trim().is_empty() => Ok(Override::new(argument)),
        _ => Err("write it as KEY=VALUE, as in simulation.step=0.001".to_owned()),
    }
}

/// The frames that are asked for, all of which the scene must have.
pub(super) fn selection(asked: Option<&Selection>, frames: usize) -> Result<Selection, Failure> {
    let Some(selection) = asked else { return Ok(Selection::first(frames)) };
    match selection.last() {
        Some(last) if last >= frames => {
            let message =
                format!("there is no frame {last}: the frames of this scene are 0 to {}", frames - 1);
            Err(Failure::Usage(message))
        }
        _ => Ok(selection.clone()),
    }
}

/// A view of a scene.
pub(super) fn view<'a>(scene: &'a Scene, name: &str) -> Result<&'a View, Failure> {
    scene.views.iter().find(|view| view.name == *name).ok_or_else(|| {
        let names: Vec<&str> = scene.views.iter().map(|view| view.name.as_str()).collect();
        let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        Failure::Usage(format!("there is no view `{name}`: the views of this scene are {known}"))
    })
}

/// The folder for the scripts of a view, beside that of the main camera's.
pub(super) fn beside(folder: &Path, view: &str) -> PathBuf {
    let mut path = folder.as_os_str().to_owned();
    path.push(format!("-{view}"));
    PathBuf::from(path)
}

/// Says the errors of a scene.
fn errors(report: &Report) -> Failure {
    say::report(report);
    let (errors, s) = (report.errors(), if report.errors() == 1 { "" } else { "s" });
    say::error(&format!("nothing was written: {errors} error{s}\n"));
    Failure::Errors
}
