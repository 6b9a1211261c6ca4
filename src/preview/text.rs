//! The text of the scene, which the page edits in its file.
//!
//! The file belongs to the user, who may have it open in another editor, too. So the page says on which version of the text its own is
//! based, and a file that has changed since then is not overwritten.

use std::ffi::OsStr;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::PoisonError;

use serde::{Deserialize, Serialize};

use crate::page::{Failed, text_version};
use crate::system::{self, Dir, FolderError};

/// The file of the scene.
pub(super) struct SceneFile {
    path: PathBuf,
    /// Locked while the file is compared and written, so that two pages do not overwrite each other's text.
    writing: Mutex<()>,
}

/// The text of the scene, as the page shows it: its lines end in `\n`.
#[derive(Debug, Serialize)]
pub(super) struct Text {
    /// The path of the file, as messages name it.
    file: String,
    text: String,
    version: String,
}

/// A new text of the scene.
#[derive(Deserialize)]
pub(super) struct NewText {
    text: String,
    /// The version of the text on which this one is based.
    base: String,
}

/// What the text of a file has besides its lines.
struct Form {
    has_mark: bool,
    has_returns: bool,
}

const BYTE_ORDER_MARK: char = '\u{feff}';

impl Form {
    fn of(whole: &str) -> Form {
        let first = whole.find('\n').unwrap_or(0);
        Form { has_mark: whole.starts_with(BYTE_ORDER_MARK), has_returns: whole[..first].ends_with('\r') }
    }

    /// Returns a text with lines that end in `\n` as the file has it, without a byte order mark.
    fn lines(&self, text: &str) -> String {
        if self.has_returns { text.replace('\n', "\r\n") } else { text.to_owned() }
    }
}

impl SceneFile {
    pub(super) fn new(path: PathBuf) -> SceneFile {
        SceneFile { path, writing: Mutex::new(()) }
    }

    fn whole(&self) -> Result<String, Failed> {
        let bytes = fs::read(&self.path)?;
        String::from_utf8(bytes).map_err(|_| Failed::Io(io::Error::other("the file is not UTF-8")))
    }

    /// Reads the file.
    ///
    /// # Errors
    /// If it cannot be read, or is not UTF-8.
    pub(super) fn read(&self) -> Result<Text, Failed> {
        let whole = self.whole()?;
        let text = whole.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&whole);
        let version = text_version(text);
        Ok(Text { file: self.path.display().to_string(), text: text.replace("\r\n", "\n"), version })
    }

    /// Replaces the text, and returns its version. The file keeps its byte order mark, its kind of line ends and its permissions. It is
    /// complete at any time.
    ///
    /// # Errors
    /// If the file has another version than the one on which the text is based, or cannot be written.
    pub(super) fn write(&self, new: &NewText) -> Result<String, Failed> {
        let _writing = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
        let whole = self.whole()?;
        let old = whole.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&whole);
        let form = Form::of(&whole);
        let text = form.lines(&new.text);
        let version = text_version(&text);
        if text == old {
            return Ok(version);
        }
        if text_version(old) != new.base {
            return Err(Failed::Changed);
        }
        let mark = if form.has_mark { "\u{feff}" } else { "" };
        replace(&self.path, &whole, &[mark, &text])?;
        Ok(version)
    }
}

/// Replaces the contents of a file, which are `old` before. If its path is a link, the file at its end is replaced.
fn replace(path: &Path, old: &str, parts: &[&str]) -> Result<(), Failed> {
    let file = system::canonicalize(path)?;
    let permissions = fs::metadata(&file)?.permissions();
    if permissions.readonly() {
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only").into());
    }
    let folder = Dir::of_path(file.parent().unwrap_or(Path::new("."))).map_err(io::Error::from)?;
    let name = file.file_name().unwrap_or(OsStr::new(""));
    folder.write_whole(name, |out| -> Result<(), Failed> {
        out.get_ref().set_permissions(permissions)?;
        parts.iter().try_for_each(|part| out.write_all(part.as_bytes()))?;
        out.flush()?;
        out.get_ref().sync_all()?;
        // Writing takes time, in which another program may have changed the file. Only a change during the renaming itself is not noticed.
        if fs::read(&file)? == old.as_bytes() { Ok(()) } else { Err(Failed::Changed) }
    })
}

impl From<FolderError> for Failed {
    fn from(error: FolderError) -> Failed {
        Failed::Io(error.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edited(before: &str, text: &str, base: Option<&str>) -> (Result<String, Failed>, String) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        fs::write(&path, before).unwrap();
        let file = SceneFile::new(path.clone());
        let base = base.map_or_else(|| file.read().unwrap().version, str::to_owned);
        let written = file.write(&NewText { text: text.to_owned(), base });
        (written, fs::read_to_string(path).unwrap())
    }

    #[test]
    fn a_text_keeps_the_byte_order_mark_and_the_line_ends_of_its_file() {
        assert_eq!(edited("a = 1\n", "a = 2\nb = 3\n", None).1, "a = 2\nb = 3\n");
        assert_eq!(edited("a = 1\r\n", "a = 2\nb = 3\n", None).1, "a = 2\r\nb = 3\r\n");
        assert_eq!(edited("\u{feff}a = 1\r\n", "a = 2\n", None).1, "\u{feff}a = 2\r\n");
        assert_eq!(edited("", "a = 2\n", None).1, "a = 2\n");
    }

    #[test]
    fn the_version_is_that_of_the_next_text() {
        let (version, whole) = edited("\u{feff}a = 1\r\n", "a = 2\n", None);
        assert_eq!(version.unwrap(), text_version(whole.trim_start_matches('\u{feff}')));
    }

    #[test]
    fn a_file_that_has_changed_is_not_overwritten() {
        let (written, whole) = edited("a = 1\n", "a = 2\n", Some(&text_version("a = 0\n")));
        assert!(matches!(written, Err(Failed::Changed)), "{written:?}");
        assert_eq!(whole, "a = 1\n");
        // Another page may have written the same.
        assert!(edited("a = 1\n", "a = 1\n", Some(&text_version("a = 0\n"))).0.is_ok());
    }

    #[test]
    fn what_another_program_writes_meanwhile_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        fs::write(&path, "theirs\n").unwrap();
        let written = replace(&path, "old\n", &["new\n"]);
        assert!(matches!(written, Err(Failed::Changed)), "{written:?}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "theirs\n");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [real, link] = ["real.toml", "link.toml"].map(|name| folder.path().join(name));
        fs::write(&real, "a = 1\n").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("real.toml", &link).unwrap();
        let file = SceneFile::new(link.clone());
        let base = file.read().unwrap().version;
        file.write(&NewText { text: "a = 2\n".to_owned(), base }).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "a = 2\n");
        assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
        fs::set_permissions(&real, fs::Permissions::from_mode(0o440)).unwrap();
        let base = file.read().unwrap().version;
        let refused = file.write(&NewText { text: "a = 3\n".to_owned(), base });
        assert!(matches!(refused, Err(Failed::Io(_))), "{refused:?}");
        assert_eq!(fs::read_to_string(&real).unwrap(), "a = 2\n");
    }
}
