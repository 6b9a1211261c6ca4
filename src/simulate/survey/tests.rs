use glam::DVec3;

use super::*;

fn surveyed(text: &str) -> Survey {
    survey(&Scene::parse(text).unwrap(), |_| {}).unwrap()
}

#[test]
fn bounds_hold_the_whole_motion() {
    let survey = surveyed(
        "
        [simulation]
        duration = 2
        [body.ball]
        shape.sphere.radius = 0.5
        velocity = [3, 0, 0]
        [body.box]
        shape.box.size = [2, 2, 2]
        orientation = [0, 0, 45]
        location = [0, 4, 0]
        [body.floor]
        shape.plane = {}
        location = [0, -9, 0]
        ",
    );
    let Bounds { min, max } = survey.bounds().unwrap();
    assert!((min - DVec3::new(-2f64.sqrt(), -0.5, -1.0)).length() < 1e-12, "{min}");
    assert!((max - DVec3::new(6.5, 4.0 + 2f64.sqrt(), 1.0)).length() < 1e-12, "{max}");
}

#[test]
fn bounds_hold_what_is_drawn_and_planes_are_crossed_by_what_is_there() {
    let survey = surveyed(
        "
        [body.earth]
        shape.sphere.radius = 0.5
        look.scale = 10
        velocity = [1, 0, 0]
        [environment]
        ground.height = -3
        ",
    );
    let Bounds { min, max } = survey.bounds().unwrap();
    assert!((min - DVec3::splat(-5.0)).length() < 1e-12, "{min}");
    assert!((max - DVec3::new(15.0, 5.0, 5.0)).length() < 1e-12, "{max}");
    assert_eq!(survey.crossings, []);
}

#[test]
fn the_drift_is_relative_to_the_whole_run() {
    let survey = surveyed(
        "
        [simulation]
        duration = 10
        step = 0.01
        gravity = [0, -10, 0]
        [body.ball]
        shape.sphere.radius = 1
        ",
    );
    // For each kilogram: Euler–Cromer falls ½ g t dt too far, so the energy is too small by g times this distance, 5 J after 10 s. The
    // kinetic energy is then ½ (g t)² = 5000 J. Relative to the kinetic energy at the first frame, the error would be a quarter.
    assert!((survey.drift + 1e-3).abs() < 1e-9, "{}", survey.drift);
}

#[test]
fn a_scene_of_nothing_but_planes_has_no_bounds() {
    assert_eq!(surveyed("[body.floor]\nshape.plane = {}").bounds(), None);
    assert_eq!(surveyed("").bounds(), None);
}

#[test]
fn the_first_body_through_a_plane_is_named_with_its_time() {
    let survey = surveyed(
        "
        [simulation]
        duration = 2
        frame_rate = 10
        gravity = [0, -2, 0]
        [body.floor]
        shape.plane = {}
        [body.slow]
        shape.sphere.radius = 0.5
        location = [0, 1.5, 0]
        [body.fast]
        shape.sphere.radius = 0.5
        location = [2, 1.5, 0]
        velocity = [0, -3, 0]
        [body.below]                # already through, and on its way out
        shape.sphere.radius = 0.5
        location = [4, -3, 0]
        velocity = [0, -1, 0]
        [body.lying]                # touches from the start
        shape.sphere.radius = 0.5
        location = [6, 0.5, 0]
        fixed = true
        [environment]
        ground.height = -100
        ",
    );
    // 3 t + t² reaches the gap of 1 m at t = 0.303 s, so the frame at 0.4 s is the first after the passage.
    let expected =
        Crossing { plane: Some("floor".to_owned()), body: "fast".to_owned(), time: 0.4, others: 1 };
    assert_eq!(survey.crossings, [expected]);
}

#[test]
fn what_has_gone_through_a_plane_is_not_followed() {
    let survey = surveyed(
        "
        [simulation]
        duration = 10
        gravity = [0, -9.81, 0]
        [body.floor]
        shape.plane = {}
        [body.ball]
        shape.sphere.radius = 0.5
        location = [0, 2, 0]
        ",
    );
    let bounds = survey.bounds().unwrap();
    assert!(bounds.min.y > -0.2 && bounds.max.y == 2.5, "{bounds:?}");
}

#[test]
fn the_given_ground_counts_and_the_default_one_does_not() {
    let fall = "
        [simulation]
        gravity = [0, -9.81, 0]
        [body.ball]
        shape.sphere.radius = 1
        location = [0, 5, 0]
        ";
    assert_eq!(surveyed(fall).crossings, []);
    let survey = surveyed(&format!("{fall}\n[environment]\nground.height = 0"));
    assert_eq!(survey.crossings.len(), 1);
    assert_eq!(survey.crossings[0].plane, None);
}

/// Boxes that settle in stacks hardly move. Their energy error is relative to the energy that contacts took.
#[cfg(feature = "time-stepping")]
#[test]
fn a_drift_is_small_where_contacts_take_more_than_ever_moved() {
    let survey = surveyed(
        "
        [simulation]
        duration = 2
        gravity = [0, -10, 0]
        contacts = 'time-stepping'
        [body.box]
        shape.box.size = [1, 1, 1]
        location = ['2*i', '0.5 + j', 0]
        repeat.grid.count = [8, 8]
        ",
    );
    let taken = survey.contacts.unwrap();
    assert_eq!(survey.drift_scale, EnergyScale::TakenByContacts);
    assert!(survey.drift.abs() < 0.01, "{}", survey.drift);
    assert!(taken.lost > 0.0);
}

/// A rod holds a light ball, and a second rod hangs a ball of a tonne on it. With a coarse step, the length of a rod changes too much. With
/// a fine step, both rods hold.
#[cfg(feature = "time-stepping")]
#[test]
fn a_joint_that_gives_way_is_found() {
    let with_step = |step: f64| {
        surveyed(&format!(
            "
            [simulation]
            duration = 1
            step = {step}
            gravity = [0, -10, 0]
            contacts = 'time-stepping'
            [defaults.body]
            shape.sphere.radius = 0.05
            collides = false
            [body.light]
            location = [0.5, 0, 0]
            mass = 1
            [body.heavy]
            location = [1, 0, 0]
            mass = 1000
            [body.far]
            repeat = 59
            location = ['i', 20, 9]
            collides = true
            [joint.upper.rod]
            between = [[0, 0, 0], 'light']
            [joint.lower.rod]
            between = ['light', 'heavy']
            ",
        ))
    };
    let found = with_step(0.02).stretched.unwrap();
    assert!(["upper", "lower"].contains(&found.joint.as_str()) && found.gap > 0.05 * 0.5, "{found:?}");
    assert_eq!(with_step(0.0005).stretched, None);
}

#[test]
fn one_of_many_bodies_that_flies_away_counts_where_it_starts() {
    let scene = |showing: &str| {
        format!(
            "
            simulation.duration = 2
            [body.row]
            shape.sphere.radius = 0.5
            location = ['i', 0, 0]
            repeat = 9
            [body.outlier]
            shape.sphere.radius = 0.5
            location = [9, 0, 0]
            velocity = [0, 100, 0]
            {showing}
            "
        )
    };
    let survey = surveyed(&scene(""));
    let found = survey.outliers.unwrap();
    assert_eq!(found.bodies, [9]);
    let rest = found.without;
    assert_eq!((rest.seen.min, rest.seen.max), (DVec3::splat(-0.5), DVec3::new(9.5, 0.5, 0.5)));
    assert!((survey.spans.last().unwrap().seen.max.y - 200.5).abs() < 1e-9);
    // An arrow may reach beyond the box around the other bodies.
    assert_eq!(surveyed(&scene("arrows.velocity = true")).outliers, None);
}

/// The angle of a wheel at 1 turn/s goes from 180° to −180° once in a turn. Its curve has a gap there, and no line across.
#[test]
fn the_curve_of_an_angle_has_gaps_where_it_jumps_by_a_turn() {
    let survey = surveyed(
        "simulation = { duration = 3, frame_rate = 50, integrator = 'rk4' }
        [body.wheel]\nshape.sphere.radius = 0.5\nmotion.formula.orientation = [0, 0, '360*t']
        [angle.phi]\nat = [0, 0, 0]\nfrom = [1, 0, 0]\nto = { body = 'wheel', at = [1, 0, 0] }\naxis = [0, 0, 1]
        [plot.p]\ny = ['angle.phi', '0*angle.phi']",
    );
    let [phi, zero] = &survey.curves[..] else { panic!("two curves") };
    let gaps = |curve: &[CurvePoint]| curve.iter().filter(|point| point.at.is_none()).count();
    assert_eq!([gaps(phi), gaps(zero)], [3, 0]);
    for pair in phi.windows(2) {
        if let [Some([_, from]), Some([_, to])] = [pair[0].at, pair[1].at] {
            assert!((to - from - 7.2).abs() < 1e-9, "{from} to {to}");
        }
    }
}
