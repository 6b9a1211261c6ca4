//! The manifest: what an output folder holds, and of which scene.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::Run;

/// The name of the manifest in its folder.
pub const MANIFEST: &str = "manifest.json";

/// What jabuka calls itself in a manifest.
const GENERATOR: &str = "jabuka";

/// A file of an output folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Of a script, the number of its frame.
    pub frame: Option<usize>,
    /// Its name.
    pub name: String,
    /// Its length in bytes.
    pub bytes: u64,
    /// The SHA-256 of its bytes.
    pub sha256: [u8; 32],
}

impl Entry {
    /// The entry of a file that holds these bytes.
    pub(super) fn of(frame: Option<usize>, name: String, bytes: &[u8]) -> Entry {
        Entry { frame, name, bytes: bytes.len() as u64, sha256: Sha256::digest(bytes).into() }
    }
}

/// How far a folder is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum State {
    /// Files of another scene may be there.
    Clearing,
    /// All files are of this scene; some may be missing.
    Writing,
    /// All files are there.
    Complete,
}

/// The head of a manifest: all but its list of files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Head {
    pub(super) generator: String,
    pub(super) version: String,
    pub(crate) state: State,
    /// The name of the scene.
    pub(crate) scene: String,
    /// The view that sees the scene; absent for the main camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) view: Option<String>,
    /// The digest of the texts that the scene was read from.
    pub(super) digest: String,
    /// The number of the scene's frames.
    pub(crate) frames: usize,
    pub(crate) frame_rate: f64,
    /// While writing: the frames that are being written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) planned: Option<String>,
}

impl Head {
    pub(super) fn new(run: &Run<'_>) -> Head {
        let scene = run.scene();
        Head {
            generator: GENERATOR.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            state: State::Complete,
            scene: scene.name.clone(),
            view: run.view().map(str::to_owned),
            digest: scene.digest.clone(),
            frames: scene.simulation.frames(),
            frame_rate: scene.simulation.frame_rate,
            planned: None,
        }
    }

    /// Whether all files of a folder with this manifest are as jabuka would write them now.
    pub(super) fn is_of(&self, other: &Head) -> bool {
        let what = |head: &Head| (head.version.clone(), head.view.clone(), head.digest.clone());
        self.state != State::Clearing && what(self) == what(other)
    }
}

/// Reads the head of a manifest; `None` if there is none, if it is not ours, or if it is a link.
pub(crate) fn read(path: &Path) -> Option<Head> {
    /// More than a million frames need.
    const MAX_BYTES: u64 = 512 << 20;
    let metadata = fs::symlink_metadata(path).ok()?;
    if !metadata.is_file() || metadata.len() > MAX_BYTES {
        return None;
    }
    let head: Head = serde_json::from_reader(io::BufReader::new(fs::File::open(path).ok()?)).ok()?;
    (head.generator == GENERATOR).then_some(head)
}

/// Writes a manifest, one line a file.
pub(super) fn write(out: &mut impl Write, head: &Head, entries: &[Entry]) -> io::Result<()> {
    let text = serde_json::to_string_pretty(head)?;
    // The list of files goes before the closing brace.
    let open = text.strip_suffix("\n}").unwrap_or(&text);
    write!(out, "{open},\n  \"files\": [")?;
    for (i, entry) in entries.iter().enumerate() {
        let comma = if i == 0 { "" } else { "," };
        write!(
            out,
            "{comma}\n    {{ \"name\": \"{}\", \"bytes\": {}, \"sha256\": \"",
            entry.name, entry.bytes
        )?;
        for byte in entry.sha256 {
            write!(out, "{byte:02x}")?;
        }
        write!(out, "\" }}")?;
    }
    writeln!(out, "\n  ]\n}}")
}
