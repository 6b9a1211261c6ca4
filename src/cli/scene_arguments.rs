//! The arguments by which a scene is named, changed and cut: what `compile` and its kin have in common.

use std::path::{Path, PathBuf};

use jabuka::diagnostic::Report;
use jabuka::scene::{Options, Override, View};
use jabuka::simulate::Selection;
use jabuka::{Run, Scene};

use super::progress::Progress;
use super::{Failure, say};

/// What changes and cuts a scene.
#[derive(clap::Args)]
pub(super) struct SceneArguments {
    /// Replace a value of the scene: a TOML value, or else a string; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    set: Vec<Override>,
    /// Take only these frames, as in 0,50,90-100
    #[arg(long, value_name = "LIST", allow_negative_numbers = true)]
    pub(super) frames: Option<Selection>,
    /// Take this view instead of the main camera, or `all` cameras; may be repeated
    #[arg(long, value_name = "NAME")]
    view: Vec<String>,
    /// Use the templates in this folder in place of those built in: see `jabuka templates`
    #[arg(long, value_name = "DIR")]
    templates: Option<PathBuf>,
    /// Let the scene's SDL open, write and include files, and its paths leave its folder
    #[arg(long)]
    trust: bool,
}

fn parse_set(argument: &str) -> Result<Override, String> {
    match argument.split_once('=') {
        Some((key, _)) if !key.trim().is_empty() => Ok(Override::new(argument)),
        _ => Err("write it as KEY=VALUE, as in simulation.step=0.001".to_owned()),
    }
}

impl SceneArguments {
    /// Reads the scene, and says its errors and warnings.
    pub(super) fn read(&self, path: &Path) -> Result<Scene, Failure> {
        self.read_with(path, &[])
    }

    /// Reads the scene with further values replaced.
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

    /// Whether nothing is given that only a scene can have.
    pub(super) fn suit_scripts(&self) -> bool {
        self.set.is_empty() && self.templates.is_none() && !self.trust && self.view.is_empty()
    }

    /// The frames that are asked for, of so many.
    pub(super) fn selection(&self, frames: usize) -> Result<Selection, Failure> {
        let Some(selection) = &self.frames else { return Ok(Selection::first(frames)) };
        match selection.last() {
            Some(last) if last >= frames => {
                let message =
                    format!("there is no frame {last}: the frames of this scene are 0 to {}", frames - 1);
                Err(Failure::Usage(message))
            }
            _ => Ok(selection.clone()),
        }
    }

    /// The cameras that are asked for, each with its folder: the given one, or one beside it. `None` is the main camera;
    /// `chosen` says whether it was the user who gave the folder.
    pub(super) fn cameras<'a>(
        &self,
        folder: &Path,
        chosen: bool,
        scene: &'a Scene,
    ) -> Result<Vec<(Option<&'a View>, PathBuf)>, Failure> {
        let beside = |view: &str| {
            let mut path = folder.to_owned().into_os_string();
            path.push(format!("-{view}"));
            PathBuf::from(path)
        };
        if self.view.is_empty() {
            return Ok(vec![(None, folder.to_owned())]);
        }
        if self.view.iter().any(|name| name == "all") {
            let others = scene.views.iter().map(|view| (Some(view), beside(&view.name)));
            return Ok(std::iter::once((None, folder.to_owned())).chain(others).collect());
        }
        let find = |name: &String| match scene.views.iter().find(|view| view.name == *name) {
            // The folder that is given is that of the only view that is asked for.
            Some(view) if self.view.len() == 1 && chosen => Ok((Some(view), folder.to_owned())),
            Some(view) => Ok((Some(view), beside(name))),
            None => {
                let names: Vec<&str> = scene.views.iter().map(|view| view.name.as_str()).collect();
                let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                let message = format!("there is no view `{name}`: the views of this scene are {known}");
                Err(Failure::Usage(message))
            }
        };
        self.view.iter().map(find).collect()
    }

    /// Whether something is said that only a scene has, not a folder of scripts.
    pub(super) fn change_the_scene(&self) -> bool {
        !self.set.is_empty() || !self.view.is_empty() || self.templates.is_some() || self.trust
    }

    /// The frames that are asked for, if they are.
    pub(super) fn frames(&self) -> Option<&Selection> {
        self.frames.as_ref()
    }
}

/// Simulates a scene once, with a step of the progress for every frame.
pub(super) fn survey<'a>(scene: &'a Scene, progress: &Progress) -> Result<Run<'a>, Failure> {
    progress.phase("simulating");
    Run::new_seeing(scene, |_| progress.step()).map_err(|error| progress.failed(&error.into()))
}

/// The run as a camera sees it; `None` is the main one, by which it was made.
pub(super) fn seen<'a>(
    run: &Run<'a>,
    view: Option<&View>,
    progress: &Progress,
) -> Result<Option<Run<'a>>, Failure> {
    let seen = view.map(|view| run.seen_by(view)).transpose();
    seen.map_err(|error| progress.failed(&error.into()))
}

/// Says the errors of a scene.
fn errors(report: &Report) -> Failure {
    say::report(report);
    let (errors, s) = (report.errors(), if report.errors() == 1 { "" } else { "s" });
    say::error(&format!("nothing was written: {errors} error{s}\n"));
    Failure::Errors
}
