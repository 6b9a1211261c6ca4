//! Tests of trails and ghosts.

use glam::DVec3;

use super::super::{Frame, Frames};
use super::trail_path::MOST_POINTS;
use crate::scene::Scene;

fn scene(keys: &str) -> Scene {
    let text = format!(
        "simulation = {{ duration = 2, gravity = [0, -10, 0], integrator = 'rk4' }}
        [body.ball]\nshape.sphere.radius = 0.1\nvelocity = [1, 5, 0]\n{keys}"
    );
    Scene::parse(&text).unwrap()
}

#[test]
fn ghosts_are_where_the_body_was_and_none_is_where_it_is() {
    let scene = scene("ghosts.every = 0.13");
    let plain = self::scene("");
    for (frame, without) in Frames::new(&scene).zip(Frames::new(&plain)) {
        let (frame, without) = (frame.unwrap(), without.unwrap());
        assert_eq!(frame.bodies, without.bodies, "the run does not notice its ghosts");
        let times: Vec<f64> = frame.past.ghosts.iter().map(|ghost| ghost.time).collect();
        let expected: Vec<f64> =
            (0..99).map(|i| f64::from(i) * 0.13).filter(|t| *t < frame.time - 1e-6).collect();
        assert_eq!(times, expected);
        for ghost in &frame.past.ghosts {
            let t = ghost.time;
            let place = DVec3::new(t, 5.0 * t - 5.0 * t * t, 0.0);
            assert!(ghost.body.location.abs_diff_eq(place, 1e-9));
        }
    }
}

#[test]
fn a_ghost_at_the_time_of_a_frame_is_that_frame() {
    // 3 × 0.2 differs from 15 / 25 by rounding.
    let scene = scene("ghosts.every = 0.2");
    let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
    assert_eq!(frames[15].past.ghosts.len(), 3);
    assert_eq!(frames[16].past.ghosts[3].body, frames[15].bodies[0]);
}

#[test]
fn the_past_is_the_same_for_any_way_to_a_moment() {
    let scene = scene("ghosts.every = 0.13\ntrail.duration = 0.5");
    let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
    for frame in &frames {
        assert_eq!(Frames::at(&scene, frame.time).unwrap(), *frame);
    }
    // The ghost at 0.26 s lies between two frames.
    let later = Frames::at(&scene, 0.27).unwrap();
    assert_eq!(later.past.ghosts[..], frames[7].past.ghosts[..]);
    assert_eq!(later.past.ghosts.len(), 3);
    assert_eq!(frames[6].past.ghosts.len(), 2);
}

#[test]
fn a_trail_begins_so_many_seconds_ago_on_the_exact_way() {
    let scene = scene("trail.duration = 0.5");
    let frame = Frames::at(&scene, 1.01).unwrap();
    let points = &frame.past.trails[0].points;
    assert!((points[0].time - 0.51).abs() < 1e-12 && points.last().unwrap().time == 1.01);
    for pair in points.windows(2) {
        let t = 0.5 * (pair[0].time + pair[1].time);
        let place = DVec3::new(t, 5.0 * t - 5.0 * t * t, 0.0);
        assert!(pair[0].towards(&pair[1], t).abs_diff_eq(place, 2e-3), "{t}");
    }
}

/// A point on the rim of a rolling wheel follows a cycloid: its velocity is 0 whenever it touches the ground.
#[test]
fn a_trail_of_a_point_turns_with_its_body() {
    let text = "simulation = { duration = 4, integrator = 'rk4' }\n[body.wheel]\nshape.sphere.radius = 0.5
        velocity = [1, 0, 0]\nangular_velocity = [0, 0, -2]\ntrail.at = [0, -0.5, 0]";
    let frame = Frames::at(&Scene::parse(text).unwrap(), 4.0).unwrap();
    let points = &frame.past.trails[0].points;
    assert_eq!(points.len(), 101);
    for point in points {
        let (sin, cos) = libm::sincos(2.0 * point.time);
        let place = DVec3::new(point.time - 0.5 * sin, -0.5 * cos, 0.0);
        // In each step of 1/250 s, rk4 rotates by 2 rad/s · h with an error of (h ω)⁵/120. There are 1,000 steps.
        assert!(point.location.abs_diff_eq(place, 3e-10), "{point:?}");
        assert!(point.velocity.abs_diff_eq(DVec3::new(1.0 - cos, sin, 0.0), 1e-9), "{point:?}");
    }
}

#[test]
fn a_long_trail_has_bounded_points() {
    let text = "simulation = { duration = 400 }\n[body.b]\nshape.sphere.radius = 1\ntrail = true";
    let scene = Scene::parse(text).unwrap();
    let mut most = 0;
    for frame in Frames::new(&scene) {
        let frame = frame.unwrap();
        let points = &frame.past.trails[0].points;
        most = most.max(points.len());
        assert_eq!((points[0].time, points.last().unwrap().time), (0.0, frame.time));
    }
    assert!((MOST_POINTS / 2..=MOST_POINTS + 1).contains(&most), "{most}");
}

/// A ball falls from 1.25 m and bounces. Its trail has a corner at each impact with the floor, for any frame rate, and follows free fall
/// between impacts.
#[test]
fn a_trail_has_its_corners_at_the_impacts() {
    let text = "simulation = { duration = 4, frame_rate = 7, gravity = [0, -10, 0], integrator = 'velocity-verlet', contacts = 'event-driven' }
        [body.ball]\nshape.sphere.radius = 0.1\nlocation = [0, 1.35, 0]\nvelocity = [1, 0, 0]\nrestitution = 0.8
        friction = 0\ntrail = true\nghosts.every = 0.03";
    let scene = Scene::parse(text).unwrap();
    // The ball hits the floor at 0.5 s, and again after flights of 0.8, 0.64 and 0.512 s.
    let times = [0.5, 1.3, 1.94, 2.452];
    for time in [2.6, 3.0, 3.01] {
        let frame = Frames::at(&scene, time).unwrap();
        let points = &frame.past.trails[0].points;
        let mut speed = 5.0;
        for hit in times {
            let corner: Vec<_> = points.iter().filter(|point| (point.time - hit).abs() < 1e-9).collect();
            let [before, after] = corner[..] else { panic!("{corner:?} at {hit} s") };
            assert!(before.location.abs_diff_eq(DVec3::new(hit, 0.1, 0.0), 1e-9), "{before:?}");
            assert_eq!(before.location, after.location);
            assert!(before.velocity.abs_diff_eq(DVec3::new(1.0, -speed, 0.0), 1e-9), "{before:?}");
            speed *= 0.8;
            assert!(after.velocity.abs_diff_eq(DVec3::new(1.0, speed, 0.0), 1e-9), "{after:?}");
        }
        assert!(points.is_sorted_by(|a, b| a.time <= b.time));
        for pair in points.windows(2).filter(|pair| pair[0].velocity.dot(pair[1].velocity) > 0.0) {
            let t = 0.5 * (pair[0].time + pair[1].time);
            let fall =
                pair[0].velocity.y * (t - pair[0].time) - 5.0 * (t - pair[0].time) * (t - pair[0].time);
            let place = DVec3::new(t, pair[0].location.y + fall, 0.0);
            assert!(pair[0].towards(&pair[1], t).abs_diff_eq(place, 1e-9), "{t}");
        }
    }
}

/// A ball that comes to rest bounces infinitely often, but its trail has a bounded number of corners.
#[test]
fn where_impacts_are_many_a_trail_has_no_corners() {
    let text = "simulation = { duration = 6, gravity = [0, -10, 0], contacts = 'event-driven' }
        [body.ball]\nshape.sphere.radius = 0.1\nlocation = [0, 1.35, 0]\nrestitution = 0.8\ntrail = true";
    let frame = Frames::at(&Scene::parse(text).unwrap(), 6.0).unwrap();
    let points = &frame.past.trails[0].points;
    let corners = points.iter().filter(|point| point.frame.is_none()).count();
    assert!((20..80).contains(&corners), "{corners}");
    for run in points.chunk_by(|a, b| a.frame.is_none() && b.frame.is_none()) {
        assert!(run.len() <= 8, "{run:?}");
    }
}
