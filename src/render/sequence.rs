//! The scripts of a film in their folder.

use std::path::{Path, PathBuf};

use super::RenderError;
use crate::emit::frame_name;
use crate::output::{Manifest, scripts};
use crate::scene::Timeline;
use crate::simulate::Selection;
use crate::system;

/// The scripts of all frames of a film, or of the selected ones.
#[derive(Clone, Debug)]
pub struct Sequence {
    /// The path of the folder as the user gave it, for messages.
    folder: PathBuf,
    /// The absolute path of the folder.
    absolute: PathBuf,
    scripts: Vec<Script>,
    /// The number of the film's last frame.
    pub last: usize,
    /// The times of the frames.
    pub timeline: Timeline,
    /// The number of frames per second of a film. `None` if the scene does not set one.
    pub video_rate: Option<f64>,
    /// The width and height of the images, pixels.
    pub size: [u32; 2],
    /// True if the images have an alpha channel.
    pub transparent: bool,
    /// The number of moments that each image is the mean of. `None` without motion blur.
    pub moments: Option<u32>,
    /// The simulated time of the only script, s, if the folder contains the script of a single moment, which may lie between two frames.
    /// `None` if each script shows its frame.
    pub moment: Option<f64>,
    /// The assets (images, height fields, fonts) that the scripts read.
    pub(super) assets: Vec<PathBuf>,
}

/// The script of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Script {
    /// The number of the frame.
    pub frame: usize,
    /// The name of the frame and of its image, without extension: `frame_0007`.
    pub name: String,
    /// The name of the script's file. For a frame with motion blur, this script contains all moments of the frame.
    pub file: String,
}

impl Sequence {
    /// Opens a folder of scripts. `selection` selects frames, `None` all of them.
    ///
    /// # Errors
    /// If the folder contains no scripts of jabuka's, or some of the requested ones are missing.
    pub fn open(folder: &Path, selection: Option<&Selection>) -> Result<Sequence, RenderError> {
        let found = scripts(folder).map_err(|error| match error {
            crate::output::OutputError::Io(path, error) => RenderError::io(path)(error),
            _ => RenderError::NoScripts(folder.to_owned()),
        })?;
        let found: Vec<_> = found.into_iter().filter(|(_, file)| file.starts_with("frame_")).collect();
        let absolute = system::canonicalize(folder).map_err(RenderError::io(folder))?;
        let manifest = Manifest::read(folder);
        if manifest.as_ref().is_some_and(|manifest| !manifest.is_complete()) {
            return Err(RenderError::Incomplete(folder.to_owned()));
        }
        let Some((last, _)) = found.last() else { return Err(RenderError::NoScripts(folder.to_owned())) };
        let last = manifest.as_ref().map_or(*last, |manifest| manifest.head.frames.saturating_sub(1));
        let moments = manifest.as_ref().and_then(|manifest| manifest.head.samples);
        let script = |(frame, file): &(usize, String)| {
            let name = file.trim_end_matches(".pov").to_owned();
            let file = match moments {
                Some(_) => file.replacen("frame_", "shutter_", 1),
                None => file.clone(),
            };
            Script { frame: *frame, name, file }
        };
        let wanted = found.iter().filter(|(frame, _)| selection.is_none_or(|s| s.contains(*frame)));
        let scripts: Vec<Script> = wanted.map(script).collect();
        if let Some(selection) =
            selection.filter(|s| s.count_within(last + 1) > scripts.len() || scripts.is_empty())
        {
            return Err(RenderError::NoSuchFrames(folder.to_owned(), selection.to_string()));
        }
        let assets = manifest.iter().flat_map(|manifest| &manifest.files);
        let assets = assets.filter(|file| file.name.starts_with("assets/"));
        let size = manifest.as_ref().and_then(|manifest| Some([manifest.head.width?, manifest.head.height?]));
        Ok(Sequence {
            scripts,
            last,
            timeline: manifest.as_ref().map_or_else(
                || Timeline { frame_rate: 25.0, ..Timeline::default() },
                |manifest| manifest.head.timeline(),
            ),
            video_rate: manifest.as_ref().and_then(|manifest| manifest.head.video_rate),
            size: size.unwrap_or([1280, 720]),
            transparent: manifest.as_ref().and_then(|manifest| manifest.head.transparent).unwrap_or(false),
            moments,
            moment: None,
            assets: assets.map(|file| absolute.join(&file.name)).collect(),
            folder: folder.to_owned(),
            absolute,
        })
    }

    /// Returns the folder of the scripts, as the user gave it.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the folder of the scripts, as an absolute path.
    pub(super) fn absolute(&self) -> &Path {
        &self.absolute
    }

    /// Returns the requested scripts, in the order of their frames.
    pub fn scripts(&self) -> &[Script] {
        &self.scripts
    }

    /// Returns the simulated time of a frame, s.
    pub fn time(&self, frame: usize) -> f64 {
        self.timeline.time(frame)
    }

    /// Returns true if a name such as `frame_0007` belongs to a frame of the film, requested or not.
    pub(super) fn has(&self, name: &str) -> bool {
        let number = name.strip_prefix("frame_").and_then(|digits| digits.parse().ok());
        let is = |number: usize| frame_name(number, self.last + 1) == format!("{name}.pov");
        number.is_some_and(|number| number <= self.last && is(number))
    }
}
