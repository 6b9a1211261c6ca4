//! Reads the text of a scene file.

use std::path::{Path, PathBuf};

use super::file;
use crate::diagnostic::{Code, Diagnostic, Report, Sources, Span, nearest};
use crate::system;

/// The maximum size of a scene file, in bytes. For comparison, a scene of ten thousand bodies has about one megabyte.
pub const MAX_BYTES: u64 = 64 << 20;

/// The maximum number of entries of a folder among which a similar name is searched.
const MAX_ENTRIES: usize = 10_000;

/// Reads the text of a scene file.
///
/// # Errors
/// If the file cannot be read, is not a regular file, is too large, or is not UTF-8.
pub fn load(path: &Path) -> Result<String, Report> {
    let shown = path.display();
    let cannot_read = |error: &std::io::Error| {
        let meant = match error.kind() {
            std::io::ErrorKind::NotFound => meant(path),
            _ => None,
        };
        let meant = meant.map_or_else(String::new, |path| format!("; did you mean `{}`?", path.display()));
        let reason = reason(error);
        Report::of_error(Code::CannotRead, format!("cannot read the scene `{shown}`: {reason}{meant}"))
    };
    let metadata = system::metadata(path).map_err(|error| cannot_read(&error))?;
    if let Some(what) = system::irregular(metadata.file_type()) {
        let message = format!("`{shown}` is {what}, not a scene file");
        return Err(Report::of_error(Code::NotAFile, message));
    }
    let bytes = file::read(path, MAX_BYTES).map_err(|error| match error.kind() {
        std::io::ErrorKind::FileTooLarge => too_large(path),
        _ => cannot_read(&error),
    })?;
    String::from_utf8(bytes).map_err(|error| not_utf8(path, &error))
}

/// Returns the scene that the user probably means by the path of a missing file: the one with `.toml` at its end, or one in the same folder
/// with a similar name.
fn meant(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?;
    let mut with_ending = name.to_owned();
    with_ending.push(".toml");
    let with_ending = path.with_file_name(with_ending);
    if with_ending.is_file() {
        return Some(with_ending);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).ok()?.filter_map(Result::ok).take(MAX_ENTRIES);
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut scenes: Vec<String> = names.filter(|name| name.ends_with(".toml")).collect();
    // The order of a folder's entries differs between machines.
    scenes.sort();
    let stems = scenes.iter().map(|scene| scene.trim_end_matches(".toml"));
    let near = nearest(name.to_str()?.trim_end_matches(".toml"), stems)?;
    Some(path.with_file_name(format!("{near}.toml")))
}

fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => error.to_string(),
    }
}

fn too_large(path: &Path) -> Report {
    let most = MAX_BYTES >> 20;
    let message = format!("`{}` is larger than {most} MiB, which no scene is", path.display());
    Report::of_error(Code::FileTooLarge, message)
}

/// Creates the error for a file that is not UTF-8. It marks the first invalid byte.
fn not_utf8(path: &Path, error: &std::string::FromUtf8Error) -> Report {
    let mut sources = Sources::default();
    let valid = error.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
    let id = sources.add(path.display().to_string(), text);
    // The valid text before the invalid byte is unchanged, so the byte has the same offset in the text that is shown.
    let span = Span::new(id, valid..valid + char::REPLACEMENT_CHARACTER.len_utf8());
    let diagnostic = Diagnostic::error(Code::NotUtf8, "the file is not UTF-8, which TOML asks for")
        .at(span, "this byte is no character")
        .help("save the file as UTF-8");
    Report { sources, diagnostics: vec![diagnostic] }
}
