//! Tests that `povray animation.ini` finds the files that raw SDL reads.

use std::fs::{self, File};
use std::path::Path;

use crate::image::{Image, Rgb};
use crate::{povray, support};

/// Writes a PNG image of one color.
fn paint(path: &Path, [r, g, b]: Rgb) {
    let mut encoder = png::Encoder::new(File::create(path).unwrap(), 2, 2);
    encoder.set_color(png::ColorType::Rgb);
    let pixels: Vec<u8> = (0..4).flat_map(|_| [r, g, b]).collect();
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
}

#[test]
fn an_image_beside_the_scene_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("maps")).unwrap();
    paint(&folder.path().join("sky.png"), [20, 60, 200]);
    paint(&folder.path().join("maps/wall.png"), [200, 60, 20]);
    let scene = "
simulation.duration = 0
[output]
size = [8, 6]
[environment]
ground = false
sky = false
[camera]
location = [0, 0, 10]
look_at = [0, 0, 0]
[povray]
assets = ['sky.png', 'maps/wall.png']
sdl = '''
plane { z, -5 pigment { image_map { png \"sky.png\" } scale 9 } finish { emission 1 ambient 0 diffuse 0 } }
'''
[material.wall]
sdl = 'pigment { image_map { png \"maps/wall.png\" } } finish { emission 1 ambient 0 diffuse 0 }'
[body.wall]
shape.box.size = [2, 2, 2]
material = 'wall'
";
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene).unwrap();
    let out = folder.path().join("out");
    support::compile(&path, &out, &[]);
    // POV-Ray must find the copies, so remove the original.
    fs::remove_file(folder.path().join("sky.png")).unwrap();
    povray::run(&out, &["animation.ini", "-A"]).nothing("animation.ini");
    let image = Image::read(&out.join("frame_0000.png"));
    let pixels: Vec<Rgb> = image.pixels().collect();
    let near = |a: Rgb, b: Rgb| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1);
    assert!(near(pixels[0], [20, 60, 200]), "{:?}", pixels[0]);
    assert!(near(pixels[8 * 3 + 4], [200, 60, 20]), "{:?}", pixels[8 * 3 + 4]);
}
