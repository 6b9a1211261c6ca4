//! The forms that shapes are drawn of.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::DVec3;

use super::{Triangles, helix, lathe, mesh, straight};
use crate::dynamics::Mesh;

/// A form in a standard size, which many bodies share: each scales it as it needs. What has an axis has it along y.
///
/// Forms are equal, and the same key of a map, where their names and numbers are so bit for bit; meshes, where they are
/// one and the same in memory.
#[derive(Clone, Debug)]
pub struct Form(Kind);

#[derive(Clone, Debug)]
enum Kind {
    /// What follows from a few numbers.
    Made { name: &'static str, numbers: [f64; 4], make: fn([f64; 4], u32) -> Triangles },
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
    /// A ball of radius 1.
    pub const BALL: Form = Form::made("ball", [0.0; 4], |_, sides| lathe::capsule(0.0, sides));
    /// A cube from -1 to 1.
    pub const CUBE: Form = Form::made("cube", [0.0; 4], |_, _| straight::cube());
    /// A cylinder of radius 1 from y = -1 to 1.
    pub const CYLINDER: Form = Form::made("cylinder", [0.0; 4], |_, sides| lathe::cone(1.0, 1.0, sides));
    /// A square from -1 to 1 along x and z, seen from above. Whoever draws it chooses how large.
    pub const PLANE: Form = Form::made("plane", [0.0; 4], |_, _| straight::plane());

    /// A form that follows from some numbers. By its name and these it is known, and the function makes its triangles of
    /// the numbers and of how many sides a circle has.
    #[must_use]
    pub const fn made(name: &'static str, numbers: [f64; 4], make: fn([f64; 4], u32) -> Triangles) -> Form {
        Form(Kind::Made { name, numbers, make })
    }

    /// A cone or a frustum of height 2 about its centre of mass, of the radii of its lower and upper end, of which the larger is 1.
    #[must_use]
    pub fn cone(bottom: f64, top: f64) -> Form {
        Form::made("cone", [bottom, top, 0.0, 0.0], |[bottom, top, ..], sides| {
            lathe::cone(bottom, top, sides)
        })
    }

    /// A cylinder of radius 1 with half a ball on either end; the whole reaches from y = -1 - `straight` to 1 + `straight`.
    #[must_use]
    pub fn capsule(straight: f64) -> Form {
        Form::made("capsule", [straight, 0.0, 0.0, 0.0], |[straight, ..], sides| {
            lathe::capsule(straight, sides)
        })
    }

    /// A ring around y, the middle of whose tube is at distance 1; its tube has the given radius, at most 1.
    #[must_use]
    pub fn torus(tube: f64) -> Form {
        Form::made("torus", [tube, 0.0, 0.0, 0.0], |[tube, ..], sides| lathe::torus(tube, sides))
    }

    /// A box with round edges about the origin, of half its edges, the longest of which is 1, and the radius of its edges.
    #[must_use]
    pub fn rounded_box(half: DVec3, rounding: f64) -> Form {
        Form::made("rounded box", [half.x, half.y, half.z, rounding], |[x, y, z, rounding], sides| {
            straight::rounded_box(DVec3::new(x, y, z), rounding, sides)
        })
    }

    /// The coil of a spring about y, from y = -1 to 1, with its radius 1 and so many turns; its wire has the given radius.
    #[must_use]
    pub fn coil(turns: u32, wire: f64) -> Form {
        Form::made("coil", [f64::from(turns), wire, 0.0, 0.0], |[turns, wire, ..], sides| {
            helix::coil(turns, wire, sides)
        })
    }

    /// A mesh, in its own units.
    #[must_use]
    pub fn mesh(mesh: Arc<Mesh>) -> Form {
        Form(Kind::Mesh(mesh))
    }

    /// Its triangles. A mesh has those that it has, however fine they are.
    #[must_use]
    pub fn triangles(&self, detail: Detail) -> Triangles {
        match &self.0 {
            Kind::Made { numbers, make, .. } => make(*numbers, detail.sides()),
            Kind::Mesh(mesh) => mesh::triangles(mesh),
        }
    }

    /// Whether it encloses something, so that its inside is never seen.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        match &self.0 {
            Kind::Made { .. } => *self != Form::PLANE,
            Kind::Mesh(mesh) => mesh.flaw().is_none(),
        }
    }

    /// A short name of what it is: `ball`; of a mesh, its own.
    #[must_use]
    pub fn name(&self) -> &str {
        match &self.0 {
            Kind::Made { name, .. } => name,
            Kind::Mesh(mesh) => mesh.name(),
        }
    }

    /// What tells it from all others: its name and its numbers.
    fn key(&self) -> (Option<&'static str>, [u64; 4]) {
        match &self.0 {
            Kind::Made { name, numbers, .. } => (Some(name), numbers.map(f64::to_bits)),
            // Two meshes that live at the same time are at different places.
            Kind::Mesh(mesh) => (None, [Arc::as_ptr(mesh).addr() as u64, 0, 0, 0]),
        }
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
