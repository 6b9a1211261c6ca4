//! Job folders: everything that several machines need to render a film together, without jabuka.
//!
//! A job folder contains the scripts, the images, and `render-chunk`, a bash script that renders some of the frames. Every engine (a job
//! scheduler such as Slurm) calls `render-chunk`. The texts of the files are in `templates/batch/`.

mod copy;
mod edits;
mod settings;
mod texts;

use std::io;
use std::path::Path;

use copy::complete;
pub use copy::{copy_scripts, size};
pub(super) use settings::CurrentSettings;
pub use settings::{SETTINGS_FILE, Settings};
pub use texts::Requirements;

use super::record::HIDDEN_FOLDER;
use super::{Pace, Quality};
use crate::output::{self, Folder, OutputError};
use crate::system::{Dir, Kind};

/// The name of the subfolder of a job folder that contains the scripts.
pub const SCRIPTS_FOLDER: &str = "scripts";

/// The job scheduler that distributes the frames to machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// The workload manager Slurm.
    Slurm,
    /// A render-farm manager that reads Open Job Descriptions (OpenJD).
    OpenJd,
}

impl Engine {
    /// Returns the name of the engine on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Engine::Slurm => "slurm",
            Engine::OpenJd => "openjd",
        }
    }
}

/// A job folder that is locked, so that only this process writes to it.
pub struct JobFolder {
    folder: Folder,
}

/// What happened to edited files of a job folder when it was written again. Files are given by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edits {
    /// The edited files that were kept.
    pub kept: Vec<&'static str>,
    /// The kept files whose text would now be different. The new text is in a file beside each, with the extension `.new`.
    pub new: Vec<&'static str>,
    /// The edited files that jabuka had to replace, each with the new name of the edited version, such as `submit.old`.
    pub moved: Vec<(&'static str, String)>,
}

impl JobFolder {
    /// Opens and locks a job folder: a new or empty folder, or one that jabuka made.
    ///
    /// # Errors
    /// If jabuka did not make the folder, another process writes to it, or it cannot be created or read.
    pub fn open(path: &Path) -> Result<JobFolder, OutputError> {
        let (dir, made) = Dir::make_noting(path)?;
        let folder = Folder::of(dir, made, &|dir| edits::WrittenDigests::read(dir).is_some())?;
        for name in ["logs", "images"] {
            refuse_links(folder.dir(), name)?;
        }
        // The folder is marked as jabuka's at once, so that jabuka can open it again if this process is killed.
        edits::WrittenDigests::read(folder.dir()).unwrap_or_default().write(&folder)?;
        Ok(JobFolder { folder })
    }

    /// Opens the subfolder for the scripts of the job, for writing.
    ///
    /// # Errors
    /// If the subfolder cannot be opened as an output folder.
    pub fn scripts(&self) -> Result<Folder, OutputError> {
        Folder::within(self.folder.dir(), SCRIPTS_FOLDER)
    }

    /// Removes the folder again, if it was empty or missing before. A job without scripts is of no use.
    pub fn discard(&self) {
        self.folder.discard();
    }

    /// Writes all files of a job except the scripts. Edits by users are kept or moved; the result lists them. With `trust`, files of a folder
    /// that was not made here count as edits of the user.
    ///
    /// # Errors
    /// If a file cannot be written; if the folder was not made here, and holds files that would be kept, without `trust`.
    pub fn write(
        &self,
        settings: &Settings,
        engine: Engine,
        requirements: &Requirements,
    ) -> Result<Edits, OutputError> {
        let texts = texts::texts(settings, engine, requirements);
        if !self.folder.is_made_here() && !settings.trust {
            let names = edits::strangers(&self.folder, &texts)?;
            if !names.is_empty() {
                return Err(OutputError::JobFromElsewhere(self.folder.path().to_owned(), names));
            }
        }
        // The engine writes logs into `logs`. If that folder is missing, the job fails without a message.
        for folder in ["logs", "images", &format!("images/{HIDDEN_FOLDER}")] {
            self.folder.dir().make_folder(folder)?;
        }
        let edits = edits::write(&self.folder, &texts)?;
        self.folder.note_made_here();
        Ok(edits)
    }
}

/// Refuses links below `logs`, and in the hidden folder among the images. The scripts of a job write there.
fn refuse_links(folder: &Dir, name: &str) -> Result<(), OutputError> {
    match folder.about(name)?.map(|found| found.kind) {
        Some(Kind::Link) => Err(OutputError::Link(folder.path().join(name))),
        Some(Kind::Folder) => {
            let folder = folder.folder(name)?;
            // The images themselves are only replaced, never written to.
            let names = if name == "images" { vec![HIDDEN_FOLDER.into()] } else { folder.names()? };
            names.iter().try_for_each(|name| name.to_str().map_or(Ok(()), |name| refuse_links(&folder, name)))
        }
        _ => Ok(()),
    }
}

/// Returns the number of up-to-date images in a job folder, and the number of requested frames.
///
/// # Errors
/// If the folder has no scripts or settings that can be read, or a file that the scripts read is missing.
pub fn up_to_date(folder: &Path) -> io::Result<(usize, usize)> {
    let status = super::status::Status::read(folder)?;
    Ok((status.done.len(), status.frames.len()))
}

/// Makes the settings of a cluster job for the scripts of a folder.
///
/// `frames` are the requested frames, or `None` for all frames that have scripts. `video_rate` is the frame rate of the film, `None` for
/// the rate in the manifest.
///
/// # Errors
/// If scripts of the folder are missing, or the folder contains none of jabuka's.
pub fn settings(
    scripts: &Path,
    frames: Option<&crate::simulate::Selection>,
    options: String,
    video_rate: Option<f64>,
) -> Result<Settings, OutputError> {
    let head = complete(scripts)?;
    let mut frames: Vec<usize> = output::scripts(scripts)?
        .into_iter()
        .map(|(frame, _)| frame)
        .filter(|frame| frames.is_none_or(|frames| frames.contains(*frame)))
        .collect();
    // A frame with motion blur has two scripts but one image.
    frames.dedup();
    let names = Dir::of_path(scripts)?.names()?;
    let blurred = names.iter().any(|name| name.to_string_lossy().starts_with("shutter_"));
    let last_frame = head.frames.saturating_sub(1);
    let number = frames.len();
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of frames")]
    let end = head.timeline().time(last_frame);
    let pace = Pace::new(head.frame_rate, video_rate.or(head.video_rate));
    Ok(Settings {
        job: job_name(&head.scene),
        frames,
        last_frame,
        end,
        digits: crate::emit::width(head.frames),
        pace,
        shown: pace.at(&head.speed),
        video_quality: Quality::default(),
        chunk: chunk(number, 1),
        options,
        files: files(scripts)?,
        blurred,
        trust: false,
        limit: 3600,
    })
}

/// Returns the names of the files that all scripts read. Refuses control characters in names, since each name takes one line of the
/// settings.
fn files(scripts: &Path) -> Result<Vec<String>, OutputError> {
    let files = super::files::in_folder(&Dir::of_path(scripts)?)?;
    if let Some(file) = files.iter().find(|file| file.contains(char::is_control)) {
        let why = "the settings of a job cannot hold a name with a line break or another control character";
        return Err(OutputError::Io(scripts.join(file), io::Error::new(io::ErrorKind::InvalidInput, why)));
    }
    Ok(files)
}

/// Makes the name of a cluster job from the name of a scene. Commas, braces and other characters have a meaning for engines, so all
/// characters but letters, digits and `-_.` become `_`.
fn job_name(scene: &str) -> String {
    /// The largest number of characters taken from the scene's name. Open Job Description limits the whole name to 128 characters.
    const MOST_CHARACTERS: usize = 100;
    let plain = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    let name: String = scene.chars().take(MOST_CHARACTERS).map(plain).collect();
    format!("jabuka-{name}")
}

/// Returns the default number of frames in one job of an engine. It is small enough that a failure costs little, keeps all processors
/// busy, and gives at most 1000 jobs.
pub fn chunk(frames: usize, cpus: usize) -> usize {
    frames.div_ceil(1000).max(10).max(cpus.saturating_mul(4))
}
