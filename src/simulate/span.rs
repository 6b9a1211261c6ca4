//! The space that a run takes from its start to each of several times.

use glam::{DMat3, DVec3};

use super::Reach;
use super::course::{Course, Stretch};
use super::outliers::Paths;
use super::survey::Outliers;
use super::vectors::{anchors, axis, root, shown};
use crate::physics::BodySnapshot;
use crate::scene::{Body, Quantity, Scene};

/// The growth factor of the run's space after which the next span is stored.
const STORED_GROWTH_FACTOR: f64 = 1.2;

/// An axis-aligned box in the world, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates, m.
    pub min: DVec3,
    /// The corner with the largest coordinates, m.
    pub max: DVec3,
}

/// The space that a run takes from its start to some time.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// The time of the last included frame, s.
    pub until: f64,
    /// The box around all bodies and particles.
    pub bounds: Bounds,
    /// The box around all particles and all bodies that are not fixed. If there are none, the box around all bodies.
    pub moving: Bounds,
    /// The box around everything with a known size: bodies, particles, axes, arrows with a given scale, and the fixed ends of springs and
    /// joints.
    pub seen: Bounds,
    /// The same without fixed bodies, but with the ends of springs and joints at them. If nothing moves, the box around all that is seen.
    pub subject: Bounds,
    /// The part of all that is seen that a picture shows. Of fixed bodies around what moves that are larger, such as a wide floor, it shows only a
    /// part.
    pub shown: Bounds,
    /// The reach of arrows whose scale is chosen after the run, indexed by [`Quantity::number`].
    pub arrows: [Reach; Quantity::SCALE_COUNT],
}

/// An arrow of a joint, or of a weight, contact force or named force on a body, at one moment.
pub(super) struct ArrowNow {
    pub(super) quantity: Quantity,
    /// The drawn length of one unit of the quantity, m. `None` if it is chosen after the run.
    pub(super) scale: Option<f64>,
    /// The point where the arrow begins, m.
    pub(super) root: DVec3,
    /// The vector that the arrow shows, in the unit of its quantity.
    pub(super) vector: DVec3,
}

/// The span up to the last frame.
struct Now {
    /// The span, whose boxes `moving` and `subject` are not yet those of what moves.
    span: Span,
    /// The box around moving bodies and particles. `None` if nothing moves.
    moving: Option<Bounds>,
    /// The box around what moves, with its axes and arrows, and around the fixed ends of springs and joints.
    subject: Option<Bounds>,
}

/// Collects the spans of a run and its course, frame by frame.
pub(super) struct Spans {
    kept: Vec<Span>,
    now: Option<Now>,
    paths: Paths,
    has_arrows: bool,
    /// The box around the particles of all frames.
    particles: Option<Bounds>,
    course: Course,
}

impl Spans {
    pub(super) fn new(scene: &Scene) -> Spans {
        Spans {
            kept: Vec::new(),
            now: None,
            paths: Paths::default(),
            has_arrows: false,
            particles: None,
            course: Course::new(scene),
        }
    }

    /// Adds a frame at a time (s). `bodies` are those that the camera must show, and `arrows` those of joints, weights, contact
    /// forces and named forces.
    pub(super) fn see<'a>(
        &mut self,
        scene: &Scene,
        time: f64,
        bodies: impl Iterator<Item = &'a BodySnapshot>,
        arrows: impl Iterator<Item = ArrowNow>,
    ) {
        for frame in bodies {
            let body = &scene.bodies[frame.id];
            let Some(here) = Bounds::of(body, frame) else { continue };
            let now = self.now.get_or_insert_with(|| Now::begin(scene, time, here));
            now.span.bounds = now.span.bounds.union(here);
            let seen = now.span.see_showing(here, body, frame);
            if !body.start.fixed {
                add(&mut now.moving, here);
                add(&mut now.subject, seen);
                self.course.see(time, here);
            }
            self.paths.see(frame.id, body.start.fixed, here, seen);
            self.has_arrows |= body.showing.arrows.iter().any(Option::is_some);
        }
        let Some(now) = &mut self.now else { return };
        let mut arrows = arrows.peekable();
        self.has_arrows |= arrows.peek().is_some();
        for tip in now.span.see_arrows(arrows) {
            add(&mut now.subject, Bounds::point(tip));
        }
        self.keep(time);
    }

    /// Updates the time of the present span, and stores a copy if the span has grown enough.
    fn keep(&mut self, time: f64) {
        let Some(Now { span, .. }) = &mut self.now else { return };
        span.until = time;
        let grown = |last: &Span| span.seen.diagonal() > STORED_GROWTH_FACTOR * last.seen.diagonal();
        if self.kept.last().is_none_or(grown) {
            self.kept.extend(self.now());
        }
    }

    /// Adds the box around the particles of a frame at a time (s).
    pub(super) fn see_particles(&mut self, scene: &Scene, time: f64, here: Bounds) {
        let now = self.now.get_or_insert_with(|| Now::begin(scene, time, here));
        now.span.bounds = now.span.bounds.union(here);
        now.span.seen = now.span.seen.union(here);
        add(&mut now.moving, here);
        add(&mut now.subject, here);
        self.course.see(time, here);
        self.particles = Some(self.particles.map_or(here, |all| all.union(here)));
        self.keep(time);
    }

    /// The box around all bodies and particles so far. `None` if all bodies are planes and there are no particles.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        self.now.as_ref().map(|now| now.span.bounds)
    }

    /// Finds the outliers of the run, the bodies that fly far away. `None` if there are none, or if the scene shows arrows, since arrows may reach
    /// far themselves.
    pub(super) fn outliers(&self, scene: &Scene) -> Option<Outliers> {
        if self.has_arrows {
            return None;
        }
        let rest = self.paths.without_outliers()?;
        let add = |bounds: Bounds| self.particles.map_or(bounds, |all| all.union(bounds));
        let seen = anchors(scene).map(Bounds::point).fold(rest.seen, Bounds::union);
        let (bounds, moving, seen) = (add(rest.bounds), add(rest.moving), add(seen));
        let subject = anchors(scene).map(Bounds::point).fold(moving, Bounds::union);
        let shown = self.shown(subject, seen);
        let span = Span { bounds, moving, seen, subject, shown, ..self.now()? };
        Some(Outliers { bodies: rest.outliers, without: span })
    }

    /// Returns all stored spans by increasing time, and the course of the run. The last span is that of the whole run.
    pub(super) fn finish(mut self) -> (Vec<Span>, Vec<Stretch>) {
        let whole = self.now();
        if self.kept.last().map(|last| last.until) == whole.as_ref().map(|whole| whole.until) {
            self.kept.pop();
        }
        self.kept.extend(whole);
        (self.kept, self.course.finish())
    }

    fn now(&self) -> Option<Span> {
        let Now { span, moving, subject } = self.now.as_ref()?;
        let subject = subject.filter(|_| moving.is_some());
        Some(Span {
            moving: moving.unwrap_or(span.bounds),
            subject: subject.unwrap_or(span.seen),
            shown: subject.map_or(span.seen, |subject| self.shown(subject, span.seen)),
            ..span.clone()
        })
    }

    /// The part of all that is seen that a picture of a subject shows.
    fn shown(&self, subject: Bounds, seen: Bounds) -> Bounds {
        /// The smallest size of the subject, relative to all, at which fixed bodies are shown whole.
        const MIN_SIZE_OF_SUBJECT: f64 = 1.0 / 3.0;
        /// How far beyond the subject fixed bodies are shown otherwise, relative to its size.
        const SHOWN_BEYOND_SUBJECT: f64 = 0.5;
        let size = subject.size();
        if size >= MIN_SIZE_OF_SUBJECT * seen.size() {
            return seen;
        }
        let beyond = DVec3::splat(SHOWN_BEYOND_SUBJECT * size);
        let near = Bounds { min: subject.min - beyond, max: subject.max + beyond };
        let shown = |fixed: Bounds| match fixed.size() > size && fixed.overlaps(near) {
            true => fixed.within(near),
            false => fixed,
        };
        self.paths.of_fixed().map(shown).fold(subject, Bounds::union)
    }
}

impl Now {
    /// Begins the first span with a box, and with the fixed ends of springs and joints.
    fn begin(scene: &Scene, time: f64, here: Bounds) -> Now {
        let anchors = anchors(scene).map(Bounds::point).reduce(Bounds::union);
        let seen = anchors.map_or(here, |anchors| anchors.union(here));
        let span = Span {
            until: time,
            bounds: here,
            moving: here,
            seen,
            subject: seen,
            shown: seen,
            arrows: Default::default(),
        };
        Now { span, moving: None, subject: anchors }
    }
}

/// Adds a box to another one.
fn add(all: &mut Option<Bounds>, here: Bounds) {
    *all = Some(all.map_or(here, |all| all.union(here)));
}

impl Span {
    /// Returns the span with the part of its boxes that a picture shows.
    #[must_use]
    pub fn framed(&self) -> Span {
        Span { bounds: self.bounds.within(self.shown), seen: self.seen.within(self.shown), ..self.clone() }
    }

    /// Adds arrows of joints, weights, contact forces and named forces. Returns the tips of those with a given scale.
    fn see_arrows(&mut self, arrows: impl Iterator<Item = ArrowNow>) -> Vec<DVec3> {
        let mut tips = Vec::new();
        for ArrowNow { quantity, scale, root, vector } in arrows {
            match scale.map(|scale| root + vector * scale) {
                Some(tip) if tip.is_finite() => tips.push(tip),
                Some(_) => {}
                None => self.arrows[quantity.number()].add(root, vector),
            }
        }
        self.seen = tips.iter().copied().map(Bounds::point).fold(self.seen, Bounds::union);
        tips
    }

    /// Adds a body with its drawn axes, arrows and trail. Returns the box around the body, its axes, its trail and its arrows with a given
    /// scale.
    fn see_showing(&mut self, here: Bounds, body: &Body, frame: &BodySnapshot) -> Bounds {
        let mut seen = here;
        for (quantity, arrow) in Quantity::OF_BODIES.into_iter().zip(body.showing.arrows) {
            let Some(arrow) = arrow else { continue };
            let vector = shown(quantity, body, frame);
            let root = root(body, frame, vector);
            match arrow.scale {
                Some(scale) => seen = seen.union_if_finite(root + vector * scale),
                None => self.arrows[quantity.number()].add(root, vector),
            }
        }
        if let Some(trail) = body.showing.trail.filter(|trail| trail.at != DVec3::ZERO) {
            seen = seen.union_if_finite(frame.point(trail.at * body.look.scale).0);
        }
        if let Some(length) = axis(body) {
            for axis in DMat3::from_quat(frame.orientation).to_cols_array_2d() {
                seen = seen.union_if_finite(frame.location + DVec3::from_array(axis) * length * 1.1);
            }
        }
        self.seen = self.seen.union(seen);
        seen
    }
}

impl Bounds {
    /// The box around a body in its drawn size. `None` for a plane, which has no bounds.
    fn of(body: &Body, frame: &BodySnapshot) -> Option<Bounds> {
        let (shape, factor) = (&body.shape, body.look.scale);
        let reach =
            |direction: DVec3| shape.support(frame.orientation, direction).map(|reach| reach * factor);
        let max = DVec3::new(reach(DVec3::X)?, reach(DVec3::Y)?, reach(DVec3::Z)?);
        let min = DVec3::new(reach(-DVec3::X)?, reach(-DVec3::Y)?, reach(-DVec3::Z)?);
        Some(Bounds { min: frame.location - min, max: frame.location + max })
    }

    /// Creates a box with a single point.
    fn point(point: DVec3) -> Bounds {
        Bounds { min: point, max: point }
    }

    /// The smallest box that contains both boxes.
    #[must_use]
    pub fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The part of the box in another box that overlaps it.
    fn within(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    fn overlaps(self, other: Bounds) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// The largest edge of the box, m.
    fn size(self) -> f64 {
        (self.max - self.min).max_element()
    }

    /// The length of the box's diagonal, m.
    pub fn diagonal(self) -> f64 {
        (self.max - self.min).length()
    }

    /// The center of the box, m.
    pub fn middle(self) -> DVec3 {
        (self.min + self.max) / 2.0
    }

    fn union_if_finite(self, point: DVec3) -> Bounds {
        if point.is_finite() { self.union(Bounds::point(point)) } else { self }
    }
}
