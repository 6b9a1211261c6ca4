//! The forms that shapes are drawn of.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::DVec3;

use super::{Triangles, lathe, mesh, straight};
use crate::dynamics::Mesh;

/// A form in a standard size, which many bodies share: each scales it as it needs. What has an axis has it along y.
///
/// Forms are equal, and the same key of a map, where their numbers are so bit for bit; meshes, where they are one and
/// the same in memory.
#[derive(Clone, Debug)]
pub enum Form {
    /// A ball of radius 1.
    Ball,
    /// A cube from -1 to 1.
    Cube,
    /// A cylinder of radius 1 from y = -1 to 1.
    Cylinder,
    /// A cone or a frustum of height 2 about its centre of mass; the larger one of its radii is 1.
    Cone {
        /// The radius of the lower end.
        bottom: f64,
        /// The radius of the upper end.
        top: f64,
    },
    /// A cylinder of radius 1 with half a ball on either end.
    Capsule {
        /// Half the length of the cylinder: the whole reaches from y = -1 - `straight` to 1 + `straight`.
        straight: f64,
    },
    /// A ring around y, the middle of whose tube is at distance 1.
    Torus {
        /// The radius of the tube, at most 1.
        tube: f64,
    },
    /// A box with round edges about the origin, whose longest edge is 2.
    RoundedBox {
        /// Half its edges.
        half: DVec3,
        /// The radius of the edges.
        rounding: f64,
    },
    /// A square from -1 to 1 along x and z, seen from above. Whoever draws it chooses how large.
    Plane,
    /// A mesh, in its own units.
    Mesh(Arc<Mesh>),
}

/// How fine forms are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Detail {
    /// A ball has about 1,100 vertices: for pictures.
    Fine,
    /// A ball has about 110 vertices: for thousands of bodies.
    Coarse,
}

impl Detail {
    /// The number of sides of a circle, which is divisible by four.
    #[must_use]
    pub fn sides(self) -> u32 {
        match self {
            Detail::Fine => 48,
            Detail::Coarse => 16,
        }
    }
}

impl Form {
    /// Its triangles. A mesh has those that it has, however fine they are.
    #[must_use]
    pub fn triangles(&self, detail: Detail) -> Triangles {
        let sides = detail.sides();
        match self {
            Form::Ball => lathe::capsule(0.0, sides),
            Form::Capsule { straight } => lathe::capsule(*straight, sides),
            Form::Cylinder => lathe::cone(1.0, 1.0, sides),
            Form::Cone { bottom, top } => lathe::cone(*bottom, *top, sides),
            Form::Torus { tube } => lathe::torus(*tube, sides),
            Form::Cube => straight::cube(),
            Form::RoundedBox { half, rounding } => straight::rounded_box(*half, *rounding, sides),
            Form::Plane => straight::plane(),
            Form::Mesh(mesh) => mesh::triangles(mesh),
        }
    }

    /// Whether it encloses something, so that its inside is never seen.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        match self {
            Form::Plane => false,
            Form::Mesh(mesh) => mesh.flaw().is_none(),
            _ => true,
        }
    }

    /// A short name of what it is: `ball`; of a mesh, its own.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Form::Ball => "ball",
            Form::Cube => "cube",
            Form::Cylinder => "cylinder",
            Form::Cone { .. } => "cone",
            Form::Capsule { .. } => "capsule",
            Form::Torus { .. } => "torus",
            Form::RoundedBox { .. } => "rounded box",
            Form::Plane => "plane",
            Form::Mesh(mesh) => mesh.name(),
        }
    }

    /// What tells it from all others: its kind and its numbers.
    fn key(&self) -> (u8, [u64; 4]) {
        let (kind, numbers) = match self {
            Form::Ball => (0, [0.0; 4]),
            Form::Cube => (1, [0.0; 4]),
            Form::Cylinder => (2, [0.0; 4]),
            Form::Cone { bottom, top } => (3, [*bottom, *top, 0.0, 0.0]),
            Form::Capsule { straight } => (4, [*straight, 0.0, 0.0, 0.0]),
            Form::Torus { tube } => (5, [*tube, 0.0, 0.0, 0.0]),
            Form::RoundedBox { half, rounding } => (6, [half.x, half.y, half.z, *rounding]),
            Form::Plane => (7, [0.0; 4]),
            // Two meshes that live at the same time are at different places.
            Form::Mesh(mesh) => return (8, [Arc::as_ptr(mesh).addr() as u64, 0, 0, 0]),
        };
        (kind, numbers.map(f64::to_bits))
    }
}

impl PartialEq for Form {
    fn eq(&self, other: &Form) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Form {}

impl Hash for Form {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}
