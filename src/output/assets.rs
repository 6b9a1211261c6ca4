//! Copies the files that scripts read (assets: images, height fields, fonts) into an output folder.

use std::io::{Read as _, Write as _};
use std::path::Path;

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
        if let Some((subfolder, _)) = name.rsplit_once('/') {
            folder.dir().make_folder(subfolder)?;
        }
        let original =
            |error| OutputError::Io(asset.path().unwrap_or(Path::new(&asset.name)).to_owned(), error);
        let mut file = asset.open().map_err(original)?;
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
