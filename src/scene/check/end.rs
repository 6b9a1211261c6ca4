//! Reads the ends of springs and joints.

use glam::{DQuat, DVec3};

use super::super::read;
use super::Context;
use super::view::View;
use crate::physics::{Anchor, BodyId};
use crate::scene::Body;
use crate::scene::grammar::Bound;
use crate::scene::grammar::forces::end;
use crate::scene::source::{Node, Value};

/// Returns the index of the body that `node` names. `None` if no body has this name; validation has already reported that error.
pub(super) fn body(node: &Node, context: &Context<'_>) -> Option<usize> {
    node.as_str().and_then(|name| context.names.bodies.get(name)).copied()
}

/// Reads an end of a spring or a joint: the name of a body, a point of a body, or a point of the world.
pub(super) fn anchor(node: &Node, context: &Context<'_>) -> Option<Anchor> {
    match node.value {
        Value::Array(_) => read::vector(node, Bound::Any).map(Anchor::Point),
        Value::Table(ref table) => {
            let view = View::new(&end::TABLE, Some(table));
            let id = BodyId::new(body(view.node(&end::BODY)?, context)?);
            Some(Anchor::Body { id, at: view.get(&end::AT) })
        }
        _ => body(node, context).map(|body| Anchor::centre(BodyId::new(body))),
    }
}

/// Returns whether an end gives a point of its body with the key `at`.
pub(super) fn says_point(node: &Node) -> bool {
    matches!(&node.value, Value::Table(table) if table.get("at").is_some())
}

/// Returns the initial location (m) and orientation of a body.
pub(super) fn pose(id: BodyId, bodies: &[Body]) -> (DVec3, DQuat) {
    let start = &bodies[id.index()].start;
    (start.location, start.orientation)
}

/// Returns the initial location of an end in world coordinates, m.
pub(super) fn place(end: Anchor, bodies: &[Body]) -> DVec3 {
    end.place(|id| pose(id, bodies))
}
