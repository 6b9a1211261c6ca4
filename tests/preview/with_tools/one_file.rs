//! Tests of a run that was exported as one file.

use super::Server;
use crate::server::Scene;
use crate::support::stderr;

const SCENE: &str = r#"
title = "One file"
variables.speed = { value = 2.0, min = 0.0, max = 5.0 }
[simulation]
duration = 1.0
gravity = [0, -9.81, 0]
contacts = "event-driven"
[body.ball]
shape.sphere.radius = 0.1
location = [0, 0.5, 0]
velocity = ["speed", 0, 0]
restitution = 0.8
trail = true
ghosts.every = 0.25
[body.crate]
shape.box.size = [0.3, 0.3, 0.3]
location = [1, 0.15, 0]
start = 0.4
[view.side]
location = [0, 0.5, 5]
[emitter.dust]
shape.sphere.radius = 0.01
from.point = [0, 0.3, 0]
rate = 20
speed = 0.5
lifetime = 0.5
[label.energy]
text = "${energy} J"
corner = "top-left"
"#;

/// Exports a scene as a page, and previews it.
fn exported(scene: &str) -> Server {
    let server = Scene::of(scene).served();
    let output = server.scene.jabuka(&["export", "scene.toml", "-o", "scene.html"]).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    server
}

#[test]
fn a_run_as_one_file_shows_what_the_preview_shows() {
    exported(SCENE).shows("one_file.mjs", "a_run_as_one_file_shows_what_the_preview_shows");
}

#[test]
fn a_run_as_one_file_plays_in_a_frame() {
    let server = exported(SCENE);
    server.shows("one_file.mjs", "a_run_as_one_file_plays_in_a_frame");
    server.shows_in_firefox("one_file.mjs", "a_run_as_one_file_plays_in_a_frame");
}

/// A page holds the values of single bodies up to 100,000 of them. This run has 1,000 bodies in 101 frames.
#[test]
fn a_page_says_which_values_it_leaves_out() {
    let scene = "simulation.duration = 4\n[body.ball]\nshape.sphere.radius = 0.1\nlocation = ['i', 0, 0]\nvelocity = [0, 1, 0]\nrepeat = 1000\n";
    exported(scene).shows("one_file.mjs", "a_page_says_which_values_it_leaves_out");
}
