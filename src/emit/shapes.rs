//! Writes shapes in SDL, POV-Ray's scene description language.

use glam::{DQuat, DVec3};

use super::meshes::Meshes;
use super::sdl::Style;
use crate::physics::{Part, Shape, cone_base};

/// Returns the beginning of the SDL object for a shape in body axes. The caller appends the material, the pose and the closing brace.
pub(super) fn open(shape: &Shape, meshes: &Meshes, style: Style) -> String {
    let length = |metres: f64| {
        let mut out = String::new();
        style.length(&mut out, metres);
        out
    };
    let point = |metres: DVec3| {
        let mut out = String::new();
        style.point(&mut out, metres);
        out
    };
    let on_axis = |y: f64| point(DVec3::Y * y);
    match *shape {
        Shape::Sphere { radius } => format!("sphere {{ 0, {} ", length(radius)),
        Shape::Box { size } => format!("box {{ {}, {} ", point(-size / 2.0), point(size / 2.0)),
        Shape::RoundedBox { size, rounding } => {
            // An inner edge that is zero up to rounding becomes exactly zero, since POV-Ray refuses tiny edges.
            let inner = |edge: f64| if edge < 1e-6 * rounding { 0.0 } else { edge };
            let half = (size / 2.0 - rounding).map(inner);
            format!("object {{ Rounded_box({}, {}) ", point(half), length(rounding))
        }
        Shape::Cylinder { radius, height } => {
            let (low, high) = (on_axis(-height / 2.0), on_axis(height / 2.0));
            format!("cylinder {{ {low}, {high}, {} ", length(radius))
        }
        Shape::Capsule { radius, height } => {
            let half = height / 2.0 - radius;
            // POV-Ray refuses a cylinder without length, so a capsule as short as a ball is written as a sphere.
            if half < 1e-6 * radius {
                return open(&Shape::Sphere { radius }, meshes, style);
            }
            let (low, high, radius) = (on_axis(-half), on_axis(half), length(radius));
            let balls = format!("sphere {{ {low}, {radius} }} sphere {{ {high}, {radius} }}");
            format!("union {{ cylinder {{ {low}, {high}, {radius} open }} {balls} ")
        }
        Shape::Cone { radius, top_radius, height } => {
            let base = cone_base(radius, top_radius, height);
            let (low, high) = (on_axis(base), on_axis(base + height));
            format!("cone {{ {low}, {}, {high}, {} ", length(radius), length(top_radius))
        }
        Shape::Torus { radius, tube_radius } => {
            format!("torus {{ {}, {} ", length(radius), length(tube_radius))
        }
        Shape::Plane { normal } => {
            let mut out = "plane { ".to_owned();
            style.vector(&mut out, normal);
            out + ", 0 "
        }
        Shape::Mesh { ref mesh, scale } => meshes.open(mesh, scale, style),
        Shape::Axes { length: arm } => format!("object {{ Axes scale {} ", length(arm)),
        Shape::Compound(ref compound) => match compound.parts() {
            // POV-Ray warns about a union of one object.
            [only] => part(only, meshes, style),
            parts => {
                let parts = parts.iter().map(|each| format!("  {}}}\n", part(each, meshes, style)));
                format!("union {{\n{}  ", parts.collect::<String>())
            }
        },
    }
}

/// Returns the beginning of the SDL object for a part of a compound shape, with the part's pose in body axes. The rest is as for [`open`].
fn part(Part { shape, location, orientation }: &Part, meshes: &Meshes, style: Style) -> String {
    let mut out = open(shape, meshes, style);
    if *orientation == DQuat::IDENTITY {
        out.push_str("translate ");
        style.point(&mut out, *location);
    } else {
        style.matrix(&mut out, *orientation, *location);
    }
    out.push(' ');
    out
}

/// Returns the beginning of the SDL object for the scene's own POV-Ray code, enlarged by `scale`. Lengths in the code are in meters. The
/// rest is as for [`open`].
pub(super) fn open_sdl(object: &str, scale: f64, style: Style) -> String {
    // The scene's POV-Ray code is on separate lines, since it may end with a `//` comment.
    let mut out = format!("object {{\n{object}\n");
    if scale != style.unit {
        out.push_str("scale ");
        style.length(&mut out, scale);
        out.push(' ');
    }
    out
}
