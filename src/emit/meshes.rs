//! Meshes, each declared once.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::sync::Arc;

use glam::DVec3;

use super::sdl::Style;
use super::text::{self, Identifiers};
use crate::dynamics::{Mesh, Shape};
use crate::picture::decimal_step;
use crate::scene::{Layout, Scene};
use crate::surface::normals;

/// The meshes of a scene, each with an identifier.
#[derive(Default)]
pub(super) struct Meshes {
    all: Vec<Known>,
    /// The number of each, by the place of the mesh in memory; this decides nothing but which is which.
    numbers: HashMap<*const Mesh, usize>,
}

struct Known {
    mesh: Arc<Mesh>,
    identifier: String,
    /// The length that is 1 where it is declared, in units of the mesh.
    unit: f64,
}

/// Six digits of a normal are a ten-thousandth of a degree.
const NORMAL: Style = Style { unit: 1.0, digits: 6 };

impl Meshes {
    /// The meshes that the scripts of a scene draw.
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
                // POV-Ray drops triangles with very small coordinates, and takes very near points for the origin of the ray.
                let unit = decimal_step(reach.max(f64::MIN_POSITIVE)) / 10.0;
                let identifier = identifiers.add("Mesh", mesh.name());
                self.all.push(Known { mesh: Arc::clone(mesh), identifier, unit });
            }
            _ => {}
        }
    }

    /// Appends their declarations.
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
                list(out, "normal_vectors", &normals.vectors, |out, normal| NORMAL.vector(out, *normal));
                list(out, "face_indices", mesh.triangles(), corners);
                list(out, "normal_indices", &normals.corners, corners);
            } else {
                list(out, "face_indices", mesh.triangles(), corners);
            }
            // POV-Ray looks along a direction to find out what is inside. This direction is unlikely to lie in any face or edge.
            if mesh.flaw().is_none() {
                out.push_str("  inside_vector <0.31, 0.83, 0.47>\n");
            }
            out.push_str("}\n");
        }
    }

    /// An object that is a mesh whose unit has a length in metres; the words up to where its material and its place go.
    pub(super) fn open(&self, mesh: &Arc<Mesh>, scale: f64, style: Style) -> String {
        let known = self.numbers.get(&Arc::as_ptr(mesh)).map(|&number| &self.all[number]);
        // All that bodies draw has been declared.
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

/// Appends a list of a mesh, one item a line.
fn list<T>(out: &mut String, name: &str, items: &[T], write: impl Fn(&mut String, &T)) {
    let _ = write!(out, "  {name} {{ {}", items.len());
    for item in items {
        out.push_str(",\n");
        write(out, item);
    }
    out.push_str(" }\n");
}
