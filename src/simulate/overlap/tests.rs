//! Tests of the overlap detection: its results, and its cost.

use std::collections::HashSet;

use super::super::{Frame, Frames, survey};
use super::{Overlap, Watch};
use crate::scene::Scene;

fn overlap(text: &str) -> Option<Overlap> {
    survey(&Scene::parse(text).unwrap(), |_| {}).unwrap().overlap
}

fn found(one: &str, two: &str, time: f64) -> Option<Overlap> {
    Some(Overlap { bodies: [one.to_owned(), two.to_owned()], time })
}

#[test]
fn balls_that_run_into_each_other_are_found_with_their_time() {
    let text = "
        [simulation]
        duration = 2
        frame_rate = 10
        [body.left]
        shape.sphere.radius = 0.5
        velocity = [2, 0, 0]
        [body.right]
        shape.sphere.radius = 0.5
        location = [3, 0, 0]
        [body.above]
        shape.box.size = [1, 1, 1]
        location = [0, 1.5, 0]
        ";
    // The two balls touch at t = 1 s, and overlap by more than 0.01 m in the next frame.
    assert_eq!(overlap(text), found("left", "right", 1.1));
    // An overlap of a hundredth of the size is ignored, and so is a contact that exists from the start.
    assert_eq!(overlap(&text.replace("duration = 2", "duration = 1")), None);
    assert_eq!(overlap(&text.replace("[3, 0, 0]", "[1, 0, 0]")), None);
    assert_eq!(overlap(&text.replace("[3, 0, 0]", "[0.2, 0, 0]")), None);
}

/// The upper half of a folding rule swings into the lower half, which the hinge allows. Without the hinge, the same motion is an overlap.
#[test]
fn bodies_that_a_joint_holds_may_be_within_each_other() {
    let text = "
        simulation = { duration = 2, frame_rate = 20 }
        [body.lower]
        shape.box.size = [0.1, 1, 0.1]
        fixed = true
        [body.upper]
        shape.box.size = [0.1, 0.9, 0.1]
        location = [0, 1, 0]
        angular_velocity = [0, 0, 3]
        velocity = [1.5, 0, 0]
        ";
    let hinge = "[joint.fold.hinge]\nbetween = ['lower', 'upper']\nat = [0, 0.5, 0]\naxis = [0, 0, 1]";
    assert_eq!(overlap(&format!("{text}{hinge}")), None);
    let others = "[body.other]\nrepeat = 1\nshape.box.size = [0.1, 1, 0.1]\nfixed = true\n";
    assert!(overlap(&format!("{text}{others}{hinge}")).is_some());
}

#[test]
fn boxes_and_parts_of_compounds_are_found_where_their_surfaces_are() {
    let text = |shape: &str| {
        format!(
            "simulation = {{ duration = 4, frame_rate = 10 }}
            [body.wall]
            shape.box.size = [0.2, 4, 4]
            location = [3, 0, 0]
            fixed = true
            [body.thing]
            shape.{shape}
            velocity = [1, 0, 0]"
        )
    };
    assert_eq!(overlap(&text("box.size = [2, 0.1, 0.1]")), found("wall", "thing", 2.0));
    let dumbbell = "compound.parts = [{ sphere.radius = 0.5, location = [-2, 0, 0] }, { sphere.radius = 0.5, location = [2, 0, 0] }]";
    assert_eq!(overlap(&text(dumbbell)), found("wall", "thing", 0.5));
    // A ring is not convex: a body can pass through its middle, so it is not watched.
    assert_eq!(overlap(&text("torus = { radius = 1, tube_radius = 0.1 }")), None);
}

#[test]
fn what_is_given_to_overlap_may_do_so() {
    let text = "
        [simulation]
        duration = 2
        [body.piston]
        shape.box.size = [1, 1, 1]
        motion.formula.location = ['t', 0, 0]
        [body.cylinder]
        shape.box.size = [1, 1, 1]
        location = [3, 0, 0]
        fixed = true
        ";
    assert_eq!(overlap(text), None);
}

/// Returns the first frame of a scene.
fn first_frame(scene: &Scene) -> Frame {
    Frames::new(scene).next().unwrap().unwrap()
}

/// The grid finds the same near pairs as a comparison of all pairs, for bodies of all sizes, resting or moving.
#[test]
fn near_pairs_are_those_of_all_pairs() {
    for resting in [1, 3, 400] {
        let mut text = String::from("simulation.duration = 0.04\n");
        for i in 0..400 {
            use std::fmt::Write;
            let at = |k: f64| (f64::from(i) * k).fract() * 20.0 - 10.0;
            let radius = 0.03 * libm::exp2(f64::from(i % 7) + at(0.236_067) / 20.0);
            let (x, y, z) = (at(0.618_033), at(0.414_213), at(0.732_050));
            let fixed = i % resting == resting - 1 && resting > 1;
            writeln!(text, "[body.b{i}]\nshape.sphere.radius = {radius}\nlocation = [{x}, {y}, {z}]")
                .unwrap();
            writeln!(text, "fixed = {fixed}").unwrap();
        }
        let scene = Scene::parse(&text).unwrap();
        let frame = first_frame(&scene);
        let mut watch = Watch::new(&scene);
        watch.see(&frame);
        assert!(!watch.is_over);
        let mut expected = HashSet::new();
        for i in 0..400 {
            for j in i + 1..400 {
                let (one, other) = (&watch.near.bodies[i], &watch.near.bodies[j]);
                let distance = (frame.bodies[i].location - frame.bodies[j].location).length();
                if (one.moves || other.moves) && distance < 1.01 * (one.radius + other.radius) {
                    expected.insert((i, j));
                }
            }
        }
        assert!(expected.len() > 100, "{}", expected.len());
        let found = &watch.together;
        assert_eq!(found.symmetric_difference(&expected).collect::<Vec<_>>(), Vec::<&(usize, usize)>::new());
    }
}

#[test]
fn the_work_grows_with_the_number_of_bodies_and_not_with_that_of_pairs() {
    let cost = |count: usize| {
        let scene = Scene::parse(&format!(
            "simulation.duration = 0.04\n[body.b]\nshape.sphere.radius = 0.5\nvelocity = [1, 0, 0]\n\
             repeat.grid = {{ count = [10, 10, {count}], spacing = 1.1 }}\n"
        ));
        let scene = scene.unwrap();
        let (mut watch, frame) = (Watch::new(&scene), first_frame(&scene));
        watch.near.fill(&frame);
        watch.near.each_pair(&frame, u64::MAX, |i, j| watch.cost(i, j))
    };
    let (few, many) = (cost(5), cost(20));
    assert!(many < 5 * few, "{few} for 500 bodies, {many} for 2000");
}

/// A thousand bodies at one position form half a million pairs, all of which overlap from the start. The watch must end early.
#[test]
fn where_all_is_near_all_nothing_is_watched() {
    let scene = Scene::parse(
        "simulation.duration = 0.04\n[body.b]\nshape.sphere.radius = 0.5\nrepeat = 1000\nvelocity = [1, 0, 0]\n",
    );
    let scene = scene.unwrap();
    let mut watch = Watch::new(&scene);
    watch.see(&first_frame(&scene));
    assert!(watch.is_over);
    assert!(watch.together.len() < 100_000);
}
