//! The forces of a checked scene.

use std::sync::Arc;

use super::force_formula::FormulaLaw;
use super::{Color, SpringLook};
use crate::physics::{Anchor, BodyId, Buoyancy, Dipoles, ForceBetween, ForceOnEach, J2, Spring};

/// A named force between bodies, on bodies, or on particles. The `force` key of a single body is part of that body instead.
#[derive(Clone, Debug)]
pub struct Force {
    /// The name of the force, unique among forces.
    pub name: String,
    /// The kind of the force, with its parameters.
    pub kind: ForceKind,
    /// The arrows of the force at its bodies. `None` if they are not drawn.
    pub arrow: Option<super::Arrow>,
    /// The indices of the emitters whose particles the force acts on.
    pub emitters: Vec<usize>,
}

/// The kinds of forces. A [`BodyId`] is the index of a body in the scene.
#[derive(Clone, Debug)]
pub enum ForceKind {
    /// A force on each of several bodies alone, such as drag.
    OnEach(Arc<dyn ForceOnEach>),
    /// A force between pairs of bodies, such as gravitation.
    Between(Arc<dyn ForceBetween>),
    /// A force given by formulas.
    Formula {
        /// The bodies that the force acts on.
        bodies: Vec<BodyId>,
        /// The formulas of the force and its potential.
        law: Arc<FormulaLaw>,
    },
    /// Buoyancy in a liquid.
    Buoyancy {
        /// The liquid, and the bodies in it.
        liquid: Buoyancy,
        /// The color of its surface. `None` if the surface is not drawn.
        surface: Option<Color>,
    },
    /// The forces and torques between magnetic dipoles.
    Dipoles(Dipoles),
    /// The gravity of an oblate planet (the J₂ term).
    J2(J2),
    /// A spring with a damper, or a chain of such springs.
    Spring {
        /// The springs of the chain, in order.
        links: Vec<Spring>,
        /// The look of the springs. `None` if the springs are not drawn.
        look: Option<SpringLook>,
    },
}

impl ForceKind {
    /// Returns the bodies that the force acts on, each once, in ascending order. Some of them may be fixed.
    pub fn bodies(&self) -> Vec<BodyId> {
        let both = |one: &[BodyId], other: Option<&[BodyId]>| {
            one.iter().chain(other.into_iter().flatten()).copied().collect()
        };
        let mut bodies: Vec<BodyId> = match self {
            ForceKind::OnEach(force) => force.bodies().to_vec(),
            ForceKind::Formula { bodies, .. } => bodies.clone(),
            ForceKind::Between(force) => both(force.bodies(), force.against()),
            ForceKind::Dipoles(Dipoles { bodies, against, .. }) => both(bodies, against.as_deref()),
            ForceKind::Buoyancy { liquid, .. } => liquid.bodies.iter().map(|(body, _)| *body).collect(),
            ForceKind::J2(J2 { planet, bodies, .. }) => both(bodies, Some(&[*planet])),
            ForceKind::Spring { links, .. } => {
                links.iter().flat_map(|link| link.between).filter_map(Anchor::body).collect()
            }
        };
        bodies.sort_by_key(|body| body.index());
        bodies.dedup();
        bodies
    }
}
