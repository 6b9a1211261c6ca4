//! The remembered past of a run, for trails and ghosts.
//!
//! Only the bodies with trails or ghosts have one, and it is bounded: a trail has some hundred points and the corners between them, and
//! the scene's check limits the ghosts. The past of a frame depends on its time alone, and not on which frames are drawn.

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
    /// The requested trails.
    pub trails: Vec<Way>,
    /// The requested ghosts, in order of time.
    pub ghosts: Vec<Arc<Ghost>>,
    /// The points for cameras that follow with a lag.
    pub lagging: Vec<Lagging>,
}

/// A body at an earlier moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    /// The time, s.
    pub time: f64,
    /// The body at that time.
    pub body: BodySnapshot,
    /// Its contacts, if its ghosts show the forces there.
    pub contacts: Vec<ContactSnapshot>,
}

/// The history of a run while it advances.
#[derive(Clone, Default)]
pub(super) struct History {
    /// The bodies with requests.
    asks: Arc<[(usize, Showing)]>,
    /// For each of them, its mass, kg; infinite if no force moves it.
    masses: Arc<[f64]>,
    /// For each of them, the points of its trail, each with the number of its frame, or of the next frame.
    ways: Vec<Vec<(usize, Passed)>>,
    /// For each of them, its state in the last frame, if it was present.
    last: Vec<Option<corners::At>>,
    /// The impacts since the last frame.
    impacts: Vec<Impact>,
    /// For each of them, whether it is absent after having been present.
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

    /// Whether no body needs its past.
    pub(super) fn is_idle(&self) -> bool {
        self.asks.is_empty() && self.lagging.is_empty()
    }

    /// Stores the ghosts of a moment, and the impacts before it.
    pub(super) fn note_moment(&mut self, entry: &Entry) {
        self.note_ghosts(&entry.snapshot);
        if !self.asks.is_empty() {
            self.impacts.extend_from_slice(&entry.impacts);
        }
    }

    fn note_ghosts(&mut self, moment: &Snapshot) {
        // A time that differs from a frame's only by rounding counts as that frame's.
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

    /// Stores the bodies of a frame, without ghosts.
    pub(super) fn note(&mut self, frame: &Frame) {
        self.lagging.iter_mut().for_each(|lagging| *lagging = lagging.at(frame));
        for number in 0..self.asks.len() {
            let (body, showing) = &self.asks[number];
            let Some(trail) = showing.trail else { continue };
            let present = frame.body(*body);
            let corners = self.corners(number, frame, trail);
            let (way, is_away) = (&mut self.ways[number], &mut self.is_away[number]);
            if std::mem::replace(is_away, present.is_none()) && present.is_some() {
                // It may return elsewhere, so its path has a gap.
                way.clear();
            }
            self.last[number] = present.map(|body| (frame.time, *body));
            // The kept frames depend only on their numbers and the present one.
            let stride = stride(trail, self.interval, frame.index);
            if let Some(duration) = trail.duration {
                // Interpolation needs the last point before the start.
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
