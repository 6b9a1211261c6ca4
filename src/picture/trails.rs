//! Lines along the ways of bodies.

use glam::DVec3;

use super::colors;
use crate::scene::{Color, Scene};
use crate::simulate::{Frame, Way};

/// The color of the trail of a body that has no single color.
const AMBER: Color = Color([0.93, 0.55, 0.08]);
/// A trail bends by less than this from one piece to the next, radians, where pieces are long enough to be seen.
const BEND: f64 = 0.06;
/// The most pieces from one point of the way to the next.
const MOST_PIECES: f64 = 16.0;

/// The trail of a body up to a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Trail {
    /// The number of the body.
    pub body: usize,
    /// The points of the line, m, the oldest first: two at least.
    pub points: Vec<DVec3>,
    /// Half its width, m.
    pub radius: f64,
    /// Whether it becomes thin towards its end.
    pub tapers: bool,
    /// Its color.
    pub color: Color,
}

impl Trail {
    /// Half its width at one of its points, m.
    #[allow(clippy::cast_precision_loss, reason = "there are few points")]
    pub fn radius_at(&self, number: usize) -> f64 {
        match self.tapers {
            true => self.radius * (0.15 + 0.85 * number as f64 / (self.points.len() - 1) as f64),
            false => self.radius,
        }
    }
}

/// The trails of a scene.
#[derive(Clone, Debug)]
pub(super) struct Trails {
    /// Trails without points.
    trails: Vec<Trail>,
}

impl Trails {
    pub(super) fn new(scene: &Scene, stroke: f64) -> Trails {
        let mut trails = Vec::new();
        for (number, body) in scene.bodies.iter().enumerate() {
            let Some(trail) = body.showing.trail else { continue };
            let of_body = body.material.and_then(|material| colors::of_look(&scene.materials[material].look));
            trails.push(Trail {
                body: number,
                points: Vec::new(),
                radius: trail.width.unwrap_or(stroke) / 2.0,
                tapers: trail.duration.is_some(),
                color: trail.color.or(of_body).unwrap_or(AMBER),
            });
        }
        Trails { trails }
    }

    /// All that are asked for, without points.
    pub(super) fn planned(&self) -> &[Trail] {
        &self.trails
    }

    /// The trails up to a frame.
    pub(super) fn up_to(&self, frame: &Frame) -> Vec<Trail> {
        let trail = |way: &Way| {
            let trail = self.trails.iter().find(|trail| trail.body == way.body)?;
            let points = line(way, trail.radius);
            let is_line = points.len() >= 2 && points.iter().all(|point| point.is_finite());
            is_line.then(|| Trail { points, ..trail.clone() })
        };
        frame.past.trails.iter().filter_map(trail).collect()
    }
}

/// The points of a line along a way, none nearer to the next than a piece of it is wide.
fn line(way: &Way, radius: f64) -> Vec<DVec3> {
    let mut line: Vec<DVec3> = way.points.first().map(|point| point.location).into_iter().collect();
    let mut put = |point: DVec3| {
        if line.last().is_none_or(|last| last.distance(point) > radius) {
            line.push(point);
        }
    };
    for pair in way.points.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let bend = from.velocity.angle_between(to.velocity);
        let pieces = if bend.is_finite() { (bend / BEND).ceil().clamp(1.0, MOST_PIECES) } else { 1.0 };
        let mut piece = 1.0;
        while piece <= pieces {
            put(from.towards(to, from.time + (to.time - from.time) * piece / pieces));
            piece += 1.0;
        }
    }
    line
}
