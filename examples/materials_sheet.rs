//! Prints a scene that shows every material of the library with its name. `docs/materials.sh` renders this scene.
#![allow(clippy::print_stdout, reason = "it prints a scene")]

use jabuka::scene::MATERIALS;

const COLUMNS: usize = 9;

/// The beginning of the scene: its surroundings, and an SDL macro that writes a name on the ground.
const HEAD: &str = r#"title = "The materials that every scene knows by name"

[simulation]
duration = 0

[output]
size = [1280, 864]

[camera]
location = [0, 112, 130.75]
look_at = [0, 0, 0.4]
angle = 7.5

[environment]
preset = "studio"
ground = { height = 0, tile = 1.15 }

[light.lamp]
area = { location = [-26, 44, 22], size = 9 }
color = [1, 0.98, 0.95]
intensity = 1.05

[light.fill]
point.location = [40, 20, 50]
color = [0.55, 0.6, 0.68]
intensity = 0.5
shadows = false

[povray]
sdl = '''
#macro Name(Words, X, Z)
  #local Text = text { ttf "cyrvetic.ttf" Words 0.01, 0 scale <0.32, 0.44, 1> };
  object {
    Text
    translate -x*(min_extent(Text).x + max_extent(Text).x)/2
    rotate -x*90
    translate <X, 0.01, Z>
    pigment { color srgb <0.1, 0.1, 0.12> }
    finish { ambient 0 diffuse 0 emission 1 }
    no_shadow
    no_reflection
  }
#end
"#;

fn main() {
    let rows = MATERIALS.len().div_ceil(COLUMNS);
    let place = |i: usize| {
        let (column, row) = (i % COLUMNS, i / COLUMNS);
        let from_middle = |index: usize, count: usize| index as f64 - (count - 1) as f64 / 2.0;
        (from_middle(column, COLUMNS) * 2.3, from_middle(row, rows) * 3.6)
    };
    print!("{HEAD}");
    for (i, material) in MATERIALS.iter().enumerate() {
        let (x, z) = place(i);
        println!("Name(\"{}\", {x}, {})", material.name.replace('_', " "), z + 1.36);
    }
    println!("'''");
    for (i, material) in MATERIALS.iter().enumerate() {
        let (name, (x, z)) = (material.name, place(i));
        println!("\n[body.{name}_box]\nshape.box.size = [0.9, 0.9, 0.9]\nmaterial = \"{name}\"");
        println!("location = [{:.3}, 0.45, {:.3}]\norientation = [0, 32, 0]", x + 0.42, z - 0.34);
        println!("\n[body.{name}_ball]\nshape.sphere.radius = 0.6\nmaterial = \"{name}\"");
        println!("location = [{:.3}, 0.6, {:.3}]\norientation = [12, 0, -8]", x - 0.32, z + 0.3);
    }
}
