//! Tests that meshes and heightfields are drawn where the dynamics has them.

use std::fs;

use jabuka::{Run, Scene};

use crate::image::{Image, is_red};
use crate::pinhole::SIZE;
use crate::povray::render;
use crate::scene::DARK;

const CUBE: &str = "v 0 0 0\nv 30 0 0\nv 0 10 0\nv 30 10 0\nv 0 0 20\nv 30 0 20\nv 0 10 20\nv 30 10 20
f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";

/// Renders the first frame of a scene with some files next to it, and asserts that POV-Ray prints no warnings.
fn draw(files: &[(&str, &[u8])], text: &str) -> Image {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).unwrap());
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    let scene = Scene::from_path(path).unwrap_or_else(|report| panic!("{report}\n{text}"));
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().next().unwrap().unwrap();
    render(&run.script(&frame).unwrap(), SIZE)
}

fn body(shape: &str) -> String {
    format!(
        "[body.it]\n{shape}\norientation = [25, 35, 40]\nmaterial = 'brass'\n[camera]\nlocation = [0, 1, 5]\nlook_at = [0, 0, 0]\n"
    )
}

/// Checks that a box made of triangles looks like a box: also with a smoothing angle below that of its edges, as a part of a compound,
/// tiny or huge, and enlarged.
#[test]
fn a_box_of_triangles_looks_like_the_box() {
    let files: &[(&str, &[u8])] = &[("cube.obj", CUBE.as_bytes())];
    let expected = draw(files, &body("shape.box.size = [3, 1, 2]"));
    for shape in [
        "shape.mesh = { file = 'cube.obj', scale = 0.1 }",
        "shape.mesh = { file = 'cube.obj', scale = 0.1, smooth = 60 }",
        "shape.mesh = { file = 'cube.obj', scale = 0.0001 }\nlook.scale = 1000",
        "shape.compound.parts = [{ mesh = { file = 'cube.obj', scale = 0.1 }, location = [7, 0, 0] }]",
    ] {
        let image = draw(files, &body(shape));
        assert!(image.difference(&expected) < 0.02, "{shape}: {}", image.difference(&expected));
    }
    // Fully smoothed corners must look different, which shows that the comparison is sensitive enough.
    let round = draw(files, &body("shape.mesh = { file = 'cube.obj', scale = 0.1, smooth = true }"));
    assert!(round.difference(&expected) > 0.2, "{}", round.difference(&expected));
}

/// Checks that triangles far below POV-Ray's smallest numbers are drawn without warnings, and that triangles without area do no harm.
#[test]
fn files_in_any_unit_are_drawn() {
    let body = |scale: &str| body(&format!("shape.mesh = {{ file = 'cube.obj', scale = {scale} }}"));
    let expected = draw(&[("cube.obj", CUBE.as_bytes())], &body("0.1"));
    for (unit, scale) in [("e-9", "1e8"), ("e6", "1e-7")] {
        let cube = CUBE.replace("0 ", &format!("0{unit} ")).replace("0\n", &format!("0{unit}\n"));
        // Append a vertex and two triangles without area. The replacements above changed no face, since no vertex number ends in 0.
        let line = cube.clone() + &format!("v 10{unit} 0 0\nf 1 9 2\nf 2 9 1\n");
        let image = draw(&[("cube.obj", line.as_bytes())], &body(scale));
        assert!(image.difference(&expected) < 0.02, "{unit}: {}", image.difference(&expected));
    }
}

/// Checks the height of a heightfield: its silhouette from the side is the profile of its far edge, since the near edge is low.
#[test]
fn a_heightfield_is_as_high_as_its_pixels() {
    let levels = [0u8, 255, 51, 204];
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 4, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&[levels, [0; 4]].concat()).unwrap();
    let text = format!(
        "[body.hills]\nshape.heightfield = {{ file = 'hills.png', size = [3, 1, 0.5] }}\nmaterial = 'red'
[material.red]\ncolor = 'red'\nfinish = 'luminous'\n[camera]\nprojection = 'orthographic'\nwidth = 4
location = [0, 0.5, 50]\nlook_at = [0, 0.5, 0]\n{DARK}"
    );
    let image = draw(&[("hills.png", &png)], &text);
    let metres = 4.0 / f64::from(SIZE[0]);
    let [width, height] = SIZE.map(f64::from);
    let red = image.spot(is_red).0;
    for (i, level) in levels.into_iter().enumerate() {
        // The centers of the outer pixels are the edges of the field, where a column of the picture is only half covered.
        let x = (i as f64 - 1.5) * 0.98;
        let column = red.iter().filter(|place| ((place.x - width / 2.0) * metres - x).abs() < metres);
        let top = column.map(|place| 0.5 + (height / 2.0 - place.y) * metres).fold(f64::MIN, f64::max);
        let expected = f64::from(level) / 255.0;
        // The steepest slope is 0.8 m per 1 m. At 0.03 m from the center of a pixel of the field, the height differs by 0.024 m.
        if level > 0 {
            assert!((top - expected).abs() < 0.03 + 2.0 * metres, "pixel {i}: {top} m, not {expected} m");
        }
    }
    assert!(image.pixels().any(is_red));
}
