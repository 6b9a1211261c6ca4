//! Each measure has the same value wherever it is said: in a label, in a plot, in the colors of bodies, in SDL, in the location of a light,
//! and in the tables that have it.

use std::collections::BTreeSet;

use jabuka::Run;
use jabuka::cache::have_same_recording;
use jabuka::export::{write_csv, write_joints};
use jabuka::scene::{BodyMeasure, ColorMap, JointMeasure, Measure, Options, Scene};
use jabuka::simulate::{Frames, Measures, MomentState, Selection};

/// A crate hangs on a hinge, a bead slides on a rod, a ball falls onto the ground and rebounds, a bob hangs on a spring, and three atoms fly
/// through air. The last atom appears later.
const SCENE: &str = "
    [simulation]
    duration = 0.5
    gravity = [0, -10, 0]
    contacts = 'event-driven'
    [environment]
    ground.height = -2
    [body.ball]
    shape.sphere.radius = 0.1
    location = [3, -1.6, 0]
    velocity = [1, 0, 2]
    angular_velocity = [1, 2, 3]
    restitution = 0.8
    [body.crate]
    shape.box.size = [0.4, 0.2, 0.2]
    location = [1, 0, 0]
    [body.bead]
    shape.sphere.radius = 0.1
    location = [-2, 0, 0]
    [body.bob]
    shape.sphere.radius = 0.1
    location = [-4, 0, 1]
    velocity = [0.3, 0, 0.2]
    [body.gas]
    shape.sphere.radius = 0.1
    location = ['i', 3, 4]
    velocity = ['1 + i', 2, 'i']
    angular_velocity = ['i', 0, 1]
    start = '0.2*i'
    repeat.count = 3
    [force.pull.spring]
    between = [[-4, 1, 1], 'bob']
    stiffness = 20
    rest_length = 0.8
    [force.air.drag]
    on = ['gas']
    linear = 0.7
    [joint.hook.hinge]
    between = [[0, 0, 0], 'crate']
    axis = [0, 0, 1]
    motor = { speed = 3, torque = 5 }
    [joint.rail.slider]
    between = [[-2, 0, 0], 'bead']
    axis = [1, -1, 0]
    [angle.phi]
    at = [-4, 1, 1]
    from = [0, -1, 0]
    to = 'bob'
    [distance.h]
    between = [[0, 0, 0], 'ball']
    along = [0, 1, 0]
    [emitter.spray]
    from.point = [0, 2, 5]
    speed = 2
    rate = 123
    lifetime = 'uniform(0.1, 0.2)'
    shape.sphere.radius = 0.01
    [area.a]
    body = 'ball'
    center = [0, 0, 0]
    every = 0.13
    ";

/// Returns the names of all measures of the scene: those of the list of all measures, with names of the scene's things in it. So a measure
/// that is added to the list is tried here.
fn names(scene: &Scene) -> Vec<String> {
    let mut names = Vec::new();
    for line in Measure::listed() {
        let name = line.name;
        if let Some(measure) = name.strip_prefix("joint.NAME.") {
            for joint in &scene.joints {
                let mut its = JointMeasure::names().filter(|(_, measure)| measure.is_of(&joint.kind));
                if its.any(|(its, _)| its == measure) {
                    names.push(format!("joint.{}.{measure}", joint.name));
                }
            }
            continue;
        }
        let name = name.replace("force.NAME.BODY", "force.air.gas[1]").replace("force.NAME", "force.pull");
        let name = name.replace("angle.NAME", "angle.phi").replace("distance.NAME", "distance.h");
        let name = name.replace("area.NAME", "area.a").replace("emitter.NAME", "emitter.spray");
        let body = if name.contains('(') { "gas" } else { "ball" };
        names.push(name.replace("BODY", body).replace("OTHER", "crate"));
    }
    let of_copies = |how: &str| BodyMeasure::ALL.map(|(name, ..)| format!("{how}(gas.{name})"));
    names.extend(["sum", "mean"].into_iter().flat_map(of_copies));
    // Formulas of copies, also of other bodies and of other sums.
    names.extend(
        ["sum(0.5*gas.mass*gas.speed^2)", "max(force.air.gas.size)", "min(gas[*].distance.ball)"]
            .map(str::to_owned),
    );
    names.push("sqrt(mean((gas.x - mean(gas.x))^2))".to_owned());
    names.dedup();
    names
}

#[test]
fn each_measure_has_one_value_in_labels_plots_and_tables() {
    let names = names(&Scene::parse(SCENE).unwrap());
    let mut text = SCENE.to_owned();
    for (number, name) in names.iter().enumerate() {
        text += &format!("[label.l{number}]\ntext = '${{{name}:.9}}'\n[plot.p{number}]\ny = '{name}'\n");
        text += &format!(
            "[body.c{number}]\nshape.sphere.radius = 0.1\nfixed = true\nlocation = [50, {number}, 0]\n\
             material.color.map = {{ of = '{name}', range = [-50, 50], bar = false }}\n"
        );
    }
    for (number, name) in names.iter().enumerate() {
        text += &format!("[light.l{number}]\npoint.location = ['{name}', 0, 0]\n");
    }
    text += "[povray]\ndigits = 15\nsdl = '''\n";
    for (number, name) in names.iter().enumerate() {
        text += &format!("#declare V{number} = ${{{name}}};\n");
    }
    text += "'''\n";
    let scene = Scene::parse(&text).unwrap();
    let run = Run::new(&scene).unwrap();
    let last = run.frames().last().unwrap().unwrap();
    let plan = run.emitter().plan();
    let texts = plan.texts(&last);
    let said = |number: usize| {
        let text = texts.iter().find(|text| text.name == format!("l{number}")).unwrap();
        text.says.replace('−', "-").parse::<f64>().unwrap()
    };
    let value = |name: &str| said(names.iter().position(|known| known == name).unwrap());
    for (number, name) in names.iter().enumerate() {
        let curve = &run.survey().curves[number];
        let [time, drawn] = curve.last().unwrap().at.unwrap();
        assert!((time - last.time).abs() < 1e-12, "{name}");
        assert!(
            (drawn - said(number)).abs() < 1e-9,
            "{name}: {drawn} in the plot, {} in the label",
            said(number)
        );
    }
    let script = run.emitter().script(&last).unwrap();
    let lights = plan.lights(&last);
    for (number, name) in names.iter().enumerate() {
        let (_, rest) = script.split_once(&format!("#declare V{number} = ")).unwrap();
        let filled: f64 = rest.split(';').next().unwrap().trim().parse().unwrap();
        let off = (filled - said(number)).abs();
        assert!(off < 1e-9, "{name}: {filled} in SDL, {} in the label", said(number));
        let off = (lights[number].location.x - said(number)).abs();
        assert!(off < 1e-9, "{name}: a light is {off} m from {}", said(number));
    }
    let colors = plan.looks(&last).colors;
    // A name such as `kinetic` alone means the body that gets the color.
    let is_of_colored_body = |name: &str| BodyMeasure::ALL.iter().any(|(known, ..)| *known == name);
    for (number, name) in names.iter().enumerate().filter(|(_, name)| !is_of_colored_body(name)) {
        let body = scene.bodies.iter().position(|body| *body.name == *format!("c{number}")).unwrap();
        let expected = ColorMap::color_of(said(number), [-50.0, 50.0]).unwrap();
        assert_eq!(usize::from(colors[body]), expected, "the color of {name}, {}", said(number));
    }
    assert!(colors.iter().collect::<BTreeSet<_>>().len() > 10, "{colors:?}");
    assert!(names.len() > 120, "{}", names.len());
    // The values are no accident: the ball has fallen 0.3 m, has rebounded once, and still turns.
    assert_eq!(value("ball.impacts"), 1.0);
    assert!(value("ball.spin") > 1.0 && value("joint.hook.motor") != 0.0);
    let of_ball = glam::DVec3::from_array(["ball.wx", "ball.wy", "ball.wz"].map(value));
    assert!((of_ball.length() - value("ball.spin")).abs() < 1e-9, "{of_ball}");
    // Nothing turns the atoms, so each keeps its angular velocity.
    assert!((value("sum(gas.wx)") - 3.0).abs() < 1e-9 && (value("sum(gas.wz)") - 3.0).abs() < 1e-9);

    // The distance is the height of the ball, and the tangent of the angle is that of the way from the hook of the spring to the bob.
    assert!((value("distance.h") - value("ball.y").abs()).abs() < 1e-8);
    let bob = last.bodies.iter().find(|body| scene.bodies[body.id].name.as_ref() == "bob").unwrap();
    let [x, y, z] = (bob.location - glam::DVec3::new(-4.0, 1.0, 1.0)).to_array();
    let expected = libm::atan2((x * x + z * z).sqrt(), -y).to_degrees();
    assert!((value("angle.phi") - expected).abs() < 1e-8 && expected > 1.0, "{expected}");

    let (mut bodies, mut joints) = (Vec::new(), Vec::new());
    let selection = Selection::first(scene.simulation.timeline.frames());
    write_csv(run.recorded(), &selection, &mut bodies).unwrap();
    write_joints(run.recorded(), &selection, &mut joints).unwrap();
    for (table, thing, prefix) in
        [(&bodies, "ball", "ball"), (&joints, "hook", "joint.hook"), (&joints, "rail", "joint.rail")]
    {
        let table = std::str::from_utf8(table).unwrap();
        let header = table.lines().next().unwrap().split(',');
        let row = table.lines().rfind(|line| line.split(',').nth(1) == Some(thing)).unwrap().split(',');
        let mut compared = 0;
        for (column, entry) in header.zip(row) {
            let name = format!("{prefix}.{}", column.split(" [").next().unwrap());
            if names.contains(&name) {
                let (entry, said) = (entry.parse::<f64>().unwrap(), value(&name));
                assert!((entry - said).abs() < 1e-9, "{name}: {entry} in the table, {said} in the label");
                compared += 1;
            }
        }
        assert!(compared >= 6, "{thing}: {compared}");
    }

    // The sum over the copies is that of their rows in the table.
    let table = std::str::from_utf8(&bodies).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let time = rows.last().unwrap()[0];
    let atoms: Vec<&Vec<&str>> =
        rows.iter().filter(|row| row[0] == time && row[1].starts_with("gas[")).collect();
    assert_eq!(atoms.len(), 3);
    let mut compared = 0;
    for (column, title) in rows[0].iter().enumerate() {
        let name = format!("sum(gas.{})", title.split(" [").next().unwrap());
        if names.contains(&name) {
            let sum: f64 = atoms.iter().map(|row| row[column].parse::<f64>().unwrap()).sum();
            assert!(
                (sum - value(&name)).abs() < 2e-9,
                "{name}: {sum} in the table, {} in the label",
                value(&name)
            );
            compared += 1;
        }
    }
    assert!(compared >= 6, "{compared}");
}

/// Returns what the labels of a scene show in a frame.
fn labels(text: &str, frame: usize) -> Vec<String> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().nth(frame).unwrap().unwrap();
    run.emitter().plan().texts(&frame).iter().map(|text| text.says.to_string()).collect()
}

/// The atom `gas[i]` has the velocity i + 1 m/s, and appears at i/10 s. Only the first is there from the start on.
const ATOMS: &str = "simulation = { duration = 1, integrator = 'rk4' }
    [body.gas]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = ['10*i', 0, 0]\nvelocity = ['i + 1', 0, 0]
    start = '0.1*i'\nrepeat.count = 3
    [body.late]\nshape.sphere.radius = 0.1\nlocation = [0, 9, 0]\nstart = 0.5\nrepeat.count = 2\n";

#[test]
fn absent_bodies_are_left_out_and_nothing_has_no_mean() {
    let text =
        "[label.a]\ntext = '${sum(gas.speed)} ${mean(gas.speed)} ${max(gas[*].speed)} ${min(gas.kinetic)}'
        [label.b]\ntext = '${sum(late.speed)} ${mean(late.speed)} ${max(late.y)}'\n";
    let text = ATOMS.to_owned() + text;
    assert_eq!(labels(&text, 0), ["1 1 1 1", "0 ? ?"]);
    assert_eq!(labels(&text, 25), ["6 2 3 1", "0 0 9"]);
}

#[test]
fn a_unit_that_is_asked_for_stands_behind_the_number() {
    let text = "[label.a]\ntext = '${gas[1].speed:km/h}, ${gas[0].speed:.1f km/h}, ${sum(gas.kinetic):.3 kJ}'
        [label.b]\ntext = '${t:ms}, ${gas[0].x:cm}, ${gas[0].kinetic:.2e eV}, ${gas[0].distance.gas[1]:.0f mm}'\n";
    let text = ATOMS.to_owned() + text;
    assert_eq!(
        labels(&text, 25),
        ["7.2 km/h, 3.6 km/h, 0.014 kJ", "1000 ms, 100 cm, 6.24·10¹⁸ eV, 10800 mm"]
    );
}

/// A hinge turns at 2 rad/s; its angle is in degrees unless a unit is asked for.
#[test]
fn the_units_of_a_joint_follow_from_its_kind() {
    let text = "simulation.duration = 1
        [body.wheel]\nshape.cylinder = { radius = 1, height = 0.1 }\nangular_velocity = [0, 2, 0]
        [joint.axle.hinge]\nbetween = [[0, 0, 0], 'wheel']\naxis = [0, 1, 0]
        [label.a]\ntext = '${joint.axle.angle:.3f rad}, ${joint.axle.angle:.1f °}, ${joint.axle.speed:rpm}'
        [plot.p]\ny = 'joint.axle.speed'\n";
    assert_eq!(labels(text, 25)[0], "2.000 rad, 114.6°, 19.1 rpm");
    assert_eq!(Scene::parse(text).unwrap().plots[0].curves[0].y.unit(), Some("rad/s"));
}

#[test]
fn plots_have_the_units_that_are_asked_for_at_their_axes() {
    let text = "[plot.speed]\nx = 't:ms'\ny = ['gas[0].speed:km/h', 'max(gas.speed):km/h']
        [plot.mixed]\ny = ['gas[0].speed:km/h', 'gas[0].speed']\n";
    let scene = Scene::parse(&(ATOMS.to_owned() + text)).unwrap();
    let run = Run::new(&scene).unwrap();
    let last = run.survey().curves[1].last().unwrap().at.unwrap();
    assert!((last[0] - 1000.0).abs() < 1e-9 && (last[1] - 10.8).abs() < 1e-9, "{last:?}");
    let said = |plot: usize| -> Vec<String> {
        run.emitter().plan().planned_plots()[plot].texts.iter().map(|text| text.says.to_string()).collect()
    };
    let (speed, mixed) = (said(0), said(1));
    for words in ["km/h", "gas[0].speed", "max(gas.speed)", "500", "t (ms)"] {
        assert!(speed.iter().any(|said| said == words), "{words} is not in {speed:?}");
    }
    assert!(mixed.iter().any(|said| said == "gas[0].speed, km/h"), "{mixed:?}");
}

/// An angle between coinciding legs has an arc without a length, which POV-Ray would refuse. The arc is left out.
#[test]
fn an_angle_of_zero_has_no_arc() {
    let text = "simulation.duration = 0
        [body.ball]\nshape.sphere.radius = 0.1
        [angle.phi]\nat = [0, 0, 0]\nfrom = [0, 1, 0]\nto = [0, 2, 0]\ntext = 'zero'\n";
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let script = run.script(&run.frames().next().unwrap().unwrap()).unwrap();
    let cylinders: Vec<&str> = script.lines().filter(|line| line.trim().starts_with("cylinder {")).collect();
    for line in &cylinders {
        let points: Vec<&str> = line.split(['<', '>']).collect();
        assert_ne!(points[1], points[3], "{line}");
    }
    assert_eq!(cylinders.len(), 2, "the two legs: {cylinders:?}");
}

/// No picture changes by them: the script is that of the scene without them.
#[test]
fn formulas_that_no_picture_shows_have_the_values_of_a_plot() {
    let text = "[simulation]\nduration = 1\nframe_rate = 4\n\
                [body.ball]\nshape.sphere.radius = 0.1\nrepeat = 2\nvelocity = ['3 + i', 0, 0]\n";
    let asked = ["ball[0].speed:km/h", "max(ball.speed) - 1", "kinetic"];
    let options = Options { measures: asked.map(str::to_owned).to_vec(), ..Options::default() };
    let (scene, plain) = (Scene::parse_with(text, &options).unwrap(), Scene::parse(text).unwrap());
    let frame = Frames::new(&scene).nth(2).unwrap().unwrap();
    let measures = Measures::new(&scene);
    let now = MomentState::now(&frame);
    let values: Vec<f64> = scene.measures.iter().map(|formula| measures.value(formula, &now)).collect();
    assert!((values[0] - 10.8).abs() < 1e-9 && values[1] == 3.0, "{values:?}");
    assert_eq!(values[2], frame.balance.kinetic_of_all());
    assert_eq!(scene.measures[0].unit(), Some("km/h"));
    assert_eq!(scene.digest, plain.digest);
    let script = |scene: &Scene| Run::new(scene).unwrap().script(&frame).unwrap();
    assert_eq!(script(&scene), script(&plain));
}

#[test]
fn a_mistake_in_such_a_formula_points_into_it() {
    let text = "[body.ball]\nshape.sphere.radius = 0.1\n";
    let options = Options { measures: vec!["t + bal.speed".to_owned()], ..Options::default() };
    let report = Scene::parse_with(text, &options).unwrap_err();
    let text = report.to_text(false);
    assert!(text.contains("measure:1:5") && text.contains("did you mean `ball`?"), "{text}");
}

/// Contact forces are recorded only if something shows them.
#[test]
fn a_recording_fits_scenes_that_record_the_same() {
    let scene = |measures: &[&str], color: &str| {
        let text = format!(
            "[simulation]\ncontacts = 'event-driven'\ngravity = [0, -9.81, 0]\n[environment]\nground.height = 0\n\
             [body.ball]\nshape.sphere.radius = 0.1\nlocation = [0, 1, 0]\nmaterial.color = '{color}'\n"
        );
        let measures = measures.iter().map(|&measure| measure.to_owned()).collect();
        Scene::parse_with(&text, &Options { measures, ..Options::default() }).unwrap()
    };
    let plain = scene(&[], "red");
    assert!(have_same_recording(&plain, &scene(&["ball.speed"], "blue")));
    assert!(!have_same_recording(&plain, &scene(&["ball.impacts.ground"], "red")));
}
