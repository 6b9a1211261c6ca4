//! Looks that follow values: transparency, glow, size and visibility, in scripts and in models.

use super::color_maps::{BALLS, script};
use jabuka::Run;
use jabuka::export::write_glb;
use jabuka::picture::Looks;
use jabuka::scene::Scene;
use jabuka::simulate::Selection;

fn looks(text: &str) -> Looks {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{}", report.to_text(false)));
    let run = Run::new(&scene).unwrap();
    run.emitter().plan().looks(&run.frames().next().unwrap().unwrap())
}

/// The number at a value is `to[0]` + part (`to[1]` − `to[0]`), in 63 steps. Values outside of the range get the numbers of its ends.
#[test]
fn a_value_gives_the_number_of_its_place_in_the_range() {
    let near = |found: &[f64], expected: [f64; 3]| {
        found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 0.5 / 63.0 + 1e-12)
    };
    let found = looks(&format!("{BALLS}transparency.map.of = 'speed'\nglow = 0.5"));
    assert!(near(&found.transparency, [0.0, 0.5, 1.0]), "{found:?}");
    assert!(found.glow.is_empty() && found.colors.is_empty());
    assert_eq!([found.transparency[0], found.transparency[2]], [0.0, 1.0], "the ends are exact");
    let found = looks(&format!("{BALLS}glow.map = {{ of = 'speed', range = [5, 20], to = [1, 0.4] }}"));
    assert!(near(&found.glow, [1.0, 1.0, 0.8]), "{found:?}");
    let found = looks(&format!("{BALLS}glow.map = {{ of = '1/speed', range = [0, 0.2], to = [0.3, 0.7] }}"));
    assert!(near(&found.glow, [0.3, 0.7, 0.5]), "an undefined value has the first number: {found:?}");
}

/// Bodies of one look stand in one union, with its values before it.
#[test]
fn bodies_of_one_look_stand_together() {
    let gas = |keys: &str| {
        let text = format!(
            "simulation.duration = 0
            [body.gas]\nshape.sphere.radius = 0.1\nlocation = ['i', 0, 0]\nvelocity = ['i', 0, 0]
            repeat.count = 1000\nmaterial = 'gas'\n[material.gas]\n{keys}"
        );
        script(&text, 0)
    };
    let objects = |script: &str| script.matches("\nunion {").count() + script.matches("\nobject {").count();
    let clear = gas("transparency.map.of = 'speed'");
    assert_eq!(
        (clear.matches("#local Transparency = ").count(), clear.matches("#local Shade = ").count()),
        (64, 0)
    );
    assert_eq!(objects(&clear), 64);
    assert!(clear.contains("material { Material_gas(Transparency) }"));
    let both = gas(
        "color.map = { of = 'speed', bar = false }\ntransparency.map.of = 'speed'\nglow.map.of = 'speed'",
    );
    assert!((256..=320).contains(&objects(&both)), "{}: as many as colors and steps", objects(&both));
    assert!(both.contains("#macro Material_gas(Shade, Transparency, Glow)"));
    assert_eq!(objects(&gas("transparency = 0.5")), 1, "a fixed number needs no parts");
}

#[test]
fn a_model_has_the_looks_of_its_first_frame() {
    let model = |keys: &str| {
        let scene = Scene::parse(&format!("{BALLS}{keys}")).unwrap();
        let run = Run::new(&scene).unwrap();
        let mut bytes = Vec::new();
        write_glb(run.recorded(), &Selection::first(3), &mut bytes).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    };
    let clear = model("color = 'white'\ntransparency.map = { of = 'speed', range = [0, 20] }");
    // 0.5 in steps of 1/63.
    for cover in ["1.0,1.0,1.0,1.0]", "1.0,1.0,1.0,0.49206"] {
        assert!(clear.contains(cover), "{cover} in {clear}");
    }
    assert_eq!(clear.matches("\"alphaMode\":\"BLEND\"").count(), 2, "the ball at rest is opaque");
    let glowing = model("color = 'white'\nglow.map.of = 'speed'");
    assert!(glowing.contains("\"emissiveFactor\":[1.0,1.0,1.0]") && glowing.contains("[0.0,0.0,0.0,1.0]"));
    assert_eq!(glowing.matches("emissiveFactor").count(), 2);
    let fixed = model("color = 'white'\nglow = 0.25\ntransparency = 0.75");
    assert!(fixed.contains("\"emissiveFactor\":[0.25,0.25,0.25]") && fixed.contains("[0.75,0.75,0.75,0.25]"));
}

/// Returns the name of each ball in a script, with its radius.
fn radii(script: &str) -> Vec<(&str, f64)> {
    let of_line = |line: &&str| line.contains("sphere {");
    let radius = |line: &str| line.split_once(">, ")?.1.split([' ', '}']).next()?.parse().ok();
    let found = script.lines().filter(of_line);
    found.filter_map(|line| Some((line.split_once("} // ")?.1, radius(line)?))).collect()
}

/// The radius at a value is the true one times `to[0]` + part (`to[1]` − `to[0]`), without steps.
#[test]
fn a_body_is_drawn_as_large_as_its_value_says() {
    let with = |keys: &str| {
        let text = format!("{BALLS}\n").replace("[body.still]", &format!("{keys}\n[body.still]"));
        script(&(text + "[povray]\nunit = 1"), 0)
    };
    let usual = with("look.scale.map.of = 'speed'");
    assert_eq!(radii(&usual), [("still", 0.1), ("slow", 0.15), ("fast", 0.2)]);
    let given = with("look.scale.map = { of = 'speed', range = [4, 8], to = [3, 1] }");
    assert_eq!(radii(&given), [("still", 0.3), ("slow", 0.25), ("fast", 0.1)]);
}

/// A matrix scales what is no ball, about its center.
#[test]
fn a_box_is_drawn_as_large_as_its_value_says() {
    let text = "simulation.duration = 0\n[body.crate]\nshape.box.size = [1, 1, 1]\nlocation = [3, 0, 0]
        look.scale.map = { of = 'x', range = [0, 6], to = [1, 2] }\n[povray]\nunit = 1";
    let script = script(text, 0);
    // Drawn 1.5 times as large: its largest size, 2, times 0.75.
    assert!(script.contains("matrix <0.75, 0, 0, 0, 0.75, 0, 0, 0, 0.75, 3, 0, 0>"), "{script}");
    assert!(script.contains("box { <-1, -1, -1>, <1, 1, 1>") || script.contains("box { -1, 1"), "{script}");
}

#[test]
fn a_body_is_drawn_while_its_condition_holds() {
    let scene = |condition: &str| {
        let text = BALLS.replace("[body.still]", &format!("look.visible = {condition}\n[body.still]"));
        Scene::parse(&text).unwrap_or_else(|report| panic!("{}", report.to_text(false)))
    };
    let names = |condition: &str, frame: usize| -> Vec<String> {
        let scene = scene(condition);
        let run = Run::new(&scene).unwrap();
        let frame = run.frames().nth(frame).unwrap().unwrap();
        assert_eq!(frame.bodies.len(), 3, "the run has all bodies");
        let script = run.script(&frame).unwrap();
        radii(&script).into_iter().map(|(name, _)| name.to_owned()).collect()
    };
    assert_eq!(names("'speed > 1'", 0), ["slow", "fast"]);
    assert_eq!(names("'z'", 0), [""; 0]);
    assert_eq!(names("'z'", 1), ["fast"], "it is at z = 0.4 m");
    assert_eq!([names("'t >= 0.5'", 12).len(), names("'t >= 0.5'", 13).len()], [0, 3]);
    assert_eq!(names("'1/speed'", 0), ["slow", "fast"], "an undefined value hides the body");
    assert_eq!([names("false", 0).len(), names("true", 0).len()], [0, 3]);
}

/// Ghosts show what was: a ghost has the size of its own time, and there is none of a hidden body.
#[test]
fn ghosts_have_the_size_and_the_visibility_of_their_time() {
    let text = "simulation = { duration = 1, frame_rate = 20 }\n[body.ball]\nshape.sphere.radius = 0.1\nvelocity = [10, 0, 0]
        look = { visible = 't > 0.1', scale.map = { of = 'x', range = [0, 10], to = [1, 2] } }
        ghosts.every = 0.25\nmaterial = 'red'\n[material.red]\ncolor = 'red'\n[povray]\nunit = 1";
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let script = run.script(&run.frames().last().unwrap().unwrap()).unwrap();
    let found: Vec<f64> = radii(&script).into_iter().map(|(_, radius)| radius).collect();
    // The body itself, and the ghosts at 0.25, 0.5 and 0.75 s. That at 0 s was hidden.
    for (found, expected) in found.iter().zip([0.2, 0.125, 0.15, 0.175]) {
        assert!((found - expected).abs() < 1e-9, "{found} instead of {expected}");
    }
    assert_eq!(found.len(), 4);
}

#[test]
fn a_model_has_the_sizes_of_its_first_frame() {
    let text = BALLS.replace(
        "[body.still]",
        "look = { visible = 'speed > 1', scale.map = { of = 'speed', range = [5, 10] } }\n[body.still]",
    );
    let scene = Scene::parse(&text).unwrap();
    let run = Run::new(&scene).unwrap();
    let mut bytes = Vec::new();
    write_glb(run.recorded(), &Selection::first(3), &mut bytes).unwrap();
    let model = String::from_utf8_lossy(&bytes);
    for scale in ["[0.1,0.1,0.1]", "[0.2,0.2,0.2]"] {
        assert_eq!(model.matches(&format!("\"scale\":{scale}")).count(), 1, "{scale} in {model}");
    }
    assert!(model.contains("{\"name\":\"still\""));
}
