//! Triangles of base shapes with flat faces.

use glam::DVec3;

use super::Triangles;
use super::angles::circle;

/// A cube from -1 to 1 along all axes.
pub(super) fn cube() -> Triangles {
    let mut out = Triangles::default();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for normal in [axis, -axis] {
            // Two vectors along the face, which form a right-handed system with its normal.
            let first = DVec3::new(normal.z.abs() + normal.y.abs(), 0.0, normal.x.abs());
            let second = normal.cross(first);
            let corner = |i: f64, j: f64| normal + first * i + second * j;
            let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            let face = corners.map(|corner| out.vertex(corner, normal));
            out.quad(face);
        }
    }
    out
}

/// A square from -1 to 1 along x and z, visible from above.
pub(super) fn plane() -> Triangles {
    let mut out = Triangles::default();
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    let face = corners.map(|[x, z]| out.vertex(DVec3::new(x, 0.0, z), DVec3::Y));
    out.quad(face);
    out
}

/// A box with rounded edges: a ball cut into eight parts, which are moved to the corners of the box. The gaps become its edges and faces.
pub(super) fn rounded_box(half: DVec3, rounding: f64, sides: u32) -> Triangles {
    let mut out = Triangles::default();
    let inner = (half - rounding).max(DVec3::ZERO);
    let quarter = sides / 4;
    // The angles from the lower to the upper pole, and around the axis. The angle of each cut occurs twice, once for each side.
    let rows = [0, 1].map(|upper| (0..=quarter).map(move |part| (part + upper * quarter, upper)));
    let columns = [0, 1, 2, 3].map(|side| (0..=quarter).map(move |part| (part + side * quarter, side)));
    let columns: Vec<_> = columns.into_iter().flatten().collect();
    for (row, upper) in rows.into_iter().flatten() {
        let (cosine, sine) = circle(row, sides);
        for &(column, side) in &columns {
            let (z, x) = circle(column, sides);
            let normal = DVec3::new(sine * x, -cosine, sine * z);
            let corner = DVec3::new(
                if side < 2 { 1.0 } else { -1.0 },
                if upper == 1 { 1.0 } else { -1.0 },
                if side == 0 || side == 3 { 1.0 } else { -1.0 },
            );
            out.vertex(inner * corner + rounding * normal, normal);
        }
    }
    let width = 4 * (quarter + 1);
    let height = 2 * (quarter + 1);
    for row in 0..height - 1 {
        for column in 0..width {
            let next = (column + 1) % width;
            let (low, high) = (row * width, (row + 1) * width);
            out.quad([low + column, low + next, high + next, high + column]);
        }
    }
    // The bottom and top faces.
    let corner = |row: u32, side: u32| row * width + side * (quarter + 1);
    out.quad([0, 1, 2, 3].map(|side| corner(height - 1, side)));
    out.quad([3, 2, 1, 0].map(|side| corner(0, side)));
    out
}
