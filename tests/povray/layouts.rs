//! Tests that the self-contained and the shared layout give the same pictures.

use std::fs;

use crate::image::Image;
use crate::povray;
use crate::support::{compile, scene};

#[test]
fn a_shared_part_changes_no_pixel() {
    let images = ["self-contained", "shared"].map(|layout| {
        let folder = tempfile::tempdir().unwrap();
        let set = format!("output.layout={layout}");
        compile(&scene("tumbling_box"), folder.path(), &["--frames", "176", "--set", &set]);
        assert_eq!(folder.path().join("common.inc").exists(), layout == "shared");
        let arguments = ["+Iframe_0176.pov", "+Oimage.png", "+W160", "+H90"];
        povray::run(folder.path(), &arguments).nothing(layout);
        let image = Image::read(&folder.path().join("image.png"));
        fs::remove_dir_all(folder.path()).unwrap();
        image
    });
    assert_eq!(images[0].difference(&images[1]), 0.0);
}

/// Checks trails of three kinds: one reaches back to the beginning, one has a limited length and tapers, and one belongs to a body that
/// stops and moves again.
#[test]
fn trails_that_scripts_share_are_the_same_trails() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "
        simulation = { duration = 4, integrator = 'rk4' }
        camera = { location = [0, 0, 9], look_at = [0, 0, 0] }
        [body.whole]
        shape.sphere.radius = 0.2
        location = [3, 0, 0]
        velocity = [0, 4, 0]
        trail.width = 0.3
        [body.end]
        shape.sphere.radius = 0.2
        location = [-2, 0, 1]
        velocity = [0, 3, 0]
        trail = { duration = 1.8, width = 0.3 }
        [body.slow]
        shape.sphere.radius = 0.2
        motion.formula.location = ['if(t < 1, t, if(t < 3, 1, t - 2)) - 2', -2, 0]
        trail.width = 0.3
        [force.pull.spring]
        between = ['whole', [0, 0, 0]]
        stiffness = 200
        rest_length = 0
        [force.other.spring]
        between = ['end', [0, 0, 0]]
        stiffness = 100
        rest_length = 0
        ";
    fs::write(&scene, text).unwrap();
    let images = ["self-contained", "shared"].map(|layout| {
        let scripts = folder.path().join(layout);
        let set = format!("output.layout={layout}");
        compile(&scene, &scripts, &["--frames", "97", "--set", &set]);
        let script = fs::read_to_string(scripts.join("frame_0097.pov")).unwrap();
        assert_eq!(script.contains("#include \"trail_"), layout == "shared", "{script}");
        povray::run(&scripts, &["+Iframe_0097.pov", "+Oimage.png", "+W64", "+H36"]).nothing(layout);
        Image::read(&scripts.join("image.png"))
    });
    assert_eq!(images[0].difference(&images[1]), 0.0);
}
