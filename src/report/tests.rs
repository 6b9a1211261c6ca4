//! Tests of reports about runs with a known solution.

use glam::DVec3;

use super::*;
use crate::simulate::{SimulateError, Snapshots};

fn scene(text: &str) -> Scene {
    Scene::parse(text).unwrap()
}

fn assessed(scene: &Scene, accuracy: f64) -> (Assessment, Verdict) {
    let assessment = assess(scene, accuracy, &mut |_, _| true).unwrap();
    let verdict = assessment.verdict.clone().unwrap();
    (assessment, verdict)
}

/// Makes a scene with a mass of 1 kg on a spring of 4 N/m. The mass starts at 1 m from the anchor with 2 m/s sideways, so its orbit is a
/// circle with the angular frequency ω = 2 rad/s.
fn oscillator(integrator: &str, step: f64) -> Scene {
    scene(&format!(
        "simulation = {{ duration = 6, step = {step}, integrator = '{integrator}' }}\n\
         [body.anchor]\nshape.sphere.radius = 0.1\nfixed = true\n\
         [body.mass]\nshape.sphere.radius = 0.1\nmass = 1\nlocation = [1, 0, 0]\nvelocity = [0, 0, -2]\n\
         [force.spring.spring]\nbetween = ['anchor', 'mass']\nstiffness = 4\nrest_length = 0\n"
    ))
}

fn on_circle(time: f64) -> DVec3 {
    DVec3::new(libm::cos(2.0 * time), 0.0, -libm::sin(2.0 * time))
}

/// Makes a scene with a planet around a fixed sun with GM = 1. The orbit has the semi-major axis 1 and the eccentricity 0.5.
fn kepler(integrator: &str, step: f64) -> Scene {
    scene(&format!(
        "simulation = {{ duration = 12.6, step = {step}, integrator = '{integrator}' }}\n\
         [body.sun]\nshape.sphere.radius = 0.01\nmass = 1\nfixed = true\n\
         [body.planet]\nshape.sphere.radius = 0.01\nmass = 1e-3\nlocation = [0.5, 0, 0]\n\
         velocity = [0, {:?}, 0]\n[force.pull.gravitation]\nconstant = 1\n",
        3.0_f64.sqrt()
    ))
}

/// Returns the exact position of the planet in [`kepler`]'s scene, by Kepler's equation E − e sin E = t.
fn on_ellipse(time: f64) -> DVec3 {
    let mut anomaly = time;
    for _ in 0..50 {
        anomaly -= (anomaly - 0.5 * libm::sin(anomaly) - time) / (1.0 - 0.5 * libm::cos(anomaly));
    }
    DVec3::new(libm::cos(anomaly) - 0.5, 0.75_f64.sqrt() * libm::sin(anomaly), 0.0)
}

/// Returns the largest distance of a body from its exact position during a run.
fn true_error(scene: &Scene, body: usize, truth: fn(f64) -> DVec3) -> f64 {
    let distance = |at: Result<_, SimulateError>| {
        let at: crate::physics::Snapshot = at.unwrap();
        (at.body(body).unwrap().location - truth(at.time)).length()
    };
    Snapshots::new(scene).map(distance).fold(0.0, f64::max)
}

#[test]
fn the_estimated_error_is_the_true_one_within_a_factor_of_two() {
    let oscillators = ["euler-cromer", "velocity-verlet", "rk4", "yoshida4"].map(|method| {
        let step = if method == "euler-cromer" { 0.002 } else { 0.02 };
        (oscillator(method, step), on_circle as fn(f64) -> DVec3)
    });
    let orbits =
        ["velocity-verlet", "rk4", "yoshida4"].map(|method| (kepler(method, 0.004), on_ellipse as _));
    for (scene, truth) in oscillators.into_iter().chain(orbits) {
        let (_, verdict) = assessed(&scene, 1e-3);
        let (found, true_one) = (verdict.error, true_error(&scene, 1, truth));
        let name = scene.simulation.method.name;
        assert!((0.5..2.0).contains(&(found / true_one)), "{name}: {found} {true_one}");
        assert_eq!(verdict.bodies[0].body, if scene.bodies.len() == 2 { &*scene.bodies[1].name } else { "" });
        assert!(matches!(verdict.order, Order::Nominal { .. }), "{name}: {:?}", verdict.order);
    }
}

#[test]
fn what_is_recommended_reaches_the_accuracy() {
    let scene = oscillator("explicit-euler", 0.02);
    let (assessment, verdict) = assessed(&scene, 1e-3);
    // Explicit Euler multiplies the energy by the factor 1 + (ω dt)² in each step.
    let grown = libm::pow(1.0 + 0.04 * 0.04, 300.0) - 1.0;
    assert!(verdict.drift > 0.5 * grown, "{}", verdict.drift);
    assert!(!verdict.trusted.to_the_end && verdict.trusted.until.unwrap() < 1.0);
    let best = &assessment.trials[assessment.recommended.unwrap()];
    let lines = assessment.to_text("scene.toml");
    let step = best.step.unwrap();
    for line in [format!("integrator = \"{}\"", best.integrator), format!("step = {step}")] {
        assert!(lines.contains(&line), "{lines}");
    }
    let cured = oscillator(best.integrator, step);
    let size = 2.0 * (1.1 * 1.1 + 1.1 * 1.1 + 0.1 * 0.1_f64).sqrt();
    let error = true_error(&cured, 1, on_circle);
    assert!(error <= 1e-3 * size, "{} {step}: {error}", best.integrator);
    // The recommended timestep is not much smaller than necessary: one four times as long fails.
    let coarser = oscillator(best.integrator, 4.0 * step);
    assert!(true_error(&coarser, 1, on_circle) > 1e-3 * size, "{} {step}", best.integrator);
}

#[test]
fn orbits_are_regular_and_a_double_pendulum_is_chaotic() {
    for scene in [oscillator("velocity-verlet", 0.01), kepler("velocity-verlet", 0.01)] {
        let found = assessed(&scene, 1e-3).1.neighbours;
        assert!(matches!(found, Separation::Regular { .. }), "{found:?}");
    }
    let pendulum = scene(
        "simulation = { duration = 20, step = 0.004, integrator = 'rk4', gravity = [0, -9.81, 0] }\n\
         [body.upper]\nshape.sphere.radius = 0.1\nlocation = [0.5, 0.866, 0]\n\
         [body.lower]\nshape.sphere.radius = 0.1\nlocation = [1, 1.73, 0]\n\
         [joint.top.rod]\nbetween = [[0, 0, 0], 'upper']\n[joint.bottom.rod]\nbetween = ['upper', 'lower']\n",
    );
    let (assessment, verdict) = assessed(&pendulum, 1e-3);
    let Separation::Chaotic { lyapunov_time, .. } = verdict.neighbours else {
        panic!("{:?}", verdict.neighbours)
    };
    // The Lyapunov time is of the order of the period of a small oscillation, 2 s, divided by 2π.
    assert!((0.1..2.0).contains(&lyapunov_time), "{lyapunov_time}");
    assert!(assessment.untried.iter().any(|untried| untried.integrator == "yoshida4"));
}

#[test]
fn momenta_are_told_from_what_acts_from_outside() {
    let (_, orbit) = assessed(&kepler("rk4", 0.01), 1e-3);
    assert_eq!(orbit.linear_momentum, Conserved::Changed, "the sun is fixed");
    let Conserved::Kept { drift } = orbit.angular_momentum else { panic!("{:?}", orbit.angular_momentum) };
    assert!(drift > 1e-12 && drift < 1e-4, "{drift}");
    let (_, wide) = assessed(&oscillator("explicit-euler", 0.02), 1e-3);
    assert!(matches!(wide.angular_momentum, Conserved::Kept { drift } if drift > 0.1), "{wide:?}");
    let pair = scene(
        "simulation = { duration = 5, step = 0.01, integrator = 'velocity-verlet' }\n\
         [body.a]\nshape.sphere.radius = 0.1\nmass = 1\n\
         [body.b]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [1, 0, 0]\nvelocity = [0, 1, 0]\n\
         [force.spring.spring]\nbetween = ['a', 'b']\nstiffness = 4\nrest_length = 1\n",
    );
    let (_, verdict) = assessed(&pair, 1e-3);
    for found in [verdict.linear_momentum, verdict.angular_momentum] {
        assert!(matches!(found, Conserved::Kept { drift } if drift < 1e-12), "{found:?}");
    }
}

/// The contact forces of a settling body depend on the timestep, as errors do. Yet gravity and the ground change its momentum.
#[cfg(feature = "time-stepping")]
#[test]
fn gravity_and_the_ground_change_the_momentum_of_bodies_that_settle() {
    let text = "simulation = { duration = 1, gravity = [0, -9.81, 0], contacts = 'time-stepping' }\n\
                [body.b]\nshape.box.size = [0.4, 0.2, 0.2]\nlocation = [0, 0.1, 0]\n\
                repeat.grid = { count = [3, 21, 1], spacing = [1, 0.2, 0] }\n";
    let (_, resting) = assessed(&scene(text), 1e-3);
    for found in [resting.linear_momentum, resting.angular_momentum] {
        assert_eq!(found, Conserved::Changed);
    }
}

/// If gravitation is approximated with a tree of bodies, the forces of two bodies on each other are not exactly opposite, whatever the
/// timestep.
#[test]
fn a_momentum_that_the_forces_do_not_conserve_drifts() {
    let text = "simulation = { duration = 2, step = 0.01, integrator = 'velocity-verlet' }\n\
                [body.star]\nrepeat = 60\nshape.sphere.radius = 0.01\nmass = 1\n\
                location = ['uniform(-1, 1)', 'uniform(-1, 1)', 'uniform(-1, 1)']\n\
                [force.g.gravitation]\nconstant = 0.01\nsoftening = 0.2\nopening_angle = 1\n";
    let (assessment, cluster) = assessed(&scene(text), 1e-3);
    // The drift does not show errors of the tree, since it is measured with the tree's own potential.
    assert!(assessment.to_text("s.toml").contains("energy, with the potential of the tree\n"));
    let Conserved::Kept { drift } = cluster.linear_momentum else { panic!("{:?}", cluster.linear_momentum) };
    assert!(drift > 1e-9 && drift < 0.1, "{drift}");
}

/// A ball hits two others that touch, all equal and elastic. The last one leaves with the whole velocity, and the others rest. Fifty-eight more
/// balls lie far away, two of them on a rod, so that there are too many for Moreau's scheme.
#[cfg(feature = "time-stepping")]
fn three_balls(contacts: &str) -> Scene {
    let ball = "shape.sphere.radius = 0.1\nmass = 1\nrestitution = 1\nlocation";
    scene(&format!(
        "simulation = {{ duration = 1, frame_rate = 50, contacts = '{contacts}' }}\nenvironment.ground = false\n\
         [body.a]\n{ball} = [-0.5, 0, 0]\nvelocity = [1, 0, 0]\n\
         [body.b]\n{ball} = [0, 0, 0]\n[body.c]\n{ball} = [0.2, 0, 0]\n\
         [body.far]\nrepeat = 58\n{ball} = ['0.3*i', 5, 0]\n\
         [joint.far.rod]\nbetween = ['far[0]', 'far[1]']\n"
    ))
}

/// Time stepping shares the velocity among balls that touch, at every timestep. Only the other scheme shows that this is wrong.
#[cfg(feature = "time-stepping")]
#[test]
fn runs_that_share_a_mistake_converge_but_are_not_called_good() {
    let last = |time: f64| DVec3::X * (0.2 + (time - 0.3).max(0.0));
    let stepped = three_balls("time-stepping");
    let (assessment, verdict) = assessed(&stepped, 1e-2);
    let true_one = true_error(&stepped, 2, last);
    assert!(true_one > 10.0 * verdict.error && true_one > 0.1, "{true_one} {}", verdict.error);
    let Some(OtherScheme::Run { contacts, distance, agreement, .. }) = &verdict.other_scheme else {
        panic!("{:?}", verdict.other_scheme)
    };
    assert_eq!((*contacts, *agreement), ("event-driven", Agreement::Parted));
    assert!(*distance > true_one - verdict.error, "{distance} {true_one}");
    let said = assessment.to_text("s.toml");
    assert!(
        !said.contains("good") && !said.contains("point is off by") && said.contains("is wrong"),
        "{said}"
    );
    assert_eq!(assessment.recommended, None);

    let exact = three_balls("event-driven");
    let (assessment, verdict) = assessed(&exact, 1e-2);
    assert!(true_error(&exact, 2, last) < 1e-12);
    let said = assessment.to_text("s.toml");
    assert!(!said.contains("good") && verdict.other_scheme.unwrap().contradicts(0.1), "{said}");
}

/// Contacts that add energy or change angular momentum take the verdict away, whatever the comparisons say.
#[test]
fn a_broken_law_takes_the_verdict_away() {
    let (mut assessment, mut verdict) = assessed(&oscillator("velocity-verlet", 0.01), 0.01);
    assert!(verdict.is_confirmed() && !verdict.is_contradicted(1.0) && assessment.recommended.is_some());
    let broken = BrokenLaw { law: "energy", amount: 0.5, unit: "J", time: 0.25 };
    verdict.broken_laws.push(broken);
    assert!(!verdict.is_confirmed() && verdict.is_contradicted(1.0));
    (assessment.verdict, assessment.recommended) = (Some(verdict), None);
    let said = assessment.to_text("scene");
    assert!(said.contains("contacts change the energy by 0.5 J at t = 0.25 s"), "{said}");
    assert!(said.contains("first find a step at which contacts break no law"), "{said}");
    assert!(!said.contains("the estimate is good") && !said.contains("off by at most"), "{said}");
}

/// A block slides to rest over v²/2µg. Both schemes find this place, each within its own error.
#[cfg(feature = "time-stepping")]
#[test]
fn what_the_errors_of_both_schemes_explain_is_no_contradiction() {
    let slides = |contacts: &str| {
        let integrator = if contacts == "event-driven" { "velocity-verlet" } else { "euler-cromer" };
        scene(&format!(
            "simulation = {{ duration = 1, frame_rate = 50, gravity = [0, -9.81, 0], contacts = '{contacts}', \
             integrator = '{integrator}' }}\n\
             [body.a]\nshape.box.size = [0.4, 0.2, 0.4]\nmass = 1\nlocation = [0, 0.1, 0]\nvelocity = [2, 0, 0]\n\
             friction = 0.4\n"
        ))
    };
    let place = |time: f64| {
        let time = time.min(2.0 / (0.4 * 9.81));
        DVec3::new(2.0 * time - 0.2 * 9.81 * time * time, 0.1, 0.0)
    };
    for (contacts, sure) in [("event-driven", 1e-9), ("time-stepping", 0.02)] {
        let scene = slides(contacts);
        let (assessment, verdict) = assessed(&scene, 1e-3);
        let true_one = true_error(&scene, 0, place);
        assert!(true_one < sure, "{contacts}: {true_one}");
        let Some(OtherScheme::Run { agreement, distance, .. }) = verdict.other_scheme else {
            panic!("{:?}", verdict.other_scheme)
        };
        assert!(agreement != Agreement::Parted && distance < 0.02, "{contacts}: {agreement:?} {distance}");
        assert!(assessment.recommended.is_some(), "{}", assessment.to_text("s.toml"));
    }
}

#[test]
fn where_the_other_scheme_is_not_run_the_reason_is_said() {
    let text = "simulation = { duration = 0.2, gravity = [0, -9.81, 0], contacts = 'event-driven' }\n\
                [body.b]\nrepeat = 61\nshape.sphere.radius = 0.1\nlocation = ['i', 1, 0]\nrolling_friction = 0.1\n";
    let (assessment, verdict) = assessed(&scene(text), 1e-3);
    assert!(matches!(verdict.other_scheme, Some(OtherScheme::NotRun { contacts: "time-stepping", .. })));
    let said = assessment.to_text("s.toml");
    assert!(!said.contains("good") && said.contains("`time-stepping` is not compared: "), "{said}");
}

#[test]
fn where_nothing_is_integrated_that_is_said() {
    let given = "[body.a]\nshape.sphere.radius = 0.1\nmotion.formula.location = ['t', 0, 0]\n";
    let emitter = "[emitter.e]\nshape.sphere.radius = 0.1\nrate = 10\nlifetime = 1\nfrom.point = [0, 0, 0]\n";
    let still = "simulation.duration = 0\n[body.a]\nshape.sphere.radius = 0.1\n";
    for (text, expected) in [
        (given, "no body is moved by forces, so nothing is integrated"),
        (emitter, "their errors are not measured"),
        (still, "a single frame, so nothing is integrated"),
    ] {
        let assessment = assess(&scene(text), 1e-3, &mut |_, _| true).unwrap();
        assert!(assessment.verdict.is_none());
        let said = assessment.to_text("s.toml");
        assert!(said.contains(expected), "{said}");
        assert!(plot::Picture::of(&assessment, "s").is_none());
    }
}

#[test]
fn a_run_that_breaks_down_is_told_with_its_time() {
    // On a spring this stiff, explicit Euler multiplies the amplitude by about a thousand in each step.
    let text = "simulation = { duration = 20, step = 0.04, integrator = 'explicit-euler' }\n\
                [body.a]\nshape.sphere.radius = 0.1\nfixed = true\n\
                [body.b]\nshape.sphere.radius = 0.1\nmass = 1\nlocation = [1, 0, 0]\nvelocity = [0, 1, 0]\n\
                [force.s.spring]\nbetween = ['a', 'b']\nstiffness = 1e9\nrest_length = 0\n";
    let scene = scene(text);
    let (assessment, verdict) = assessed(&scene, 1e-2);
    assert!(!verdict.broken.is_empty() && !verdict.trusted.to_the_end);
    let said = assessment.to_text("s.toml");
    assert!(said.contains("is at no finite place"), "{said}");
    assert!(plot::Picture::of(&assessment, "s").is_some());
}

#[test]
fn bodies_that_rest_and_nothing_that_moves_make_no_trouble() {
    let rest = "simulation = { duration = 0.4, gravity = [0, -9.81, 0], contacts = 'event-driven', integrator = 'rk4' }\n\
                [body.a]\nshape.box.size = [1, 1, 1]\nlocation = [0, 0.5, 0]\n";
    let still = "simulation.duration = 0.4\n[body.a]\nshape.sphere.radius = 0.1\n";
    let pile = rest.replace("event-driven", "time-stepping").replace("rk4", "euler-cromer");
    let texts = if cfg!(feature = "time-stepping") { [rest, still, &pile] } else { [rest, still, rest] };
    for text in texts {
        let (assessment, verdict) = assessed(&scene(text), 1e-2);
        assert!(verdict.broken.is_empty(), "{:?}", verdict.broken);
        assert!(verdict.trusted.to_the_end, "{}", assessment.to_text("s.toml"));
    }
}

#[test]
fn somebody_may_stop_it() {
    let scene = oscillator("rk4", 0.01);
    for last in [Phase::Comparing, Phase::Trying] {
        let stopped = assess(&scene, 1e-3, &mut |phase, _| phase != last);
        assert_eq!(stopped.err(), Some(Stopped));
    }
}

#[test]
fn a_report_and_its_pictures_are_the_same_on_each_run() {
    let scene = oscillator("velocity-verlet", 0.02);
    let [one, two] = [0, 1].map(|_| assessed(&scene, 1e-3).0);
    assert_eq!(one.to_text("s"), two.to_text("s"));
    let [one, two] = [&one, &two].map(|of| plot::Picture::of(of, "A <ball> & ω").unwrap());
    assert_eq!(plot::svg(&one), plot::svg(&two));
    #[cfg(feature = "render")]
    assert_eq!(plot::png(&one).unwrap(), plot::png(&two).unwrap());
    assert!(plot::svg(&one).contains("A &lt;ball&gt; &amp; ω"));
}
