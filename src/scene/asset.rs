//! The assets of a scene: files that its scripts read, such as images, height fields and fonts.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// A file that the scripts read. jabuka places a copy of the file beside the scripts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asset {
    /// The path of the copy in scripts, relative to the folder of all copies, with `/` as separator.
    pub name: String,
    /// The contents of the copy.
    pub source: AssetSource,
}

/// Where the contents of an asset come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AssetSource {
    /// A file, by its path.
    File(PathBuf),
    /// Bytes that jabuka itself contains.
    BuiltIn(&'static [u8]),
}

impl Asset {
    /// Opens the contents for reading.
    ///
    /// # Errors
    /// If the file cannot be opened.
    pub fn open(&self) -> io::Result<Box<dyn Read>> {
        Ok(match &self.source {
            AssetSource::File(path) => Box::new(File::open(path)?),
            AssetSource::BuiltIn(bytes) => Box::new(*bytes),
        })
    }

    /// Returns the path of the original file. `None` if jabuka itself contains the asset.
    pub fn path(&self) -> Option<&Path> {
        match &self.source {
            AssetSource::File(path) => Some(path),
            AssetSource::BuiltIn(_) => None,
        }
    }
}
