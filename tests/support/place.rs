//! A temporary folder with the files of a test.

use std::fs;
use std::path::PathBuf;

use jabuka::Scene;

/// A temporary folder with files. Dropping it deletes them.
pub(crate) struct Place(pub(crate) tempfile::TempDir);

impl Place {
    pub(crate) fn new(files: &[(&str, &str)]) -> Place {
        let place = Place(tempfile::tempdir().unwrap());
        for (name, text) in files {
            fs::write(place.path(name), text).unwrap();
        }
        place
    }

    /// Returns the path of a file in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Reads a scene in the folder, and asserts that it is valid.
    #[allow(clippy::panic, reason = "a test stops at the first surprise")]
    pub(crate) fn read(&self, name: &str) -> Scene {
        Scene::from_path(self.path(name)).unwrap_or_else(|report| panic!("{}", report.to_text(false)))
    }

    /// Checks a scene in the folder, and asserts that it is invalid. Returns the error messages.
    pub(crate) fn errors(&self, name: &str) -> String {
        let output = super::jabuka().current_dir(self.0.path()).args(["check", name]).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        super::stderr(&output)
    }
}
