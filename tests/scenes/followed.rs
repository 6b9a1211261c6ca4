//! Cameras, lights and the scene's own SDL that follow measures.

use glam::DVec3;
use jabuka::Run;
use jabuka::emit::Emitter;
use jabuka::picture::{Lens, Plan};
use jabuka::scene::Scene;

/// A ball that falls freely from 9 m, and a ring that moves by a formula.
const SCENE: &str = "
    [simulation]
    duration = 1
    frame_rate = 10
    gravity = [0, -10, 0]
    integrator = 'velocity-verlet'
    [body.ball]
    shape.sphere.radius = 0.3
    mass = 2
    location = [0, 9, 0]
    velocity = [1, 0, 0]
    [body.ring]
    shape.sphere.radius = 0.1
    motion.formula.location = ['2*cos(t)', 1, '2*sin(t)']
    ";

#[test]
fn cameras_lights_and_sdl_have_the_values_of_closed_forms() {
    let scene = format!(
        "{SCENE}
        [camera]
        location = ['ball.x + 0.5', 'ring.z', '10 + 0.1*ball.kinetic']
        look_at = ['ball.x', 'ball.y', 'sin(t)']
        angle = '30 + ball.speed'
        [view.side]
        angle = 50
        [light.lamp]
        area = {{ location = ['ball.x', 'ball.y + 4', 't'], size = 1 }}
        [povray]
        sdl = 'sphere {{ <${{ball.x}}, ${{ball.y:cm}}, 0>, ${{t}} }}'
        "
    );
    let scene = Scene::parse(&scene).unwrap();
    let run = Run::new(&scene).unwrap();
    let plan = run.emitter().plan();
    let side = Plan::new(&scene, &scene.views[0].camera, run.survey());
    for frame in run.frames() {
        let frame = frame.unwrap();
        let t = frame.time;
        let [x, y] = [t, 9.0 - 5.0 * t * t];
        let speed = libm::sqrt(1.0 + 100.0 * t * t);
        let camera = plan.camera(&frame);
        let location = DVec3::new(x + 0.5, 2.0 * libm::sin(t), 10.0 + 0.1 * speed * speed);
        assert!(camera.location().abs_diff_eq(location, 1e-9), "{camera:?} at {t} s");
        assert!(camera.look_at().abs_diff_eq(DVec3::new(x, y, libm::sin(t)), 1e-9), "{camera:?} at {t} s");
        let Lens::Perspective { angle } = camera.lens() else { panic!("another lens") };
        assert!((angle - 30.0 - speed).abs() < 1e-9, "{angle} at {t} s");
        // A view inherits the location and has an angle of its own.
        assert!(side.camera(&frame).location().abs_diff_eq(location, 1e-9), "the view at {t} s");
        assert_eq!(side.camera(&frame).lens(), Lens::Perspective { angle: 50.0 });
        let light = &plan.lights(&frame)[0];
        assert!(light.location.abs_diff_eq(DVec3::new(x, y + 4.0, t), 1e-9), "{light:?} at {t} s");
        let script = run.emitter().script(&frame).unwrap();
        let (_, rest) = script.split_once("sphere { <").unwrap();
        let numbers: Vec<f64> =
            rest.split([',', '>', '}']).filter_map(|part| part.trim().parse().ok()).take(4).collect();
        for (found, known) in numbers.iter().zip([x, 100.0 * y, 0.0, t]) {
            assert!((found - known).abs() < 1e-6, "{numbers:?} at {t} s");
        }
        assert_eq!(numbers.len(), 4, "{script}");
    }
    // The plan starts where the first frame is.
    assert!(plan.placed().location().abs_diff_eq(DVec3::new(0.5, 0.0, 10.1), 1e-9));
    assert!(plan.lights_at_start()[0].location.abs_diff_eq(DVec3::new(0.0, 13.0, 0.0), 1e-9));
}

#[test]
fn mistakes_in_what_follows_measures_are_said_once_at_their_places() {
    let scene = format!(
        "{SCENE}
        [camera]
        location = ['bal.x', 'tt', '2*kinetic +']
        look_at = ['ball.xx', 0, 0]
        angle = 'ball.x:kg'
        [view.side]
        projection = 'perspective'
        [light.lamp]
        point.location = ['mean(ring.x)', '5 cm', 'impacts']
        [povray]
        sdl = '#declare A = ${{ball.z'
        "
    );
    let report = Scene::parse(&scene).unwrap_err();
    insta::assert_snapshot!(report.to_string());
}

/// A body that comes later has no place before, so a script that needs it cannot be written.
#[test]
fn an_unknown_value_is_an_error_and_no_script() {
    for (keys, expected) in [
        ("[camera]\nlocation = ['late.x', 1, 5]", "at t = 0 s the camera has no value"),
        ("[camera]\nangle = 'late.speed'", "at t = 0 s the camera has no value"),
        ("[light.lamp]\npoint.location = [0, 'late.y', 5]", "at t = 0 s the light `lamp` has no value"),
        ("[povray]\nsdl = '#declare A = ${late.x};'", "at t = 0 s `${late.x}` in `povray.sdl` has no value"),
    ] {
        let late = "[body.late]\nshape.sphere.radius = 0.2\nlocation = [3, 3, 0]\nstart = 0.5\n";
        let scene = Scene::parse(&format!("{SCENE}\n{late}{keys}")).unwrap();
        let run = Run::new(&scene).unwrap();
        let first = run.frames().next().unwrap().unwrap();
        let error = run.emitter().script(&first).unwrap_err().to_string();
        assert!(error.contains(expected), "{keys}: {error}");
        let last = run.frames().last().unwrap().unwrap();
        assert!(run.emitter().script(&last).is_ok(), "{keys}");
    }
}

/// SDL without values stands in the part that all scripts share.
#[test]
fn sdl_with_values_stands_in_each_script() {
    let emitted = |sdl: &str| {
        let text = format!("{SCENE}\noutput.layout = 'shared'\n[povray]\nsdl = '{sdl}'");
        let text = text.replace("[povray]", "[body.last]\nshape.sphere.radius = 1\n[povray]");
        let text = text.replace("output.layout = 'shared'", "[output]\nlayout = 'shared'");
        let scene = Scene::parse(&text).unwrap();
        let run = Run::new(&scene).unwrap();
        let emitter: &Emitter = run.emitter();
        let frame = run.frames().last().unwrap().unwrap();
        let files = emitter.sequence(&scene, [0]).unwrap();
        let shared = files.into_iter().find(|(name, _)| *name == jabuka::emit::COMMON).unwrap().1;
        [emitter.script(&frame).unwrap(), shared].map(|text| text.contains("#declare A ="))
    };
    assert_eq!(emitted("#declare A = 3;"), [false, true]);
    assert_eq!(emitted("#declare A = ${t};"), [true, false]);
}

/// Returns where a camera with these keys sees a point, as fractions of half the width of the picture.
fn seen(camera: &str, point: [f64; 3], time: f64) -> [f64; 2] {
    let scene = Scene::parse(&format!("{SCENE}\n[camera]\n{camera}")).unwrap();
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().map(Result::unwrap).find(|frame| frame.time >= time - 1e-9).unwrap();
    let screen = run.emitter().plan().camera(&frame).screen();
    let at = screen.project(DVec3::from_array(point)).unwrap();
    [at.x, at.y].map(|number| (1e9 * number).round() / 1e9)
}

/// Each camera is the first one, turned as a whole with the world, so a turned point is at the same place of its picture.
#[test]
fn up_and_roll_turn_the_picture() {
    let upright = seen("location = [0, 0, 10]\nlook_at = [0, 0, 0]", [1.0, 2.0, 0.0], 0.0);
    assert!(upright[0] > 0.1 && (upright[1] - 2.0 * upright[0]).abs() < 1e-8);
    for (camera, point) in [
        ("location = [10, 0, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, 7]", [0.0, 1.0, 2.0]),
        ("location = [0, 10, 0]\nlook_at = [0, 0, 0]\nup = [1, 0, 0]", [2.0, 0.0, 1.0]),
        ("location = [0, 0, 10]\nlook_at = [0, 0, 0]\nup = [0, -1, 3]", [-1.0, -2.0, 0.0]),
        // A camera that is turned clockwise sees things lean to the left.
        ("location = [0, 0, 10]\nlook_at = [0, 0, 0]\nroll = 90", [2.0, -1.0, 0.0]),
        ("location = [0, 0, 10]\nlook_at = [0, 0, 0]\nroll = -90", [-2.0, 1.0, 0.0]),
        ("location = [0, 0, 10]\nlook_at = [0, 0, 0]\nup = [-1, 0, 0]\nroll = '90'", [1.0, 2.0, 0.0]),
        // The orbit goes about `up`: after a quarter of the period, the camera is at [0, 10, 0] or at [0, -10, 0].
        ("location = [10, 0, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\norbit.period = 2", [-1.0, 0.0, 2.0]),
    ] {
        let time = if camera.contains("orbit") { 0.5 } else { 0.0 };
        assert_eq!(seen(camera, point, time), upright, "{camera}");
    }
    let rolled = seen("location = [0, 0, 10]\nlook_at = [0, 0, 0]\nroll = '90*t'", [2.0, -1.0, 0.0], 1.0);
    assert_eq!(rolled, upright);
    let wrong = "location = [0, 10, 0]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]";
    let report = Scene::parse(&format!("{SCENE}\n[camera]\n{wrong}")).unwrap_err().to_string();
    assert!(report.contains("the camera looks along its `up`"), "{report}");
}

/// With another upward direction, an automatic camera stands as it does with the vertical, as seen in a world that is turned along.
#[test]
fn an_automatic_camera_turns_with_up() {
    let placed = |keys: &str, ball: &str| {
        let text = format!(
            "simulation.duration = 1\nenvironment.ground = false\n{keys}\n[body.a]\nshape.sphere.radius = 0.5\nlocation = {ball}"
        );
        let scene = Scene::parse(&text).unwrap();
        let run = Run::new(&scene).unwrap();
        let screen = run.emitter().plan().placed().screen();
        let corner = |point| screen.project(point).unwrap();
        (*run.emitter().plan().placed(), corner(DVec3::ZERO))
    };
    let (upright, seen) = placed("", "[0, 0, 0]");
    let (turned, then) = placed("camera.up = [0, 0, 1]", "[0, 0, 0]");
    let way = |camera: jabuka::picture::Placed| camera.location() - camera.look_at();
    // The rotation from y to z takes z to -y.
    let expected = DVec3::new(way(upright).x, -way(upright).z, way(upright).y);
    assert!(way(turned).abs_diff_eq(expected, 0.02 * expected.length()), "{} {expected}", way(turned));
    assert!((seen.x - then.x).abs() < 0.02 && (seen.y - then.y).abs() < 0.02, "{seen:?} {then:?}");
}

/// A value cannot hide SDL that an untrusted scene may not contain.
#[test]
fn values_in_sdl_are_formulas_and_nothing_else() {
    let report =
        |sdl: &str| Scene::parse(&format!("{SCENE}\n[povray]\nsdl = \"{sdl}\"")).unwrap_err().to_string();
    let hidden = report("// ${\\n#fopen F \\\"x\\\" write\\n}");
    assert!(hidden.contains("error"), "{hidden}");
    // Nor does a value become part of a word: `df3` reads a file, and `1e` is a number for POV-Ray.
    let scene = format!("{SCENE}\n[povray]\nsdl = '#declare df0 = ${{1}}; #declare B = df${{1+2}};'");
    let scene = Scene::parse(&scene).unwrap();
    let run = Run::new(&scene).unwrap();
    let script = run.emitter().script(&run.frames().next().unwrap().unwrap()).unwrap();
    assert!(script.contains("#declare df0 =  1 ; #declare B = df 3 ;"), "{script}");
    let string = report("#declare A = \\\"part${t}.inc\\\";");
    assert!(string.contains("a value cannot stand within a string"), "{string}");
    let beside = report("#declare A = ${t}; #fopen F A write");
    assert!(beside.contains("untrusted-sdl") && beside.contains("#fopen F A write"), "{beside}");
}
