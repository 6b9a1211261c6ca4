//! Declares each mesh of a scene once, as POV-Ray's `mesh2`.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::sync::Arc;

use glam::DVec3;

use super::sdl::Style;
use super::text::{self, Identifiers};
use crate::decimal::decimal_step;
use crate::physics::{Mesh, Shape};
use crate::scene::{Layout, Scene};
use crate::surface::normals;

/// The meshes of a scene, each with an identifier.
#[derive(Default)]
pub(super) struct Meshes {
    all: Vec<Known>,
    /// The index of each mesh in `all`, by the address of the mesh. Addresses only identify meshes, so they do not affect the scripts.
    numbers: HashMap<*const Mesh, usize>,
}

struct Known {
    mesh: Arc<Mesh>,
    identifier: String,
    /// The length of one unit of the declaration, in units of the mesh file.
    unit: f64,
}

/// The number format of normal vectors. With six digits, the error of a normal is about a ten-thousandth of a degree.
const NORMAL_STYLE: Style = Style { unit: 1.0, digits: 6 };

impl Meshes {
    /// Collects the meshes that the scripts of a scene draw.
    pub(super) fn new(scene: &Scene) -> Meshes {
        let mut meshes = Meshes::default();
        let mut identifiers = Identifiers::default();
        for body in scene.bodies.iter().filter(|body| body.look.object.is_none()) {
            meshes.add(&body.shape, &mut identifiers);
        }
        meshes
    }

    fn add(&mut self, shape: &Shape, identifiers: &mut Identifiers) {
        match shape {
            Shape::Compound(compound) => {
                compound.parts().iter().for_each(|part| self.add(&part.shape, identifiers));
            }
            Shape::Mesh { mesh, .. } if !self.numbers.contains_key(&Arc::as_ptr(mesh)) => {
                self.numbers.insert(Arc::as_ptr(mesh), self.all.len());
                let reach = |p: &DVec3| p.abs().max_element();
                let reach = mesh.vertices().iter().map(reach).fold(0.0, f64::max);
                // POV-Ray drops triangles with very small coordinates. It also mistakes points very close to the origin of a ray for the
                // origin itself.
                let unit = decimal_step(reach.max(f64::MIN_POSITIVE)) / 10.0;
                let identifier = identifiers.add("Mesh", mesh.name());
                self.all.push(Known { mesh: Arc::clone(mesh), identifier, unit });
            }
            _ => {}
        }
    }

    /// Appends the declarations of all meshes.
    pub(super) fn declare(&self, out: &mut String, layout: Layout, digits: usize) {
        let scope = match layout {
            Layout::SelfContained => "local",
            Layout::Shared => "declare",
        };
        for Known { mesh, identifier, unit } in &self.all {
            let name = text::comment(mesh.name());
            let _ = writeln!(out, "\n// the mesh {name}: {} triangles", mesh.triangles().len());
            let _ = writeln!(out, "#{scope} {identifier} = mesh2 {{");
            let style = Style { unit: *unit, digits };
            list(out, "vertex_vectors", mesh.vertices(), |out, vertex| style.point(out, *vertex));
            let corners = |out: &mut String, [a, b, c]: &[u32; 3]| {
                let _ = write!(out, "<{a},{b},{c}>");
            };
            if let Some(smooth) = mesh.smooth() {
                let normals = normals::of_corners(mesh, smooth);
                list(out, "normal_vectors", &normals.vectors, |out, normal| {
                    NORMAL_STYLE.vector(out, *normal);
                });
                list(out, "face_indices", mesh.triangles(), corners);
                list(out, "normal_indices", &normals.corners, corners);
            } else {
                list(out, "face_indices", mesh.triangles(), corners);
            }
            // POV-Ray casts a ray in this direction to test whether a point is inside. The direction is unlikely to be parallel to a face
            // or an edge.
            if mesh.flaw().is_none() {
                out.push_str("  inside_vector <0.31, 0.83, 0.47>\n");
            }
            out.push_str("}\n");
        }
    }

    /// Returns the beginning of the SDL object for a mesh. `scale` is the length of the mesh's unit, m. The caller appends the material,
    /// the pose and the closing brace.
    pub(super) fn open(&self, mesh: &Arc<Mesh>, scale: f64, style: Style) -> String {
        let known = self.numbers.get(&Arc::as_ptr(mesh)).map(|&number| &self.all[number]);
        // Every mesh of a body has been declared, so the lookup always succeeds.
        let Some(Known { identifier, unit, .. }) = known else { return "union { ".to_owned() };
        let mut out = format!("object {{ {identifier} ");
        if scale * unit != style.unit {
            out.push_str("scale ");
            style.length(&mut out, scale * unit);
            out.push(' ');
        }
        out
    }
}

/// Appends a list of a `mesh2`, such as its vertices, one item per line.
fn list<T>(out: &mut String, name: &str, items: &[T], write: impl Fn(&mut String, &T)) {
    let _ = write!(out, "  {name} {{ {}", items.len());
    for item in items {
        out.push_str(",\n");
        write(out, item);
    }
    out.push_str(" }\n");
}
