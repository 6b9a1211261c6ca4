//! Opens the files of a scene. Accepts only regular files up to a maximum size.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

use crate::system;

/// Opens a regular file of at most `most` bytes. Other files are refused before reading: a pipe would block until another process writes
/// to it, and a device may have no end.
///
/// # Errors
/// If the file cannot be opened, is not a regular file, or is too large. The error's message is a clause that names the reason.
pub(in crate::scene) fn open(path: &Path, most: u64) -> io::Result<File> {
    // Opening a device may have side effects, so its metadata are checked first.
    accept(&system::metadata(path)?, most)?;
    // Another file may have replaced the checked file meanwhile. If the new file is a pipe, opening it must not block.
    let file = system::open_without_waiting(path)?;
    accept(&file.metadata()?, most)?;
    Ok(file)
}

/// Reads a regular file of at most `most` bytes.
///
/// # Errors
/// The errors of [`open`].
pub(in crate::scene) fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // Reading at most one byte more than the limit detects a file that has grown since it was opened.
    open(path, most)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(most)) } else { Ok(bytes) }
}

/// Reads a regular file of at most `most` bytes as UTF-8 text.
///
/// # Errors
/// The errors of [`open`], and an error if the bytes are not UTF-8.
pub(in crate::scene) fn read_text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read(path, most)?).map_err(|error| {
        let line = error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|byte| **byte == b'\n');
        io::Error::new(io::ErrorKind::InvalidData, format!("its line {} is not UTF-8", line.count() + 1))
    })
}

fn accept(metadata: &Metadata, most: u64) -> io::Result<()> {
    if let Some(what) = system::irregular(metadata.file_type()) {
        return Err(io::Error::other(format!("it is {what}, and only regular files are read")));
    }
    if metadata.len() > most { Err(too_large(most)) } else { Ok(()) }
}

fn too_large(most: u64) -> io::Error {
    io::Error::new(
        io::ErrorKind::FileTooLarge,
        format!("it is larger than {} MiB, the most that is read", most >> 20),
    )
}
