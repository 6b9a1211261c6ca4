//! Finds the point at which a ray leaves a shape.

use glam::{DVec2, DVec3};

use super::{Mesh, Shape, cone_base};

/// The largest number of steps along a ray towards a surface. Only rays that graze the surface need more than about twenty steps.
const MAX_STEPS: usize = 300;
/// A point counts as lying on a surface if its distance is at most this fraction of the size of the shape.
const SURFACE_TOLERANCE: f64 = 1e-12;
/// The radius of the shaft of each arm of [`Shape::Axes`], as a fraction of the arm's length.
const SHAFT_RADIUS: f64 = 0.03;

impl Shape {
    /// Returns the distance along a ray from its origin to its last point in the shape, m. The ray begins at `origin` (m) and has the unit
    /// direction `direction`, both in the frame of the body. Returns `None` if the ray misses the shape, and for a plane.
    #[must_use]
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        match *self {
            Shape::Sphere { radius } => sphere(origin, direction, radius),
            Shape::Box { size } => cuboid(origin, direction, 0.5 * size),
            Shape::Plane { .. } => None,
            Shape::Compound(ref compound) => {
                let exits = compound.parts().iter().filter_map(|part| {
                    let turn = part.orientation.conjugate();
                    part.shape.exit(turn * (origin - part.location), turn * direction)
                });
                exits.reduce(f64::max)
            }
            Shape::Mesh { ref mesh, scale } => Some(scale * triangles(mesh, origin / scale, direction)?),
            Shape::RoundedBox { .. }
            | Shape::Cylinder { .. }
            | Shape::Capsule { .. }
            | Shape::Cone { .. }
            | Shape::Torus { .. }
            | Shape::Axes { .. } => self.traced(origin, direction),
        }
    }

    /// Returns the positions along a line at which it first enters the shape and last leaves it, m. The positions count from `at` (m) in the
    /// unit direction `direction`, both in the frame of the body. Returns `None` if the line misses the shape, and for a plane.
    #[must_use]
    pub fn through(&self, at: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        let outside = at.length() + self.bounding_radius()?;
        let last = |way: DVec3| Some(self.exit(at - outside * way, way)? - outside);
        Some([-last(-direction)?, last(direction)?])
    }

    /// Finds the exit point backwards along the ray, from a point outside of the shape. Each step is as long as the distance to the
    /// surface, so no step passes through the surface (sphere tracing).
    ///
    /// Source: J. C. Hart, The Visual Computer 12 (1996) 527.
    fn traced(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let size = self.bounding_radius()?;
        let mut along = origin.length() + size;
        for _ in 0..MAX_STEPS {
            let off = self.distance(origin + direction * along)?;
            if off <= SURFACE_TOLERANCE * size {
                return Some(along);
            }
            along -= off;
            if along < 0.0 {
                return None;
            }
        }
        Some(along)
    }

    /// Returns the signed distance of a point from the surface, m; negative inside. The point is in the frame of the body. Returns `None`
    /// for shapes whose exits are computed without a distance function.
    fn distance(&self, point: DVec3) -> Option<f64> {
        // Shapes that use `across` have an axis of symmetry along y.
        let across = DVec2::new(point.x, point.z).length();
        Some(match *self {
            Shape::RoundedBox { size, rounding } => {
                let over = point.abs() - (0.5 * size - rounding);
                over.max(DVec3::ZERO).length() + over.max_element().min(0.0) - rounding
            }
            Shape::Cylinder { radius, height } => {
                let over = DVec2::new(across - radius, point.y.abs() - 0.5 * height);
                over.max(DVec2::ZERO).length() + over.max_element().min(0.0)
            }
            Shape::Capsule { radius, height } => {
                let half = 0.5 * height - radius;
                (point - DVec3::Y * point.y.clamp(-half, half)).length() - radius
            }
            Shape::Cone { radius, top_radius, height } => {
                let base = cone_base(radius, top_radius, height);
                cone(DVec2::new(across, point.y - base), radius, top_radius, height)
            }
            Shape::Torus { radius, tube_radius } => {
                DVec2::new(across - radius, point.y).length() - tube_radius
            }
            Shape::Axes { length } => {
                let arm = |axis: DVec3| (point - axis * point.dot(axis).clamp(0.0, length)).length();
                arm(DVec3::X).min(arm(DVec3::Y)).min(arm(DVec3::Z)) - SHAFT_RADIUS * length
            }
            Shape::Sphere { .. }
            | Shape::Box { .. }
            | Shape::Plane { .. }
            | Shape::Compound(_)
            | Shape::Mesh { .. } => return None,
        })
    }
}

fn sphere(origin: DVec3, direction: DVec3, radius: f64) -> Option<f64> {
    let along = -origin.dot(direction);
    let half_chord = radius * radius - (origin + direction * along).length_squared();
    let exit = along + half_chord.max(0.0).sqrt();
    (half_chord >= 0.0 && exit >= 0.0).then_some(exit)
}

/// Returns the distance to the exit from a box by the slab method: the ray is inside the box between the last of its three entries and the
/// first of its three exits.
fn cuboid(origin: DVec3, direction: DVec3, half: DVec3) -> Option<f64> {
    let (mut enters, mut leaves) = (0.0f64, f64::MAX);
    for axis in 0..3 {
        if direction[axis].abs() < 1e-300 {
            if origin[axis].abs() > half[axis] {
                return None;
            }
            continue;
        }
        let towards = half[axis] * direction[axis].signum();
        enters = enters.max((-towards - origin[axis]) / direction[axis]);
        leaves = leaves.min((towards - origin[axis]) / direction[axis]);
    }
    (enters <= leaves).then_some(leaves)
}

/// Returns the signed distance of a point from a frustum, m; negative inside. The coordinates of `point` are its distance from the axis
/// and its height above the base.
///
/// Source: I. Quilez, "Capped Cone", in his list of distance functions.
fn cone(point: DVec2, radius: f64, top_radius: f64, height: f64) -> f64 {
    let at_end = if point.y < 0.5 * height { radius } else { top_radius };
    let end = DVec2::new(point.x - point.x.min(at_end), (point.y - 0.5 * height).abs() - 0.5 * height);
    let slope = DVec2::new(radius - top_radius, -height);
    let top = DVec2::new(top_radius, height);
    let part = ((top - point).dot(-slope) / slope.length_squared()).clamp(0.0, 1.0);
    let side = point - top - slope * part;
    let inside = side.x < 0.0 && end.y < 0.0;
    let off = side.length_squared().min(end.length_squared()).sqrt();
    if inside { -off } else { off }
}

/// Returns the distance to the farthest triangle that a ray intersects (Möller and Trumbore, J. Graphics Tools 2 (1997) 21).
fn triangles(mesh: &Mesh, origin: DVec3, direction: DVec3) -> Option<f64> {
    let vertices = mesh.vertices();
    let met = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|number| vertices[number as usize]);
        let (ab, ac) = (b - a, c - a);
        let across = direction.cross(ac);
        let volume = ab.dot(across);
        if volume == 0.0 {
            return None;
        }
        let from_a = origin - a;
        let u = from_a.dot(across) / volume;
        let turned = from_a.cross(ab);
        let v = direction.dot(turned) / volume;
        let along = ac.dot(turned) / volume;
        // Because of this tolerance, a ray through an edge intersects at least one triangle at that edge in spite of rounding errors.
        (u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9 && along >= 0.0).then_some(along)
    };
    mesh.triangles().iter().filter_map(met).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DQuat;

    use super::*;
    use crate::shape::{Compound, Part};

    /// Returns a ball of triangles with its corners at a radius of 1, at a scale of 2. Its surface lies between the radii cos 3.6° and 1.
    fn globe() -> Shape {
        let (rows, columns) = (50u32, 100u32);
        let at = |row: u32, column: u32| {
            let polar = std::f64::consts::PI * f64::from(row) / f64::from(rows);
            let around = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
            let across = libm::sin(polar);
            DVec3::new(across * libm::sin(around), libm::cos(polar), across * libm::cos(around))
        };
        let vertices = (0..=rows).flat_map(|row| (0..columns).map(move |column| at(row, column))).collect();
        let number = |row: u32, column: u32| row * columns + column % columns;
        let triangles = (0..rows).flat_map(|row| {
            (0..columns).flat_map(move |column| {
                let [a, b] = [number(row, column), number(row + 1, column)];
                let [c, d] = [number(row + 1, column + 1), number(row, column + 1)];
                [[a, b, c], [a, c, d]]
            })
        });
        Shape::Mesh { mesh: Arc::new(Mesh::surface("globe", vertices, triangles.collect())), scale: 2.0 }
    }

    #[test]
    fn rays_leave_shapes_where_they_end() {
        let slanted = DVec3::new(3.0, 4.0, 0.0) / 5.0;
        let cone = Shape::Cone { radius: 1.0, top_radius: 0.0, height: 4.0 };
        let ring = Shape::Torus { radius: 3.0, tube_radius: 1.0 };
        for (shape, origin, direction, exit) in [
            (Shape::Sphere { radius: 2.0 }, DVec3::ZERO, slanted, Some(2.0)),
            (Shape::Sphere { radius: 5.0 }, DVec3::Z * 3.0, DVec3::X, Some(4.0)),
            (Shape::Sphere { radius: 2.0 }, DVec3::Z * 2.1, DVec3::X, None),
            (Shape::Sphere { radius: 2.0 }, DVec3::X * 3.0, DVec3::X, None),
            (Shape::Box { size: DVec3::new(4.0, 0.2, 1.0) }, DVec3::ZERO, slanted, Some(0.125)),
            (Shape::Box { size: DVec3::ONE }, DVec3::Z * 0.4, DVec3::X, Some(0.5)),
            (Shape::Box { size: DVec3::ONE }, DVec3::Z * 0.6, DVec3::X, None),
            (Shape::RoundedBox { size: DVec3::splat(2.0), rounding: 0.5 }, DVec3::ZERO, DVec3::Y, Some(1.0)),
            // The ray leaves through a rounded edge: the exit is the distance to the axis of the rounding, plus the rounding radius.
            (
                Shape::RoundedBox { size: DVec3::splat(2.0), rounding: 0.5 },
                DVec3::ZERO,
                DVec3::new(1.0, 1.0, 0.0).normalize(),
                Some(0.5 * 2f64.sqrt() + 0.5),
            ),
            (Shape::Cylinder { radius: 0.5, height: 2.0 }, DVec3::ZERO, slanted, Some(0.5 / 0.6)),
            (Shape::Cylinder { radius: 0.5, height: 2.0 }, DVec3::Z * 0.3, DVec3::X, Some(0.4)),
            (Shape::Capsule { radius: 0.5, height: 2.0 }, DVec3::ZERO, DVec3::Y, Some(1.0)),
            (Shape::Capsule { radius: 0.5, height: 2.0 }, DVec3::ZERO, DVec3::X, Some(0.5)),
            // The centre of mass of a cone is a quarter of its height above its base.
            (cone.clone(), DVec3::ZERO, DVec3::Y, Some(3.0)),
            (cone.clone(), DVec3::ZERO, -DVec3::Y, Some(1.0)),
            (cone, DVec3::ZERO, DVec3::X, Some(0.75)),
            (ring.clone(), DVec3::ZERO, DVec3::X, Some(4.0)),
            (ring.clone(), DVec3::Y * 0.6, DVec3::X, Some(3.8)),
            (ring, DVec3::ZERO, DVec3::Y, None),
            (Shape::Plane { normal: DVec3::Y }, DVec3::ZERO, DVec3::Y, None),
            (Shape::Axes { length: 2.0 }, DVec3::ZERO, DVec3::Y, Some(2.06)),
            (Shape::Axes { length: 2.0 }, DVec3::ZERO, -DVec3::Y, Some(0.06)),
        ] {
            let found = shape.exit(origin, direction);
            let is_right = match (found, exit) {
                (Some(found), Some(exit)) => (found - exit).abs() < 1e-9,
                (found, exit) => found == exit,
            };
            assert!(is_right, "{shape:?} from {origin} along {direction}: {found:?}");
        }
    }

    #[test]
    fn rays_leave_the_last_part_or_triangle_that_they_meet() {
        let part =
            |shape: Shape, x: f64| Part { shape, location: DVec3::X * x, orientation: DQuat::IDENTITY };
        // A hammer: a long handle and a heavy head.
        let handle = Shape::Box { size: DVec3::new(4.0, 0.1, 0.1) };
        let head = Shape::Box { size: DVec3::new(1.0, 2.0, 1.0) };
        let hammer = Shape::Compound(Compound::new(vec![part(handle, 0.0), part(head.clone(), 2.5)]));
        let Shape::Compound(ref compound) = hammer else { panic!("it is one") };
        let [handle_at, head_at] = [0, 1].map(|number: usize| compound.parts()[number].location.x);
        assert!((hammer.exit(DVec3::ZERO, DVec3::X).unwrap() - head_at - 0.5).abs() < 1e-9);
        assert!((hammer.exit(DVec3::ZERO, -DVec3::X).unwrap() - 2.0 + handle_at).abs() < 1e-9);
        // Two heads without a connection: a ray upwards from the centre of mass misses both.
        let apart = Shape::Compound(Compound::new(vec![part(head.clone(), -2.0), part(head, 2.0)]));
        assert_eq!(apart.exit(DVec3::ZERO, DVec3::Y), None);
        for direction in [DVec3::X, DVec3::new(0.3, -0.8, 0.5).normalize(), -DVec3::Z] {
            let exit = globe().exit(DVec3::ZERO, direction).unwrap();
            assert!(
                (2.0 * libm::cos(3.6f64.to_radians())..2.0 + 1e-9).contains(&exit),
                "{direction}: {exit}"
            );
        }
        assert_eq!(globe().exit(DVec3::Y * 2.1, DVec3::X), None);
    }

    #[test]
    fn lines_pass_through_shapes_between_two_surfaces() {
        let can = Shape::Cylinder { radius: 0.5, height: 2.0 };
        for (shape, at, direction, expected) in [
            (can.clone(), DVec3::Y * 5.0, DVec3::Y, Some([-6.0, -4.0])),
            (can.clone(), DVec3::new(0.3, -5.0, 0.0), DVec3::Y, Some([4.0, 6.0])),
            (can.clone(), DVec3::Y * 0.5, DVec3::X, Some([-0.5, 0.5])),
            (can, DVec3::new(0.6, 5.0, 0.0), DVec3::Y, None),
            (Shape::Plane { normal: DVec3::Y }, DVec3::Y, DVec3::Y, None),
        ] {
            let found = shape.through(at, direction);
            let near =
                |found: [f64; 2], expected: [f64; 2]| (0..2).all(|i| (found[i] - expected[i]).abs() < 1e-9);
            let is_right =
                found.zip(expected).map_or(found == expected, |(found, expected)| near(found, expected));
            assert!(is_right, "{shape:?} at {at} along {direction}: {found:?}");
        }
    }
}
