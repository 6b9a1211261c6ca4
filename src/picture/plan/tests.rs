//! Tests of the contents of pictures.

use glam::DVec3;

use super::*;
use crate::picture::Form;
use crate::picture::arrows::ArrowOwner;
use crate::simulate::{Frames, survey};

fn plan(keys: &str) -> (Plan, Frame) {
    let text = format!(
        "simulation = {{ duration = 1, gravity = [0, -10, 0] }}
        [body.ball]\nshape.sphere.radius = 0.1\nvelocity = [1, 5, 0]\n{keys}"
    );
    let scene = Scene::parse(&text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frame = Frames::at(&scene, 0.5).unwrap();
    (plan, frame)
}

#[test]
fn what_nobody_asks_for_is_not_there() {
    let (plan, frame) = plan("");
    assert!(plan.arrows(&frame).is_empty() && plan.marks(&frame).is_empty());
    assert!(plan.links(&frame).is_empty() && plan.trails(&frame).is_empty());
    assert!(plan.texts(&frame).is_empty() && plan.ghosts(&frame).next().is_none());
    assert!(plan.grid(&frame).is_none() && plan.bar(&frame).is_none() && plan.screen(&frame).is_none());
    assert!(plan.lights(0.5).is_empty() && !plan.camera_moves() && !plan.lights_move());
}

#[test]
fn lengths_are_metres_whatever_the_unit_of_scripts_is() {
    let keys = "arrows.velocity.scale = 0.2\naxes.length = 2\n[povray]\nunit = 0.001";
    let (plan, frame) = plan(keys);
    let ball = frame.bodies[0];
    let [arrow] = plan.arrows(&frame)[..] else { panic!("one is asked for") };
    assert_eq!((arrow.owner, arrow.quantity), (ArrowOwner::Body(0), Quantity::Velocity));
    assert!((arrow.from.distance(ball.location) - 0.1).abs() < 1e-9);
    assert!((arrow.to - arrow.from).abs_diff_eq(0.2 * ball.velocity, 1e-12));
    let marks = plan.marks(&frame);
    let [_, Thing { form: Form::Axes { location, length, .. }, .. }] = marks[..] else { panic!("{marks:?}") };
    assert_eq!((location, length), (ball.location, 2.0));
    assert!((1.0..5.0).contains(&plan.stage().size));
}

/// The arrows of a ghost show the contact forces at the time of the ghost.
#[test]
fn ghosts_have_the_arrows_of_what_touched_them() {
    let text = "[simulation]\nduration = 0.5\ngravity = [0, -10, 0]\ncontacts = 'event-driven'
        integrator = 'rk4'\n[body.block]\nshape.box.size = [1, 1, 1]\nmass = 2\nlocation = [0, 0.5, 0]
        velocity = [4, 0, 0]\nfriction = 0.2\nghosts = { every = 0.2, arrows = true }
        arrows = { normal.scale = 0.1, friction.scale = 0.1 }";
    let scene = Scene::parse(text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frame = Frames::at(&scene, 0.48).unwrap();
    let ghosts: Vec<_> = plan.ghosts(&frame).filter(|ghost| ghost.time > 0.1).collect();
    assert_eq!(ghosts.len(), 2);
    for ghost in ghosts {
        let [normal, friction] = plan.ghost_arrows(&frame, ghost)[..] else { panic!("two are asked for") };
        let along = |arrow: Arrow| (arrow.to - arrow.from).normalize();
        assert!(along(normal).dot(DVec3::Y) > 0.99, "{normal:?}");
        assert!(along(friction).dot(DVec3::X) < -0.99, "{friction:?}");
    }
}

#[test]
fn ghosts_have_their_arrows_and_are_not_where_their_body_is() {
    let (plan, frame) = plan("arrows.velocity = true\nghosts.every = 0.25");
    let ghosts: Vec<f64> = plan.ghosts(&frame).map(|ghost| ghost.time).collect();
    assert_eq!(ghosts, [0.0, 0.25]);
    for ghost in plan.ghosts(&frame) {
        let [arrow] = plan.ghost_arrows(&frame, ghost)[..] else { panic!("they have arrows") };
        assert!(arrow.from.distance(ghost.body.location) < 0.1 + 1e-9);
    }
}

#[test]
fn texts_say_of_what_they_are_and_the_bar_is_below_its_number() {
    let (plan, frame) = plan("[label.now]\ntext = '${t:.1} s'\n[scale_bar]\nlength = 1\n[grid]");
    let texts = plan.texts(&frame);
    let says = |name: &str| texts.iter().find(|text| text.name == name).map(|text| text.says.as_ref());
    assert_eq!((says("now"), says("scale bar")), (Some("0.5 s"), Some("1 m")));
    assert!(says("grid").is_some() && plan.grid(&frame).is_some_and(|grid| !grid.lines().is_empty()));
    let (bar, number) = plan.written(&frame).unwrap().bar.unwrap();
    assert_eq!(Some(bar), plan.bar(&frame));
    assert!(number.y.above_middle(0.5) > bar.y.above_middle(0.5));
    assert!((number.x - (bar.from + bar.to) / 2.0).abs() < 1e-12);
}

#[test]
fn a_camera_that_follows_looks_at_its_body() {
    let (plan, frame) = plan("[camera]\nfollow = { body = 'ball' }\n[label.now]\ntext = 'x'");
    assert!(plan.camera_moves());
    assert_eq!(plan.camera(&frame).look_at(), frame.bodies[0].location);
    let spot = plan.screen(&frame).unwrap().project(frame.bodies[0].location).unwrap();
    assert!(spot.x.abs() < 1e-12 && spot.y.abs() < 1e-12);
}
