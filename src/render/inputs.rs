//! Finds the inputs of a script: the files that the script and its include files name, and the assets of its scene.

use std::collections::{HashMap, HashSet};
use std::io;
use std::path::{Path, PathBuf};

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::files::ASSETS;
use super::record::{Files, Record, read_input};
use super::{RenderError, Script, Sequence};
use crate::emit::{COMMON, is_trail_file};
use crate::scene::sdl::{FileKind, files};
use crate::system;

/// Returns the record that the image of each script would get if it were rendered now. Length and digest of the image are missing.
///
/// # Errors
/// If a script or a file that it reads cannot be read.
pub(super) fn records(sequence: &Sequence, options: &str, version: &str) -> Result<Vec<Record>, RenderError> {
    let scripts = sequence.scripts();
    let lists: Result<Vec<Vec<PathBuf>>, RenderError> =
        scripts.par_iter().map(|script| files_of(sequence, script)).collect();
    let lists = lists?;
    // Most scripts of a scene read the same files, so each list of files is digested only once.
    let mut digests: HashMap<&[PathBuf], Files> = HashMap::new();
    for list in &lists {
        if !digests.contains_key(list.as_slice()) {
            let files = Files::read(list).map_err(|(path, error)| RenderError::io(path)(error))?;
            digests.insert(list, files);
        }
    }
    let pairs: Vec<(&Script, &Files)> =
        scripts.iter().zip(lists.iter().map(|list| &digests[list.as_slice()])).collect();
    let record = |(script, files): &(&Script, &Files)| {
        let path = sequence.folder().join(&script.file);
        Record::expected(&path, script.frame, files, options, version).map_err(RenderError::io(path))
    };
    pairs.par_iter().map(record).collect()
}

/// Lists the files that a script reads, except those that come with POV-Ray: the record has POV-Ray's version instead.
///
/// The order is the same as in the lists of cluster jobs, so that the records are equal: first the common include file, then the assets
/// sorted by name, then all other files.
fn files_of(sequence: &Sequence, script: &Script) -> Result<Vec<PathBuf>, RenderError> {
    let folder = sequence.absolute();
    let path = folder.join(&script.file);
    let bytes = system::read(&path).map_err(RenderError::io(&path))?;
    let mut read = Vec::new();
    add_read(folder, &bytes, &mut read);
    close(folder, &mut read).map_err(|(path, error)| RenderError::io(path)(error))?;
    let mut paths: Vec<PathBuf> = read.into_iter().map(|(_, path)| path).collect();
    paths.extend(sequence.assets.iter().cloned());
    let mut known = HashSet::new();
    paths.retain(|path| known.insert(path.clone()));
    let (common, assets) = (folder.join(COMMON), folder.join(ASSETS));
    paths.sort_by_cached_key(|path| {
        let class = if *path == common { 0 } else { 2 - usize::from(path.starts_with(&assets)) };
        (class, (class == 1).then(|| path.as_os_str().to_owned()))
    });
    Ok(paths)
}

/// Appends the files that the include files in `read` read, and so on recursively.
fn close(folder: &Path, read: &mut Vec<(FileKind, PathBuf)>) -> Result<(), (PathBuf, io::Error)> {
    let mut next = 0;
    while let Some((kind, path)) = read.get(next).cloned() {
        next += 1;
        if kind == FileKind::Include {
            let bytes = read_input(&path).map_err(|error| (path, error))?;
            add_read(folder, &bytes, read);
        }
    }
    Ok(())
}

/// Lists the existing files that scripts in a folder would read if their SDL (POV-Ray code) contained these names. Files that the listed
/// files include are listed, too, as far as the including files can be read.
pub(crate) fn named(folder: &Path, names: &[(FileKind, String)]) -> Vec<PathBuf> {
    let mut read = Vec::new();
    for (kind, name) in names {
        add_name(folder, *kind, name, &mut read);
    }
    // The list protects files from being overwritten. A file that cannot be read is left out, so errors do not matter.
    let _ = close(folder, &mut read);
    read.into_iter().map(|(_, path)| path).collect()
}

/// Appends the existing files that a script or include file names: beside the scripts, among the assets, or at an absolute path.
fn add_read(folder: &Path, text: &[u8], read: &mut Vec<(FileKind, PathBuf)>) {
    for file in files(&String::from_utf8_lossy(text)) {
        // The name of a trail file identifies its contents, and is part of the script's digest.
        let Some(name) = file.literal.filter(|name| !is_trail_file(name)) else { continue };
        add_name(folder, file.kind, name, read);
    }
}

fn add_name(folder: &Path, kind: FileKind, name: &str, read: &mut Vec<(FileKind, PathBuf)>) {
    let found = candidates(name, kind).into_iter().find_map(|name| {
        [folder.join(&name), folder.join(ASSETS).join(&name)].into_iter().find(|path| path.is_file())
    });
    if let Some(path) = found {
        let file = (kind, path);
        if !read.contains(&file) {
            read.push(file);
        }
    }
}

/// Returns the names under which POV-Ray looks for a file. To a name without an extension, POV-Ray adds the usual extensions of this kind
/// of file.
fn candidates(name: &str, kind: FileKind) -> Vec<String> {
    let endings: &[&str] = match kind {
        _ if Path::new(name).extension().is_some() => &[],
        FileKind::Include => &["inc", "INC"],
        FileKind::Font => &["ttf", "TTF", "ttc", "TTC"],
        FileKind::Image => &[
            "png", "PNG", "gif", "GIF", "jpg", "JPG", "jpeg", "JPEG", "tga", "TGA", "tif", "TIF", "tiff",
            "TIFF", "bmp", "BMP", "iff", "IFF", "ppm", "PPM", "pgm", "PGM", "pot", "POT", "exr", "EXR",
            "hdr", "HDR", "df3", "DF3",
        ],
        FileKind::Data => &[],
    };
    std::iter::once(name.to_owned()).chain(endings.iter().map(|ending| format!("{name}.{ending}"))).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn files_are_listed_as_jobs_list_them_and_then_what_else_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().canonicalize().unwrap().join(name);
        fs::create_dir(path(ASSETS)).unwrap();
        for (name, text) in [
            ("frame_0000.pov", "#include \"z.inc\" #include \"common.inc\" #include \"mine.inc\""),
            ("common.inc", "include \"a-b\" #include Computed"),
            ("mine.inc", "pigment { image_map { png \"sky\" } } text { ttf \"timrom.ttf\" \"a\" 1, 0 }"),
            ("sky.png", ""),
            ("assets/z.inc", "#include \"z.inc\" #include \"mine.inc\""),
            ("assets/a-b.inc", "#include \"missing.inc\" // #include \"unread.inc\""),
            ("unread.inc", ""),
        ] {
            fs::write(path(name), text).unwrap();
        }
        let sequence = Sequence::open(folder.path(), None).unwrap();
        let files = files_of(&sequence, &sequence.scripts()[0]).unwrap();
        let listed = super::super::files::of_scripts(folder.path()).unwrap();
        assert_eq!(listed, ["common.inc", "assets/a-b.inc", "assets/z.inc"]);
        let all = [listed, vec!["mine.inc".to_owned(), "sky.png".to_owned()]].concat();
        assert_eq!(files, all.iter().map(|name| path(name)).collect::<Vec<_>>());
    }
}
