//! Tests of using scripts in other POV-Ray projects, as `docs/reuse.md` describes.

use std::fs;
use std::path::Path;

use glam::DVec2;

use crate::image::Image;
use crate::povray;
use crate::support::{compile, root};

const SCENE: &str = "
simulation = { duration = 0.04 }
[body.red]
shape.sphere.radius = 1
material.color = 'red'
arrows.velocity = true
velocity = [0, 3, 0]
[label.time]
text = 't = ${t}'
";

/// Returns the first example of `docs/reuse.md` that contains a word.
fn example(word: &str) -> String {
    let page = fs::read_to_string(root().join("docs/reuse.md")).unwrap();
    let blocks = page.split("```pov\n").skip(1).map(|rest| rest.split("```").next().unwrap().to_owned());
    blocks.into_iter().find(|block| block.contains(word)).unwrap()
}

fn render(folder: &Path, script: &str) -> Image {
    fs::write(folder.join("mine.pov"), script).unwrap();
    let arguments = ["+Imine.pov", "+Omine.png", "+FN8", "+WT1", "+W64", "+H36"];
    povray::run(folder, &arguments).nothing(script);
    Image::read(&folder.join("mine.png"))
}

fn scripts(folder: &Path, out: &str, arguments: &[&str]) -> String {
    let scene = folder.join("scene.toml");
    fs::write(&scene, SCENE).unwrap();
    compile(&scene, &folder.join(out), arguments);
    fs::read_to_string(folder.join(out).join("frame_0001.pov")).unwrap()
}

#[test]
fn a_whole_frame_can_be_included() {
    let folder = tempfile::tempdir().unwrap();
    scripts(folder.path(), "out/projectile", &[]);
    let script = example("frame_0050").replace("frame_0050", "frame_0001");
    render(folder.path(), &script);
}

#[test]
fn bodies_stand_without_camera_lights_and_ground() {
    let folder = tempfile::tempdir().unwrap();
    let bare = folder.path().join("bare");
    fs::create_dir(&bare).unwrap();
    for name in ["camera.inc", "lights.inc", "environment.inc"] {
        fs::write(bare.join(name), "").unwrap();
    }
    let script = scripts(folder.path(), "out/bare", &["--templates", bare.to_str().unwrap()]);
    for word in ["camera {", "light_source", "plane {", "sky_sphere"] {
        assert!(!script.contains(word), "{word}\n{script}");
    }
    // Seen from the side of the page's camera, the red ball is visible, and nothing is behind it.
    let mine = example("look_at").replace("<4, 3, 12>", "<0, 0, 9>").replace("<4, 2, 0>", "0");
    let image = render(folder.path(), &mine.replace("frame_number", "1"));
    let [r, g, b] = image.at(DVec2::new(32.0, 18.0));
    assert!(r > 100 && g < 60 && b < 60, "{:?}", [r, g, b]);
    assert_eq!(image.at(DVec2::new(2.0, 2.0)), [0, 0, 0]);
}

#[test]
fn a_template_that_draws_bodies_itself_keeps_arrows_and_labels() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("own");
    fs::create_dir(&own).unwrap();
    fs::write(own.join("frame.pov"), example("showing_sdl")).unwrap();
    let usual = scripts(folder.path(), "usual", &[]);
    let script = scripts(folder.path(), "own-out", &["--templates", own.to_str().unwrap()]);
    let label = usual.lines().find(|line| line.contains("t = 0.04")).unwrap();
    assert!(
        usual.contains("Arrow(") && script.contains("Arrow(") && script.matches(label).count() > 0,
        "{script}"
    );
    assert!(script.contains("sphere { 0, 0.2"), "{script}");
    render(folder.path(), &script);
}
