//! The joints of a checked scene.

use std::sync::Arc;

use glam::DQuat;

use super::timed::Timed;
use super::{Arrow, Color};
use crate::dynamics::{
    Anchor, Ball, BodyId, BodySnapshot, Constraint, Coordinate, Fixed, Gear, Hinge, Pulley, Rod, Rope, Servo,
    Slider, Target,
};

/// A joint between two bodies, or between a body and a point of the world.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The name of the joint, unique among joints.
    pub name: String,
    /// The kind of the joint.
    pub kind: JointKind,
    /// The motor with limited strength. `None` if the joint has none.
    pub servo: Option<Servo>,
    /// Whether the two bodies of the joint can collide with each other.
    pub collides: bool,
    /// The look of the joint. `None` if the joint is not drawn.
    pub look: Option<JointLook>,
    /// Arrows for the joint's force and torque, in the order of [`Quantity::OF_JOINTS`](super::Quantity::OF_JOINTS).
    pub arrows: [Option<Arrow>; 2],
}

/// The kinds of joints. A [`BodyId`](crate::dynamics::BodyId) is the index of a body in the scene.
#[derive(Clone, Debug)]
pub enum JointKind {
    /// Keeps two points together.
    Ball(Ball),
    /// Keeps two points together, and an axis common to both bodies.
    Hinge(Hinge),
    /// Lets one body move only along an axis of the other.
    Slider(Slider),
    /// Fastens two bodies to each other, without any relative motion.
    Fixed(Fixed),
    /// Keeps the distance between two points constant.
    Rod(Rod),
    /// Keeps the distance between two points from exceeding the length of the rope.
    Rope(Rope),
    /// A rope that runs over two points.
    Pulley(Pulley),
    /// Couples the motion of two joints.
    Gear(Gear),
}

/// The look of a joint: a rod is drawn from end to end, any other joint as a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLook {
    /// The radius of the rod or the pin, m.
    pub radius: Option<f64>,
    /// The color of the joint. `None` for the default color.
    pub color: Option<Color>,
}

impl JointKind {
    /// The constraint as the dynamics use it.
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

    /// The two ends of the joint. For a gear, the second end of each of its two joints.
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

    /// The error of the joint, m: the distance between its two points, or the error of its length. `body` returns the
    /// state of a body. `None` while a body of the joint is absent, and for pulleys and gears, which do not hold two
    /// points together.
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

    /// The angle of a hinge, or the position of a slider. `None` for other joints.
    pub fn coordinate(&self) -> Option<Coordinate> {
        match self {
            JointKind::Hinge(hinge) => Some(hinge.coordinate()),
            JointKind::Slider(slider) => Some(slider.coordinate()),
            _ => None,
        }
    }
}

/// A joint coordinate that a scene gives as a function of time.
#[derive(Clone, Debug)]
pub struct Course {
    /// The formula.
    pub value: Timed,
    /// The factor from the unit of the formula to the unit of the dynamics: π/180 for degrees.
    pub unit: f64,
}

impl Target for Course {
    fn at(&self, t: f64) -> [f64; 3] {
        [self.value.at(t), self.value.rate(t), self.value.curvature(t)].map(|value| self.unit * value)
    }
}
