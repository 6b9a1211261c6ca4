//! The vectors of a scene that a user drags in the picture.

use glam::DVec3;

use crate::diagnostic::Span;

/// A vector in the text of the scene, such as the location of a body, which a page shows as a handle.
#[derive(Clone, Debug, PartialEq)]
pub struct Handle {
    /// The key of the vector, such as `body.ball.location`.
    pub key: String,
    /// What the vector means.
    pub kind: HandleKind,
    /// The index of the body to which it belongs. `None` for a vector of something else.
    pub body: Option<usize>,
    /// The vector, m or m/s.
    pub value: DVec3,
    /// Where the vector stands in the text.
    pub place: HandlePlace,
}

/// The meaning of a [`Handle`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandleKind {
    /// A point of the world.
    Point,
    /// The velocity of the body at the start.
    Velocity,
}

/// Where the vector of a [`Handle`] stands in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandlePlace {
    /// Its three components.
    Given([Span; 3]),
    /// The text does not give the vector. This is the name of the table to which it belongs.
    Missing(Span),
}
