//! Each measure has the same value wherever it is said: in a label, in a plot, and in the tables that have it.

use jabuka::Run;
use jabuka::export::{write_csv, write_joints};
use jabuka::scene::{BodyMeasure, JointMeasure, RunMeasure, Scene};
use jabuka::simulate::Selection;

/// A crate hangs on a hinge, a bead slides on a rod, and a ball falls onto the ground and rebounds.
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
    [joint.hook.hinge]
    between = [[0, 0, 0], 'crate']
    axis = [0, 0, 1]
    motor = { speed = 3, torque = 5 }
    [joint.rail.slider]
    between = [[-2, 0, 0], 'bead']
    axis = [1, -1, 0]
    ";

/// Returns the names of all measures of the scene.
fn names(scene: &Scene) -> Vec<String> {
    let mut names: Vec<String> = RunMeasure::ALL.iter().map(|(name, ..)| (*name).to_owned()).collect();
    names.extend(BodyMeasure::ALL.iter().map(|(name, ..)| format!("ball.{name}")));
    for joint in &scene.joints {
        let its = JointMeasure::names().filter(|(_, measure)| measure.is_of(&joint.kind));
        names.extend(its.map(|(name, _)| format!("joint.{}.{name}", joint.name)));
    }
    names
}

#[test]
fn each_measure_has_one_value_in_labels_plots_and_tables() {
    let names = names(&Scene::parse(SCENE).unwrap());
    let mut text = SCENE.to_owned();
    for (number, name) in names.iter().enumerate() {
        text += &format!("[label.l{number}]\ntext = '${{{name}:.9}}'\n[plot.p{number}]\ny = '{name}'\n");
    }
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
    // The values are no accident: the ball has fallen 0.3 m, has rebounded once, and still turns.
    assert_eq!(value("ball.impacts"), 1.0);
    assert!(value("ball.spin") > 1.0 && value("joint.hook.motor") != 0.0);

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
}
