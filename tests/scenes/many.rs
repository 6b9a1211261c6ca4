//! Tests of short scenes with many bodies, and of their scripts.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use jabuka::{Run, Scene};

use crate::support;

/// Returns the text of a scene of the gallery.
fn text(name: &str) -> String {
    std::fs::read_to_string(support::scene(name)).unwrap()
}

#[test]
fn a_spiral_of_500_dominoes_is_at_most_25_lines() {
    let text = text("dominoes");
    assert!(text.lines().count() <= 25);
    let scene = Scene::parse(&text).unwrap();
    assert_eq!(scene.bodies.len(), 500);
    let bottom = |body: &jabuka::scene::Body| {
        let reach = body.shape.support(body.start.orientation, -glam::DVec3::Y).unwrap();
        body.start.location.y - reach
    };
    for body in &scene.bodies {
        assert!(bottom(body).abs() < 1e-12, "{} does not stand", body.name);
    }
    // Dominoes at equal distances along the spiral are at nearly equal distances in a straight line.
    let gaps = scene.bodies.windows(2).map(|pair| pair[0].start.location.distance(pair[1].start.location));
    let (least, most) = gaps.fold((f64::MAX, 0.0f64), |(least, most), gap| (least.min(gap), most.max(gap)));
    assert!(least > 0.99 * most && most < 0.4, "{least} {most}");
}

#[test]
fn a_thousand_scattered_balls_without_overlap_are_at_most_10_lines() {
    let text = text("scattered_balls");
    assert!(text.lines().count() <= 10);
    let scene = Scene::parse(&text).unwrap();
    assert_eq!(scene.bodies.len(), 1000);
    for (n, one) in scene.bodies.iter().enumerate() {
        for other in &scene.bodies[..n] {
            let reach = one.shape.bounding_radius().unwrap() + other.shape.bounding_radius().unwrap();
            let distance = one.start.location.distance(other.start.location);
            assert!(distance >= reach, "{} overlaps {}", one.name, other.name);
        }
    }
}

/// Returns each body's line in a script, by the body's name.
fn lines(script: &str) -> BTreeMap<&str, &str> {
    script.lines().filter_map(|line| Some((line.rsplit_once(" // ")?.1, line))).collect()
}

/// Returns the scripts of the first three frames of a scene.
fn scripts(text: &str) -> Vec<String> {
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    run.frames().take(3).map(|frame| run.script(&frame.unwrap()).unwrap()).collect()
}

/// Asserts that the scripts of the larger scene contain all body lines of the smaller one unchanged, and more.
fn assert_only_more(before: &str, after: &str) {
    for (before, after) in scripts(before).iter().zip(&scripts(after)) {
        let (before, after) = (lines(before), lines(after));
        assert!(!before.is_empty() && after.len() > before.len(), "{before:?} {after:?}");
        for (body, line) in &before {
            assert_eq!(Some(line), after.get(body));
        }
    }
}

#[test]
fn a_body_added_at_the_end_changes_no_line_of_another_in_any_script() {
    let added =
        "\n[body.added]\nshape.sphere.radius = \"uniform(0.1, 0.2)\"\nlocation = [0, 2, 0]\nfixed = true\n";
    for name in ["dominoes", "scattered_balls", "string_of_balls"] {
        let before = text(name);
        assert_only_more(&before, &format!("{before}{added}"));
    }
}

/// Checks that a second body with the same material does not change the line of the first.
#[test]
fn a_second_body_of_a_material_changes_no_line_of_the_first() {
    for (shape, material) in [
        ("sphere.radius = 1", "brass"),
        ("box.size = [1, 2, 3]", "brass"),
        ("compound.parts = [{ sphere.radius = 1 }, { sphere.radius = 1, location = [3, 0, 0] }]", "brass"),
        // A pattern belongs to its body, also if several bodies have the same material.
        ("sphere.radius = 1", "marble"),
        ("plane.normal = [0, 1, 0]", "brass"),
    ] {
        let body = |name| format!("[body.{name}]\nshape.{shape}\nmaterial = \"{material}\"\n");
        assert_only_more(&body("a"), &(body("a") + &body("b")));
        assert_only_more(&body("a"), &(body("a") + &body("b") + &body("c")));
    }
}

#[test]
fn the_ninth_body_of_the_palette_changes_no_line_of_the_first() {
    let bodies = |count: usize| -> String {
        let body = |n| format!("[body.b{n}]\nshape.sphere.radius = 0.4\nlocation = [{n}, 0, 0]\n");
        (0..count).map(body).collect()
    };
    assert_only_more(&bodies(8), &bodies(9));
    assert_only_more(&bodies(1), &bodies(9));
}

#[test]
fn more_copies_change_no_line_of_the_others() {
    let repeat = |count: usize| {
        format!("[body.b]\nrepeat = {count}\nshape.sphere.radius = 0.4\nlocation = [\"i\", 0, 0]\n")
    };
    for (before, after) in [(2, 3), (8, 9), (9, 30)] {
        assert_only_more(&repeat(before), &repeat(after));
    }
}

/// Checks the locations of ten thousand bodies with formulas. `benches/reading.rs` measures the time.
#[test]
fn ten_thousand_bodies_with_formulas_are_where_these_put_them() {
    let mut text = String::from("simulation.duration = 0\n[variables]\nr = 0.2\nspacing = 1.5\n");
    for n in 0..10_000 {
        let (row, column) = (n / 100, n % 100);
        write!(
            text,
            "\n[body.b{n}]\nshape.sphere.radius = \"r + 0.1*sin({n})\"\n\
             location = [\"spacing*{row}\", \"uniform(0, 1)\", \"spacing*{column}\"]\nmass = \"4/3*pi*r^3\"\n"
        )
        .unwrap();
    }
    assert!(text.len() > 1_000_000, "{}", text.len());
    let scene = Scene::parse(&text).unwrap();
    let run = Run::new(&scene).unwrap();
    let script = run.script(&run.frames().next().unwrap().unwrap()).unwrap();
    assert!(script.contains("// b9999\n"));
    let last = &scene.bodies[9_999].start;
    assert_eq!((last.location.x, last.location.z), (1.5 * 99.0, 1.5 * 99.0));
    assert!((last.mass - 4.0 / 3.0 * std::f64::consts::PI * 0.008).abs() < 1e-15);
}

/// Checks that scattered meshes do not overlap: their sizes are read from the file before their masses are known.
#[test]
fn scattered_meshes_do_not_overlap() {
    let folder = tempfile::tempdir().unwrap();
    let vertices = "v 5 5 5\nv 5 -5 -5\nv -5 5 -5\nv -5 -5 5\n";
    std::fs::write(
        folder.path().join("tetrahedron.obj"),
        format!("{vertices}f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n"),
    )
    .unwrap();
    let scene = "
        simulation.duration = 0
        [body.stone]
        shape.mesh.file = 'tetrahedron.obj'
        repeat.scatter = { count = 20, within.sphere.radius = 60 }
        ";
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let scene = jabuka::Scene::from_path(folder.path().join("scene.toml")).unwrap();
    let at: Vec<_> = scene.bodies.iter().map(|body| body.start.location).collect();
    for (i, a) in at.iter().enumerate() {
        for b in &at[..i] {
            assert!(a.distance(*b) >= 2.0 * 75f64.sqrt() * (1.0 - 1e-12), "{a} {b}");
        }
    }
}

#[test]
fn labels_know_copies_by_their_names() {
    let text = "
        [body.ball]
        repeat = 2
        shape.sphere.radius = 0.1
        location = ['7 + 2*i', 0, 0]
        [body.brick]
        repeat.grid.count = [2, 1, 2]
        repeat.grid.spacing = [1, 1, 1]
        shape.box.size = [0.1, 0.1, 0.1]
        [label.sum]
        text = 'a = ${ball[1].x}, b = ${ball[0].x + ball[1].x:.1}'
        [label.of_three_indices]
        text = 'c = ${brick[0,0,1].x:.3}'
        ";
    let wrong = Scene::parse(&text.replace("ball[0].x", "ball.x")).unwrap_err().to_string();
    assert!(wrong.contains("its copies are `ball[0]` to `ball[1]`"), "{wrong}");
    let script = &scripts(text)[0];
    assert!(script.contains("a = 9, b = 16.0") && script.contains("c = "), "{script}");
}

/// A scene with bobs that hang from hooks on rods, and rods between neighboring bobs.
const PENDULUMS: &str = r#"
        [variables]
        count = 4
        [body.hook]
        repeat = "count"
        shape.sphere.radius = 0.1
        location = ["i", 2, 0]
        fixed = true
        [body.bob]
        repeat = "count"
        shape.sphere.radius = 0.1
        location = ["i", "1 - i/10", 0]
        [joint.string.rod]
        between = ["hook[i]", "bob[i]"]
        [joint.chain.rod]
        between = ["bob[i]", { body = "bob[i+1]", at = [0, 0, 0] }]
"#;

/// Checks that an indexed name such as `hook[i]` in a joint or a force makes one for each copy: twenty pendulums need one body and one
/// joint, and so does a chain.
#[test]
fn ends_that_are_named_by_an_index_make_one_joint_or_force_for_each() {
    let scene = Scene::parse(
        &(PENDULUMS.to_owned()
            + r#"
        [joint.last.rod]
        between = ["hook[count-1]", [4, 3, 0]]
        [force.some]
        repeat = 3
        spring.between = [["i", 0, "2*i"], "bob[count-1-i]"]
        spring.stiffness = "1 + i"
        "#),
    );
    // Both ends of the last rod are fixed.
    let report = scene.unwrap_err().to_text(false);
    assert_eq!(report.matches("error").count(), 1, "{report}");
    assert!(report.contains("the joint `last` cannot hold anything"), "{report}");
}

#[test]
fn copies_of_joints_and_forces_have_names_and_numbers_of_their_own() {
    let text = PENDULUMS.to_owned()
        + r#"
        [force.some]
        repeat = 3
        spring.between = [["i", 0, 0], "bob[3-i]"]
        spring.stiffness = "1 + i"
        "#;
    let scene = Scene::parse(&text).unwrap();
    let names: Vec<&str> = scene.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(
        names,
        ["string[0]", "string[1]", "string[2]", "string[3]", "chain[0]", "chain[1]", "chain[2]"]
    );
    // Written one by one, they are the same joints and forces.
    let mut by_hand: String = text.split("[joint").next().unwrap().to_owned();
    for i in 0..4 {
        by_hand += &format!("[joint.\"string[{i}]\".rod]\nbetween = [\"hook[{i}]\", \"bob[{i}]\"]\n");
    }
    for i in 0..3 {
        by_hand += &format!("[joint.\"chain[{i}]\".rod]\nbetween = [\"bob[{i}]\", \"bob[{}]\"]\n", i + 1);
    }
    for i in 0..3 {
        by_hand += &format!(
            "[force.\"some[{i}]\".spring]\nbetween = [[{i}, 0, 0], \"bob[{}]\"]\nstiffness = {}\n",
            3 - i,
            1 + i
        );
    }
    let by_hand = Scene::parse(&by_hand).unwrap();
    assert_eq!(format!("{:?}", scene.joints), format!("{:?}", by_hand.joints));
    assert_eq!(format!("{:?}", scene.forces), format!("{:?}", by_hand.forces));
}

/// Checks that a gear train can be written as one repeated body, one repeated hinge and one repeated gear.
#[test]
fn gears_couple_copies_of_joints() {
    let train = |gears: &str| {
        Scene::parse(&format!(
            r#"
            [joint.mesh.gear]
            joints = {gears}
            ratio = -1
            [body.wheel]
            repeat = 4
            shape.cylinder = {{ radius = 0.5, height = 0.1 }}
            orientation = {{ axis = [1, 0, 0], angle = 90 }}
            location = ["i", 0, 0]
            [joint.axle.hinge]
            between = [["i", 0, 0], "wheel[i]"]
            axis = [0, 0, 1]
            "#
        ))
    };
    let names = |scene: Scene| -> Vec<String> {
        let joints = scene.joints.into_iter().map(|joint| joint.name);
        joints.filter(|name| name.starts_with("mesh")).collect()
    };
    let all = train(r#"["axle[i]", "axle[i+1]"]"#).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(names(all), ["mesh[0]", "mesh[1]", "mesh[2]"]);
    let one = train(r#"["axle[0]", "axle[2*1+1]"]"#).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(names(one), ["mesh"]);
    let wrong = train(r#"["axle", "axle[1]"]"#).unwrap_err().to_string();
    assert!(wrong.contains("its copies are `axle[0]` to `axle[3]`"), "{wrong}");
}
