//! The geometry that placing copies needs before there is a body: its size and orientation.

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

/// Reads the geometry of bodies before they are checked.
pub(in crate::scene) trait Geometer {
    /// The geometry of a body from its table. The later check reports mistakes.
    fn of(&mut self, table: &Table, spec: &'static TableSpec) -> Geometry;
}
