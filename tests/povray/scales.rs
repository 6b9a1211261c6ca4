//! Tests that a scene of any size looks the same, although POV-Ray itself works only with numbers of moderate size.

use glam::DVec3;

use crate::image::{is_blue, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::render_all;
use crate::scene::{script, shining_ball};

/// Returns the script of a red ball on the ground and a blue box in the air, with all lengths multiplied by `scale`.
fn scene(scale: f64, rest: &str) -> String {
    let length = |number: f64| format!("{:e}", number * scale);
    let [one, two, three] = [1.0, 2.0, 3.0].map(length);
    format!(
        "[body.ball]\nshape.sphere.radius = {one}\nlocation = [0, {one}, 0]\nmaterial = \"red\"
[body.crate]\nshape.box.size = [{one}, {one}, {one}]\nlocation = [{three}, {two}, 0]\nmaterial = \"blue\"
[material.red]\ncolor = \"red\"\n[material.blue]\ncolor = \"blue\"\n{rest}"
    )
}

#[test]
fn the_tiny_and_the_huge_look_like_what_is_as_large_as_we_are() {
    let scales = [1.0, 1e-10, 1e13, 1e-3, 1e6];
    let images = render_all(scales.map(|scale| script(&scene(scale, ""))), SIZE);
    assert!((80.0..230.0).contains(&images[0].brightness()), "{}", images[0].brightness());
    for (image, scale) in images.iter().zip(scales) {
        // Rounding moves some edges and tiles across the center of a pixel.
        let difference = image.difference(&images[0]);
        assert!(difference < 1.0, "times {scale:e}: {difference}");
    }
}

#[test]
fn a_camera_of_the_scenes_own_sees_the_tiny_and_the_huge() {
    let scales = [1e-10, 1e13];
    let cameras = scales.map(|scale| {
        let scaled = |v: [f64; 3]| v.map(|number| number * scale);
        Pinhole::new(scaled([2.0, 3.0, 12.0]), scaled([1.0, 1.0, 0.0]))
    });
    let toml = |camera: &Pinhole| {
        let [location, look_at] = [camera.location, camera.look_at].map(|v| format!("{:?}", v.to_array()));
        format!("[camera]\nlocation = {location}\nlook_at = {look_at}\n")
    };
    let scripts = [0, 1].map(|i| script(&scene(scales[i], &toml(&cameras[i]))));
    for ((image, camera), scale) in render_all(scripts, SIZE).iter().zip(&cameras).zip(scales) {
        let at = |x: f64, y: f64| image.at(camera.sees(DVec3::new(x, y, 0.0) * scale));
        assert!(is_red(at(0.0, 1.0)), "times {scale:e}: {:?}", at(0.0, 1.0));
        assert!(is_blue(at(3.0, 2.0)), "times {scale:e}: {:?}", at(3.0, 2.0));
    }
}

#[test]
fn the_unit_of_the_scripts_changes_no_picture() {
    let with = |unit: &str| script(&scene(1.0, &format!("[povray]\nunit = {unit}\n")));
    let [metre, centimetre, kilometre] = render_all([with("1"), with("0.01"), with("10")], SIZE);
    for image in [&centimetre, &kilometre] {
        let difference = image.difference(&metre);
        assert!(difference < 1.0, "{difference}");
    }
}

/// Checks bodies far from the origin, where POV-Ray has fewer digits left: at a distance of 2 km, objects of one meter are still sharp.
#[test]
fn bodies_far_from_the_origin_are_to_be_seen() {
    let far = DVec3::new(1000.0, -500.0, 2000.0);
    let camera = Pinhole::new((far + DVec3::new(0.0, 1.0, 8.0)).to_array(), far.to_array());
    let ball = shining_ball("ball", far.to_array(), 0.5, "#ff0000");
    let [image] = render_all([script(&(ball + &camera.toml()))], SIZE);
    let off = image.spot(|rgb| rgb == [255, 0, 0]).middle().distance(camera.sees(far));
    assert!(off < 0.4, "{off} pixels off");
}
