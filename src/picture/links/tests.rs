//! Tests of the drawn parts of springs and joints: they must be where the bodies are.

use glam::DVec3;

use crate::picture::Form;
use crate::picture::Plan;
use crate::scene::Scene;
use crate::simulate::{Frames, survey};

/// The shapes of all springs and joints in a frame of a scene.
fn forms(text: &str, frame: usize) -> Vec<Form> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frame = Frames::new(&scene).nth(frame).unwrap().unwrap();
    plan.links(&frame).into_iter().map(|link| link.form).collect()
}

fn near(point: DVec3, x: f64, y: f64, z: f64) -> bool {
    point.abs_diff_eq(DVec3::new(x, y, z), 1e-9)
}

#[test]
fn a_spring_is_a_coil_a_straight_line_or_nothing() {
    let scene = |keys: &str| {
        format!(
            "[body.ball]\nshape.sphere.radius = 0.5\nlocation = [4, 0, 0]\n[force.s.spring]\nstiffness = 0\n
             between = ['ball', [0, 0, 0]]\n{keys}"
        )
    };
    let [Form::Ball { at, radius: knob }, Form::Coil { radius, .. }] = forms(&scene("line = 'coil'"), 0)[..]
    else {
        panic!("a coil, and its end")
    };
    assert!(at == DVec3::ZERO && (knob - 0.6 * radius).abs() < 1e-12);
    let straight = forms(&scene("line = 'straight'\ncoil = { radius = 0.02, color = 'red' }"), 0);
    let [Form::Ball { .. }, Form::Rod { ends: [from, to], radius: 0.02 }] = straight[..] else {
        panic!("{straight:?}")
    };
    assert!(near(from, 4.0 - 0.95 * 0.5, 0.0, 0.0) && near(to, 0.0, 0.0, 0.0), "{from} {to}");
    assert_eq!(forms(&scene("line = 'none'"), 0), []);
    assert_eq!(forms(&scene("coil = false"), 0), []);
}

#[test]
fn an_axle_goes_through_what_turns_about_it_and_an_arm_to_what_is_far() {
    let bar = "[body.bar]\nshape.box.size = [0.2, 1, 0.1]\nlocation = [0, -0.4, 0]\n[joint.pivot.hinge]\n
               between = [[0, 0, 0], 'bar']\naxis = [0, 0, 2]";
    let found = forms(bar, 0);
    let [Form::Rod { ends: [from, to], radius }] = found[..] else { panic!("{found:?}") };
    assert!((radius - 0.35 * 0.05).abs() < 1e-12, "{radius}");
    // The axle extends by half the thickness of the bar plus twice its own radius.
    let half = 0.05 + 2.0 * radius;
    assert!(near(from, 0.0, 0.0, -half) && near(to, 0.0, 0.0, half), "{from} {to}");

    let bob = "[body.bob]\nshape.sphere.radius = 0.1\nlocation = [0, -2, 0]\n[joint.pivot.hinge]\n
               between = [[0, 0, 0], 'bob']\naxis = [0, 0, 1]";
    let found = forms(bob, 0);
    let [Form::Rod { ends: [from, to], radius: arm }, Form::Rod { radius: axle, .. }] = found[..] else {
        panic!("{found:?}")
    };
    assert!(near(from, 0.0, -2.0 + 0.095, 0.0) && near(to, 0.0, 0.0, 0.0), "{from} {to}");
    assert!(axle > arm, "{axle} {arm}");
    assert_eq!(forms(&format!("{bob}\nlook = 'none'"), 0), []);
}

/// The cart starts at rest at x = 1 m. With 2 m/s² for 1 s, it reaches x = 2 m, except for the error of the method.
#[test]
fn a_rail_is_as_long_as_the_way_of_what_slides() {
    let scene = |between: &str| {
        format!(
            "simulation = {{ duration = 1, integrator = 'rk4' }}\n[body.cart]\nshape.box.size = [0.4, 0.2, 0.2]\n
             mass = 1\nlocation = [1, 0, 0]\nforce = [2, 0, 0]\n[joint.rail.slider]\nbetween = {between}\naxis = [1, 0, 0]"
        )
    };
    for between in ["[[0, 0, 0], 'cart']", "['cart', [0, 0, 0]]"] {
        for frame in [0, 25] {
            let found = forms(&scene(between), frame);
            let [Form::Rod { ends, .. }] = found[..] else { panic!("{found:?}") };
            let [left, right] = if ends[0].x < ends[1].x { ends } else { [ends[1], ends[0]] };
            assert!(
                near(left, 1.0 - 1.3 * 0.2, 0.0, 0.0) && near(right, 2.0 + 1.3 * 0.2, 0.0, 0.0),
                "{found:?}"
            );
        }
    }
}

/// The lift moves from y = 1 m to y = 2 m below a beam, whose lower side is at y = 3.9 m.
#[test]
fn a_rail_starts_at_the_body_that_it_is_fastened_to() {
    let scene = |x: f64, between: &str| {
        format!(
            "simulation = {{ duration = 1, integrator = 'rk4' }}\n[body.beam]\nshape.box.size = [2, 0.2, 0.4]\n
             location = [{x}, 4, 0]\nfixed = true\n[body.lift]\nshape.box.size = [0.4, 0.4, 0.4]\nmass = 1\n
             location = [0, 1, 0]\nforce = [0, 2, 0]\n[joint.rail.slider]\nbetween = {between}\naxis = [0, 1, 0]"
        )
    };
    for between in ["['beam', 'lift']", "['lift', 'beam']"] {
        for frame in [0, 25] {
            let found = forms(&scene(0.0, between), frame);
            let [Form::Rod { ends, .. }] = found[..] else { panic!("{found:?}") };
            let [low, high] = if ends[0].y < ends[1].y { ends } else { [ends[1], ends[0]] };
            assert!(near(low, 0.0, 1.0 - 1.3 * 0.2, 0.0) && near(high, 0.0, 3.91, 0.0), "{found:?}");
        }
    }
    // The line of the rail misses the beam, so a rod connects them.
    let found = forms(&scene(3.0, "['beam', 'lift']"), 0);
    let [Form::Rod { ends: [from, to], .. }, Form::Rod { ends, .. }] = found[..] else { panic!("{found:?}") };
    assert!(
        near(ends[1], 0.0, 2.0 + 1.3 * 0.2, 0.0) && near(to, ends[1].x, ends[1].y, ends[1].z),
        "{found:?}"
    );
    assert!(from.y > 3.9 && from.y < 4.0 && from.x > 2.0, "it starts below the surface: {from}");
}

/// A leg is glued below the corner of a table. The point of the joint is in the center of the leg, outside of the table.
#[test]
fn fixed_bodies_that_touch_need_no_rods() {
    let scene = |height: f64| {
        format!(
            "[body.top]\nshape.box.size = [1.6, 0.08, 1]\nlocation = [0, 0.76, 0]\n
             [body.leg]\nshape.box.size = [0.08, {height}, 0.08]\nlocation = [0.7, 0.36, 0.4]\n
             [joint.glue.fixed]\nbetween = ['top', 'leg']"
        )
    };
    let rods =
        |text: &str| forms(text, 0).into_iter().filter(|form| matches!(form, Form::Rod { .. })).count();
    assert_eq!(rods(&scene(0.72)), 0, "they touch");
    assert_eq!(rods(&scene(0.8)), 0, "they overlap");
    assert_eq!(rods(&scene(0.5)), 1, "they are apart");
    assert_eq!(rods(&(scene(0.72) + "\nlook.color = 'red'")), 1, "the scene asks for them");
    let compound = "[body.ring]\nlocation = [0, 0, 0]\nmass = 1\n
        shape.compound.parts = [{ sphere.radius = 0.1, location = [2, 0, 0] }, { sphere.radius = 0.1, location = [-2, 0, 0] }]\n
        [body.ball]\nshape.sphere.radius = 0.5\nlocation = [2.6, 0, 0]\n[joint.glue.fixed]\nbetween = ['ring', 'ball']";
    assert_eq!(rods(compound), 0, "a part touches");
    assert_ne!(rods(&compound.replace("2.6", "2.9")), 0);
}
