//! Tests that shapes are drawn with the size and the center that the dynamics uses.

use glam::{DVec2, DVec3};
use jabuka::Scene;

use crate::image::{is_green, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::render_all;
use crate::scene::{DARK, script, script_of};

/// Returns a camera so far away that its rays are nearly parallel. The picture is 4 m wide.
fn far() -> Pinhole {
    Pinhole { angle: 4.0, ..Pinhole::new([0.0, 0.0, 2.0 / libm::tan(2f64.to_radians())], [0.0; 3]) }
}

/// Returns a scene with a luminous red body; `words` are the keys of the body.
fn body(words: &str) -> String {
    format!(
        "[body.it]\n{words}\nmaterial = \"red\"\n[material.red]\ncolor = \"red\"\nfinish = \"luminous\"\n{DARK}{}",
        far().toml()
    )
}

/// Asserts that the red area in the picture of each body ends, on the left, right, bottom and top, where the body's shape ends.
fn assert_fills<const N: usize>(bodies: &[String; N]) {
    let metres_per_pixel = 4.0 / f64::from(SIZE[0]);
    let scripts = bodies.each_ref().map(|body| script(body));
    for (body, image) in bodies.iter().zip(render_all(scripts, SIZE)) {
        let it = &Scene::parse(body).unwrap().bodies[0];
        let places = image.spot(is_red).0;
        let middle = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1])) / 2.0;
        for (direction, sign) in [(DVec2::X, 1.0), (DVec2::X, -1.0), (DVec2::Y, 1.0), (DVec2::Y, -1.0)] {
            let farthest = |place: &DVec2| sign * (*place - middle).dot(direction) * metres_per_pixel;
            let seen = places.iter().map(farthest).fold(f64::MIN, f64::max) + metres_per_pixel / 2.0;
            // In the picture, y points down.
            let way = sign * DVec3::new(direction.x, -direction.y, 0.0);
            let reach = it.drawn().support(it.start.orientation, way).unwrap();
            assert!((seen - reach).abs() < 1.5 * metres_per_pixel, "{way}: {seen} m, not {reach} m\n{body}");
        }
    }
}

const TURNED: &str = "orientation = [25, 35, 40]";

#[test]
fn every_shape_is_drawn_where_it_weighs() {
    assert_fills(
        &[
            "sphere.radius = 0.9",
            "box.size = [1.8, 1.2, 0.6]",
            "box = { size = [1.8, 1.2, 0.8], rounding = 0.3 }",
            "cylinder = { radius = 0.5, height = 1.6 }",
            "capsule = { radius = 0.4, height = 2.0 }",
            "cone = { radius = 0.8, height = 1.8 }",
            "cone = { radius = 0.3, height = 1.5, top_radius = 0.8 }",
            "torus = { radius = 0.8, tube_radius = 0.3 }",
        ]
        .map(|shape| body(&format!("shape.{shape}\n{TURNED}"))),
    );
}

#[test]
fn limits_of_the_shapes_are_drawn_without_a_word() {
    assert_fills(
        &[
            "box = { size = [1.8, 1.2, 0.8], rounding = 0.4 }",
            "box = { size = [1.8, 1.2, 0.8], rounding = 0 }",
            "box = { size = [1.4, 1.4, 1.4], rounding = 0.7 }",
            "box = { size = [0.3, 0.3, 1.9], rounding = 0.15 }",
            "capsule = { radius = 0.7, height = 1.4 }",
            "cone = { radius = 0.6, height = 1.2, top_radius = 0.6 }",
            "torus = { radius = 0.5, tube_radius = 0.5 }",
        ]
        .map(|shape| body(&format!("shape.{shape}\n{TURNED}"))),
    );
}

#[test]
fn an_enlarged_body_is_drawn_larger_about_its_centre() {
    assert_fills(
        &[
            "sphere.radius = 0.009",
            "box = { size = [0.018, 0.012, 0.006], rounding = 0.002 }",
            "cone = { radius = 0.008, height = 0.018 }",
        ]
        .map(|shape| body(&format!("shape.{shape}\nlook.scale = 100\n{TURNED}"))),
    );
}

/// Checks the keys for SDL in a body: a texture before the matrix turns and moves with the body, one after the matrix does not.
#[test]
fn own_words_stand_before_and_after_the_matrix() {
    let halves = "pigment { gradient x color_map { [0.5 rgb <1, 0, 0>] [0.5 rgb <0, 1, 0>] } scale 10 translate -x*5 }\
                  finish { ambient 0 diffuse 0 emission 1 } // a comment at the end";
    let ball = |words: &str| {
        format!(
            "[simulation]\nduration = 1\nframe_rate = 1\n[body.it]\nshape.sphere.radius = 1\n{words}
angular_velocity = [0, 0, 1.5707963267948966]\n{DARK}{}",
            far().toml()
        )
    };
    let before = ball(&format!("look.sdl_before = \"texture {{ {halves}\\n}}\""));
    let after = ball(&format!("look.sdl_after = \"texture {{ {halves}\\n}}\""));
    let hidden = ball("look.sdl_before = \"no_image\"");
    let [before, after, hidden] = render_all([before, after, hidden].map(|text| script_of(&text, 1)), SIZE);
    // A quarter turn about z moves green from the right to the top. The centroid of a half disk is 4 r / 3π from its straight edge.
    for (image, way) in [(before, DVec2::NEG_Y), (after, DVec2::X)] {
        let found = image.spot(is_green).middle() - image.spot(is_red).middle();
        assert!(found.distance(way * 34.0) < 3.0, "red → green is {found}");
    }
    assert_eq!(hidden.brightness(), 0.0);
}

/// Checks that an object given in SDL has lengths in meters, whatever the script's unit, and the location and orientation of its stand-in
/// shape.
#[test]
fn an_object_in_sdl_is_drawn_in_place_of_its_stand_in() {
    let cone = "shape.sdl.object = \"object { cone { -y*0.45, 0.8, y*1.35, 0 } } // a cone\"
shape.sdl.stand_in.cone = { radius = 0.8, height = 1.8 }";
    let own = "shape.sdl.object = \"union { sphere { y, 0.3 } sphere { -y, 0.3 } pigment { rgb x } finish { emission 1 } }\"
shape.sdl.stand_in.capsule = { radius = 0.3, height = 2.6 }";
    let small = format!("{}\nlook.scale = 0.5", cone.replace("0.8", "1.6").replace("0.45", "0.9"));
    let small = small.replace("1.35", "2.7").replace("height = 1.8", "height = 3.6");
    let in_centimetres = format!("{}\n[povray]\nunit = 0.01\n", body(&format!("{cone}\n{TURNED}")));
    let own = body(&format!("{own}\n{TURNED}")).replace("material = \"red\"\n", "");
    assert_fills(&[
        body(&format!("{cone}\n{TURNED}")),
        body(&format!("{small}\n{TURNED}")),
        in_centimetres,
        own,
    ]);
}

#[test]
fn parts_of_a_compound_are_drawn_about_their_centre_of_mass() {
    let hammer = "compound.parts = [{ cylinder = { radius = 0.1, height = 1.6 }, location = [9, 0, 0] },
  { box = { size = [0.9, 0.4, 0.4], rounding = 0.1 }, location = [9, 0.9, 0], orientation = [0, 30, 0] }]";
    let one = "compound.parts = [{ cone = { radius = 0.5, height = 1.5 }, location = [5, 5, 5], orientation = [0, 0, 90] }]";
    assert_fills(&[hammer, one].map(|shape| body(&format!("shape.{shape}\n{TURNED}"))));
    let grouped = body(&format!("shape.{hammer}\n{TURNED}"))
        + "[body.behind]\nshape.sphere.radius = 0.05\nmaterial = \"red\"\n";
    assert_fills(&[grouped]);
}
