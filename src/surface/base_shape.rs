//! Base shapes: shapes in a standard size, which are scaled when they are drawn.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::DVec3;

use super::{Triangles, helix, lathe, mesh, straight};
use crate::physics::Mesh;

/// A base shape: a shape in a standard size that many bodies share, each with its own scale. Its axis of symmetry, if any, is y.
///
/// Two base shapes are equal, also as keys of a map, if their names and their numbers agree bit for bit. Two meshes are equal only if they
/// are the same object in memory.
#[derive(Clone, Debug)]
pub struct BaseShape(Kind);

#[derive(Clone, Debug)]
enum Kind {
    /// A base shape that a function computes from a few numbers.
    Made { name: &'static str, numbers: [f64; 4], make: fn([f64; 4], u32) -> Triangles },
    /// A mesh, in the units of the mesh.
    Mesh(Arc<Mesh>),
}

/// The resolution of the triangles of a base shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Detail {
    /// The resolution for pictures: a ball has about 1,100 vertices.
    Fine,
    /// The resolution for thousands of bodies: a ball has about 110 vertices.
    Coarse,
}

impl Detail {
    /// The number of straight sides that approximate a circle. It is divisible by four.
    #[must_use]
    pub fn sides(self) -> u32 {
        match self {
            Detail::Fine => 48,
            Detail::Coarse => 16,
        }
    }
}

impl BaseShape {
    /// A ball of radius 1.
    pub const BALL: BaseShape = BaseShape::new("ball", [0.0; 4], |_, sides| lathe::capsule(0.0, sides));
    /// A cube from -1 to 1 along all axes.
    pub const CUBE: BaseShape = BaseShape::new("cube", [0.0; 4], |_, _| straight::cube());
    /// A cylinder of radius 1 from y = -1 to 1.
    pub const CYLINDER: BaseShape =
        BaseShape::new("cylinder", [0.0; 4], |_, sides| lathe::cone(1.0, 1.0, sides));
    /// A square from -1 to 1 along x and z, visible from above. The renderer chooses its drawn size.
    pub const PLANE: BaseShape = BaseShape::new("plane", [0.0; 4], |_, _| straight::plane());

    /// Creates a base shape from a name and numbers, which together identify it. `make` computes the triangles from the numbers and from
    /// the number of sides of a circle.
    #[must_use]
    pub const fn new(
        name: &'static str,
        numbers: [f64; 4],
        make: fn([f64; 4], u32) -> Triangles,
    ) -> BaseShape {
        BaseShape(Kind::Made { name, numbers, make })
    }

    /// A cone or frustum of height 2, centered at its center of mass. `bottom` and `top` are its lower and upper radius, of which the
    /// larger must be 1.
    #[must_use]
    pub fn cone(bottom: f64, top: f64) -> BaseShape {
        BaseShape::new("cone", [bottom, top, 0.0, 0.0], |[bottom, top, ..], sides| {
            lathe::cone(bottom, top, sides)
        })
    }

    /// A capsule: a cylinder of radius 1 with a hemisphere on either end, from y = -1 - `straight` to 1 + `straight`.
    #[must_use]
    pub fn capsule(straight: f64) -> BaseShape {
        BaseShape::new("capsule", [straight, 0.0, 0.0, 0.0], |[straight, ..], sides| {
            lathe::capsule(straight, sides)
        })
    }

    /// A torus around y with a major radius of 1. The radius of its tube is `tube`, at most 1.
    #[must_use]
    pub fn torus(tube: f64) -> BaseShape {
        BaseShape::new("torus", [tube, 0.0, 0.0, 0.0], |[tube, ..], sides| lathe::torus(tube, sides))
    }

    /// A box with rounded edges, centered at the origin. `half` holds half the length of each edge, and its largest component must be 1.
    /// `rounding` is the radius of the edges.
    #[must_use]
    pub fn rounded_box(half: DVec3, rounding: f64) -> BaseShape {
        BaseShape::new("rounded box", [half.x, half.y, half.z, rounding], |[x, y, z, rounding], sides| {
            straight::rounded_box(DVec3::new(x, y, z), rounding, sides)
        })
    }

    /// The coil of a spring around y, from y = -1 to 1, with a radius of 1. `wire` is the radius of its wire.
    #[must_use]
    pub fn coil(turns: u32, wire: f64) -> BaseShape {
        BaseShape::new("coil", [f64::from(turns), wire, 0.0, 0.0], |[turns, wire, ..], sides| {
            helix::coil(turns, wire, sides)
        })
    }

    /// Creates a base shape from a mesh, in the units of the mesh.
    #[must_use]
    pub fn mesh(mesh: Arc<Mesh>) -> BaseShape {
        BaseShape(Kind::Mesh(mesh))
    }

    /// Computes the triangles of the base shape. Those of a mesh are the same for all resolutions.
    #[must_use]
    pub fn triangles(&self, detail: Detail) -> Triangles {
        match &self.0 {
            Kind::Made { numbers, make, .. } => make(*numbers, detail.sides()),
            Kind::Mesh(mesh) => mesh::triangles(mesh),
        }
    }

    /// True if the surface is closed, so that its inside is never visible.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        match &self.0 {
            Kind::Made { .. } => *self != BaseShape::PLANE,
            Kind::Mesh(mesh) => mesh.flaw().is_none(),
        }
    }

    /// A short name of the base shape, such as `ball`, or the name of the mesh.
    #[must_use]
    pub fn name(&self) -> &str {
        match &self.0 {
            Kind::Made { name, .. } => name,
            Kind::Mesh(mesh) => mesh.name(),
        }
    }

    /// The key that identifies the base shape: its name and its numbers, or the address of its mesh.
    fn key(&self) -> (Option<&'static str>, [u64; 4]) {
        match &self.0 {
            Kind::Made { name, numbers, .. } => (Some(name), numbers.map(f64::to_bits)),
            // Two meshes that exist at the same time have different addresses.
            Kind::Mesh(mesh) => (None, [Arc::as_ptr(mesh).addr() as u64, 0, 0, 0]),
        }
    }
}

impl PartialEq for BaseShape {
    fn eq(&self, other: &BaseShape) -> bool {
        self.key() == other.key()
    }
}

impl Eq for BaseShape {}

impl Hash for BaseShape {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}
