//! The forces of a checked scene.

use std::sync::Arc;

use super::SpringLook;
use super::law::FormulaLaw;
use crate::dynamics::{
    self, BodyId, Buoyancy, ConstantForce, Coulomb, Dipoles, Drag, FormulaForce, Gravitation, J2,
    LennardJones, Lorentz, Spring,
};

/// A force that is not a single body's own.
#[derive(Clone, Debug)]
pub struct Force {
    /// Its name, unique among forces.
    pub name: String,
    /// Its kind.
    pub kind: ForceKind,
    /// The numbers of the emitters on whose particles it acts.
    pub emitters: Vec<usize>,
}

/// The kinds of forces. A [`BodyId`](dynamics::BodyId) is the number of a body of the scene.
#[derive(Clone, Debug)]
pub enum ForceKind {
    /// The same force and torque on several bodies.
    Constant(ConstantForce),
    /// The resistance of air or a liquid.
    Drag(Drag),
    /// Newton's gravitation between all pairs.
    Gravitation(Gravitation),
    /// Coulomb's force between all pairs of charges.
    Coulomb(Coulomb),
    /// Uniform electric and magnetic fields.
    Lorentz(Lorentz),
    /// A force by formulas.
    Formula {
        /// The bodies it acts on.
        bodies: Vec<BodyId>,
        /// The formulas.
        law: Arc<FormulaLaw>,
    },
    /// The force between neutral atoms, for all pairs that are near.
    LennardJones(LennardJones),
    /// Buoyancy in a liquid.
    Buoyancy(Buoyancy),
    /// Magnetic dipoles.
    Dipoles(Dipoles),
    /// The gravity of a planet's bulge.
    J2(J2),
    /// A spring with a damper, or a chain of such springs.
    Spring {
        /// The springs, one behind the other.
        links: Vec<Spring>,
        /// The look of the springs. `None` if the springs are not drawn.
        look: Option<SpringLook>,
    },
}

impl ForceKind {
    /// The forces for a world.
    pub fn acting(&self) -> Vec<Arc<dyn dynamics::Force>> {
        match self {
            ForceKind::Constant(constant) => vec![Arc::new(constant.clone())],
            ForceKind::Drag(drag) => vec![Arc::new(drag.clone())],
            ForceKind::Gravitation(gravitation) => vec![Arc::new(gravitation.clone())],
            ForceKind::Coulomb(coulomb) => vec![Arc::new(coulomb.clone())],
            ForceKind::Lorentz(lorentz) => vec![Arc::new(lorentz.clone())],
            ForceKind::Formula { bodies, law } => {
                vec![Arc::new(FormulaForce::new(bodies.clone(), law.clone()))]
            }
            ForceKind::LennardJones(lennard_jones) => vec![Arc::new(lennard_jones.clone())],
            ForceKind::Buoyancy(buoyancy) => vec![Arc::new(buoyancy.clone())],
            ForceKind::Dipoles(dipoles) => vec![Arc::new(dipoles.clone())],
            ForceKind::J2(j2) => vec![Arc::new(j2.clone())],
            ForceKind::Spring { links, .. } => links.iter().map(|link| Arc::new(*link) as Arc<_>).collect(),
        }
    }
}
