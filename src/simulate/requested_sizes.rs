//! The largest sizes of arrows, trails, ghosts, springs and sliders in a run. They serve to warn about requested things that are too small
//! to see.

use glam::{DQuat, DVec3};

use super::span::ArrowNow;
use super::vectors::{root, shown, surface};
use super::{Frame, Load};
use crate::physics::{Anchor, BodySnapshot, Coordinate, Shape};
use crate::scene::{Body, ForceKind, JointKind, Quantity, Scene};

/// The largest sizes of the requested arrows, trails, ghosts, springs and sliders in a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RequestedSizes {
    /// The requested arrows for motion and force, in the order of bodies, then of [`Quantity::OF_BODIES`].
    pub arrows: Vec<RequestedArrow>,
    /// The requested arrows for weight and contact forces, in the order of bodies, then of [`Quantity::OF_LOADS`].
    pub loads: Vec<RequestedArrow>,
    /// The forces with arrows: the index of each, and the length of its longest vector at any body in the run, N.
    pub forces: Vec<(usize, f64)>,
    /// The requested trails, in the order of bodies.
    pub trails: Vec<RequestedTrail>,
    /// The requested ghosts, in the order of bodies.
    pub ghosts: Vec<RequestedGhosts>,
    /// The drawn springs, in the order of the forces. A spring force may have several springs.
    pub springs: Vec<RequestedSpring>,
    /// The drawn sliders, in the order of the joints.
    pub sliders: Vec<RequestedSlider>,
}

/// A requested arrow of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedArrow {
    /// The index of the body.
    pub body: usize,
    /// The quantity that the arrow shows.
    pub quantity: Quantity,
    /// The length of the longest vector in the run, in the SI unit of its quantity.
    pub longest: f64,
    /// The time of the first frame in which the tip of the arrow is not finite, s. `None` if all tips are finite.
    pub lost: Option<f64>,
}

/// A requested trail of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedTrail {
    /// The index of the body.
    pub body: usize,
    /// The first point of the trail, m. `None` until the body is present.
    begin: Option<DVec3>,
    /// The largest distance between the body and the first point of its trail, m.
    pub largest_distance: f64,
}

/// The requested ghosts of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedGhosts {
    /// The index of the body.
    pub body: usize,
    every: f64,
    /// The time of the first possible ghost, s. `None` until the body is present.
    first: Option<f64>,
    /// The pose of the first ghost: its location (m) and orientation. `None` before the time of the first ghost.
    stands: Option<(DVec3, DQuat)>,
    /// The largest distance between the body and its first ghost, m. `None` if there is no ghost.
    pub largest_distance: Option<f64>,
    /// The largest rotation of the body relative to its first ghost, as the cosine of half the angle.
    pub turn: f64,
}

/// A drawn spring.
#[derive(Clone, Debug, PartialEq)]
pub struct RequestedSpring {
    /// The name of the force that the spring belongs to.
    pub force: String,
    /// The two ends of the spring.
    ends: [End; 2],
    /// The largest gap between the surfaces at the two ends of the spring, m. Negative if these surfaces overlap in all frames.
    pub largest_gap: f64,
}

/// A slider whose rail is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedSlider {
    /// The index of the joint.
    pub joint: usize,
    coordinate: Coordinate,
    /// The smallest distance from the first end of the slider to the second end, along the axis, m. Negative if the second end is behind
    /// the first.
    pub least: f64,
    /// The largest distance from the first end of the slider to the second end, along the axis, m.
    pub most: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum End {
    Point(DVec3),
    /// A point on a body, in body axes and in the drawn scale, m. A spring attached at the body's center is drawn from the surface of the
    /// shape.
    Body {
        number: usize,
        at: DVec3,
        shape: Option<Shape>,
    },
}

impl RequestedSizes {
    /// Lists the arrows, trails, ghosts, springs and sliders that a scene requests, with their sizes before the first frame.
    pub(super) fn new(scene: &Scene) -> RequestedSizes {
        let end = |anchor: Anchor| match anchor {
            Anchor::Point(point) => End::Point(point),
            Anchor::Body { id, at } => {
                let body = &scene.bodies[id.index()];
                let shape = anchor.is_centre().then(|| body.drawn());
                End::Body { number: id.index(), at: at * body.look.scale, shape }
            }
        };
        let mut sizes = RequestedSizes::default();
        for (number, body) in scene.bodies.iter().enumerate() {
            for (quantity, arrow) in Quantity::OF_BODIES.into_iter().zip(body.showing.arrows) {
                let arrow =
                    arrow.map(|_| RequestedArrow { body: number, quantity, longest: 0.0, lost: None });
                sizes.arrows.extend(arrow);
            }
            for (quantity, arrow) in Quantity::OF_LOADS.into_iter().zip(body.showing.loads) {
                let arrow =
                    arrow.map(|_| RequestedArrow { body: number, quantity, longest: 0.0, lost: None });
                sizes.loads.extend(arrow);
            }
            let trail = body.showing.trail.map(|_| RequestedTrail {
                body: number,
                begin: None,
                largest_distance: 0.0,
            });
            sizes.trails.extend(trail);
            sizes.ghosts.extend(body.showing.ghosts.map(|ghosts| RequestedGhosts {
                body: number,
                every: ghosts.every,
                first: None,
                stands: None,
                largest_distance: None,
                turn: 1.0,
            }));
        }
        let with_arrows = scene.forces.iter().enumerate().filter(|(_, force)| force.arrow.is_some());
        sizes.forces = with_arrows.map(|(number, _)| (number, 0.0)).collect();
        for force in &scene.forces {
            let ForceKind::Spring { links, look: Some(_) } = &force.kind else { continue };
            sizes.springs.extend(links.iter().map(|link| RequestedSpring {
                force: force.name.clone(),
                ends: link.between.map(end),
                largest_gap: f64::NEG_INFINITY,
            }));
        }
        for (number, joint) in scene.joints.iter().enumerate() {
            let JointKind::Slider(slider) = &joint.kind else { continue };
            if joint.look.is_some() {
                let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
                sizes.sliders.push(RequestedSlider {
                    joint: number,
                    coordinate: slider.coordinate(),
                    least,
                    most,
                });
            }
        }
        sizes
    }

    /// Updates the sizes with the arrows of forces in the next frame, each with the index of its force.
    pub(super) fn see_forces(&mut self, arrows: &[(usize, ArrowNow)]) {
        for (force, longest) in &mut self.forces {
            let its = arrows.iter().filter(|(number, _)| number == force);
            *longest = its.map(|(_, arrow)| arrow.vector.length()).fold(*longest, f64::max);
        }
    }

    /// Updates the sizes with the next frame of the run and the weights and contact forces in this frame.
    pub(super) fn see(&mut self, scene: &Scene, frame: &Frame, loads: &[Load]) {
        for arrow in &mut self.loads {
            let its = loads.iter().filter(|load| (load.body, load.quantity) == (arrow.body, arrow.quantity));
            arrow.longest = its.map(|load| load.vector.length()).fold(arrow.longest, f64::max);
        }
        for arrow in &mut self.arrows {
            let Some(body) = frame.body(arrow.body) else { continue };
            arrow.see(&scene.bodies[arrow.body], body, frame.time);
        }
        for trail in &mut self.trails {
            let Some(body) = frame.body(trail.body) else { continue };
            let at = scene.bodies[trail.body].showing.trail.map_or(DVec3::ZERO, |trail| trail.at);
            let (place, _) = body.point(at * scene.bodies[trail.body].look.scale);
            let begin = *trail.begin.get_or_insert(place);
            trail.largest_distance = trail.largest_distance.max(begin.distance(place));
        }
        for ghosts in &mut self.ghosts {
            if let Some(body) = frame.body(ghosts.body) {
                ghosts.see(body, frame.time, scene.simulation.timeline.slack());
            }
        }
        for spring in &mut self.springs {
            let [Some(from), Some(to)] = spring.ends.each_ref().map(|end| end.place(frame)) else { continue };
            let along = (to - from).normalize_or_zero();
            let inside = spring.ends[0].depth(frame, along) + spring.ends[1].depth(frame, -along);
            spring.largest_gap = spring.largest_gap.max(from.distance(to) - inside);
        }
        self.sliders.iter_mut().for_each(|slider| slider.see(frame));
    }
}

impl RequestedGhosts {
    fn see(&mut self, body: &BodySnapshot, time: f64, slack: f64) {
        let every = self.every;
        let first = *self.first.get_or_insert_with(|| ((time - slack) / every).ceil() * every);
        if time < first - slack {
            return;
        }
        let (location, turn) = *self.stands.get_or_insert((body.location, body.orientation));
        self.largest_distance =
            Some(self.largest_distance.unwrap_or(0.0).max(location.distance(body.location)));
        self.turn = self.turn.min(turn.dot(body.orientation).abs());
    }
}

impl RequestedArrow {
    fn see(&mut self, body: &Body, frame: &BodySnapshot, time: f64) {
        let vector = shown(self.quantity, body, frame);
        let scale =
            body.showing.arrows.iter().zip(Quantity::OF_BODIES).find(|(_, kind)| *kind == self.quantity);
        let scale = scale.and_then(|(arrow, _)| arrow.as_ref()?.scale).unwrap_or(1.0);
        if (root(body, frame, vector) + vector * scale).is_finite() {
            self.longest = self.longest.max(vector.length());
        } else if self.lost.is_none() {
            self.lost = Some(time);
        }
    }
}

impl RequestedSlider {
    fn see(&mut self, frame: &Frame) {
        let pose = |end: Anchor| match end.body() {
            Some(id) => frame.body(id.index()).map(|body| (body.location, body.orientation)),
            None => Some((DVec3::ZERO, DQuat::IDENTITY)),
        };
        let [first, second] = self.coordinate.between;
        let (Some(one), Some(other)) = (pose(first), pose(second)) else { return };
        let apart = second.place(|_| other) - first.place(|_| one);
        let along = apart.dot(one.1 * self.coordinate.axis);
        self.least = self.least.min(along);
        self.most = self.most.max(along);
    }
}

impl End {
    /// The position of the end, m. `None` while its body is absent.
    fn place(&self, frame: &Frame) -> Option<DVec3> {
        match self {
            End::Point(point) => Some(*point),
            End::Body { number, at, .. } => {
                let body = frame.body(*number)?;
                Some(body.location + body.orientation * *at)
            }
        }
    }

    /// The distance from the center of the body to its surface in a direction, m. 0 if the end is not at a center.
    fn depth(&self, frame: &Frame, direction: DVec3) -> f64 {
        match self {
            End::Body { number, shape: Some(shape), .. } => {
                frame.body(*number).map_or(0.0, |body| surface(shape, body.orientation, direction))
            }
            End::Body { .. } | End::Point(_) => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::survey;

    #[test]
    fn the_longest_vectors_distances_and_gaps_of_a_run_are_kept() {
        let text = "simulation = { duration = 2, gravity = [0, -10, 0] }
            [body.ball]\nshape.sphere.radius = 0.5\nlocation = [3, 0, 0]\nvelocity = [0, 5, 0]\ntrail = true
            arrows.velocity = true
            [body.wall]\nshape.box.size = [1, 9, 9]\nfixed = true
            [force.s.spring]\nbetween = ['wall', 'ball', [9, 0, 0]]\nstiffness = 0";
        let sizes = survey(&Scene::parse(text).unwrap(), |_| {}).unwrap().requested;
        let [velocity] = sizes.arrows[..] else { panic!("one is asked for") };
        // The velocity changes from 5 m/s upward to 15 m/s downward.
        assert!((velocity.longest - 15.0).abs() < 1e-9 && velocity.lost.is_none(), "{velocity:?}");
        // The ball returns to its start, then falls to 10 m below. The method's error is at most v·dt.
        assert!((sizes.trails[0].largest_distance - 10.0).abs() < 0.1, "{:?}", sizes.trails);
        // At the end, the ball is 10 m below its start: √(3² + 10²) m from the center of the wall. The wall covers 0.5/3 of this distance,
        // and the ball 0.5 m.
        let far = libm::hypot(3.0, 10.0);
        let [wall, _] = &sizes.springs[..] else { panic!("a chain of two") };
        assert!((wall.largest_gap - (far * 2.5 / 3.0 - 0.5)).abs() < 0.1, "{wall:?}");
    }
}
