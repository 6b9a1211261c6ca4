//! Decides which files a command may replace. The files that the command reads are protected, and so are the files in folders that jabuka
//! manages.
//!
//! A file is identified by `system::FileId`, its device and inode on Unix. So symbolic links, hard links, `..`, and names that differ only in
//! case are recognized as the same file.
//!
//! No command replaces a file that it reads, or a script or image in one of jabuka's folders.

use std::ffi::OsStr;
use std::fmt;
use std::path::{Component, Path, PathBuf};

use crate::diagnostic::{Code, Diagnostic, Report};
use crate::emit::ASSETS;
use crate::output;
use crate::render;
use crate::scene::Scene;
use crate::scene::sdl::FileKind;
use crate::system::{self, FileId};

/// The reason, shown in errors, for protecting a file that the scene's SDL reads.
const READ_BY_SDL: &str = "the SDL of the scene reads it";

/// The files and folders that a command must not overwrite.
#[derive(Debug, Default)]
pub struct ProtectedFiles {
    inputs: Vec<Input>,
    /// The names and identities of the scene's assets, which are copied into the folders of scripts.
    assets: Vec<(String, Option<FileId>)>,
    /// The folders that the command fills with scripts and images. They need not exist yet.
    folders: Vec<PathBuf>,
    /// The files that the SDL of a trusted scene reads, by name. Relative names start from the folder of the scripts.
    named: Vec<(FileKind, String)>,
}

/// A file that the command reads, and must not overwrite.
#[derive(Debug)]
struct Input {
    /// The path of the file, without links and `..`.
    path: PathBuf,
    identity: Option<FileId>,
    use_of_it: &'static str,
}

/// The error that a file must not be overwritten, with the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CannotOverwrite {
    path: PathBuf,
    why: String,
}

impl CannotOverwrite {
    /// Converts the error to a report with one diagnostic.
    pub fn report(&self) -> Report {
        let help = "name another file";
        let diagnostic = Diagnostic::error(Code::CannotOverwrite, self.to_string()).help(help);
        Report { diagnostics: vec![diagnostic], ..Report::default() }
    }
}

impl fmt::Display for CannotOverwrite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` would be overwritten, and {}", self.path.display(), self.why)
    }
}

impl std::error::Error for CannotOverwrite {}

impl ProtectedFiles {
    /// Protects all inputs of a scene: its file, included files, tables, meshes, heightfields, assets and templates, and the files that
    /// its SDL reads, as far as their names can be found in the SDL.
    pub fn of_scene(scene: &Scene) -> ProtectedFiles {
        let asset =
            |asset: &crate::scene::Asset| Some((asset.name.clone(), FileId::of_path(asset.path()?).ok()));
        let protected = ProtectedFiles {
            assets: scene.povray.assets.iter().filter_map(asset).collect(),
            named: scene.povray.reads.clone(),
            ..ProtectedFiles::default()
        };
        let mut absolute = scene.povray.reads.clone();
        absolute.retain(|(_, name)| Path::new(name).is_absolute());
        let protected = protected.and_files(scene.files(), "the scene is made from it");
        protected.and_files(render::named(Path::new("/"), &absolute), READ_BY_SDL)
    }

    /// Protects further files that the command reads. `use_of_it` is the end of an error message, such as `the scene is made from it`.
    #[must_use]
    pub fn and_files<P: AsRef<Path>>(
        mut self,
        files: impl IntoIterator<Item = P>,
        use_of_it: &'static str,
    ) -> ProtectedFiles {
        let input = |file: P| {
            let path = file.as_ref();
            Input { path: resolved(path), identity: FileId::of_path(path).ok(), use_of_it }
        };
        self.inputs.extend(files.into_iter().map(input));
        self
    }

    /// Adds a folder that the command fills with scripts or images. No file that it writes there may replace an input of the command.
    ///
    /// # Errors
    /// If an input has the path of a file that will be written into the folder.
    pub fn and_folder(mut self, folder: &Path) -> Result<ProtectedFiles, CannotOverwrite> {
        let resolved = resolved(folder);
        let is_replaced = |input: &&Input| {
            let Ok(name) = input.path.strip_prefix(&resolved) else { return false };
            let copied_over = |(asset, identity): &(String, Option<FileId>)| {
                name == Path::new(ASSETS).join(asset) && *identity != input.identity
            };
            name.to_str().is_some_and(is_our_name) || self.assets.iter().any(copied_over)
        };
        if let Some(input) = self.inputs.iter().find(is_replaced) {
            return Err(CannotOverwrite { path: input.path.clone(), why: input.use_of_it.to_owned() });
        }
        self.folders.push(resolved);
        // Rendering may read files that an earlier run wrote into this folder. They may be replaced by the new scripts, but by nothing
        // else.
        let read = render::named(folder, &self.named);
        Ok(self.and_files(read, READ_BY_SDL))
    }

    /// Checks that a file may be written at this path, where it may replace an existing file.
    ///
    /// # Errors
    /// If the file at this path is protected.
    pub fn check(&self, path: &Path) -> Result<(), CannotOverwrite> {
        let cannot = |why: String| Err(CannotOverwrite { path: path.to_owned(), why });
        let identity = FileId::of_path(path).ok();
        if let Some(input) = self.inputs.iter().find(|input| identity.is_some() && input.identity == identity)
        {
            return cannot(input.use_of_it.to_owned());
        }
        // If the path is a symbolic link, both the link and its target are checked.
        let beside = path.parent().map(|parent| resolved(parent).join(path.file_name().unwrap_or_default()));
        for place in beside.into_iter().chain([resolved(path)]) {
            let Some(folder) = place.parent() else { continue };
            let name = place.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
            if is_our_name(&name) && self.is_ours(folder) {
                return cannot(format!("jabuka keeps its frames in `{}`", folder.display()));
            }
            let mut above =
                folder.ancestors().filter(|folder| folder.file_name() == Some(OsStr::new(ASSETS)));
            let read_by_scripts = |assets: &Path| assets.parent().is_some_and(|folder| self.is_ours(folder));
            if above.any(read_by_scripts) {
                return cannot("scripts read what is in that folder".to_owned());
            }
        }
        Ok(())
    }

    /// Returns true if a folder contains, or will contain, scripts or images of jabuka.
    fn is_ours(&self, folder: &Path) -> bool {
        self.folders.iter().any(|known| known == folder)
            || output::read_manifest(folder).is_some()
            || render::is_folder_of_images(folder)
    }
}

/// Returns true if jabuka uses this file name in its folders: for a script, for a file beside the scripts, or for an image.
fn is_our_name(name: &str) -> bool {
    let image = name.strip_suffix(".png").is_some_and(|stem| output::is_own_name(&format!("{stem}.pov")));
    image || output::is_own_name(name) || name.starts_with(".jabuka")
}

/// Returns the absolute path without links and `..`. The part of the path that does not exist is kept.
fn resolved(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let parts: Vec<Component<'_>> = absolute.components().collect();
    for existing in (1..=parts.len()).rev() {
        let Ok(mut found) = system::canonicalize(&parts[..existing].iter().collect::<PathBuf>()) else {
            continue;
        };
        for part in &parts[existing..] {
            match part {
                Component::ParentDir => drop(found.pop()),
                part => found.push(part),
            }
        }
        return found;
    }
    absolute
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn said(result: Result<(), CannotOverwrite>) -> String {
        result.unwrap_err().to_string()
    }

    #[test]
    fn a_file_that_is_read_is_kept_by_whatever_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("wall.gif"), "GIF").unwrap();
        fs::hard_link(at("wall.gif"), at("hard.gif")).unwrap();
        std::os::unix::fs::symlink("wall.gif", at("soft.gif")).unwrap();
        std::os::unix::fs::symlink(".", at("here")).unwrap();
        let protected = ProtectedFiles::default().and_files([at("wall.gif")], "the scene is made from it");
        for name in ["wall.gif", "hard.gif", "soft.gif", "sub/../wall.gif", "here/here/wall.gif"] {
            assert!(said(protected.check(&at(name))).ends_with("and the scene is made from it"), "{name}");
        }
        for name in ["new.gif", "sub/wall.gif", "no/such/folder/wall.gif"] {
            assert_eq!(protected.check(&at(name)), Ok(()), "{name}");
        }
    }

    #[test]
    fn what_jabuka_keeps_in_its_folders_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let protected = ProtectedFiles::default().and_folder(&at("out/scene")).unwrap();
        for name in
            ["frame_0003.png", "FRAME_0003.PNG", "manifest.json", "x/../common.inc", "assets/a/wall.png"]
        {
            said(protected.check(&at("out/scene").join(name)));
        }
        for name in ["film.mp4", "frame_3.png", "images/frame_0003.png", "sheet.png"] {
            assert_eq!(protected.check(&at("out/scene").join(name)), Ok(()), "{name}");
        }
        // The folder `.jabuka` marks a folder of images that another command has rendered.
        fs::create_dir_all(at("images/.jabuka")).unwrap();
        said(ProtectedFiles::default().check(&at("images/frame_0003.png")));
        assert_eq!(ProtectedFiles::default().check(&at("images/sheet.png")), Ok(()));
    }

    #[test]
    fn a_folder_is_not_filled_over_what_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let reading =
            |name: &str| ProtectedFiles::default().and_files([at(name)], "the scene is made from it");
        assert!(reading("frame_0000.png").and_folder(folder.path()).is_err());
        assert!(reading("common.inc").and_folder(&at("no/..")).is_err());
        assert!(reading("heights.png").and_folder(folder.path()).is_ok());
        assert!(reading("frame_0000.png").and_folder(&at("images")).is_ok());
    }

    #[test]
    fn what_trusted_sdl_reads_is_kept_with_what_that_includes() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("out")).unwrap();
        for name in ["sky.png", "deep.png", "out/near.png", "free.png"] {
            fs::write(at(name), "PNG").unwrap();
        }
        let shown = |name: &str| at(name).display().to_string();
        let include = format!("#declare P = pigment {{ image_map {{ png \"{}\" }} }}", shown("deep"));
        fs::write(at("parts.inc"), include).unwrap();
        let sdl = format!(
            "#include \"{}\" plane {{ y, 0 pigment {{ image_map {{ png \"{}\" }} }} }} // \"free.png\"",
            shown("parts.inc"),
            shown("sky.png")
        );
        let scene =
            "[body.a]\nshape.sphere.radius = 1\nmaterial.sdl = 'pigment { image_map { png \"near.png\" } }'";
        fs::write(at("scene.toml"), format!("povray.sdl = '''{sdl}'''\n{scene}\n")).unwrap();
        let trusting = crate::scene::Options { trust: true, ..Default::default() };
        let scene = Scene::from_path_with(at("scene.toml"), &trusting).unwrap();
        let protected = ProtectedFiles::of_scene(&scene);
        for name in ["sky.png", "deep.png", "parts.inc"] {
            assert!(
                said(protected.check(&at(name))).ends_with("and the SDL of the scene reads it"),
                "{name}"
            );
        }
        assert_eq!(protected.check(&at("free.png")), Ok(()));
        // A relative name in SDL starts from the folder of the scripts, which is unknown until it is added.
        assert_eq!(protected.check(&at("out/near.png")), Ok(()));
        let protected = protected.and_folder(&at("out")).unwrap();
        assert!(said(protected.check(&at("out/near.png"))).ends_with("and the SDL of the scene reads it"));
    }
}
