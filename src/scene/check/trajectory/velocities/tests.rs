//! Tests which velocities contradict the places: wrong units and signs do, and honest motions with noise and impacts do not.

use std::f64::consts::TAU;

use super::*;
use crate::physics::random::Stream;

fn key(time: f64, location: DVec3, velocity: DVec3) -> Keyframe {
    Keyframe {
        time,
        location,
        orientation: DQuat::IDENTITY,
        velocity: Some(velocity),
        angular_velocity: None,
    }
}

fn normal(random: &mut Stream) -> DVec3 {
    DVec3::new(random.normal(), random.normal(), random.normal())
}

/// Returns the rows of a motion with unit speed: an oscillation with 6 to 40 rows per period, a free fall, a straight line, and a ball that
/// bounces between rows, in this order.
fn motions(rows: usize, random: &mut Stream) -> [Vec<Keyframe>; 4] {
    let times = || (0..rows).map(|i| i as f64 / 30.0);
    let (a, b, phase) = (normal(random), normal(random), TAU * random.uniform());
    let rate = TAU * 30.0 / (6.0 + 34.0 * random.uniform());
    let slow = rate * (0.1 + 0.9 * random.uniform());
    let swing = times().map(|t| {
        let [(s, c), (s2, c2)] = [rate * t + phase, slow * t].map(libm::sincos);
        key(t, a * s + b * c2, rate * c * a - slow * s2 * b)
    });
    let g = DVec3::new(0.0, -9.81, 0.0);
    let fall = times().map(|t| key(t, b * t + 0.5 * g * t * t, b + g * t));
    let line = times().map(|t| key(t, a * t, a));
    // The ball falls from `height` and bounces without loss.
    let height = 0.5 + 1.5 * random.uniform();
    let half: f64 = (2.0_f64 * height / 9.81).sqrt();
    let bounce = times().map(|t| {
        let since = (t + half).rem_euclid(2.0 * half) - half;
        key(
            t,
            DVec3::new(0.2 * t, height - 0.5 * 9.81 * since * since, 0.0),
            DVec3::new(0.2, -9.81 * since, 0.0),
        )
    });
    [swing.collect(), fall.collect(), line.collect(), bounce.collect()]
}

/// Adds noise to the rows, in parts of the root mean square of the ways and of the velocities.
fn with_noise(mut keys: Vec<Keyframe>, [places, velocities]: [f64; 2], random: &mut Stream) -> Vec<Keyframe> {
    let mean = |sum: f64| (sum / keys.len() as f64 / 3.0).sqrt();
    let way = mean(keys.windows(2).map(|pair| (pair[1].location - pair[0].location).length_squared()).sum());
    let speed = mean(keys.iter().filter_map(|key| key.velocity).map(DVec3::length_squared).sum());
    for key in &mut keys {
        key.location += places * way * normal(random);
        key.velocity = key.velocity.map(|velocity| velocity + velocities * speed * normal(random));
    }
    keys
}

#[test]
fn honest_motions_are_accepted() {
    let mut random = Stream::new(1, "rows");
    for rows in [2, 3, 4, 6, 12, 40, 200] {
        for noise in [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1], [0.1, 0.1], [0.3, 0.0], [5.0, 0.0], [0.3, 0.3]] {
            // Of less than ten rows, strong noise can look like anything.
            if rows < 10 && noise.iter().any(|noise| *noise > 0.1) {
                continue;
            }
            for _ in 0..20 {
                for keys in motions(rows, &mut random) {
                    let keys = with_noise(keys, noise, &mut random);
                    assert_eq!(of_places(&keys, &[]), None, "{rows} rows, {noise:?}: {keys:?}");
                }
            }
        }
    }
}

#[test]
fn a_body_at_rest_may_have_noise() {
    let mut random = Stream::new(2, "rows");
    for (places, velocities) in [(1e-3, 0.0), (0.0, 1e-3), (1e-3, 1e-3), (1e-3, 1.0)] {
        for _ in 0..200 {
            let keys: Vec<_> = (0..30)
                .map(|i| {
                    key(f64::from(i) / 30.0, places * normal(&mut random), velocities * normal(&mut random))
                })
                .collect();
            assert_eq!(of_places(&keys, &[]), None, "{keys:?}");
        }
    }
}

/// The oscillation with the fewest rows per period that is accepted: 3.
#[test]
fn an_oscillation_needs_three_rows_per_period() {
    for (rows, is_honest) in [(6.0, true), (4.0, true), (3.05, true), (2.5, false)] {
        let keys: Vec<_> = (0..100)
            .map(|i| {
                let t = f64::from(i);
                let (sine, cosine) = libm::sincos(TAU / rows * t);
                key(t, DVec3::X * sine, DVec3::X * (TAU / rows * cosine))
            })
            .collect();
        assert_eq!(of_places(&keys, &[]).is_none(), is_honest, "{rows}");
    }
}

/// Velocities in cm/s, mm/s, km/h, mph, knots, km/s and others, of zero, and of the wrong sign.
#[test]
fn other_units_and_signs_are_found() {
    let mut random = Stream::new(3, "rows");
    for factor in
        [100.0, 1000.0, 3.6, 2.237, 3.281, 1.944, 0.01, 0.001, 0.278, 0.447, 0.305, 0.514, 0.0, -1.0]
    {
        for rows in [40, 200] {
            for mut keys in motions(rows, &mut random) {
                keys.iter_mut().for_each(|key| key.velocity = key.velocity.map(|velocity| factor * velocity));
                let found = of_places(&keys, &[]);
                let found = found.unwrap_or_else(|| panic!("{factor}, {rows} rows: {keys:?}"));
                if found.factor > 0.0 {
                    assert!((found.factor / factor - 1.0).abs() < 0.25, "{factor}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn the_error_shows_the_row_and_both_numbers() {
    for rows in [2, 3, 6] {
        let keys: Vec<_> = (0..rows).map(f64::from).map(|t| key(t, DVec3::Y * t, DVec3::Y * 100.0)).collect();
        let found = of_places(&keys, &[]).unwrap();
        assert_eq!((found.axis, found.column, found.rows), (1, 100.0, 1.0));
        assert!((found.factor - 100.0).abs() < 1e-9, "{found:?}");
    }
}

/// A body that leaves in one place and comes back in another.
#[test]
fn what_happens_in_a_gap_does_not_count() {
    let mut keys: Vec<_> = (0..20).map(f64::from).map(|t| key(t, DVec3::X * t, DVec3::X)).collect();
    keys[10..].iter_mut().for_each(|key| key.location.x += 1e4);
    assert_eq!(of_places(&keys, &[10]), None);
}

#[test]
fn angular_velocities_in_degrees_are_found() {
    for (factor, is_right) in [(1.0, true), (57.3, false)] {
        let keys: Vec<_> = (0..30)
            .map(|i| {
                let t = f64::from(i) / 60.0;
                let (sine, cosine) = libm::sincos(0.5 * t);
                let orientation = DQuat::from_xyzw(0.0, 0.0, sine, cosine);
                let angular_velocity = Some(DVec3::Z * factor);
                Keyframe { orientation, angular_velocity, ..key(t, DVec3::ZERO, DVec3::ZERO) }
            })
            .collect();
        assert_eq!(of_orientations(&keys, &[]).is_none(), is_right);
        assert_eq!(of_places(&keys, &[]), None);
    }
}
