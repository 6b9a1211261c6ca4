//! The remembered past of a run, for trails and ghosts.
//!
//! Only the bodies that ask for it have one, and it is bounded: a trail has some hundred points and the corners between, and the
//! scene's check limits the ghosts. The past of a frame depends on its time alone, and not on which frames are drawn.

mod corners;
#[cfg(test)]
mod tests;
mod way;

use std::sync::Arc;

use glam::DVec3;

pub use way::{Passed, Way};

use self::way::{cut, stride, thin};
use super::simulation::Entry;
use super::{Frame, Lagging, Moments};
use crate::dynamics::{BodySnapshot, ContactSnapshot, Impact, Snapshot};
use crate::scene::{Scene, Showing, Trail};

/// The past of a moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Past {
    /// The trails that are asked for.
    pub trails: Vec<Way>,
    /// The ghosts that are asked for, in the order of their times.
    pub ghosts: Vec<Arc<Ghost>>,
    /// The places that cameras ask for which follow with a lag.
    pub lagging: Vec<Lagging>,
}

/// A body as it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    /// When, s.
    pub time: f64,
    /// How it was.
    pub body: BodySnapshot,
    /// Its contacts, if its ghosts show the forces there.
    pub contacts: Vec<ContactSnapshot>,
}

/// The past of a run as it goes on.
#[derive(Clone, Default)]
pub(super) struct History {
    /// The requests of the bodies that have any.
    asks: Arc<[(usize, Showing)]>,
    /// For each of them, its mass, kg. That of a body that no force moves is infinite.
    masses: Arc<[f64]>,
    /// For each of them, the points of its trail, each with the number of its frame, or of the one after it.
    ways: Vec<Vec<(usize, Passed)>>,
    /// For each of them, how it was in the last frame, if it was there.
    last: Vec<Option<corners::At>>,
    /// The impacts since the last frame.
    impacts: Vec<Impact>,
    /// For each of them, whether it is away after it has been there.
    is_away: Vec<bool>,
    ghosts: Vec<Arc<Ghost>>,
    lagging: Vec<Lagging>,
    interval: f64,
}

impl History {
    /// The history of a run that has not begun.
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
        let mass = |(number, _): &(usize, Showing)| {
            let body = &scene.bodies[*number];
            if body.start.fixed || body.motion.is_some() { f64::INFINITY } else { body.start.mass }
        };
        History {
            masses: asks.iter().map(mass).collect(),
            last: vec![None; asks.len()],
            impacts: Vec::new(),
            ways: vec![Vec::new(); asks.len()],
            is_away: vec![false; asks.len()],
            asks,
            ghosts: Vec::new(),
            lagging: Lagging::of(scene),
            interval: 1.0 / scene.simulation.frame_rate,
        }
    }

    /// Whether no body asks for its past.
    pub(super) fn is_idle(&self) -> bool {
        self.asks.is_empty() && self.lagging.is_empty()
    }

    /// Remembers the ghosts that stand at a moment, and the impacts before it.
    pub(super) fn note_moment(&mut self, entry: &Entry) {
        self.note_ghosts(&entry.snapshot);
        if !self.asks.is_empty() {
            self.impacts.extend_from_slice(&entry.impacts);
        }
    }

    fn note_ghosts(&mut self, moment: &Snapshot) {
        // A time that differs from a frame's only by rounding is that frame's.
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
        for number in 0..self.asks.len() {
            let (body, showing) = &self.asks[number];
            let Some(trail) = showing.trail else { continue };
            let present = frame.body(*body);
            let corners = self.corners(number, frame, trail);
            let (way, is_away) = (&mut self.ways[number], &mut self.is_away[number]);
            if std::mem::replace(is_away, present.is_none()) && present.is_some() {
                // It may come back elsewhere: between, there is no way.
                way.clear();
            }
            self.last[number] = present.map(|body| (frame.time, *body));
            // Which frames are kept follows from their numbers and the present one alone.
            let stride = stride(trail, self.interval, frame.index);
            if let Some(duration) = trail.duration {
                // The last point before is needed for interpolation.
                let before = way.iter().take_while(|(_, point)| point.time <= frame.time - duration).count();
                way.drain(..before.saturating_sub(1));
            }
            way.retain(|(index, point)| point.frame.is_none() || index % stride == 0);
            way.extend(corners.into_iter().map(|point| (frame.index, point)));
            if frame.index.is_multiple_of(stride) {
                let Some(body) = present else { continue };
                let point = Passed::of(frame.time, body, trail);
                way.push((frame.index, Passed { frame: Some(frame.index), ..point }));
            }
            thin(way);
        }
        self.impacts.clear();
    }

    /// The points of a trail at the impacts since the last frame.
    fn corners(&self, number: usize, moment: &Frame, trail: Trail) -> Vec<Passed> {
        let id = self.asks[number].0;
        let (Some(before), Some(now)) = (&self.last[number], moment.body(id)) else { return Vec::new() };
        let impulse = |impact: &Impact| match impact.bodies {
            [first, _] if first == id => -impact.impulse,
            [_, second] if second == id => impact.impulse,
            _ => DVec3::ZERO,
        };
        corners::between((before, &(moment.time, *now)), &self.impacts, impulse, (self.masses[number], trail))
    }

    /// The past of a moment, which is the last frame or later.
    pub(super) fn before(&self, moment: &Frame) -> Past {
        let mut trails = Vec::new();
        for (number, ((body, showing), way)) in self.asks.iter().zip(&self.ways).enumerate() {
            let Some(trail) = showing.trail else { continue };
            let mut points: Vec<Passed> = way.iter().map(|(_, point)| *point).collect();
            points.extend(self.corners(number, moment, trail));
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
