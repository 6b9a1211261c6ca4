//! The geometry that placing copies needs before the bodies are read: size and orientation.

use glam::DQuat;

use crate::scene::grammar::TableSpec;
use crate::scene::source::Table;

/// The size and orientation of a body.
pub(in crate::scene) struct Geometry {
    /// The radius, m, of a ball around the body's centre that contains the body. `None` for an endless body.
    pub(in crate::scene) radius: Option<f64>,
    /// The orientation that the body's own keys give.
    pub(in crate::scene) orientation: DQuat,
}

/// Reads the geometry of bodies before they are checked.
pub(in crate::scene) trait Geometer {
    /// Reads the geometry of a body from the body's table. The later check reports mistakes.
    fn of(&mut self, table: &Table, spec: &'static TableSpec) -> Geometry;
}
