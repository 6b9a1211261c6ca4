//! Tests formulas in scenes.

use glam::DVec3;

use crate::diagnostic::{Code, Report};
use crate::scene::{Options, Override, Scene};

fn location(text: &str) -> DVec3 {
    Scene::parse(text).unwrap().bodies[0].start.location
}

fn errors(text: &str) -> Vec<(Code, String)> {
    let Report { diagnostics, .. } = Scene::parse(text).unwrap_err();
    diagnostics.into_iter().map(|diagnostic| (diagnostic.code, diagnostic.message)).collect()
}

#[test]
fn a_formula_stands_wherever_a_number_does() {
    let scene = Scene::parse(
        r#"
        simulation = { duration = "1/2", frame_rate = "5*5", gravity = [0, "-g", 0] }
        variables = { g = "9 + 81/100", n = 2, deep = "n*n" }
        environment.sky = ["1/4", 0.5, "3/4"]
        [body.ball]
        shape.compound.parts = [{ sphere.radius = "n" }, { sphere.radius = 2, location = ["4*n", 0, 0] }]
        orientation = { axis = ["n - 1", 0, 0], angle = "deg(pi)" }
        location = ["-n^2", "2^3^2", "deep"]
        mass = """
            1
            + n"""
        [force.s.spring]
        between = ["ball", ["n", "n", 0]]
        stiffness = "1e2"
        [output]
        size = ["320*n", 480]
        "#,
    )
    .unwrap();
    assert_eq!((scene.simulation.timeline.frames(), scene.simulation.gravity.y), (14, -9.81));
    let ball = &scene.bodies[0];
    assert_eq!(ball.start.location, DVec3::new(-4.0, 512.0, 4.0));
    assert_eq!(ball.start.mass, 3.0);
    assert!((ball.start.orientation * DVec3::Y - DVec3::NEG_Y).length() < 1e-15);
    assert_eq!((scene.output.width, scene.output.height), (640, 480));
}

#[test]
fn strings_that_are_no_numbers_stay_as_they_are() {
    let scene = Scene::parse(
        "title = '2*3'\n[material.pi]\ncolor = 'tan'\n[body.'1 + 1']\nshape.sphere.radius = 1\nmaterial = 'pi'\n",
    );
    let scene = scene.unwrap();
    assert_eq!((scene.title.as_deref(), &*scene.bodies[0].name), (Some("2*3"), "1 + 1"));
}

#[test]
fn variables_may_stand_in_any_order_and_be_set_from_outside() {
    let text = "[variables]\na = 'b + 1'\nb = '2*c'\nc = 3\nunused = 'a/b'\n[body.ball]\nshape.sphere.radius = 'a'\n\
                location = ['a', 'b', 'c']";
    assert_eq!(location(text), DVec3::new(7.0, 6.0, 3.0));
    for (set, expected) in [
        ("variables.c=4", DVec3::new(9.0, 8.0, 4.0)),
        ("variables.b=10*c", DVec3::new(31.0, 30.0, 3.0)),
        ("body.ball.location=['c', \"c/2\", 0]", DVec3::new(3.0, 1.5, 0.0)),
    ] {
        let options = Options { overrides: vec![Override::new(set)], ..Options::default() };
        assert_eq!(Scene::parse_with(text, &options).unwrap().bodies[0].start.location, expected, "{set}");
    }
}

#[test]
fn a_long_chain_of_variables_and_a_long_cycle_are_no_trouble() {
    use std::fmt::Write as _;
    const CHAIN_LENGTH: usize = 20_000;
    let mut text = String::from("[body.ball]\nshape.sphere.radius = 'v0'\n[variables]\n");
    for i in 0..CHAIN_LENGTH {
        writeln!(text, "v{i} = 'v{}'", i + 1).unwrap();
    }
    let ends = format!("{text}v{CHAIN_LENGTH} = 0.25\n");
    let scene = Scene::parse(&ends).unwrap();
    assert_eq!(scene.bodies[0].shape, crate::physics::Shape::Sphere { radius: 0.25 });
    let cycle = format!("{text}v{CHAIN_LENGTH} = 'v0'\n");
    let said = errors(&cycle);
    assert_eq!(said.len(), 1);
    assert_eq!(said[0].1, "variables need each other: `v0` → `v1` → `v2` → `v3` → `v4` → `v5` → … → `v0`");
}

#[test]
fn every_cycle_is_told_once_and_what_needs_it_is_not() {
    let said = errors(
        "[variables]\na = 'b'\nb = 'a + c'\nc = 'd'\nd = 'c'\ne1 = 'e1'\nf = 'a*g'\ng = 1\n\
         [body.ball]\nshape.sphere.radius = 'f + a'",
    );
    let codes: Vec<_> = said.iter().map(|(code, _)| *code).collect();
    assert_eq!(codes, [Code::CyclicVariables; 3], "{said:?}");
}

#[test]
fn random_numbers_follow_from_the_seed_and_their_place() {
    let body = |name: &str| {
        format!(
            "[body.{name}]\nshape.sphere.radius = 1\nlocation = ['uniform(0, 1)', 'uniform(0, 1)', 'normal(0, 1)']\n"
        )
    };
    let both = Scene::parse(&(body("a") + &body("b"))).unwrap();
    let alone = location(&body("b"));
    assert_eq!(both.bodies[1].start.location, alone, "another body changed the numbers");
    assert_ne!(both.bodies[0].start.location, alone);
    assert_ne!(alone.x, alone.y);
    assert_ne!(location(&format!("seed = 1\n{}", body("b"))), alone);
    let twice = "[body.b]\nshape.sphere.radius = 1\nlocation = ['uniform(0, 1) - uniform(0, 1)', 0, 0]";
    assert_ne!(location(twice).x, 0.0);
    let one = "[variables]\nu = 'uniform(3, 4)'\n[body.b]\nshape.sphere.radius = 1\nlocation = ['u', 'u', 0]";
    let one = location(one);
    assert!(one.x == one.y && (3.0..4.0).contains(&one.x), "{one}");
}

#[test]
fn a_seed_is_no_random_number_and_needs_no_variable() {
    let with_seed =
        |seed: &str| format!("seed = {seed}\n[variables]\nn = 1\n[body.b]\nshape.sphere.radius = 1");
    assert!(Scene::parse(&with_seed("'2^31'")).is_ok());
    assert_eq!(errors(&with_seed("'n'"))[0].0, Code::UnknownName);
    assert_eq!(errors(&with_seed("'uniform(0, 9)'"))[0].0, Code::FormulaSyntax);
    assert_eq!(errors(&with_seed("-1"))[0].0, Code::OutOfRange);
}
