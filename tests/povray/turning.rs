//! Tests of rotations: their sense follows the right-hand rule, and materials turn with the body.

use glam::DVec2;

use crate::image::{Image, is_green, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::render_all;
use crate::scene::{DARK, script, script_of};

fn front() -> Pinhole {
    Pinhole::new([0.0, 0.0, 10.0], [0.0; 3])
}

/// Returns a scene with a red box, 4 m long along x; `words` are the keys of the body.
fn rod(words: &str) -> String {
    format!(
        "[simulation]\nduration = 1\nframe_rate = 1\n[body.rod]\nshape.box.size = [4, 0.3, 0.3]\n{words}
material = \"red\"\n[material.red]\ncolor = \"red\"\nfinish = \"luminous\"\n{DARK}{}",
        front().toml()
    )
}

/// Returns true if the red rod goes from the lower left to the upper right, and false if it goes from the upper left to the lower right.
fn rises(image: &Image) -> bool {
    let side = |x: f64, y: f64| is_red(image.at(DVec2::new(80.0 + 15.0 * x, 50.0 + 15.0 * y)));
    let (rising, falling) = ([side(-1.0, 1.0), side(1.0, -1.0)], [side(-1.0, -1.0), side(1.0, 1.0)]);
    assert!(side(0.0, 0.0) && rising[0] == rising[1] && falling[0] == falling[1] && rising != falling);
    rising[0]
}

#[test]
fn a_turn_about_z_takes_x_towards_y() {
    let scripts = [
        script(&rod("orientation = { axis = [0, 0, 1], angle = 45 }")),
        script(&rod("orientation = [0, 0, 45]")),
        script(&rod("orientation = { quaternion = [0, 0, 0.3826834323650898, 0.9238795325112867] }")),
        script_of(&rod("angular_velocity = [0, 0, 0.7853981633974483]"), 1),
        script(&rod("orientation = { axis = [0, 0, 1], angle = -45 }")),
    ];
    let images = render_all(scripts, SIZE);
    assert_eq!(images.each_ref().map(rises), [true, true, true, true, false]);
    // The width from corner to corner at 22 pixels per meter; the nearer face looks 1.5 % larger.
    let width = |image: &Image| {
        let xs = image.spot(is_red).0.into_iter().map(|place| place.x);
        xs.clone().fold(f64::MIN, f64::max) - xs.fold(f64::MAX, f64::min)
    };
    let expected = (4.0 + 0.3) / std::f64::consts::SQRT_2 * 22.0 * 1.015;
    for image in &images {
        assert!((width(image) - expected).abs() < 2.0, "{} pixels wide, not {expected}", width(image));
    }
}

/// Returns a scene with a ball that is green on the positive side of one of its axes, and red on the other side.
fn halves(axis: char, words: &str) -> String {
    format!(
        "[simulation]\nduration = 1\nframe_rate = 1\n[body.ball]\nshape.sphere.radius = 2\n{words}
material = \"halves\"\n[material.halves]
sdl = \"texture {{ pigment {{ gradient {axis} color_map {{ [0.5 rgb <1, 0, 0>] [0.5 rgb <0, 1, 0>] }} scale 10 \
translate -{axis}*5 }} finish {{ ambient 0 diffuse 0 emission 1 }} }}\"\n{DARK}{}",
        front().toml()
    )
}

/// Checks that patterns turn with their bodies. By the right-hand rule, a quarter turn about x takes y to z, about y z to x, and about z x
/// to y. So the green half faces the viewer, is on the right, or is on top.
#[test]
fn a_pattern_turns_with_its_body() {
    const QUARTER_PER_SECOND: &str = "1.5707963267948966";
    let scripts = [
        script_of(&halves('y', &format!("angular_velocity = [{QUARTER_PER_SECOND}, 0, 0]")), 1),
        script_of(&halves('z', &format!("angular_velocity = [0, {QUARTER_PER_SECOND}, 0]")), 1),
        script_of(&halves('x', &format!("angular_velocity = [0, 0, {QUARTER_PER_SECOND}]")), 1),
        script(&halves('x', "orientation = { axis = [0, 0, 1], angle = 90 }")),
        script(&halves('x', "")),
    ];
    let [about_x, about_y, about_z, at_once, not_turned] = render_all(scripts, SIZE);
    assert!(about_x.spot(is_red).area() < 0.02 * about_x.spot(is_green).area());
    // The centroid of a half disk is 4 r / 3π from its straight edge: 0.85 m for a radius of 2 m, at 22 pixels per meter.
    let middle = |image: &Image| image.spot(is_green).middle() - image.spot(is_red).middle();
    for (image, x, y) in
        [(about_y, 1.0, 0.0), (about_z, 0.0, -1.0), (at_once, 0.0, -1.0), (not_turned, 1.0, 0.0)]
    {
        let way = middle(&image);
        let expected = 38.0 * DVec2::new(x, y);
        assert!(way.distance(expected) < 3.0, "red → green is {way}, not {expected}");
    }
}

/// Checks that Euler angles mean the same as in POV-Ray: the matrix that jabuka writes equals a `rotate` with these angles.
#[test]
fn euler_angles_are_those_of_povray() {
    let scene = format!(
        "[body.crate]\nshape.box.size = [3, 2, 1]\nlocation = [0.5, 0.25, 0]\norientation = [30, 40, 50]
material = \"tiles\"\n[material.tiles]
sdl = \"texture {{ pigment {{ checker rgb <1, 0, 0> rgb <0, 1, 0> scale 0.5 }} finish {{ ambient 0.5 }} }}\"\n{}",
        front().toml()
    );
    let ours = script(&scene);
    let (before, rest) = ours.split_once("matrix <").expect("the place of a box is a matrix");
    let (_, after) = rest.split_once('>').unwrap();
    let with = |rotate: &str| format!("{before}{rotate} translate <0.5, 0.25, 0>{after}");
    let scripts = [with("rotate <30, 40, 50>"), with("rotate z*50 rotate y*40 rotate x*30"), ours.clone()];
    let [by_rotate, in_another_order, by_matrix] = render_all(scripts, SIZE);
    // The matrix is rounded to nine digits, so an edge may move across the center of a pixel.
    let same = by_matrix.difference(&by_rotate);
    assert!(same < 0.02, "{same}");
    let other = by_matrix.difference(&in_another_order);
    assert!(other > 1.0, "{other}");
}
