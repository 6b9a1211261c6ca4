//! What the placing of copies must know of a body before there is one: how large it is, and how it is turned.

use glam::DQuat;

use crate::scene::grammar::TableSpec;
use crate::scene::source::Table;

/// How large a body is, and how it is turned.
pub(in crate::scene) struct Geometry {
    /// The radius of a ball around its centre that holds it, m; none where it is endless.
    pub(in crate::scene) radius: Option<f64>,
    /// How it is turned by its own keys.
    pub(in crate::scene) orientation: DQuat,
}

/// What reads the geometry of bodies before they are checked.
pub(in crate::scene) trait Geometer {
    /// The geometry of a body that is described by a table. What is wrong with it is said later, when it is checked.
    fn of(&mut self, table: &Table, spec: &'static TableSpec) -> Geometry;
}
