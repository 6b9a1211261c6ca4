//! Renames files that a user has edited since jabuka wrote them, before jabuka writes these files anew.

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::manifest::Entry;
use super::{DigestWriter, Folder, OutputError};
use crate::diagnostic::{Code, Diagnostic};
use crate::emit::ASSETS;
use crate::system::{Dir, FolderError, Kind};

/// An edited file that was renamed, so that jabuka can write the file anew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SetAside {
    /// The original name of the file in the folder.
    name: String,
    /// The new name of the edited file in the folder.
    now: String,
}

impl Folder {
    /// Renames the edited files among those that are about to be rewritten or removed. A file counts as edited if it differs from its
    /// entry in the manifest.
    ///
    /// # Errors
    /// If a file cannot be read or renamed; if the folder was not made here, so that its manifest proves nothing, and a file differs.
    pub(crate) fn set_aside<'a>(&self, files: impl Iterator<Item = &'a Entry>) -> Result<(), OutputError> {
        let files: Vec<&Entry> = files.collect();
        let is_edited = |entry: &&Entry| is_edited(self.dir(), entry);
        let edited: Vec<bool> = files.par_iter().map(is_edited).collect::<Result<_, _>>()?;
        let edited: Vec<&Entry> =
            files.into_iter().zip(edited).filter_map(|(entry, edited)| edited.then_some(entry)).collect();
        if !self.is_made_here() && !edited.is_empty() {
            let names = edited.iter().map(|entry| entry.name.clone()).collect();
            return Err(OutputError::FromElsewhere(self.path().to_owned(), names));
        }
        for entry in edited {
            let file = move_aside(self.dir(), &entry.name)?;
            self.lock_set_aside().push(file);
        }
        Ok(())
    }

    /// Removes each renamed file that equals the file written anew under the original name. With `same_scene`, renamed files whose
    /// originals were not written anew get their original names back.
    ///
    /// # Errors
    /// If a file cannot be removed or renamed.
    pub(crate) fn settle(&self, same_scene: bool) -> Result<(), OutputError> {
        let mut set_aside = self.lock_set_aside();
        for file in std::mem::take(&mut *set_aside) {
            if same_scene && self.dir().about(&file.name)?.is_none() {
                self.dir().rename(&file.now, self.dir(), &file.name)?;
                continue;
            }
            let same = || Ok::<_, FolderError>(self.dir().read(&file.now)? == self.dir().read(&file.name)?);
            // A file that cannot be compared stays under its new name.
            if same().unwrap_or(false) {
                self.dir().remove_file(&file.now)?;
            } else {
                set_aside.push(file);
            }
        }
        Ok(())
    }

    /// Returns a warning that names the first edited files that were renamed. `None` if no file was edited.
    pub fn edits(&self) -> Option<Diagnostic> {
        /// The largest number of files that the warning names.
        const MAX_LISTED_FILES: usize = 3;
        let set_aside = self.lock_set_aside();
        let moves = set_aside
            .iter()
            .take(MAX_LISTED_FILES)
            .map(|SetAside { name, now }| format!("`{name}` is now `{now}`"));
        let moves = moves.collect::<Vec<_>>().join(", ");
        let others = match set_aside.len().saturating_sub(MAX_LISTED_FILES) {
            0 => String::new(),
            others => format!(", and {others} more"),
        };
        let files = match set_aside.len() {
            0 => return None,
            1 => "a file was".to_owned(),
            files => format!("{files} files were"),
        };
        let message = format!("{files} edited in `{}` and kept: {moves}{others}", self.path().display());
        let help = "what the scene gives stands in their place; `jabuka render DIR` renders edited scripts as they are";
        Some(Diagnostic::warning(Code::EditedScript, message).help(help))
    }
}

/// Returns true if a regular file exists and differs from its entry in the manifest.
fn is_edited(dir: &Dir, entry: &Entry) -> Result<bool, FolderError> {
    match dir.about(&entry.name)? {
        None => Ok(false),
        // A symbolic link is replaced, which leaves its target unchanged.
        Some(found) if found.kind != Kind::File => Ok(false),
        Some(found) if found.bytes != entry.bytes => Ok(true),
        Some(_) => {
            let read = DigestWriter::of(dir.open_file(&entry.name)?);
            let read = read.map_err(|error| FolderError::Io(dir.path().join(&entry.name), error))?;
            Ok(read.entry(entry.frame, entry.name.clone()) != *entry)
        }
    }
}

/// Renames an edited file of a folder: `frame_0002.pov` becomes `frame_0002.edited.pov`, with a number if that name is taken.
fn move_aside(dir: &Dir, name: &str) -> Result<SetAside, FolderError> {
    // Scripts can read every file in the folder of assets, so edited assets go to a folder beside it.
    let in_assets = name.strip_prefix(ASSETS).and_then(|name| name.strip_prefix('/'));
    let now = match in_assets {
        Some(name) => format!("{ASSETS}.edited/{name}"),
        None => between(name, ".edited"),
    };
    if let Some((folder, _)) = now.rsplit_once('/') {
        dir.make_folder(folder)?;
    }
    let now = free_name(dir, &now)?;
    dir.rename(name, dir, &now)?;
    Ok(SetAside { name: name.to_owned(), now })
}

/// Inserts a text before the extension of a file name.
fn between(name: &str, inserted: &str) -> String {
    match name.rsplit_once('.') {
        Some((stem, ending)) => format!("{stem}{inserted}.{ending}"),
        None => format!("{name}{inserted}"),
    }
}

/// Returns a name that no file in the folder has: the given name, or that name with a number, as in `submit-2.old`.
pub(crate) fn free_name(dir: &Dir, name: &str) -> Result<String, FolderError> {
    let mut free = name.to_owned();
    let mut number = 2_u64;
    while dir.about(&free)?.is_some() {
        free = between(name, &format!("-{number}"));
        number += 1;
    }
    Ok(free)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn entry(name: &str, bytes: &[u8]) -> Entry {
        Entry::of(None, name.to_owned(), bytes)
    }

    #[test]
    fn an_edited_file_is_set_aside_under_a_name_that_is_free() {
        let temporary = tempfile::tempdir().unwrap();
        let folder = Folder::open(temporary.path()).unwrap();
        let at = |name: &str| temporary.path().join(name);
        fs::create_dir(at("assets")).unwrap();
        let entries =
            ["frame_0002.pov", "frame_0003.pov", "gone.pov", "assets/a.png"].map(|name| entry(name, b"ours"));
        for name in ["frame_0002.pov", "assets/a.png"] {
            // The length equals that of jabuka's file, so that only the bytes differ.
            fs::write(at(name), "mine").unwrap();
        }
        fs::write(at("frame_0003.pov"), "ours").unwrap();
        let now = || folder.lock_set_aside().iter().map(|file| file.now.clone()).collect::<Vec<_>>();
        folder.set_aside(entries.iter()).unwrap();
        assert_eq!(now(), ["frame_0002.edited.pov", "assets.edited/a.png"]);
        assert!(!at("frame_0002.pov").exists() && at("frame_0003.pov").exists());
        fs::write(at("frame_0002.pov"), "mine, once more").unwrap();
        folder.set_aside(entries.iter()).unwrap();
        assert_eq!(now().last().unwrap(), "frame_0002.edited-2.pov");
        assert_eq!(fs::read_to_string(at("frame_0002.edited.pov")).unwrap(), "mine");
        let said = folder.edits().unwrap().message;
        assert!(said.starts_with("3 files were edited in `"), "{said}");
    }

    #[test]
    fn an_edit_that_is_what_the_scene_gives_now_is_none() {
        let temporary = tempfile::tempdir().unwrap();
        let folder = Folder::open(temporary.path()).unwrap();
        let path = temporary.path().join("frame_0002.pov");
        fs::write(&path, "new").unwrap();
        folder.set_aside([entry("frame_0002.pov", b"old")].iter()).unwrap();
        fs::write(&path, "new").unwrap();
        folder.settle(false).unwrap();
        assert!(folder.edits().is_none());
        assert!(!temporary.path().join("frame_0002.edited.pov").exists());
    }
}
