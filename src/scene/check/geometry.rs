//! Reads the size and the orientation of bodies before the check, for the placement of copies.

use std::path::Path;

use super::view::View;
use super::{Context, body, shape};
use crate::diagnostic::Sources;
use crate::scene::expand::{Geometer, Geometry};
use crate::scene::grammar::TableSpec;
use crate::scene::grammar::bodies;
use crate::scene::source::Table;

/// Reads the bounding radius and the orientation of bodies before the check. Reads each mesh file only once.
pub(super) struct BodyReader<'a> {
    context: Context<'a>,
    /// The shape table of the body read before, and the bounding radius of that shape. Copies of a body share one shape table, so its
    /// radius is computed only once.
    last: Option<(Option<Table>, Option<f64>)>,
}

impl<'a> BodyReader<'a> {
    /// Creates a reader for a scene with these texts, whose files are in `folder`.
    pub(super) fn new(folder: Option<&'a Path>, trust: bool, sources: Sources) -> BodyReader<'a> {
        BodyReader { context: Context { folder, trust, ..Context::new(sources) }, last: None }
    }
}

impl Geometer for BodyReader<'_> {
    fn of(&mut self, table: &Table, spec: &'static TableSpec) -> Geometry {
        let view = View::new(spec, Some(table));
        let shape = view.table(&bodies::body::SHAPE);
        let radius = match &self.last {
            Some((last, radius)) if shape.is_same(last.as_ref()) => *radius,
            _ => shape::read("", &shape, &mut self.context).bounding_radius(),
        };
        self.last = Some((shape.to_table(), radius));
        let orientation = body::orientation("", &view, &mut self.context);
        self.context.diagnostics.clear();
        Geometry { radius, orientation }
    }
}
