//! The size and orientation of a body. The patterns of `repeat` need them before the bodies of the scene are checked.

use glam::DQuat;

use crate::scene::grammar::TableSpec;
use crate::scene::source::Table;

/// The size and orientation of a body, as far as the patterns of `repeat` need them.
pub(in crate::scene) struct Geometry {
    /// The radius, m, of a sphere around the body's center that contains the body. `None` for an unbounded body such as a plane.
    pub(in crate::scene) radius: Option<f64>,
    /// The orientation given by the body's own keys, before a pattern of copies turns the body further.
    pub(in crate::scene) orientation: DQuat,
}

/// Reads the size and orientation of a body directly from its table, before the table is checked.
pub(in crate::scene) trait Geometer {
    /// Returns the size and orientation of the body that `table` describes. Ignores errors, because the later check reports them.
    fn of(&mut self, table: &Table, spec: &'static TableSpec) -> Geometry;
}
