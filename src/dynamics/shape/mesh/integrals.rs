//! Integrals over what a surface encloses.

use glam::{DMat3, DVec3};

/// Volume, centre of mass and second moments of a homogeneous solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole {
    pub(super) volume: f64,
    pub(super) centre: DVec3,
    /// ∫ p pᵀ dV about the origin.
    second: DMat3,
}

/// The product p qᵀ.
fn outer(p: DVec3, q: DVec3) -> DMat3 {
    DMat3::from_cols(p * q.x, p * q.y, p * q.z)
}

/// The integrals of 1, p and p pᵀ over the solid that a closed surface encloses, negative where it shows its inside.
///
/// By the divergence theorem they are sums over the triangles (B. Mirtich, *Fast and Accurate Computation of Polyhedral Mass
/// Properties*, Journal of Graphics Tools 1(2), 1996; D. Eberly, *Polyhedral Mass Properties (Revisited)*, 2002). The term of a
/// triangle (a, b, c) is the integral over the tetrahedron (0, a, b, c): with d = a · (b × c) and s = a + b + c, its volume is
/// d/6, its first moment d s/24 and its second moment d (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/120.
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
    /// Those of the same surface seen from its other side.
    pub(super) fn inside_out(self) -> Whole {
        Whole { volume: -self.volume, centre: self.centre, second: self.second * -1.0 }
    }

    /// The inertia tensor per mass about the centre of mass: tr(C) − C, where C is the second moment there (Goldstein,
    /// *Classical Mechanics*, ch. 5).
    pub(super) fn inertia_per_mass(self) -> DMat3 {
        let about_centre = self.second * (1.0 / self.volume) - outer(self.centre, self.centre);
        let trace = about_centre.x_axis.x + about_centre.y_axis.y + about_centre.z_axis.z;
        DMat3::from_diagonal(DVec3::splat(trace)) - about_centre
    }
}

/// The centre of mass of the surface as a thin sheet; of one without area, the origin.
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
