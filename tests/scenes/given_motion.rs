//! Tests of prescribed motion by formulas, keyframes and tables, and of moving cameras and lights.

use std::fmt::Write as _;
use std::fs;

use glam::DVec3;
use jabuka::simulate::{Frame, Frames};
use jabuka::{Run, Scene};

use crate::support::place::Place;
use crate::support::{jabuka, stderr, stdout};

fn frames(text: &str) -> Vec<Frame> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{}", report.to_text(false)));
    Frames::new(&scene).map(Result::unwrap).collect()
}

/// Returns the scripts of all frames of a scene.
fn scripts(text: &str) -> Vec<String> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{}", report.to_text(false)));
    let run = Run::new(&scene).unwrap();
    run.frames().map(|frame| run.script(&frame.unwrap()).unwrap()).collect()
}

#[test]
fn a_body_goes_where_its_formulas_say_and_its_velocities_follow() {
    let frames = frames(
        "
        [variables]
        r = 2
        w = 3
        [simulation]
        duration = 1
        gravity = [0, -9.81, 0]
        [body.crank]
        shape.box.size = [1, 2, 3]
        motion.formula.location = ['r*cos(w*t)', 'r*sin(w*t)', 'uniform(1, 2)']
        motion.formula.orientation = [0, '30*t', 'deg(w*t)']
        ",
    );
    for frame in frames {
        let (sin, cos) = libm::sincos(3.0 * frame.time);
        let body = frame.bodies[0];
        assert!(body.location.truncate().abs_diff_eq(glam::DVec2::new(2.0 * cos, 2.0 * sin), 1e-14));
        assert!((1.0..2.0).contains(&body.location.z), "drawn once");
        assert!(body.velocity.abs_diff_eq(DVec3::new(-6.0 * sin, 6.0 * cos, 0.0), 1e-13));
        assert!(
            body.force.abs_diff_eq(DVec3::new(-18.0 * cos, -18.0 * sin, 0.0), 1e-12),
            "m a, {}",
            body.force
        );
        // The body turns about z with the rate w, and by 30°/s about its y axis, which the first rotation turns as well.
        let spin = DVec3::Z * 3.0 + DVec3::new(-sin, cos, 0.0) * 30f64.to_radians();
        assert!(body.angular_velocity.abs_diff_eq(spin, 1e-13), "{} {spin}", body.angular_velocity);
        assert_eq!(frame.balance.drift, 0.0);
    }
}

/// A slider-crank: the rod's end follows the crank, and the lamp of the rod follows both. Positions, velocities and accelerations are those of
/// the closed forms.
#[test]
fn a_motion_by_formulas_follows_another_one() {
    let frames = frames(
        "
        variables.l = 3
        [simulation]
        duration = 1
        gravity = [0, 0, 0]
        [body.lamp]
        shape.sphere.radius = 0.1
        motion.formula.location = ['(crank.x + slider.x)/2', 1, 't*slider.y']
        [body.slider]
        shape.sphere.radius = 0.1
        location = ['9', '4/2', 0]
        motion.formula.location = ['crank.x + sqrt(l^2 - crank.y^2)', 2, 0]
        [body.crank]
        shape.sphere.radius = 0.1
        motion.formula.location = ['cos(2*t)', 'sin(2*t)', 0]
        ",
    );
    for frame in frames {
        let (sin, cos) = libm::sincos(2.0 * frame.time);
        let root = (9.0 - sin * sin).sqrt();
        let x = cos + root;
        let speed = -2.0 * sin - 2.0 * sin * cos / root;
        let [lamp, slider, _] = frame.bodies[..] else { panic!() };
        assert!((slider.location.x - x).abs() < 1e-14 && (slider.velocity.x - speed).abs() < 1e-13);
        let expected = DVec3::new(0.5 * (x + cos), 1.0, 2.0 * frame.time);
        assert!(lamp.location.abs_diff_eq(expected, 1e-14), "{} {expected}", lamp.location);
        let expected = DVec3::new(0.5 * (speed - 2.0 * sin), 0.0, 2.0);
        assert!(lamp.velocity.abs_diff_eq(expected, 1e-13), "{} {expected}", lamp.velocity);
    }
}

#[test]
fn motions_that_follow_each_other_are_named() {
    let body = |name: &str, x: &str| {
        format!("[body.{name}]\nshape.sphere.radius = 1\nmotion.formula.location = ['{x}', 0, 0]\n")
    };
    let report = |text: &str| Scene::parse(text).unwrap_err().to_string();
    let said =
        report(&(body("a", "t + b.x") + &body("b", "c.x/2") + &body("c", "1 - a.x") + &body("d", "a.x")));
    assert_eq!(said.matches("error").count(), 3, "`d` is outside of the circle: {said}");
    assert!(said.contains("follow each other"), "{said}");
    assert!(report(&body("a", "a.x + t")).contains("the motion of `a` follows itself"));
    // A mistake is reported where it is, and only there.
    let said = report(&(body("a", "foo*t") + &body("b", "a.x + 1") + &body("c", "b.x + bar")));
    assert_eq!(said.matches("error").count(), 1, "{said}");
    assert!(said.contains("there is no variable `foo`"), "{said}");
    let said = report(&(body("a", "t") + &body("b", "a.x + bar")));
    assert!(said.contains("'a.x + bar'") && said.contains("          ^^^"), "{said}");
    let many: String =
        (0..5000).map(|number| body(&format!("b{number}"), &format!("b{}.x", number + 1))).collect();
    let said = report(&(many + &body("b5000", "t")));
    assert!(said.contains("more than 50 bodies follow one after the other"), "{said}");
    // Each formula names the one before twice.
    let mut text = body("a0", "sin(t)");
    for number in 1..20 {
        text += &body(&format!("a{number}"), &format!("a{0}.x*a{0}.x", number - 1));
    }
    assert!(report(&text).contains("this formula has over 10000 bytes"));
    // What is random or moved by forces cannot be followed.
    for other in ["motion.formula.location = ['t*uniform(0, 1)', 0, 0]", "velocity = [1, 0, 0]"] {
        let text = format!("{}[body.b]\nshape.sphere.radius = 1\n{other}", body("a", "b.x"));
        assert!(report(&text).contains("a formula cannot ask where a body is"), "{other}");
    }
}

#[test]
fn keyframes_are_reached_and_what_they_leave_out_stays() {
    let frames = frames(
        "
        [simulation]
        duration = 3
        frame_rate = 2
        [body.lift]
        shape.box.size = [1, 1, 1]
        location = [0, 1, 0]
        motion.keyframes.at = [
          { time = 0.5 },
          { time = 1.5, location = [0, 5, 0] },
          { time = 2.5, orientation = [0, 90, 0] },
        ]
        ",
    );
    let y: Vec<f64> = frames.iter().map(|frame| frame.bodies[0].location.y).collect();
    assert_eq!((y[0], y[1], y[3], y[5], y[6]), (1.0, 1.0, 5.0, 5.0, 5.0));
    let x_axis = frames[5].bodies[0].orientation * DVec3::X;
    assert!(x_axis.abs_diff_eq(DVec3::NEG_Z, 1e-15));
    assert_eq!(frames[6].bodies[0].velocity, DVec3::ZERO);
}

#[test]
fn what_is_wrong_with_a_formula_is_said_with_its_place_and_time() {
    let place = Place::new(&[(
        "scene.toml",
        "[body.a]\nshape.sphere.radius = 1\nmotion.formula.location = [\"1/(t - 2)\", \"sqrt(3 - t)\", 0]\n",
    )]);
    let said = place.errors("scene.toml");
    assert!(said.contains("scene.toml:3:31") && said.contains(", at t = 2 s"), "{said}");
    assert!(said.contains("scene.toml:3:42") && said.contains(", at t = 3.04 s"), "{said}");
}

/// Checks the error of a camera or light whose formula has no value between two frames. The check evaluates formulas only at the times of
/// frames.
#[test]
fn a_camera_or_a_light_that_is_nowhere_between_frames_is_named() {
    let place = |what: &str| {
        let text = format!(
            "simulation.duration = 1\n[body.a]\nshape.sphere.radius = 1\n{what} = ['1/(t - 0.5)', 3, 10]\n"
        );
        let scene = Scene::parse(&text).unwrap();
        let run = Run::new(&scene).unwrap();
        assert!(run.frames().all(|frame| run.script(&frame.unwrap()).is_ok()));
        run.script(&Frames::at(&scene, 0.5).unwrap()).unwrap_err().to_string()
    };
    assert!(place("[camera]\nlocation").contains("at t = 0.5 s the camera is"));
    assert!(place("[light.lamp]\npoint.location").contains("at t = 0.5 s the light `lamp` is"));
}

/// Checks that an export does not overwrite a file that the scene reads, also if a link gives it another name.
#[test]
fn a_file_that_a_scene_is_made_from_is_not_overwritten() {
    let csv = "t [s],x [m],y [m],z [m]\n0,0,0,0\n1,5,0,0\n";
    let scene = "[body.a]\nshape.sphere.radius = 1\nmotion.trajectory.file = 'run.csv'\n";
    let place = Place::new(&[("scene.toml", scene), ("run.csv", csv)]);
    std::os::unix::fs::symlink(place.path("run.csv"), place.path("other.csv")).unwrap();
    for name in ["run.csv", "other.csv"] {
        let mut command = jabuka();
        command.current_dir(place.0.path()).args(["export", "scene.toml", "-o", name]);
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains(&format!("`{name}` would be overwritten")), "{}", stderr(&output));
    }
    assert_eq!(fs::read_to_string(place.path("run.csv")).unwrap(), csv);
}

#[test]
fn an_exported_run_drives_the_same_bodies() {
    let scene = "
        [simulation]
        duration = 1
        frame_rate = 50
        integrator = 'rk4'
        gravity = [0, -9.81, 0]
        [body.brick]
        shape.box.size = [1, 2, 0.5]
        velocity = [1, 4, 0]
        angular_velocity = [1, 5, 0.1]
        [body.\"the ball\"]
        shape.sphere.radius = 0.2
        location = [0, 0, 3]
        velocity = [0, 5, 0]
        ";
    let driven = "
        simulation.duration = 1
        simulation.frame_rate = FRAME_RATE
        [defaults.body.motion.trajectory]
        file = 'run.csv'
        [body.brick]
        shape.box.size = [1, 2, 0.5]
        [body.other]
        shape.sphere.radius = 0.2
        motion.trajectory.body = 'the ball'
        ";
    let place = Place::new(&[
        ("scene.toml", scene),
        ("same.toml", &driven.replace("FRAME_RATE", "50")),
        ("between.toml", &driven.replace("FRAME_RATE", "100")),
    ]);
    let export = |scene: &str, file: &str| {
        let output =
            jabuka().current_dir(place.0.path()).args(["export", scene, "-o", file]).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output)
    };
    assert_eq!(export("scene.toml", "run.csv"), "run.csv: 102 rows, 51 times of 2 bodies\n");
    let run = fs::read_to_string(place.path("run.csv")).unwrap();
    assert!(run.starts_with("t [s],body,x [m],y [m],z [m],qx,qy,qz,qw,vx [m/s],"), "{run}");

    let original: Vec<Frame> = Frames::new(&place.read("scene.toml")).map(Result::unwrap).collect();
    let again: Vec<Frame> = Frames::new(&place.read("same.toml")).map(Result::unwrap).collect();
    for (a, b) in original.iter().zip(&again) {
        for (a, b) in a.bodies.iter().zip(&b.bodies) {
            assert_eq!(a.location, b.location);
            assert!(
                a.velocity.abs_diff_eq(b.velocity, 1e-13)
                    && a.angular_velocity.abs_diff_eq(b.angular_velocity, 1e-13)
            );
            assert!(a.orientation.dot(b.orientation).abs() > 1.0 - 1e-15);
        }
    }
    // Locations between the rows are exact as well: the path of a free flight is a parabola, which cubic interpolation reproduces.
    let between: Vec<Frame> = Frames::new(&place.read("between.toml")).map(Result::unwrap).collect();
    let y = |t: f64| 5.0 * t - 9.81 * t * t / 2.0;
    for frame in &between {
        assert!((frame.bodies[1].location.y - y(frame.time)).abs() < 1e-12, "{}", frame.time);
    }
    // Exporting the driven scene gives the same table, up to rounding.
    export("same.toml", "again.csv");
    assert_eq!(run.lines().count(), fs::read_to_string(place.path("again.csv")).unwrap().lines().count());
    assert_eq!(fs::read_dir(place.0.path()).unwrap().count(), 5, "nothing is left over");
}

#[test]
fn files_of_others_are_read_by_the_names_of_their_columns_and_their_units() {
    let scene = "
        [simulation]
        duration = 2
        frame_rate = 1
        [body.probe]
        shape.sphere.radius = 1
        [body.probe.motion.trajectory]
        file = 'data.csv'
        interpolation = 'linear'
        columns = { time = 'Zeit', location = ['Ost', 'hoch', 'z'] }
        ";
    let data = "# measured on a Tuesday\nZeit (ms);z [cm];Ost [km];hoch\n0; 100 ;1;7\n2000;300;3;9\n";
    let place = Place::new(&[("scene.toml", scene), ("data.csv", data)]);
    let frames: Vec<Frame> = Frames::new(&place.read("scene.toml")).map(Result::unwrap).collect();
    let middle = frames[1].bodies[0];
    assert_eq!(middle.location, DVec3::new(2000.0, 8.0, 2.0));
    assert_eq!(middle.velocity, DVec3::new(1000.0, 1.0, 1.0));
}

#[test]
fn mistakes_in_a_file_are_said_where_they_are_all_in_one_run() {
    let scene = "
        [defaults.body.shape.sphere]
        radius = 1
        [body.a.motion.trajectory]
        file = 'number.csv'
        [body.b.motion.trajectory]
        file = 'order.csv'
        [body.c.motion.trajectory]
        file = 'column.csv'
        [body.d.motion.trajectory]
        file = 'unit.csv'
        [body.e.motion.trajectory]
        file = 'body.csv'
        [body.f.motion.trajectory]
        file = 'empty.csv'
        [body.g.motion.trajectory]
        file = 'short.csv'
        ";
    let place = Place::new(&[
        ("scene.toml", scene),
        ("number.csv", "t,x,y,z\n0,1,2,3\n1,1,two,3\n2,1,,nan\n"),
        ("order.csv", "t,body,x,y,z\n0,b,1,2,3\n1,other,1,2,3\n0.5,b,1,2,3\n0.5,b,1,2,3\n0.4,b,0,0,0\n"),
        ("column.csv", "t,x,why,z\n0,1,2,3\n"),
        ("unit.csv", "t [s],x [m],y [px],z [m]\n0,1,2,3\n"),
        ("body.csv", "t,body,x,y,z\n0,ee,1,2,3\n"),
        ("empty.csv", "t,x,y,z\n"),
        ("short.csv", "t,x,y,z\n0,1,2\n"),
    ]);
    let said = place.errors("scene.toml");
    for expected in [
        "error[csv-number]: expected a number, found `two`\n --> number.csv:3:5",
        "expected a number, found nothing\n --> number.csv:4:5",
        "expected a number, found `nan`\n --> number.csv:4:6",
        "error[csv-order]: this time comes twice: 0.5 s after 0.5 s\n --> order.csv:5:1",
        "the time goes backwards: 0.4 s after 0.5 s\n --> order.csv:6:1",
        "error[csv-column]: there is no column `y`\n --> column.csv:1:1",
        "error[csv-unit]: the unit `px` is not known here\n --> unit.csv:1:13",
        "error[csv-body]: the file has no rows of the body `e`\n",
        "error[csv-syntax]: the file has no rows under its header\n --> empty.csv:2:1",
        "expected a number, found the end of the row\n --> short.csv:2:6",
    ] {
        assert!(said.contains(expected), "{expected}\n\n{said}");
    }
}

#[test]
fn a_thousand_times_of_a_hundred_bodies_drive_a_hundred_bodies() {
    let mut table = String::from("t [s],body,x [m],y [m],z [m]\n");
    for time in 0..1000 {
        for body in 0..100 {
            writeln!(
                table,
                "{},dot[{body}],{body},{},0",
                f64::from(time) / 100.0,
                f64::from(time * body) / 1e4
            )
            .unwrap();
        }
    }
    let scene = "
        simulation = { duration = 9.99, frame_rate = 100 }
        [body.dot]
        shape.sphere.radius = 0.3
        motion.trajectory = { file = 'dots.csv', interpolation = 'linear' }
        repeat = 100
        ";
    let place = Place::new(&[("scene.toml", scene), ("dots.csv", &table)]);
    let last = Frames::new(&place.read("scene.toml")).last().unwrap().unwrap();
    assert_eq!((last.index, last.bodies.len()), (999, 100));
    let off = |body: usize| {
        (last.bodies[body].location - DVec3::new(body as f64, 0.0999 * body as f64, 0.0)).length()
    };
    assert!((0..100).all(|body| off(body) < 1e-12));
}

/// Further columns of a file are measures of its bodies: between two rows on a straight line, in the unit of the header.
#[test]
fn further_columns_of_a_file_are_measures() {
    let file = "t,body,x,y,z,epot [eV],bonds,kinetic,note\n\
                0,atom[0],0,0,0,-1,2,7,a\n0,atom[1],3,0,0,-3,4,7,b\n\
                1,atom[0],1,0,0,-2,4,7,a\n1,atom[1],3,0,0,-7,,7,b\n\
                2,atom[0],2,0,0,-2,6,7,a\n2,atom[1],3,0,0,-7,8,7,b\n";
    let scene = "
        simulation = { duration = 2, frame_rate = 4 }
        [body.atom]
        shape.sphere.radius = 0.5
        mass = 2
        repeat.count = 2
        motion.trajectory.file = 'run.csv'
        material.color.map = { of = 'epot', range = [-8e-19, 0], bar = false }
        [label.one]
        text = '${atom[0].epot:.6 eV} ${atom[1].bonds:.3} ${sum(atom.epot):.6 eV} ${atom[0].kinetic:.3}'
        [label.own]
        body = 'atom[0]'
        text = '${epot}'
        [plot.p]
        y = ['atom[1].epot:eV', 'atom[1].bonds']
        corner = 'top-right'
        ";
    let place = Place::new(&[("scene.toml", scene), ("run.csv", file)]);
    let scene_read = place.read("scene.toml");
    let run = Run::new(&scene_read).unwrap();
    let said = |frame: &Frame, name: &str| {
        let texts = run.emitter().plan().texts(frame);
        texts.iter().find(|text| text.name == name).unwrap().says.replace('−', "-")
    };
    let frames: Vec<Frame> = run.frames().map(Result::unwrap).collect();
    // The measure of the program has precedence over a column of the same name: ½ · 2 kg · (1 m/s)².
    assert_eq!(said(&frames[2], "one"), "-1.500000 eV ? -6.500000 eV 1.000");
    assert_eq!(said(&frames[4], "one"), "-2.000000 eV ? -9.000000 eV 1.000");
    assert_eq!(said(&frames[8], "one"), "-2.000000 eV 8.000 -9.000000 eV 1.000");
    // −2 eV in J.
    assert_eq!(said(&frames[8], "own"), "-3.2·10⁻¹⁹");
    let curves = &run.survey().curves;
    assert!(curves[0].iter().filter_map(|point| point.at).all(|[t, epot]| {
        let expected = (-3.0 - 4.0 * t).max(-7.0);
        (epot - expected).abs() < 1e-9
    }));
    let drawn: Vec<f64> = curves[1].iter().filter_map(|point| Some(point.at?[0])).collect();
    assert_eq!(drawn, [0.0, 2.0], "a row without a number leaves a gap");
    let colors = |frame: &Frame| run.emitter().plan().looks(frame).colors;
    assert_ne!(colors(&frames[0]), colors(&frames[8]));

    // Only what the file has can be named.
    let wrong = scene.replace("atom[1].bonds:.3", "atom[1].bond:.3");
    let place = Place::new(&[("scene.toml", &wrong), ("run.csv", file)]);
    let report = Scene::from_path(place.path("scene.toml")).unwrap_err().to_string();
    assert!(report.contains("a body has no `bond` that a label could show"), "{report}");
    assert!(report.contains("did you mean `bonds`?"), "{report}");
}

#[test]
fn another_file_is_another_scene() {
    let scene = "[body.a]\nshape.sphere.radius = 1\nmotion.trajectory.file = 'a.csv'\n";
    let place = Place::new(&[("scene.toml", scene), ("a.csv", "t,x,y,z\n0,1,2,3\n")]);
    let before = place.read("scene.toml").digest;
    fs::write(place.path("a.csv"), "t,x,y,z\n0,1,2,4\n").unwrap();
    assert_ne!(place.read("scene.toml").digest, before);
}

/// Returns the camera's part of a script.
fn camera(script: &str) -> &str {
    assert_eq!(script.matches("\ncamera {").count(), 1, "{script}");
    let start = script.find("\ncamera {").unwrap();
    &script[start..start + script[start..].find("\n}").unwrap()]
}

const BALL: &str = "
    [simulation]
    duration = 1
    frame_rate = 4
    [body.ball]
    shape.sphere.radius = 0.5
    velocity = [4, 0, 0]
    ";

#[test]
fn a_camera_moves_by_formulas_keyframes_along_a_body_and_around() {
    let with = |camera: &str| scripts(&format!("{BALL}\n[camera]\n{camera}"));
    let script = with("location = ['10*t', 2, 20]\nlook_at = [0, 't', 0]\nangle = '40 - 20*t'");
    assert!(camera(&script[2]).contains("location <5, 2, 20>"), "{}", camera(&script[2]));
    assert!(camera(&script[2]).contains("look_at <0, 0.5, 0>") && camera(&script[2]).contains("angle 30"));

    let script = with(
        "keyframes.at = [{ time = 0, location = [0, 0, 9], look_at = [1, 0, 0] }, { time = 1, location = [0, 8, 9] }]",
    );
    assert!(
        camera(&script[2]).contains("location <0, 4, 9>") && camera(&script[2]).contains("look_at <1, 0, 0>")
    );

    let script = with("location = [0, 0, 10]\nlook_at = [0, 0, 0]\nfollow.body = 'ball'");
    assert!(
        camera(&script[4]).contains("location <4, 0, 10>")
            && camera(&script[4]).contains("look_at <4, 0, 0>")
    );
    let script = with("location = [0, 0, 10]\nfollow = { body = 'ball', distance = 3 }");
    assert!(camera(&script[4]).contains("location <4, 0, 3>"), "{}", camera(&script[4]));
    assert!(with("follow.body = 'ball'")[4].contains("look_at <4, 0, 0>"));

    let script = with("location = [0, 5, 10]\nlook_at = [0, 0, 0]\norbit.period = 4");
    assert!(camera(&script[4]).contains("location <10, 5, "), "{}", camera(&script[4]));

    // In the shared layout, a moving camera is written into each script.
    let shared = scripts(&format!("{BALL}\n[output]\nlayout = 'shared'\n[camera]\norbit.period = 4\n"));
    assert!(camera(&shared[1]) != camera(&shared[2]));
    let views = format!("{BALL}\n[camera]\nlocation = [0, 0, 9]\n[view.along]\nfollow.body = 'ball'\n");
    let scene = Scene::parse(&views).unwrap();
    let run = Run::new(&scene).unwrap().seen_by(&scene.views[0]).unwrap();
    let last = run.script(&run.frames().last().unwrap().unwrap()).unwrap();
    assert!(camera(&last).contains("look_at <4, 0, 0>"));
}

#[test]
fn a_light_moves_by_formulas() {
    let text = format!(
        "{BALL}\n[light.torch]\npoint.location = ['8*t', 3, 0]\n[light.sun]\nsun.direction = [0, -1, 0]\n"
    );
    let scripts = scripts(&text);
    assert!(scripts[1].contains("{ // torch\n  <2, 3, 0> color"), "{}", scripts[1]);
    assert!(scripts[2].contains("{ // torch\n  <4, 3, 0> color"));
    assert_eq!(scripts[2].matches("light_source").count(), 2);
}

/// Checks that initial values such as the rest length of a spring follow from the start of a prescribed motion.
#[test]
fn a_motion_begins_where_its_body_begins() {
    let last = frames(
        "
        simulation = { duration = 0.2, frame_rate = 10 }
        [body.hand]
        shape.sphere.radius = 0.1
        motion.formula.location = ['5 + 0*t', 0, 0]
        [body.ball]
        shape.sphere.radius = 0.1
        location = [6, 0, 0]
        [force.spring.spring]
        between = ['hand', 'ball']
        stiffness = 50
        ",
    );
    assert_eq!(last[2].bodies[1].location, DVec3::X * 6.0, "the spring is as long as it wants to be");

    let text =
        format!("{BALL}\n[body.far]\nshape.sphere.radius = 1\nmotion.formula.location = ['5 + t', 1, 0]\n");
    let followed = scripts(&format!("{text}\n[camera]\nlocation = [5, 1, 6]\nfollow.body = 'far'\n"));
    assert!(camera(&followed[4]).contains("location <6, 1, 6>"), "{}", camera(&followed[4]));
}

#[test]
fn a_view_that_says_where_it_is_stands_there() {
    let text = format!(
        "{BALL}\n[camera]\nkeyframes.at = [{{ time = 0, location = [1, 2, 9] }}, {{ time = 1, location = [1, 4, 9] }}]\n\
         [view.top]\nlocation = [0, 20, 0]\nlook_at = [0, 0, 0]\n"
    );
    let scene = Scene::parse(&text).unwrap();
    let run = Run::new(&scene).unwrap().seen_by(&scene.views[0]).unwrap();
    let last = run.script(&run.frames().last().unwrap().unwrap()).unwrap();
    assert!(camera(&last).contains("location <0, 20, 0>"), "{}", camera(&last));
}

#[test]
fn a_camera_that_passes_its_aim_goes_on_looking() {
    let scripts = scripts(&format!("{BALL}\n[camera]\nlocation = [0, 0, '4 - 8*t']\nlook_at = [0, 0, 0]\n"));
    assert!(camera(&scripts[2]).contains("look_at <0, 0, -4>"), "{}", camera(&scripts[2]));
}

#[test]
fn a_formula_whose_derivatives_are_endless_is_refused_at_its_place() {
    let terms = vec!["t*t"; 60].join(",");
    let text =
        format!("[body.a]\nshape.sphere.radius = 1\nmotion.formula.location = ['hypot({terms})', 0, 0]\n");
    let report = Scene::parse(&text).unwrap_err();
    assert!(report.to_text(false).contains("error[formula-syntax]: the derivatives of this formula"));
}

#[test]
fn what_a_file_does_not_say_is_as_the_body_says() {
    let scene = "
        simulation = { duration = 1, frame_rate = 1 }
        [body.a]
        shape.box.size = [1, 2, 3]
        orientation = [0, 0, 90]
        motion.trajectory.file = 'a.csv'
        [body.ring]
        shape.sphere.radius = 1
        repeat.ring = { count = 3, radius = 9 }
        motion.formula.location = ['t', 'i', 0]
        ";
    let place = Place::new(&[("scene.toml", scene), ("a.csv", "time,t,x,y,z\n7,0,1,2,3\n8,1,1,2,3\n")]);
    let scene = place.read("scene.toml");
    let last = Frames::new(&scene).last().unwrap().unwrap();
    assert!((last.bodies[0].orientation * DVec3::X).abs_diff_eq(DVec3::Y, 1e-15));
    // A location pattern that the motion overrides causes a warning.
    let warned = scene.warnings.to_text(false);
    assert!(warned.contains("the place that `repeat` gives to `ring[0]` has no effect"), "{warned}");
}

/// Checks that a run of prescribed motion takes no integration steps: a step of 1 ps would mean 10¹⁸ of them.
#[test]
fn motion_that_is_given_takes_no_steps_and_none_of_their_limits() {
    for method in ["integrator = 'rk4'\nstep = 1e-12", "integrator = 'gauss-radau'", "integrator = 'dop853'"]
    {
        let frames = frames(&format!(
            "[simulation]\nduration = 1e6\nframe_rate = 1e-4\n{method}\n[body.a]\nshape.sphere.radius = 1
            motion.formula.location = ['t/1000', 0, 0]"
        ));
        assert_eq!(frames.len(), 101);
        assert_eq!(frames[100].bodies[0].location, DVec3::X * 1000.0, "{method}");
    }
}
