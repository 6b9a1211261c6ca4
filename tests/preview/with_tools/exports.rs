//! Tests that files saved from the page equal those that the program writes.

use std::fs;

use crate::server::Scene;
use crate::support::stderr;

#[test]
fn all_kinds_of_files_are_saved() {
    let text = "simulation.duration = 0.5\n[body.ball]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n";
    let server = Scene::of(text).served();
    server.shows("exports.mjs", "all_kinds_of_files_are_saved");
    for kind in ["glb", "csv", "html"] {
        let exported = format!("exported.{kind}");
        let output = server.scene.jabuka(&["export", "scene.toml", "-o", &exported]).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        let read = |name: &str| fs::read(server.scene.folder().join(name)).unwrap();
        assert!(read(&exported) == read(&format!("scene.{kind}")), "{kind}");
    }
}
