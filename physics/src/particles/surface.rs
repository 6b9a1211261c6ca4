//! Draws random points on the surfaces of shapes, with uniform distribution over the area.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::origin::within_disc;
use crate::random::Stream;
use crate::{Shape, cone_base};

/// Returns whether points on the surface of a shape can be drawn by a formula, so that particles can be born on that surface. For a mesh,
/// use its [triangles](super::Triangles).
#[must_use]
pub fn has_surface(shape: &Shape) -> bool {
    matches!(
        shape,
        Shape::Sphere { .. }
            | Shape::Box { .. }
            | Shape::Cylinder { .. }
            | Shape::Capsule { .. }
            | Shape::Cone { .. }
            | Shape::Torus { .. }
    )
}

/// Draws a random point on the surface of a shape, in the axes of the shape. Returns the point (m) and the unit normal at this point. If
/// [`has_surface`] is false for the shape, the point is the origin.
pub(super) fn place(shape: &Shape, random: &mut Stream) -> (DVec3, DVec3) {
    match *shape {
        Shape::Sphere { radius } => {
            let normal = on_unit_sphere(random);
            (radius * normal, normal)
        }
        Shape::Box { size } => on_box(size, random),
        Shape::Cylinder { radius, height } => {
            let base = -height / 2.0;
            on_frustum(Frustum { base, height, low: radius, high: radius, is_closed: true }, random)
        }
        Shape::Cone { radius, top_radius, height } => {
            let base = cone_base(radius, top_radius, height);
            on_frustum(Frustum { base, height, low: radius, high: top_radius, is_closed: true }, random)
        }
        Shape::Capsule { radius, height } => {
            let middle = height - 2.0 * radius;
            // By Archimedes' theorem, each half ball has the lateral area of a cylinder of the same height, 2πr per unit of height. The
            // wall has the same area per unit of height.
            if random.uniform() * height < middle {
                let wall = Frustum {
                    base: -middle / 2.0,
                    height: middle,
                    low: radius,
                    high: radius,
                    is_closed: false,
                };
                return on_frustum(wall, random);
            }
            let normal = on_unit_sphere(random);
            let end = DVec3::Y * (middle / 2.0).copysign(normal.y);
            (end + radius * normal, normal)
        }
        Shape::Torus { radius, tube_radius } => on_torus(radius, tube_radius, random),
        Shape::RoundedBox { .. }
        | Shape::Plane { .. }
        | Shape::Axes { .. }
        | Shape::Compound(_)
        | Shape::Mesh { .. } => (DVec3::ZERO, DVec3::Y),
    }
}

/// Draws a random point on the unit sphere, with uniform distribution. By Archimedes' theorem, the height of such a point is uniform.
fn on_unit_sphere(random: &mut Stream) -> DVec3 {
    let y = 2.0 * random.uniform() - 1.0;
    let (sin, cos) = libm::sincos(TAU * random.uniform());
    let across = (1.0 - y * y).sqrt();
    DVec3::new(across * cos, y, across * sin)
}

fn on_box(size: DVec3, random: &mut Stream) -> (DVec3, DVec3) {
    let areas = [size.y * size.z, size.z * size.x, size.x * size.y];
    let mut chosen = random.uniform() * areas.iter().sum::<f64>();
    let mut axis = 0;
    while axis < 2 && chosen >= areas[axis] {
        chosen -= areas[axis];
        axis += 1;
    }
    let side = if chosen < areas[axis] / 2.0 { 1.0 } else { -1.0 };
    let normal = side * DVec3::AXES[axis];
    let part = DVec3::new(random.uniform(), random.uniform(), random.uniform()) - 0.5;
    let mut place = part * size;
    place[axis] = side * size[axis] / 2.0;
    (place, normal)
}

/// A cylinder or frustum about the y axis, with or without the discs at its ends. `low` and `high` are the radii at its lower and upper
/// end.
struct Frustum {
    base: f64,
    height: f64,
    low: f64,
    high: f64,
    is_closed: bool,
}

fn on_frustum(
    Frustum { base, height, low, high, is_closed }: Frustum,
    random: &mut Stream,
) -> (DVec3, DVec3) {
    let slope = low - high;
    let side = (height * height + slope * slope).sqrt();
    let discs = if is_closed { [low, high].map(|radius| PI * radius * radius) } else { [0.0; 2] };
    let wall = PI * (low + high) * side;
    let chosen = random.uniform() * (wall + discs[0] + discs[1]);
    if chosen >= wall {
        let is_low = chosen < wall + discs[0];
        let (x, z) = within_disc(if is_low { low } else { high }, random);
        let (y, normal) = if is_low { (base, -DVec3::Y) } else { (base + height, DVec3::Y) };
        return (DVec3::new(x, y, z), normal);
    }
    // The area below a fraction s of the height is proportional to s low + s² (high − low)/2. The inverse of this function gives s.
    let part = random.uniform();
    let (square, whole) = (low * low, part * (low * low - high * high));
    let radius = (square - whole).max(0.0).sqrt();
    let up = if slope == 0.0 { part } else { (low - radius) / slope };
    let (sin, cos) = libm::sincos(TAU * random.uniform());
    let normal = DVec3::new(cos * height, slope, sin * height) / side;
    (DVec3::new(radius * cos, base + up * height, radius * sin), normal)
}

/// Draws a random point on a torus by rejection sampling: the density of the area along the tube is proportional to R + r cos φ, so points
/// are drawn until one is accepted.
fn on_torus(radius: f64, tube_radius: f64, random: &mut Stream) -> (DVec3, DVec3) {
    let (sin, cos) = loop {
        let (sin, cos) = libm::sincos(TAU * random.uniform());
        if random.uniform() * (radius + tube_radius) <= radius + tube_radius * cos {
            break (sin, cos);
        }
    };
    let (z, x) = libm::sincos(TAU * random.uniform());
    let normal = DVec3::new(x * cos, sin, z * cos);
    (DVec3::new(x * radius, 0.0, z * radius) + tube_radius * normal, normal)
}
