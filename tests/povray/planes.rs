//! Tests of planes: their place in the picture, for all orientations and materials.

use glam::{DQuat, DVec3};

use crate::image::{brightness, is_green};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::render_all;
use crate::scene::{script, shining_ball};

const PLAIN: &str = "material = \"m\"\n[material.m]\ncolor = \"#00ff00\"\nfinish = \"luminous\"\n";
const PATTERN: &str = "material = \"m\"\n[material.m]
sdl = \"texture { pigment { checker rgb <0, 1, 0> rgb <0, 0.5, 0> } finish { diffuse 0 emission 1 } }\"\n";

/// Checks the place of tilted planes. The material decides how a plane is written: a plain one by normal and distance, others with a
/// matrix.
#[test]
fn a_turned_plane_is_where_it_should_be() {
    let location = DVec3::new(0.5, -0.4, 0.3);
    let turned = "orientation = { axis = [0, 0, 1], angle = 20 }\n";
    let with_normal = "shape.plane.normal = [-0.3, 1, 0.1]\n";
    let upright = DVec3::new(-0.3, 1.0, 0.1).normalize();
    let by_turn = DQuat::from_rotation_z(20f64.to_radians());
    let cases = [
        (format!("shape.plane = {{}}\n{turned}"), by_turn * DVec3::Y),
        (with_normal.to_owned(), upright),
        (format!("{with_normal}{turned}"), by_turn * upright),
    ];
    let camera = Pinhole { angle: 110.0, ..Pinhole::new([0.5, 0.5, 6.0], [0.5, -0.4, 0.0]) };
    // The last of these planes fades into the black sky, so it is checked nearer to the camera.
    let materials = [(PLAIN, false, 0.03), (PATTERN, false, 0.03), ("", false, 0.03), ("", true, 0.3)];
    for (material, fog, under) in materials {
        let scene = |words: &str| {
            format!(
                "[body.p]\nlocation = {location}\n{words}{material}[environment]\nsky = false\nfog = {fog}\n{}",
                camera.toml()
            )
        };
        let is_there = |rgb| if material.is_empty() { brightness(rgb) > 40.0 } else { is_green(rgb) };
        let scripts = cases.each_ref().map(|(words, _)| script(&scene(words)));
        for (image, (words, normal)) in render_all(scripts, SIZE).iter().zip(&cases) {
            let back = (camera.location - camera.look_at).normalize();
            let along = normal.cross(back).normalize();
            for step in -3..=3 {
                let pixel = image.at(camera.sees(location + along * (0.4 * f64::from(step))));
                assert!(is_there(pixel), "{words}: {pixel:?} on the plane");
            }
            // In the distance, the plane ends at its horizon; two degrees above it the picture is empty.
            let away = (-back - normal * (-back).dot(*normal)).normalize();
            let horizon = |over: f64| camera.sees(camera.location + away + normal * over);
            let (over, under) = (image.at(horizon(0.03)), image.at(horizon(-under)));
            assert!(is_there(under) && over == [0, 0, 0], "{words}: {over:?} over {under:?}");
        }
    }
}

/// Checks the sign of a plain plane's distance from the origin: half of a ball is below the plane.
#[test]
fn a_plane_cuts_a_ball_where_it_should() {
    let camera = Pinhole::new([0.0, 3.0, 8.0], [0.0, 1.0, 0.0]);
    let scene = |height: f64, material: &str| {
        let ball = shining_ball("ball", [0.0, 1.0, 0.0], 1.0, "#ff0000");
        script(&format!(
            "[body.p]\nshape.plane = {{}}\nlocation = [3, {height}, 0]\n{material}{ball}{}",
            camera.toml()
        ))
    };
    let scripts = [scene(1.0, PLAIN), scene(1.0, PATTERN), scene(-1.0, PLAIN), scene(-1.0, PATTERN)];
    let [half_plain, half_pattern, under_plain, under_pattern] = render_all(scripts, SIZE);
    let low = camera.sees(DVec3::new(0.0, 0.4, 0.8));
    let high = camera.sees(DVec3::new(0.0, 1.6, 0.8));
    for image in [&half_plain, &half_pattern] {
        assert!(is_green(image.at(low)) && image.at(high) == [255, 0, 0]);
    }
    for image in [&under_plain, &under_pattern] {
        assert!(image.at(low) == [255, 0, 0] && image.at(high) == [255, 0, 0]);
    }
}

/// Checks a plane tilted by 45° towards the viewer: it leaves the front of the ball visible, which a level plane hides.
#[test]
fn a_turned_plane_cuts_a_ball_where_it_should() {
    let camera = Pinhole::new([0.0, 3.0, 8.0], [0.0, 1.0, 0.0]);
    let scene = |turn: &str, material: &str| {
        let ball = shining_ball("ball", [0.0, 1.0, 0.0], 1.0, "#ff0000");
        let plane = format!("[body.p]\nshape.plane = {{}}\nlocation = [0, 1, 0]\n{turn}{material}");
        script(&(plane + &ball + &camera.toml()))
    };
    let front = camera.sees(DVec3::new(0.0, 0.8, 0.95));
    for material in [PLAIN, PATTERN, ""] {
        let scripts = [scene("orientation = [45, 0, 0]\n", material), scene("", material)];
        let [turned, level] = render_all(scripts, SIZE).map(|image| image.at(front));
        assert!(turned == [255, 0, 0] && level != [255, 0, 0], "{turned:?} and {level:?}");
    }
}

/// Checks that a plane without a material has the checkered look of the ground.
#[test]
fn a_plane_without_a_material_is_checkered() {
    let camera = Pinhole { up: DVec3::NEG_Z, ..Pinhole::new([0.0, 6.0, 0.0], [0.0; 3]) };
    let scene =
        "[body.p]\nshape.plane = {}\n[body.ball]\nshape.sphere.radius = 0.2\nlocation = [0, 0.2, 0]\n";
    let tilted = scene.replace("{}\n", "{}\norientation = [0, 0, 10]\n");
    let images = render_all([scene, &tilted].map(|text| script(&(text.to_owned() + &camera.toml()))), SIZE);
    for image in &images {
        let shades: Vec<f64> =
            image.spot(|_| true).0.iter().step_by(7).map(|place| brightness(image.at(*place))).collect();
        let count = |range: std::ops::Range<f64>| shades.iter().filter(|s| range.contains(s)).count();
        let all = shades.len();
        assert!((100.0..235.0).contains(&image.brightness()), "{}", image.brightness());
        let middle = image.brightness();
        let (dark, light) = (count(0.0..middle), count(middle..256.0));
        assert!(dark > all / 4 && light > all / 4, "{dark} dark and {light} light of {all}");
    }
}

/// Checks that a plane without a material fades into the horizon like the ground, wherever its location is, and does not fade without fog.
#[test]
fn a_plane_without_a_material_looks_like_the_ground() {
    let camera = Pinhole::new([0.0, 2.0, 10.0], [0.0, 1.0, 0.0]);
    let ball = shining_ball("ball", [0.0, 1.0, 0.0], 1.0, "#ff0000");
    let of = |floor: &str| script(&format!("{ball}{floor}{}", camera.toml()));
    // The tiles of this scene are 0.2 m long, and the plane is moved by an even number of them.
    let plane = "[body.p]\nshape.plane = {}\nlocation = [40, -0.5, -20]\n";
    let no_fog = "[environment]\nfog = false\n";
    let grounds = ["ground.height = -0.5\n", "ground.height = -0.5\nfog = false\n"];
    let [ground, clear_ground] = grounds.map(|words| of(&format!("[environment]\n{words}")));
    let scripts = [ground, of(plane), clear_ground, of(&format!("{plane}{no_fog}"))];
    let [ground, plane, clear_ground, clear_plane] = render_all(scripts, SIZE);
    for (a, b) in [(&ground, &plane), (&clear_ground, &clear_plane)] {
        let difference = a.difference(b);
        assert!(difference < 1.0, "{difference}");
    }
    assert!(plane.difference(&clear_plane) > 5.0, "{}", plane.difference(&clear_plane));
}
