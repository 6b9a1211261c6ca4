//! The earlier positions of bodies, for trails, ghosts and swept areas.
//!
//! Only bodies with trails, ghosts or swept areas have a past. Memory is bounded: a trail has some hundred points and the corners between them, and the
//! scene's check limits the number of ghosts. The past of a frame depends on its time alone, and not on the frames that are drawn.

mod corners;
#[cfg(test)]
mod tests;
mod trail_path;
mod values;

use std::sync::Arc;

use glam::DVec3;

pub(super) use trail_path::BEND;
pub use trail_path::{TrailPath, TrailPoint};

use self::trail_path::{cut, stride, thin};
use self::values::Values;
use super::simulation::Entry;
use super::tallies::Tallies;
use super::{Frame, Lagging, MomentState, Sector};
use crate::physics::{BodySnapshot, ContactSnapshot, Impact};
use crate::scene::{Scene, Showing, Timeline, Trail};

/// The earlier positions of bodies, as a frame shows them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Past {
    /// The requested trails.
    pub trails: Vec<TrailPath>,
    /// The requested ghosts, in order of time.
    pub ghosts: Vec<Arc<Ghost>>,
    /// The points that cameras with a lag look at.
    pub lagging: Vec<Lagging>,
    /// The complete sectors of each swept area, in order of time.
    pub areas: Vec<Vec<Arc<Sector>>>,
    /// The smallest distance so far of each pair in `approaches` of the scene, m. NaN before both bodies have been present.
    pub closest: Vec<f64>,
}

/// A copy of a body at an earlier time, for drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    /// The time of the ghost, s.
    pub time: f64,
    /// The state of the body at the time of the ghost.
    pub body: BodySnapshot,
    /// The contacts of the body at the time of the ghost. Empty unless the ghost shows contact forces.
    pub contacts: Vec<ContactSnapshot>,
    /// The values at the time of the ghost that its look follows.
    pub look: GhostLook,
}

/// The values that the look of a ghost follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GhostLook {
    /// The value that the color follows. `None` if the color never changes, or if the value is not finite.
    pub color: Option<f64>,
    /// The value that the size follows. `None` if the size never changes, or if the value is not finite.
    pub scale: Option<f64>,
    /// Whether the body was drawn then.
    pub is_drawn: bool,
}

/// Collects the trails, ghosts and delayed camera targets of a run, frame by frame.
#[derive(Clone, Default)]
pub(super) struct History {
    /// The bodies with trails or ghosts: the index of each, and the scene's settings for its trail and ghosts.
    requests: Arc<[(usize, Showing)]>,
    /// The mass of each body with trails or ghosts, kg. Infinite for a body that no force moves.
    masses: Arc<[f64]>,
    /// The points of each trail. Each point comes with the number of its frame, or of the next frame if it lies between frames.
    paths: Vec<Vec<(usize, TrailPoint)>>,
    /// The state of each body with a trail in the last frame. `None` if the body was absent.
    last: Vec<Option<corners::At>>,
    /// The value in the last frame that the color of each trail follows.
    last_values: Vec<Option<f64>>,
    /// The values that the colors of trails and ghosts follow. `None` if all of these colors stay.
    values: Option<Arc<Values>>,
    /// The number of the last frame.
    latest: usize,
    /// The impacts since the last frame.
    impacts: Vec<Impact>,
    /// For each body with a trail, whether it was absent in the last frame.
    is_away: Vec<bool>,
    ghosts: Vec<Arc<Ghost>>,
    lagging: Vec<Lagging>,
    tallies: Tallies,
    timeline: Timeline,
}

impl History {
    /// Creates an empty history at the start of a run.
    pub(super) fn new(scene: &Scene) -> History {
        let requests = scene.bodies.iter().enumerate().map(|(number, body)| (number, &*body.showing));
        let requests = requests.filter(|(_, showing)| showing.trail.is_some() || showing.ghosts.is_some());
        let as_drawn = |(number, showing): (usize, &Showing)| {
            let mut showing = showing.clone();
            if let Some(trail) = &mut showing.trail {
                trail.at *= scene.bodies[number].look.scale;
            }
            (number, showing)
        };
        let requests: Arc<[_]> = requests.map(as_drawn).collect();
        let mass = |(number, _): &(usize, Showing)| {
            let body = &scene.bodies[*number];
            if body.start.fixed || body.motion.is_some() { f64::INFINITY } else { body.start.mass }
        };
        History {
            masses: requests.iter().map(mass).collect(),
            last: vec![None; requests.len()],
            last_values: vec![None; requests.len()],
            values: Values::new(scene).map(Arc::new),
            latest: 0,
            impacts: Vec::new(),
            paths: vec![Vec::new(); requests.len()],
            is_away: vec![false; requests.len()],
            requests,
            ghosts: Vec::new(),
            lagging: Lagging::of(scene),
            tallies: Tallies::new(scene),
            timeline: scene.simulation.timeline.clone(),
        }
    }

    /// True if the scene needs no trails, ghosts, delayed camera targets, swept areas or smallest distances.
    pub(super) fn is_idle(&self) -> bool {
        self.requests.is_empty() && self.lagging.is_empty() && self.tallies.is_idle()
    }

    /// Stores the ghosts at a moment, and the impacts since the moment before.
    pub(super) fn note_moment(&mut self, entry: &Entry) {
        self.note_ghosts(entry);
        if !self.requests.is_empty() {
            self.impacts.extend_from_slice(&entry.impacts);
        }
    }

    fn note_ghosts(&mut self, entry: &Entry) {
        let moment = &entry.snapshot;
        // A ghost's time that differs from the moment's time only by rounding counts as equal.
        let slack = self.timeline.slack();
        let mut due: Vec<(f64, usize)> = Vec::new();
        for (body, showing) in self.requests.iter() {
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
            if self.requests.iter().any(shows) { touches.collect() } else { Vec::new() }
        };
        let state = MomentState::of_entry(entry, self.latest, self.tallies.so_far());
        let look = |body: usize| match &self.values {
            Some(values) => values.of_ghost(body, &state),
            None => GhostLook { color: None, scale: None, is_drawn: true },
        };
        let ghost = |(time, id): (f64, usize)| {
            let body = *moment.body(id)?;
            Some(Arc::new(Ghost { time, body, contacts: contacts(id), look: look(id) }))
        };
        self.ghosts.extend(due.into_iter().filter_map(ghost));
    }

    /// Updates the trails and delayed camera targets with a frame.
    pub(super) fn note(&mut self, frame: &Frame) {
        self.lagging.iter_mut().for_each(|lagging| *lagging = lagging.at(frame));
        self.tallies.note(frame);
        self.latest = frame.index;
        let values = self.values_of_trails(frame);
        for (number, value) in values.into_iter().enumerate() {
            let (body, showing) = &self.requests[number];
            let Some(trail) = showing.trail else { continue };
            let present = frame.body(*body);
            let corners = self.corners(number, (frame, value), trail);
            let (trail_path, is_away) = (&mut self.paths[number], &mut self.is_away[number]);
            if std::mem::replace(is_away, present.is_none()) && present.is_some() {
                // A body may return at another place, so clear the trail from before its absence.
                trail_path.clear();
            }
            self.last[number] = present.map(|body| (frame.time, *body));
            self.last_values[number] = value;
            // The stride depends on the number of the present frame alone, so every reader keeps the same points.
            let stride = stride(trail, &self.timeline, frame.time, frame.index);
            if let Some(duration) = trail.duration {
                // The last point before the start of the trail is needed for interpolation.
                let before =
                    trail_path.iter().take_while(|(_, point)| point.time <= frame.time - duration).count();
                trail_path.drain(..before.saturating_sub(1));
            }
            trail_path.retain(|(index, point)| point.frame.is_none() || index % stride == 0);
            trail_path.extend(corners.into_iter().map(|point| (frame.index, point)));
            if frame.index.is_multiple_of(stride) {
                let Some(body) = present else { continue };
                let point = TrailPoint::of(frame.time, body, trail);
                let point = TrailPoint { frame: Some(frame.index), value, ..point };
                trail_path.push((frame.index, point));
            }
            thin(trail_path);
        }
        self.impacts.clear();
    }

    /// Returns the value at a frame, or at a moment after the last frame, that the color of each trail follows.
    fn values_of_trails(&self, frame: &Frame) -> Vec<Option<f64>> {
        let moment = MomentState::with_past(frame, self.tallies.so_far());
        let value = |(body, showing): &(usize, Showing)| {
            showing.trail.filter(|trail| trail.color.is_none())?;
            self.values.as_ref()?.of_trail(*body, &moment)
        };
        self.requests.iter().map(value).collect()
    }

    /// Computes the points of a trail at the impacts since the last frame. `now_value` is the value at the moment that the color of the trail
    /// follows.
    fn corners(
        &self,
        number: usize,
        (moment, now_value): (&Frame, Option<f64>),
        trail: Trail,
    ) -> Vec<TrailPoint> {
        let id = self.requests[number].0;
        let (Some(before), Some(now)) = (&self.last[number], moment.body(id)) else { return Vec::new() };
        let impulse = |impact: &Impact| match impact.bodies {
            [first, _] if first == id => -impact.impulse,
            [_, second] if second == id => impact.impulse,
            _ => DVec3::ZERO,
        };
        let now = (moment.time, *now);
        let values = [self.last_values[number], now_value];
        corners::between((before, &now), values, &self.impacts, impulse, self.masses[number], trail)
    }

    /// The trails, ghosts and delayed camera targets of a moment at or after the last frame.
    pub(super) fn before(&self, moment: &Frame) -> Past {
        let mut trails = Vec::new();
        let values = self.values_of_trails(moment);
        for (number, ((body, showing), trail_path)) in self.requests.iter().zip(&self.paths).enumerate() {
            let Some(trail) = showing.trail else { continue };
            let mut points: Vec<TrailPoint> = trail_path.iter().map(|(_, point)| *point).collect();
            points.extend(self.corners(number, (moment, values[number]), trail));
            if points.last().is_none_or(|last| last.time < moment.time) {
                let here = moment.body(*body).map(|body| TrailPoint::of(moment.time, body, trail));
                points.extend(here.map(|here| TrailPoint { value: values[number], ..here }));
            }
            if let Some(duration) = trail.duration {
                cut(&mut points, moment.time - duration);
            }
            trails.push(TrailPath {
                body: *body,
                points,
                stride: stride(trail, &self.timeline, moment.time, moment.index),
            });
        }
        let lagging = self.lagging.iter().map(|lagging| lagging.at(moment)).collect();
        let slack = self.timeline.slack();
        let is_past = |ghost: &&Arc<Ghost>| ghost.time < moment.time - slack;
        let ghosts = self.ghosts.iter().filter(is_past).cloned().collect();
        let mut tallies = self.tallies.clone();
        tallies.note(moment);
        let (areas, closest) = tallies.finish();
        Past { trails, ghosts, lagging, areas, closest }
    }
}
