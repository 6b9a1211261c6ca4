//! Draws random points on a surface of triangles, with uniform distribution over the area.

use std::sync::Arc;

use glam::DVec3;

use crate::Mesh;
use crate::random::Stream;

/// The corners of a mesh's triangles, m, and the cumulative sums of the triangles' areas, m².
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    corners: Arc<[[DVec3; 3]]>,
    sums: Arc<[f64]>,
}

impl Triangles {
    /// Computes the triangles of a mesh and their areas. `scale` is the length of one unit of the mesh, m.
    #[must_use]
    pub fn new(mesh: &Mesh, scale: f64) -> Triangles {
        let vertices = mesh.vertices();
        let corners: Arc<[_]> = mesh
            .triangles()
            .iter()
            .map(|triangle| triangle.map(|vertex| scale * vertices[vertex as usize]))
            .collect();
        let mut sum = 0.0;
        let area = |&[a, b, c]: &[DVec3; 3]| {
            sum += 0.5 * (b - a).cross(c - a).length();
            sum
        };
        let sums = corners.iter().map(area).collect();
        Triangles { corners, sums }
    }

    /// Draws a random point on the triangles. Returns the point (m) and the unit normal at this point. Without triangles, the point is the
    /// origin.
    ///
    /// The triangle is drawn with a probability proportional to its area. The point in the triangle is drawn as in Osada, Funkhouser,
    /// Chazelle & Dobkin, *Shape Distributions*, ACM Trans. Graph. 21 (2002) 807, section 4.2.
    pub(super) fn place(&self, random: &mut Stream) -> (DVec3, DVec3) {
        let chosen = random.uniform() * self.sums.last().copied().unwrap_or(0.0);
        let number = self.sums.partition_point(|sum| *sum <= chosen);
        let (root, part) = (random.uniform().sqrt(), random.uniform());
        let Some([a, b, c]) = self.corners.get(number).or(self.corners.last()) else {
            return (DVec3::ZERO, DVec3::Y);
        };
        let place = (1.0 - root) * a + root * ((1.0 - part) * b + part * c);
        (place, (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y))
    }
}
