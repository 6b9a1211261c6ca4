//! Lists the files that all scripts of a folder read.

use std::io;
use std::path::Path;

use crate::emit::COMMON;
use crate::system::{Dir, FolderError, Kind};

/// The name of the folder of assets (images, height fields, fonts) beside the scripts.
pub const ASSETS: &str = "assets";

/// Lists the files that the scripts of a folder read, as paths relative to the folder: first the common include file, then the assets
/// sorted by name.
///
/// # Errors
/// If a folder cannot be read.
pub fn of_scripts(scripts: &Path) -> io::Result<Vec<String>> {
    Ok(in_folder(&Dir::of_path(scripts)?)?)
}

/// Lists the files that the scripts of an open folder read, as [`of_scripts`] does.
pub(super) fn in_folder(dir: &Dir) -> Result<Vec<String>, FolderError> {
    let mut files = Vec::new();
    if dir.about(COMMON)?.is_some_and(|found| found.kind == Kind::File) {
        files.push(COMMON.to_owned());
    }
    let mut assets = Vec::new();
    if dir.about(ASSETS)?.is_some() {
        below(&dir.folder(ASSETS)?, ASSETS, &mut assets)?;
    }
    assets.sort_unstable();
    files.extend(assets);
    Ok(files)
}

/// Appends all files below a folder, except hidden ones. `name` is the path of the folder relative to that of the scripts. A link is an error:
/// it may lead to any file of the user, and the files of the list are copied for other machines.
fn below(folder: &Dir, name: &str, found: &mut Vec<String>) -> Result<(), FolderError> {
    for file in folder.names()? {
        let Some(file) = file.to_str().filter(|file| !file.starts_with('.')) else { continue };
        let inner = format!("{name}/{file}");
        match folder.about(file)?.map(|about| about.kind) {
            Some(Kind::Folder) => below(&folder.folder(file)?, &inner, found)?,
            Some(Kind::Link) => return Err(FolderError::Link(folder.path().join(file))),
            Some(_) => found.push(inner),
            None => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shared_comes_first_then_assets_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let make = |name: &str| std::fs::write(folder.path().join(name), "").unwrap();
        assert!(of_scripts(folder.path()).unwrap().is_empty());
        std::fs::create_dir_all(folder.path().join("assets/b")).unwrap();
        for name in ["frame_0000.pov", "assets/b/x.png", "assets/a.png", "assets/.hidden", COMMON] {
            make(name);
        }
        assert_eq!(of_scripts(folder.path()).unwrap(), [COMMON, "assets/a.png", "assets/b/x.png"]);
    }
}
