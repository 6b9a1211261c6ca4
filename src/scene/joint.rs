//! The joints of a checked scene.

use glam::DQuat;

use super::timed::Timed;
use super::{Arrow, Color};
use crate::physics::{
    Anchor, Ball, BodyId, BodySnapshot, Coordinate, Fixed, Gear, Hinge, Motor, Pulley, Rod, Rope, Servo,
    Slider, Target,
};

/// A joint between two bodies, or between a body and a point of the world.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The name of the joint, unique among joints.
    pub name: String,
    /// The kind of the joint, with its parameters.
    pub kind: JointKind,
    /// The motor that drives the joint like a spring with a damper. `None` if the joint has no such motor.
    pub servo: Option<Servo>,
    /// Whether the two bodies of the joint collide with each other.
    pub collides: bool,
    /// The look of the joint. `None` if the joint is not drawn.
    pub look: Option<JointLook>,
    /// Arrows for the joint's reaction force and reaction torque, in the order of [`Quantity::OF_JOINTS`](super::Quantity::OF_JOINTS).
    pub arrows: [Option<Arrow>; 2],
}

/// The kinds of joints. A [`BodyId`](crate::physics::BodyId) is the index of a body in the scene.
#[derive(Clone, Debug)]
pub enum JointKind {
    /// A ball joint: keeps two points together.
    Ball(Ball),
    /// A hinge: keeps two points together, and keeps two axes parallel.
    Hinge(Hinge),
    /// A slider: lets one body move only along an axis of the other body.
    Slider(Slider),
    /// A fixed joint: prevents any relative motion of two bodies.
    Fixed(Fixed),
    /// A rod: keeps the distance between two points constant.
    Rod(Rod),
    /// A rope: keeps the distance between two points from exceeding the length of the rope.
    Rope(Rope),
    /// A pulley: a rope that runs over points.
    Pulley(Pulley),
    /// A gear: couples the coordinates of two hinges or sliders.
    Gear(Gear),
}

/// The look of a joint. A rod is drawn from end to end, any other joint as a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLook {
    /// The radius of the drawn rod or pin, m. `None` for the default radius.
    pub radius: Option<f64>,
    /// The color of the drawn joint. `None` for the default color.
    pub color: Option<Color>,
}

impl JointKind {
    /// Returns the two ends of the joint. For a gear, returns the second end of each of the two coupled joints.
    pub fn between(&self) -> [Anchor; 2] {
        match self {
            JointKind::Ball(Ball { between })
            | JointKind::Hinge(Hinge { between, .. })
            | JointKind::Slider(Slider { between, .. })
            | JointKind::Fixed(Fixed { between, .. })
            | JointKind::Rod(Rod { between, .. })
            | JointKind::Rope(Rope { between, .. }) => *between,
            JointKind::Pulley(pulley) => pulley.between(),
            JointKind::Gear(gear) => gear.joints.map(|joint| joint.between[1]),
        }
    }

    /// Returns the constraint error of the joint, m: the distance between two points that should coincide, the distance of a point from the
    /// axis of its slider, or the error in the length of a rod or rope. `body` returns the state of a body. `None` while a body of the
    /// joint is absent, and for pulleys and gears.
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

    /// Returns the free coordinate of a joint: the angle of a hinge, or the position of a slider. `None` for other joints.
    pub fn coordinate(&self) -> Option<Coordinate> {
        match self {
            JointKind::Hinge(hinge) => Some(hinge.coordinate()),
            JointKind::Slider(slider) => Some(slider.coordinate()),
            _ => None,
        }
    }

    /// Returns the motor of a hinge or slider. `None` for other joints, and without a motor.
    pub fn motor(&self) -> Option<&Motor> {
        match self {
            JointKind::Hinge(hinge) => hinge.freedom.motor.as_ref(),
            JointKind::Slider(slider) => slider.freedom.motor.as_ref(),
            _ => None,
        }
    }

    /// Returns the name of the kind if rapier, which steps scenes of many bodies, has no such joint.
    pub fn unknown_to_rapier(&self) -> Option<&'static str> {
        match self {
            JointKind::Ball(_)
            | JointKind::Hinge(_)
            | JointKind::Slider(_)
            | JointKind::Fixed(_)
            | JointKind::Rod(_)
            | JointKind::Rope(_) => None,
            JointKind::Pulley(_) => Some("pulley"),
            JointKind::Gear(_) => Some("gear"),
        }
    }
}

/// A joint coordinate that the scene prescribes as a function of time.
#[derive(Clone, Debug)]
pub struct PrescribedCoordinate {
    /// The number or formula of the time, in the scene's unit.
    pub value: Timed,
    /// The factor that converts the scene's unit to SI units, such as π/180 for degrees.
    pub unit: f64,
}

impl Target for PrescribedCoordinate {
    fn at(&self, t: f64) -> [f64; 3] {
        [self.value.at(t), self.value.rate(t), self.value.curvature(t)].map(|value| self.unit * value)
    }
}
