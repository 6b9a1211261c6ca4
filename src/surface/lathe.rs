//! Surfaces of revolution: profiles swept around the y axis.

use glam::DVec3;

use super::Triangles;
use super::angles::circle;
use crate::physics::cone_base;

/// A point of a profile, with the surface normal.
#[derive(Clone, Copy)]
struct Point {
    radius: f64,
    y: f64,
    /// The components of the normal away from the axis and along the axis.
    normal: [f64; 2],
}

impl Point {
    /// True if the swept point is a single vertex: a pole, or the center of a disk.
    fn is_single(self) -> bool {
        self.radius == 0.0 && self.normal[0] == 0.0
    }
}

/// A capsule: a ball of radius 1, cut at its equator, with each half moved along y by `straight`.
pub(super) fn capsule(straight: f64, sides: u32) -> Triangles {
    let quarter = sides / 4;
    let at = |part: u32| {
        let (cosine, sine) = circle(part, sides);
        // The angle runs from the lower pole to the upper pole.
        Point { radius: sine, y: -cosine, normal: [sine, -cosine] }
    };
    let lower = (0..=quarter).map(at).map(|point| Point { y: point.y - straight, ..point });
    let upper = (quarter..=2 * quarter).map(at).map(|point| Point { y: point.y + straight, ..point });
    let skip = usize::from(straight == 0.0);
    turned(&lower.chain(upper.skip(skip)).collect::<Vec<_>>(), sides)
}

/// A cone or frustum of height 2, centered at its center of mass. With equal radii, it is a cylinder.
pub(super) fn cone(bottom: f64, top: f64, sides: u32) -> Triangles {
    let low = if bottom == top { -1.0 } else { cone_base(bottom, top, 2.0) };
    let high = low + 2.0;
    let slant = DVec3::new(2.0, bottom - top, 0.0).normalize();
    let slant = [slant.x, slant.y];
    let point = |radius, y, normal| Point { radius, y, normal };
    let profile = [
        point(0.0, low, [0.0, -1.0]),
        point(bottom, low, [0.0, -1.0]),
        point(bottom, low, slant),
        point(top, high, slant),
        point(top, high, [0.0, 1.0]),
        point(0.0, high, [0.0, 1.0]),
    ];
    turned(&profile, sides)
}

/// A torus with a major radius of 1 and the given tube radius.
pub(super) fn torus(tube: f64, sides: u32) -> Triangles {
    let half = sides / 2;
    // The profile goes once around the tube, starting on the inner side and continuing along the bottom. The tube has half as many sides
    // as the ring.
    let at = |part: u32| {
        let (cosine, sine) = circle((part + half / 2) % half, half);
        Point { radius: 1.0 + tube * cosine, y: tube * sine, normal: [cosine, sine] }
    };
    turned(&(0..=half).map(at).collect::<Vec<_>>(), sides)
}

/// Sweeps a profile around the y axis. On the outer side of the surface, the profile must go upward. At a sharp edge, the profile has two
/// equal points with different normals.
fn turned(profile: &[Point], sides: u32) -> Triangles {
    let mut out = Triangles::default();
    let mut starts = Vec::with_capacity(profile.len());
    for point in profile {
        let [across, along] = point.normal;
        starts.push(out.positions.len() as u32);
        if point.is_single() {
            out.vertex(DVec3::Y * point.y, DVec3::Y * along);
            continue;
        }
        for side in 0..sides {
            let (z, x) = circle(side, sides);
            // At the tip of a cone, each side has its own vertex, with the normal of the side's middle.
            let (nz, nx) = if point.radius == 0.0 { circle(2 * side + 1, 2 * sides) } else { (z, x) };
            let position = DVec3::new(point.radius * x, point.y, point.radius * z);
            out.vertex(position, DVec3::new(across * nx, along, across * nz));
        }
    }
    for (pair, start) in profile.windows(2).zip(starts.windows(2)) {
        let at =
            |which: usize, side: u32| start[which] + if pair[which].is_single() { 0 } else { side % sides };
        for side in 0..sides {
            let quad @ [a, b, c, d] = [at(0, side), at(0, side + 1), at(1, side + 1), at(1, side)];
            // At an apex, `c` and `d` have the same position, but only `d` has the normal of this side. Rotate the quad so that its
            // triangle uses `d`.
            if pair[1].radius == 0.0 { out.quad([b, c, d, a]) } else { out.quad(quad) }
        }
    }
    out
}
