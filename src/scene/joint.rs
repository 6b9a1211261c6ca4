//! The joints of a checked scene.

use std::sync::Arc;

use super::Color;
use crate::dynamics::{Anchor, Ball, Constraint, Fixed, Hinge, Rod, Slider};

/// What holds two bodies together, or a body to a point of the world.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name, unique among joints.
    pub name: String,
    /// What it is.
    pub kind: JointKind,
    /// How it is drawn, if it is.
    pub look: Option<JointLook>,
}

/// The kinds of joints. A [`BodyId`](crate::dynamics::BodyId) is the number of a body of the scene.
#[derive(Clone, Copy, Debug)]
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
    /// What holds the bodies of a world.
    pub fn constraint(&self) -> Arc<dyn Constraint> {
        match *self {
            JointKind::Ball(ball) => Arc::new(ball),
            JointKind::Hinge(hinge) => Arc::new(hinge),
            JointKind::Slider(slider) => Arc::new(slider),
            JointKind::Fixed(fixed) => Arc::new(fixed),
            JointKind::Rod(rod) => Arc::new(rod),
        }
    }

    /// Its two ends.
    pub fn between(&self) -> [Anchor; 2] {
        match self {
            JointKind::Ball(Ball { between })
            | JointKind::Hinge(Hinge { between, .. })
            | JointKind::Slider(Slider { between, .. })
            | JointKind::Fixed(Fixed { between, .. })
            | JointKind::Rod(Rod { between, .. }) => *between,
        }
    }

    /// Whether it reaches from one end to the other, as a rod does; the ends of all others are at one place.
    pub fn is_long(&self) -> bool {
        matches!(self, JointKind::Rod(_))
    }
}
