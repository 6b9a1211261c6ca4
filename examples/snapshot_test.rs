//! A snapshot test of a scene, to copy into your own project:
//!
//!     cargo test --example snapshot_test
//!
//! A script is the same on every run and machine. If the script changes, the test shows the difference, and
//! `cargo insta review` accepts an intended change.

use jabuka::{Run, Scene};

const SCENE: &str = r##"
    title = "A stone is thrown"

    [simulation]
    duration = 1.0
    gravity = [0, -9.81, 0]

    [body.stone]
    shape.sphere.radius = 0.1
    velocity = [3, 4, 0]

    [environment]
    ground = false
    sky = "#000000"

    [camera]
    location = [1.5, 0.5, 6]
    look_at = [1.5, 0.5, 0]

    [light.lamp]
    point.location = [0, 5, 5]
"##;

/// Returns the script of one frame of the scene.
fn script(frame: usize) -> Result<String, Box<dyn std::error::Error>> {
    let scene = Scene::parse(SCENE)?;
    let run = Run::new(&scene)?;
    let frame = run.frames().nth(frame).ok_or("the scene has no such frame")??;
    Ok(run.script(&frame)?)
}

#[allow(clippy::print_stdout, reason = "an example shows what it does")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", script(10)?);
    Ok(())
}

#[test]
fn the_stone_after_ten_frames() {
    insta::assert_snapshot!(script(10).expect("the scene is right"), @r"
    // frame 10, t = 0.4 s
    #version 3.7;
    // A stone is thrown
    // right-handed: x right, y up, z towards the viewer; one unit is 1 m
    global_settings { assumed_gamma 1.0 charset utf8 ambient_light rgb <0.03, 0.03, 0.03> }

    camera {
      location <1.5, 0.5, 6>
      up y
      right -x*image_width/image_height
      angle 40
      look_at <1.5, 0.5, 0>
    }

    light_source { // lamp
      <0, 5, 5> color rgb <1, 1, 1>
    }

    background { color srgb <0, 0, 0> }

    #local Material_palette_red = material {
      texture {
        pigment { color srgb <0.8, 0.07, 0.1> }
        finish { ambient 0.16 diffuse 0.72 specular 0.55 roughness 0.004 reflection { 0.03, 0.6 falloff 5 } }
      }
    }

    // the bodies
    object {
      sphere { <1.2, 0.807352, 0>, 0.1 } // stone
      material { Material_palette_red }
    }
    ");
}
