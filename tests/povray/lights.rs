//! Tests of every kind of light: the direction of the light, and whether it casts shadows.

use glam::DVec3;

use crate::image::{Image, brightness};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::{render, render_all};
use crate::scene::script;

fn front() -> Pinhole {
    Pinhole::new([0.0, 3.0, 6.0], [0.0, 0.5, 0.0])
}

/// Returns the script of a white ball over the ground with one light; `words` are the keys of the light.
fn lit(words: &str) -> String {
    let ball = "[body.ball]\nshape.sphere.radius = 0.3\nlocation = [0, 1.2, 0]\nmaterial = \"m\"\n";
    let rest = "[material.m]\nfinish = \"matte\"\n[environment]\nground.height = 0\n[light.l]\n";
    script(&format!("{ball}{rest}{words}{}", front().toml()))
}

#[test]
fn the_side_that_faces_a_light_is_the_bright_one() {
    let from_the_right = [
        "point.location = [5, 2, 1]",
        "area = { location = [5, 2, 1], size = 1 }",
        "sun.direction = [-1, -0.4, -0.2]",
        "point.location = [5, 2, 1]\nshadows = false",
        "sun.direction = [-1, -0.4, -0.2]\nshadows = false",
        "area = { location = [5, 2, 1], size = 1 }\nshadows = false",
    ];
    let images = render_all(from_the_right.map(lit), SIZE);
    for (image, light) in images.iter().zip(from_the_right) {
        assert!((30.0..230.0).contains(&image.brightness()), "{light}: {}", image.brightness());
        let side = |x: f64| brightness(image.at(front().sees(DVec3::new(x, 1.2, 0.15))));
        let (left, right) = (side(-0.2), side(0.2));
        assert!(right > left + 40.0, "{light}: {left} on the left, {right} on the right");
    }
}

#[test]
fn a_shadow_falls_where_it_should_and_only_where_it_is_wanted() {
    let from_above = [
        "point.location = [0, 8, 0]",
        "area = { location = [0, 8, 0], size = 0.5 }",
        "sun.direction = [0, -1, 0]",
    ];
    for light in from_above {
        let [with, without] = render_all([lit(light), lit(&format!("{light}\nshadows = false"))], SIZE);
        let ground = |x: f64| front().sees(DVec3::new(x, 0.0, 0.05));
        let at = |image: &Image, x| brightness(image.at(ground(x)));
        assert!(at(&with, 0.02) < at(&without, 0.02) - 40.0, "{light}");
        let beside = (at(&with, 1.5) - at(&without, 1.5)).abs();
        assert!(beside < 1.5, "{light}: {beside} beside the shadow");
    }
}

#[test]
fn light_has_its_color_and_intensity() {
    let scripts = ["", "intensity = 0.25", "color = \"#ff0000\"", "intensity = 0"];
    let [white, weak, red, none] =
        render_all(scripts.map(|words| lit(&format!("sun.direction = [0, -1, -1]\n{words}"))), SIZE);
    let place = front().sees(DVec3::new(0.0, 1.3, 0.25));
    let [white, weak, red, none] = [white, weak, red, none].map(|image| image.at(place));
    assert!(brightness(white) > brightness(weak) + 30.0 && brightness(weak) > brightness(none) + 10.0);
    assert_eq!((red[0], red[1], red[2]), (white[0], none[1], none[2]), "red is only red");
}

/// Checks the default lights of a scene that defines none: the upper left side of a ball is the bright one, and no pixel is black.
#[test]
fn the_usual_lights_are_pleasant() {
    let ball = "[body.ball]\nshape.sphere.radius = 1\nlocation = [0, 1.2, 0]\nmaterial = \"m\"\n";
    let camera = front();
    let image = render(&script(&format!("{ball}[material.m]\nfinish = \"matte\"\n{}", camera.toml())), SIZE);
    assert!((110.0..220.0).contains(&image.brightness()), "{}", image.brightness());
    let black = image.spot(|rgb| brightness(rgb) < 20.0).area();
    assert!(black < 1.0, "{black} black pixels");
    let at = |x: f64, y: f64| brightness(image.at(camera.sees(DVec3::new(x, y, 0.6))));
    let (bright, dark) = (at(-0.45, 1.75), at(0.45, 0.65));
    assert!(bright > dark + 40.0 && dark > 40.0, "{bright} and {dark}");
}
