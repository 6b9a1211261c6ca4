//! Reads mesh files (OBJ, STL) and images of heights as triangle meshes ([`Mesh`]).

mod heightfield;
mod lines;
mod obj;
mod stl;
mod weld;

use std::fmt;
use std::io::{self, Read};
use std::path::Path;

use glam::DVec3;

use crate::physics::Mesh;
use crate::scene::source::file;
use sha2::{Digest, Sha256};

pub(super) use heightfield::heightfield;

/// The reason why a file cannot be read as a mesh.
#[derive(Debug)]
pub(super) struct MeshError {
    /// The description of the error, as a clause for a message.
    pub(super) why: String,
    /// The number of the faulty line, counted from 1. `None` if the line is unknown.
    pub(super) line: Option<usize>,
}

/// The positions of vertices, and triangles given by three indices of vertices.
type Triangles = (Vec<DVec3>, Vec<[u32; 3]>);

/// The file name extension of Wavefront OBJ files, in lower case.
const OBJ_EXTENSION: &str = "obj";
/// The file name extension of STL files, in lower case.
const STL_EXTENSION: &str = "stl";

/// The maximum magnitude of a vertex coordinate, m. Moments of inertia contain its fifth power, which must be finite.
const MAX_COORDINATE: f64 = 1e50;

/// The maximum size of a mesh file, in bytes: ten million triangles in a binary STL file. The script for a mesh of this size takes about a
/// gigabyte.
const MOST_BYTES: u64 = 512 << 20;

/// The maximum number of vertices of a mesh. The two vertex indices of an edge then fit into 64 bits.
const MOST_VERTICES: usize = 1 << 31;

/// Reads a mesh file (OBJ or STL). Merges vertices at the same position, so that adjacent triangles share vertices.
pub(super) fn read(path: &Path) -> Result<Mesh, MeshError> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let (positions, triangles) = match ending.as_deref() {
        Some(OBJ_EXTENSION) => obj::read(file::open(path, MOST_BYTES)?)?,
        Some(STL_EXTENSION) => stl::read(file::open(path, MOST_BYTES)?)?,
        _ => return Err(MeshError::new("its name ends neither with `.obj` nor with `.stl`")),
    };
    if let Some(far) = positions.iter().find(|p| !p.is_finite() || p.abs().max_element() > MAX_COORDINATE) {
        return Err(MeshError::new(format!("a vertex is at {far}")));
    }
    if positions.len() >= MOST_VERTICES {
        return Err(MeshError::new(format!("it has {} vertices", positions.len())));
    }
    let (vertices, triangles) = weld::weld(positions, triangles);
    if triangles.iter().all(|[a, b, c]| a == b || b == c || c == a) {
        return Err(MeshError::new("it has no triangles"));
    }
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    Ok(Mesh::new(&name, vertices, triangles))
}

/// Computes the SHA-256 digest of a file.
pub(super) fn digest(path: &Path) -> io::Result<[u8; 32]> {
    let (mut file, mut hash) = (file::open(path, MOST_BYTES)?, Sha256::new());
    let mut buffer = [0; 1 << 16];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hash.finalize().into()),
            length => hash.update(&buffer[..length]),
        }
    }
}

impl MeshError {
    fn new(why: impl Into<String>) -> MeshError {
        MeshError { why: why.into(), line: None }
    }

    fn at(self, line: usize) -> MeshError {
        MeshError { line: Some(line), ..self }
    }
}

impl From<io::Error> for MeshError {
    fn from(error: io::Error) -> MeshError {
        MeshError::new(error.to_string())
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}: {}", self.why),
            None => f.write_str(&self.why),
        }
    }
}

#[cfg(test)]
mod tests;
