//! An end of a spring or a joint.

use glam::{DQuat, DVec3};

use super::super::read;
use super::Context;
use super::view::View;
use crate::dynamics::{Anchor, BodyId};
use crate::scene::Body;
use crate::scene::grammar::{Bound, END};
use crate::scene::source::{Node, Value};

/// The number of the body that is named; none if there is no such body, which the validation has said.
pub(super) fn body(node: &Node, context: &Context<'_>) -> Option<usize> {
    node.as_str().and_then(|name| context.names.bodies.get(name)).copied()
}

/// The end as written: a body by its name, a point of a body, or a point of the world.
pub(super) fn anchor(node: &Node, context: &Context<'_>) -> Option<Anchor> {
    match node.value {
        Value::Array(_) => read::vector(node, Bound::Any).map(Anchor::Point),
        Value::Table(ref table) => {
            let view = View::new(&END, Some(table));
            let id = BodyId::new(body(view.raw("body")?, context)?);
            Some(Anchor::Body { id, at: view.vector("at")? })
        }
        _ => body(node, context).map(|body| Anchor::centre(BodyId::new(body))),
    }
}

/// Whether an end says a point of its body.
pub(super) fn says_point(node: &Node) -> bool {
    matches!(&node.value, Value::Table(table) if table.get("at").is_some())
}

/// The pose of a body at the start.
pub(super) fn pose(id: BodyId, bodies: &[Body]) -> (DVec3, DQuat) {
    let start = &bodies[id.index()].start;
    (start.location, start.orientation)
}

/// The place of an end at the start.
pub(super) fn place(end: Anchor, bodies: &[Body]) -> DVec3 {
    end.place(|id| pose(id, bodies))
}
