//! Tests of forces that are given by formulas.

use glam::DVec3;
use jabuka::Scene;
use jabuka::physics::{METHODS, World};
use jabuka::simulate::{SimulateError, world};

use crate::common::{frames, tolerance};

/// Returns a scene for this method, with this number of steps in the given time. Its bodies have 1 kg and a radius of 0.1 m; `rest` is the
/// other text of the scene.
#[allow(clippy::panic, reason = "it is part of tests")]
fn scene(method: &str, time: f64, steps: u32, rest: &str) -> Scene {
    let step = time / f64::from(steps);
    let text = format!(
        "simulation = {{ integrator = '{method}', duration = {time:?}, frame_rate = {:?}, step = {step:?} }}
        defaults.body.shape.sphere.radius = 0.1
        defaults.body.mass = 1
        {rest}",
        1.0 / time
    );
    Scene::parse(&text).unwrap_or_else(|report| panic!("{report}"))
}

fn run(scene: &Scene, time: f64) -> World {
    let mut world = world(scene);
    // The drift is relative to the largest kinetic energy at the observed times, so observe the run once before its end.
    world.advance_to(0.25 * time);
    world.balance();
    world.advance_to(time);
    world
}

/// Checks x'' = −x³ from rest at x = 1. The period is 4 ∫₀¹ dx / √((1 − x⁴)/2) = 4 K(1/√2), by Gauss's constant 7.416298709205487.
#[test]
fn the_period_of_a_quartic_trap() {
    let (period, steps) = (7.416_298_709_205_487, 4000);
    for method in METHODS {
        let trap = "[body.b]\nlocation = [1, 0, 0]\n[force.trap.formula]\nforce = ['-x^3', 0, 0]\npotential = 'x^4/4'";
        let mut world = run(&scene(method.name, period, steps, trap), period);
        let state = world.state();
        // At the turning point the location does not change to first order, so the velocity shows an error in phase. The rate is √3 at
        // most.
        let off = state.velocity[0].length().max((state.location[0] - DVec3::X).length());
        let allowed = tolerance(method, 3.0_f64.sqrt() * period, steps);
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
        assert_eq!(state.accounts.work, 0.0, "a potential needs no account");
        assert!(world.balance().drift.abs() < allowed);
    }
}

/// Checks that a magnetic field given by formulas acts like the built-in Lorentz force.
#[test]
fn a_magnetic_field_by_formulas_is_the_lorentz_force() {
    let body = "[body.b]\ncharge = 2\nvelocity = [0.3, 1, 0.2]\n";
    let lorentz = "[force.f.lorentz]\nmagnetic = [0, 0, 3]\nelectric = [0, 0.5, 0]";
    let formula = "variables.B = 3\n[force.f.formula]\nforce = ['charge*vy*B', 'charge*(0.5 - vx*B)', 0]\n\
                   potential = '-charge*0.5*y'";
    for method in METHODS {
        let by = |force: &str| {
            // The table of variables must come before the bodies.
            let (variables, force) = force.split_once('\n').unwrap_or(("", force));
            let text = format!("{variables}\n{body}{force}");
            run(&scene(method.name, 1.0, 100, &text), 1.0)
        };
        let mut by_formula = by(formula);
        let by_lorentz = by(&format!("\n{lorentz}"));
        let off = (by_formula.state().location[0] - by_lorentz.state().location[0]).length();
        assert!(off < 1e-13, "{}: {off:e}", method.name);
        // The account holds the work of a force perpendicular to the velocity. Its error is that of the method.
        let drift = by_formula.balance().drift.abs();
        assert!(drift < tolerance(method, 6.0, 100), "{}: {drift:e}", method.name);
    }
}

/// Checks x'' = cos 3t from rest: x = (1 − cos 3t)/9, and the work equals the kinetic energy.
#[test]
fn a_force_that_depends_on_time_alone() {
    for method in METHODS {
        let steps = 400;
        let text = "[body.b]\n[force.f.formula]\nforce = ['cos(3*t)', 0, 0]";
        let mut world = run(&scene(method.name, 2.0, steps, text), 2.0);
        let exact = (1.0 - libm::cos(6.0)) / 9.0;
        let allowed = tolerance(method, 6.0, steps);
        let off = (world.state().location[0].x - exact).abs();
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
        let balance = world.balance();
        assert!(balance.accounts.work > 0.0 && balance.drift.abs() < allowed, "{}", method.name);
    }
}

/// Checks a drag m v' = −c v², with the solution v = 1/(1/v₀ + c t/m), next to a force with a potential: the account holds only the work
/// of the drag.
#[test]
fn beside_a_potential_only_what_velocity_adds_is_booked() {
    for method in METHODS {
        let steps = 400;
        let text = "[body.b]\nvelocity = [2, 0, 0]\n[force.f.formula]\nforce = ['-0.7*vx*speed', 0, '3 - 2*z']\n\
                    potential = 'z^2 - 3*z'";
        let mut world = run(&scene(method.name, 1.0, steps, text), 1.0);
        let balance = world.balance();
        let allowed = 4.0 * tolerance(method, 3.0, steps);
        assert!(balance.accounts.work < -1.0 && balance.drift.abs() < allowed, "{}", method.name);
    }
    // For a motion along x alone, the speed is |vx|.
    let text =
        "[body.b]\nvelocity = [2, 0, 0]\n[force.f.formula]\nforce = ['-0.7*vx*speed', 0, 0]\npotential = 0";
    let world = run(&scene("rk4", 1.0, 400, text), 1.0);
    let exact = 1.0 / (0.5 + 0.7);
    assert!((world.state().velocity[0].x - exact).abs() < 1e-9);
}

/// Checks that a force that becomes undefined ends the run with an error. From rest at x = 1 with x'' = −1/√x, the ball reaches x = 0
/// after 4/3 s, where the formula has no value.
#[test]
fn a_force_without_a_value_ends_the_run_and_says_where() {
    let text = "[body.other]\nlocation = [0, 5, 0]\n[body.b]\nlocation = [1, 0, 0]\n\
                [force.well.formula]\non = ['b']\nforce = ['-1/sqrt(x)', 0, 0]";
    for contacts in ["", "simulation.contacts = 'time-stepping'\nenvironment.ground = false\n"] {
        let text = format!(
            "{contacts}simulation.duration = 3\nsimulation.gravity = [0, 1, 0]\nsimulation.step = 0.01\n\
             defaults.body.shape.sphere.radius = 0.1\n{text}"
        );
        let scene = Scene::parse(&text).unwrap();
        let error = jabuka::Run::new(&scene).err();
        let Some(jabuka::RunError::Simulate(SimulateError::Undefined(error))) = error else {
            panic!("{error:?}")
        };
        assert_eq!((&*error.force, &*error.body), ("well", "b"));
        assert!((error.time - 4.0 / 3.0).abs() < 0.05, "{}", error.time);
        assert!(error.why.1.contains("square root"), "{error}");
        let (span, sources) = (error.place.0.unwrap(), &error.place.1);
        assert!(sources.raw(span).contains("sqrt(x)"));
    }
}

/// Checks that a formula acts on particles as on bodies, and that copies made by `repeat` are evaluated one by one.
#[test]
fn particles_and_copies_feel_a_formula() {
    let text = "simulation = { duration = 1, frame_rate = 1, step = 0.01, integrator = 'rk4' }
        [body.b]\nshape.sphere.radius = 0.1\nmass = 0.5\nlocation = [2, 0, 0]\n
        [emitter.e]\nshape.sphere.radius = 0.1\nmass = 0.5\nfrom.point = [2, 0, 0]\nburst = 1\nspeed = 0\ndirection = [0, 1, 0]
        [force.f.formula]\nforce = ['-mass*4*x', 'mass*t', 0]";
    let frames = frames(text);
    let last = frames.last().unwrap();
    let exact = DVec3::new(2.0 * libm::cos(2.0), 1.0 / 6.0, 0.0);
    for place in [last.bodies[0].location, last.particles[0][0].location] {
        assert!((place - exact).length() < 1e-7, "{place}");
    }
}
