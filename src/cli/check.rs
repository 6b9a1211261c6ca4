//! The command `jabuka check`: reports errors and warnings in scenes.

use std::path::{Path, PathBuf};

use crate::cache::Cache;
use crate::diagnostic::{Report, visible_path};
use crate::scene::Options;
use crate::simulate::Moments;
use crate::{Run, Scene};
use clap::ValueEnum;

use super::progress::Progress;
use super::run_arguments::simulated;
use super::scene_arguments::SceneArguments;
use super::{Failure, terminal};

/// Check scenes for errors, without writing any file
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene files to check
    #[arg(required = true)]
    scene: Vec<PathBuf>,
    /// The format of the errors and warnings
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Also simulate the scenes, and report warnings about their motion
    #[arg(long)]
    run: bool,
    #[command(flatten)]
    of_scene: SceneArguments,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    /// Text for people, on standard error
    Text,
    /// JSON for editors: a list of objects, on standard output
    Json,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let options = arguments.of_scene.options(&[]);
    let cache = arguments.run.then(|| arguments.of_scene.cache()).transpose()?;
    let mut errors = 0;
    let mut json = Vec::new();
    for path in &arguments.scene {
        let report = look_at(path, &options, cache.as_ref());
        errors += report.errors();
        match arguments.format {
            Format::Text => show(path, &report),
            Format::Json => {
                // A diagnostic without a position names no file, so each entry also gets the path of the scene.
                let mut entries = report.to_json();
                entries.iter_mut().for_each(|entry| entry.set_scene(path.display().to_string()));
                json.extend(entries.into_iter().filter_map(|entry| serde_json::to_value(entry).ok()));
            }
        }
    }
    if matches!(arguments.format, Format::Json) {
        terminal::json(&format!("{:#}\n", serde_json::Value::Array(json)));
    }
    if errors > 0 { Err(Failure::Errors) } else { Ok(()) }
}

/// Returns the diagnostics of a scene. With a cache, also simulates the scene and adds the warnings of its run.
fn look_at(path: &Path, options: &Options, cache: Option<&Cache>) -> Report {
    let scene = match Scene::from_path_with(path, options) {
        Ok(scene) => scene,
        Err(report) => return report,
    };
    let mut report = scene.warnings.clone();
    if let Some(cache) = cache {
        let progress = Progress::of_run(&scene, 0);
        let run = simulated(&scene, cache, Moments::of(&scene), &progress);
        let run = run.and_then(|recorded| Ok(Run::of(recorded)?));
        progress.finish();
        report.diagnostics.extend(match run {
            Ok(run) => run.warnings(),
            Err(error) => error.report().diagnostics,
        });
    }
    report
}

fn show(path: &Path, report: &Report) {
    terminal::report(report);
    let count = |number: usize, noun: &str| format!("{number} {noun}{}", if number == 1 { "" } else { "s" });
    let verdict = match (report.errors(), report.warnings()) {
        (0, 0) => "ok".to_owned(),
        (0, warnings) => format!("ok, {}", count(warnings, "warning")),
        (errors, 0) => count(errors, "error"),
        (errors, warnings) => format!("{}, {}", count(errors, "error"), count(warnings, "warning")),
    };
    terminal::result(&format!("{}: {verdict}\n", visible_path(path)));
}
