//! The joints of a checked scene.

use std::sync::Arc;

use glam::DQuat;

use super::timed::Timed;
use super::{Arrow, Color};
use crate::dynamics::{
    Anchor, Ball, BodyId, BodySnapshot, Constraint, Coordinate, Fixed, Gear, Hinge, Pulley, Rod, Rope, Servo,
    Slider, Target,
};

/// A joint: it holds two bodies together, or a body to a point of the world.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name, unique among joints.
    pub name: String,
    /// Its kind.
    pub kind: JointKind,
    /// The motor that gives way, if it has one.
    pub servo: Option<Servo>,
    /// Whether the bodies that it joins can collide with each other.
    pub collides: bool,
    /// How it is drawn, if it is.
    pub look: Option<JointLook>,
    /// Arrows for what it does, in the order of [`Quantity::OF_JOINTS`](super::Quantity::OF_JOINTS).
    pub arrows: [Option<Arrow>; 2],
}

/// The kinds of joints. A [`BodyId`](crate::dynamics::BodyId) is the number of a body of the scene.
#[derive(Clone, Debug)]
pub enum JointKind {
    /// Two points stay together.
    Ball(Ball),
    /// Two points stay together, and one axis is common.
    Hinge(Hinge),
    /// One body moves along an axis of the other.
    Slider(Slider),
    /// Two bodies move as one.
    Fixed(Fixed),
    /// Two points keep their distance.
    Rod(Rod),
    /// The distance of two points does not grow.
    Rope(Rope),
    /// A rope that runs over two points.
    Pulley(Pulley),
    /// Two joints move together.
    Gear(Gear),
}

/// How a joint is drawn: a rod from end to end, any other as a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLook {
    /// The radius of the rod or the pin, m.
    pub radius: Option<f64>,
    /// Its color.
    pub color: Option<Color>,
}

impl JointKind {
    /// The constraint for a world.
    pub fn constraint(&self) -> Arc<dyn Constraint> {
        match self {
            JointKind::Ball(ball) => Arc::new(*ball),
            JointKind::Hinge(hinge) => Arc::new(hinge.clone()),
            JointKind::Slider(slider) => Arc::new(slider.clone()),
            JointKind::Fixed(fixed) => Arc::new(*fixed),
            JointKind::Rod(rod) => Arc::new(*rod),
            JointKind::Rope(rope) => Arc::new(*rope),
            JointKind::Pulley(pulley) => Arc::new(*pulley),
            JointKind::Gear(gear) => Arc::new(*gear),
        }
    }

    /// Its two ends; those of a gear are what the two joints turn.
    pub fn between(&self) -> [Anchor; 2] {
        match self {
            JointKind::Ball(Ball { between })
            | JointKind::Hinge(Hinge { between, .. })
            | JointKind::Slider(Slider { between, .. })
            | JointKind::Fixed(Fixed { between, .. })
            | JointKind::Rod(Rod { between, .. })
            | JointKind::Rope(Rope { between, .. })
            | JointKind::Pulley(Pulley { between, .. }) => *between,
            JointKind::Gear(gear) => gear.joints.map(|joint| joint.between[1]),
        }
    }

    /// The error of the joint, m: the distance between its two points, or the error of its length. The closure gives the state of
    /// a body. `None` while a body of the joint is absent, and for pulleys and gears, which hold no two points together.
    pub fn gap(&self, body: impl Fn(BodyId) -> Option<BodySnapshot>) -> Option<f64> {
        let ends = self.between().map(|end| match end {
            Anchor::Body { id, at } => body(id).map(|body| (body.point(at).0, body.orientation)),
            Anchor::Point(point) => Some((point, DQuat::IDENTITY)),
        });
        let [Some((from, turn)), Some((to, _))] = ends else { return None };
        let way = to - from;
        Some(match self {
            JointKind::Ball(_) | JointKind::Hinge(_) | JointKind::Fixed(_) => way.length(),
            JointKind::Slider(slider) => way.reject_from_normalized(turn * slider.axis).length(),
            JointKind::Rod(rod) => (way.length() - rod.length).abs(),
            JointKind::Rope(rope) => (way.length() - rope.length).max(0.0),
            JointKind::Pulley(_) | JointKind::Gear(_) => return None,
        })
    }

    /// The angle of a hinge, or the way of a slider.
    pub fn coordinate(&self) -> Option<Coordinate> {
        match self {
            JointKind::Hinge(hinge) => Some(hinge.coordinate()),
            JointKind::Slider(slider) => Some(slider.coordinate()),
            _ => None,
        }
    }
}

/// A value of a joint that a scene gives by a formula.
#[derive(Clone, Debug)]
pub struct Course {
    /// The formula.
    pub value: Timed,
    /// One unit of it in the dynamics' unit: for degrees, π/180.
    pub unit: f64,
}

impl Target for Course {
    fn at(&self, t: f64) -> [f64; 3] {
        [self.value.at(t), self.value.rate(t), self.value.curvature(t)].map(|value| self.unit * value)
    }
}
