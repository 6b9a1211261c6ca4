//! Colors that follow a value: in scripts, on the page's data and in models.

use jabuka::Run;
use jabuka::export::write_glb;
use jabuka::scene::{ColorMap, Scene};
use jabuka::simulate::Selection;

/// Three balls with constant speeds of 0, 5 and 10 m/s, a fourth one that starts later, and a crate with a pattern.
const BALLS: &str = "
    simulation.duration = 1
    [defaults.body]
    shape.sphere.radius = 0.1
    material = 'gray'
    [material.gray]
    color.map = { of = 'speed', palette = ['black', 'white'] }
    [body.still]
    [body.slow]
    location = [0, 1, 0]
    velocity = [5, 0, 0]
    [body.fast]
    location = [0, 2, 0]
    velocity = [0, 0, 10]
    [body.late]
    location = [0, 3, 0]
    start = 0.5
    ";

fn script(text: &str, frame: usize) -> String {
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    run.script(&run.frames().nth(frame).unwrap().unwrap()).unwrap()
}

/// Returns the name of each body in a script, with the color that it has there.
fn colored(script: &str) -> Vec<(String, String)> {
    let (mut shade, mut found) = (String::new(), Vec::new());
    for line in script.lines() {
        if let Some(color) = line.strip_prefix("#local Shade = ") {
            shade = color.trim_end_matches(';').to_owned();
        } else if let Some((_, name)) = line.split_once("} // ").filter(|_| line.contains("sphere")) {
            found.push((name.to_owned(), shade.clone()));
        }
    }
    found
}

#[test]
fn bodies_of_one_value_stand_together_in_its_color() {
    let (gray, name) = ("<0.501960784, 0.501960784, 0.501960784>", |name: &str| name.to_owned());
    let pair = |body: &str, color: &str| (name(body), name(color));
    let first = colored(&script(BALLS, 0));
    assert_eq!(first, [pair("still", "<0, 0, 0>"), pair("slow", gray), pair("fast", "<1, 1, 1>")]);
    let last = colored(&script(BALLS, 25));
    assert_eq!(last[..2], [pair("still", "<0, 0, 0>"), pair("late", "<0, 0, 0>")], "one union");
}

/// The color at a value is that of the palette at (value − low)/(high − low). Values outside of the range get the colors of its ends, and an
/// undefined value is gray.
#[test]
fn a_range_and_a_formula_choose_the_color() {
    let of = |of: &str| {
        let text = BALLS.replace("'speed',", &format!("'{of}', range = [-10, 10],"));
        let scene = Scene::parse(&text).unwrap();
        let run = Run::new(&scene).unwrap();
        run.emitter().plan().colors(&run.frames().next().unwrap().unwrap())
    };
    // The last body is absent, so its value is undefined.
    let undefined = u16::try_from(ColorMap::COLORS).unwrap();
    assert_eq!(of("speed"), [128, 192, 255, undefined]);
    assert_eq!(of("10*speed"), [128, 255, 255, undefined]);
    assert_eq!(of("-speed"), [128, 64, 0, undefined]);
    assert_eq!(of("slow.speed"), [192, 192, 192, 192]);
    assert_eq!(of("speed - fast.speed"), [0, 64, 128, undefined]);
    assert_eq!(of("1/speed"), [undefined, 130, 129, undefined]);
    assert_eq!(of("speed:km/h"), [128, 255, 255, undefined], "18 and 36 km/h");
}

/// The number of materials does not grow with the number of bodies.
#[test]
fn copies_share_one_map_and_one_bar() {
    let text = "simulation.duration = 0
        [body.gas]\nshape.sphere.radius = 0.1\nlocation = ['i', 0, 0]\nvelocity = ['i', 0, 0]\nrepeat.count = 1000
        material.color.map = { of = 'speed' }
        [body.other]\nshape.sphere.radius = 0.1\nlocation = [0, 1, 0]\nmaterial.color.map = { of = 'speed' }";
    let script = script(text, 0);
    assert_eq!(script.matches("#macro Material_").count(), 2);
    assert_eq!(script.matches("Strip(<").count(), 1);
    assert_eq!(
        script.matches("#local Shade = ").count(),
        256 + 1,
        "the other body has a material of its own"
    );
}

/// A model has the colors of its first frame.
#[test]
fn a_model_has_the_colors_of_its_first_frame() {
    let scene = Scene::parse(BALLS).unwrap();
    let run = Run::new(&scene).unwrap();
    let mut bytes = Vec::new();
    write_glb(run.recorded(), &Selection::first(3), &mut bytes).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    for color in ["[0.0,0.0,0.0,1.0]", "[1.0,1.0,1.0,1.0]"] {
        assert!(text.contains(color), "{color}");
    }
}
