//! The command-line arguments that change a scene.

use std::path::{Path, PathBuf};

use crate::Scene;
use crate::cache::Cache;
use crate::diagnostic::Report;
use crate::sandbox::{Confinement, Launcher};
use crate::scene::{Options, Override};

use super::{Failure, terminal};

/// Command-line arguments that change a scene or grant it rights.
#[derive(clap::Args)]
pub(super) struct SceneArguments {
    /// Replace a value of the scene by a TOML value, or by a string if VALUE is no TOML; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    set: Vec<Override>,
    /// Use the templates in this folder instead of the built-in ones: see `jabuka templates`
    #[arg(long, value_name = "DIR")]
    templates: Option<PathBuf>,
    /// Trust the scene: its SDL may open, write and include files, and its paths may lead out of its folder. POV-Ray may then read all
    /// files, and write in the folder of the scene and in the folders of results
    #[arg(long)]
    trust: bool,
    /// Do not use or keep the results of earlier simulations: see `jabuka cache`
    #[arg(long)]
    no_cache: bool,
}

fn parse_set(argument: &str) -> Result<Override, String> {
    match argument.split_once('=') {
        Some((key, _)) if !key.trim().is_empty() => Ok(Override::new(argument)),
        _ => Err("write it as KEY=VALUE, as in simulation.step=0.001".to_owned()),
    }
}

impl SceneArguments {
    /// Reads and checks the scene after replacing further values by `overrides`. Prints its errors and warnings.
    pub(super) fn read_with(&self, path: &Path, overrides: &[Override]) -> Result<Scene, Failure> {
        let options = self.options(overrides);
        let scene = Scene::from_path_with(path, &options).map_err(|report| errors(&report))?;
        terminal::report(&scene.warnings);
        Ok(scene)
    }

    /// Returns the options for reading the scene. `overrides` are further values to replace, after those of `--set`.
    pub(super) fn options(&self, overrides: &[Override]) -> Options {
        Options {
            overrides: self.set.iter().chain(overrides).cloned().collect(),
            templates: self.templates.clone(),
            trust: self.trust,
            measures: Vec::new(),
        }
    }

    /// Returns true if the arguments change the scene: by `--set` or by other templates.
    pub(super) fn change_the_scene(&self) -> bool {
        !self.set.is_empty() || self.templates.is_some()
    }

    /// Returns the cache that keeps simulated runs between commands, or a cache that keeps nothing for `--no-cache`.
    pub(super) fn cache(&self) -> Result<Cache, Failure> {
        if self.no_cache { Ok(Cache::none()) } else { Cache::of_user().map_err(Failure::Usage) }
    }

    /// Returns true if the user trusts the scene (`--trust`), so that its SDL may access files.
    pub(super) fn trust(&self) -> bool {
        self.trust
    }

    /// Returns the access rights of POV-Ray. `scene` is the path of the scene, or `None` for existing scripts. `folders` are the folders
    /// that receive results.
    pub(super) fn confinement(&self, scene: Option<&Path>, folders: &[&Path]) -> Confinement {
        let confinement = Confinement::new(Launcher::of_this_program());
        if self.trust { confinement.trusting(scene, folders) } else { confinement }
    }
}

/// Prints the errors of a scene, and that nothing was written.
fn errors(report: &Report) -> Failure {
    terminal::report(report);
    let (errors, s) = (report.errors(), if report.errors() == 1 { "" } else { "s" });
    terminal::error(&format!("nothing was written: {errors} error{s}\n"));
    Failure::Errors
}
