//! Tests of the camera: orthographic projection, and a lens with depth of field.

use glam::DVec2;

use crate::image::{is_blue, is_red};
use crate::pinhole::SIZE;
use crate::povray::render_all;
use crate::scene::{DARK, script, shining_ball};

#[test]
fn without_perspective_places_are_proportional_and_nearness_changes_nothing() {
    let camera =
        "\n[camera]\nprojection = 'orthographic'\nlocation = [0, 0, 9]\nlook_at = [0, 0, 0]\nwidth = 16\n";
    let bodies = shining_ball("right", [4.0, 2.0, -7.0], 0.5, "#ff0000")
        + &shining_ball("left", [-4.0, -2.0, 5.0], 0.5, "#0000ff");
    let [image] = render_all([script(&(bodies + DARK + camera))], SIZE);
    let (right, left) = (image.spot(is_red), image.spot(is_blue));
    // The scale is ten pixels per meter from the center at (80, 50); y points down.
    assert!(right.middle().distance(DVec2::new(120.0, 30.0)) < 0.3, "{}", right.middle());
    assert!(left.middle().distance(DVec2::new(40.0, 70.0)) < 0.3, "{}", left.middle());
    let ratio = right.area() / left.area();
    assert!((0.97..1.03).contains(&ratio), "{ratio}");
}

#[test]
fn a_lens_blurs_what_is_not_in_focus() {
    let camera = |lens: &str| format!("\n[camera]\nlocation = [0, 0, 9]\nlook_at = [0, 0, 0]\n{lens}\n");
    let bodies = shining_ball("near", [-1.5, 0.0, 0.0], 0.5, "#ff0000")
        + &shining_ball("far", [3.0, 0.0, -9.0], 1.0, "#0000ff")
        + DARK;
    let scripts = ["", "aperture = 0.5", "aperture = 0.5\nfocus = [0, 0, -9]"]
        .map(|lens| script(&(bodies.clone() + &camera(lens))));
    let [sharp, near, far] = render_all(scripts, SIZE);
    // Blur spreads the edge of a ball, and leaves fewer pixels that are fully red or blue.
    let area = |image: &crate::image::Image| (image.spot(is_red).area(), image.spot(is_blue).area());
    let ((red, blue), (red_near, blue_near), (red_far, blue_far)) = (area(&sharp), area(&near), area(&far));
    assert!(
        (red_near / red - 1.0).abs() < 0.1 && (blue_near / blue - 1.0).abs() > 0.1,
        "{red_near} {blue_near}"
    );
    assert!((blue_far / blue - 1.0).abs() < 0.1 && (red_far / red - 1.0).abs() > 0.1, "{red_far} {blue_far}");
}
