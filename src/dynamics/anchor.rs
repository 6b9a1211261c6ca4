//! Ends of springs and joints.

use glam::{DQuat, DVec3};

use super::BodyId;

/// The end of a spring or a joint: the point to which it is fastened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Anchor {
    /// A point of a body.
    Body {
        /// The body.
        id: BodyId,
        /// The point in the body's frame, relative to its centre of mass, m.
        at: DVec3,
    },
    /// A point of the world, m.
    Point(DVec3),
}

impl Anchor {
    /// The centre of mass of a body.
    #[must_use]
    pub const fn centre(id: BodyId) -> Anchor {
        Anchor::Body { id, at: DVec3::ZERO }
    }

    /// The body, if it is one.
    #[must_use]
    pub fn body(self) -> Option<BodyId> {
        match self {
            Anchor::Body { id, .. } => Some(id),
            Anchor::Point(_) => None,
        }
    }

    /// Whether it is the centre of mass of a body.
    #[must_use]
    pub fn is_centre(self) -> bool {
        matches!(self, Anchor::Body { at: DVec3::ZERO, .. })
    }

    /// The position of the end, m. The closure returns the location and orientation (`world_from_body`) of a body.
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
