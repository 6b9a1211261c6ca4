use glam::DVec3;

use super::super::super::{BodyId, Loads, Model, RigidBody, Shape, State};
use super::super::testing::loads;
use super::super::{Force, Gravitation, Moment};

const SOFTENING: f64 = 0.05;

fn part(i: usize, k: f64) -> f64 {
    (i as f64 * k).fract()
}

/// Returns the `i`-th star of a cluster that is dense in the middle.
fn star(i: usize) -> RigidBody {
    let ball = RigidBody::new(&Shape::Sphere { radius: 0.001 }, 1.0 + part(i, 0.236_067));
    let spread = DVec3::new(part(i, 0.618_033), part(i, 0.414_213), part(i, 0.732_050)) - 0.5;
    ball.with_location(10.0 * spread * spread.length_squared())
}

fn stars(count: usize) -> (Model, State) {
    world((0..count).map(star))
}

fn world(bodies: impl Iterator<Item = RigidBody>) -> (Model, State) {
    let (mut model, mut state) = (Model::default(), State::default());
    bodies.for_each(|body| model.push(&body, &mut state));
    (model, state)
}

fn among(bodies: std::ops::Range<usize>, opening_angle: Option<f64>) -> Gravitation {
    Gravitation { bodies: ids(bodies), against: None, constant: 2.0, softening: SOFTENING, opening_angle }
}

fn ids(range: std::ops::Range<usize>) -> Vec<BodyId> {
    range.map(BodyId::new).collect()
}

fn potential(force: &Gravitation, model: &Model, state: &State) -> f64 {
    force.potential(&Moment { time: 0.0, state, model })
}

/// Returns the root mean square error of the forces, relative to the root mean square of the exact forces.
fn off(loads: &Loads, exact: &Loads) -> f64 {
    let squares = |forces: &mut dyn Iterator<Item = DVec3>| forces.map(DVec3::length_squared).sum::<f64>();
    let off = squares(&mut loads.force.iter().zip(&exact.force).map(|(force, exact)| *force - *exact));
    (off / squares(&mut exact.force.iter().copied())).sqrt()
}

/// The first neglected term of the expansion is of third order in size over distance. So half the opening angle must leave about an eighth
/// of the error, or less if the errors of many nodes cancel.
#[test]
fn the_error_falls_with_the_third_power_of_the_angle() {
    let (model, state) = stars(1500);
    let exact = loads(&among(0..1500, None), &model, &state);
    let energy = potential(&among(0..1500, None), &model, &state);
    let errors = [0.8, 0.4, 0.2].map(|angle| {
        let tree = among(0..1500, Some(angle));
        let error = off(&loads(&tree, &model, &state), &exact);
        assert!(error < 1e-2 * angle * angle * angle, "{angle}: {error:e}");
        let energy = (potential(&tree, &model, &state) / energy - 1.0).abs();
        assert!(energy < 5e-3 * angle * angle * angle, "{angle}: {energy:e}");
        error
    });
    assert!(errors[1] < errors[0] / 6.0 && errors[2] < errors[1] / 6.0, "{errors:?}");
    assert!(errors[2] > 1e-8, "it is a tree: {errors:?}");
}

#[test]
fn without_an_angle_to_speak_of_it_is_the_sum_of_all_pairs() {
    for count in [0, 1, 2, 8, 9, 32, 33, 100, 257, 600] {
        let (model, state) = stars(count);
        let (tree, exact) = (among(0..count, Some(1e-6)), among(0..count, None));
        let (by_tree, by_pairs) = (loads(&tree, &model, &state), loads(&exact, &model, &state));
        if count > 1 {
            let error = off(&by_tree, &by_pairs);
            assert!(error < 1e-14, "{count}: {error:e}");
        }
        let [tree, exact] = [&tree, &exact].map(|force| potential(force, &model, &state));
        assert!((tree - exact).abs() <= 1e-14 * exact.abs(), "{count}: {tree} {exact}");
    }
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let (model, state) = stars(9000);
    let tree = among(0..9000, Some(0.7));
    let [one, two, eight] = [1, 2, 8].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (loads(&tree, &model, &state).force, potential(&tree, &model, &state)))
    });
    assert_eq!(one, two);
    assert_eq!(one, eight);
}

#[test]
fn every_node_has_the_moments_of_its_bodies() {
    for count in [1, 8, 9, 40, 333] {
        let located = |i| (star(i).location, star(i).mass);
        let tree = super::Tree::new((0..count).map(located), 0.5);
        let mut numbers: Vec<usize> = tree.bodies.iter().map(|body| body.number).collect();
        numbers.sort_unstable();
        assert!(numbers.into_iter().eq(0..count));
        assert_eq!(tree.nodes.len(), super::nodes(count));
        assert_eq!(tree.nodes[0].next, tree.nodes.len());
        for node in &tree.nodes {
            let bodies = &tree.bodies[node.first..node.end];
            let mass: f64 = bodies.iter().map(|body| body.mass).sum();
            let centre = bodies.iter().map(|body| body.mass * body.at).sum::<DVec3>() / mass;
            let second = bodies.iter().map(|body| body.mass * (body.at - centre).y * (body.at - centre).z);
            assert!((node.moments.mass - mass).abs() < 1e-12 * mass);
            assert!(node.moments.centre.distance(centre) < 1e-12);
            assert!((node.moments.second[5] - second.sum::<f64>()).abs() < 1e-11 * mass);
            let far = bodies.iter().map(|body| body.at.distance(centre)).fold(0.0, f64::max);
            assert!((node.opening.sqrt() - 2.0 / 3_f64.sqrt() * far / 0.5).abs() < 1e-11);
        }
    }
}

/// The two forces of a pair are not exactly opposite in a tree. Their errors point in all directions, so the sum of all forces must be
/// small compared to the error of the forces.
#[test]
fn momentum_hardly_drifts() {
    let (model, state) = stars(1500);
    let exact = loads(&among(0..1500, None), &model, &state);
    let tree = loads(&among(0..1500, Some(0.5)), &model, &state);
    let all: f64 = exact.force.iter().map(|force| force.length()).sum();
    let (left, off) = (tree.force.iter().sum::<DVec3>().length() / all, off(&tree, &exact));
    assert!(left > 1e-12 && left < 0.2 * off, "{left:e} {off:e}");
}

/// A cluster with extreme properties: masses from 0 to 1e12 kg, many bodies at one position, many bodies on a line, and one body far away.
#[test]
fn odd_clusters_are_summed_up_as_well() {
    let bodies = (0..800).map(|i| {
        let mut body = star(i);
        body.mass = match i % 50 {
            0 => 1e12,
            1 => 0.0,
            _ => body.mass,
        };
        match i % 4 {
            0 => body.location = DVec3::new(1.0, 2.0, 3.0),
            1 => body.location = DVec3::X * part(i, 0.618_033),
            _ => {}
        }
        if i == 77 {
            body.location = DVec3::new(1e9, -1e8, 0.0);
        }
        body
    });
    let (model, state) = world(bodies);
    let [tree, exact] = [Some(0.3), None].map(|angle| loads(&among(0..800, angle), &model, &state));
    for (i, (force, exact)) in tree.force.iter().zip(&exact.force).enumerate() {
        // Where large forces cancel, their rounding errors remain, so the tolerance has a lower bound.
        let scale = exact.length().max(1e-9 * model.mass()[i] * 1e12);
        assert!((*force - *exact).length() <= 1e-3 * scale, "{i}: {force} {exact}");
        assert!(model.mass()[i] > 0.0 || *force == DVec3::ZERO, "{i}");
    }
    let [tree, exact] = [Some(0.3), None].map(|angle| potential(&among(0..800, angle), &model, &state));
    assert!((tree / exact - 1.0).abs() < 1e-5, "{tree} {exact}");
}

/// Trees must treat fixed and absent bodies as the sum over all pairs does. Fixed bodies attract other bodies. Two fixed bodies have no
/// potential energy, even at the same position. Absent bodies neither exert nor feel forces.
#[test]
fn fixed_bodies_and_those_that_are_away_are_as_with_all_pairs() {
    let bodies = (0..600).map(|i| {
        let mut body = star(i);
        body.fixed = i % 3 == 0;
        if i % 30 == 0 {
            body.location = DVec3::ONE;
        }
        body
    });
    let (mut model, mut state) = world(bodies);
    let away: Vec<_> = (0..600).filter(|i| i % 7 == 0).map(|i| (i, false)).collect();
    model.let_come_and_go(&away, &mut state);
    for softening in [SOFTENING, 0.0] {
        let force = |opening_angle, between: bool| Gravitation {
            bodies: ids(0..if between { 250 } else { 600 }),
            against: between.then(|| ids(250..600)),
            constant: 2.0,
            softening,
            opening_angle,
        };
        for between in [false, true] {
            let [tree, exact] = [Some(1e-6), None].map(|angle| {
                let force = force(angle, between);
                let mut loads = loads(&force, &model, &state);
                model.bear(&state, &mut loads);
                (loads, potential(&force, &model, &state))
            });
            let error = off(&tree.0, &exact.0);
            assert!(error < 1e-13, "{between}: {error:e}");
            assert!((tree.1 - exact.1).abs() < 1e-13 * exact.1.abs(), "{} {}", tree.1, exact.1);
            let [tree, exact] = [Some(0.5), None].map(|angle| {
                let force = force(angle, between);
                let mut loads = loads(&force, &model, &state);
                model.bear(&state, &mut loads);
                (loads, potential(&force, &model, &state))
            });
            let error = off(&tree.0, &exact.0);
            assert!(error < 2e-3, "{between}: {error:e}");
            assert!((tree.1 / exact.1 - 1.0).abs() < 1e-3, "{} {}", tree.1, exact.1);
            for i in (0..600).filter(|i| i % 7 == 0) {
                assert_eq!(tree.0.force[i], DVec3::ZERO, "{i} is away");
            }
        }
    }
}
