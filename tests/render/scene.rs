//! A folder with a small scene, and helpers that run `jabuka` there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::{jabuka, stderr};

/// A scene with a moving ball and a box at rest, in pictures of 64 × 36 pixels.
pub(crate) const SCENE: &str = "
    [simulation]
    duration = 1.0
    [output]
    size = [64, 36]
    [camera]
    location = [0, 2, 12]
    look_at = [0, 1, 0]
    [body.ball]
    shape.sphere.radius = 1
    velocity = [1, 0, 0]
    [body.box]
    shape.box.size = [1, 1, 1]
    location = [-2, 0, 0]
    ";

/// A temporary folder with a scene.
pub(crate) struct Place(tempfile::TempDir);

impl Place {
    pub(crate) fn new(scene: &str) -> Place {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), scene).unwrap();
        Place(folder)
    }

    /// Returns the path of a file in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Returns a command that runs `jabuka` in the folder.
    pub(crate) fn jabuka(&self, arguments: &[&str]) -> Command {
        let mut command = jabuka();
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    /// Runs `jabuka` in the folder.
    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        self.jabuka(arguments).output().unwrap()
    }

    /// Runs `jabuka` in the folder, and asserts success.
    pub(crate) fn succeed(&self, arguments: &[&str]) -> Output {
        let output = self.run(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
        output
    }

    /// Writes a stand-in for POV-Ray: a shell script that may `exec povray "$@"`. Returns its path.
    pub(crate) fn stand_in(&self, script: &str) -> String {
        use std::os::unix::fs::PermissionsExt;
        let path = self.path("stand_in");
        let version = "if [ \"$1\" = --version ]; then exec povray --version; fi";
        fs::write(&path, format!("#!/bin/sh\n{version}\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path.display().to_string()
    }

    /// Returns the sorted names of the images.
    pub(crate) fn images(&self) -> Vec<String> {
        names(&self.path("out/scene/images")).into_iter().filter(|name| name.ends_with(".png")).collect()
    }
}

/// Returns the sorted names of a folder's entries.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Returns the width, the height and the bytes of an image.
pub(crate) fn pixels(path: &Path) -> (u32, u32, Vec<u8>) {
    let file = fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width, info.height, bytes)
}

/// Asserts that a folder of images contains no leftovers, only images, their records and jabuka's own files.
pub(crate) fn assert_tidy(images: &Path) {
    for name in names(images) {
        assert!(name == ".jabuka" || name.ends_with(".png"), "{name} is left over");
    }
    for name in names(&images.join(".jabuka")) {
        let known = ["lock", "povray", "failed"].contains(&name.as_str());
        assert!(known || (name.starts_with("frame_") && name.ends_with(".txt")), "{name} is left over");
    }
}
