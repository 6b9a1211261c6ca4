//! Computes smooth normals of meshes.

use glam::DVec3;

use crate::physics::Mesh;

/// The normals of a mesh, and their indices at the three corners of each triangle.
pub(crate) struct Normals {
    pub(crate) vectors: Vec<DVec3>,
    pub(crate) corners: Vec<[u32; 3]>,
}

/// Computes the normals at the corners of each triangle. A normal is the mean over those triangles at the vertex whose normals differ from
/// the triangle's own by at most `smooth` (rad), weighted by their angles at the vertex (G. Thürmer, C. A. Wüthrich, *Computing Vertex
/// Normals from Polygonal Facets*, Journal of Graphics Tools 3(1), 1998).
#[allow(clippy::cast_possible_truncation, reason = "a mesh has fewer corners than 32 bits can count")]
pub(crate) fn of_corners(mesh: &Mesh, smooth: f64) -> Normals {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let around = Around::new(vertices.len(), triangles);
    let least_cosine = libm::cos(smooth);
    let face = |triangle: [u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| vertices[vertex as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let mut normals = Normals { vectors: Vec::new(), corners: vec![[0; 3]; triangles.len()] };
    for vertex in 0..vertices.len() {
        let corners = around.corners(vertex);
        let known = normals.vectors.len();
        for &(own, corner) in corners {
            let own_normal = face(triangles[own as usize]);
            let mean = corners.iter().map(|&(other, corner)| {
                let triangle = triangles[other as usize];
                let normal = face(triangle);
                let near = smooth >= std::f64::consts::PI || own_normal.dot(normal) >= least_cosine;
                if near { normal * angle(vertices, triangle, corner as usize) } else { DVec3::ZERO }
            });
            let mean = mean.sum::<DVec3>().try_normalize().or_else(|| own_normal.try_normalize());
            let mean = mean.unwrap_or(DVec3::Y);
            // Triangles with the same neighbors have bit-identical sums, so they share a normal.
            let number = normals.vectors[known..].iter().position(|normal| *normal == mean);
            let number = number.map_or(normals.vectors.len(), |number| known + number);
            if number == normals.vectors.len() {
                normals.vectors.push(mean);
            }
            normals.corners[own as usize][corner as usize] = number as u32;
        }
    }
    normals
}

/// The angle of a triangle at one of its corners, rad.
fn angle(vertices: &[DVec3], triangle: [u32; 3], corner: usize) -> f64 {
    let at = |i: usize| vertices[triangle[(corner + i) % 3] as usize];
    let (one, other) = (at(1) - at(0), at(2) - at(0));
    libm::atan2(one.cross(other).length(), one.dot(other))
}

/// The triangles around each vertex of a mesh.
struct Around {
    /// The index in `corners` at which each vertex's range starts, and the end of the last range.
    starts: Vec<u32>,
    /// The index of a triangle, and the number of its corner (0 to 2) at the vertex.
    corners: Vec<(u32, u8)>,
}

impl Around {
    #[allow(clippy::cast_possible_truncation, reason = "a mesh has fewer corners than 32 bits can count")]
    fn new(vertices: usize, triangles: &[[u32; 3]]) -> Around {
        let mut starts = vec![0; vertices + 1];
        triangles.iter().flatten().for_each(|&vertex| starts[vertex as usize + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let mut next = starts.clone();
        let mut corners = vec![(0, 0); 3 * triangles.len()];
        for (number, triangle) in triangles.iter().enumerate() {
            for (corner, &vertex) in triangle.iter().enumerate() {
                let at = &mut next[vertex as usize];
                corners[*at as usize] = (number as u32, corner as u8);
                *at += 1;
            }
        }
        Around { starts, corners }
    }

    fn corners(&self, vertex: usize) -> &[(u32, u8)] {
        &self.corners[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube in which each face consists of two triangles, and neighboring faces meet at 90°.
    fn cube() -> Mesh {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1));
        let faces: [[u32; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh::new("cube", (0..8).map(corner).collect(), triangles)
    }

    #[test]
    fn sharp_edges_keep_the_normals_of_their_faces() {
        let mesh = cube();
        let normals = of_corners(&mesh, 80f64.to_radians());
        assert_eq!(normals.vectors.len(), 24, "three faces at each of eight corners");
        for (triangle, corners) in mesh.triangles().iter().zip(&normals.corners) {
            let [a, b, c] = triangle.map(|vertex| mesh.vertices()[vertex as usize]);
            let face = (b - a).cross(c - a).normalize();
            assert!(corners.iter().all(|&i| normals.vectors[i as usize].abs_diff_eq(face, 1e-15)));
        }
    }

    /// Triangles are weighted by their angles, so the way faces are divided has no effect: the normal at each corner of a cube is along
    /// its diagonal.
    #[test]
    fn round_edges_have_one_normal_at_each_vertex() {
        let mesh = cube();
        for smooth in [100f64.to_radians(), std::f64::consts::PI] {
            let normals = of_corners(&mesh, smooth);
            assert_eq!(normals.vectors.len(), 8);
            for (triangle, corners) in mesh.triangles().iter().zip(&normals.corners) {
                for (&vertex, &normal) in triangle.iter().zip(corners) {
                    let outward = mesh.vertices()[vertex as usize].normalize();
                    assert!(normals.vectors[normal as usize].abs_diff_eq(outward, 1e-15));
                }
            }
        }
    }
}
