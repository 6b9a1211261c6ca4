//! The command-line arguments that change a scene and select frames and cameras, shared by `compile`, `render` and `batch`.

use std::path::{Path, PathBuf};

use crate::cache::Cache;
use crate::output::OutputError;
use crate::sandbox::Confinement;
use crate::scene::{Override, View};
use crate::simulate::{Moments, Recorded, Selection, SimulateError};
use crate::{Run, Scene};

use super::progress::Progress;
use super::scene_arguments::SceneArguments;
use super::{Failure, interrupt, terminal};

/// Command-line arguments that change a scene, and select frames and cameras of its run.
#[derive(clap::Args)]
pub(super) struct RunArguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Select frames by number, as in 0,50,90-100
    #[arg(long, value_name = "LIST", allow_negative_numbers = true)]
    pub(super) frames: Option<Selection>,
    /// Use this view instead of the main camera, or `all` cameras; may be repeated
    #[arg(long, value_name = "NAME")]
    view: Vec<String>,
}

impl RunArguments {
    /// Reads and checks the scene, and prints its errors and warnings.
    pub(super) fn read(&self, path: &Path) -> Result<Scene, Failure> {
        self.read_with(path, &[])
    }

    /// Reads and checks the scene after replacing further values by `overrides`. Prints its errors and warnings.
    pub(super) fn read_with(&self, path: &Path, overrides: &[Override]) -> Result<Scene, Failure> {
        self.scene.read_with(path, overrides)
    }

    /// Returns true if the arguments change the scene or select a view. Neither is possible for a folder of existing scripts.
    pub(super) fn change_the_scene(&self) -> bool {
        self.scene.change_the_scene() || !self.view.is_empty()
    }

    /// Returns the cache that keeps simulated runs between commands.
    pub(super) fn cache(&self) -> Result<Cache, Failure> {
        self.scene.cache()
    }

    /// Returns true if the user trusts the scene (`--trust`), so that its SDL may access files.
    pub(super) fn trust(&self) -> bool {
        self.scene.trust()
    }

    /// Returns the access rights of POV-Ray. `scene` is the path of the scene, or `None` for existing scripts. `folders` are the folders
    /// that receive results.
    pub(super) fn confinement(&self, scene: Option<&Path>, folders: &[&Path]) -> Confinement {
        self.scene.confinement(scene, folders)
    }

    /// Returns the selected frames of a scene with `frames` frames. It is an error to select a frame that does not exist.
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

    /// Returns the requested cameras, each with its folder. `None` is the main camera, which gets `folder`; a view gets a folder named
    /// after it, beside `folder`. `chosen` is true if the user gave the folder.
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
        // If the user gives a folder and a single view, the view gets that very folder.
        let alone = self.view.len() == 1 && chosen;
        let find = |name: &String| {
            let folder = if alone { folder.to_owned() } else { beside(name) };
            Ok((Some(view(scene, name)?), folder))
        };
        self.view.iter().map(find).collect()
    }
}

/// Returns the view of the scene with this name. An unknown name is an error of usage.
pub(super) fn view<'a>(scene: &'a Scene, name: &str) -> Result<&'a View, Failure> {
    scene.views.iter().find(|view| view.name == name).ok_or_else(|| {
        let names: Vec<&str> = scene.views.iter().map(|view| view.name.as_str()).collect();
        let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        Failure::Usage(format!("there is no view `{name}`: the views of this scene are {known}"))
    })
}

/// Simulates a scene, or takes its run from the cache. Advances the progress bar by a step for each frame.
pub(super) fn simulated<'a>(
    scene: &'a Scene,
    cache: &Cache,
    moments: Moments,
    progress: &Progress,
) -> Result<Recorded<'a>, OutputError> {
    progress.phase("simulating");
    announce_checkpoints(scene, cache);
    let recorded = cache.run(scene, moments, progress.pair_counter(), |_| progress.step())?;
    say_resumed(&recorded, progress);
    Ok(recorded)
}

/// Simulates a scene as [`simulated`] does. If the simulation breaks down, the result holds the frames before the breakdown.
pub(super) fn simulated_to_breakdown<'a>(
    scene: &'a Scene,
    cache: &Cache,
    moments: Moments,
    progress: &Progress,
) -> Result<Recorded<'a>, OutputError> {
    progress.phase("simulating");
    announce_checkpoints(scene, cache);
    let recorded = cache.run_to_breakdown(scene, moments, progress.pair_counter(), |_| progress.step())?;
    say_resumed(&recorded, progress);
    Ok(recorded)
}

/// If the simulation of a scene is saved from time to time, Ctrl-C says so.
fn announce_checkpoints(scene: &Scene, cache: &Cache) {
    // Only the engine for many bodies saves its state.
    if scene.is_for_many_bodies() && cache.folder().is_some() {
        interrupt::announced();
    }
}

/// If the simulation continued a run that had been stopped, prints the time from which it continued.
fn say_resumed(recorded: &Recorded<'_>, progress: &Progress) {
    if let Some(time) = recorded.resumed() {
        progress
            .above(|| terminal::error(&format!("the run had been stopped; it went on from t = {time} s\n")));
    }
}

/// Returns the selected frames that were simulated: all of them, or only those before a breakdown of the simulation.
pub(super) fn whole(recorded: &Recorded<'_>, selection: &Selection) -> Selection {
    match recorded.breakdown() {
        Some(_) => (0..recorded.whole_frames()).filter(|&frame| selection.contains(frame)).collect(),
        None => selection.clone(),
    }
}

/// If the simulation broke down, prints the reason and the number of selected frames before the breakdown, and returns an error.
pub(super) fn broken_down(recorded: &Recorded<'_>, selection: &Selection) -> Result<(), Failure> {
    let Some(breakdown) = recorded.breakdown() else { return Ok(()) };
    let kept = match selection.count_within(recorded.whole_frames()) {
        0 => "no frame before that was asked for".to_owned(),
        1 => "1 frame before is kept".to_owned(),
        frames => format!("{frames} frames before are kept"),
    };
    Err(report_breakdown(breakdown, &kept))
}

/// Prints why the simulation broke down, and what is `kept` of the run before that.
pub(super) fn report_breakdown(breakdown: &SimulateError, kept: &str) -> Failure {
    let mut report = OutputError::from(breakdown.clone()).report();
    report.diagnostics.iter_mut().for_each(|diagnostic| diagnostic.message.push_str(&format!("; {kept}")));
    terminal::report(&report);
    Failure::Errors
}

/// Simulates a scene as [`run`] does. If the simulation breaks down, the result holds the frames before the breakdown.
pub(super) fn run_to_breakdown<'a>(
    scene: &'a Scene,
    cache: &Cache,
    progress: &Progress,
) -> Result<Run<'a>, Failure> {
    let recorded = simulated_to_breakdown(scene, cache, Moments::of(scene), progress);
    let run = recorded.and_then(|recorded| Ok(Run::of(recorded)?));
    run.map_err(|error| progress.failed(&error))
}

/// Simulates a scene, and prepares the scripts for its main camera.
pub(super) fn run<'a>(scene: &'a Scene, cache: &Cache, progress: &Progress) -> Result<Run<'a>, Failure> {
    let recorded = simulated(scene, cache, Moments::of(scene), progress);
    let run = recorded.and_then(|recorded| Ok(Run::of(recorded)?));
    run.map_err(|error| progress.failed(&error))
}

/// Returns the run as seen by a view of the scene. Returns `None` if `view` is `None`: the given run already uses the main camera.
pub(super) fn seen<'a>(
    run: &Run<'a>,
    view: Option<&View>,
    progress: &Progress,
) -> Result<Option<Run<'a>>, Failure> {
    let seen = view.map(|view| run.seen_by(view)).transpose();
    seen.map_err(|error| progress.failed(&error.into()))
}
