//! The obstacles of particles: the ground, and bodies with their motion between two frames of the animation.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::{BodyState, RecordedMotion};
use crate::contact::{Ball, Pose, Solid, Surface, Tree};
use crate::{BodyId, BodySnapshot, Motion, Shape};

/// The largest number of parts that are searched one by one. More parts are stored in a tree of boxes.
const MAX_PARTS_WITHOUT_TREE: usize = 24;

/// A body or the ground, as an obstacle that stops particles.
#[derive(Clone, Debug)]
pub struct Obstacle {
    /// The body of the obstacle; `None` for an obstacle that is fixed at `location`, such as the ground.
    body: Option<BodyId>,
    location: DVec3,
    solid: Solid,
    surface: Surface,
}

impl Obstacle {
    /// Creates the obstacle of a body. Returns `None` for a shape whose surface does not consist of convex parts, such as a torus.
    #[must_use]
    pub fn body(body: BodyId, shape: &Shape, surface: Surface) -> Option<Obstacle> {
        let solid = Solid::of(shape)?;
        Some(Obstacle { body: Some(body), location: DVec3::ZERO, solid, surface })
    }

    /// Creates the obstacle of level ground at a height, m.
    #[must_use]
    pub fn ground(height: f64, surface: Surface) -> Option<Obstacle> {
        let solid = Solid::of(&Shape::Plane { normal: DVec3::Y })?;
        Some(Obstacle { body: None, location: DVec3::Y * height, solid, surface })
    }
}

/// All obstacles that are present in one interval of time, with their motion.
#[derive(Debug)]
pub struct Scenery {
    obstacles: Arc<[Obstacle]>,
    placed: Vec<Placed>,
    /// The parts that are half-spaces. They are infinite, so they are checked for each particle.
    endless: Vec<Target>,
    /// All finite parts, each with a box that contains it during the whole interval. A mesh is a single entry with one box.
    parts: Vec<(Target, [DVec3; 2])>,
    tree: Option<Tree>,
    /// An upper bound for the speed of the obstacles' surfaces, m/s. Half-spaces count with the speed of their centre.
    fastest: f64,
}

/// An obstacle that is present in the time interval of its [`Scenery`], with its motion.
#[derive(Debug)]
struct Placed {
    obstacle: usize,
    course: RecordedMotion,
    /// The pose of an obstacle at rest; `None` if the obstacle moves.
    still: Option<Pose>,
    /// Upper bounds for the acceleration of the centre of mass, m/s², and for the angular speed, rad/s.
    bend: f64,
    turning: f64,
}

/// The indices of an obstacle and of one of its convex parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Target {
    placed: usize,
    part: usize,
}

/// The pose and the velocities of an obstacle at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObstacleState {
    pub(super) pose: Pose,
    pub(super) state: BodyState,
}

/// The distance between a particle and a part of an obstacle at one time, with bounds for its change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    /// The gap between the surfaces of particle and part, m; negative if they overlap.
    pub(super) gap: f64,
    /// The unit normal of the contact, from the part towards the particle, world axes.
    pub(super) normal: DVec3,
    /// The velocity of the obstacle's material at the centre of the particle, m/s.
    pub(super) velocity: DVec3,
    /// An upper bound for the speed at which the obstacle's motion closes the gap, m/s.
    pub(super) coming: f64,
    /// An upper bound for the rate of change of the speed `coming`, m/s².
    pub(super) bend: f64,
    /// Whether the part is a triangle with a neighbour that is nearer to the particle. The particle then touches the neighbour.
    pub(super) is_hidden: bool,
}

impl ObstacleState {
    /// Returns the velocity of a point that moves with the obstacle, m/s. `place` is the position of the point, world axes, m.
    pub(super) fn velocity(&self, place: DVec3) -> DVec3 {
        self.state.velocity + self.state.angular_velocity.cross(place - self.state.location)
    }
}

impl Scenery {
    /// Collects the obstacles that are present in an interval. `course` returns the motion of a body in the interval, or `None` if the
    /// body is absent.
    #[must_use]
    pub fn new(obstacles: &Arc<[Obstacle]>, course: &dyn Fn(BodyId) -> Option<RecordedMotion>) -> Scenery {
        let (mut placed, mut endless, mut parts) = (Vec::new(), Vec::new(), Vec::new());
        for (number, obstacle) in obstacles.iter().enumerate() {
            let course = match obstacle.body {
                Some(body) => course(body).map(RecordedMotion::at_rest),
                None => Some(RecordedMotion::still(BodySnapshot {
                    location: obstacle.location,
                    orientation: DQuat::IDENTITY,
                    ..BodySnapshot::default()
                })),
            };
            let Some(course) = course else { continue };
            let there = Placed::new(number, course);
            let solid = &obstacle.solid;
            if solid.has_tree() {
                let target = Target { placed: placed.len(), part: 0 };
                parts.push((target, there.around(solid.reach())));
            } else {
                for part in 0..solid.count() {
                    let target = Target { placed: placed.len(), part };
                    if solid.is_endless(part) {
                        endless.push(target);
                    } else {
                        parts.push((target, there.box_of(solid, part)));
                    }
                }
            }
            placed.push(there);
        }
        let speed = |there: &Placed| {
            let reach = obstacles[there.obstacle].solid.reach();
            there.speed() + if reach.is_finite() { there.turning * reach } else { 0.0 }
        };
        let fastest = placed.iter().map(speed).fold(0.0, f64::max);
        let tree = (parts.len() > MAX_PARTS_WITHOUT_TREE)
            .then(|| Tree::new(parts.iter().map(|(_, bounds)| *bounds)));
        Scenery { obstacles: obstacles.clone(), placed, endless, parts, tree, fastest }
    }

    /// An upper bound for the speed at which an obstacle carries a particle, m/s.
    pub(super) fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Returns true if no obstacle is present.
    pub(super) fn is_empty(&self) -> bool {
        self.placed.is_empty()
    }

    /// Returns whether a ball whose centre stays in the box from `low` to `high` may touch an obstacle between the two `times`, s.
    pub(super) fn may_stop(&self, ball: &Ball, [low, high]: [DVec3; 2], times: [f64; 2]) -> bool {
        let mut targets = Vec::new();
        self.near([low, high], ball.radius(), times, &mut targets);
        let centre = 0.5 * (low + high);
        let half = (0.5 * (high - low)).length();
        targets.iter().any(|target| {
            let is_flat = self.solid(target).is_endless(target.part) && self.is_still(target);
            !is_flat || self.seen(ball, target, centre, times[0]).gap <= half
        })
    }

    /// Writes to `found` all parts of obstacles that may come closer to a box than `within` (m) between the times `begin` and `end` (s).
    pub(super) fn near(
        &self,
        [low, high]: [DVec3; 2],
        within: f64,
        [begin, end]: [f64; 2],
        found: &mut Vec<Target>,
    ) {
        found.clear();
        found.extend(&self.endless);
        let (low, high) = (low - within, high + within);
        let mut take = |(target, bounds): &(Target, [DVec3; 2])| {
            if !(bounds[0].cmple(high).all() && bounds[1].cmpge(low).all()) {
                return;
            }
            let solid = self.solid(target);
            if solid.has_tree() {
                let half = (0.5 * (high - low)).length() + self.placed[target.placed].way(solid, begin, end);
                let place = self.standing(target, begin).pose.local(0.5 * (low + high));
                let parts = solid.parts_near(place, half);
                found.extend(parts.into_iter().map(|part| Target { part, ..*target }));
            } else {
                found.push(*target);
            }
        };
        match &self.tree {
            None => self.parts.iter().for_each(take),
            Some(tree) => {
                tree.near([low, high], 0.0, self.parts.len()).into_iter().for_each(|i| take(&self.parts[i]));
            }
        }
    }

    /// Returns the pose and the velocities of an obstacle at time `t`, s.
    pub(super) fn standing(&self, target: &Target, t: f64) -> ObstacleState {
        let Placed { course, still, .. } = &self.placed[target.placed];
        match *still {
            Some(pose) => {
                let Pose { location, orientation } = pose;
                let (velocity, angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
                ObstacleState { pose, state: BodyState { location, orientation, velocity, angular_velocity } }
            }
            None => {
                let state = course.state(t);
                ObstacleState {
                    pose: Pose { location: state.location, orientation: state.orientation },
                    state,
                }
            }
        }
    }

    /// Returns the acceleration of a point that moves with an obstacle, at time `t` (s), m/s².
    pub(super) fn acceleration(&self, target: &Target, place: DVec3, t: f64) -> DVec3 {
        let Placed { course, still, .. } = &self.placed[target.placed];
        if still.is_some() {
            return DVec3::ZERO;
        }
        let (at, turning) = (course.at(t), course.angular_acceleration(t));
        let arm = place - at.location;
        at.acceleration + turning.cross(arm) + at.angular_velocity.cross(at.angular_velocity.cross(arm))
    }

    /// Returns the gap between a part and a ball with its centre at `place`, at time `t` (s), with bounds for its change.
    pub(super) fn seen(&self, ball: &Ball, target: &Target, place: DVec3, t: f64) -> Near {
        let standing = self.standing(target, t);
        let solid = self.solid(target);
        let (mut gap, mut normal, _) = ball.nearest(place, solid, target.part, &standing.pose);
        let is_hidden = gap == f64::INFINITY;
        if is_hidden && let Some(apart) = ball.apart(place, solid, target.part, &standing.pose) {
            (gap, normal) = apart;
        }
        let placed = &self.placed[target.placed];
        if placed.still.is_some() {
            return Near { gap, normal, velocity: DVec3::ZERO, coming: 0.0, bend: 0.0, is_hidden };
        }
        let reach = solid.reach_of(target.part);
        // A half-space has no finite bounding radius. Its points near the particle are about as far from its centre as the particle is.
        let reach = if reach.is_finite() { reach } else { 2.0 * (place - standing.pose.location).length() };
        let speed = placed.turning;
        let coming = normal.dot(standing.state.velocity) + speed * reach;
        let bend = placed.bend + speed * speed * reach + 2.0 * speed * standing.state.velocity.length();
        Near { gap, normal, velocity: standing.velocity(place), coming, bend, is_hidden }
    }

    /// Returns the gap (m) and the normal between a part and a ball with its centre at `place`, all in the axes of the obstacle.
    pub(super) fn seen_within(&self, ball: &Ball, target: &Target, place: DVec3) -> (f64, DVec3) {
        let (gap, normal, _) = ball.nearest(place, self.solid(target), target.part, &Pose::IDENTITY);
        (gap, normal)
    }

    /// Returns whether an obstacle is at rest during the interval.
    pub(super) fn is_still(&self, target: &Target) -> bool {
        self.placed[target.placed].still.is_some()
    }

    /// Returns whether two parts belong to the same obstacle.
    pub(super) fn is_same(one: &Target, other: &Target) -> bool {
        one.placed == other.placed
    }

    pub(super) fn surface(&self, target: &Target) -> &Surface {
        &self.obstacles[self.placed[target.placed].obstacle].surface
    }

    fn solid(&self, target: &Target) -> &Solid {
        &self.obstacles[self.placed[target.placed].obstacle].solid
    }
}

impl Placed {
    fn new(obstacle: usize, course: RecordedMotion) -> Placed {
        let state = course.state(0.0);
        let still =
            course.is_still().then_some(Pose { location: state.location, orientation: state.orientation });
        let (bend, turning) = (course.largest_acceleration(), course.largest_turning());
        Placed { obstacle, course, still, bend, turning }
    }

    /// Returns an upper bound for the speed of the obstacle's centre of mass, m/s.
    fn speed(&self) -> f64 {
        if self.still.is_some() { 0.0 } else { self.course.largest_speed() }
    }

    /// Returns an upper bound for the displacement of any point of the obstacle between two times, m.
    fn way(&self, solid: &Solid, begin: f64, end: f64) -> f64 {
        if self.still.is_some() {
            return 0.0;
        }
        let (span, speed) = (end - begin, self.course.state(begin).velocity.length());
        span * (speed + 0.5 * span * self.bend + self.turning * solid.reach())
    }

    /// Returns a box that contains all points within `reach` (m) of the obstacle's centre of mass during the interval.
    fn around(&self, reach: f64) -> [DVec3; 2] {
        let [low, high] = self.course.places();
        [low - reach, high + reach]
    }

    /// Returns a box that contains a part of the obstacle during the whole interval.
    fn box_of(&self, solid: &Solid, part: usize) -> [DVec3; 2] {
        if let Some(pose) = &self.still {
            return solid.box_of(part, pose);
        }
        if self.turning > 0.0 {
            return self.around(solid.reach_of(part));
        }
        let orientation = self.course.state(0.0).orientation;
        let [low, high] = solid.box_of(part, &Pose { location: DVec3::ZERO, orientation });
        let [from, to] = self.course.places();
        [from + low, to + high]
    }
}
