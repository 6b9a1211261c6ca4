//! Remembers which folders jabuka has made on this machine, for this user.
//!
//! What a folder says about itself, such as its manifest, can come from anyone. So jabuka keeps a note of each folder that it makes or finds
//! empty, outside of that folder: in `jabuka/made-here` below `XDG_STATE_HOME` or `~/.local/state`; on Windows, below `%LOCALAPPDATA%`. The name
//! of the note is the digest of the folder's identity: its inode and the time when it was made. A folder that was unpacked, copied or
//! downloaded has another identity. What has changed since in a folder with a note was changed here, by the user.

use std::env;
use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::Dir;
use sha2::{Digest, Sha256};

/// The number of notes from which on those of removed folders are deleted.
const MAX_NOTES_WITHOUT_CLEANUP: usize = 10_000;

/// Returns true if jabuka has noted that it made this folder.
pub(crate) fn is_noted(folder: &Dir) -> bool {
    let found = || Dir::open(&place()?).ok()?.about(name(folder)?).ok()?;
    found().is_some()
}

/// Notes that jabuka has made this folder. If the note cannot be written, the folder will count as made elsewhere.
pub(crate) fn note(folder: &Dir) {
    let write = || -> Option<()> {
        let notes = Dir::make(&place()?).ok()?;
        let names = notes.names().ok()?;
        if names.len() >= MAX_NOTES_WITHOUT_CLEANUP {
            names.iter().for_each(|name| forget_if_gone(&notes, name));
        }
        let mut file = notes.create(name(folder)?).ok()?;
        let path = std::path::absolute(folder.path()).ok()?;
        file.write_all(path.as_os_str().as_encoded_bytes()).ok()
    };
    let _: Option<()> = write();
}

/// Removes the note of a folder that is no longer at its path.
fn forget_if_gone(notes: &Dir, note: &OsString) {
    let of = |path: String| name(&Dir::open(Path::new(&path)).ok()?);
    let is_there =
        notes.read_to_string(note).ok().and_then(of).is_some_and(|name| OsString::from(name) == *note);
    if !is_there {
        // If the note cannot be removed, the next process tries again.
        let _ = notes.remove_file(note);
    }
}

/// Returns the folder of the notes.
fn place() -> Option<PathBuf> {
    if cfg!(test) {
        return Some(env::temp_dir().join("jabuka-tests/made-here"));
    }
    let state = super::state_folder().filter(|path| path.is_absolute());
    Some(state?.join("jabuka").join("made-here"))
}

/// Returns the name of a folder's note.
fn name(folder: &Dir) -> Option<String> {
    let digest = Sha256::digest(folder.identity().ok()?);
    Some(digest.iter().take(16).map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_known_wherever_it_is_moved_and_no_other_in_its_place() {
        let place = tempfile::tempdir().unwrap();
        let at = |name: &str| place.path().join(name);
        let made = Dir::make(&at("made")).unwrap();
        assert!(!is_noted(&made));
        note(&made);
        assert!(is_noted(&made) && is_noted(&Dir::open(&at("made")).unwrap()));
        std::fs::rename(at("made"), at("moved")).unwrap();
        assert!(!is_noted(&Dir::make(&at("made")).unwrap()));
        assert!(is_noted(&Dir::open(&at("moved")).unwrap()));
    }
}
