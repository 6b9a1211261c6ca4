//! Tests of particles in real POV-Ray: each has the right place and color, and thousands are parsed without warnings.

use std::fs;

use glam::DVec3;

use crate::image::{is_blue, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::{self, render_all};
use crate::scene::{DARK, script_of};

/// Checks two glowing particles, a young red one and an old blue one, and a particle with a streak.
#[test]
fn particles_are_seen_where_they_are() {
    let camera = Pinhole::new([0.0, 0.0, 10.0], [0.0, 0.0, 0.0]);
    let dot = |name: &str, keys: &str| {
        format!("[emitter.{name}]\nshape.sphere.radius = 0.4\nburst = 1\nglow = 1\nlifetime = 2\n{keys}\n")
    };
    let text = [
        "simulation = { duration = 1, frame_rate = 1 }\n".to_owned(),
        dot("young", "from.point = [-2, 0, 0]\ncolor = ['red', 'blue']\nstart = 1"),
        dot("old", "from.point = [2, 0, 0]\ncolor = ['red', 'blue']\nstart = -0.99"),
        dot("fast", "from.point = [0, -2, 0]\ncolor = 'red'\nspeed = 4\nstreak = 0.5"),
        camera.toml(),
        DARK.to_owned(),
        format!("[output]\nsize = [{}, {}]\n", SIZE[0], SIZE[1]),
    ]
    .concat();
    let [image] = render_all([script_of(&text, 1)], SIZE);
    let at = |x: f64, y: f64| image.at(camera.sees(DVec3::new(x, y, 0.0)));
    assert!(is_red(at(-2.0, 0.0)) && is_blue(at(2.0, 0.0)));
    // The streak's front end is at 2 m, and its rear end 2 m below.
    assert!(is_red(at(0.0, 1.9)) && is_red(at(0.0, 0.5)));
    assert!(!is_red(at(0.0, -0.3)) && !is_red(at(0.3, 0.5)));
}

#[test]
fn thousands_of_particles_are_parsed_without_a_word() {
    let script = script_of(
        "simulation = { duration = 1, frame_rate = 1, gravity = [0, -10, 0] }
        [emitter.drops]\nshape.sphere.radius = 0.01\nrate = 20000\nlifetime = 'uniform(0.5, 2)'
        spread = 30\nspeed = 'normal(5, 1)'\ncolor = ['white', 'blue']\nsize = [1, 2, 0]
        [emitter.sparks]\nshape.sphere.radius = 0.004\nrate = 5000\nlifetime = 0.5\nspread = 180
        speed = 3\nglow = 3\nstreak = 0.05\ncolor = ['yellow', 'red']
        [emitter.one]\nshape.sphere.radius = 0.01\nburst = 1",
        1,
    );
    assert!(script.matches("  sphere {").count() > 10_000 && script.matches("  cone {").count() > 2_000);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("many.pov"), script).unwrap();
    povray::run(folder.path(), &["+Imany.pov", "+Omany.png", "+W1", "+H1", "-MB"]).nothing("many particles");
}
