//! Makes the forces of a world from those of a scene.

use std::sync::Arc;

use crate::physics::{Force, FormulaForce};
use crate::scene::ForceKind;

/// Returns a force of a scene as forces of a world. A chain of springs gives one force for each spring.
pub(crate) fn forces(kind: &ForceKind) -> Vec<Arc<dyn Force>> {
    match kind {
        ForceKind::OnEach(force) => vec![force.clone()],
        ForceKind::Between(force) => vec![force.clone()],
        ForceKind::Formula { bodies, law } => vec![Arc::new(FormulaForce::new(bodies.clone(), law.clone()))],
        ForceKind::Buoyancy { liquid, .. } => vec![Arc::new(liquid.clone())],
        ForceKind::Dipoles(dipoles) => vec![Arc::new(dipoles.clone())],
        ForceKind::J2(j2) => vec![Arc::new(j2.clone())],
        ForceKind::Spring { links, .. } => links.iter().map(|link| Arc::new(*link) as Arc<_>).collect(),
    }
}
