//! Tests of motion blur: one command renders all moments of an image, and their mean looks like a smooth blur, not like separate ghosts.

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec2;
use jabuka::render::linear_light;
use jabuka::{Run, Scene};

use crate::image::{Image, brightness};
use crate::{povray, support};

/// Renders all moments of a script. Returns the paths of their images in order.
fn moments(folder: &Path, script: &str, samples: usize, arguments: &[&str]) -> Vec<PathBuf> {
    let input = format!("+I{script}");
    let last = format!("+KFF{}", samples - 1);
    let mut all = vec![&*input, "+Omoment.png", "+WT1", "+KFI0", &*last];
    all.extend(arguments);
    povray::run(folder, &all).nothing(script);
    let digits = (samples - 1).to_string().len();
    (0..samples).map(|i| folder.join(format!("moment{i:0digits$}.png"))).collect()
}

/// Returns the mean of an image's linear light over all pixels and channels, 0 to 1.
fn light(image: &Image) -> f64 {
    let linear = |byte: u8| {
        let number = f64::from(byte) / 255.0;
        if number <= 0.04045 { number / 12.92 } else { libm::pow((number + 0.055) / 1.055, 2.4) }
    };
    let pixels: Vec<f64> = image.pixels().map(|rgb| rgb.map(linear).iter().sum::<f64>() / 3.0).collect();
    pixels.iter().sum::<f64>() / pixels.len() as f64
}

/// Returns a scene with a wheel of eight spokes, seen along its axis; 200 pixels are 3 m. It turns by 20° in the 20 ms of exposure. At
/// [`RADIUS`] its spokes are 7° wide: wide enough to overlap in consecutive moments if there are 16 of them, and too narrow to overlap if
/// there are 4.
fn wheel(samples: usize) -> String {
    let width = 2.0 * RADIUS * libm::sin(3.5_f64.to_radians());
    let spokes = (0..8).map(|i| {
        let (angle, turn) = (TAU / 8.0 * f64::from(i), 45 * i);
        let [x, y] = [libm::cos(angle), libm::sin(angle)];
        format!(
            "{{ box.size = [1.5, {width}, 0.2], location = [{x}, {y}, 0], orientation = [0, 0, {turn}] }}"
        )
    });
    let spokes: Vec<String> = spokes.collect();
    format!(
        "
simulation.duration = 0
[body.wheel]
shape.compound.parts = [
    {{ torus = {{ radius = 1.8, tube_radius = 0.08 }}, orientation = [90, 0, 0] }},
    {{ cylinder = {{ radius = 0.3, height = 0.2 }}, orientation = [90, 0, 0] }},
    {},
]
angular_velocity = [0, 0, {}]
material = {{ color = 'white', finish = 'luminous' }}
[camera]
projection = 'orthographic'
width = 4.5
location = [0, 0, 10]
look_at = [0, 0, 0]
shutter = 0.02
samples = {samples}
[environment]
ground = false
sky = false
[output]
size = [300, 300]
",
        spokes.join(",\n    "),
        20_f64.to_radians() / 0.02
    )
}

/// The distance from the axis at which the spokes are examined, m.
const RADIUS: f64 = 1.5;

/// Counts the local extremes of the brightness along a circle through the spokes. Changes below a tenth of the full range are ignored.
fn turns(image: &Image) -> usize {
    const NOTICEABLE: f64 = 25.5;
    let at = |step: i32| {
        let (sin, cos) = libm::sincos(TAU * f64::from(step) / 1440.0);
        brightness(image.at(DVec2::splat(150.0) + DVec2::new(cos, sin) * RADIUS * 300.0 / 4.5))
    };
    let (mut turns, mut rising, mut extreme) = (0, None, at(0));
    // Go around twice, so that the starting point cuts off no extreme of the second round.
    for step in 0..2880 {
        let here = at(step);
        let onwards = match rising {
            Some(true) => here >= extreme,
            Some(false) => here <= extreme,
            None => false,
        };
        if onwards {
            extreme = here;
        } else if (here - extreme).abs() >= NOTICEABLE {
            turns += usize::from(step >= 1440);
            (rising, extreme) = (Some(here > extreme), here);
        }
    }
    turns
}

/// Compiles and renders the wheel. Returns the sharp image and the blurred one, and asserts that the blurred image has the mean light of
/// all moments.
fn render(samples: usize) -> [Image; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wheel.toml");
    fs::write(&path, wheel(samples)).unwrap();
    let out = folder.path().join("out");
    support::compile(&path, &out, &[]);
    let quality = ["+W300", "+H300", "+A0.1", "+AM1", "+R3"];
    let mut sharp = vec!["+Iframe_0000.pov", "+Osharp.png", "+FN8", "+WT1"];
    sharp.extend(quality);
    povray::run(&out, &sharp).nothing("the sharp script");

    let images = moments(&out, "shutter_0000.pov", samples, &[&["+FN16"], &quality[..]].concat());
    let mean = out.join("mean.png");
    linear_light::mean(&images).unwrap().write(&mean).unwrap();
    let mean = Image::read(&mean);
    let of_moments = images.iter().map(|path| {
        let one = path.with_extension("8.png");
        linear_light::mean(std::slice::from_ref(path)).unwrap().write(&one).unwrap();
        light(&Image::read(&one))
    });
    let expected = of_moments.sum::<f64>() / samples as f64;
    let found = light(&mean);
    assert!((found / expected - 1.0).abs() < 0.01, "the light is {found}, not {expected}");
    [Image::read(&out.join("sharp.png")), mean]
}

#[test]
fn a_wheel_that_turns_is_one_blur_and_not_several_wheels() {
    let ([sharp, blurred], [_, ghosts]) = std::thread::scope(|scope| {
        let [many, few] = [16, 4].map(|samples| scope.spawn(move || render(samples)));
        (many.join().unwrap(), few.join().unwrap())
    });
    // Each of the eight spokes and of the eight gaps is an extreme.
    assert_eq!(turns(&sharp), 16);
    assert_eq!(turns(&blurred), 16);
    assert!(turns(&ghosts) > 16, "four moments are too few, and this test does not see it");
    assert!(sharp.difference(&blurred) > 5.0);
}

/// A scene with many features of scripts: patterns, glass, a macro, axes, a lens, and SDL of its own that uses the frame's number and must
/// not affect the next moment.
const RICH: &str = "
title = 'Rich'
simulation.duration = 0.04
[body.glass]
shape.sphere.radius = 0.5
velocity = [9, 0, 0]
material = 'glass'
[body.rounded]
shape.box = { size = [1, 1, 1], rounding = 0.2 }
location = [2, 0, 0]
angular_velocity = [9, 20, 0]
material = 'marble'
[body.axes]
shape.axes.length = 1
location = [-2, 0, 0]
angular_velocity = [0, 9, 9]
[camera]
location = [0, 2, 8]
look_at = [0, 0, 0]
shutter = 0.03
samples = 3
[povray]
include = ['shapes.inc']
sdl = '''
#if (frame_number != 1) #error \"this is another frame\" #end
#declare Own = 0.3;
#macro Pearl(Where) sphere { Where, Own pigment { rgb x } } #end
#switch (2) #case (1) #break #case (2) Pearl(<0, 1, 0>) #break #else #end
'''
";

#[test]
fn a_moment_is_rendered_as_if_it_were_alone_in_both_layouts() {
    let scene = Scene::parse(RICH).unwrap();
    let run = Run::new(&scene).unwrap();
    let exposure = run.at(0.04).unwrap();
    let last = run.script(&exposure.moments(run.shutter().unwrap()).last().unwrap().unwrap()).unwrap();
    assert!(last.starts_with("// frame 1, t = 0.065 s\n"));
    let alone = last.replace("#if (frame_number != 1)", "#if (0)");
    let alone = povray::render(&alone, [80, 60]);
    std::thread::scope(|scope| {
        for layout in ["self-contained", "shared"] {
            let alone = &alone;
            scope.spawn(move || {
                let folder = tempfile::tempdir().unwrap();
                let path = folder.path().join("rich.toml");
                fs::write(&path, RICH).unwrap();
                let out = folder.path().join("out");
                let templates = folder.path().join("templates");
                let mut command = support::jabuka();
                assert!(command.arg("templates").arg(&templates).output().unwrap().status.success());
                let layout = format!("output.layout={layout}");
                let templates = templates.to_str().unwrap();
                support::compile(&path, &out, &["--set", &layout, "--templates", templates]);
                let images = moments(&out, "shutter_0001.pov", 3, &["+FN8", "+W80", "+H60"]);
                let images: Vec<Image> = images.iter().map(|path| Image::read(path)).collect();
                assert!(images[2] == *alone, "{layout}");
                assert!(images[0] != images[2]);
                // Render one moment by its number instead of as a part of an animation.
                let one =
                    ["+Ishutter_0001.pov", "+Oone.png", "+FN8", "+W80", "+H60", "Declare=Shutter_Sample=2"];
                povray::run(&out, &one).nothing("one moment");
                assert!(Image::read(&out.join("one.png")) == *alone);
                let said = povray::run(&out, &[&one[..5], &["Declare=Shutter_Sample=3"]].concat());
                assert!(said.errors.contains("Shutter_Sample goes from 0 to 2"), "{}", said.errors);
            });
        }
    });
}
