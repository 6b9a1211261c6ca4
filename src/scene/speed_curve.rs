//! The speed of the film against simulated time: slow motion around an event.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// The speed of the film as a function of the simulated time: seconds of the simulation per second of the film, at a frame rate that shows the
/// simulation in real time. The speed changes linearly between its points, and is constant before the first and after the last one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")]
pub struct SpeedCurve(Arc<[Point]>);

/// A point of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    /// The simulated time, s.
    time: f64,
    /// The speed. It is positive.
    speed: f64,
    /// The time of the film, s.
    film: f64,
}

/// Speeds that differ by less than this fraction between two points count as equal.
const EQUAL_SPEEDS: f64 = 1e-9;

impl SpeedCurve {
    /// Creates the curve through these points, each a simulated time (s) and a positive speed. The times increase. Without points, the speed
    /// is 1.
    pub fn new(points: impl IntoIterator<Item = [f64; 2]>) -> SpeedCurve {
        let mut all: Vec<Point> = Vec::new();
        let points: Vec<[f64; 2]> = points.into_iter().collect();
        if points.iter().all(|[_, speed]| *speed == 1.0) {
            return SpeedCurve::default();
        }
        for [time, speed] in points {
            let film = match all.last() {
                None => time / speed,
                Some(last) => last.film + between(*last, [time, speed]),
            };
            all.push(Point { time, speed, film });
        }
        SpeedCurve(all.into())
    }

    /// Returns true if the film shows simulated time evenly.
    pub fn is_even(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the speed if it does not change.
    pub fn constant(&self) -> Option<f64> {
        let Some(first) = self.0.first() else { return Some(1.0) };
        self.0.iter().all(|point| point.speed == first.speed).then_some(first.speed)
    }

    /// Computes when the film shows a simulated time (s): a time of the film, s.
    pub fn film_time(&self, time: f64) -> f64 {
        let after = self.0.partition_point(|point| point.time <= time);
        match (after.checked_sub(1).map(|before| self.0[before]), self.0.get(after)) {
            (None, None) => time,
            (None, Some(first)) => time / first.speed,
            (Some(last), None) => last.film + (time - last.time) / last.speed,
            (Some(last), Some(next)) => {
                let speed =
                    last.speed + (next.speed - last.speed) * (time - last.time) / (next.time - last.time);
                last.film + between(last, [time, speed])
            }
        }
    }

    /// Computes the simulated time (s) that the film shows at a time of the film (s).
    pub fn time(&self, film: f64) -> f64 {
        let after = self.0.partition_point(|point| point.film <= film);
        match (after.checked_sub(1).map(|before| self.0[before]), self.0.get(after)) {
            (None, None) => film,
            (None, Some(first)) => film * first.speed,
            (Some(last), None) => last.time + (film - last.film) * last.speed,
            (Some(last), Some(next)) => {
                let passed = film - last.film;
                let growth = (next.speed - last.speed) / (next.time - last.time);
                if are_equal(last.speed, next.speed) {
                    return last.time + last.speed * passed;
                }
                // dt/dτ = v + k t has the solution t = v (exp(k τ) - 1) / k.
                (last.time + last.speed * libm::expm1(growth * passed) / growth).min(next.time)
            }
        }
    }
}

impl From<SpeedCurve> for Vec<[f64; 2]> {
    fn from(curve: SpeedCurve) -> Vec<[f64; 2]> {
        curve.0.iter().map(|point| [point.time, point.speed]).collect()
    }
}

impl TryFrom<Vec<[f64; 2]>> for SpeedCurve {
    type Error = &'static str;

    fn try_from(points: Vec<[f64; 2]>) -> Result<SpeedCurve, &'static str> {
        let are_finite = points.iter().flatten().all(|number| number.is_finite());
        let are_positive = points.iter().all(|[_, speed]| *speed > 0.0);
        let increase = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if are_finite && are_positive && increase {
            Ok(SpeedCurve::new(points))
        } else {
            Err("times that increase, with positive speeds")
        }
    }
}

fn are_equal(one: f64, other: f64) -> bool {
    (one - other).abs() <= EQUAL_SPEEDS * one.max(other)
}

/// Computes the time of the film (s) from a point to a later time (s) with this speed. The integral of 1/v over a speed v that changes linearly is
/// Δt ln(v₂/v₁) / (v₂ - v₁).
fn between(from: Point, [time, speed]: [f64; 2]) -> f64 {
    let passed = time - from.time;
    if are_equal(from.speed, speed) {
        return passed / from.speed;
    }
    passed * libm::log(speed / from.speed) / (speed - from.speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_points_the_film_shows_life() {
        let even = SpeedCurve::default();
        assert!(even.is_even());
        assert_eq!([even.time(1.7), even.film_time(1.7)], [1.7; 2]);
    }

    #[test]
    fn a_constant_speed_stretches_the_film() {
        let slow = SpeedCurve::new([[0.0, 0.25]]);
        assert_eq!([slow.time(4.0), slow.film_time(1.0)], [1.0, 4.0]);
    }

    /// The speed falls from 1 to 0.1 within 2 s: the film takes 2 ln(0.1) / (0.1 - 1) = 5.1169 s.
    #[test]
    fn the_film_takes_the_integral_of_one_over_the_speed() {
        let curve = SpeedCurve::new([[0.0, 1.0], [2.0, 0.1], [3.0, 1.0]]);
        let fall = 2.0 * libm::log(10.0) / 0.9;
        assert!((curve.film_time(2.0) - fall).abs() < 1e-14);
        assert!((curve.film_time(3.0) - 1.5 * fall).abs() < 1e-14);
        assert!((curve.film_time(5.0) - (1.5 * fall + 2.0)).abs() < 1e-14);
        // Against a sum of small pieces.
        let pieces = 100_000;
        let piece = 1.3 / f64::from(pieces);
        let sum: f64 = (0..pieces).map(|i| piece / (1.0 - 0.45 * (f64::from(i) + 0.5) * piece)).sum();
        assert!((curve.film_time(1.3) - sum).abs() < 1e-9);
    }

    #[test]
    fn both_directions_agree() {
        let curve = SpeedCurve::new([[0.5, 2.0], [1.0, 2.0], [1.5, 0.01], [4.0, 7.0]]);
        for i in 0..500 {
            let time = f64::from(i) * 0.01;
            assert!((curve.time(curve.film_time(time)) - time).abs() < 1e-12, "{time}");
        }
    }
}
