//! Job folders: everything that several machines need to render a film together, without jabuka.
//!
//! A job folder holds the scripts, the images, and `render-chunk`, a bash script that renders some of the frames and that every
//! engine calls. Its texts are in `templates/batch/`.

mod copy;
mod edits;
mod settings;
mod texts;

use std::fs;
use std::io;
use std::path::Path;

use copy::complete;
pub use copy::{copy_scripts, size};
pub(super) use settings::InForce;
pub use settings::{SETTINGS, Settings};
pub use texts::Requirements;

use super::record::HIDDEN;
use super::{Pace, Quality};
use crate::output::{self, Folder, OutputError};

/// The folder of the scripts in a job folder.
pub const SCRIPTS: &str = "scripts";

/// The program that distributes the frames to machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// Slurm.
    Slurm,
    /// A manager of render farms that reads Open Job Descriptions.
    OpenJd,
}

impl Engine {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Engine::Slurm => "slurm",
            Engine::OpenJd => "openjd",
        }
    }
}

/// A job folder that this process alone writes to.
pub struct JobFolder {
    folder: Folder,
}

/// The treatment of the files that users may edit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edits {
    /// Edited files that were kept.
    pub kept: Vec<&'static str>,
    /// The kept files that jabuka would now write differently. The new text is beside each, with the ending `.new`.
    pub new: Vec<&'static str>,
    /// Edited files that jabuka had to replace, each with its present name, as in `submit.old`.
    pub moved: Vec<(&'static str, String)>,
}

impl JobFolder {
    /// Opens a job folder: a new or empty one, or one that jabuka made.
    ///
    /// # Errors
    /// If the folder belongs to something else, another process writes to it, or it cannot be used.
    pub fn open(path: &Path) -> Result<JobFolder, OutputError> {
        let folder = Folder::open_marked(path, &|path| edits::Marks::read(path).is_some())?;
        let job = JobFolder { folder };
        // From the first moment on, the folder is marked as jabuka's.
        edits::Marks::read(path).unwrap_or_default().write(&job.folder)?;
        Ok(job)
    }

    /// The folder for its scripts, to be written like any other.
    ///
    /// # Errors
    /// If it cannot be used.
    pub fn scripts(&self) -> Result<Folder, OutputError> {
        Folder::open(&self.folder.path().join(SCRIPTS))
    }

    /// Writes everything but the scripts. No user's edit is lost.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(
        &self,
        settings: &Settings,
        engine: Engine,
        requirements: &Requirements,
    ) -> Result<Edits, OutputError> {
        let path = self.folder.path();
        // A log without a folder makes its job fail without a message.
        for folder in ["logs", "images", &format!("images/{HIDDEN}")] {
            let folder = path.join(folder);
            fs::create_dir_all(&folder).map_err(|error| OutputError::Io(folder, error))?;
        }
        edits::write(&self.folder, &texts::texts(settings, engine, requirements))
    }
}

/// The number of up-to-date images of a job folder, and the number of requested ones.
///
/// # Errors
/// If a file that the scripts read is missing.
pub fn up_to_date(folder: &Path) -> io::Result<(usize, usize)> {
    let status = super::status::Status::read(folder)?;
    Ok((status.done.len(), status.frames.len()))
}

/// The settings of a job for the scripts of a folder.
///
/// `frames` are the requested ones; `None` stands for all that have scripts. `video_rate` is the film's, if it is given.
///
/// # Errors
/// If the folder has no complete set of jabuka's scripts.
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
    // A blurred frame has two scripts but one image.
    frames.dedup();
    let blurred = fs::read_dir(scripts).map_err(|error| OutputError::Io(scripts.to_owned(), error))?;
    let blurred = blurred.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with("shutter_"));
    let last_frame = head.frames.saturating_sub(1);
    let number = frames.len();
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of frames")]
    let end = last_frame as f64 / head.frame_rate;
    Ok(Settings {
        job: job_name(&head.scene),
        frames,
        last_frame,
        end,
        digits: crate::emit::width(head.frames),
        pace: Pace::new(head.frame_rate, video_rate.or(head.video_rate)),
        video_quality: Quality::default(),
        chunk: chunk(number, 1),
        options,
        files: files(scripts)?,
        blurred,
        trust: false,
        limit: 3600,
    })
}

/// The files that all scripts read. Their names must be valid in the settings, where each takes up a line.
fn files(scripts: &Path) -> Result<Vec<String>, OutputError> {
    let files = super::files::of_scripts(scripts);
    let files = files.map_err(|error| OutputError::Io(scripts.to_owned(), error))?;
    if let Some(file) = files.iter().find(|file| file.contains(char::is_control)) {
        let why = "the settings of a job cannot hold a name with a line break or another control character";
        return Err(OutputError::Io(scripts.join(file), io::Error::new(io::ErrorKind::InvalidInput, why)));
    }
    Ok(files)
}

/// The name of a job for a scene. Commas, braces and other characters have a meaning for engines, so all but letters, digits
/// and `-_.` become `_`.
fn job_name(scene: &str) -> String {
    /// The limit of Open Job Description is 128.
    const MOST_CHARACTERS: usize = 100;
    let plain = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    let name: String = scene.chars().take(MOST_CHARACTERS).map(plain).collect();
    format!("jabuka-{name}")
}

/// The default number of frames in one job of an engine: few enough that a failure costs little, enough for all processors, and
/// at most 1000 jobs.
pub fn chunk(frames: usize, cpus: usize) -> usize {
    frames.div_ceil(1000).max(10).max(cpus.saturating_mul(4))
}
