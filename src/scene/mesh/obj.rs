//! Reads Wavefront OBJ files with the crate `tobj`.

use std::collections::HashMap;
use std::fs::File;

use glam::DVec3;
use tobj::{LoadError, LoadOptions};

use super::lines::{LinePosition, Lines};
use super::{MeshError, Triangles};

/// Reads the vertices and triangles of an OBJ file. Splits polygons into fans of triangles, and ignores points and lines.
pub(super) fn read(file: File) -> Result<Triangles, MeshError> {
    let mut lines = Lines::new(file, only_geometry).with_continuations();
    let options =
        LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let no_materials = |_: &std::path::Path| Ok((Vec::new(), HashMap::new()));
    let models = tobj::load_obj_buf(&mut lines, &options, no_materials);
    let (models, _) = models.map_err(|error| {
        let unreadable = MeshError::new(reason(error));
        // The parser looks up the vertices of faces after the last line, so an error in a vertex index has no line number.
        if is_of_a_line(error) { unreadable.at(lines.number) } else { unreadable }
    })?;
    // The lines that begin objects and groups have been removed, so there is only one model.
    let mesh = models.into_iter().next().map(|model| model.mesh).unwrap_or_default();
    let positions = mesh.positions.chunks_exact(3).map(DVec3::from_slice).collect();
    let triangles =
        mesh.indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
    Ok((positions, triangles))
}

/// Rewrites a line of an OBJ file: keeps vertices, faces and the vertex indices of faces, and empties all other lines. Errors in textures,
/// normals, names and materials do not matter for the shape.
fn only_geometry(line: &mut Vec<u8>, _: LinePosition) {
    let start = line.len() - line.trim_ascii_start().len();
    line.drain(..start);
    if let Some(comment) = line.iter().position(|&byte| byte == b'#') {
        line.truncate(comment);
    }
    let word = line.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    if word == b"f" {
        // Removes the indices of the texture coordinate and the normal: `1/2/3` → `1`.
        let mut after_slash = false;
        line.retain(|byte| {
            after_slash = !byte.is_ascii_whitespace() && (after_slash || *byte == b'/');
            !after_slash
        });
    } else if word == b"v" {
        // The three coordinates may be followed by a weight or by the three components of a color.
        let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        if words.count() > 5 {
            let mut words = 0;
            let end = (1..line.len()).find(|&i| {
                words += usize::from(line[i].is_ascii_whitespace() && !line[i - 1].is_ascii_whitespace());
                words == 4
            });
            line.truncate(end.unwrap_or(line.len()));
        }
    } else {
        line.clear();
    }
}

fn is_of_a_line(error: LoadError) -> bool {
    !matches!(error, LoadError::FaceVertexOutOfBounds | LoadError::InvalidPolygon)
}

fn reason(error: LoadError) -> String {
    match error {
        LoadError::PositionParseError => "a vertex is `v x y z`, in numbers".to_owned(),
        LoadError::FaceParseError => "a face is `f` and the numbers of its vertices".to_owned(),
        LoadError::FaceVertexOutOfBounds => "a face names a vertex that is not there".to_owned(),
        LoadError::InvalidPolygon => "a face has no vertices".to_owned(),
        LoadError::ReadError => "it is no text".to_owned(),
        other => other.to_string(),
    }
}
