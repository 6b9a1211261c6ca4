//! Tests that bodies appear in the picture where the scene's camera must see them: right, up and near.

use glam::{DVec2, DVec3};

use crate::image::{is_blue, is_green, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::render_all;
use crate::scene::{DARK, script, script_of, shining_ball};

#[test]
fn a_ball_is_where_the_camera_sees_it() {
    let wide = Pinhole { angle: 75.0, ..Pinhole::new([-3.0, 4.0, 6.0], [0.5, 0.0, -1.0]) };
    let cameras = [
        Pinhole::new([0.0, 0.0, 10.0], [0.0; 3]),
        Pinhole::new([6.0, 5.0, 8.0], [0.0, 0.5, 0.0]),
        Pinhole::new([-7.0, -3.0, -9.0], [1.0, 0.0, 0.0]),
        wide,
    ];
    let balls = [([0.0; 3], "#ff0000"), ([1.5, 1.0, -1.0], "#00ff00"), ([-1.2, 0.4, 1.5], "#0000ff")];
    let bodies: String =
        balls.map(|(location, color)| shining_ball(&color[1..], location, 0.2, color)).concat();
    let scripts = cameras.each_ref().map(|camera| script(&format!("{bodies}{DARK}{}", camera.toml())));
    for (image, camera) in render_all(scripts, SIZE).iter().zip(&cameras) {
        for ((location, _), is_color) in balls.iter().zip([is_red, is_green, is_blue]) {
            let expected = camera.sees(DVec3::from_array(*location));
            let off = image.spot(is_color).middle().distance(expected);
            // The picture of a ball is an ellipse, whose center is some hundredths of a pixel away from that of the ball.
            assert!(off < 0.4, "{off} pixels from {expected}");
        }
    }
}

#[test]
fn x_goes_right_y_up_and_z_towards_the_viewer() {
    let ball = |name, location, color| shining_ball(name, location, 0.3, color);
    let camera = Pinhole::new([0.0, 0.0, 10.0], [0.0; 3]);
    let along = |location: [f64; 3]| script(&(ball("ball", location, "#ff0000") + DARK + &camera.toml()));
    let scripts = [along([2.0, 0.0, 0.0]), along([0.0, 1.0, 0.0]), along([0.0, 0.0, 4.0]), along([0.0; 3])];
    let [x, y, z, origin] = render_all(scripts, SIZE).map(|image| image.spot(is_red));
    assert!(x.middle().x > 100.0 && (x.middle().y - 50.0).abs() < 1.0);
    assert!(y.middle().y < 40.0 && (y.middle().x - 80.0).abs() < 1.0);
    // At 6/10 of the distance, the ball has (10/6)² times the area.
    let nearer = z.area() / origin.area();
    assert!((2.4..3.2).contains(&nearer), "{nearer} times as large");
}

/// Checks cameras that look straight down or up: they are the limits of tilting the camera, and x stays on the right.
#[test]
fn x_is_on_the_right_for_a_camera_that_looks_straight_down_or_up() {
    let bodies = shining_ball("x", [1.0, 0.0, 0.0], 0.2, "#ff0000")
        + &shining_ball("z", [0.0, 0.0, 1.0], 0.2, "#0000ff")
        + DARK;
    let down = Pinhole { up: DVec3::NEG_Z, ..Pinhole::new([0.0, 6.0, 0.0], [0.0; 3]) };
    let up = Pinhole { up: DVec3::Z, ..Pinhole::new([0.0, -6.0, 0.0], [0.0; 3]) };
    let cameras = [down, up];
    let scripts = cameras.each_ref().map(|camera| script(&format!("{bodies}{}", camera.toml())));
    for (image, camera) in render_all(scripts, SIZE).iter().zip(&cameras) {
        let (x, z) = (image.spot(is_red).middle(), image.spot(is_blue).middle());
        assert!(x.x > 100.0, "x is at {x}");
        assert!(x.distance(camera.sees(DVec3::X)) < 0.5, "x is at {x}");
        assert!(z.distance(camera.sees(DVec3::Z)) < 0.5, "z is at {z}");
    }
}

/// Checks that the default camera shows the whole motion, from the first frame to the last.
#[test]
fn the_usual_camera_sees_the_whole_motion() {
    let ball = shining_ball("ball", [-5.0, 0.0, 0.0], 0.5, "#ff0000");
    let thrown = ball.replace("shape", "velocity = [2.5, 1, 0]\nshape");
    let simulation = "[simulation]\nduration = 4\nframe_rate = 1\n";
    let scene = format!("{simulation}{thrown}{DARK}");
    let images = render_all([0, 2, 4].map(|frame| script_of(&scene, frame)), SIZE);
    for image in &images {
        let spot = image.spot(is_red);
        assert!(spot.area() > 20.0, "the ball is to be seen");
        let at_edge = |p: &&DVec2| p.x < 1.0 || p.y < 1.0 || p.x > 159.0 || p.y > 99.0;
        assert_eq!(spot.0.iter().filter(at_edge).count(), 0, "the ball is not cut");
    }
}
