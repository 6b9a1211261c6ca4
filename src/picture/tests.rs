//! Tests of whole pictures: sizes must fit the view of the camera, and texts must stay inside the picture.

use glam::DVec3;

use super::{Form, FramedPart, Plan, Text, Thing};
use crate::scene::{ArrowOwner, Corner, Options, Override, PlotPlace, Preset, Scene};
use crate::simulate::{Frame, Frames, survey};

fn plan(text: &str) -> (Scene, Plan) {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    (scene, plan)
}

/// A ball flies 600 m, and the camera follows it.
fn flight(keys: &str) -> (Scene, Plan) {
    plan(&format!(
        "simulation = {{ duration = 10, gravity = [0, -9.81, 0] }}
        [body.ball]\nshape.sphere.radius = 0.1\nvelocity = [60, 49, 0]
        trail = true\narrows.velocity = true\n{keys}
        [camera]\nfollow = {{ body = 'ball' }}\n[grid]\nplane = 'wall'"
    ))
}

fn frames(scene: &Scene) -> impl Iterator<Item = Frame> {
    Frames::new(scene).map(Result::unwrap)
}

#[test]
fn a_camera_that_follows_sees_arrows_trails_and_grids_in_its_own_size() {
    let (scene, plan) = flight("arrows.force.scale = 0.002");
    for frame in frames(&scene).skip(1).step_by(25) {
        let [velocity, force] = plan.arrows(&frame)[..] else { panic!("two are asked for") };
        assert!(velocity.radius < 0.02 && velocity.from.distance(velocity.to) < 0.22, "{velocity:?}");
        // An arrow with a given scale has the length that the scene gives, however short.
        assert!(force.from.distance(force.to) < 0.1, "{force:?}");
        let stroke = plan.stroke(&frame);
        assert!(stroke < 0.01, "{stroke}");
        assert!(plan.trails(&frame).iter().all(|trail| (trail.radius - stroke / 2.0).abs() < 1e-15));
        let grid = plan.grid(&frame).unwrap();
        assert!((6..40).contains(&grid.lines().len()), "{}", grid.lines().len());
        assert!(grid.lines().iter().all(|line| line.from.distance(frame.bodies[0].location) < 3.0));
    }
    assert_eq!(plan.too_small(), None);
    assert!((0.02..0.3).contains(&plan.stage().tile), "{}", plan.stage().tile);
}

#[test]
fn a_camera_that_stands_still_sees_one_size_and_the_tips_of_all_arrows() {
    let text = "simulation = { duration = 2, gravity = [0, -9.81, 0] }
        [body.ball]\nshape.sphere.radius = 0.2\nvelocity = [3, 9.81, 0]
        arrows = { velocity = true, force = true }\n[label.x]\ntext = 'x'";
    let (scene, plan) = plan(text);
    let first = plan.arrows(&frames(&scene).next().unwrap());
    for frame in frames(&scene) {
        let arrows = plan.arrows(&frame);
        assert_eq!(arrows.iter().map(|arrow| arrow.radius).collect::<Vec<_>>(), [first[0].radius; 2]);
        for arrow in arrows {
            let spot = plan.screen(&frame).unwrap().project(arrow.to).unwrap();
            assert!(spot.x.abs() < 0.95 && spot.y.abs() < 0.95 * 9.0 / 16.0, "{spot:?}");
        }
    }
    let longest = first[0].from.distance(first[0].to);
    let view = plan.stage().size;
    assert!((0.05..0.35).contains(&(longest / view)), "{longest} of {view}");
}

/// Two lines in a corner take a sixth of the height. The ball, which goes up and down, stays out of it.
#[test]
fn the_camera_leaves_room_for_labels_in_corners() {
    for (corner, is_top) in [("top-left", true), ("bottom-right", false)] {
        let (scene, plan) = plan(&format!(
            "simulation = {{ duration = 2, gravity = [0, -9.81, 0] }}
            [body.ball]\nshape.sphere.radius = 0.2\nvelocity = [1, 9.81, 0]
            [label.first]\ntext = 'one line'\ncorner = '{corner}'
            [label.second]\ntext = 'another line'\ncorner = '{corner}'"
        ));
        let aspect = 9.0 / 16.0;
        for frame in frames(&scene) {
            let ball = frame.bodies[0].location;
            let reached = plan.screen(&frame).unwrap();
            let reached = [-0.2, 0.2].map(|off| reached.project(ball + DVec3::Y * off).unwrap().y);
            for text in plan.texts(&frame) {
                let base = text.y.above_middle(aspect);
                let is_clear = match is_top {
                    true => reached[1] < base - 0.25 * text.height,
                    false => reached[0] > base + 0.75 * text.height,
                };
                assert!(is_clear, "{corner}: {reached:?} and {} at {base}, t = {}", text.says, frame.time);
            }
        }
    }
}

/// A thread is drawn a pixel and a half wide, since POV-Ray breaks thinner lines into dots. A thick rod keeps its own radius.
#[test]
fn no_line_of_a_joint_is_thinner_than_a_pixel_and_a_half() {
    for (joint, thick) in [("rope", false), ("rod", false), ("rod", true)] {
        let radius = if thick { 0.05 } else { 1e-4 };
        let (scene, plan) = plan(&format!(
            "simulation = {{ duration = 1, gravity = [0, -9.81, 0] }}
            [body.bob]\nshape.sphere.radius = 0.1\nlocation = [1, 0, 0]
            [joint.thread.{joint}]\nbetween = [[0, 0, 0], 'bob']\nlook.radius = {radius}"
        ));
        let frame = frames(&scene).next().unwrap();
        let drawn = plan.links(&frame).into_iter().filter_map(|thing| match thing.form {
            Form::Rod { radius, .. } | Form::Rope { radius, .. } => Some(radius),
            _ => None,
        });
        let drawn = drawn.fold(0.0, f64::max);
        // A clearly visible line is four pixels of 1280 wide.
        let least = 0.5 * 1.5 * plan.stroke(&frame) / (0.0031 * 1280.0);
        let expected = if thick { radius } else { least };
        assert!((drawn / expected - 1.0).abs() < 1e-9, "{joint}: {drawn} instead of {expected}");
    }
}

/// A ball falls 490 m.
fn fall(keys: &str) -> (Scene, Plan) {
    plan(&format!("simulation.gravity = [0, -9.81, 0]\n[body.ball]\nshape.sphere.radius = 0.1\n{keys}"))
}

/// A camera that cannot go along with a fall, since nothing would show that there is motion, or since it moves otherwise, frames its start.
#[test]
fn where_all_of_a_fall_would_leave_a_dot_the_camera_frames_its_start() {
    let (_, start) = fall("[camera]\norbit.period = 9");
    let FramedPart::Start(end) = start.part() else { panic!("{:?}", start.part()) };
    assert!((0.5..2.0).contains(&end), "{end}");
    assert!(start.too_small().is_some_and(|largest| largest.name == "ball" && largest.pixels_in_whole < 1.0));
    assert!(start.too_small().unwrap().pixels > 8.0);
    // The fall continues after the framed start, so the ground is below the whole run.
    assert!(start.stage().ground.unwrap().height < -490.0);
    for keys in [
        "trail = true",
        "look.scale = 200",
        "[camera]\nauto = 'whole'",
        "[camera]\nlocation = [0, 0, 900]",
        "[camera]\nfollow.body = 'ball'",
    ] {
        assert_eq!(fall(keys).1.part(), FramedPart::Whole, "{keys}");
    }
    for keys in ["[environment]\npreset = 'space'", "[output]\ntransparent = true"] {
        assert!(matches!(fall(keys).1.part(), FramedPart::Start(_)), "{keys}");
    }
}

#[test]
fn the_camera_goes_along_where_all_of_a_motion_would_leave_dots() {
    for keys in [
        "",
        "[camera]\nprojection = 'orthographic'",
        "[body.other]\nshape.sphere.radius = 0.05\nlocation = [1, 0, 0]\nvelocity = [2, 3, 0]",
        "velocity = [0, 40, 30]",
        "[plot.height]\ny = 'ball.y'\nside = 'right'",
        "[camera]\nauto = 'track'",
    ] {
        let (scene, along) = fall(keys);
        assert_eq!(along.part(), FramedPart::Along, "{keys}");
        let mut before = None;
        for frame in frames(&scene) {
            let camera = along.camera(&frame);
            let screen = camera.screen();
            for body in &frame.bodies {
                let point = screen.project(body.location).unwrap();
                let free = if keys.contains("plot") { -0.9..0.4 } else { -0.9..0.9 };
                assert!(free.contains(&point.x) && point.y.abs() < 0.9 * 9.0 / 16.0, "{keys}: {point:?}");
                assert!(2.0 * 0.1 * point.scale / 2.0 > 0.002, "{keys}: {point:?}");
            }
            // Smooth: the aim changes its velocity only slowly, relative to the view.
            let view = camera.width_at(camera.location().distance(camera.look_at()));
            if let Some((aim, step)) = before.replace((camera.look_at(), DVec3::ZERO)) {
                let now = camera.look_at() - aim;
                before = Some((camera.look_at(), now));
                assert!(
                    step == DVec3::ZERO || now.distance(step) < 0.02 * view,
                    "{keys}: {step} {now} {view}"
                );
            }
            assert!(along.stage().ground.is_none_or(|ground| camera.location().y > ground.height));
        }
    }
    // The camera does not go along with a ball between two posts: the posts would leave the picture.
    let posts = [-60, 60].map(|x| {
        format!("[body.post{x}]\nshape.sphere.radius = 0.1\nlocation = [{x}, 0, 0]\nfixed = true\n")
    });
    let (_, between) =
        plan(&format!("[body.ball]\nshape.sphere.radius = 0.1\nvelocity = [2, 0, 0]\n{}", posts.concat()));
    assert_ne!(between.part(), FramedPart::Along);
    // The path of a throw fills the picture, and ghosts show where the ball was.
    let part = |keys: &str| {
        let simulation = "simulation = { duration = 4.5, gravity = [0, -9.81, 0] }";
        let ball = "[body.ball]\nshape.sphere.radius = 0.5\nlocation = [0, 100, 0]";
        plan(&format!("{simulation}\n{ball}\n{keys}")).1.part()
    };
    assert_eq!(part(""), FramedPart::Along);
    assert_eq!(part("ghosts.every = 0.5"), FramedPart::Whole);
}

/// A body in straight motion stays in the middle of the picture, at the same size, from the first frame to the last. This does not depend on
/// its place, on the unit of length, or on the number of frames: long runs have several frames in a stretch of their course.
#[test]
fn a_camera_along_a_straight_motion_keeps_the_body_in_the_middle() {
    for (unit, rate) in [(1.0, 25), (1e-6, 25), (1e6, 25), (1.0, 130)] {
        let lengths = [20.0, 3.0, 1.0].map(|length| length * unit);
        let [speed, aside, radius] = lengths;
        let (scene, plan) = plan(&format!(
            "simulation.frame_rate = {rate}\n[body.car]\nshape.sphere.radius = {radius:e}\nlocation = [{aside:e}, {aside:e}, 0]\nvelocity = [{speed:e}, {aside:e}, 0]"
        ));
        assert_eq!(plan.part(), FramedPart::Along);
        let mut views = Vec::new();
        for frame in frames(&scene) {
            let camera = plan.camera(&frame);
            let away = camera.look_at().distance(frame.bodies[0].location);
            assert!(away < 1e-9 * 200.0 * unit, "{away} at {} s", frame.time);
            views.push(camera.location().distance(camera.look_at()) / unit);
        }
        assert!(views.iter().all(|view| (view / views[0] - 1.0).abs() < 1e-9), "{views:?}");
    }
}

/// A floor of 20 m is shown in part around a ball that falls by 2 m; a ramp that is not much larger than the motion is shown whole.
#[test]
fn a_fixed_body_that_is_much_larger_than_the_motion_is_shown_in_part() {
    let drawn = |floor: [f64; 3]| {
        let (scene, plan) = plan(&format!(
            "simulation = {{ duration = 0.6, gravity = [0, -9.81, 0] }}\n[environment]\nground = false\n\
             [body.floor]\nshape.box.size = {floor:?}\nfixed = true\n\
             [body.ball]\nshape.sphere.radius = 0.25\nlocation = [0, 3, 0]"
        ));
        let frame = frames(&scene).next().unwrap();
        let camera = plan.camera(&frame);
        let ball = camera.screen().project(DVec3::new(0.0, 3.0, 0.0)).unwrap();
        let left = camera.screen().project(DVec3::new(-floor[0] / 2.0, 0.0, 0.0)).unwrap();
        assert_eq!(plan.part(), FramedPart::Whole);
        (0.25 * ball.scale, left.x)
    };
    let (ball, left) = drawn([20.0, 0.5, 20.0]);
    assert!(ball > 0.06 && left < -1.0, "{ball} {left}");
    let (ball, left) = drawn([4.0, 0.5, 2.0]);
    assert!(ball > 0.06 && left > -1.0, "{ball} {left}");
    // A post beside the ball is something to see, however large it is.
    let text = "[body.ball]\nshape.sphere.radius = 0.1\n[body.post]\nshape.box.size = [1, 4, 1]\nlocation = [3, 2, 0]\nfixed = true";
    let (scene, plan) = plan(text);
    let frame = frames(&scene).next().unwrap();
    let top = plan.camera(&frame).screen().project(DVec3::new(3.5, 4.0, 0.0)).unwrap();
    assert!(top.x < 1.0 && top.y < 9.0 / 16.0, "{top:?}");
}

/// The left, right, bottom and top of a text in the image plane.
fn extent(text: &Text<'_>) -> [f64; 4] {
    let wide = super::text::width(&text.says, text.height);
    let left = text.x - text.align * wide;
    let base = text.y.above_middle(9.0 / 16.0);
    [left, left + wide, base - 0.2 * text.height, base + 0.7 * text.height]
}

fn assert_legible(texts: &[Text<'_>], what: &str) {
    for (number, text) in texts.iter().enumerate() {
        let [left, right, bottom, top] = extent(text);
        assert!(left > -1.0 && right < 1.0 && bottom > -0.5625 && top < 0.5625, "{what}: {text:?}");
        for other in &texts[..number] {
            let [l, r, b, t] = extent(other);
            let apart = right <= l || r <= left || top <= b || t <= bottom;
            assert!(apart, "{what}: {text:?} lies on {other:?}");
        }
    }
}

#[test]
fn texts_neither_overlap_nor_leave_the_picture() {
    let text = "simulation = { duration = 3, gravity = [0, -9.81, 0] }
        [body.left]\nshape.sphere.radius = 0.3\nlocation = [-1, 0, 0]\nvelocity = [0, 9, 0]\narrows.velocity = true
        [body.right]\nshape.sphere.radius = 0.3\nlocation = [1, 0, 0]\nvelocity = [0, 9, 0]
        [label.head]\ncorner = 'top'\ntext = 'Two balls are thrown upward with the same velocity of 9 m/s, one beside the other, and fall again'
        [label.clock]\ntext = 't = ${t:.2} s'
        [label.energy]\ncorner = 'top-right'\ntext = 'E = ${energy:.2} J'
        [label.l]\nbody = 'left'\ntext = 'the left ball is at y = ${left.y:.2} m'
        [label.r]\nbody = 'right'\ntext = 'the right ball is at y = ${right.y:.2} m'
        [label.foot]\ncorner = 'bottom-left'\ntext = 'no air'
        [grid]\nplane = 'wall'\n[scale_bar]";
    for size in ["[1280, 720]", "[640, 360]", "[320, 180]"] {
        let overrides = vec![Override::new(format!("output.size={size}"))];
        let scene = Scene::parse_with(text, &Options { overrides, ..Options::default() }).unwrap();
        let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
        for frame in frames(&scene).step_by(15) {
            let texts = plan.texts(&frame);
            assert!(
                texts.iter().any(|text| text.says == "x (m)")
                    && texts.iter().any(|text| text.says == "y (m)")
            );
            assert_legible(&texts, size);
            let labels: Vec<_> = texts.into_iter().filter(|text| text.name != "grid").collect();
            assert_eq!(labels.len(), 7);
            let least = 10.9 * 2.0 / f64::from(scene.output.width);
            assert!(labels.iter().all(|label| label.height > least || label.name == "head"), "{size}");
        }
    }
}

/// Letters follow the shorter side: an upright picture has those of a wide one, of which it shows less.
#[test]
fn letters_are_as_large_in_upright_pictures_as_in_wide_ones() {
    let pixels = |width: u32, height: u32| {
        let (scene, plan) = plan(&format!(
            "[body.a]\nshape.sphere.radius = 1\n[label.a]\nbody = 'a'\ntext = 'A'\n[output]\nsize = [{width}, {height}]"
        ));
        let frame = frames(&scene).next().unwrap();
        plan.texts(&frame)[0].height * f64::from(width)
    };
    let [wide, upright] = [pixels(960, 540), pixels(540, 960)];
    assert!((wide - upright).abs() < 1e-9, "{wide} {upright}");
}

/// Bodies that attract each other are in space, unless the scene says otherwise.
#[test]
fn what_attracts_each_other_is_in_space() {
    let preset = |keys: &str| {
        let (scene, _) = plan(&format!(
            "{keys}\n[body.sun]\nshape.sphere.radius = 1\nlocation = [0, 9, 0]\nmass = 1e10
            [body.planet]\nshape.sphere.radius = 0.1\nlocation = [5, 9, 0]\nvelocity = [0, 0, 0.3]"
        ));
        scene.environment.preset
    };
    let pull = "force.pull.gravitation = {}\n";
    assert_eq!(preset(pull), Preset::Space);
    for keys in [
        "",
        &format!("{pull}environment.ground = true"),
        &format!("{pull}simulation.gravity = [0, -9.81, 0]"),
        &format!("{pull}simulation.contacts = 'event-driven'"),
    ] {
        assert_eq!(preset(keys), Preset::Daylight, "{keys}");
    }
}

/// A plot without a place stands beside the bodies, if the camera is free to leave it room there.
#[test]
fn a_plot_without_a_place_stands_beside_the_bodies() {
    let place = |keys: &str| {
        let (scene, _) = plan(&format!(
            "simulation.duration = 1\n[body.a]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]
            [plot.p]\ny = 'a.x'\n{keys}"
        ));
        scene.plots[0].place
    };
    assert_eq!(place(""), PlotPlace::Right);
    let in_a_corner = PlotPlace::Corner(Corner::TopRight);
    let camera = "[camera]\nlocation = [0, 0, -9]\nlook_at = [0, 0, 0]";
    for keys in [camera, "[output]\nsize = [540, 960]", "[plot.q]\ny = 'a.y'\ncorner = 'bottom-left'"] {
        assert_eq!(place(keys), in_a_corner, "{keys}");
    }
}

#[test]
fn a_grid_that_a_moving_camera_sees_fills_the_picture_and_has_its_numbers_at_the_edges() {
    // The flight is 600 m long. In its middle, the grid extends to all edges of the picture.
    let (scene, plan) = flight("");
    let frame = Frames::at(&scene, 3.0).unwrap();
    let screen = plan.screen(&frame).unwrap();
    let lines = plan.grid(&frame).unwrap().lines().to_vec();
    for line in &lines {
        let [from, to] = [line.from, line.to].map(|end| screen.project(end).unwrap());
        let leaves = |spot: crate::picture::ScreenPoint| spot.x.abs() > 1.0 || spot.y.abs() > 0.5625;
        assert!(leaves(from) && leaves(to), "{line:?}");
    }
    let numbers: Vec<_> = plan.texts(&frame).into_iter().filter(|text| text.name == "grid").collect();
    let is_low = |text: &&Text<'_>| text.y.above_middle(0.5625) < -0.5;
    let is_left = |text: &&Text<'_>| extent(text)[0] < -0.95;
    assert!(numbers.iter().filter(is_low).count() >= 5, "{numbers:?}");
    assert!(numbers.iter().filter(is_left).count() >= 3, "{numbers:?}");
    assert!(numbers.iter().all(|text| is_low(&text) || is_left(&text)), "{numbers:?}");
    assert_legible(&numbers, "the grid");
    // Even a grid with distant lines has a number in every picture.
    let coarse = "simulation = { duration = 4.5, gravity = [0, -9.81, 0] }
        [body.ball]\nshape.sphere.radius = 0.5\nlocation = [0, 100, 0]
        [camera]\nfollow = { body = 'ball', distance = 25 }\n[grid]\nplane = 'wall'\nspacing = 10";
    let (scene, plan) = self::plan(coarse);
    for frame in frames(&scene).step_by(10) {
        let texts = plan.texts(&frame);
        assert_legible(&texts, "a coarse grid");
        let is_number = |text: &Text<'_>| text.says.parse::<f64>().is_ok();
        assert!(texts.iter().any(is_number), "{texts:?}");
        assert!(
            texts.iter().any(|text| text.says == "x (m)") && texts.iter().any(|text| text.says == "y (m)")
        );
    }
}

#[test]
fn an_upright_grid_ends_at_the_ground_and_one_on_the_ground_lies_on_the_edges_of_tiles() {
    let ball = "[simulation]\nduration = 2\n[body.ball]\nshape.sphere.radius = 0.5\nlocation = [0, -0.3, 0]\nvelocity = [5, 1, 0]\n";
    let (scene, wall) = plan(&format!("{ball}[grid]\nplane = 'wall'\nspacing = 2"));
    let ground = wall.stage().ground.unwrap().height;
    let lines = wall.grid(&frames(&scene).next().unwrap()).unwrap().lines().to_vec();
    let lowest = lines.iter().map(|line| line.from.y.min(line.to.y)).fold(f64::MAX, f64::min);
    assert_eq!(lowest, ground);
    let (_, floor) = plan(&format!("{ball}[grid]\nspacing = 2"));
    assert_eq!(floor.stage().ground.unwrap().tile, 2.0);
    // A spacing that is unsuitable for tiles leaves the tiles unchanged.
    let (_, fine) = plan(&format!("{ball}[grid]\nspacing = 0.02"));
    assert!(fine.stage().ground.unwrap().tile >= 0.5);
}

/// A grid in a coordinate plane lies in it, although the motion does not, and the camera faces it. Its axes have their names.
#[test]
fn a_coordinate_plane_passes_through_the_origin() {
    let ball = "[environment]\nground = false\n[body.ball]\nshape.sphere.radius = 0.5\nlocation = [3, 2, 4]\nvelocity = [5, 4, 3]\n";
    for (name, normal, titles) in [
        ("xy", DVec3::Z, ["x (m)", "y (m)"]),
        ("xz", DVec3::Y, ["x (m)", "z (m)"]),
        ("yz", DVec3::X, ["z (m)", "y (m)"]),
    ] {
        let (scene, plan) = plan(&format!("{ball}[grid]\nplane = '{name}'"));
        let frame = frames(&scene).next().unwrap();
        let lines = plan.grid(&frame).unwrap().lines().to_vec();
        assert!(lines.len() > 6 && lines.iter().all(|line| line.from.dot(normal) == 0.0), "{lines:?}");
        let texts = plan.texts(&frame);
        for title in titles {
            assert!(texts.iter().any(|text| text.says == title), "{name}: {title} is not in {texts:?}");
        }
        let view = (plan.placed().location() - plan.placed().look_at()).normalize();
        assert!(view.dot(normal).abs() > 0.25, "{name}: {view}");
    }
}

#[test]
fn a_grid_reaches_as_far_as_the_springs() {
    let text = "[body.bob]\nshape.sphere.radius = 0.1\nlocation = [1, 0, 0]\n[grid]\nplane = 'wall'\n\
        [force.rod.spring]\nbetween = [[0, 2, 0], 'bob']\nstiffness = 100";
    let (scene, plan) = plan(text);
    let lines = plan.grid(&frames(&scene).next().unwrap()).unwrap().lines().to_vec();
    assert!(
        lines.iter().any(|line| line.to.y >= 2.0) && lines.iter().any(|line| line.to.x <= 0.0),
        "{lines:?}"
    );
}

#[test]
fn a_label_stands_where_no_arrow_crosses_it() {
    let text = "simulation = { duration = 2, gravity = [0, -9.81, 0] }
        [body.ball]\nshape.sphere.radius = 0.2\nvelocity = [0, 9.81, 0]\narrows.velocity = true
        [label.name]\nbody = 'ball'\ntext = 'the ball'";
    let (scene, plan) = plan(text);
    let side = |time: f64| {
        let frame = Frames::at(&scene, time).unwrap();
        let ball = plan.screen(&frame).unwrap().project(frame.bodies[0].location).unwrap();
        plan.texts(&frame)[0].y.above_middle(9.0 / 16.0) - ball.y
    };
    assert!(side(0.2) < 0.0, "below the ball, whose arrow points up");
    assert!(side(1.8) > 0.0, "above the ball, whose arrow points down");
}

#[test]
fn a_label_stands_beside_other_bodies_and_the_names_of_axes_beside_coils() {
    let text = "[body.ball]\nshape.sphere.radius = 0.5
        [body.other]\nshape.sphere.radius = 0.5\nlocation = [0, 1.05, 0]
        [body.third]\nshape.sphere.radius = 0.5\nlocation = [1.3, 0, 0]
        [label.name]\nbody = 'ball'\ntext = 'ball'\n[camera]\nlocation = [0, 0, 9]\nlook_at = [0, 0, 0]";
    let place = |text: &str| {
        let (scene, plan) = plan(text);
        let frame = frames(&scene).next().unwrap();
        let [ref label] = plan.texts(&frame)[..] else { panic!("there is one") };
        let at = label.y.above_middle(9.0 / 16.0);
        (label.x, at)
    };
    assert!(place(text).1 < 0.0, "below the ball, above which is the other");
    // If a body fills the picture, no position is free of bodies, so the label stays at its usual position.
    let wall = "\n[body.wall]\nshape.box.size = [50, 50, 1]\nlocation = [0, 0, -2]";
    assert!(place(&format!("{text}{wall}")).1 > 0.0);

    let spring = "[body.bob]\nshape.sphere.radius = 0.1\nlocation = [1, 0, 0]\n[grid]\nspacing = 0.4\n
        [force.rod.spring]\nbetween = [[-1.5, 0, -0.4], 'bob']\nstiffness = 100\ncoil.radius = 0.13";
    let (scene, with) = plan(spring);
    let frame = frames(&scene).next().unwrap();
    let screen = with.screen(&frame).unwrap();
    for [begin, end] in
        with.links(&frame).iter().flat_map(|link| link.form.middle_lines().collect::<Vec<_>>())
    {
        for part in 0..=40 {
            let spot = screen.project(begin.lerp(end, f64::from(part) / 40.0)).unwrap();
            for text in with.texts(&frame) {
                let [left, right, bottom, top] = extent(&text);
                let is_on = left < spot.x && spot.x < right && bottom < spot.y && spot.y < top;
                assert!(!is_on, "{text:?}");
            }
        }
    }
    assert_eq!(with.texts(&frame).iter().filter(|text| text.says.contains("(m)")).count(), 2);
}

#[test]
fn a_grid_of_too_many_lines_is_drawn_coarser_and_lines_are_as_thick_as_pixels() {
    let grid =
        |keys: &str| plan(&format!("[body.ball]\nshape.sphere.radius = 1\nvelocity = [10, 0, 0]\n{keys}"));
    let (scene, fine) = grid("[grid]\nspacing = 0.001");
    let (given, drawn) = fine.too_fine_grid().unwrap();
    assert!(given == 0.001 && (0.2..=0.5).contains(&drawn), "{drawn}");
    let frame = frames(&scene).next().unwrap();
    assert!((100..1000).contains(&fine.grid(&frame).unwrap().lines().len()));
    let (scene, small) = grid("[grid]\n[output]\nsize = [320, 180]");
    assert_eq!(small.too_fine_grid(), None);
    let frame = frames(&scene).next().unwrap();
    let placed = small.placed();
    let pixel = placed.width_of_view(small.stage().whole) / 320.0;
    let lines = small.grid(&frame).unwrap().lines().to_vec();
    assert!(lines.iter().all(|line| line.radius >= 0.59 * pixel), "{pixel} {}", lines[0].radius);
}

#[test]
fn a_camera_nearby_sees_small_tiles_though_the_motion_is_long() {
    let (_, plan) = plan(
        "[body.ball]\nshape.sphere.radius = 0.1\nvelocity = [100, 0, 0]\n[camera]\nlocation = [0, 1, 5]\nlook_at = [0, 0, 0]",
    );
    assert!((0.1..=0.5).contains(&plan.stage().tile), "{}", plan.stage().tile);
    assert_eq!(plan.placed().location(), DVec3::new(0.0, 1.0, 5.0));
}

/// On a body that is drawn twice as large, attachment points are twice as far from the center.
#[test]
fn a_coil_stands_between_the_points_that_its_spring_pulls() {
    let (scene, plan) = plan(
        "simulation = { duration = 1 }
        [body.plank]\nshape.box.size = [2, 0.1, 0.4]\nlocation = [0, 1, 0]\nangular_velocity = [0.3, 0, 1]
        [body.moon]\nshape.sphere.radius = 0.1\nlook.scale = 2\nlocation = [3, 3, 0]\nvelocity = [0, 0, 1]
        [force.a.spring]\nstiffness = 1
        between = [{ body = 'plank', at = [1, 0.05, 0.1] }, { body = 'moon', at = [0, -0.1, 0] }]",
    );
    for frame in frames(&scene).step_by(5) {
        let [Thing { form: Form::Coil { ends: [begin, end], .. }, .. }] = plan.links(&frame)[..] else {
            panic!("one is drawn")
        };
        let [plank, moon] = &frame.bodies[..] else { panic!("there are two") };
        assert_eq!(begin, plank.location + plank.orientation * DVec3::new(1.0, 0.05, 0.1));
        assert_eq!(end, moon.location + moon.orientation * DVec3::new(0.0, -0.2, 0.0));
    }
}

/// A scene with a bob and an arm, to which joints are added.
const HELD: &str = "simulation = { duration = 1, gravity = [0, -10, 0], integrator = 'rk4' }
    [body.bob]\nshape.sphere.radius = 0.1\nmass = 3\nlocation = [0, -2, 0]
    [body.arm]\nshape.box.size = [2, 0.1, 0.1]\nlocation = [4, 0, 0]\nmass = 1\n";

#[test]
fn a_label_tells_what_a_joint_does() {
    let (scene, plan) = plan(&format!(
        "{HELD}[joint.clamp.fixed]\nbetween = [[3, 0, 0], 'arm']
        [joint.string.rod]\nbetween = [[0, 0, 0], 'bob']
        [label.note]\ntext = '${{joint.string.force:.3}} ${{-joint.string.fx + joint.string.fy:.1}} ${{joint.clamp.tz:.2}} ${{2*bob.y}}'",
    ));
    let frame = frames(&scene).nth(20).unwrap();
    let [ref note] = plan.texts(&frame)[..] else { panic!("there is one") };
    assert_eq!(note.says, "30.000 30.0 10.00 −4");
}

/// The force on the bob is along its rod. The arrow of this force has the common scale of all forces.
#[test]
fn a_joint_has_arrows_for_its_force_and_its_torque() {
    let (scene, plan) = plan(&format!(
        "{HELD}[joint.string.rod]\nbetween = [[0, 0, 0], 'bob']\narrows.force = true
        [joint.clamp.fixed]\nbetween = ['arm', [3, 0, 0]]\narrows.force.scale = 0.05
        arrows.torque = {{ scale = 0.1, color = 'red' }}",
    ));
    let frame = frames(&scene).nth(20).unwrap();
    let [string, force, torque] = plan.arrows(&frame)[..] else { panic!("three are asked for") };
    assert_eq!((string.owner, string.body), (ArrowOwner::Joint(0), Some(0)));
    // The arrow begins at the surface of the bob, and points towards the pivot.
    assert!(string.from.abs_diff_eq(DVec3::new(0.0, -1.9, 0.0), 1e-9), "{string:?}");
    assert!((string.to - string.from).normalize().abs_diff_eq(DVec3::Y, 1e-9), "{string:?}");
    // The force on the fixed point is the weight of the arm. The torque is about the clamp.
    assert!((force.to - force.from).abs_diff_eq(DVec3::NEG_Y * 0.5, 1e-9), "{force:?}");
    assert!(torque.from.abs_diff_eq(DVec3::X * 3.0, 1e-9), "{torque:?}");
    assert!((torque.to - torque.from).abs_diff_eq(DVec3::NEG_Z, 1e-9), "{torque:?}");
    assert_eq!(torque.color.0, [1.0, 0.0, 0.0]);
}
