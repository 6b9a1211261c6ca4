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
pub(in crate::scene) struct Geometer<'a> {
    context: Context<'a>,
    /// The body before, and its radius.
    last: Option<(Table, Option<f64>)>,
}

impl<'a> Geometer<'a> {
    /// For the bodies of a scene whose files are in a folder.
    pub(in crate::scene) fn new(folder: Option<&'a Path>, trust: bool) -> Geometer<'a> {
        Geometer { context: Context { folder, trust, ..Context::silent() }, last: None }
    }

    /// The geometry of a body that is described by a table. What is wrong with it, its own reading says.
    pub(in crate::scene) fn of(&mut self, table: &Table, spec: &'static TableSpec) -> Geometry {
        let view = View::new(spec, Some(table));
        let shape = view.table("shape");
        let radius = match &self.last {
            Some((last, radius)) if View::new(spec, Some(last)).table("shape").is_same(&shape) => *radius,
            _ => shape::read("", &shape, &mut self.context).bounding_radius(),
        };
        self.last = Some((table.clone(), radius));
        let orientation = body::orientation("", &view, &mut self.context);
        self.context.diagnostics.clear();
        Geometry { radius, orientation }
    }
}
