//! Tests of the materials of bodies.

use glam::{DVec2, DVec3};

use crate::image::{brightness, is_blue, is_green, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::{render, render_all};
use crate::scene::{DARK, script, shining_ball};

fn front() -> Pinhole {
    Pinhole::new([0.0, 1.5, 8.0], [0.0, 0.5, 0.0])
}

/// Returns a scene with a ball of radius 1 on the ground whose material `m` has the given keys.
fn ball_of(material: &str) -> String {
    let body = "[body.ball]\nshape.sphere.radius = 1\nlocation = [0, 1, 0]\nmaterial = \"m\"\n[material.m]\n";
    format!("{body}{material}{}", front().toml())
}

/// Returns the center of the ball in the picture, and a point near its top, both in pixels.
fn middle_and_crown() -> (DVec2, DVec2) {
    (front().sees(DVec3::Y), front().sees(DVec3::new(0.0, 1.75, 0.6)))
}

#[test]
fn every_finish_is_to_be_seen() {
    let finishes = ["matte", "satin", "glossy", "metal", "mirror", "luminous"];
    let names = jabuka::scene::Finish::ALL.map(jabuka::scene::Finish::name);
    assert_eq!(names, finishes);
    let images = finishes.map(|f| script(&ball_of(&format!("color = \"#c03020\"\nfinish = \"{f}\"\n"))));
    let images = render_all(images, SIZE);
    let (middle, crown) = middle_and_crown();
    for (finish, image) in finishes.iter().zip(&images) {
        assert!((60.0..230.0).contains(&image.brightness()), "{finish}: {}", image.brightness());
        let (middle, crown) = (image.at(middle), image.at(crown));
        match *finish {
            // A mirror has no color of its own: the upper half of a mirror ball shows the sky.
            "mirror" => assert!(crown[2] > crown[0], "{finish}: {crown:?}"),
            "luminous" => assert_eq!((middle, crown), ([0xc0, 0x30, 0x20], [0xc0, 0x30, 0x20])),
            _ => assert!(is_red(middle), "{finish}: {middle:?}"),
        }
    }
    for (i, one) in images.iter().enumerate() {
        for (j, other) in images.iter().enumerate().skip(i + 1) {
            assert!(one.difference(other) > 0.1, "{} looks like {}", finishes[i], finishes[j]);
        }
    }
}

#[test]
fn a_texture_of_an_include_file_is_to_be_seen() {
    let chrome = ball_of("texture = \"T_Chrome_4C\"\n[povray]\ninclude = [\"metals.inc\"]\n");
    let image = render(&script(&chrome), SIZE);
    let (middle, crown) = middle_and_crown();
    assert!((60.0..230.0).contains(&image.brightness()), "{}", image.brightness());
    assert!(brightness(image.at(crown)) > 60.0 && brightness(image.at(middle)) > 15.0);
    assert!(image.at(crown)[2] > image.at(crown)[0], "chrome shows the sky: {:?}", image.at(crown));
}

#[test]
fn a_material_in_povrays_words_is_to_be_seen() {
    let pigment = "sdl = \"pigment { color rgb <0, 1, 0> } finish { emission 1 }\"\n";
    let glass = "sdl = '''\nmaterial {\n  texture { pigment { rgbf <1, 1, 1, 0.9> } }\n  interior { ior 1.5 }\n}'''\n";
    let behind = shining_ball("behind", [0.0, 1.0, -4.0], 4.0, "#0000ff");
    let scripts = [script(&ball_of(pigment)), script(&(ball_of(glass) + &behind))];
    let [green, glass] = render_all(scripts, SIZE);
    let (middle, _) = middle_and_crown();
    assert!(is_green(green.at(middle)), "{:?}", green.at(middle));
    assert!(is_blue(glass.at(middle)), "through glass: {:?}", glass.at(middle));
}

/// Checks that bodies of one plain material, which the script puts into one union with this material, all have its color.
#[test]
fn bodies_of_one_material_all_have_it() {
    let camera = front();
    let mut scene = String::from("[material.m]\ncolor = \"red\"\nfinish = \"luminous\"\n");
    let places = [-2.0, 0.0, 2.0].map(|x| DVec3::new(x, 0.5, 0.0));
    for (i, place) in places.iter().enumerate() {
        let shape = ["sphere.radius = 0.4", "box.size = [0.6, 0.6, 0.6]", "sphere.radius = 0.3"][i];
        scene += &format!("[body.b{i}]\nshape.{shape}\nlocation = {place}\nmaterial = \"m\"\n");
    }
    let image = render(&script(&(scene + &camera.toml())), SIZE);
    for place in places {
        assert_eq!(image.at(camera.sees(place)), [255, 0, 0]);
    }
}

#[test]
fn the_scenes_own_sdl_stands_in_the_script() {
    let sdl =
        "[povray]\nsdl = '''\nsphere { <2, 1, 0>, 0.5 pigment { rgb <0, 1, 0> } finish { emission 1 } }'''\n";
    let image = render(&script(&(ball_of("color = \"red\"\n") + sdl)), SIZE);
    let place = front().sees(DVec3::new(2.0, 1.0, 0.0));
    assert!(is_green(image.at(place)), "{:?}", image.at(place));
}

/// Checks a material in the body itself: a table with the same keys as a named material.
#[test]
fn a_material_can_stand_in_the_body() {
    let ball = "[body.ball]\nshape.sphere.radius = 1\nlocation = [0, 1, 0]\n";
    let inside = "material.color = \"Lime\"\nmaterial.finish = \"luminous\"\n";
    let image = render(&script(&format!("{ball}{inside}{}", front().toml())), SIZE);
    assert_eq!(image.at(middle_and_crown().0), [0, 255, 0]);
}

/// Luminous balls show the colors of the map unchanged: the ends of viridis for the slowest and the fastest ball. A ball of patterned wood
/// takes the color as its tint. The color bar shows the same colors from left to right.
#[test]
fn colors_follow_values() {
    let text = format!(
        "[simulation]\nduration = 1\n[defaults.body]\nshape.sphere.radius = 0.8\n\
         [body.slow]\nlocation = [-1.2, 0.5, 0]\nmaterial = 'hot'\n\
         [body.fast]\nlocation = [1.2, 0.5, 0]\nvelocity = [0, 0, 10]\nmaterial = 'hot'\n\
         [material.hot]\nfinish = 'luminous'\ncolor.map = {{ of = 'speed', title = 'v' }}\n\
         [body.tinted]\nlocation = [0, 1.4, 0]\nshape.sphere.radius = 0.4\nmaterial = {{ like = 'striped', color.map = {{ of = 'y', palette = ['blue', 'red'], range = [0, 1], bar = false }} }}\n{}",
        front().toml()
    );
    let image = render(&script(&text), SIZE);
    let at = |x: f64, y: f64| image.at(front().sees(DVec3::new(x, y, 0.0)));
    let near = |found: [u8; 3], known: [f64; 3]| {
        found.iter().zip(known).all(|(found, known)| (f64::from(*found) - 255.0 * known).abs() < 6.0)
    };
    // Source of the colors: matplotlib, `_cm_listed.py`.
    let (slow, fast) = ([0.267, 0.005, 0.329], [0.993, 0.906, 0.144]);
    assert!(near(at(-1.2, 0.5), slow), "{:?}", at(-1.2, 0.5));
    assert!(near(at(1.2, 0.5), fast), "{:?}", at(1.2, 0.5));
    assert!((0..20).any(|k| is_red(at(0.0, 1.1 + 0.03 * f64::from(k)))), "a red stripe");
    assert!((0..20).all(|k| !is_blue(at(0.0, 1.1 + 0.03 * f64::from(k)))), "no blue stripe");
    let [width, height] = SIZE.map(f64::from);
    let pixels = |known: [f64; 3]| {
        let corner =
            (0..SIZE[0]).flat_map(|x| (0..SIZE[1]).map(move |y| DVec2::new(f64::from(x), f64::from(y))));
        let mut corner = corner.filter(|at| at.x > 0.5 * width && at.y > 0.75 * height);
        corner.find(|at| near(image.at(*at), known)).map(|at| at.x)
    };
    let ends = [pixels(slow), pixels([0.128, 0.567, 0.551]), pixels(fast)];
    assert!(ends.iter().all(Option::is_some) && ends.is_sorted(), "{ends:?}");
}

/// Half of the light passes through a body of transparency 0.5, and a body of transparency 1 leaves no trace: no highlight, no reflection and
/// no shadow. This holds for every finish, and for a material of the library.
#[test]
fn a_transparent_body_lets_light_through() {
    let behind = shining_ball("behind", [0.0, 1.0, -8.0], 6.0, "white");
    let dark = |keys: &str| script(&(ball_of(keys) + &behind + DARK));
    let lit = |keys: &str| script(&ball_of(keys));
    let none = ball_of("").replace("[body.ball]", "[body.ball]\nend = 0.5\nstart = 0.2");
    let images = [
        dark("color = 'red'\nfinish = 'luminous'\ntransparency = 0.5\n"),
        dark("color = 'red'\nfinish = 'luminous'\ntransparency.map = { of = 't', range = [-1, 1] }\n"),
        script(&none),
        lit("color = 'red'\ntransparency.map = { of = 't', range = [-1, 0] }\n"),
        lit("finish = 'metal'\ntransparency = 1\n"),
        lit("like = 'marble'\ntransparency = 1\n"),
        lit("color = 'blue'\ntransparency = 0\n"),
        lit("color = 'blue'\n"),
    ];
    let [half, mapped, none, plain, metal, marble, opaque, blue] = render_all(images, SIZE);
    let (middle, _) = middle_and_crown();
    for image in [half, mapped] {
        let [red, green, blue] = image.at(middle);
        // Half of the white light is 188 of 255 in sRGB. The red is that of both.
        assert!(red > 250 && green.abs_diff(188) < 4 && blue.abs_diff(188) < 4, "{red} {green} {blue}");
    }
    for (image, name) in [(plain, "plain"), (metal, "metal"), (marble, "marble")] {
        assert!(none.difference(&image) < 0.02, "{name}: {}", none.difference(&image));
    }
    assert!(opaque.difference(&blue) == 0.0 && is_blue(opaque.at(middle)));
}

/// A glow of 1 is the finish `luminous`, and a glow of 0.5 is between it and none.
#[test]
fn a_glowing_body_shines_by_itself() {
    let dark = |keys: &str| {
        script(&(ball_of(keys) + "\n[light.weak]\nsun.direction = [0, 0, -1]\nintensity = 0.05\n" + DARK))
    };
    let color = "color = [0.8, 0.4, 0.2]\n";
    let images = [
        "finish = 'luminous'",
        "glow = 1",
        "glow.map = { of = 't', range = [-1, 0] }",
        "glow = 0.5",
        "glow = 0",
    ];
    let images = render_all(images.map(|keys| dark(&format!("{color}{keys}\n"))), SIZE);
    let (middle, _) = middle_and_crown();
    let [luminous, full, mapped, half, none] = images.each_ref().map(|image| image.at(middle));
    assert_eq!(luminous, [204, 102, 51]);
    assert_eq!([full, mapped], [luminous; 2]);
    assert!(half[0] > none[0] + 40 && half[0] + 20 < full[0], "{none:?} {half:?} {full:?}");
    // Half of the light of 204 is 149 in sRGB. The weak lamp adds a little.
    assert!((143..=160).contains(&half[0]), "{half:?}");
}
