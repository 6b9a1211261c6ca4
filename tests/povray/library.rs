//! Tests of the materials that every scene knows by name.

use std::fmt::Write as _;

use glam::DVec3;
use jabuka::scene::MATERIALS;

use crate::image::Image;
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::{render, render_all};
use crate::scene::script;

/// Checks that POV-Ray draws a ball of each material without a warning, and that each ball is visible in front of the ground.
#[test]
fn every_material_is_to_be_seen() {
    let camera = Pinhole { angle: 60.0, size: [300, 180], ..Pinhole::new([0.0, 9.0, 14.0], [0.0, 0.0, 0.0]) };
    let place = |i: usize| DVec3::new((i % 9) as f64 * 1.6 - 6.4, 0.6, (i / 9) as f64 * 1.6 - 4.0);
    let mut balls = String::new();
    for (i, material) in MATERIALS.iter().enumerate() {
        let name = material.name;
        let _ = writeln!(balls, "[body.{name}]\nshape.sphere.radius = 0.6\nmaterial = \"{name}\"");
        let _ = writeln!(balls, "location = {}", place(i));
    }
    let rest = format!("[body.floor]\nshape.plane = {{}}\nmaterial = \"clay\"\n{}", camera.toml());
    let [with, without] = render_all([script(&(balls + &rest)), script(&rest)], camera.size);
    for (i, material) in MATERIALS.iter().enumerate() {
        let seen = camera.sees(place(i));
        let change: u32 = (-4..=4)
            .flat_map(|x| (-4..=4).map(move |y| glam::DVec2::new(f64::from(x), f64::from(y))))
            .map(|step| {
                let (a, b) = (with.at(seen + step), without.at(seen + step));
                (0..3).map(|i| u32::from(a[i].abs_diff(b[i]))).sum::<u32>()
            })
            .sum();
        assert!(change > 81 * 10, "{}: {change}", material.name);
    }
}

/// Checks that a wooden crate looks the same for any size of the body and any length of POV-Ray's unit.
#[test]
fn a_pattern_fits_the_body() {
    let scene = |size: f64, rest: &str| {
        let text =
            format!("[body.crate]\nshape.box.size = [{size}, {size}, {size}]\nmaterial = \"wood\"\n{rest}");
        script(&text)
    };
    let scripts = [
        scene(1.0, ""),
        scene(0.1, ""),
        scene(10.0, ""),
        scene(1.0, "[povray]\nunit = 0.01\n"),
        scene(1.0, "[material.wood]\nlike = \"marble\"\n"),
    ];
    let [one, small, large, in_centimetres, marble] = render_all(scripts, SIZE);
    for other in [&small, &large, &in_centimetres] {
        let difference = one.difference(other);
        assert!(difference < 1.0, "{difference}");
    }
    assert!(one.difference(&marble) > 5.0, "the scene's own names come first");
}

/// Checks the color of tinted materials: a green ball stays green behind tinted glass, and a tinted ball has the color of the tint.
#[test]
fn a_color_tints_what_takes_one() {
    let camera = Pinhole::new([0.0, 1.5, 8.0], [0.0, 1.0, 0.0]);
    let scene = |like: &str, color: &str| {
        let ball = "[body.ball]\nshape.sphere.radius = 1\nlocation = [0, 1, 0]\nmaterial = \"m\"\n";
        script(&format!("{ball}[material.m]\nlike = \"{like}\"\ncolor = \"{color}\"\n{}", camera.toml()))
    };
    let scripts = ["wood", "marble", "glass", "plastic"].map(|like| scene(like, "#20d020"));
    let middle = camera.sees(DVec3::Y);
    for image in render_all(scripts, SIZE) {
        let [r, g, b] = image.at(middle);
        assert!(g > r && g > b, "{:?}", image.at(middle));
    }
}

/// Checks that planes of a plain color or a pattern fade into the haze like the ground.
#[test]
fn planes_of_any_material_fade() {
    let camera = Pinhole::new([0.0, 2.0, 10.0], [0.0, 2.0, 0.0]);
    let ball = "[body.ball]\nshape.sphere.radius = 0.3\nlocation = [0, 0.3, 0]\n";
    for material in ["matte", "wood", "water"] {
        let plane = format!("[body.floor]\nshape.plane = {{}}\nmaterial = \"{material}\"\n");
        let of = |fog: &str| script(&format!("{ball}{plane}[environment]\nfog = {fog}\n{}", camera.toml()));
        let step = |image: &Image| {
            let at = |y: f64| crate::image::brightness(image.at(camera.sees(DVec3::new(-3.0, y, 0.0))));
            (at(2.08) - at(1.92)).abs()
        };
        let hazy = render(&of("true"), SIZE);
        assert!(step(&hazy) < 15.0, "{material}: {}", step(&hazy));
    }
}
