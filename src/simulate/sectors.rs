//! The sectors that the line from a center to a body sweeps, and their areas.
//!
//! The path of the body relative to the center is known at frames. Between two frames it is the cubic of the trails. Sectors begin and end at
//! any time, also between frames. They depend on the frames of the run alone, so they are the same for any selection of frames. The line
//! sweeps the area A = ½ ∫ |r × v| dt, where r is the way from the center to the body, and v its rate of change. On a cubic, r × v is a
//! polynomial of degree 5, which Gauss's rule with three points integrates exactly. By Kepler's second law, A = L t / 2m for a central force.
//!
//! Sources: J. Kepler, *Astronomia nova*, ch. 59; H. Goldstein, *Classical Mechanics*, § 3.2.

use std::sync::Arc;

use glam::DVec3;

use super::past::{BEND, TrailPoint};
use super::{Frame, marks};
use crate::physics::{BodySnapshot, find};
use crate::scene::{Area, Scene};

/// A sector that the line from a center to a body has swept.
#[derive(Clone, Debug, PartialEq)]
pub struct Sector {
    /// The number of the sector, counted from 0.
    pub number: usize,
    /// The time at which the sector was complete, s.
    pub until: f64,
    /// The path of the body as a polyline, relative to the center, m. It has at least two points.
    pub rim: Vec<DVec3>,
    /// The area, m².
    pub area: f64,
    /// The angle between the neighboring points of the rim, as seen from the center, summed up, rad.
    pub turn: f64,
}

/// Collects the sectors of all swept areas of a run, frame by frame.
#[derive(Clone, Default)]
pub(super) struct Sweeps {
    areas: Arc<[Area]>,
    lines: Vec<Line>,
    complete: Vec<Vec<Arc<Sector>>>,
    /// Times that differ by less than this count as equal, s.
    slack: f64,
}

/// The line from a center to a body.
#[derive(Clone, Default)]
struct Line {
    /// The end of the line at the last frame, relative to its beginning. `None` if the body or the center was absent.
    last: Option<TrailPoint>,
    /// The number of the present sector, or of the next one.
    number: usize,
    sector: Option<OpenSector>,
}

/// A sector that is not complete.
#[derive(Clone)]
struct OpenSector {
    rim: Vec<DVec3>,
    /// The velocity of the body at the last point of the rim, m/s.
    velocity: DVec3,
    area: f64,
    turn: f64,
}

impl Sweeps {
    /// Begins at the start of a run.
    pub(super) fn new(scene: &Scene) -> Sweeps {
        let count = scene.areas.len();
        Sweeps {
            areas: scene.areas.as_slice().into(),
            lines: vec![Line::default(); count],
            complete: vec![Vec::new(); count],
            slack: scene.simulation.timeline.slack(),
        }
    }

    /// The complete sectors of each area, in order of time.
    pub(super) fn complete(&self) -> &[Vec<Arc<Sector>>] {
        &self.complete
    }

    pub(super) fn into_complete(self) -> Vec<Vec<Arc<Sector>>> {
        self.complete
    }

    /// Moves the lines on to a frame, or to a moment after the last frame.
    pub(super) fn note(&mut self, frame: &Frame) {
        for ((area, line), complete) in self.areas.iter().zip(&mut self.lines).zip(&mut self.complete) {
            let now = end_of_line(area, frame.time, &frame.bodies);
            let last = std::mem::replace(&mut line.last, now);
            match last.zip(now) {
                Some(ends) => line.sweep(area, ends, self.slack, complete),
                // A sector without a part of its path is not shown.
                None => line.sector = None,
            }
        }
    }
}

/// The end of the line at a time (s), relative to its beginning. `None` while the body or the center is absent.
fn end_of_line(area: &Area, time: f64, bodies: &[BodySnapshot]) -> Option<TrailPoint> {
    let (center, drift) = marks::motion(area.center, bodies)?;
    let body = find(bodies, area.body)?;
    Some(TrailPoint {
        time,
        location: body.location - center,
        velocity: body.velocity - drift,
        frame: None,
        value: None,
    })
}

impl Line {
    /// Sweeps from one frame to the next. Appends the sectors that are complete.
    fn sweep(
        &mut self,
        area: &Area,
        (last, now): (TrailPoint, TrailPoint),
        slack: f64,
        complete: &mut Vec<Arc<Sector>>,
    ) {
        let mut at = last.time;
        loop {
            let [begin, end] = area.times(self.number);
            if end > area.until + slack || begin > now.time + slack {
                return;
            }
            if self.sector.is_none() {
                if begin < last.time - slack {
                    // The beginning was not seen.
                    self.number += 1;
                    continue;
                }
                at = begin.clamp(last.time, now.time);
                self.sector = Some(OpenSector::new(last.towards(&now, at), last.velocity_towards(&now, at)));
            }
            let Some(sector) = &mut self.sector else { return };
            let is_complete = end <= now.time + slack;
            let stop = if is_complete { end.min(now.time) } else { now.time };
            sector.sweep((&last, &now), [at, stop], is_complete);
            if !is_complete {
                return;
            }
            at = stop;
            let number = self.number;
            let sector = self.sector.take();
            complete.extend(sector.map(|OpenSector { rim, area, turn, .. }| {
                Arc::new(Sector { number, until: end, rim, area, turn })
            }));
            self.number += 1;
        }
    }
}

impl OpenSector {
    fn new(place: DVec3, velocity: DVec3) -> OpenSector {
        OpenSector { rim: vec![place], velocity, area: 0.0, turn: 0.0 }
    }

    /// Sweeps from one time to another (s) on the path between two frames. `is_complete` tells whether the sector ends there.
    fn sweep(&mut self, (last, now): (&TrailPoint, &TrailPoint), [from, to]: [f64; 2], is_complete: bool) {
        if to > from {
            self.area += swept((last, now), [from, to]);
        }
        let pieces = last.pieces_towards(now);
        let mut piece = 1.0;
        while piece <= pieces {
            let time = from + (to - from) * piece / pieces;
            let velocity = last.velocity_towards(now, time);
            // A straight part of the path needs no points.
            let is_end = is_complete && piece >= pieces;
            // A body at rest has no direction.
            let bend = self.velocity.angle_between(velocity);
            if is_end || bend >= BEND / 2.0 || bend.is_nan() {
                self.put(last.towards(now, time));
                self.velocity = velocity;
            }
            piece += 1.0;
        }
    }

    fn put(&mut self, place: DVec3) {
        let Some(&before) = self.rim.last() else { return };
        self.turn += libm::atan2(before.cross(place).length(), before.dot(place));
        self.rim.push(place);
    }
}

/// The area (m²) that the line sweeps between two times (s) on the path between two frames.
fn swept((last, now): (&TrailPoint, &TrailPoint), [from, to]: [f64; 2]) -> f64 {
    /// The points and the weights of Gauss's rule on the interval from −1 to 1: 0 and ±√(3/5).
    const GAUSS_LEGENDRE_RULE: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
    let half = 0.5 * (to - from);
    let rate = |(point, weight): (f64, f64)| {
        let time = from + half * (1.0 + point);
        weight * last.towards(now, time).cross(last.velocity_towards(now, time)).length()
    };
    0.5 * half * GAUSS_LEGENDRE_RULE.into_iter().map(rate).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::simulate::{Frames, survey};

    /// A planet on an ellipse with a semi-major axis of 1 m and the eccentricity 0.5, about a sun at (1, 2, 3), in a plane that is tilted
    /// about the x axis. Its period is 2 s, since G M = π².
    fn kepler(keys: &str) -> Scene {
        let text = format!(
            "simulation = {{ duration = 5, frame_rate = 100, step = 0.001, integrator = 'yoshida4' }}
            [body.sun]\nshape.sphere.radius = 0.05\nfixed = true\nmass = 1\nlocation = [1, 2, 3]
            [body.planet]\nshape.sphere.radius = 0.01\nmass = 1e-6\nlocation = [1.5, 2, 3]
            velocity = [0, '0.6*pi*sqrt(3)', '0.8*pi*sqrt(3)']
            [force.gravity.gravitation]\nconstant = 'pi^2'\n{keys}"
        );
        Scene::parse(&text).unwrap_or_else(|report| panic!("{report}"))
    }

    fn sectors(scene: &Scene, time: f64) -> Vec<Arc<Sector>> {
        Frames::at(scene, time).unwrap().past.areas[0].clone()
    }

    /// Kepler's second law. The whole ellipse has the area π a b, and r × v = a b 2π/T at any time: π √3/2 in m²/s.
    #[test]
    fn sectors_of_equal_times_have_equal_areas() {
        // The interval of 0.123 s is none of frames.
        let scene = kepler("[area.a]\nbody = 'planet'\ncenter = 'sun'\nevery = 0.123");
        let all = sectors(&scene, 5.0);
        assert_eq!(all.len(), 40);
        // The method keeps L, so only the cubic between frames has an error: (ω h)⁴/360 of a circular motion, at the perihelion 4e-7.
        let expected = 0.5 * PI * 0.75_f64.sqrt() * 0.123;
        for sector in &all {
            assert!((sector.area / expected - 1.0).abs() < 1e-6, "{} {}", sector.number, sector.area);
            // The triangles of the picture fill the sector.
            let drawn: f64 = sector.rim.windows(2).map(|pair| 0.5 * pair[0].cross(pair[1]).length()).sum();
            assert!((drawn / expected - 1.0).abs() < 2e-3, "{drawn}");
            assert!(sector.rim.len() < 60);
        }
        // The sectors are very different, although their areas are equal.
        let turns = all.iter().map(|sector| sector.turn);
        assert!(turns.clone().fold(0.0, f64::max) > 5.0 * turns.fold(9.0, f64::min));
        let ring = kepler("[area.a]\nbody = 'planet'\ncenter = [1, 2, 3]\nfrom = 0.3\nuntil = 2.3");
        let [whole] = &sectors(&ring, 5.0)[..] else { panic!("one sector") };
        assert!((whole.area / (PI * 0.75_f64.sqrt()) - 1.0).abs() < 1e-6 && (whole.turn - TAU).abs() < 1e-4);
        assert!(sectors(&ring, 2.29).is_empty());
    }

    /// About a body that moves at a constant velocity, the areas are those about the body at rest.
    #[test]
    fn areas_are_relative_to_the_center() {
        let area = "[area.a]\nbody = 'b'\ncenter = 'a'\nevery = 0.25";
        let text = |drift: f64| {
            format!(
                "simulation = {{ duration = 1, integrator = 'rk4' }}
                [body.a]\nshape.sphere.radius = 0.1\nvelocity = [{drift}, 0, 0]
                [body.b]\nshape.sphere.radius = 0.1\nlocation = [0, 2, 0]\nvelocity = [{drift} + 3, 0, 0]\n{area}"
            )
            .replace(&format!("[{drift} + 3"), &format!("[{}", drift + 3.0))
        };
        for drift in [0.0, 7.0] {
            let all = sectors(&Scene::parse(&text(drift)).unwrap(), 1.0);
            assert_eq!(all.len(), 4);
            for sector in &all {
                // A straight line at the distance 2 m, at 3 m/s.
                assert!((sector.area - 0.5 * 2.0 * 3.0 * 0.25).abs() < 1e-12, "{sector:?}");
                assert_eq!(sector.rim.len(), 2, "a straight path needs no more");
            }
        }
    }

    #[test]
    fn sectors_are_the_same_for_any_way_to_a_frame() {
        let scene = kepler("[area.a]\nbody = 'planet'\ncenter = 'sun'\nevery = 0.07");
        for frame in Frames::new(&scene).step_by(61) {
            let frame = frame.unwrap();
            assert_eq!(sectors(&scene, frame.time), frame.past.areas[0]);
        }
        // Between two frames, the sectors that were complete before are the same.
        let (between, later) = (sectors(&scene, 1.234), sectors(&scene, 3.0));
        assert_eq!(between[..], later[..between.len()]);
        // A curve of a plot is made without the past of frames.
        let scene = kepler("[area.a]\nbody = 'planet'\ncenter = 'sun'\nevery = 0.07\n[plot.p]\ny = 'area.a'");
        let curves = survey(&scene, |_| {}).unwrap().curves;
        assert_eq!(curves[0].last().unwrap().at.unwrap()[1], sectors(&scene, 5.0).last().unwrap().area);
        assert_eq!(curves[0][0].at, None, "no sector is complete at the start");
    }

    /// While the body is absent, no sector is swept. A sector is shown only if its whole path was seen.
    #[test]
    fn a_sector_needs_its_whole_path() {
        let text = "simulation = { duration = 2, integrator = 'rk4' }
            [body.b]\nshape.sphere.radius = 0.1\nlocation = [0, 2, 0]\nvelocity = [3, 0, 0]\nstart = 0.3\nend = 1.6
            [area.a]\nbody = 'b'\ncenter = [0, 0, 0]\nevery = 0.25";
        let all = sectors(&Scene::parse(text).unwrap(), 2.0);
        assert_eq!(all.iter().map(|sector| sector.number).collect::<Vec<_>>(), [2, 3, 4, 5]);
    }
}
