//! The unit forms from which shapes are built.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::DVec3;

use super::{Triangles, helix, lathe, mesh, straight};
use crate::dynamics::Mesh;

/// A form of standard size, shared by many bodies that each scale it. Its axis, if any, is y.
///
/// Two forms are equal, and the same key of a map, if their names and numbers agree bit for bit; two meshes, if they
/// are the same object in memory.
#[derive(Clone, Debug)]
pub struct Form(Kind);

#[derive(Clone, Debug)]
enum Kind {
    /// A form computed from a few numbers.
    Made { name: &'static str, numbers: [f64; 4], make: fn([f64; 4], u32) -> Triangles },
    /// A mesh, in its own units.
    Mesh(Arc<Mesh>),
}

/// The resolution of forms.
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
    /// A square from -1 to 1 along x and z, seen from above. The renderer chooses its size.
    pub const PLANE: Form = Form::made("plane", [0.0; 4], |_, _| straight::plane());

    /// A form computed from some numbers, which with its name identify it. The function makes its triangles from the
    /// numbers and the number of sides of a circle.
    #[must_use]
    pub const fn made(name: &'static str, numbers: [f64; 4], make: fn([f64; 4], u32) -> Triangles) -> Form {
        Form(Kind::Made { name, numbers, make })
    }

    /// A cone or frustum of height 2 about its centre of mass, with its lower and upper radius. The larger is 1.
    #[must_use]
    pub fn cone(bottom: f64, top: f64) -> Form {
        Form::made("cone", [bottom, top, 0.0, 0.0], |[bottom, top, ..], sides| {
            lathe::cone(bottom, top, sides)
        })
    }

    /// A cylinder of radius 1 with a hemisphere on either end, from y = -1 - `straight` to 1 + `straight`.
    #[must_use]
    pub fn capsule(straight: f64) -> Form {
        Form::made("capsule", [straight, 0.0, 0.0, 0.0], |[straight, ..], sides| {
            lathe::capsule(straight, sides)
        })
    }

    /// A ring around y with major radius 1. Its tube has the given radius, at most 1.
    #[must_use]
    pub fn torus(tube: f64) -> Form {
        Form::made("torus", [tube, 0.0, 0.0, 0.0], |[tube, ..], sides| lathe::torus(tube, sides))
    }

    /// A box with rounded edges about the origin: half its edge lengths, the longest being 1, and the radius of its
    /// edges.
    #[must_use]
    pub fn rounded_box(half: DVec3, rounding: f64) -> Form {
        Form::made("rounded box", [half.x, half.y, half.z, rounding], |[x, y, z, rounding], sides| {
            straight::rounded_box(DVec3::new(x, y, z), rounding, sides)
        })
    }

    /// A spring's coil about y, from y = -1 to 1, with radius 1 and `turns` turns. Its wire has the given radius.
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

    /// Its triangles. Those of a mesh do not depend on the detail.
    #[must_use]
    pub fn triangles(&self, detail: Detail) -> Triangles {
        match &self.0 {
            Kind::Made { numbers, make, .. } => make(*numbers, detail.sides()),
            Kind::Mesh(mesh) => mesh::triangles(mesh),
        }
    }

    /// Whether it is closed, so that its inside is never visible.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        match &self.0 {
            Kind::Made { .. } => *self != Form::PLANE,
            Kind::Mesh(mesh) => mesh.flaw().is_none(),
        }
    }

    /// A short name: `ball`; for a mesh, its own.
    #[must_use]
    pub fn name(&self) -> &str {
        match &self.0 {
            Kind::Made { name, .. } => name,
            Kind::Mesh(mesh) => mesh.name(),
        }
    }

    /// Its identity: its name and its numbers.
    fn key(&self) -> (Option<&'static str>, [u64; 4]) {
        match &self.0 {
            Kind::Made { name, numbers, .. } => (Some(name), numbers.map(f64::to_bits)),
            // Two meshes alive at the same time have different addresses.
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
