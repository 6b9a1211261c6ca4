//! Tests that a frame rendered by the preview equals the image that `jabuka still` makes.

use std::fs;

use crate::server::Scene;
use crate::support::stderr;

const SMALL: &str = "
    simulation.duration = 1
    [output]
    size = [96, 72]
    [body.ball]
    shape.sphere.radius = 1
    velocity = [1, 0, 0]
    angular_velocity = [0, 1, 0]
    material = 'marble'
    ";

/// Returns a PNG without its optional chunks, such as the time that POV-Ray writes. The type of every chunk that is needed to decode the
/// image begins with a capital letter.
fn timeless(png: &[u8]) -> Vec<u8> {
    let mut kept = png[..8].to_vec();
    let mut rest = &png[8..];
    while let Some((length, _)) = rest.split_first_chunk::<4>() {
        // A chunk consists of length, type, data and checksum.
        let (chunk, after) = rest.split_at(u32::from_be_bytes(*length) as usize + 12);
        if chunk[4].is_ascii_uppercase() {
            kept.extend_from_slice(chunk);
        }
        rest = after;
    }
    kept
}

#[test]
fn a_frame_is_rendered_first_as_a_draft_and_then_as_the_final_image() {
    let server = Scene::of(SMALL).served();
    server.shows("rendering.mjs", "a_frame_is_rendered_first_as_a_draft_and_then_as_the_final_image");
    // Frame 6 at 25 frames per second is at 0.24 s.
    for quality in ["draft", "final"] {
        let still = ["still", "scene.toml", "--time", "0.24", "--quality", quality, "-o", "still.png"];
        let output = server.scene.jabuka(&still).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        let image = |name: &str| timeless(&fs::read(server.scene.folder().join(name)).unwrap());
        let same = image(&format!("{quality}.png")) == image("still.png");
        let sizes = [image(&format!("{quality}.png")).len(), image("still.png").len()];
        assert!(same, "the {quality} is not the image that `jabuka still` makes: {sizes:?} bytes");
    }
}

/// The image equals that of a scene whose `[camera]` is the one that the page copies.
#[test]
fn the_viewers_own_camera_is_rendered() {
    let server = Scene::of(SMALL).served();
    server.shows("rendering.mjs", "the_viewers_own_camera_is_rendered");
    let still = ["still", "own.toml", "--time", "0.24", "--quality", "final", "-o", "still.png"];
    let output = server.scene.jabuka(&still).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let image = |name: &str| timeless(&fs::read(server.scene.folder().join(name)).unwrap());
    assert!(image("own.png") == image("still.png"), "the image is not that of the copied camera");
}

#[test]
fn without_povray_the_error_is_shown() {
    let povray = ["--povray", "/nonexistent/povray"];
    let server = Scene::of(SMALL).previewed_with(&povray).served();
    let shown = server.shows("rendering.mjs", "without_povray_the_error_is_shown");
    let still = ["still", "scene.toml", "-o", "still.png"];
    let output = server.scene.jabuka(&still).args(povray).output().unwrap();
    assert!(!output.status.success());
    assert!(shown.contains("/nonexistent/povray"), "{shown}");
    assert_eq!(shown.trim(), stderr(&output).trim());
}
