//! The manifest: the contents of an output folder, and their scene.

use std::fs;
use std::io::{self, Write};
use std::path::{Component, Path};

use serde::{Deserialize, Deserializer, Serialize};
use sha2::{Digest, Sha256};

use super::folder;
use crate::Run;
use crate::diagnostic::Diagnostic;
use crate::run::RUN_WARNINGS;
use crate::scene::{Scene, Shutter, is_possible_number_of_frames};

/// The name of the manifest in its folder.
pub const MANIFEST: &str = "manifest.json";

/// The name of jabuka in a manifest.
const GENERATOR: &str = "jabuka";

/// The largest manifest that is read, bytes: enough for more than a million frames.
const MAX_BYTES: u64 = 512 << 20;

/// The contents of an output folder, and the scene that they belong to.
///
/// Everything in a manifest comes from a file that anyone can change: it tells where to look, but never justifies removing or
/// overwriting anything.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifest {
    /// The data of the folder as a whole.
    pub head: Head,
    /// The files: first those of the whole sequence, then the scripts in the order of their frames. While some are being
    /// written, only the files that stay as they are.
    pub files: Vec<Entry>,
}

impl Manifest {
    /// Reads the manifest of a folder; `None` if there is none, if it is not ours, if it is a link, or if it lists
    /// files that are not in the folder.
    pub fn read(folder: &Path) -> Option<Manifest> {
        #[derive(Deserialize)]
        struct File {
            #[serde(flatten)]
            head: Head,
            #[serde(default)]
            files: Vec<Entry>,
        }
        let file: File = serde_json::from_reader(open(&folder.join(MANIFEST))?).ok()?;
        let ours = file.head.is_ours() && file.files.iter().all(Entry::is_inside);
        ours.then_some(Manifest { head: file.head, files: file.files })
    }

    /// The warnings of the run that the scripts belong to.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        self.head.warnings.iter().filter_map(Warning::diagnostic).collect()
    }

    /// Whether all files have been written.
    pub fn is_complete(&self) -> bool {
        self.head.state == State::Complete
    }
}

/// A file of an output folder.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(from = "Line")]
pub struct Entry {
    /// The number of the frame, for a script.
    pub frame: Option<usize>,
    /// Its name; for a file in a subfolder, its path with `/`.
    pub name: String,
    /// Its length in bytes.
    pub bytes: u64,
    /// The SHA-256 of its bytes.
    pub sha256: [u8; 32],
}

/// A file as a manifest lists it.
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

/// A digest in hexadecimal.
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
    /// The entry of a file that holds these bytes.
    pub(super) fn of(frame: Option<usize>, name: String, bytes: &[u8]) -> Entry {
        Entry { frame, name, bytes: bytes.len() as u64, sha256: Sha256::digest(bytes).into() }
    }

    /// Whether its name is a path that stays in the folder.
    fn is_inside(&self) -> bool {
        let mut parts = Path::new(&self.name).components().peekable();
        parts.peek().is_some() && parts.all(|part| matches!(part, Component::Normal(_)))
    }

    /// Its digest in hexadecimal, as `sha256sum` prints it.
    pub fn hex(&self) -> String {
        self.sha256.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// A warning of a run, as a manifest keeps it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// The kind of warning: `energy-drift`.
    pub code: String,
    /// The message.
    pub message: String,
    /// A suggestion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub help: Option<String>,
}

impl Warning {
    fn of(diagnostic: Diagnostic) -> Warning {
        let Diagnostic { code, message, help, .. } = diagnostic;
        Warning { code: code.name().to_owned(), message, help }
    }

    /// The warning, to be reported again; `None` for an unknown code.
    fn diagnostic(&self) -> Option<Diagnostic> {
        let code = RUN_WARNINGS.into_iter().find(|code| code.name() == self.code)?;
        let warning = Diagnostic::warning(code, self.message.clone());
        Some(match &self.help {
            Some(help) => warning.help(help.clone()),
            None => warning,
        })
    }
}

/// The progress of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// Files of another scene may be there.
    Clearing,
    /// All files are of this scene; some may be missing.
    Writing,
    /// All files are there.
    Complete,
}

/// The head of a manifest: everything but its list of files. Fields added since the first version are optional, so that old
/// manifests can be read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// The program that wrote it.
    pub(super) generator: String,
    /// The version of that program.
    pub version: String,
    /// A digest of its sources: a program from other sources may write other scripts of the same scene.
    #[serde(default)]
    pub build: String,
    /// The progress of the folder.
    pub state: State,
    /// The name of the scene.
    pub scene: String,
    /// The view that shows the scene; absent for the main camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// The values of the scene that were replaced: `simulation.step=0.001`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// The digest of the texts that the scene was read from.
    pub digest: String,
    /// The number of the scene's frames; the folder may hold only some of them.
    pub frames: usize,
    /// Frames per second.
    pub frame_rate: f64,
    /// Frames per second of a film, if the scene gives it a rate of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video_rate: Option<f64>,
    /// The width of the images, pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<u32>,
    /// The height of the images, pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<u32>,
    /// Whether the images have alpha.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transparent: Option<bool>,
    /// The time for which the shutter is open, s, if images have motion blur and there are `shutter_` scripts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shutter: Option<f64>,
    /// The number of moments in each of those scripts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u32>,
    /// The energy error, relative to the largest kinetic energy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drift: Option<f64>,
    /// The warnings of the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// While writing: the frames being written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub planned: Option<String>,
}

impl Head {
    /// The head of a folder that holds all files of a run.
    pub(super) fn new(run: &Run<'_>) -> Head {
        let head = Head::of(run.scene(), run.view(), run.shutter());
        let warnings = run.warnings().into_iter().map(Warning::of).collect();
        Head { drift: Some(run.survey().drift), warnings, ..head }
    }

    /// The part that needs no run of the scene.
    pub(super) fn of(scene: &Scene, view: Option<&str>, shutter: Option<Shutter>) -> Head {
        Head {
            generator: GENERATOR.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            build: env!("JABUKA_BUILD").to_owned(),
            state: State::Complete,
            scene: scene.name.clone(),
            view: view.map(str::to_owned),
            set: scene.overrides.clone(),
            digest: scene.digest.clone(),
            frames: scene.simulation.frames(),
            frame_rate: scene.simulation.frame_rate,
            video_rate: scene.output.video_rate,
            width: Some(scene.output.width),
            height: Some(scene.output.height),
            transparent: Some(scene.output.transparent),
            shutter: shutter.map(|shutter| shutter.open),
            samples: shutter.map(|shutter| shutter.samples),
            drift: None,
            warnings: Vec::new(),
            planned: None,
        }
    }

    /// Whether jabuka can have written it. Impossible numbers would make readers count without end.
    fn is_ours(&self) -> bool {
        self.generator == GENERATOR
            && is_possible_number_of_frames(self.frames)
            && self.frame_rate.is_finite()
            && self.frame_rate > 0.0
    }

    /// Whether all files of a folder with this manifest are as jabuka would write them now.
    pub(super) fn is_of(&self, other: &Head) -> bool {
        let what = |head: &Head| [head.version.clone(), head.build.clone(), head.digest.clone()];
        self.state != State::Clearing && what(self) == what(other) && self.view == other.view
    }
}

/// Reads the head of a manifest; `None` if there is none, if it is not ours, or if it is a link.
pub(crate) fn read(path: &Path) -> Option<Head> {
    let head: Head = serde_json::from_reader(open(path)?).ok()?;
    head.is_ours().then_some(head)
}

/// Opens a manifest if it is a regular file of a plausible size, and not a link.
fn open(path: &Path) -> Option<impl io::Read> {
    let metadata = fs::symlink_metadata(path).ok()?;
    let sensible = metadata.is_file() && metadata.len() <= MAX_BYTES;
    sensible.then(|| fs::File::open(path).ok().map(io::BufReader::new))?
}

/// Writes a manifest, with one line for each file.
pub(super) fn write(out: &mut impl Write, head: &Head, entries: &[Entry]) -> io::Result<()> {
    write_each(out, head, entries.iter().cloned().map(Ok))
}

/// Writes a manifest whose list of files is not in memory as a whole.
pub(super) fn write_each(
    out: &mut impl Write,
    head: &Head,
    entries: impl Iterator<Item = io::Result<Entry>>,
) -> io::Result<()> {
    let text = serde_json::to_string_pretty(head)?;
    // The list of files goes before the closing brace.
    let open = text.strip_suffix("\n}").unwrap_or(&text);
    write!(out, "{open},\n  \"files\": [")?;
    for (i, entry) in entries.enumerate() {
        let entry = entry?;
        let comma = if i == 0 { "" } else { "," };
        // A name chosen by somebody else may need escapes.
        let name = serde_json::to_string(&entry.name)?;
        let (bytes, digest) = (entry.bytes, entry.hex());
        write!(out, "{comma}\n    {{ \"name\": {name}, \"bytes\": {bytes}, \"sha256\": \"{digest}\" }}")?;
    }
    writeln!(out, "\n  ]\n}}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    fn head() -> Head {
        let scene = Scene::parse("[body.ball]\nshape.sphere.radius = 1").unwrap();
        Head::new(&Run::new(&scene).unwrap())
    }

    /// A folder with a manifest of these entries, whose text is changed.
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
        let Head { width, height, transparent, frame_rate, .. } = manifest.head;
        assert_eq!((width, height, transparent, frame_rate), (Some(1280), Some(720), Some(false), 25.0));
    }

    #[test]
    fn a_manifest_of_an_older_version_is_read() {
        let lines = ["\"width\"", "\"height\"", "\"transparent\""];
        let without = |text: String| {
            text.lines().filter(|line| !lines.iter().any(|key| line.contains(key))).collect::<String>()
        };
        let manifest = Manifest::read(folder(&[], without).path()).unwrap();
        assert_eq!(manifest.head, Head { width: None, height: None, transparent: None, ..head() });
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
