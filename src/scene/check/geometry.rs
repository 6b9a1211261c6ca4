//! What the placing of copies must know of a body before there is one: how large it is, and how it is turned.

use std::path::Path;

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

/// What reads the geometry of bodies before they are checked; a mesh that several have is read once.
pub(in crate::scene) struct Geometer<'a>(Context<'a>);

impl<'a> Geometer<'a> {
    /// For the bodies of a scene whose files are in a folder.
    pub(in crate::scene) fn new(folder: Option<&'a Path>, trust: bool) -> Geometer<'a> {
        Geometer(Context { folder, trust, ..Context::silent() })
    }

    /// The geometry of a body that is described by a table. What is wrong with it, its own reading says.
    pub(in crate::scene) fn of(&mut self, table: &Table, spec: &'static TableSpec) -> Geometry {
        let view = View::new(spec, Some(table));
        let radius = shape::read("", &view.table("shape"), &mut self.0).bounding_radius();
        let orientation = body::orientation("", &view, &mut self.0);
        self.0.diagnostics.clear();
        Geometry { radius, orientation }
    }
}
