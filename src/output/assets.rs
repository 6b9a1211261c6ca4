//! Copies the files that scripts read (assets: images, height fields, fonts) into an output folder.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use super::manifest::Entry;
use super::{DigestWriter, Folder, OutputError};
use crate::emit::ASSETS;
use crate::scene::Asset;

/// Copies the assets of a scene to where its scripts find them. Existing copies of other assets stay, since they cannot be told from a
/// user's own files. Returns the manifest entries of the copies.
///
/// # Errors
/// If an asset cannot be read, its copy cannot be written, or a subfolder on its path is a symbolic link.
pub(super) fn copy(folder: &Folder, assets: &[Asset]) -> Result<Vec<Entry>, OutputError> {
    let copy = |asset: &Asset| {
        let name = format!("{ASSETS}/{}", asset.name);
        make_folders(folder.path(), Path::new(&name))?;
        let original = |error| OutputError::Io(asset.path.clone(), error);
        let mut file = File::open(&asset.path).map_err(original)?;
        let mut writer = DigestWriter::default();
        folder.try_write_with(&name, |copy| {
            let mut buffer = [0; 1 << 16];
            loop {
                match file.read(&mut buffer).map_err(original)? {
                    0 => return Ok(()),
                    length => {
                        let piece = &buffer[..length];
                        writer.add(piece);
                        copy.write_all(piece)
                            .map_err(|error| OutputError::Io(folder.path().join(&name), error))?;
                    }
                }
            }
        })?;
        Ok(writer.entry(None, name))
    };
    assets.iter().map(copy).collect()
}

/// Creates the missing subfolders on the path of a file below `folder`. Refuses symbolic links.
fn make_folders(folder: &Path, file: &Path) -> Result<(), OutputError> {
    let mut path: PathBuf = folder.to_owned();
    for part in file.parent().into_iter().flat_map(Path::components) {
        path.push(part);
        match fs::symlink_metadata(&path) {
            Ok(metadata) if metadata.is_symlink() => return Err(OutputError::Link(path)),
            Ok(metadata) if !metadata.is_dir() => return Err(OutputError::NotAFolder(path)),
            Ok(_) => {}
            Err(_) => fs::create_dir(&path).map_err(|error| OutputError::Io(path.clone(), error))?,
        }
    }
    Ok(())
}
