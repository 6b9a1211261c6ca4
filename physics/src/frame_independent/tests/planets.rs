//! Tests of adaptive methods with bodies that attract each other.

use super::*;

/// Seven stars in a plane, several of which have close encounters, must reach the published positions. Source: IVP Test Set, problem PLEI.
#[test]
fn the_pleiades_are_where_the_test_set_has_them() {
    let start = [
        [3.0, 3.0, 0.0, 0.0],
        [3.0, -3.0, 0.0, 0.0],
        [-1.0, 2.0, 0.0, 0.0],
        [-3.0, 0.0, 0.0, -1.25],
        [2.0, 0.0, 0.0, 1.0],
        [-2.0, -4.0, 1.75, 0.0],
        [2.0, 4.0, -1.5, 0.0],
    ];
    let end = [
        [0.370_613_914_397_050_2, -3.943_437_585_517_392],
        [3.237_284_092_057_233, -3.271_380_973_972_55],
        [-3.222_559_032_418_324, 5.225_081_843_456_543],
        [0.659_709_145_577_531, -2.590_612_434_977_47],
        [0.342_558_170_715_658_4, 1.198_213_693_392_275],
        [1.562_172_101_400_631, -0.242_968_234_493_582_4],
        [-0.700_309_292_221_249_5, 1.091_449_240_428_98],
    ];
    for (name, tolerance) in [("gauss-radau", 1e-9), ("dop853", 1e-13)] {
        let mut world = World::new();
        let mut mass = 0.0;
        for [x, y, u, v] in start {
            mass += 1.0;
            let star = sphere(mass).with_location(DVec3::new(x, y, 0.0));
            world.add(star.with_velocity(DVec3::new(u, v, 0.0)));
        }
        attract(&mut world);
        let mut run = run(name, tolerance, 3.0, world);
        run.advance(3.0, &[], &mut |_| {}).unwrap();
        for (body, [x, y]) in run.snapshot().unwrap().bodies.iter().zip(end) {
            let off = (body.location - DVec3::new(x, y, 0.0)).length();
            assert!(off < 1e-9, "{name} {}: {off:e}", body.id);
        }
    }
}

/// Three stars follow each other along a figure of eight, and must return to their starts after a period. The initial values have eight
/// digits, which leaves an error of 3e-8. Source: A. Chenciner & R. Montgomery, Ann. Math. 152 (2000) 881.
#[test]
fn the_figure_of_eight_closes() {
    let outer = (DVec3::new(0.97000436, -0.24308753, 0.0), DVec3::new(0.466203685, 0.43236573, 0.0));
    for name in ADAPTIVE {
        let mut world = World::new();
        world.add(sphere(1.0).with_location(outer.0).with_velocity(outer.1));
        world.add(sphere(1.0).with_location(-outer.0).with_velocity(outer.1));
        world.add(sphere(1.0).with_velocity(-2.0 * outer.1));
        attract(&mut world);
        let mut run = run(name, 1e-11, 6.325_913_98, world);
        run.advance(6.325_913_98, &[], &mut |_| {}).unwrap();
        for (body, start) in run.snapshot().unwrap().bodies.iter().zip([outer.0, -outer.0, DVec3::ZERO]) {
            let off = (body.location - start).length();
            assert!(off < 1e-7, "{name} {}: {off:e}", body.id);
        }
    }
}

/// Prepares the run of a star with two planets that have a hundredth of its mass each.
fn system(name: &str, step: f64, tolerance: f64) -> Box<dyn Dynamics> {
    let method = Method::by_name(name).unwrap();
    let mut world = World::new();
    world.set_step(step);
    world.set_integrator(method);
    world.add(sphere(1.0).with_angular_velocity(DVec3::Y));
    world.add(sphere(0.01).with_location(DVec3::X * 1.0).with_velocity(DVec3::new(0.1, 0.95, 0.1)));
    world.add(sphere(0.01).with_location(DVec3::Y * -2.5).with_velocity(DVec3::new(0.6, 0.1, 0.0)));
    attract(&mut world);
    method.take_over.unwrap()(world, Accuracy { tolerance, end: 20.0 })
}

fn places(mut run: Box<dyn Dynamics>) -> Vec<DVec3> {
    run.advance(20.0, &[], &mut |_| {}).unwrap();
    run.snapshot().unwrap().bodies.iter().map(|body| body.location).collect()
}

/// The error of Wisdom–Holman must be of second order in the step: half the step gives about a quarter of the error.
#[test]
fn planets_have_an_error_of_second_order() {
    let exact = places(system("gauss-radau", 1.0, 1e-10));
    let error = |step: f64| {
        let off =
            places(system("wisdom-holman", step, 0.0)).into_iter().zip(&exact).map(|(a, b)| (a - b).length());
        off.fold(0.0, f64::max)
    };
    let errors = [0.2, 0.1, 0.05].map(error);
    for pair in errors.windows(2) {
        let slope = libm::log2(pair[0] / pair[1]);
        assert!((1.8..2.6).contains(&slope), "{slope} {errors:?}");
    }
    assert!(errors[2] < 1e-4, "{errors:?}");
}

/// A single planet must follow its exact orbit with steps of any length.
#[test]
fn a_single_planet_needs_no_short_steps() {
    let mut world = World::new();
    world.set_integrator(Method::by_name("wisdom-holman").unwrap());
    world.set_step(1.7);
    world.add(sphere(1.0));
    world.add(sphere(1e-3).with_location(DVec3::X * 0.5).with_velocity(DVec3::Y * (1.001_f64 * 3.0).sqrt()));
    attract(&mut world);
    let method = Method::by_name("wisdom-holman").unwrap();
    let end = std::f64::consts::TAU / 1.001_f64.sqrt();
    let mut run = method.take_over.unwrap()(world, Accuracy { tolerance: 0.0, end });
    run.advance(end, &[], &mut |_| {}).unwrap();
    let bodies = run.snapshot().unwrap().bodies;
    let seen = bodies[1].location - bodies[0].location;
    assert!((seen - DVec3::X * 0.5).length() < 1e-11, "{seen}");
}

/// Requested moments must not affect the run. The energy must be conserved at moments between steps as well.
#[test]
fn planets_can_be_looked_at_at_any_time() {
    let straight = places(system("wisdom-holman", 0.07, 0.0));
    let mut run = system("wisdom-holman", 0.07, 0.0);
    let momentum = run.snapshot().unwrap().balance;
    let mut t = 0.0;
    while t < 20.0 {
        let next = (t + 0.3_f64).min(20.0);
        run.advance(next, &[t + 0.11], &mut |snapshot| {
            assert!(snapshot.balance.drift.abs() < 1e-6, "{}: {:e}", snapshot.time, snapshot.balance.drift);
        })
        .unwrap();
        t = next;
    }
    let end = run.snapshot().unwrap();
    assert_eq!(end.bodies.iter().map(|body| body.location).collect::<Vec<_>>(), straight);
    let lost = (end.balance.angular_momentum - momentum.angular_momentum).length();
    assert!(
        lost < 1e-13 && (end.balance.linear_momentum - momentum.linear_momentum).length() < 1e-14,
        "{lost:e}"
    );
    assert_eq!(run.steps(), 286);
}
