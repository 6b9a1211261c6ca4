//! The manifest: a JSON file that lists the files of an output folder, with data about their scene.

use std::io::{self, Write};
use std::path::{Component, Path};

use serde::{Deserialize, Deserializer, Serialize};
use sha2::{Digest, Sha256};

use super::folder;
use crate::Run;
use crate::diagnostic::Diagnostic;
use crate::run::RUN_WARNINGS;
use crate::scene::{Scene, Shutter, SpeedCurve, Timeline, is_possible_number_of_frames};
use crate::simulate::{EnergyScale, Survey};
use crate::system::Dir;

/// The file name of the manifest in an output folder.
pub const MANIFEST: &str = "manifest.json";

/// The name of the program that a manifest of jabuka's gives as its generator.
const GENERATOR: &str = "jabuka";

/// The size of the largest manifest that is read, bytes. It is enough for more than a million frames.
const MAX_BYTES: u64 = 512 << 20;

/// The manifest of an output folder: its files, and data about the scene that they belong to.
///
/// Anyone can change a manifest. It tells where to look for files, but never justifies removing or overwriting any.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifest {
    /// The data about the whole folder and its scene.
    pub head: Header,
    /// The files of the folder: first those of the whole sequence, then the scripts in the order of their frames. While scripts are being
    /// written, the list holds only the files that stay unchanged.
    pub files: Vec<Entry>,
}

impl Manifest {
    /// Reads the manifest of a folder. `None` if it is missing, is a symbolic link, comes from another program, or lists files outside of
    /// the folder.
    pub fn read(folder: &Path) -> Option<Manifest> {
        Manifest::of_dir(&Dir::of_path(folder).ok()?)
    }

    /// Reads the manifest of an open folder, as [`Manifest::read`] does.
    pub(crate) fn of_dir(folder: &Dir) -> Option<Manifest> {
        #[derive(Deserialize)]
        struct File {
            #[serde(flatten)]
            head: Header,
            #[serde(default)]
            files: Vec<Entry>,
        }
        let file: File = serde_json::from_reader(open(folder)?).ok()?;
        let ours = file.head.is_ours() && file.files.iter().all(Entry::is_inside);
        ours.then_some(Manifest { head: file.head, files: file.files })
    }

    /// Returns the warnings of the run that the scripts belong to.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        self.head.warnings.iter().filter_map(Warning::diagnostic).collect()
    }

    /// Returns true if all files of the folder have been written.
    pub fn is_complete(&self) -> bool {
        self.head.state == State::Complete
    }
}

/// A file in a manifest: its name, length and digest.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(from = "Line")]
pub struct Entry {
    /// The number of the frame, if the file is a script of a frame.
    pub frame: Option<usize>,
    /// The name of the file. For a file in a subfolder, its path with `/`.
    pub name: String,
    /// The length of the file in bytes.
    pub bytes: u64,
    /// The SHA-256 of the file's bytes.
    pub sha256: [u8; 32],
}

/// A file as the JSON of a manifest lists it.
#[derive(Deserialize)]
struct Line {
    name: String,
    bytes: u64,
    #[serde(deserialize_with = "digest")]
    sha256: [u8; 32],
}

impl From<Line> for Entry {
    fn from(line: Line) -> Entry {
        let Line { name, bytes, sha256 } = line;
        Entry { frame: folder::script_number(&name), name, bytes, sha256 }
    }
}

/// Reads a SHA-256 from 64 hexadecimal digits.
fn digest<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[u8; 32], D::Error> {
    let text = String::deserialize(deserializer)?;
    let wrong = || serde::de::Error::custom("not a SHA-256 in hexadecimal");
    if text.len() != 64 || !text.is_ascii() {
        return Err(wrong());
    }
    let mut digest = [0; 32];
    for (i, byte) in digest.iter_mut().enumerate() {
        *byte = u8::from_str_radix(&text[2 * i..2 * i + 2], 16).map_err(|_| wrong())?;
    }
    Ok(digest)
}

impl Entry {
    /// Makes the manifest entry of a file that consists of these bytes.
    pub(super) fn of(frame: Option<usize>, name: String, bytes: &[u8]) -> Entry {
        Entry { frame, name, bytes: bytes.len() as u64, sha256: Sha256::digest(bytes).into() }
    }

    /// Returns true if the name is a relative path that stays inside the folder.
    fn is_inside(&self) -> bool {
        let mut parts = Path::new(&self.name).components().peekable();
        parts.peek().is_some() && parts.all(|part| matches!(part, Component::Normal(_)))
    }

    /// Returns the SHA-256 in hexadecimal, as `sha256sum` prints it.
    pub fn hex(&self) -> String {
        self.sha256.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// A warning of a run, as the manifest stores it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// The name of the warning's diagnostic code, such as `energy-drift`.
    pub code: String,
    /// The message of the warning.
    pub message: String,
    /// Advice on how to avoid the warning.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub help: Option<String>,
}

impl Warning {
    fn of(diagnostic: Diagnostic) -> Warning {
        let Diagnostic { code, message, help, .. } = diagnostic;
        Warning { code: code.name().to_owned(), message, help }
    }

    /// Returns the warning as a diagnostic. `None` if no warning of a run has this code.
    fn diagnostic(&self) -> Option<Diagnostic> {
        let code = RUN_WARNINGS.into_iter().find(|code| code.name() == self.code)?;
        let warning = Diagnostic::warning(code, self.message.clone());
        Some(match &self.help {
            Some(help) => warning.help(help.clone()),
            None => warning,
        })
    }
}

/// How far the writing of an output folder has progressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// Scripts of another scene are being removed, and some may remain.
    Clearing,
    /// All scripts belong to this scene, but some may be missing.
    Writing,
    /// All files have been written.
    Complete,
}

/// The header of a manifest: all of its data except the list of files. Fields that were added after the first version are optional, so
/// that old manifests can be read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// The name of the program that wrote the manifest.
    pub(super) generator: String,
    /// The version of the program that wrote the manifest.
    pub version: String,
    /// A digest of the program's source code. A program from other source code may write other scripts for the same scene.
    #[serde(default)]
    pub build: String,
    /// How far the writing of the folder has progressed.
    pub state: State,
    /// The name of the scene.
    pub scene: String,
    /// The name of the view whose camera the scripts use. `None` for the scene's main camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// The values of the scene that were replaced on the command line, such as `simulation.step=0.001`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// The digest of the texts that the scene was read from.
    pub digest: String,
    /// The number of the scene's frames. The folder may contain scripts of only some frames.
    pub frames: usize,
    /// The number of frames per second of simulated time.
    pub frame_rate: f64,
    /// The speed of the film against simulated time.
    #[serde(default, skip_serializing_if = "SpeedCurve::is_even")]
    pub speed: SpeedCurve,
    /// The duration of the simulation, s, if the film has a speed of its own. Its last frame shows the end of the simulation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// The number of frames per second of a film. `None` if the scene does not set one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video_rate: Option<f64>,
    /// The width of the images, pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<u32>,
    /// The height of the images, pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<u32>,
    /// True if the images have an alpha channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transparent: Option<bool>,
    /// The exposure time of an image with motion blur, s. `None` without motion blur.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shutter: Option<f64>,
    /// The number of moments that an image with motion blur is the mean of. `None` without motion blur.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u32>,
    /// The largest energy error of the run, relative to the energy that `drift_scale` names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drift: Option<f64>,
    /// The energy that the drift is relative to. Manifests leave out the largest kinetic energy, which is the usual scale.
    #[serde(default, skip_serializing_if = "EnergyScale::is_largest_kinetic")]
    pub drift_scale: EnergyScale,
    /// The warnings of the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// The selection of frames whose scripts are being written. `None` once all files have been written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub planned: Option<String>,
}

impl Header {
    /// Makes the header for a folder that contains all files of a run.
    pub(super) fn new(run: &Run<'_>) -> Header {
        let head = Header::of(run.scene(), run.view(), run.shutter());
        let warnings = run.warnings().into_iter().map(Warning::of).collect();
        let Survey { drift, drift_scale, .. } = run.survey();
        Header { drift: Some(*drift), drift_scale: *drift_scale, warnings, ..head }
    }

    /// Makes a header from the scene alone, without the energy error and the warnings of its run.
    pub(super) fn of(scene: &Scene, view: Option<&str>, shutter: Option<Shutter>) -> Header {
        let timeline = &scene.simulation.timeline;
        Header {
            generator: GENERATOR.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            build: env!("JABUKA_BUILD").to_owned(),
            state: State::Complete,
            scene: scene.name.clone(),
            view: view.map(str::to_owned),
            set: scene.overrides.clone(),
            digest: scene.digest.clone(),
            frames: timeline.frames(),
            frame_rate: timeline.frame_rate,
            speed: timeline.speed.clone(),
            duration: (!timeline.speed.is_even()).then_some(timeline.duration),
            video_rate: scene.output.video_rate,
            width: Some(scene.output.width),
            height: Some(scene.output.height),
            transparent: Some(scene.output.transparent),
            shutter: shutter.map(|shutter| shutter.open),
            samples: shutter.map(|shutter| shutter.samples),
            drift: None,
            drift_scale: EnergyScale::default(),
            warnings: Vec::new(),
            planned: None,
        }
    }

    /// Returns the times of the frames.
    pub fn timeline(&self) -> Timeline {
        let duration = self.duration.unwrap_or_default();
        Timeline { duration, frame_rate: self.frame_rate, speed: self.speed.clone() }
    }

    /// Returns true if jabuka can have written the header. Impossible numbers are refused, since a huge number of frames would make
    /// readers count forever.
    fn is_ours(&self) -> bool {
        self.generator == GENERATOR
            && is_possible_number_of_frames(self.frames)
            && self.frame_rate.is_finite()
            && self.frame_rate > 0.0
    }

    /// Returns true if both headers have the same program, scene and view, so that jabuka would write the same scripts now.
    pub(super) fn is_of(&self, other: &Header) -> bool {
        let what = |head: &Header| [head.version.clone(), head.build.clone(), head.digest.clone()];
        self.state != State::Clearing && what(self) == what(other) && self.view == other.view
    }
}

/// Reads the header of a folder's manifest. `None` if the file is missing, is a symbolic link, or comes from another program.
pub(crate) fn read(folder: &Dir) -> Option<Header> {
    let head: Header = serde_json::from_reader(open(folder)?).ok()?;
    head.is_ours().then_some(head)
}

/// Reads the header of the manifest of the folder at a path, as [`read`] does.
pub(crate) fn header_of(folder: &Path) -> Option<Header> {
    read(&Dir::of_path(folder).ok()?)
}

/// Opens a manifest. `None` unless it is a regular file of a plausible size.
fn open(folder: &Dir) -> Option<impl io::Read> {
    let file = folder.open_file(MANIFEST).ok()?;
    let is_sensible = file.metadata().ok()?.len() <= MAX_BYTES;
    is_sensible.then(|| io::BufReader::new(file))
}

/// Writes a manifest as JSON, with one line for each file.
pub(super) fn write(out: &mut impl Write, head: &Header, entries: &[Entry]) -> io::Result<()> {
    write_each(out, head, entries.iter().cloned().map(Ok))
}

/// Writes a manifest as JSON. The entries come from an iterator, so that the whole list need not be in memory.
pub(super) fn write_each(
    out: &mut impl Write,
    head: &Header,
    entries: impl Iterator<Item = io::Result<Entry>>,
) -> io::Result<()> {
    let text = serde_json::to_string_pretty(head)?;
    // The list of files goes before the closing brace of the header's JSON.
    let open = text.strip_suffix("\n}").unwrap_or(&text);
    write!(out, "{open},\n  \"files\": [")?;
    for (i, entry) in entries.enumerate() {
        let entry = entry?;
        let comma = if i == 0 { "" } else { "," };
        // The file names of assets are arbitrary, so they may need escapes.
        let name = serde_json::to_string(&entry.name)?;
        let (bytes, digest) = (entry.bytes, entry.hex());
        write!(out, "{comma}\n    {{ \"name\": {name}, \"bytes\": {bytes}, \"sha256\": \"{digest}\" }}")?;
    }
    writeln!(out, "\n  ]\n}}")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::Scene;

    fn head() -> Header {
        let scene = Scene::parse("[body.ball]\nshape.sphere.radius = 1").unwrap();
        Header::new(&Run::new(&scene).unwrap())
    }

    /// Makes a temporary folder that contains a manifest with these entries. `change` edits the text of the manifest.
    fn folder(entries: &[Entry], change: impl Fn(String) -> String) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let mut text = Vec::new();
        write(&mut text, &head(), entries).unwrap();
        fs::write(folder.path().join(MANIFEST), change(String::from_utf8(text).unwrap())).unwrap();
        folder
    }

    #[test]
    fn what_was_written_is_read() {
        let entries = [
            Entry::of(None, "animation.ini".to_owned(), b"; all"),
            Entry::of(None, "assets/a \"b\".png".to_owned(), b"..."),
            Entry::of(Some(7), "frame_0007.pov".to_owned(), b"// frame 7"),
        ];
        let manifest = Manifest::read(folder(&entries, |text| text).path()).unwrap();
        assert_eq!(manifest, Manifest { head: head(), files: entries.to_vec() });
        assert!(manifest.is_complete());
        let Header { width, height, transparent, frame_rate, .. } = manifest.head;
        assert_eq!((width, height, transparent, frame_rate), (Some(1280), Some(720), Some(false), 25.0));
    }

    #[test]
    fn a_manifest_of_an_older_version_is_read() {
        let lines = ["\"width\"", "\"height\"", "\"transparent\""];
        let without = |text: String| {
            text.lines().filter(|line| !lines.iter().any(|key| line.contains(key))).collect::<String>()
        };
        let manifest = Manifest::read(folder(&[], without).path()).unwrap();
        assert_eq!(manifest.head, Header { width: None, height: None, transparent: None, ..head() });
    }

    #[test]
    fn what_is_not_ours_or_leads_out_of_the_folder_is_none() {
        let entries = [Entry::of(Some(0), "frame_0000.pov".to_owned(), b"")];
        assert!(Manifest::read(folder(&entries, |text| text).path()).is_some());
        for (from, to) in [
            ("\"generator\": \"jabuka\"", "\"generator\": \"another\""),
            ("frame_0000.pov", "../frame_0000.pov"),
            ("frame_0000.pov", "/etc/passwd"),
            ("frame_0000.pov", ""),
            ("\"sha256\": \"e", "\"sha256\": \"x"),
        ] {
            let changed = |text: String| {
                assert!(text.contains(from), "{text}");
                text.replace(from, to)
            };
            assert_eq!(Manifest::read(folder(&entries, changed).path()), None, "{to}");
        }
        assert_eq!(Manifest::read(tempfile::tempdir().unwrap().path()), None);
    }
}
