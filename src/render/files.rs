//! Lists the files that all scripts of a folder read.

use std::io;
use std::path::Path;

use crate::emit::COMMON;

/// The name of the folder of assets (images, height fields, fonts) beside the scripts.
pub const ASSETS: &str = "assets";

/// Lists the files that the scripts of a folder read, as paths relative to the folder: first the common include file, then the assets
/// sorted by name.
///
/// # Errors
/// If a folder cannot be read.
pub fn of_scripts(scripts: &Path) -> io::Result<Vec<String>> {
    let mut files = Vec::new();
    if scripts.join(COMMON).is_file() {
        files.push(COMMON.to_owned());
    }
    let mut assets = Vec::new();
    if scripts.join(ASSETS).is_dir() {
        below(scripts, ASSETS, &mut assets)?;
    }
    assets.sort_unstable();
    files.extend(assets);
    Ok(files)
}

/// Appends all files below a folder, except hidden ones, as paths relative to `root`.
fn below(root: &Path, folder: &str, found: &mut Vec<String>) -> io::Result<()> {
    for entry in std::fs::read_dir(root.join(folder))? {
        let entry = entry?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        if name.starts_with('.') {
            continue;
        }
        let name = format!("{folder}/{name}");
        if entry.file_type()?.is_dir() {
            below(root, &name, found)?;
        } else {
            found.push(name);
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
