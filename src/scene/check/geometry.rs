//! What the placing of copies must know of a body before there is one: how large it is, and how it is turned.

use glam::DQuat;

use super::view::View;
use super::{Context, body, shape};
use crate::scene::grammar::TableSpec;
use crate::scene::source::Table;

/// How large a body is, and how it is turned.
pub(in crate::scene) struct Geometry {
    /// The radius of a ball around its centre that holds it, m; none where it is endless.
    pub(in crate::scene) radius: Option<f64>,
    /// How it is turned by its own keys.
    pub(in crate::scene) orientation: DQuat,
}

/// The geometry of a body that is described by a table. What is wrong with it, its own reading says.
pub(in crate::scene) fn of(table: &Table, spec: &'static TableSpec) -> Geometry {
    let context = &mut Context::silent();
    let view = View::new(spec, Some(table));
    let radius = shape::read("", &view.table("shape"), context).bounding_radius();
    Geometry { radius, orientation: body::orientation("", &view, context) }
}
