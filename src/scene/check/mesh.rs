//! Reads meshes and heightfields from the files that `shape.mesh` and `shape.heightfield` name.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::Context;
use super::read::figure;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{Flaw, Mesh, Shape};
use crate::scene::grammar::shapes::{heightfield, mesh as mesh_keys};
use crate::scene::{Camera, Layout, Output, SimulationSettings, mesh};

/// The meshes read so far. Bodies that name the same file with the same settings share one mesh.
#[derive(Default)]
pub(super) struct Meshes {
    known: HashMap<MeshKey, Result<Arc<Mesh>, String>>,
    /// The path and the SHA-256 digest of each mesh file, in the order in which the scene names them.
    files: Vec<(PathBuf, [u8; 32])>,
    /// For each mesh, the source span that first names it, and its number of triangles.
    sizes: Vec<(Span, usize)>,
    /// The number of times that each file has been read again with other settings.
    readings: HashMap<PathBuf, usize>,
    /// The total number of triangles in all meshes.
    triangles: usize,
}

/// The maximum number of times that one mesh file is read again with other settings.
const MOST_READINGS: usize = 1000;
/// The total number of triangles above which no file is read again with other settings.
const MOST_TRIANGLES: usize = 4_000_000;

/// Identifies a mesh: the path of its file, and the bits of the settings with which the file is read.
type MeshKey = (PathBuf, Vec<u64>);

/// The largest total size of all scripts without a warning, bytes. The warning suggests the layout `shared`.
const MAX_BYTES_WITHOUT_WARNING: f64 = 5e8;
/// The estimated size of a triangle in a script, in bytes: the indices of its three vertices, and half a vertex with three coordinates.
const BYTES_OF_A_TRIANGLE: f64 = 45.0;

impl Meshes {
    /// Returns the SHA-256 digests of the mesh files, in the order in which the scene names them.
    pub(super) fn digests(&self) -> impl Iterator<Item = &[u8; 32]> {
        self.files.iter().map(|(_, digest)| digest)
    }

    /// Returns the mesh of a file for these settings, and reads the file only the first time.
    ///
    /// # Errors
    ///
    /// Returns the reason if the file cannot be read as a mesh, or if there are too many meshes.
    fn get(
        &mut self,
        path: PathBuf,
        span: Span,
        numbers: &[f64],
        read: impl FnOnce(&PathBuf) -> Result<Mesh, mesh::MeshError>,
    ) -> Result<Arc<Mesh>, String> {
        let bits = numbers.iter().map(|number| number.to_bits()).collect();
        if !self.files.iter().any(|(known, _)| *known == path) {
            let digest = mesh::digest(&path).map_err(|error| error.to_string())?;
            self.files.push((path.clone(), digest));
        }
        let (known, sizes) = (&mut self.known, &mut self.sizes);
        let before = sizes.len();
        let read = |key: &MeshKey| {
            let mesh = read(&key.0).map_err(|error| error.to_string())?;
            sizes.push((span, mesh.triangles().len()));
            Ok(Arc::new(mesh))
        };
        let key = (path, bits);
        if !known.contains_key(&key) {
            let again =
                *self.readings.entry(key.0.clone()).and_modify(|readings| *readings += 1).or_insert(0);
            if again > MOST_READINGS || again > 0 && self.triangles > MOST_TRIANGLES {
                return Err(format!(
                    "with so many sizes it would come to more than {MOST_READINGS} meshes or {MOST_TRIANGLES} triangles"
                ));
            }
        }
        let mesh = known.entry(key).or_insert_with_key(read).clone();
        if sizes.len() > before {
            self.triangles += mesh.as_ref().map_or(0, |mesh| mesh.triangles().len());
        }
        mesh
    }

    /// Returns a warning that the scripts become too large because each of them repeats the meshes. `None` if the scripts are small.
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    pub(super) fn too_large_to_repeat(
        &self,
        simulation: &SimulationSettings,
        camera: &Camera,
        output: Output,
    ) -> Option<Diagnostic> {
        let triangles: usize = self.sizes.iter().map(|(_, triangles)| triangles).sum();
        let moments = camera.shutter.map_or(1.0, |shutter| 1.0 + f64::from(shutter.samples));
        let scripts = simulation.timeline.frames() as f64 * moments;
        let bytes = triangles as f64 * BYTES_OF_A_TRIANGLE * scripts;
        let (span, _) = self.sizes.iter().max_by_key(|(_, triangles)| *triangles)?;
        let message = format!("every script holds the whole mesh: together about {:.1} GB", bytes / 1e9);
        let warning = Diagnostic::warning(Code::LargeScripts, message);
        let help = "`layout = \"shared\"` in [output] writes it once";
        let large = output.layout == Layout::SelfContained && bytes > MAX_BYTES_WITHOUT_WARNING;
        large.then(|| warning.at(*span, format!("{triangles} triangles, {scripts} times")).help(help))
    }
}

/// Reads a shape that is a mesh from a file. `None` if a value is missing or wrong.
pub(super) fn read(view: &View<'_>, context: &mut Context<'_>) -> Option<Shape> {
    let scale = view.get(&mesh_keys::SCALE);
    let smooth = smooth(view);
    let mesh = file(view, context, &[smooth.unwrap_or(-1.0)], |path| {
        mesh::read(path).map(|mesh| mesh.with_smooth(smooth))
    });
    Some(Shape::Mesh { mesh: mesh?, scale })
}

/// Reads a shape that is a heightfield from a file. `None` if a value is missing or wrong.
pub(super) fn heightfield(view: &View<'_>, context: &mut Context<'_>) -> Option<Shape> {
    let size = view.get(&heightfield::SIZE)?;
    let smooth = smooth(view);
    let numbers = [smooth.unwrap_or(-1.0), size.x, size.y, size.z];
    let mesh = file(view, context, &numbers, |path| {
        mesh::heightfield(path, size).map(|mesh| mesh.with_smooth(smooth))
    });
    Some(Shape::Mesh { mesh: mesh?, scale: 1.0 })
}

/// Returns the mesh of the file that the table names. Reports an error if the file is not a mesh.
fn file(
    view: &View<'_>,
    context: &mut Context<'_>,
    numbers: &[f64],
    read: impl FnOnce(&PathBuf) -> Result<Mesh, mesh::MeshError>,
) -> Option<Arc<Mesh>> {
    let node = view.node(&mesh_keys::FILE)?;
    let asset = super::asset::asset(node, context.folder, context.trust).ok()?;
    match context.meshes.get(asset.path, node.span, numbers, read) {
        Ok(mesh) => Some(mesh),
        Err(why) => {
            let message = format!("cannot read `{}`", node.as_str().unwrap_or_default());
            context.diagnostics.push(Diagnostic::error(Code::BadMesh, message).at(node.span, why));
            None
        }
    }
}

/// Reads the largest angle between two faces whose common edge is drawn smooth, rad. `None` if no edge is smooth.
fn smooth(view: &View<'_>) -> Option<f64> {
    match view.get_as::<bool>(&mesh_keys::SMOOTH) {
        Some(true) => Some(std::f64::consts::PI),
        Some(false) => None,
        None => view.get_as::<f64>(&mesh_keys::SMOOTH).map(f64::to_radians).filter(|angle| *angle > 0.0),
    }
}

/// Returns the error for a mesh that does not enclose a solid. `None` for a closed mesh and for other shapes.
pub(super) fn open(view: &View<'_>, shape: &Shape) -> Option<Diagnostic> {
    let Shape::Mesh { mesh, .. } = shape else { return None };
    let span = view.span(&mesh_keys::FILE)?;
    let at = |[from, to]: &[glam::DVec3; 2]| {
        let point = |p: &glam::DVec3| format!("[{}]", p.to_array().map(figure).join(", "));
        format!("from {} to {}", point(from), point(to))
    };
    let s = |edges: usize| if edges == 1 { "edge" } else { "edges" };
    let label = match mesh.flaw()? {
        Flaw::Open { edges, first } => {
            format!("it is open at {edges} {}, one of them {}", s(*edges), at(first))
        }
        Flaw::Inconsistent { edges, first } => format!(
            "its triangles disagree on where outside is, at {edges} {}, one of them {}",
            s(*edges),
            at(first)
        ),
        Flaw::Flat => "it is flat".to_owned(),
    };
    let message = format!(
        "the mesh `{}` encloses no solid, so its mass and inertia do not follow from it",
        mesh.name()
    );
    Some(Diagnostic::error(Code::OpenMesh, message).at(span, label))
}
