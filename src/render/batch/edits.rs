//! Writes the files of a job folder that users may edit, without losing their edits.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::Edits;
use super::texts::Text;
use crate::output::{self, Folder, OutputError};
use crate::system::{self, Dir, Kind};

/// The name of the file that marks a folder as one of jabuka's job folders. It contains the digests of the files as jabuka wrote them.
const DIGESTS_FILE: &str = ".jabuka-job.json";

/// The name of the program that the file of digests gives as its generator.
const GENERATOR: &str = "jabuka";

/// The files of a job folder that its scripts or an engine read, and that users may edit. Jabuka keeps such a file if it differs from what
/// jabuka writes.
const EDITABLE_FILES: [&str; 9] = [
    "local.conf",
    "render.sbatch",
    "video.sbatch",
    "template.yaml",
    "template.json",
    "asset_references.yaml",
    "asset_references.json",
    "parameter_values.yaml",
    "parameter_values.json",
];

/// The digests of the files that jabuka wrote into a job folder. A file with another digest was edited.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct WrittenDigests {
    generator: String,
    /// The SHA-256 of each file in hexadecimal, by file name.
    files: BTreeMap<String, String>,
}

impl Default for WrittenDigests {
    fn default() -> WrittenDigests {
        WrittenDigests { generator: GENERATOR.to_owned(), files: BTreeMap::new() }
    }
}

impl WrittenDigests {
    /// Reads the digests of the files in a job folder. `None` if jabuka did not make the folder.
    pub(super) fn read(folder: &Dir) -> Option<WrittenDigests> {
        let marks: WrittenDigests = serde_json::from_slice(&folder.read(DIGESTS_FILE).ok()?).ok()?;
        (marks.generator == GENERATOR).then_some(marks)
    }

    pub(super) fn write(&self, folder: &Folder) -> Result<(), OutputError> {
        let text = serde_json::to_string_pretty(self).unwrap_or_default();
        folder.write(DIGESTS_FILE, format!("{text}\n").as_bytes())
    }
}

/// Returns the files of a job folder that its scripts or an engine would use, and that jabuka would keep as edited by the user. In a folder that
/// was not made here, they can be anyone's.
pub(super) fn strangers(folder: &Folder, texts: &[Text]) -> Result<Vec<String>, OutputError> {
    let mut found = Vec::new();
    for name in EDITABLE_FILES {
        let Some(about) = folder.dir().about(name)? else { continue };
        let ours = texts.iter().find(|text| text.name == name).map(|text| text.text.as_bytes());
        let is_ours = about.kind == Kind::File
            && ours.is_some_and(|ours| folder.dir().read(name).is_ok_and(|is| is == ours));
        if !is_ours {
            found.push(name.to_owned());
        }
    }
    Ok(found)
}

/// Writes files into a job folder. If a file was edited and users may edit it, it stays, and the new text goes to a file with the added
/// extension `.new`. Any other edited file is renamed: it gets the added extension `.old`.
pub(super) fn write(folder: &Folder, texts: &[Text]) -> Result<Edits, OutputError> {
    let mut marks = WrittenDigests::read(folder.dir()).unwrap_or_default();
    let mut edits = Edits::default();
    for text in texts {
        let (was, is) = (marks.files.get(text.name).cloned(), digest(text.text.as_bytes()));
        let edited = match folder.dir().about(text.name)?.map(|found| found.kind) {
            None => false,
            Some(Kind::File) => {
                let there = digest(&folder.dir().read(text.name)?);
                there != is && Some(&there) != was.as_ref()
            }
            // Users may have put a link here.
            Some(_) => true,
        };
        if edited && text.users {
            edits.kept.push(text.name);
            if was.as_ref() != Some(&is) {
                edits.new.push(text.name);
                put(folder, &format!("{}.new", text.name), text)?;
            }
        } else {
            if edited {
                let name = output::free_name(folder.dir(), &format!("{}.old", text.name))?;
                folder.dir().rename(text.name, folder.dir(), &name)?;
                edits.moved.push((text.name, name));
            }
            put(folder, text.name, text)?;
        }
        marks.files.insert(text.name.to_owned(), is);
        // The digests are saved after every file. If this process is killed, the next process does not mistake jabuka's own files for
        // edited ones.
        marks.write(folder)?;
    }
    Ok(edits)
}

fn put(folder: &Folder, name: &str, text: &Text) -> Result<(), OutputError> {
    folder.write(name, text.text.as_bytes())?;
    if text.runs {
        let file = folder.dir().open_file(name)?;
        system::make_executable(&file).map_err(|error| OutputError::Io(folder.path().join(name), error))?;
    }
    Ok(())
}

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::system::Made;

    fn text(name: &'static str, users: bool, text: &str) -> Text {
        Text { name, text: text.to_owned(), users, runs: false }
    }

    #[test]
    fn edits_are_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        let open = || {
            let dir = Dir::make(folder.path()).unwrap();
            Folder::of(dir, Made::default(), &|dir| WrittenDigests::read(dir).is_some()).unwrap()
        };
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        let texts = |version: &str| [text("render.sbatch", true, version), text("submit", false, version)];
        assert_eq!(write(&open(), &texts("1")).unwrap(), Edits::default());
        assert_eq!(write(&open(), &texts("2")).unwrap(), Edits::default(), "nobody has edited anything");
        assert_eq!((read("render.sbatch"), read("submit")), ("2".to_owned(), "2".to_owned()));

        for name in ["render.sbatch", "submit"] {
            fs::write(folder.path().join(name), "mine").unwrap();
        }
        let edits = write(&open(), &texts("2")).unwrap();
        assert_eq!(
            (edits.kept, edits.new, edits.moved),
            (vec!["render.sbatch"], vec![], vec![("submit", "submit.old".to_owned())])
        );
        assert_eq!(["render.sbatch", "submit", "submit.old"].map(read), ["mine", "2", "mine"]);
        let edits = write(&open(), &texts("3")).unwrap();
        assert_eq!(
            (edits.kept, edits.new, edits.moved),
            (vec!["render.sbatch"], vec!["render.sbatch"], vec![])
        );
        assert_eq!(["render.sbatch", "render.sbatch.new", "submit"].map(read), ["mine", "3", "3"]);
        let edits = write(&open(), &texts("3")).unwrap();
        assert_eq!((edits.kept, edits.new), (vec!["render.sbatch"], vec![]), "it has been said");
    }
}
