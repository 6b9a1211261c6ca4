//! Scenes for the tests, and the scripts that they give.

use jabuka::{Run, Scene};

/// TOML that leaves only the bodies in the picture: no ground, and a black sky.
pub(crate) const DARK: &str = "\n[environment]\nground = false\nsky = false\n";

/// Returns the script of one frame of a scene.
pub(crate) fn script_of(text: &str, frame: usize) -> String {
    let scene =
        Scene::parse(text).unwrap_or_else(|report| panic!("{}\n{text}", report.diagnostics[0].message));
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().nth(frame).unwrap().unwrap();
    run.script(&frame).unwrap()
}

/// Returns the script of the first frame of a scene.
pub(crate) fn script(text: &str) -> String {
    script_of(text, 0)
}

/// Returns TOML for a ball with its own luminous material of this color.
pub(crate) fn shining_ball(name: &str, location: [f64; 3], radius: f64, color: &str) -> String {
    format!(
        "\n[body.{name}]\nshape.sphere.radius = {radius}\nlocation = {location:?}\nmaterial = \"{name}\"
[material.{name}]\ncolor = \"{color}\"\nfinish = \"luminous\"\n"
    )
}
