//! Computes volume, centre of mass and inertia of the solid inside a surface of triangles.

use glam::{DMat3, DVec3};

/// The volume, the centre of mass and the second moments of a homogeneous solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole {
    pub(super) volume: f64,
    pub(super) centre: DVec3,
    /// The second moments ∫ p pᵀ dV about the origin.
    second: DMat3,
}

/// Returns the outer product p qᵀ.
fn outer(p: DVec3, q: DVec3) -> DMat3 {
    DMat3::from_cols(p * q.x, p * q.y, p * q.z)
}

/// Computes the integrals of 1, p and p pᵀ over the solid that a closed surface encloses. The volume is negative if the triangles are
/// oriented inwards.
///
/// By the divergence theorem, the integrals are sums over the triangles (B. Mirtich, *Fast and Accurate Computation of Polyhedral Mass
/// Properties*, Journal of Graphics Tools 1(2), 1996; D. Eberly, *Polyhedral Mass Properties (Revisited)*, 2002). The term of a triangle
/// (a, b, c) is the integral over the tetrahedron (0, a, b, c): with d = a · (b × c) and s = a + b + c, its volume is d/6, its first
/// moment is d s/24, and its second moment is d (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/120.
pub(super) fn over_solid(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Whole {
    let (mut volume, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| vertices[vertex as usize]);
        let (d, s) = (a.dot(b.cross(c)), a + b + c);
        volume += d;
        first += d * s;
        second += (outer(a, a) + outer(b, b) + outer(c, c) + outer(s, s)) * d;
    }
    let volume = volume / 6.0;
    Whole { volume, centre: first / (24.0 * volume), second: second * (1.0 / 120.0) }
}

impl Whole {
    /// Returns the integrals of the same surface with the orientation of all triangles reversed.
    pub(super) fn inside_out(self) -> Whole {
        Whole { volume: -self.volume, centre: self.centre, second: self.second * -1.0 }
    }

    /// Returns the inertia tensor about the centre of mass, divided by the volume: tr(C) − C, where C is the second moment about the
    /// centre of mass, divided by the volume (Goldstein, *Classical Mechanics*, ch. 5).
    pub(super) fn inertia_per_mass(self) -> DMat3 {
        let about_centre = self.second * (1.0 / self.volume) - outer(self.centre, self.centre);
        let trace = about_centre.x_axis.x + about_centre.y_axis.y + about_centre.z_axis.z;
        DMat3::from_diagonal(DVec3::splat(trace)) - about_centre
    }
}

/// Returns the centre of mass of the surface as a thin sheet; the origin for a surface without area.
pub(super) fn centre_of_surface(vertices: &[DVec3], triangles: &[[u32; 3]]) -> DVec3 {
    let (mut area, mut first) = (0.0, DVec3::ZERO);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| vertices[vertex as usize]);
        let twice = (b - a).cross(c - a).length();
        area += twice;
        first += twice * (a + b + c) / 3.0;
    }
    if area > 0.0 { first / area } else { DVec3::ZERO }
}
