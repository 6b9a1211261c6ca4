//! Tests of whole runs.

use super::*;

const TUMBLE: &str = "
    [simulation]
    duration = 1
    gravity = [0, -9.81, 0]
    [body.box]
    shape.box.size = [3, 1, 2]
    angular_velocity = [0.1, 0.2, 5]
    torque = [1, 0, 0]
    ";

#[test]
fn a_run_after_a_reset_is_the_first_run_bit_for_bit() {
    for method in crate::physics::METHODS {
        let set = crate::scene::Override::new(format!("simulation.integrator={}", method.name));
        let options = crate::scene::Options { overrides: vec![set], ..Default::default() };
        let scene = Scene::parse_with(TUMBLE, &options).unwrap();
        let mut frames = Frames::new(&scene);
        let first: Vec<Frame> = frames.by_ref().map(Result::unwrap).collect();
        assert_eq!(first.len(), 26);
        assert_ne!(first[0].bodies, first[25].bodies);
        frames.reset();
        assert_eq!(frames.map(Result::unwrap).collect::<Vec<_>>(), first, "{}", method.name);
    }
}

/// A brick as a single box, and as two halves in rotated body axes, must tumble in the same way.
#[test]
fn a_compound_tumbles_as_the_solid_that_it_makes_up() {
    let tumble = |shape: &str, orientation: &str| {
        let text = format!(
            "
            [simulation]
            duration = 2
            integrator = 'rk4'
            [body.brick]
            mass = 2
            angular_velocity = [0.3, 0.2, 3]
            torque = [0.1, 0, 0]
            shape.{shape}
            orientation = {orientation}
            "
        );
        let scene = Scene::parse(&text).unwrap();
        let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
        (frames[0].bodies[0], frames[50].bodies[0])
    };
    let turn = glam::DQuat::from_rotation_z(30f64.to_radians());
    let (_, whole) = tumble("box.size = [3, 1, 2]", "[0, 0, 30]");
    let half = |x: f64| {
        let place = turn * glam::DVec3::new(x, 0.0, 0.0) + 5.0;
        format!("{{ box.size = [1.5, 1, 2], orientation = [0, 0, 30], location = {place} }}")
    };
    let parts = format!("compound.parts = [{}, {}]", half(-0.75), half(0.75));
    let (first, halves) = tumble(&parts, "[0, 0, 0]");
    assert!(first.orientation.abs_diff_eq(glam::DQuat::IDENTITY, 1e-15), "{}", first.orientation);
    assert!(halves.angular_velocity.abs_diff_eq(whole.angular_velocity, 1e-9));
    let whole = whole.orientation * turn.conjugate();
    assert!((halves.orientation.dot(whole).abs() - 1.0).abs() < 1e-9, "{whole} {}", halves.orientation);
}

#[test]
fn a_run_of_the_callers_own_dynamics_is_not_simulated_again_with_those_of_the_scene() {
    let text = "simulation = { duration = 1, frame_rate = 10 }\n[body.ball]\nshape.sphere.radius = 1";
    let scene = Scene::parse(text).unwrap();
    let moving = Scene::parse(&format!("{text}\nvelocity = [1, 0, 0]")).unwrap();
    let recorded = Recorded::of(&scene, Box::new(world(&moving))).unwrap();
    assert_eq!(recorded.at(0.5).unwrap().frame.bodies[0].velocity.x, 1.0);
    let refused = recorded.at(0.55).map(|exposure| exposure.frame.bodies[0].location);
    assert!(matches!(refused, Err(SimulateError::Recording(_))), "{refused:?}");
    assert!(Recorded::new(&scene).unwrap().at(0.55).is_ok());
}

/// At half the speed, every other frame is one of the usual frames, bit for bit. The frames between them differ by the error of interpolation.
#[test]
fn the_speed_of_the_film_does_not_change_the_motion() {
    let ball = "gravity = [0, -9.81, 0]\n[body.ball]\nshape.sphere.radius = 0.2\nlocation = [0, 0.5, 0]\nvelocity = [1, 0, 0]\n";
    let bob = "joint.string.rod.between = [[0, 2, 0], 'ball']\n";
    for (first, last) in [
        ("contacts = 'event-driven'\n", ""),
        ("contacts = 'time-stepping'\n", ""),
        ("integrator = 'explicit-euler'\n", bob),
        ("integrator = 'dop853'\n", ""),
    ] {
        let run = |speed: &str| -> Vec<Frame> {
            let text = format!("{last}output.speed = {speed}\n[simulation]\nduration = 1\n{first}{ball}");
            let scene = Scene::parse(&text).unwrap();
            let live: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
            let recorded = Recorded::new(&scene).unwrap();
            let read: Vec<Frame> = recorded.frames().map(Result::unwrap).collect();
            assert_eq!(live, read, "{first}");
            live
        };
        let (usual, slow) = (run("1"), run("0.5"));
        assert_eq!([usual.len(), slow.len()], [26, 51]);
        for (usual, slow) in usual.iter().zip(slow.iter().step_by(2)) {
            assert_eq!((usual.time, &usual.bodies), (slow.time, &slow.bodies), "{first}");
        }
        let varied = run("[[0.2, 1], [0.5, 0.1], [0.8, 1]]");
        for (before, after) in varied.iter().zip(&varied[1..]) {
            let moved = after.bodies[0].location - before.bodies[0].location;
            let passed = after.time - before.time;
            assert!(passed > 0.0 && moved.length() < 12.0 * passed, "{first}: {passed}");
        }
    }
}

#[test]
fn frames_know_their_time_and_the_forces() {
    let scene = Scene::parse(TUMBLE).unwrap();
    let last = Frames::new(&scene).last().unwrap().unwrap();
    assert_eq!((last.index, last.time), (25, 1.0));
    assert_eq!(last.bodies[0].force, glam::DVec3::new(0.0, -9.81, 0.0));
}

#[test]
fn a_run_that_leaves_the_numbers_ends_there() {
    let text = "
        simulation.integrator = 'explicit-euler'
        [body.far]
        shape.sphere.radius = 1
        location = [1, 0, 0]
        [force.spring]
        spring = { between = ['far', [0, 0, 0]], stiffness = 1e50, rest_length = 0 }
        ";
    let scene = Scene::parse(text).unwrap();
    let frames: Vec<_> = Frames::new(&scene).collect();
    let Some(Err(SimulateError::Diverged(diverged))) = frames.last() else {
        panic!("the run did not diverge")
    };
    assert_eq!(diverged.body, "far");
    assert!(frames.len() < 251 && frames[..frames.len() - 1].iter().all(Result::is_ok));
}

/// The report of a run that diverges points to the one force that causes it, and recommends a shorter step only where that helps.
#[test]
fn a_run_that_diverges_says_why() {
    let said = |text: &str| {
        let scene = Scene::parse(text).unwrap();
        let last = Frames::new(&scene).last().unwrap();
        last.unwrap_err().report().to_string()
    };
    let ball = "[body.ball]\nshape.sphere.radius = 1\nlocation = [1, 0, 0]\n";
    for force in ["1e300", "1e150"] {
        let report = said(&format!("{ball}[force.wind.formula]\nforce = ['{force}', 0, 0]"));
        assert!(report.contains("at t = 0.04 s `ball`") && report.contains(":4:8"), "{report}");
        assert!(report.contains("the force `wind` acts on `ball` with 1.0e"), "{report}");
        assert!(!report.contains("step"), "{report}");
    }
    let report = said(&format!("simulation.gravity = [0, -1e100, 0]\n{ball}"));
    assert!(report.contains("gravity acts on `ball`") && !report.contains("step"), "{report}");
    let spring = "spring = { between = ['ball', [0, 0, 0]], rest_length = 0, stiffness = ";
    let head = "simulation.integrator = 'velocity-verlet'\nsimulation.step = 0.01\n";
    let report = said(&format!("{head}{ball}[force.s]\n{spring} 1e9 }}"));
    assert!(report.contains("a smaller `simulation.step` helps: with "), "{report}");
    let report = said(&format!("{head}{ball}[force.s]\n{spring} 1e50 }}"));
    assert!(report.contains("the force `s`") && !report.contains("step"), "{report}");
    // A spring at rest pulls only after the first step.
    let report = said(&format!(
        "{head}{}[force.s]\n{} 1e50 }}",
        ball.replace("radius = 1", "radius = 1\nvelocity = [1, 0, 0]"),
        spring.replace("rest_length = 0, ", "")
    ));
    assert!(
        report.contains("at t = 0.01 s, the force `s` acts") && !report.contains("simulation.step"),
        "{report}"
    );
    // Such a force sends the ball beyond all bounds in a finite time.
    let report = said(&format!("{head}{ball}[force.s.formula]\nforce = ['1e3 * x^3', 0, 0]"));
    assert!(!report.contains("helps"), "{report}");
}

mod between_frames {
    use super::*;
    use crate::physics::METHODS;
    use crate::scene::{Options, Override, Shutter};

    const SCENE: &str = "
        [simulation]
        duration = 0.4
        gravity = [0, -9.81, 0]
        step = 0.007
        [body.box]
        shape.box.size = [3, 1, 2]
        angular_velocity = [0.1, 0.2, 5]
        ghosts.every = 0.03
        [body.ball]
        shape.sphere.radius = 1
        location = [9, 0, 0]
        trail.duration = 0.1
        [force.air.drag]
        quadratic = 0.3
        [force.spring.spring]
        between = ['box', 'ball']
        stiffness = 50
        [camera]
        shutter = 0.035
        samples = 5
        ";

    fn scenes() -> impl Iterator<Item = Scene> {
        METHODS.iter().map(|method| {
            let overrides = vec![Override::new(format!("simulation.integrator={}", method.name))];
            Scene::parse_with(SCENE, &Options { overrides, ..Options::default() }).unwrap()
        })
    }

    /// Compares positions, velocities, energies, momenta, drift, ghosts and trails.
    #[test]
    fn a_recording_gives_the_frames_of_the_run_bit_for_bit_and_nobody_changes_it_by_looking() {
        for scene in scenes() {
            let live: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
            let recorded = Recorded::new(&scene).unwrap();
            let frames: Vec<Frame> = recorded.frames().map(Result::unwrap).collect();
            assert_eq!(frames, live, "{}", scene.simulation.method.name);
            let unseen = Scene::parse_with(
                &SCENE
                    .replace("ghosts.every = 0.03", "")
                    .replace("shutter = 0.035", "")
                    .replace("samples = 5", ""),
                &Options {
                    overrides: vec![Override::new(format!(
                        "simulation.integrator={}",
                        scene.simulation.method.name
                    ))],
                    ..Options::default()
                },
            )
            .unwrap();
            for (frame, plain) in frames.iter().zip(Frames::new(&unseen)) {
                let plain = plain.unwrap();
                assert_eq!((&frame.bodies, frame.balance), (&plain.bodies, plain.balance));
            }
        }
    }

    #[test]
    fn moments_are_evenly_spread_over_the_time_that_the_shutter_is_open() {
        for scene in scenes() {
            let recorded = Recorded::new(&scene).unwrap();
            let shutter = scene.camera.shutter.unwrap();
            let exposures: Vec<Exposure> =
                recorded.exposures(&Selection::first(11)).map(Result::unwrap).collect();
            assert_eq!(exposures.len(), 11);
            for exposure in &exposures {
                let moments: Vec<Frame> = exposure.moments(shutter).map(Result::unwrap).collect();
                let times: Vec<f64> =
                    moments.iter().map(|moment| moment.time - exposure.frame.time).collect();
                let near = |(time, expected): (&f64, f64)| (time - expected).abs() < 1e-12;
                assert!(times.iter().zip([0.0035, 0.0105, 0.0175, 0.0245, 0.0315]).all(near), "{times:?}");
                assert!(moments.iter().all(|moment| moment.index == exposure.frame.index));
            }
            // The frame from a sequence of frames must equal the frame computed alone.
            let alone = recorded.at(exposures[4].frame.time).unwrap();
            assert_eq!(alone.frame, exposures[4].frame);
            let of = |exposure: &Exposure| exposure.moments(shutter).map(Result::unwrap).collect::<Vec<_>>();
            assert_eq!(of(&alone), of(&exposures[4]));
        }
    }

    /// At a tenth of the speed, a shutter that is open for half of each frame is open for a tenth of the simulated time.
    #[test]
    fn slow_motion_has_less_blur() {
        let scene = "simulation = { duration = 0.4, frame_rate = 10 }\noutput.speed = [[0.1, 1], [0.2, 0.1]]
            [body.ball]\nshape.sphere.radius = 1\n[camera]\nshutter = 0.05\nsamples = 2";
        let scene = Scene::parse(scene).unwrap();
        let recorded = Recorded::new(&scene).unwrap();
        let shutter = scene.camera.shutter.unwrap();
        let spans: Vec<f64> = recorded
            .exposures(&Selection::first(1000))
            .map(|exposure| {
                let times: Vec<f64> =
                    exposure.unwrap().moments(shutter).map(|moment| moment.unwrap().time).collect();
                times[1] - times[0]
            })
            .collect();
        assert_eq!(spans.len(), scene.simulation.timeline.frames());
        let [first, last] = [spans[0], spans[spans.len() - 1]];
        assert!((first - 0.025).abs() < 1e-12 && (last - 0.0025).abs() < 1e-12, "{spans:?}");
    }

    /// A uniformly rotating body has the orientation of the exact motion at every moment, with every method except explicit Euler.
    #[test]
    fn moments_are_states_of_the_motion_and_not_something_between() {
        for method in METHODS.iter().filter(|method| method.name != "explicit-euler") {
            let text = format!(
                "
                simulation = {{ duration = 0.2, integrator = '{}', step = 0.001 }}
                [body.ball]
                shape.sphere.radius = 1
                velocity = [3, 0, 0]
                angular_velocity = [0, 0, 40]
                [camera]
                shutter = 0.03
                samples = 5
                ",
                method.name
            );
            let scene = Scene::parse(&text).unwrap();
            let recorded = Recorded::new(&scene).unwrap();
            let exposure = recorded.at(0.12).unwrap();
            for moment in exposure.moments(Shutter { open: 0.03, samples: 5 }) {
                let Frame { time, bodies, .. } = moment.unwrap();
                assert!((bodies[0].location.x - 3.0 * time).abs() < 1e-12);
                let expected = glam::DQuat::from_rotation_z(40.0 * time);
                // A Runge–Kutta step of 0.04 rad has an error of 0.04⁵ / 120.
                assert!((bodies[0].orientation.dot(expected).abs() - 1.0).abs() < 1e-9, "at {time}");
            }
        }
    }

    #[test]
    fn at_the_time_of_a_frame_there_is_the_frame_and_between_two_what_is_between() {
        for scene in scenes() {
            let recorded = Recorded::new(&scene).unwrap();
            let frames: Vec<Frame> = recorded.frames().map(Result::unwrap).collect();
            for frame in &frames {
                assert_eq!(&Frames::at(&scene, frame.time).unwrap(), frame);
                assert_eq!(&recorded.at(frame.time).unwrap().frame, frame);
            }
            // A moment that was not recorded is simulated.
            let between = recorded.at(0.21).unwrap().frame;
            assert_eq!(between, Frames::at(&scene, 0.21).unwrap());
            assert_eq!((between.index, between.time), (5, 0.21));
            let height = |frame: &Frame| frame.bodies[0].location.y;
            assert!(height(&frames[5]) > height(&between) && height(&between) > height(&frames[6]));
            // A time before the start gives the first frame; a time after the end gives the last.
            for (time, index) in [(-1.0, 0), (f64::NAN, 0), (7.0, 10)] {
                assert_eq!(&recorded.at(time).unwrap().frame, &frames[index]);
            }
        }
    }

    #[test]
    fn any_frame_can_be_read_in_any_order_also_one_body_of_it() {
        let scene = Scene::parse(SCENE).unwrap();
        let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
        let recorded = Recorded::new(&scene).unwrap();
        let mut reader = recorded.recording().read();
        for index in [7, 3, 10, 0, 4, 5] {
            assert_eq!(reader.frame(index).unwrap().bodies, frames[index].bodies);
            let (moment, body) = reader.body(index, 1).unwrap();
            assert_eq!((moment.time, body), (frames[index].time, Some(frames[index].bodies[1])));
        }
        assert!(reader.frame(11).is_err());
    }
}

#[test]
fn bodies_that_overlap_at_the_start_may_be_joined() {
    let text = "simulation = { duration = 0.1, contacts = 'event-driven', integrator = 'rk4' }\n\
                [body.post]\nshape.sphere.radius = 0.5\nlocation = [0, 1, 0]\n\
                [body.lever]\nshape.sphere.radius = 0.5\nlocation = [0.8, 1, 0]\n";
    let first = |text: &str| Frames::new(&Scene::parse(text).unwrap()).next().unwrap().map(|_| ());
    let said = first(text).unwrap_err().report().to_string();
    assert!(said.contains("overlap-at-start") && said.contains("join them"), "{said}");
    let joined = text.to_owned()
        + "[joint.j.hinge]\nbetween = ['post', 'lever']\nat = [0.4, 1, 0]\naxis = [0, 0, 1]\n";
    assert!(first(&joined).is_ok());
}
