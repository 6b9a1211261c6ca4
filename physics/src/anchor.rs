//! The ends of springs and joints.

use glam::{DQuat, DVec3};

use super::BodyId;

/// An end of a spring or a joint: the point of a body or of the world to which it is fastened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Anchor {
    /// A point that moves with a body.
    Body {
        /// The body that the end is fastened to.
        id: BodyId,
        /// The point in body axes, relative to the body's center of mass, m.
        at: DVec3,
    },
    /// A fixed point of the world, m.
    Point(DVec3),
}

impl Anchor {
    /// Creates an end at the center of mass of a body.
    #[must_use]
    pub const fn centre(id: BodyId) -> Anchor {
        Anchor::Body { id, at: DVec3::ZERO }
    }

    /// Returns the body that the end is fastened to; `None` for a point of the world.
    #[must_use]
    pub fn body(self) -> Option<BodyId> {
        match self {
            Anchor::Body { id, .. } => Some(id),
            Anchor::Point(_) => None,
        }
    }

    /// Returns true if the end is at the center of mass of a body.
    #[must_use]
    pub fn is_centre(self) -> bool {
        matches!(self, Anchor::Body { at: DVec3::ZERO, .. })
    }

    /// Returns the position of the end, world axes, m. The closure `pose` returns the position of a body's center of mass (m) and the
    /// rotation from body axes to world axes.
    #[must_use]
    pub fn place(self, pose: impl FnOnce(BodyId) -> (DVec3, DQuat)) -> DVec3 {
        match self {
            Anchor::Body { id, at } => {
                let (location, orientation) = pose(id);
                if at == DVec3::ZERO { location } else { location + orientation * at }
            }
            Anchor::Point(point) => point,
        }
    }
}
