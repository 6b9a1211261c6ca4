//! The arguments that change a scene.

use std::path::{Path, PathBuf};

use jabuka::Scene;
use jabuka::cache::Cache;
use jabuka::diagnostic::Report;
use jabuka::sandbox::{Confinement, Launcher};
use jabuka::scene::{Options, Override};

use super::{Failure, say};

/// Arguments that change a scene.
#[derive(clap::Args)]
pub(super) struct SceneArguments {
    /// Replace a value of the scene: a TOML value, or else a string; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    set: Vec<Override>,
    /// Use the templates in this folder in place of those built in: see `jabuka templates`
    #[arg(long, value_name = "DIR")]
    templates: Option<PathBuf>,
    /// Let the scene's SDL open, write and include files, and its paths leave its folder. POV-Ray may then read all
    /// files, and write in the folder of the scene and in those of the results
    #[arg(long)]
    trust: bool,
    /// Simulate the scene anew, and keep nothing of the run: see `jabuka cache`
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
    /// Reads the scene with further values replaced, and prints its errors and warnings.
    pub(super) fn read_with(&self, path: &Path, overrides: &[Override]) -> Result<Scene, Failure> {
        let options = self.options(overrides);
        let scene = Scene::from_path_with(path, &options).map_err(|report| errors(&report))?;
        say::report(&scene.warnings);
        Ok(scene)
    }

    /// The options for reading the scene, with further values replaced.
    pub(super) fn options(&self, overrides: &[Override]) -> Options {
        Options {
            overrides: self.set.iter().chain(overrides).cloned().collect(),
            templates: self.templates.clone(),
            trust: self.trust,
        }
    }

    /// Whether anything is changed.
    pub(super) fn change_the_scene(&self) -> bool {
        !self.set.is_empty() || self.templates.is_some()
    }

    /// The cache that keeps runs between commands.
    pub(super) fn cache(&self) -> Result<Cache, Failure> {
        if self.no_cache { Ok(Cache::none()) } else { Cache::of_user().map_err(Failure::Usage) }
    }

    /// Whether the scene is trusted.
    pub(super) fn trust(&self) -> bool {
        self.trust
    }

    /// POV-Ray's rights for the scene. `None` means scripts without a scene. `folders` are those of the results.
    pub(super) fn confinement(&self, scene: Option<&Path>, folders: &[&Path]) -> Confinement {
        let confinement = Confinement::new(Launcher::of_this_program());
        if self.trust { confinement.trusting(scene, folders) } else { confinement }
    }
}

/// Prints the errors of a scene.
fn errors(report: &Report) -> Failure {
    say::report(report);
    let (errors, s) = (report.errors(), if report.errors() == 1 { "" } else { "s" });
    say::error(&format!("nothing was written: {errors} error{s}\n"));
    Failure::Errors
}
