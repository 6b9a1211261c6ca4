//! Tests the copies that `repeat` makes.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::physics::{Anchor, BodyId};
use crate::scene::{Body, ForceKind, Options, Override, Scene};

fn scene(text: &str) -> Scene {
    Scene::parse(text).unwrap_or_else(|report| panic!("{report}"))
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.bodies.iter().map(|body| &*body.name).collect()
}

fn body<'a>(scene: &'a Scene, name: &str) -> &'a Body {
    scene.bodies.iter().find(|body| *body.name == *name).unwrap_or_else(|| panic!("no {name}"))
}

fn locations(scene: &Scene) -> Vec<DVec3> {
    scene.bodies.iter().map(|body| body.start.location).collect()
}

#[test]
fn a_count_makes_copies_that_formulas_of_their_index_tell_apart() {
    for repeat in ["repeat = 3", "repeat.count = 3", "repeat.count = 'n'"] {
        let scene = scene(&format!(
            "[variables]\nn = 3\n[body.ball]\nshape.sphere.radius = '1 + i'\nlocation = ['2.5*i^2', 'n', 0]\n{repeat}\n"
        ));
        assert_eq!(names(&scene), ["ball[0]", "ball[1]", "ball[2]"]);
        assert_eq!(
            locations(&scene),
            [DVec3::new(0.0, 3.0, 0.0), DVec3::new(2.5, 3.0, 0.0), DVec3::new(10.0, 3.0, 0.0)]
        );
        assert_eq!(scene.bodies[2].shape, crate::physics::Shape::Sphere { radius: 3.0 });
    }
}

#[test]
fn a_grid_counts_by_i_j_and_k_and_starts_at_the_location() {
    let grid = |grid: &str| {
        scene(&format!(
            "[body.a]\nshape.sphere.radius = 1\nlocation = [10, 'j', 0]\nmass = '1 + 100*i + 10*j'\nrepeat.grid = {grid}\n"
        ))
    };
    let wall = grid("{ count = [2, 3], spacing = [2, 5] }");
    assert_eq!(names(&wall), ["a[0,0]", "a[0,1]", "a[0,2]", "a[1,0]", "a[1,1]", "a[1,2]"]);
    assert_eq!(body(&wall, "a[1,2]").start.location, DVec3::new(12.0, 12.0, 0.0));
    assert_eq!(body(&wall, "a[1,2]").start.mass, 121.0);
    let block = grid("{ count = [2, 2, 2], spacing = 3 }");
    assert_eq!(body(&block, "a[1,0,1]").start.location, DVec3::new(13.0, 0.0, 3.0));
    let plain = grid("{ count = [2, 2] }");
    assert_eq!(body(&plain, "a[1,1]").start.location, DVec3::new(10.0, 1.0, 0.0));
}

#[test]
fn copies_in_a_ring_are_turned_as_far_as_they_have_come_around() {
    let text = "[body.a]\nshape.box.size = [1, 2, 3]\nlocation = [0, 7, 0]\norientation = [0, 30, 0]\nrepeat.ring = ";
    let ring = scene(&format!("{text}{{ count = 4, radius = 2 }}"));
    let expected = [
        DVec3::new(2.0, 7.0, 0.0),
        DVec3::new(0.0, 7.0, -2.0),
        DVec3::new(-2.0, 7.0, 0.0),
        DVec3::new(0.0, 7.0, 2.0),
    ];
    for (n, (body, expected)) in ring.bodies.iter().zip(expected).enumerate() {
        assert!(body.start.location.distance(expected) < 1e-15, "{n}: {}", body.start.location);
        let angle = TAU * n as f64 / 4.0 + 30f64.to_radians();
        assert!(body.start.orientation.angle_between(DQuat::from_rotation_y(angle)) < 1e-7, "{n}");
    }
    let still = scene(&format!("{text}{{ count = 4, radius = 2, turned = false }}"));
    assert!(still.bodies.iter().all(|body| body.start.orientation == still.bodies[0].start.orientation));
    for (axis, first, second) in [
        ("[0, 0, 3]", DVec3::X, DVec3::Y),
        ("[1, 0, 0]", DVec3::Y, DVec3::Z),
        ("[0, -1, 0]", DVec3::X, DVec3::Z),
    ] {
        let ring = scene(&format!("{text}{{ count = 4, radius = 1, axis = {axis} }}"));
        let up = DVec3::Y * 7.0;
        assert!((ring.bodies[0].start.location - up).distance(first) < 1e-15, "{axis}");
        assert!((ring.bodies[1].start.location - up).distance(second) < 1e-15, "{axis}");
    }
}

#[test]
fn a_line_has_a_copy_at_either_end() {
    let line = |line: &str| {
        locations(&scene(&format!(
            "[body.a]\nshape.sphere.radius = 0.1\nlocation = [0, 1, 0]\nrepeat.line = {line}"
        )))
    };
    assert_eq!(
        line("{ count = 3, to = [4, 0, 0] }"),
        [DVec3::Y, DVec3::new(2.0, 1.0, 0.0), DVec3::new(4.0, 1.0, 0.0)]
    );
    assert_eq!(line("{ count = 2, from = [0, 0, 1], to = [0, 0, 3] }")[0], DVec3::new(0.0, 1.0, 1.0));
    assert_eq!(line("{ count = 1, from = [0, 0, 1], to = [0, 0, 3] }"), [DVec3::new(0.0, 1.0, 1.0)]);
}

#[test]
fn copies_along_a_curve_are_evenly_apart_whatever_its_pace() {
    // An arc of 2 rad on a circle of radius 3 m is 6 m long. The speed along the arc varies, because the angle is quadratic in `u`.
    let arc = scene(
        "[body.a]\nshape.sphere.radius = 0.1\n[body.a.repeat.curve]\ncount = 7\nat = ['3*cos(2*u^2)', 5, '-3*sin(2*u^2)']",
    );
    for (n, body) in arc.bodies.iter().enumerate() {
        let angle = n as f64 / 3.0;
        let expected = DVec3::new(3.0 * libm::cos(angle), 5.0, -3.0 * libm::sin(angle));
        // Each of the 4096 chords is shorter than its arc by the fraction angle² / 24.
        assert!(body.start.location.distance(expected) < 1e-6, "{n}");
        // The tangent of a circle is perpendicular to its radius.
        let tangent = DVec3::new(-libm::sin(angle), 0.0, -libm::cos(angle));
        assert!((body.start.orientation * DVec3::X).distance(tangent) < 1e-3, "{n}");
        assert!((body.start.orientation * DVec3::Y).distance(DVec3::Y) < 1e-12, "{n}");
    }
}

#[test]
fn a_closed_curve_has_no_copy_twice_at_its_beginning() {
    let points = "points = [[1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 0, -1]]";
    let text = |more: &str| {
        format!("[body.a]\nshape.sphere.radius = 0.1\nrepeat.curve = {{ count = 8, {points}, {more} }}")
    };
    let closed = locations(&scene(&text("closed = true")));
    let gaps: Vec<f64> = (0..8).map(|n| closed[n].distance(closed[(n + 1) % 8])).collect();
    assert!(gaps.iter().all(|gap| (gap - gaps[0]).abs() < 1e-6), "{gaps:?}");
    let open = locations(&scene(&text("turned = false")));
    assert!(open[0].distance(DVec3::X) < 1e-12 && open[7].distance(-DVec3::Z) < 1e-12);
}

#[test]
fn scattered_copies_do_not_overlap_and_stay_inside() {
    for (within, inside) in [
        (
            "box.size = [6, 4, 5]",
            &(|p: DVec3, r: f64| (p.abs() + r).cmple(DVec3::new(3.0, 2.0, 2.5)).all())
                as &dyn Fn(DVec3, f64) -> bool,
        ),
        ("sphere.radius = 3", &|p, r| p.length() + r <= 3.0),
        ("cylinder = { radius = 3, height = 4 }", &|p, r| {
            DVec3::new(p.x, 0.0, p.z).length() + r <= 3.0 && p.y.abs() + r <= 2.0
        }),
        ("box.size = [20, 0, 20]", &|p, r| p.y == 0.0 && p.x.abs() + r <= 10.0),
    ] {
        let scene = scene(&format!(
            "[body.a]\nshape.sphere.radius = 'uniform(0.1, 0.4)'\nlocation = [0, 9, 0]\n\
             repeat.scatter = {{ count = 200, gap = 0.01, within.{within} }}"
        ));
        let balls: Vec<_> = scene
            .bodies
            .iter()
            .map(|b| (b.start.location - 9.0 * DVec3::Y, b.shape.bounding_radius().unwrap()))
            .collect();
        for (n, (place, radius)) in balls.iter().enumerate() {
            assert!(inside(*place, radius - 1e-12), "{within}: {place}");
            for (other, size) in &balls[..n] {
                assert!(place.distance(*other) > radius + size + 0.01 - 1e-12, "{within}: {n}");
            }
        }
        // The copies are spread over the whole volume: about a quarter of the 200 copies is in each quarter of the volume.
        let quarter = balls.iter().filter(|(place, _)| place.x > 0.0 && place.z > 0.0).count();
        assert!((30..=70).contains(&quarter), "{within}: {quarter}");
    }
}

#[test]
fn what_is_scattered_may_be_turned_any_way() {
    let text = "[body.a]\nshape.box.size = [1, 1, 1]\nrepeat.scatter = { count = 100, turned = true, within.sphere.radius = 9 }";
    let mean: DVec3 =
        scene(text).bodies.iter().map(|body| body.start.orientation * DVec3::Y).sum::<DVec3>() / 100.0;
    // Each component of the mean has a standard deviation of √(1/3) / √100 = 0.058.
    assert!(mean.abs().max_element() < 4.0 * 0.058, "{mean}");
}

#[test]
fn neither_another_copy_nor_another_body_changes_random_numbers() {
    let text = |count: usize, more: &str| {
        format!(
            "{more}[body.a]\nshape.sphere.radius = 'uniform(0.1, 0.2)'\nvelocity = ['normal(0, 1)', 'i*uniform(0, 1)', 0]\n\
             repeat.scatter = {{ count = {count}, turned = true, within.sphere.radius = 9 }}\n"
        )
    };
    let few = scene(&text(50, ""));
    let many =
        scene(&text(80, "[body.other]\nshape.sphere.radius = 'uniform(1, 2)'\nlocation = [20, 0, 0]\n"));
    assert_eq!(few.bodies.len(), 50);
    for one in &few.bodies {
        let other = body(&many, &one.name);
        assert_eq!((&one.start, &one.shape), (&other.start, &other.shape), "{}", one.name);
    }
    let velocities: std::collections::HashSet<u64> =
        few.bodies.iter().map(|b| b.start.velocity.x.to_bits()).collect();
    assert_eq!(velocities.len(), 50, "every copy has numbers of its own");
    let seeded = scene(&format!("seed = 1\n{}", text(50, "")));
    assert_ne!(seeded.bodies[0].start.location, few.bodies[0].start.location);
}

#[test]
fn forces_name_one_copy_or_many() {
    let scene = scene(
        "[body.ball]\nshape.sphere.radius = 0.1\nrepeat.line = { count = 4, to = [3, 0, 0] }\n\
         [body.brick]\nshape.sphere.radius = 0.1\nlocation = [0, 5, 0]\nrepeat.grid = { count = [2, 3], spacing = 1 }\n\
         [force.all.drag]\nlinear = 1\non = ['ball']\n\
         [force.some.drag]\nlinear = 1\non = ['ball[2]', 'brick[*,1]', 'brick[1,2]']\n\
         [force.chain.spring]\nbetween = [[-1, 0, 0], 'ball']\nstiffness = 1\n\
         [force.points.spring]\nbetween = [[-1, 0, 0], { body = 'ball', at = [0, 0.1, 0] }, 'ball[1]']\nstiffness = 1\n",
    );
    let on = |force: usize| match &scene.forces[force].kind {
        ForceKind::OnEach(drag) => {
            drag.bodies().iter().map(|body| &*scene.bodies[body.index()].name).collect::<Vec<_>>()
        }
        _ => panic!("not a drag"),
    };
    assert_eq!(on(0), ["ball[0]", "ball[1]", "ball[2]", "ball[3]"]);
    assert_eq!(on(1), ["ball[2]", "brick[0,1]", "brick[1,1]", "brick[1,2]"]);
    let ForceKind::Spring { links, .. } = &scene.forces[2].kind else { panic!("not a spring") };
    assert_eq!(links.len(), 4);
    assert_eq!(links[0].between, [Anchor::Point(-DVec3::X), Anchor::centre(BodyId::new(0))]);
    assert_eq!(links[3].between, [2, 3].map(|i| Anchor::centre(BodyId::new(i))));
    let ForceKind::Spring { links, .. } = &scene.forces[3].kind else { panic!("not a spring") };
    assert_eq!(links.len(), 5);
    assert_eq!(links[3].between, [2, 3].map(|i| Anchor::Body { id: BodyId::new(i), at: 0.1 * DVec3::Y }));
}

#[test]
fn copies_and_bodies_get_the_colors_of_the_palette_in_the_order_of_the_file() {
    let material = |text: &str, name: &str| {
        let scene = scene(text);
        scene.materials[body(&scene, name).material.unwrap()].name.clone()
    };
    let text = |count: usize| {
        format!(
            "[body.a]\nshape.sphere.radius = 1\nlocation = ['3*i', 0, 0]\nrepeat = {count}\n[body.b]\nshape.sphere.radius = 1\nlocation = [0, 5, 0]"
        )
    };
    assert_eq!(material(&text(3), "a[0]"), "palette red");
    assert_eq!(material(&text(3), "a[2]"), "palette amber");
    assert_eq!(material(&text(3), "b"), "palette teal");
    assert_eq!(material(&text(8), "b"), "palette red");
}

#[test]
fn copies_share_a_material_of_their_own_where_they_look_the_same() {
    let scene = scene(
        "[body.a]\nshape.sphere.radius = 1\nlocation = ['3*i', 0, 0]\nmaterial.color = ['(i % 2)/2', 0, 0]\nrepeat = 100\n",
    );
    assert_eq!(scene.materials.len(), 2);
    assert_ne!(scene.bodies[0].material, scene.bodies[1].material);
    assert_eq!(scene.bodies[0].material, scene.bodies[98].material);
}

#[test]
fn a_count_can_be_set_from_outside() {
    let text =
        "[variables]\nn = 2\n[body.a]\nshape.sphere.radius = 1\nlocation = ['3*i', 0, 0]\nrepeat = 'n'\n";
    for (set, expected) in [("variables.n=5", 5), ("body.a.repeat=7", 7)] {
        let options = Options { overrides: vec![Override::new(set)], ..Options::default() };
        assert_eq!(Scene::parse_with(text, &options).unwrap().bodies.len(), expected, "{set}");
    }
}
