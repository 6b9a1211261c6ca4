//! Scenes in the tests.

use jabuka::{Run, Scene};

/// Nothing but the bodies: no ground and a black sky.
pub(crate) const DARK: &str = "\n[environment]\nground = false\nsky = false\n";

/// The script of a frame of a scene.
pub(crate) fn script_of(text: &str, frame: usize) -> String {
    let scene =
        Scene::parse(text).unwrap_or_else(|report| panic!("{}\n{text}", report.diagnostics[0].message));
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().nth(frame).unwrap().unwrap();
    run.script(&frame).unwrap()
}

/// The script of the first frame of a scene.
pub(crate) fn script(text: &str) -> String {
    script_of(text, 0)
}

/// A ball, with a material of its own that shines in a color.
pub(crate) fn shining_ball(name: &str, location: [f64; 3], radius: f64, color: &str) -> String {
    format!(
        "\n[body.{name}]\nshape.sphere.radius = {radius}\nlocation = {location:?}\nmaterial = \"{name}\"
[material.{name}]\ncolor = \"{color}\"\nfinish = \"luminous\"\n"
    )
}
