//! Makes the files of a job folder from the templates in `templates/batch/`.

use super::settings::fill;
use super::{Engine, SETTINGS_FILE, Settings};
use crate::simulate::Selection;

/// The computing resources that a job requests. The user can set missing ones by editing the job's files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Requirements {
    /// The Slurm partition (queue) to submit to.
    pub partition: Option<String>,
    /// The Slurm account to charge.
    pub account: Option<String>,
    /// The time limit for a chunk of frames, in Slurm's notation.
    pub time: Option<String>,
    /// The number of processors for a chunk of frames.
    pub cpus: Option<usize>,
    /// The memory for a chunk of frames, in Slurm's notation.
    pub memory: Option<String>,
    /// The environment modules to load, as arguments of `module load`.
    pub modules: Option<String>,
}

/// A file of a job folder, with its name and text.
pub(super) struct Text {
    pub(super) name: &'static str,
    pub(super) text: String,
    /// True if users may edit the file, so that jabuka keeps their edits.
    pub(super) users: bool,
    /// True if the file is executable.
    pub(super) runs: bool,
}

/// The part of the README that says how to submit a job to Slurm.
const SLURM_INSTRUCTIONS: &str = "\
Send it from where Slurm takes jobs, as often as you like; only what is missing is sent:

    ./submit

Look over the lines `#SBATCH` of `render.sbatch` and `video.sbatch` before: partition, account, time, modules.";

const SLURM_FILES: &str = "\
| `render.sbatch`, `video.sbatch` | the jobs, with the lines `#SBATCH` for you to edit |
| `submit` | sends what is missing |";

/// The part of the README that says how to run a job as an Open Job Description.
const OPENJD_INSTRUCTIONS: &str = "\
This folder is a bundle of an Open Job Description:

    openjd check template.yaml
    openjd run template.yaml --step Render && openjd run template.yaml --step Video
    deadline bundle submit .";

const OPENJD_FILES: &str = "\
| `template.yaml` | the job; `-p Frames=7,13-24` renders only some |
| `asset_references.yaml` | files beyond this folder: none |";

/// Makes all files of a job folder except the scripts.
pub(super) fn texts(settings: &Settings, engine: Engine, requirements: &Requirements) -> Vec<Text> {
    let own = |name, text: String, runs| Text { name, text, users: false, runs };
    let users = |name, text| Text { name, text, users: true, runs: false };
    let frames = settings.frames.iter().copied().collect::<Selection>().to_string();
    let (kept, how, files) = match engine {
        Engine::Slurm => ("`render.sbatch` and `video.sbatch`", SLURM_INSTRUCTIONS, SLURM_FILES),
        Engine::OpenJd => ("`template.yaml` and `asset_references.yaml`", OPENJD_INSTRUCTIONS, OPENJD_FILES),
    };
    let readme = fill(
        include_str!("../../../templates/batch/README.md"),
        &[("kept", kept), ("how", how), ("files", files), ("frames", &frames), ("job", &settings.job)],
    );
    let mut texts = vec![
        own(SETTINGS_FILE, settings.to_text(), false),
        own("settings.sh", include_str!("../../../templates/batch/settings.sh").to_owned(), false),
        own("render-chunk", include_str!("../../../templates/batch/render-chunk").to_owned(), true),
        own("render-video", include_str!("../../../templates/batch/render-video").to_owned(), true),
        own("README.md", readme, false),
    ];
    match engine {
        Engine::Slurm => {
            let modules = modules(requirements);
            let sbatch = |text: &str, more: &str| {
                fill(text, &[("sbatch", &(slurm(requirements) + more)), ("modules", &modules)])
            };
            let cpus = format!("\n#SBATCH --cpus-per-task={}", requirements.cpus.unwrap_or(1));
            let render = sbatch(include_str!("../../../templates/batch/render.sbatch"), &cpus);
            texts.push(users("render.sbatch", render));
            texts.push(users(
                "video.sbatch",
                sbatch(include_str!("../../../templates/batch/video.sbatch"), ""),
            ));
            texts.push(own("submit", include_str!("../../../templates/batch/submit").to_owned(), true));
        }
        Engine::OpenJd => {
            let template = fill(
                include_str!("../../../templates/batch/template.yaml"),
                &[
                    ("name", &yaml(&settings.job)),
                    ("frames", &frames),
                    ("chunk", &settings.chunk.to_string()),
                    ("cpus", &requirements.cpus.unwrap_or(1).to_string()),
                ],
            );
            texts.push(users("template.yaml", template));
            let references = include_str!("../../../templates/batch/asset_references.yaml");
            texts.push(users("asset_references.yaml", references.to_owned()));
        }
    }
    texts
}

/// Returns the `#SBATCH` lines of a Slurm script: those for the requested resources, and commented-out examples of all others.
fn slurm(requirements: &Requirements) -> String {
    let line = |option: &str, value: Option<&str>, example: &str| match value {
        Some(value) => format!("#SBATCH --{option}={value}"),
        None => format!("##SBATCH --{option}={example}"),
    };
    let Requirements { partition, account, time, memory, .. } = requirements;
    [
        line("partition", partition.as_deref(), "compute"),
        line("account", account.as_deref(), "my_group"),
        line("time", time.as_deref(), "01:00:00"),
        line("mem", memory.as_deref(), "2G"),
    ]
    .join("\n")
}

fn modules(requirements: &Requirements) -> String {
    match &requirements.modules {
        Some(modules) => {
            format!(
                "# shellcheck source=/dev/null\ncommand -v module >/dev/null || . /etc/profile\nmodule load {modules} || exit 1"
            )
        }
        None => "# module load povray ffmpeg".to_owned(),
    }
}

/// Quotes a text as a YAML string, shortened to the largest number of characters that a name may have.
fn yaml(text: &str) -> String {
    /// The largest number of characters in a name, according to Open Job Description.
    const MAX_NAME_CHARACTERS: usize = 128;
    let text: String = text.chars().take(MAX_NAME_CHARACTERS).collect();
    // A JSON string is also a YAML string. Double braces are replaced, since Open Job Description reads them as a variable.
    serde_json::Value::String(text.replace("{{", "(").replace("}}", ")")).to_string()
}

#[cfg(test)]
mod tests {
    use super::super::settings::tests::settings;
    use super::*;

    fn text(engine: Engine, requirements: &Requirements, name: &str) -> String {
        let texts = texts(&settings(), engine, requirements);
        texts.into_iter().find(|text| text.name == name).unwrap().text
    }

    #[test]
    fn what_is_asked_for_is_set_and_the_rest_is_left_open() {
        let asked = Requirements {
            partition: Some("long".to_owned()),
            cpus: Some(4),
            modules: Some("povray/3.7 ffmpeg".to_owned()),
            ..Requirements::default()
        };
        let render = text(Engine::Slurm, &asked, "render.sbatch");
        for line in ["#SBATCH --partition=long", "##SBATCH --account=my_group", "#SBATCH --cpus-per-task=4"] {
            assert!(render.lines().any(|l| l == line), "{line} is missing in\n{render}");
        }
        assert!(render.contains("\nmodule load povray/3.7 ffmpeg || exit 1\n"));
        assert!(!text(Engine::Slurm, &asked, "video.sbatch").contains("cpus"));
    }

    #[test]
    fn no_place_is_left_empty() {
        for engine in [Engine::Slurm, Engine::OpenJd] {
            for text in texts(&settings(), engine, &Requirements::default()) {
                let left = text.text.split('@').skip(1).step_by(2).find(|word| {
                    !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c == '_')
                });
                assert_eq!(left, None, "in {}", text.name);
            }
        }
    }
}
