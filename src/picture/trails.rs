//! Trails: lines along the paths of bodies.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::color_maps::shade;
use super::colors;
use super::stage::LineWidths;
use crate::decimal::decimal_step;
use crate::scene::{Color, Scene};
use crate::simulate::{Frame, TrailPath, TrailPoint};

/// The default color of a trail if the body has no single color.
const DEFAULT_TRAIL_COLOR: Color = Color([0.93, 0.55, 0.08]);
/// The width of a trail, relative to the smallest visible distance. A trail is some pixels wide.
const TRAIL_WIDTH: f64 = 50.0;
/// The smallest width of a tapering trail at its oldest point, relative to that at the body.
const MIN_TAIL_WIDTH: f64 = 0.15;
/// The number of pieces in a stretch. A piece connects the points of two stored frames.
const PIECES_PER_STRETCH: usize = 32;
/// The largest number of stretches of a trail that the cache holds: twice as many as one frame can show.
const MAX_CACHED_STRETCHES: usize = 32;

/// The trail of a body up to some time.
#[derive(Clone, Debug, PartialEq)]
pub struct Trail {
    /// The index of the body.
    pub body: usize,
    /// The points of the trail, m, by increasing time. The list has at least two points.
    pub points: Vec<DVec3>,
    /// The complete stretches of the trail, in order. Each stretch is the same in all frames that contain it.
    pub stretches: Vec<Stretch>,
    /// The largest absolute value of the points' coordinates, m.
    pub reach: f64,
    /// Half the width of the trail, m.
    pub radius: f64,
    /// The distance below which details are invisible, m.
    pub fineness: f64,
    /// True if the trail tapers towards its oldest point.
    pub tapers: bool,
    /// Half the width of the trail at its oldest point, m.
    pub tail: f64,
    /// The color of the trail. If the color follows a value, the middle one of its map.
    pub color: Color,
    /// The color map of the trail, by its index in the scene. `None` for a trail of one color.
    pub map: Option<usize>,
    /// The color of each point, as an index into the colors of the map. Empty for a trail of one color.
    pub shades: Vec<u16>,
}

/// A complete part of a trail. Its points are bit-identical in all later frames, for any width of the trail. `stride` and `number`
/// identify a stretch among those of the same body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// The number of frames between two stored points of the path.
    pub stride: usize,
    /// The index of the stretch among all stretches of this stride, from 0.
    pub number: usize,
    /// The index of the stretch's first point in [`Trail::points`].
    pub first: usize,
    /// The index of the stretch's last point in [`Trail::points`]. It may be the first point of the next stretch.
    pub last: usize,
}

impl Trail {
    /// Uses the width `widths.stroke` for a trail without a given width. The tail of a trail is wide enough to have no gaps.
    fn of_width(self, widths: LineWidths) -> Trail {
        let radius = if self.radius > 0.0 { self.radius } else { widths.stroke / 2.0 };
        let tail = match self.tapers {
            true => (MIN_TAIL_WIDTH * radius).max(widths.thinnest / 2.0).min(radius),
            false => radius,
        };
        Trail { radius, tail, ..self }
    }

    /// Half the width of the trail at one of its points, m.
    #[allow(clippy::cast_precision_loss, reason = "there are few points")]
    pub fn radius_at(&self, number: usize) -> f64 {
        self.tail + (self.radius - self.tail) * number as f64 / (self.points.len() - 1) as f64
    }
}

/// The trails of a scene.
#[derive(Clone, Debug)]
pub(super) struct Trails {
    /// The trails that the scene requests, in the order of bodies.
    trails: Vec<Planned>,
}

#[derive(Clone, Debug)]
struct Planned {
    /// The trail without points. The radius is 0 if the scene gives no width.
    trail: Trail,
    /// The smallest distance between two points, m. It is the same in all frames, so that stretches can be reused.
    least: f64,
    /// The values of the first and the last color. `None` for a trail of one color.
    range: Option<[f64; 2]>,
    stretches: Arc<Remembered>,
}

/// A cache of the latest stretches of a trail. Consecutive frames share nearly all stretches, and computing them is most of the work.
#[derive(Debug, Default)]
struct Remembered {
    made: Mutex<VecDeque<Made>>,
}

/// A stretch with its points, identified by its stride and number.
#[derive(Clone, Debug)]
struct Made {
    stride: usize,
    number: usize,
    part: TrailPart,
}

/// The points of a part of a trail. `reach` is the largest absolute value of their coordinates, m, or infinite if a coordinate is not
/// finite.
#[derive(Clone, Debug)]
struct TrailPart {
    points: Arc<[Spot]>,
    reach: f64,
}

/// A point of a trail (m), and its color as an index into the colors of the map; 0 for a trail of one color.
type Spot = (DVec3, u16);

impl TrailPart {
    fn of(points: Vec<Spot>) -> TrailPart {
        let far =
            |(point, _): &Spot| if point.is_finite() { point.abs().max_element() } else { f64::INFINITY };
        TrailPart { reach: points.iter().map(far).fold(0.0, f64::max), points: points.into() }
    }
}

impl Remembered {
    /// Returns the stretch with a stride and a number from the cache. Calls `make` if the cache does not contain it.
    fn part(&self, (stride, number): (usize, usize), make: impl FnOnce() -> TrailPart) -> TrailPart {
        let made = || self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |made: &&Made| (made.stride, made.number) == (stride, number);
        if let Some(it) = made().iter().find(is_it) {
            return it.part.clone();
        }
        let part = make();
        let mut made = made();
        if made.len() >= MAX_CACHED_STRETCHES {
            made.pop_front();
        }
        made.push_back(Made { stride, number, part: part.clone() });
        part
    }
}

impl Trails {
    /// Plans the trails of a scene. `narrowest` is the smallest default width of a trail in the run (m). It
    /// determines the fineness of trails without a given width. `ranges` are the values of the first and the last color of each color map.
    pub(super) fn new(scene: &Scene, narrowest: f64, ranges: &[[f64; 2]]) -> Trails {
        let mut trails = Vec::new();
        for (number, body) in scene.bodies.iter().enumerate() {
            let Some(trail) = body.showing.trail else { continue };
            let of_body = body.material.and_then(|material| scene.materials[material].look.color());
            let of_body = of_body.map(|color| colors::seen(color, scene.environment.is_dark()));
            let least = trail.width.unwrap_or(narrowest) / 2.0;
            let trail = Trail {
                body: number,
                points: Vec::new(),
                stretches: Vec::new(),
                reach: 0.0,
                radius: trail.width.unwrap_or(0.0) / 2.0,
                fineness: decimal_step(least / TRAIL_WIDTH),
                tapers: trail.duration.is_some(),
                tail: 0.0,
                color: trail.color.or(of_body).unwrap_or(DEFAULT_TRAIL_COLOR),
                map: scene.trail_map_of(body),
                shades: Vec::new(),
            };
            let range = trail.map.map(|map| ranges.get(map).copied().unwrap_or([0.0, 1.0]));
            trails.push(Planned { trail, least, range, stretches: Arc::default() });
        }
        Trails { trails }
    }

    /// The requested trails without points.
    pub(super) fn planned(&self, widths: LineWidths) -> impl Iterator<Item = Trail> {
        self.trails.iter().map(move |planned| planned.trail.clone().of_width(widths))
    }

    /// Computes the trails up to a frame.
    pub(super) fn up_to(&self, frame: &Frame, widths: LineWidths) -> Vec<Trail> {
        let trail = |path: &TrailPath| {
            let of = self.trails.binary_search_by_key(&path.body, |planned| planned.trail.body).ok()?;
            let Planned { trail, least, range, stretches } = &self.trails[of];
            let Line { points, shades, stretches, reach, .. } = Line::along(path, *least, *range, stretches);
            let is_line = points.len() >= 2 && reach.is_finite();
            let shades = if range.is_some() { shades } else { Vec::new() };
            is_line.then(|| Trail { points, shades, stretches, reach, ..trail.clone().of_width(widths) })
        };
        frame.past.trails.iter().filter_map(trail).collect()
    }
}

/// A trail under construction along a path.
struct Line {
    points: Vec<DVec3>,
    /// The color of each point.
    shades: Vec<u16>,
    stretches: Vec<Stretch>,
    /// The largest absolute value of the coordinates, m, or infinite if a coordinate is not finite.
    reach: f64,
    /// The smallest distance between two points, m.
    least: f64,
}

impl Line {
    /// Computes the points of a trail along a path, at least `least` (m) apart. The points of a stretch depend only on its own part of the
    /// path. `range` has the values of the first and the last color.
    fn along(path: &TrailPath, least: f64, range: Option<[f64; 2]>, remembered: &Remembered) -> Line {
        let mut line =
            Line { points: Vec::new(), shades: Vec::new(), stretches: Vec::new(), reach: 0.0, least };
        let mut rest = path.points.as_slice();
        while rest.len() > 1 {
            let found = stretch_at(rest, path.stride);
            let number = found.map(|(number, _)| number);
            let end = found.map_or_else(|| until_stretch(rest, path.stride), |(_, end)| end);
            let make = || TrailPart::of(between(&rest[..=end], least, range));
            let TrailPart { points, reach } = match number {
                Some(number) => remembered.part((path.stride, number), make),
                None => make(),
            };
            line.reach = line.reach.max(reach);
            match number {
                Some(number) if points.len() > 1 => {
                    // If both parts have a point in common, keep only one copy, in the new stretch.
                    if line.points.last() == points.first().map(|(point, _)| point) {
                        line.points.pop();
                        line.shades.pop();
                    }
                    let first = line.points.len();
                    line.points.extend(points.iter().map(|(point, _)| *point));
                    line.shades.extend(points.iter().map(|(_, shade)| *shade));
                    line.stretches.push(Stretch {
                        stride: path.stride,
                        number,
                        first,
                        last: line.points.len() - 1,
                    });
                }
                _ => points.iter().for_each(|point| line.put(*point)),
            }
            rest = &rest[end..];
        }
        line
    }

    /// Appends a point to the trail. Skips points that are too near to the last point.
    fn put(&mut self, (point, shade): Spot) {
        if self.points.last().is_none_or(|last| last.distance(point) > self.least) {
            self.points.push(point);
            self.shades.push(shade);
        }
    }
}

/// If a complete stretch begins at the first point, returns the number of the stretch and the index of its last point. Points at impacts
/// lie between those of frames and are not counted.
fn stretch_at(points: &[TrailPoint], stride: usize) -> Option<(usize, usize)> {
    let frames = stride * PIECES_PER_STRETCH;
    let begin = points.first()?.frame.filter(|frame| frame.is_multiple_of(frames))?;
    let mut of_frames = points.iter().enumerate().filter_map(|(place, point)| Some((place, point.frame?)));
    let (end, frame) = of_frames.nth(PIECES_PER_STRETCH)?;
    (frame == begin + frames).then_some((begin / frames, end))
}

/// Returns the index of the first point after `points[0]` at which a stretch may begin: a section of `PIECES_PER_STRETCH` pieces, which later frames
/// use as well. If there is none, returns the index of the last point.
fn until_stretch(points: &[TrailPoint], stride: usize) -> usize {
    let begins = |point: &TrailPoint| {
        point.frame.is_some_and(|frame| frame.is_multiple_of(stride * PIECES_PER_STRETCH))
    };
    let next = points.iter().skip(1).position(begins);
    next.map_or(points.len() - 1, |next| next + 1)
}

/// Computes the points of a trail along a part of a path, at least `least` (m) apart. Both ends are included unless the whole part is
/// shorter than `least`. `range` has the values of the first and the last color.
fn between(path: &[TrailPoint], least: f64, range: Option<[f64; 2]>) -> Vec<Spot> {
    let shade = |value: Option<f64>| range.map_or(0, |range| shade(value, range));
    let spot = |point: &TrailPoint| (point.location, shade(point.value));
    let mut line: Vec<Spot> = path.first().map(spot).into_iter().collect();
    let mut put = |point: DVec3, value: Option<f64>| {
        if line.last().is_none_or(|(last, _)| last.distance(point) > least) {
            line.push((point, shade(value)));
        }
    };
    for pair in path.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let pieces = from.pieces_towards(to);
        let mut piece = 1.0;
        while piece <= pieces {
            let time = from.time + (to.time - from.time) * piece / pieces;
            put(from.towards(to, time), from.value_towards(to, time));
            piece += 1.0;
        }
    }
    // The part must end exactly where the next part begins.
    if let Some(end) = path.last().map(spot) {
        let is_near = |(point, _): &Spot| point.distance(end.0) <= least;
        while line.len() > 1 && line.last().is_some_and(is_near) {
            line.pop();
        }
        if !line.last().is_some_and(is_near) {
            line.push(end);
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Frames, survey};

    const WIDTHS: LineWidths = LineWidths { stroke: 0.01, thinnest: 0.005 };

    /// The trails of a frame do not depend on the cache: frames in any order, or one frame alone, have the same trails.
    #[test]
    fn what_is_remembered_of_a_trail_changes_nothing() {
        let scene = Scene::parse(
            "simulation.duration = 60\n[body.b]\nshape.sphere.radius = 0.1\ntrail = true\n\
             motion.formula.location = ['cos(t)', 'sin(t)', 't/9']\nmaterial.color.map.of = 'x'",
        );
        let scene = scene.unwrap();
        let ranges = survey(&scene, |_| {}).unwrap().color_ranges;
        let often = Trails::new(&scene, 0.01, &ranges);
        let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
        for frame in frames.iter().chain(frames.iter().rev()).step_by(37) {
            let trails = often.up_to(frame, WIDTHS);
            assert_eq!(trails, Trails::new(&scene, 0.01, &ranges).up_to(frame, WIDTHS), "{}", frame.index);
            let far = |trail: &Trail| {
                trail.points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max)
            };
            assert!(trails.iter().all(|trail| trail.reach == far(trail)));
            // The color at x is that of the palette at (x + 1)/2. Between two frames, x differs from a straight line by less than 10⁻³.
            for trail in &trails {
                assert_eq!(trail.points.len(), trail.shades.len());
                for (point, shade) in trail.points.iter().zip(&trail.shades) {
                    assert!(
                        (f64::from(*shade) + 0.5 - 128.0 * (point.x + 1.0)).abs() < 2.0,
                        "{point} {shade}"
                    );
                }
            }
        }
        let remembered = often.trails[0].stretches.made.lock().unwrap();
        assert!((17..=MAX_CACHED_STRETCHES).contains(&remembered.len()), "{}", remembered.len());
    }

    /// The tail of a tapering trail has the width of the thinnest line, if that is more than a part of its own width.
    #[test]
    fn a_tail_is_wide_enough_to_have_no_gaps() {
        let tail = |keys: &str, thinnest: f64| {
            let scene = format!("[body.b]\nshape.sphere.radius = 1\ntrail = {{ {keys} }}\n");
            let trails = Trails::new(&Scene::parse(&scene).unwrap(), 0.01, &[]);
            let widths = LineWidths { stroke: 0.04, thinnest };
            trails.planned(widths).next().unwrap().tail
        };
        assert_eq!(tail("", 0.01), 0.02);
        assert_eq!(tail("duration = 1", 0.001), MIN_TAIL_WIDTH * 0.02);
        assert_eq!(tail("duration = 1", 0.01), 0.005);
        assert_eq!(tail("duration = 1, width = 0.006", 0.01), 0.003);
    }
}
