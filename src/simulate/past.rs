//! What a run remembers of its past, for trails and ghosts.
//!
//! It is kept for bodies that ask for it, and bounded: a trail has at most [`MOST_POINTS`] points, and the scene's
//! check limits the ghosts. What a frame is given depends on its time alone, and not on which frames are drawn.

use std::sync::Arc;

use glam::DVec3;

use super::{Frame, Lagging, Moments};
use crate::dynamics::{BodySnapshot, ContactSnapshot, Snapshot};
use crate::scene::{Scene, Showing, Trail};

/// The most points of a trail; where frames are more, every second, fourth, … is kept.
const MOST_POINTS: usize = 512;

/// What has been before a moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Past {
    /// The trails that are asked for.
    pub trails: Vec<Way>,
    /// The ghosts that are asked for, in the order of their times.
    pub ghosts: Vec<Arc<Ghost>>,
    /// The places that cameras ask for which follow with a lag.
    pub lagging: Vec<Lagging>,
}

/// The way of a body, or of a point of it, up to a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// The number of the body.
    pub body: usize,
    /// Points of the way, the oldest first; the last is the present one.
    pub points: Vec<Passed>,
    /// Every so many frames a point is kept.
    pub stride: usize,
}

/// A point that a body has passed, or a point of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passed {
    /// When, s.
    pub time: f64,
    /// Where, m.
    pub location: DVec3,
    /// How fast, m/s.
    pub velocity: DVec3,
    /// The number of the frame that this is the body of, if the point is kept for later frames.
    pub frame: Option<usize>,
}

/// A body as it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    /// When, s.
    pub time: f64,
    /// How it was.
    pub body: BodySnapshot,
    /// Where it touched others, if its ghosts show the forces there.
    pub contacts: Vec<ContactSnapshot>,
}

impl Passed {
    /// Where the body was between this point and a later one, m: on a curve of third degree, which meets locations
    /// and velocities at both. So the way under a constant force is exact, however far apart the points are.
    pub fn towards(&self, next: &Passed, time: f64) -> DVec3 {
        let span = next.time - self.time;
        if span <= 0.0 || self.velocity.dot(next.velocity) <= 0.0 {
            // A body that turns back between has been hit, or is slow: no curve is better than a straight line.
            let part = if span > 0.0 { (time - self.time) / span } else { 1.0 };
            return self.location.lerp(next.location, part);
        }
        let s = (time - self.time) / span;
        let (s2, s3) = (s * s, s * s * s);
        (2.0 * s3 - 3.0 * s2 + 1.0) * self.location
            + (s3 - 2.0 * s2 + s) * span * self.velocity
            + (3.0 * s2 - 2.0 * s3) * next.location
            + (s3 - s2) * span * next.velocity
    }
}

/// The past of a run as it goes on.
#[derive(Clone, Default)]
pub(super) struct History {
    /// What each body asks for that asks for something.
    asks: Arc<[(usize, Showing)]>,
    /// For each of them, the points of its trail, each with the number of its frame.
    ways: Vec<Vec<(usize, Passed)>>,
    /// For each of them, whether it is away after it has been there.
    is_away: Vec<bool>,
    ghosts: Vec<Arc<Ghost>>,
    lagging: Vec<Lagging>,
    interval: f64,
}

impl History {
    /// That of a run that has not begun.
    pub(super) fn new(scene: &Scene) -> History {
        let asks = scene.bodies.iter().enumerate().map(|(number, body)| (number, &*body.showing));
        let asks = asks.filter(|(_, showing)| showing.trail.is_some() || showing.ghosts.is_some());
        let as_drawn = |(number, showing): (usize, &Showing)| {
            let mut showing = showing.clone();
            if let Some(trail) = &mut showing.trail {
                trail.at *= scene.bodies[number].look.scale;
            }
            (number, showing)
        };
        let asks: Arc<[_]> = asks.map(as_drawn).collect();
        History {
            ways: vec![Vec::new(); asks.len()],
            is_away: vec![false; asks.len()],
            asks,
            ghosts: Vec::new(),
            lagging: Lagging::of(scene),
            interval: 1.0 / scene.simulation.frame_rate,
        }
    }

    /// Whether nobody asks for what has been.
    pub(super) fn is_idle(&self) -> bool {
        self.asks.is_empty() && self.lagging.is_empty()
    }

    /// Remembers the ghosts that stand at a moment.
    pub(super) fn note_ghosts(&mut self, moment: &Snapshot) {
        // What is the time of a frame but for rounding is that frame.
        let slack = Moments::slack(1.0 / self.interval);
        let mut due: Vec<(f64, usize)> = Vec::new();
        for (body, showing) in self.asks.iter() {
            let Some(ghosts) = showing.ghosts else { continue };
            let time = (moment.time / ghosts.every).round() * ghosts.every;
            if (time - moment.time).abs() <= slack {
                due.push((time, *body));
            }
        }
        due.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let contacts = |body: usize| {
            let shows = |(id, showing): &(usize, Showing)| {
                *id == body && showing.ghosts.is_some_and(|ghosts| ghosts.arrows) && showing.has_loads()
            };
            let touches = moment.contacts.iter().filter(|contact| contact.bodies.contains(&body)).copied();
            if self.asks.iter().any(shows) { touches.collect() } else { Vec::new() }
        };
        let ghost = |(time, body): (f64, usize)| {
            Some(Arc::new(Ghost { time, body: *moment.body(body)?, contacts: contacts(body) }))
        };
        self.ghosts.extend(due.into_iter().filter_map(ghost));
    }

    /// Remembers where bodies are in a frame, but for their ghosts.
    pub(super) fn note(&mut self, frame: &Frame) {
        self.lagging.iter_mut().for_each(|lagging| *lagging = lagging.at(frame));
        let ways = self.ways.iter_mut().zip(&mut self.is_away);
        for ((body, showing), (way, is_away)) in self.asks.iter().zip(ways) {
            let Some(trail) = showing.trail else { continue };
            let present = frame.body(*body);
            if std::mem::replace(is_away, present.is_none()) && present.is_some() {
                // It may come back elsewhere: between, there is no way.
                way.clear();
            }
            // Which frames are kept follows from their numbers and the present one alone.
            let stride = stride(trail, self.interval, frame.index);
            if let Some(duration) = trail.duration {
                // The last one before is needed for what is between.
                let before = way.iter().take_while(|(_, point)| point.time <= frame.time - duration).count();
                way.drain(..before.saturating_sub(1));
            }
            way.retain(|(index, _)| index % stride == 0);
            if frame.index.is_multiple_of(stride) {
                let Some(body) = present else { continue };
                let point = Passed::of(frame.time, body, trail);
                way.push((frame.index, Passed { frame: Some(frame.index), ..point }));
            }
        }
    }

    /// What has been before a moment, which is that of the last frame or a later one.
    pub(super) fn before(&self, moment: &Frame) -> Past {
        let mut trails = Vec::new();
        for ((body, showing), way) in self.asks.iter().zip(&self.ways) {
            let Some(trail) = showing.trail else { continue };
            let mut points: Vec<Passed> = way.iter().map(|(_, point)| *point).collect();
            if points.last().is_none_or(|last| last.time < moment.time) {
                points.extend(moment.body(*body).map(|body| Passed::of(moment.time, body, trail)));
            }
            if let Some(duration) = trail.duration {
                cut(&mut points, moment.time - duration);
            }
            trails.push(Way { body: *body, points, stride: stride(trail, self.interval, moment.index) });
        }
        let lagging = self.lagging.iter().map(|lagging| lagging.at(moment)).collect();
        let slack = Moments::slack(1.0 / self.interval);
        let is_past = |ghost: &&Arc<Ghost>| ghost.time < moment.time - slack;
        let ghosts = self.ghosts.iter().filter(is_past).cloned().collect();
        Past { trails, ghosts, lagging }
    }
}

impl Passed {
    fn of(time: f64, body: &BodySnapshot, trail: Trail) -> Passed {
        let (location, velocity) = body.point(trail.at);
        Passed { time, location, velocity, frame: None }
    }
}

/// A way from a time on, which may be between two of its points.
fn cut(points: &mut Vec<Passed>, from: f64) {
    let before = points.iter().take_while(|point| point.time <= from).count();
    let Some(last) = before.checked_sub(1) else { return };
    if let Some(&next) = points.get(before) {
        let point = points[last];
        let part = (from - point.time) / (next.time - point.time);
        let velocity = point.velocity.lerp(next.velocity, part);
        points[last] = Passed { time: from, location: point.towards(&next, from), velocity, frame: None };
    }
    points.drain(..last);
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates, and a saturated number means the same"
)]
fn frames_within(intervals: f64) -> usize {
    intervals as usize
}

/// Every so many frames a point of a trail is kept, as seen from a frame: as few as make at most [`MOST_POINTS`].
fn stride(trail: Trail, interval: f64, frame: usize) -> usize {
    let within = trail.duration.map_or(usize::MAX, |duration| frames_within(duration / interval));
    (within.min(frame) / MOST_POINTS + 1).next_power_of_two()
}

#[cfg(test)]
mod tests {
    use super::super::Frames;
    use super::*;

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
        // 3 × 0.2 is not the same number as 15 / 25.
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
        // 0.26 s is between two frames.
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

    /// A point at the rim of a wheel that rolls goes along a cycloid, and stands still where it touches the ground.
    #[test]
    fn a_trail_of_a_point_turns_with_its_body() {
        let text =
            "simulation = { duration = 4, integrator = 'rk4' }\n[body.wheel]\nshape.sphere.radius = 0.5
            velocity = [1, 0, 0]\nangular_velocity = [0, 0, -2]\ntrail.at = [0, -0.5, 0]";
        let frame = Frames::at(&Scene::parse(text).unwrap(), 4.0).unwrap();
        let points = &frame.past.trails[0].points;
        assert_eq!(points.len(), 101);
        for point in points {
            let (sin, cos) = libm::sincos(2.0 * point.time);
            let place = DVec3::new(point.time - 0.5 * sin, -0.5 * cos, 0.0);
            // rk4 turns by 2 rad/s with steps of 1/250 s: (h ω)⁵/120 a step, times 1,000.
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
}
