//! Colors that follow a value: in scripts, on the page's data and in models.

use jabuka::Run;
use jabuka::export::write_glb;
use jabuka::scene::{ColorMap, Scene};
use jabuka::simulate::Selection;

/// Three balls of the material `gas`, with constant speeds of 0, 5 and 10 m/s.
pub(super) const BALLS: &str = "
    simulation.duration = 1
    [defaults.body]
    shape.sphere.radius = 0.1
    material = 'gas'
    [body.still]
    [body.slow]
    location = [0, 1, 0]
    velocity = [5, 0, 0]
    [body.fast]
    location = [0, 2, 0]
    velocity = [0, 0, 10]
    [material.gas]
    ";

/// Returns a scene of these balls and a fourth one that starts later, whose colors follow their speeds.
fn mapped() -> String {
    format!(
        "{BALLS}color.map = {{ of = 'speed', palette = ['black', 'white'] }}\n[body.late]\nlocation = [0, 3, 0]\nstart = 0.5"
    )
}

/// Returns the script of a frame.
pub(super) fn script(text: &str, frame: usize) -> String {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{}", report.to_text(false)));
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
    let first = colored(&script(&mapped(), 0));
    assert_eq!(first, [pair("still", "<0, 0, 0>"), pair("slow", gray), pair("fast", "<1, 1, 1>")]);
    let last = colored(&script(&mapped(), 25));
    assert_eq!(last[..2], [pair("still", "<0, 0, 0>"), pair("late", "<0, 0, 0>")], "one union");
}

/// The color at a value is that of the palette at (value − low)/(high − low). Values outside of the range get the colors of its ends, and an
/// undefined value is gray.
#[test]
fn a_range_and_a_formula_choose_the_color() {
    let of = |of: &str| {
        let text = mapped().replace("'speed',", &format!("'{of}', range = [-10, 10],"));
        let scene = Scene::parse(&text).unwrap();
        let run = Run::new(&scene).unwrap();
        run.emitter().plan().looks(&run.frames().next().unwrap().unwrap()).colors
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
    let scene = Scene::parse(&mapped()).unwrap();
    let run = Run::new(&scene).unwrap();
    let mut bytes = Vec::new();
    write_glb(run.recorded(), &Selection::first(3), &mut bytes).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    for color in ["[0.0,0.0,0.0,1.0]", "[1.0,1.0,1.0,1.0]"] {
        assert!(text.contains(color), "{color}");
    }
}

/// A ball that falls from rest with 10 m/s², so that its speed is 10 t, from black at 0 m/s to white at 10 m/s. Its color is that of the
/// exact speed at each time.
const FALL: &str = "
    simulation = { duration = 1, gravity = [0, -10, 0], integrator = 'velocity-verlet', frame_rate = 50 }
    [body.ball]
    shape.sphere.radius = 0.1
    location = [0, 5, 0]
    material.color.map = { of = 'speed', palette = ['black', 'white'], range = [0, 10] }
    ";

/// Returns the colors that a script declares for the next bodies.
fn declared(script: &str) -> Vec<f64> {
    let red = |line: &str| line.strip_prefix("#local Shade = <")?.split(',').next()?.parse().ok();
    script.lines().filter_map(red).collect()
}

#[test]
fn a_ghost_has_the_color_of_its_time() {
    // The ghosts are between frames and in frames.
    let text = format!("{FALL}ghosts.every = 0.25\n");
    let found = declared(&script(&text, 50));
    let pale = |speed: f64| {
        let color = (256.0 * speed / 10.0).floor().min(255.0) / 255.0;
        color + 0.5 * (0.93 - color)
    };
    let expected = [1.0, pale(0.0), pale(2.5), pale(5.0), pale(7.5)];
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // Rounding may give the neighbor of a color.
        assert!((found - expected).abs() < 0.5 / 255.0 + 1e-6, "{found} instead of {expected}");
    }
}

/// Measures of the whole run are known between frames as well, and a recording knows what the simulation knew.
#[test]
fn a_ghost_between_frames_knows_the_measures_of_the_run() {
    let of = "'total + 1000*impacts + ball.y'";
    let text = format!("{FALL}ghosts.every = 0.13\ntrail = true\nlocation = [0, 1, 0]\n")
        .replacen("location = [0, 5, 0]\n", "", 1)
        .replace("'speed'", of)
        .replace("frame_rate", "contacts = 'event-driven', frame_rate");
    let scene = Scene::parse(&text).unwrap();
    let run = Run::new(&scene).unwrap();
    let live = jabuka::simulate::Frames::new(&scene).last().unwrap().unwrap();
    let recorded = run.frames().last().unwrap().unwrap();
    assert_eq!(live.past, recorded.past);
    assert_eq!(live.past.ghosts.len(), 8);
    for ghost in &live.past.ghosts {
        // It hits the ground at t = √(0.18) s, with its center 0.1 m above it.
        let impacts = f64::from(ghost.time > 0.18_f64.sqrt());
        let expected = 10.0 + 1000.0 * impacts + ghost.body.location.y;
        let value = ghost.look.color.unwrap();
        // At the impact, a part of the energy is lost.
        assert!(
            (value - expected).abs() < if impacts > 0.0 { 10.0 } else { 1e-9 },
            "{value} at {} s",
            ghost.time
        );
    }
}

/// Each point of a trail has the color of the value at its time, in every layout. The arrays of colors are as long as those of points.
#[test]
fn a_trail_has_the_colors_of_its_values() {
    for layout in ["shared", "self-contained"] {
        let text = format!("{FALL}trail = true\n[output]\nlayout = '{layout}'");
        let scene = Scene::parse(&text).unwrap();
        let run = Run::new(&scene).unwrap();
        let frame = run.frames().last().unwrap().unwrap();
        let trails = run.emitter().plan().trails(&frame);
        let [trail] = &trails[..] else { panic!("{trails:?}") };
        for (point, shade) in trail.points.iter().zip(&trail.shades) {
            let speed = (20.0 * (5.0 - point.y)).max(0.0).sqrt();
            // Between frames, the color is that of the interpolated value, which is exact here.
            let exact = (256.0 * speed / 10.0).min(255.0);
            assert!((f64::from(*shade) + 0.5 - exact).abs() < 1.0, "{point}: {shade} instead of {exact}");
        }
        let files: String =
            run.emitter().trail_files(&frame, &|_| false).iter().map(|it| &*it.text).collect();
        let all = run.script(&frame).unwrap() + &files;
        let sizes = |word: &str| -> Vec<String> {
            let parts = all
                .split(word)
                .skip(1)
                .filter_map(|rest| Some(rest.split_once("array[")?.1.split_once(']')?.0));
            parts.map(str::to_owned).collect()
        };
        let (points, shades) = match layout {
            "shared" => (sizes("#declare Trail_"), sizes("#declare Shades_")),
            _ => (sizes("#local Points"), sizes("#local Shades")),
        };
        assert_eq!(points, shades);
        assert!(!points.is_empty(), "{all}");
    }
}

/// A color of its own, and a body of one color, give a trail of one color.
#[test]
fn a_trail_with_a_color_of_its_own_keeps_it() {
    let given = script(&format!("{FALL}trail.color = 'red'\n"), 9);
    let plain = script(
        &format!("{FALL}trail = true\nmaterial.color = 'red'\n").replace("material.color.map", "# "),
        9,
    );
    for script in [given, plain] {
        assert!(script.contains("  Trail(Points, ") && !script.contains("Shaded_trail"), "{script}");
        assert!(!script.contains("Colors_of_map"));
    }
}
