//! Tests of what is drawn to explain the physics: arrows, axes, trails, springs, labels, scale bars and grids are in the right places.

use glam::{DVec2, DVec3};
use jabuka::Run;
use jabuka::font::{Font, Typeface, Weight};

use jabuka::scene::Scene;

use crate::image::{Image, Rgb, is_blue, is_green, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::{render, render_all, run};
use crate::scene::{DARK, script, script_of};

fn front() -> Pinhole {
    Pinhole::new([0.0, 0.0, 10.0], [0.0, 0.0, 0.0])
}

fn is_white([r, g, b]: Rgb) -> bool {
    r.min(g).min(b) > 120
}

/// Returns true if a pixel within two pixels of a position satisfies a condition on its color.
fn near(image: &Image, place: DVec2, is_wanted: impl Fn(Rgb) -> bool) -> bool {
    let steps = || (-2..=2).map(f64::from);
    steps().any(|dx| steps().any(|dy| is_wanted(image.at(place + DVec2::new(dx, dy)))))
}

#[test]
fn arrows_begin_at_the_surface_and_are_as_long_as_their_scale_says() {
    let scene = |unit: &str| {
        let ball =
            "[body.ball]\nshape.sphere.radius = 0.5\nvelocity = [2, 0, 0]\nforce = [0, -3, 0]\nmass = 3\n";
        let arrows = "arrows = { velocity = { scale = 0.5, color = 'red' }, \
             acceleration = { color = 'lime' , scale = 1 }, force = { scale = 0.1, color = 'blue' } }\n";
        let size = format!("[output]\nsize = [{}, {}]\n", SIZE[0], SIZE[1]);
        script(&format!("{ball}{arrows}{}{DARK}{size}{unit}", front().toml()))
    };
    let images = render_all([scene(""), scene("[povray]\nunit = 0.1\n")], SIZE);
    let sees = |x: f64, y: f64| front().sees(DVec3::new(x, y, 0.0));
    for image in &images {
        for x in [0.55, 1.0, 1.4] {
            assert!(near(image, sees(x, 0.0), is_red), "velocity at {x}");
        }
        assert!(!near(image, sees(1.6, 0.0), is_red), "0.5 m + 2 m/s × 0.5 is the end");
        // The acceleration of 1 m/s² is drawn 1 m long, the force of 3 N 0.3 m. The two arrows are parallel, so they are drawn side by
        // side.
        let is_blue = |[r, g, b]: Rgb| b > r.saturating_add(40) && b > g.saturating_add(40);
        assert!(near(image, sees(-0.14, -0.7), is_blue), "the head of the force");
        for y in [-0.6, -1.0, -1.4] {
            assert!(near(image, sees(0.14, y), is_green), "acceleration at {y}");
        }
        assert!(!near(image, sees(0.14, -1.7), is_green) && !near(image, sees(-0.14, -1.0), is_blue));
    }
    assert!(images[0].difference(&images[1]) < 0.5, "the unit changes nothing");
}

#[test]
fn arrows_are_seen_where_the_ground_or_a_spring_would_hide_them() {
    let camera = Pinhole::new([0.0, 3.0, 10.0], [0.0, 0.0, 0.0]);
    let size = format!("[output]\nsize = [{}, {}]\n", SIZE[0], SIZE[1]);
    let arrow = "arrows.force = { scale = 1, color = 'red' }\n";
    let ball = "shape.sphere.radius = 0.5\nmaterial = { color = 'blue', finish = 'matte' }\n";
    let seen = |place: &str, keys: &str| {
        script(&format!("[body.ball]\n{ball}{arrow}location = {place}\nforce = [0, -2, 0]\n{keys}\n{size}"))
    };
    let fall = |place: &str, keys: &str| seen(place, &format!("{keys}{}", camera.toml()));
    // The tip of the arrow is 1.5 m below the ground or a plane.
    let ground = fall("[0, 1, 0]", "[environment]\nground.height = 0\n");
    let plane = fall("[0, 1, 0]", "[body.floor]\nshape.plane = {}\n");
    let parallel = seen(
        "[0, 1, 0]",
        "[environment]\nground.height = 0\n[camera]\nprojection = 'orthographic'\nwidth = 8\nlocation = [0, 3, 10]\nlook_at = [0, 0, 0]\n",
    );
    // A spring is attached where the arrow of the force points.
    let coil = "[force.s.spring]\nbetween = ['ball', [0, -3, 0]]\nstiffness = 0\ncoil = { color = 'lime', radius = 0.4, turns = 12 }\n";
    let coil = fall("[0, 2, 0]", &format!("{coil}{DARK}"));
    let images = render_all([ground, plane, parallel, coil], SIZE);
    let sees = |y: f64| camera.sees(DVec3::Y * y);
    for (number, image) in images[..2].iter().enumerate() {
        for y in [0.2, -0.4, -1.0] {
            assert!(near(image, sees(y), is_red), "image {number} at {y}");
        }
        assert!(!near(image, sees(-1.8), is_red), "image {number}: it is as long as it would be");
    }
    let across = DVec3::new(0.0, 10.0, -3.0).normalize();
    for y in [0.2, -0.4, -1.0] {
        let place = DVec2::new(80.0, 50.0 - y * across.y * 20.0);
        assert!(near(&images[2], place, is_red), "by parallel rays, at {y}");
    }
    // Each row of pixels from the ball to the tip must show some red of the arrow's shaft.
    let spot = images[3].spot(is_red).0;
    let (top, end) = (sees(1.3).y as usize, sees(-0.3).y as usize);
    for row in top..end {
        assert!(spot.iter().any(|pixel| pixel.y as usize == row), "row {row}");
    }
}

/// Checks that the night side of a planet is dark: in space only the stars can be reflected.
#[test]
fn the_night_side_of_a_planet_is_dark() {
    let planet = "environment = 'space'\n[body.planet]\nshape.sphere.radius = 2\nmaterial.color = 'white'\n\
        [light.sun]\nsun.direction = [0, 0, 1]\n";
    let image = render(&script(&format!("{planet}{}", front().toml())), SIZE);
    for x in [-1.2, -0.6, 0.0, 0.6, 1.2] {
        for y in [-1.2, -0.6, 0.0, 0.6, 1.2] {
            let [r, g, b] = image.at(front().sees(DVec3::new(x, y, 0.0)));
            assert!(r.max(g).max(b) < 16, "{x} {y}: {:?}", [r, g, b]);
        }
    }
}

/// Checks that body axes are luminous, so that they are visible in the dark.
#[test]
fn axes_are_seen_by_night() {
    let ball = "environment = 'space'\n[body.b]\nshape.sphere.radius = 0.2\naxes.length = 2\n\
        [light.sun]\nsun.direction = [0, 0, 1]\n";
    let image = render(&script(&format!("{ball}{}", front().toml())), SIZE);
    let [x, y] = [DVec3::X, DVec3::Y].map(|axis| front().sees(axis * 1.2));
    assert!(near(&image, x, |[r, g, _]| r > 120 && g < 80), "x is red");
    assert!(near(&image, y, |[r, g, _]| g > 80 && r < 70), "y is green");
}

/// Checks that scripts with large labels or a single grid line cause no warning: POV-Ray warns of a union of one object.
#[test]
fn large_labels_and_a_single_line_are_parsed_without_a_word() {
    let text = "[body.ball]\nshape.sphere.radius = 0.5\nvelocity = [0, -1, 0]\n\
        [label.large]\ntext = 'large'\nsize = 0.3\n[grid]\nplane = 'wall'\nspacing = 100\n\
        [camera]\nfollow = { body = 'ball', distance = 5 }\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.pov"), script(text)).unwrap();
    run(folder.path(), &["+Iscene.pov", "+Oscene.png", "+W1280", "+H720", "+SR1", "+ER1", "-A"])
        .nothing("large letters");
}

/// Checks that very short lines are left out and all others are drawn. With few digits the two ends of a short line become equal, and
/// POV-Ray does not accept such a line.
#[test]
fn lines_from_a_place_to_itself_are_left_out() {
    let text = "povray.digits = 4\nsimulation.duration = 2\n[body.ball]\nshape.sphere.radius = 0.5\nlocation = [1000, 0, 0]
        velocity = [0.3, 0, 0]\ntrail = true\narrows.velocity.scale = 0.3\n[camera]\nlocation = [1000, 0, 9]
        look_at = [1000, 0, 0]\n[force.s.spring]\nbetween = ['ball', [1003, 0, 0]]\nstiffness = 0\ncoil.radius = 1e-13\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.pov"), script_of(text, 20)).unwrap();
    run(folder.path(), &["+Iscene.pov", "+Oscene.png", "+W16", "+H9", "-A"]).nothing("short lines");
}

#[test]
fn a_body_has_its_axes_and_they_turn_with_it() {
    let body = "[body.b]\nshape.box.size = [0.4, 0.4, 0.4]\norientation = [0, 0, 90]\naxes.length = 2\n";
    let image = render(&script(&format!("{body}{}", front().toml())), SIZE);
    assert!(near(&image, front().sees(DVec3::Y * 1.2), is_red), "its x is up");
    assert!(near(&image, front().sees(DVec3::X * -1.2), is_green), "its y is left");
}

#[test]
fn ghosts_and_trail_are_where_the_body_was() {
    let scene = |keys: &str| {
        let body = "[body.ball]\nshape.sphere.radius = 0.3\nlocation = [-3, 0, 0]\nvelocity = [3, 3, 0]\nforce = [0, -3, 0]\n";
        let text = format!(
            "{body}material = {{ color = 'red', finish = 'luminous' }}\n{keys}{}{DARK}",
            front().toml()
        );
        script_of(&format!("simulation = {{ duration = 2, integrator = 'rk4' }}\n{text}"), 50)
    };
    let plain = scene("");
    let [ghosts, trail, none] =
        render_all([scene("ghosts.every = 0.5\n"), scene("trail = { color = 'lime' }\n"), plain], SIZE);
    let at = |t: f64| front().sees(DVec3::new(3.0 * t - 3.0, 3.0 * t - 1.5 * t * t, 0.0));
    for t in [0.0, 0.5, 1.0, 1.5] {
        let [r, g, b] = ghosts.at(at(t));
        assert!((100..200).contains(&r) && g > 8 && g < r && b < r, "a pale ghost at {t}: {:?}", [r, g, b]);
        assert_eq!(none.at(at(t)), [0; 3]);
    }
    assert_eq!(ghosts.at(at(1.25)), [0; 3]);
    assert_eq!(ghosts.at(at(2.0)), [255, 0, 0]);
    for t in [0.1, 0.73, 1.31, 1.8] {
        assert!(near(&trail, at(t), is_green), "the trail at {t}");
    }
}

/// The color follows x, from red at -3 m to blue at 3 m, in both layouts and for both kinds of trails.
#[test]
fn a_trail_and_ghosts_have_the_colors_of_their_values() {
    let scene = |keys: &str| {
        let text = format!(
            "simulation = {{ duration = 2, integrator = 'rk4' }}\n[output]\nlayout = 'self-contained'
            [body.ball]\nshape.sphere.radius = 0.3\nlocation = [-3, 0, 0]\nvelocity = [3, 0, 0]\n{keys}
            material = {{ finish = 'luminous', color.map = {{ of = 'x', palette = ['red', 'blue'], range = [-3, 3], bar = false }} }}
            {}{DARK}",
            front().toml()
        );
        script_of(&text, 50)
    };
    let keys = ["trail.width = 0.2", "trail = { width = 0.2, duration = 9 }", "ghosts.every = 0.5"];
    let [trail, tapering, ghosts] = render_all(keys.map(scene), SIZE);
    let at = |x: f64| front().sees(DVec3::X * x);
    for image in [trail, tapering] {
        let [red, middle, blue] = [-2.2, 0.0, 2.2].map(|x| image.at(at(x)));
        assert!(is_red(red) && is_blue(blue), "{red:?} {blue:?}");
        assert!(middle[0].abs_diff(middle[2]) < 20 && middle[1] < 30, "{middle:?}");
    }
    let [first, second, fourth] = [-3.0, -1.5, 1.5].map(|x| ghosts.at(at(x)));
    assert!(first[0] > first[2] + 60 && fourth[2] > fourth[0] + 60, "{first:?} {fourth:?}");
    assert!(first[0] > second[0] && second[0] > fourth[0], "{second:?}");
}

#[test]
fn a_spring_is_drawn_between_its_ends_unless_it_must_not() {
    let scene = |keys: &str| {
        let ball = "[body.ball]\nshape.sphere.radius = 0.3\nlocation = [2, 0, 0]\n";
        let spring = "[force.s.spring]\nbetween = ['ball', [-2, 0, 0]]\nstiffness = 1\n";
        script(&format!("{ball}{spring}{keys}{}{DARK}", front().toml()))
    };
    let hidden = scene("coil = false\n");
    assert!(!hidden.contains("Coil"));
    let green = scene("coil = { color = 'lime', radius = 0.4, turns = 6 }\n");
    let [green, hidden] = render_all([green, hidden], SIZE);
    let spot = green.spot(is_green);
    let (left, right) = (front().sees(DVec3::X * -2.0), front().sees(DVec3::X * 1.7));
    for pixel in &spot.0 {
        assert!((left.x - 7.0..=right.x + 1.0).contains(&pixel.x), "{pixel}");
    }
    assert!(spot.area() > 150.0, "{}", spot.area());
    // The turns of the coil must be visible along its whole length.
    for x in -12..=12 {
        let x = front().sees(DVec3::X * (0.1 * f64::from(x))).x;
        assert!(spot.0.iter().any(|pixel| (pixel.x - x).abs() < 4.0), "{x}");
    }
    assert_eq!(hidden.spot(is_green).area(), 0.0);
}

/// Checks that labels are in the corners and have the right size for every camera and every aspect ratio. They are in front of all
/// objects, and sharp even if the scene is out of focus.
#[test]
fn labels_stand_in_the_corners_of_all_cameras() {
    let corners = ["top-left", "top-right", "bottom-left", "bottom-right", "top", "bottom"];
    let labels: String = corners
        .iter()
        .map(|corner| {
            format!("[label.{corner}]\ntext = 'HHH'\ncorner = '{corner}'\nsize = 0.12\ncolor = 'white'\n")
        })
        .collect();
    let ball = "[body.ball]\nshape.sphere.radius = 1\nmaterial = { color = 'blue', finish = 'luminous' }\n";
    let scene = |camera: &str| script(&format!("{ball}{labels}{DARK}{camera}"));
    let images = render_all(
        [
            scene(""),
            scene("[camera]\nlocation = [1, 2, 9]\nangle = 80\n"),
            scene("[camera]\nprojection = 'orthographic'\nlocation = [0, 0, 9]\nwidth = 4\n"),
            scene("[camera]\nprojection = 'orthographic'\nlocation = [0, 9, 0]\n"),
            scene("[camera]\nlocation = [0, 9, 0]\n"),
            scene("[camera]\nlocation = [0, 0, 1.5]\n"),
            scene("[camera]\nlocation = [0, 0, 9]\naperture = 0.2\n"),
            scene("[povray]\nunit = 0.001\n"),
        ],
        [160, 120],
    );
    for (number, image) in images.iter().enumerate() {
        for corner in corners {
            let inside = |pixel: &DVec2| {
                let top = pixel.y < 60.0;
                let (left, right) = (pixel.x < 50.0, pixel.x > 110.0);
                corner.starts_with("top") == top
                    && corner.ends_with("left") == left
                    && corner.ends_with("right") == right
            };
            let spot: Vec<DVec2> = image.spot(is_white).0.into_iter().filter(inside).collect();
            let middle = spot.iter().sum::<DVec2>() / spot.len() as f64;
            assert!((40..400).contains(&spot.len()), "camera {number}, {corner}: {} pixels", spot.len());
            let edge = if middle.y < 60.0 { middle.y } else { 120.0 - middle.y };
            assert!((4.0..20.0).contains(&edge), "camera {number}, {corner}: {middle}");
            if corner.contains('-') {
                let edge = if middle.x < 80.0 { middle.x } else { 160.0 - middle.x };
                assert!((8.0..30.0).contains(&edge), "camera {number}, {corner}: {middle}");
            } else {
                assert!((middle.x - 80.0).abs() < 3.0, "camera {number}, {corner}: {middle}");
            }
        }
    }
}

#[test]
fn a_label_stands_beside_its_body_and_is_not_hidden() {
    let scene = |side: &str| {
        let ball = "[body.ball]\nshape.sphere.radius = 0.5\nlocation = [1, 0, 0]\nmaterial = { color = 'blue', finish = 'luminous' }\n";
        let wall = "[body.wall]\nshape.box.size = [9, 9, 0.1]\nlocation = [0, 0, 2]\nmaterial = { color = 'red', finish = 'luminous' }\n";
        let label =
            format!("[label.l]\ntext = 'HH'\nbody = 'ball'\nside = '{side}'\nsize = 0.1\ncolor = 'white'\n");
        script(&format!("{ball}{wall}{label}{}{DARK}", front().toml()))
    };
    let images = render_all([scene("above"), scene("below"), scene("left"), scene("right")], SIZE);
    let middle = front().sees(DVec3::X);
    let sides = [DVec2::NEG_Y, DVec2::Y, DVec2::NEG_X, DVec2::X];
    for (image, side) in images.iter().zip(sides) {
        let off = image.spot(is_white).middle() - middle;
        assert!(off.normalize().dot(side) > 0.9 && (8.0..30.0).contains(&off.length()), "{side}: {off}");
    }
}

/// The font of regular letters.
fn usual_font() -> &'static Font {
    Typeface::usual().font(Weight::Regular)
}

/// Checks the places of subscripts, superscripts and lines: each part is where the metrics of the font say.
#[test]
fn subscripts_and_lines_of_a_label_are_in_their_places() {
    let label = "[label.l]\ntext = \"H_{HH}^{HH} H\\nH\"\nsize = 0.2\ncolor = 'white'\n[body.ball]\nshape.sphere.radius = 0.01\n";
    let image = render(&script(&format!("{label}{DARK}")), [640, 360]);
    let spot = image.spot(is_white).0;
    let high = 0.2 * 360.0;
    // The columns of the letters in the first line: an H, the subscript, the superscript, and an H after a space.
    let width = |text: &str| usual_font().width(text) * high;
    let small = jabuka::lettering::SCRIPT_SIZE;
    // The ink begins at the place of the label.
    let mut begin = 0.035 / 2.0 * 640.0 - usual_font().ink("H").unwrap()[0] * high;
    let mut bottoms = Vec::new();
    for wide in [width("H"), small * width("HH"), small * width("HH"), width(" H")] {
        let column =
            spot.iter().filter(|pixel| (begin..begin + wide).contains(&pixel.x) && pixel.y < 1.2 * high);
        bottoms.push(column.map(|pixel| pixel.y).fold(0.0, f64::max));
        begin += wide;
    }
    let [line, lower, upper, last] = bottoms[..] else { panic!("{bottoms:?}") };
    assert!((last - line).abs() <= 1.5, "{bottoms:?}");
    assert!(
        (lower - line - 0.14 * high).abs() <= 1.5 && (line - upper - 0.33 * high).abs() <= 1.5,
        "{bottoms:?}"
    );
    let below = spot.iter().filter(|pixel| pixel.x < 60.0).map(|pixel| pixel.y).fold(0.0, f64::max);
    assert!((below - line - 1.15 * high).abs() <= 1.5, "the second line: {below}, {bottoms:?}");
}

#[test]
fn a_scale_bar_is_as_long_as_it_says() {
    let scene = |camera: &str| {
        let ball =
            "[body.ball]\nshape.sphere.radius = 0.5\nmaterial = { color = 'blue', finish = 'luminous' }\n";
        script(&format!("scale_bar = {{ length = 2 }}\n{ball}{DARK}{camera}"))
    };
    let ortho = "[camera]\nprojection = 'orthographic'\nlocation = [0, 0, 9]\nwidth = 8\n";
    let images = render_all([scene(ortho), scene(&front().toml())], SIZE.map(|pixels| 4 * pixels));
    let wide = [160.0, 4.0 * (front().sees(DVec3::X) - front().sees(-DVec3::X)).x];
    for (image, wide) in images.iter().zip(wide) {
        // The scale bar is the longest row of white pixels.
        let spot = image.spot(is_white).0;
        let row = |y: f64| spot.iter().filter(|pixel| pixel.y == y).count();
        let longest = (0..4 * SIZE[1]).map(|y| row(f64::from(y) + 0.5)).max().unwrap();
        assert!((longest as f64 - wide).abs() <= 2.0, "{longest} pixels, not {wide}");
    }
}

#[test]
fn a_grid_has_its_lines_where_its_numbers_say() {
    let text = "grid = { plane = 'wall', spacing = 1 }\n[body.ball]\nshape.sphere.radius = 0.2\nvelocity = [1, 0.5, 0]\n\
        [simulation]\nduration = 4\n[camera]\nprojection = 'orthographic'\nlocation = [2, 1, 9]\nwidth = 8\n";
    let script = script(&format!("{text}{DARK}"));
    let image = render(&script, [960, 540]);
    let sees = |x: f64, y: f64| DVec2::new(480.0 + (x - 2.0) * 120.0, 270.0 - (y - 1.0) * 120.0);
    let bright = |[r, g, b]: Rgb| u32::from(r) + u32::from(g) + u32::from(b) > 100;
    for x in 1..=4 {
        assert!(near(&image, sees(f64::from(x), 1.5), bright), "a line at x = {x}");
        assert!(!near(&image, sees(f64::from(x) + 0.5, 1.5), bright), "no line at x = {x}.5");
    }
    for number in ["\"1\"", "\"2\"", "\"4\"", "\"x (m)\"", "\"y (m)\""] {
        assert!(script.contains(number), "{number}");
    }
}

/// A curve is drawn where its values are: a spring with a damper, whose potential energy falls from 4.5 J. The panel and its axes are known
/// from the plan; each point of the table must be a pixel in the color of the curve, and none lies ahead of the frame.
#[test]
fn a_curve_of_a_plot_is_where_its_values_are() {
    let text = "[simulation]\nduration = 4\nintegrator = 'velocity-verlet'\n[output]\nsize = [960, 540]\n\
        [body.wall]\nshape.box.size = [0.1, 0.3, 0.3]\nfixed = true\n\
        [body.sled]\nshape.box.size = [0.3, 0.3, 0.3]\nlocation = [2.2, 0, 0]\nmass = 1\n\
        [force.s]\nspring = { between = ['wall', 'sled'], stiffness = 9, damping = 0.4, rest_length = 1.2 }\n\
        [plot.energy]\ny = ['kinetic', 'potential', 'total']\nrange = [0, 5]\nside = 'right'\n";
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let (last, aspect) = (60, 540.0 / 960.0);
    let frames: Vec<_> = run.frames().take(last + 1).map(Result::unwrap).collect();
    let image = render(&run.emitter().script(&frames[last]).unwrap(), [960, 540]);
    let plot = &run.emitter().plan().planned_plots()[0];
    let pixel = |[x, y]: [f64; 2]| {
        let up = plot.bottom.above_middle(aspect) + y;
        DVec2::new(480.0 * (1.0 + plot.left + x), 270.0 - 480.0 * up)
    };
    // The values of a frame, and the corner of the axes: the upright axis goes from 0 J to 5 J, the level one from 0 s to 4 s.
    let axes: Vec<_> = plot.lines.iter().filter(|line| line.is_axis).collect();
    let (origin, top) = (axes[axes.len() - 1].from, axes[axes.len() - 1].to);
    let right = axes[axes.len() - 2].to;
    let place = |time: f64, joule: f64| {
        let across = origin[0] + (right[0] - origin[0]) * time / 4.0;
        [across, origin[1] + (top[1] - origin[1]) * joule / 5.0]
    };
    let is_near = |color: [f64; 3]| {
        move |[r, g, b]: Rgb| {
            let wanted = color.map(|part| (255.0 * part) as i32);
            [r, g, b].iter().zip(wanted).all(|(part, wanted)| (i32::from(*part) - wanted).abs() < 60)
        }
    };
    let (kinetic, total) = (plot.curves[0].color.0, plot.curves[2].color.0);
    for frame in &frames {
        // The total stands before the others.
        let at = pixel(place(frame.time, frame.balance.total));
        assert!(is_near(total)(image.at(at)), "{}: {:?}", frame.time, image.at(at));
    }
    for part in 70..95 {
        let x = origin[0] + (right[0] - origin[0]) * f64::from(part) / 100.0;
        let mut column =
            (0..200).map(|y| pixel([x, origin[1] + (top[1] - origin[1]) * f64::from(y) / 200.0]));
        let is_ahead = |at: DVec2| is_near(kinetic)(image.at(at)) || is_near(total)(image.at(at));
        assert!(!column.any(is_ahead), "the curve is drawn ahead, at {part} % of the time");
    }
}

/// Bars are filled with their colors, from zero to their values, and nothing is filled beyond.
#[test]
fn bars_of_a_plot_are_as_high_as_their_values() {
    let text = "simulation = { duration = 2, frame_rate = 10 }\n[output]\nsize = [640, 360]\n
        [body.ball]\nshape.sphere.radius = 0.1\nmotion.formula.location = ['2*t', '-t', '0']\n
        [plot.now]\nbars = ['ball.x', 'ball.y']\nrange = [-4, 4]\nside = 'right'\n";
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().nth(10).unwrap().unwrap();
    let image = render(&run.emitter().script(&frame).unwrap(), [640, 360]);
    let plan = run.emitter().plan();
    let plot = &plan.planned_plots()[0];
    let axes: Vec<_> = plot.lines.iter().filter(|line| line.is_axis).collect();
    let upright = axes[axes.len() - 1];
    let color_at = |x: f64, value: f64| {
        let y = upright.from[1] + (upright.to[1] - upright.from[1]) * (value + 4.0) / 8.0;
        let up = plot.bottom.above_middle(360.0 / 640.0) + y;
        image.at(DVec2::new(320.0 * (1.0 + plot.left + x), 180.0 - 320.0 * up))
    };
    let bars = plan.plots(&frame)[0].bars.clone();
    for (bar, value) in bars.into_iter().zip([2.0, -1.0]) {
        let middle = (bar.from[0] + bar.to[0]) / 2.0;
        let is_filled = |value: f64| {
            let wanted = bar.color.bytes();
            color_at(middle, value).iter().zip(wanted).all(|(part, wanted)| part.abs_diff(wanted) < 40)
        };
        for part in [0.1, 0.5, 0.9] {
            assert!(is_filled(part * value), "{part} of {value}: {:?}", color_at(middle, part * value));
        }
        for part in [-0.2, 1.15] {
            assert!(!is_filled(part * value), "{part} of {value}");
        }
    }
}

/// A run of 20,000 frames has more frames than a curve has points. The speed of a body that jumps within one frame is a peak of this frame, and
/// a pixel of the picture shows it.
#[test]
fn a_peak_of_one_frame_is_a_pixel_of_a_long_plot() {
    let text = "[simulation]\nduration = 799.96\n[output]\nsize = [320, 180]\n\
        [body.ball]\nshape.sphere.radius = 0.3\nmotion.formula.location = ['0', '0', 'exp(-((t - 480)/0.01)^2)']\n\
        [plot.height]\ny = 'ball.z'\nrange = [0, 1]\nwidth = 0.5\n";
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let last = run.frames().last().unwrap().unwrap();
    assert_eq!(last.index, 19_999);
    let image = render(&run.emitter().script(&last).unwrap(), [320, 180]);
    let plot = &run.emitter().plan().planned_plots()[0];
    let pixel = |[x, y]: [f64; 2]| {
        let up = plot.bottom.above_middle(180.0 / 320.0) + y;
        DVec2::new(160.0 * (1.0 + plot.left + x), 90.0 - 160.0 * up)
    };
    let axes: Vec<_> = plot.lines.iter().filter(|line| line.is_axis).collect();
    let (origin, top) = (axes[axes.len() - 1].from, axes[axes.len() - 1].to);
    let right = axes[axes.len() - 2].to;
    let at = |part: f64, height: f64| {
        let across = origin[0] + (right[0] - origin[0]) * part;
        pixel([across, origin[1] + (top[1] - origin[1]) * height])
    };
    let color = plot.curves[0].color.bytes();
    let is_curve = |rgb: Rgb| {
        rgb.iter().zip(color).all(|(part, wanted)| (i32::from(*part) - i32::from(wanted)).abs() < 70)
    };
    for height in [0.3, 0.55, 0.8, 0.95] {
        assert!(near(&image, at(480.0 / 799.96, height), is_curve), "the peak, at {height}");
        for part in [0.2, 0.45, 0.75, 0.9] {
            assert!(!near(&image, at(part, height), is_curve), "no curve at {part}, {height}");
        }
    }
}

/// Checks that each moment of an image with motion blur shows its own past in ghosts and trails, and its own time in labels.
#[test]
fn the_moments_of_a_shutter_have_their_own_past() {
    let text = "[simulation]\nduration = 1\n[camera]\nshutter = 0.04\nsamples = 2\n\
        [body.ball]\nshape.sphere.radius = 0.2\nvelocity = [1, 0, 0]\nghosts.every = 0.22\ntrail.duration = 0.1\n\
        [label.t]\ntext = 't = ${t:.3} s'\n";
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let exposure = run.at(0.2).unwrap();
    let shutter = scene.camera.shutter.unwrap();
    let mut blurred = String::new();
    let put = |piece: &str| -> Result<(), Box<dyn std::error::Error>> {
        blurred.push_str(piece);
        Ok(())
    };
    let moments = exposure.moments(shutter).map(|moment| moment.map_err(Into::into));
    run.emitter().shutter(&exposure.frame, shutter, moments, put).unwrap();
    assert!(blurred.contains("\"t = 0.210 s\"") && blurred.contains("\"t = 0.230 s\""), "{blurred}");
    let ghosts = |script: &str| script.matches("Material_").count() + script.matches("Ghost_").count();
    let (first, second) = blurred.split_once("#case (1)").unwrap();
    assert_eq!(ghosts(second), ghosts(first) + 1, "the ghost of 0.22 s is in the second only");
}

/// The advance widths of letters contain the space before the first and after the last letter, which POV-Ray does not measure.
#[test]
fn texts_are_as_wide_as_pov_ray_sets_them() {
    let texts = ["Kinetic energy", "Δφ = 30°, Höhe 2,5·10⁻³ m", "iiiiii", "WWWW", "−7.5·10⁻⁶ J", "ball"];
    let folder = tempfile::tempdir().unwrap();
    let fonts = [Weight::Regular, Weight::Bold].map(|weight| Typeface::usual().font(weight));
    let texts = fonts.into_iter().flat_map(|font| texts.map(|text| (font, text))).collect::<Vec<_>>();
    let measure = |(font, text): &(&Font, &str)| {
        let file = font.file_name();
        let letters = format!("#declare Letters = text {{ ttf \"assets/{file}\" \"{text}\" 0.01, 0 }};");
        format!("{letters}\n#warning concat(\"width \", str(max_extent(Letters).x, 0, 6), \" end\\n\")\n")
    };
    let settings = "#version 3.7;\nglobal_settings { charset utf8 assumed_gamma 1 }\n";
    let script = format!("{settings}{}", texts.iter().map(measure).collect::<String>());
    std::fs::write(folder.path().join("widths.pov"), script).unwrap();
    let said = run(folder.path(), &["+Iwidths.pov", "+W1", "+H1", "-F"]).warnings;
    let measured =
        said.split("width ").skip(1).map(|rest| rest.split(" end").next().unwrap().parse().unwrap());
    let measured: Vec<f64> = measured.collect();
    assert_eq!(measured.len(), texts.len(), "{said}");
    for ((font, text), measured) in texts.iter().zip(measured) {
        let spaces = font.width(text) - measured;
        assert!((-0.01..0.25).contains(&spaces), "{text}: {measured}, and {spaces} more by the font");
    }
}

/// POV-Ray sets bold words in the bold font, and a label in its own font. They are as wide as these fonts say.
#[test]
fn bold_letters_and_fonts_of_labels_are_drawn() {
    let text = format!(
        "{DARK}[body.ball]\nshape.sphere.radius = 0.01\n[label.l]\ntext = \"**HH** HH\"\nsize = 0.2\ncolor = 'white'\n"
    );
    let image = render(&script(&text), [640, 360]);
    let spot = image.spot(is_white).0;
    let high = 0.2 * 360.0;
    let [regular, bold] = [Weight::Regular, Weight::Bold].map(|weight| Typeface::usual().font(weight));
    let begin = 0.035 / 2.0 * 640.0;
    let middle = begin + (bold.width("HH") - bold.ink("H").unwrap()[0] + regular.width(" ") / 2.0) * high;
    let count = |is_left: bool| spot.iter().filter(|pixel| (pixel.x < middle) == is_left).count() as f64;
    let near = |x: f64| spot.iter().filter(|pixel| (pixel.x - x).abs() < 0.1 * high).count();
    assert_eq!(near(middle), 0, "the space is where the widths of bold letters end");
    // The strokes of bold letters are 1.7 times as wide.
    assert!(count(true) > 1.3 * count(false), "{} {}", count(true), count(false));
    // The file of bold letters lies beside the scripts also if only a value or the name of an angle is bold.
    let angle = "[angle.'**a**']\nat = [0, 0, 0]\nfrom = [1, 0, 0]\nto = [0, 1, 0]\n";
    for (text, is_bold) in [
        (text.replace("**HH** HH", "**${t}**"), true),
        (text.replace("**HH** HH", "HH") + angle, true),
        (text.replace("**HH** HH", "${t}"), false),
    ] {
        let assets = Scene::parse(&text).unwrap_or_else(|report| panic!("{report}")).povray.assets;
        assert_eq!(assets.iter().any(|asset| asset.name == "DejaVuSans-Bold.ttf"), is_bold, "{text}");
    }

    let folder = tempfile::tempdir().unwrap();
    let own = text.replace("**HH** HH", "HH") + "font = 'letters.ttf'\n";
    std::fs::write(folder.path().join("scene.toml"), own).unwrap();
    let font = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/keys/files/letters.ttf");
    for name in ["letters.ttf", "assets/letters.ttf"] {
        let to = folder.path().join(name);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::copy(font, to).unwrap();
    }
    let scene = Scene::from_path(folder.path().join("scene.toml")).unwrap();
    let run_of_scene = Run::new(&scene).unwrap();
    let script = run_of_scene.script(&run_of_scene.at(0.0).unwrap().frame).unwrap();
    std::fs::write(folder.path().join("own.pov"), script).unwrap();
    run(folder.path(), &["+Iown.pov", "+W640", "+H360", "+Oown.png"]).nothing("a font of one's own");
    let own = Image::read(&folder.path().join("own.png"));
    let spot = own.spot(is_white).0;
    // The ball in the middle has a white highlight.
    let columns = || spot.iter().map(|pixel| pixel.x).filter(|x| *x < 200.0);
    let wide = columns().fold(0.0, f64::max) - columns().fold(f64::INFINITY, f64::min);
    let [left, right] = scene.labels[0].typeface().font(Weight::Regular).ink("HH").unwrap();
    assert!((wide - (right - left) * high).abs() < 3.0, "{wide}, {}", (right - left) * high);
}

/// Sectors have their color from both sides: before black, 0.7 of its light, and every second one 0.35 of it. They leave the rest free.
#[test]
fn sectors_stand_between_the_center_and_the_path() {
    let scene = |z: f64| {
        let camera = Pinhole::new([0.0, 0.0, z], [0.0, 0.0, 0.0]);
        let text = format!(
            "[simulation]\nduration = 2\n[body.ball]\nshape.sphere.radius = 0.1\nlocation = [-2, 1, 0]\nvelocity = [2, 0, 0]\n\
             [area.a]\nbody = 'ball'\ncenter = [0, -1, 0]\nevery = 1\ncolor = 'red'\n{DARK}{}",
            camera.toml()
        );
        (script_of(&text, 50), camera)
    };
    let [front, behind] = [10.0, -10.0].map(scene);
    let images = render_all([front.0, behind.0], SIZE);
    for (image, camera) in images.iter().zip([front.1, behind.1]) {
        let at = |x: f64, y: f64| image.at(camera.sees(DVec3::new(x, y, 0.0)));
        for (x, part) in [(-0.6, 0.7), (0.6, 0.35)] {
            let expected = 255.0 * (1.055 * libm::pow(part, 1.0 / 2.4) - 0.055);
            let [red, green, blue] = at(x, 0.6);
            assert!((f64::from(red) - expected).abs() < 4.0 && green.max(blue) < 4, "{x}: {red}");
        }
        for (x, y) in [(-1.8, -0.5), (1.8, -0.5), (0.0, 1.3), (0.0, -1.3)] {
            assert!(at(x, y)[0] < 4, "{x} {y}: {:?}", at(x, y));
        }
    }
}

/// The surface of water is seen from above, and what is below shows through it. It is blue, not black, and ends at its level.
#[test]
fn water_is_transparent_and_has_its_color() {
    let camera = Pinhole::new([0.0, 5.0, 8.0], [0.0, 0.0, 0.0]);
    let image = |surface: &str| {
        let text = format!(
            "simulation = {{ duration = 0, gravity = [0, -10, 0] }}\nenvironment.ground.height = -1\n\
             [body.ball]\nshape.sphere.radius = 0.5\nmass = 1\nlocation = [0, -0.5, 0]\n\
             material = {{ color = 'red', finish = 'luminous' }}\n\
             [force.water.buoyancy]\ndensity = 1000\nlevel = 0.2\non = ['ball']\n{surface}\n{}",
            camera.toml()
        );
        render(&script(&text), SIZE)
    };
    let (with, without) = (image("surface = true"), image(""));
    let ball = camera.sees(DVec3::new(0.0, -0.3, 0.0));
    let ([red, _, blue], [bare, ..]) = (with.at(ball), without.at(ball));
    assert!((60..bare - 20).contains(&red) && blue > 40, "{red} of {bare}, {blue}");
    let water = with.at(camera.sees(DVec3::new(2.0, 0.2, 0.5)));
    assert!(water[2] > water[0].saturating_add(20) && water[2] > 90, "{water:?}");
}
