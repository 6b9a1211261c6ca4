//! Reads the text of a scene file.

use std::path::Path;

use super::file;
use crate::diagnostic::{Code, Diagnostic, Report, Sources, Span};

/// The maximum size of a scene file, in bytes. For comparison, a scene of ten thousand bodies has about one megabyte.
pub const MAX_BYTES: u64 = 64 << 20;

/// Reads the text of a scene file.
///
/// # Errors
/// If the file cannot be read, is not a regular file, is too large, or is not UTF-8.
pub fn load(path: &Path) -> Result<String, Report> {
    let shown = path.display();
    let cannot_read = |error: &std::io::Error| {
        Report::of_error(Code::CannotRead, format!("cannot read the scene `{shown}`: {}", reason(error)))
    };
    let metadata = std::fs::metadata(path).map_err(|error| cannot_read(&error))?;
    if let Some(what) = file::irregular(metadata.file_type()) {
        let message = format!("`{shown}` is {what}, not a scene file");
        return Err(Report::of_error(Code::NotAFile, message));
    }
    let bytes = file::read(path, MAX_BYTES).map_err(|error| match error.kind() {
        std::io::ErrorKind::FileTooLarge => too_large(path),
        _ => cannot_read(&error),
    })?;
    String::from_utf8(bytes).map_err(|error| not_utf8(path, &error))
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
