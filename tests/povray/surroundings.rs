//! Tests of the environment: ground, sky and fog.

use glam::{DVec2, DVec3};

use crate::image::{Image, Rgb, brightness, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::{render, render_all};
use crate::scene::{script, shining_ball};

fn front() -> Pinhole {
    Pinhole::new([0.0, 2.0, 10.0], [0.0, 1.0, 0.0])
}

/// Returns the script of a red ball of radius 1 about the origin; `environment` holds the keys of the environment.
fn scene(environment: &str) -> String {
    let ball = shining_ball("ball", [0.0; 3], 1.0, "#ff0000");
    script(&format!("{ball}[environment]\n{environment}\n{}", front().toml()))
}

#[test]
fn the_ball_is_to_be_seen_in_all_surroundings() {
    let all = [
        "",
        "ground = false",
        "sky = \"#204060\"",
        "fog = false",
        "ground = false\nfog = false\nsky = false",
        "ground = { height = -3, tile = 0.5 }\nsky = [0.2, 0.8, 0.2]",
        "ground.height = -1\nfog = false\nsky = \"white\"",
    ];
    for (image, words) in render_all(all.map(scene), SIZE).iter().zip(all) {
        assert!(is_red(image.at(front().sees(DVec3::ZERO))), "{words}");
        let range = if words.contains("sky = false") { 2.0..60.0 } else { 60.0..240.0 };
        assert!(range.contains(&image.brightness()), "{words}: {}", image.brightness());
    }
}

#[test]
fn the_sky_has_its_color() {
    let words = ["sky = \"#204060\"", "sky = false", "", "ground = false\nsky = \"#204060\""];
    let [plain, none, usual, all_around] = render_all(words.map(scene), SIZE);
    let top = |image: &Image| image.at(DVec2::new(10.0, 1.0));
    let near = |a: Rgb, b: Rgb| (0..3).all(|i| a[i].abs_diff(b[i]) <= 1);
    assert!(near(top(&plain), [0x20, 0x40, 0x60]), "{:?}", top(&plain));
    assert_eq!(top(&none), [0; 3]);
    let [r, _, b] = top(&usual);
    assert!(b > r && b > 150, "the usual sky is blue: {:?}", top(&usual));
    let bottom = all_around.at(DVec2::new(10.0, 98.0));
    assert!(near(bottom, [0x20, 0x40, 0x60]), "without ground there is sky below: {bottom:?}");
}

#[test]
fn the_ground_is_at_its_height() {
    let words = ["ground.height = 0", "ground.height = -1", ""];
    let [half, under, usual] = render_all(words.map(scene), SIZE);
    let low = front().sees(DVec3::new(0.0, -0.5, 0.8));
    let high = front().sees(DVec3::new(0.0, 0.5, 0.8));
    assert!(is_red(half.at(high)) && !is_red(half.at(low)));
    for image in [&under, &usual] {
        assert!(is_red(image.at(high)) && is_red(image.at(low)));
    }
}

/// Checks the size of the ground's tiles. A corner of a tile is below the origin.
#[test]
fn tiles_are_as_large_as_they_should_be() {
    let down = Pinhole { up: DVec3::NEG_Z, ..Pinhole::new([0.0, 9.0, 0.0], [0.0; 3]) };
    let scene = |tile: f64| {
        let ball = shining_ball("ball", [-2.5, 0.1, 1.5], 0.1, "#ff0000");
        let sun = "[light.l]\nsun.direction = [0, -1, 0]\nshadows = false\n";
        let ground = format!("[environment]\nground = {{ height = 0, tile = {tile:?} }}\n");
        script(&format!("{ball}{sun}{ground}{}", down.toml()))
    };
    let [one, two] = render_all([scene(1.0), scene(2.0)], SIZE);
    let shade = |image: &Image, x: f64, z: f64| brightness(image.at(down.sees(DVec3::new(x, 0.0, z))));
    let same = |a: f64, b: f64| (a - b).abs() < 4.0;
    assert!(!same(shade(&one, 0.5, 0.5), shade(&one, 1.5, 0.5)));
    assert!(same(shade(&one, 0.5, 0.5), shade(&one, 1.5, 1.5)));
    assert!(same(shade(&two, 0.5, 0.5), shade(&two, 1.5, 0.5)));
    assert!(!same(shade(&two, 0.5, 0.5), shade(&two, 2.5, 0.5)));
}

/// Checks the horizon: with fog, the ground fades into the color of the horizon; without, it ends in a sharp line.
#[test]
fn fog_hides_the_horizon() {
    let [fog, clear] = render_all(["fog = true", "fog = false"].map(scene), SIZE);
    // The camera looks down with a slope of 0.1, so the horizon is 0.1 above the center.
    let along = |over: f64| front().sees(DVec3::new(-3.0, 2.0 + over, 0.0));
    let step = |image: &Image| brightness(image.at(along(0.08))) - brightness(image.at(along(-0.08)));
    assert!(step(&clear) > 30.0, "{}", step(&clear));
    assert!(step(&fog).abs() < 15.0, "{}", step(&fog));
}

/// Checks that a scene without bodies, or with only a plane, gives a picture.
#[test]
fn an_empty_scene_has_surroundings() {
    for text in ["title = \"empty\"", "[body.floor]\nshape.plane = {}\n"] {
        let image = render(&script(text), SIZE);
        assert!((80.0..240.0).contains(&image.brightness()), "{text}: {}", image.brightness());
    }
}

/// Returns the script of a ball with the material `moon` in a preset environment, which the scene names before all tables.
fn in_surroundings(preset: &str) -> String {
    let moon = "[body.ball]\nshape.sphere.radius = 1\nmaterial = \"moon\"\n";
    let sun = "[light.sun]\nsun.direction = [-1, 0, 0]\n";
    script(&format!("environment = \"{preset}\"\n{moon}{sun}{}", front().toml()))
}

#[test]
fn every_preset_is_to_be_seen_and_is_a_look_of_its_own() {
    let presets = jabuka::scene::Preset::ALL.map(jabuka::scene::Preset::name);
    let images = render_all(presets.map(in_surroundings), SIZE);
    for (i, one) in images.iter().enumerate() {
        let lit = one.at(front().sees(DVec3::new(0.5, 0.2, 0.8)));
        assert!(brightness(lit) > 40.0, "{}: {lit:?}", presets[i]);
        for (j, other) in images.iter().enumerate().skip(i + 1) {
            assert!(one.difference(other) > 1.0, "{} looks like {}", presets[i], presets[j]);
        }
    }
}

/// Checks that ambient light depends on the sky: at night and under a black sky, the side away from all lights is dark.
#[test]
fn the_far_side_of_the_moon_is_dark_at_night() {
    let scripts = ["daylight", "night", "space"].map(in_surroundings);
    let plain = scene_of_moon("sky = false\nground = false");
    let [day, night, space] = render_all(scripts, SIZE);
    let none = render(&plain, SIZE);
    let far_side = |image: &Image| brightness(image.at(front().sees(DVec3::new(-0.7, 0.0, 0.5))));
    assert!(far_side(&day) > 50.0, "{}", far_side(&day));
    assert!(far_side(&night) < 40.0, "{}", far_side(&night));
    for image in [&space, &none] {
        assert!(far_side(image) < 20.0, "{}", far_side(image));
    }
}

/// Returns the script of the same ball; `environment` holds the keys of the environment.
fn scene_of_moon(environment: &str) -> String {
    let moon = "[body.ball]\nshape.sphere.radius = 1\nmaterial = \"moon\"\n";
    let sun = "[light.sun]\nsun.direction = [-1, 0, 0]\n";
    script(&format!("{moon}{sun}[environment]\n{environment}\n{}", front().toml()))
}

/// Checks that a light inside a luminous ball lights the scene.
#[test]
fn a_lamp_in_a_luminous_ball_lights_the_scene() {
    let scene = |material: &str| {
        let text = format!(
            "[body.lamp]\nshape.sphere.radius = 0.3\nlocation = [0, 2, 0]\nmaterial = \"{material}\"
[light.lamp]\npoint.location = [0, 2, 0]\n[environment]\npreset = \"night\"\nground.height = 0\n{}",
            front().toml()
        );
        script(&text)
    };
    let [shining, matte] = render_all(["luminous", "matte"].map(scene), SIZE);
    let under = front().sees(DVec3::new(0.5, 0.0, 0.0));
    assert!(brightness(shining.at(under)) > brightness(matte.at(under)) + 40.0);
}
