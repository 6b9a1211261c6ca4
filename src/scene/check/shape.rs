//! Reads the key `shape` of bodies.

use glam::DVec3;

use super::read::figure;
use super::view::View;
use super::{Context, body, mesh};
use crate::diagnostic::{Code, Diagnostic};
use crate::physics::{Compound, Part, Shape};
use crate::scene::grammar::KeySpec;
use crate::scene::grammar::shapes::{
    axes, capsule, compound, cone, cuboid, cylinder, part, plane, sdl, shape, sphere, torus,
};

/// Reads the physical shape of a body. Returns a placeholder for a missing or wrong shape, whose error has already been reported.
pub(super) fn read(name: &str, view: &View<'_>, context: &mut Context<'_>) -> Shape {
    if let Some(plane) = view.variant(&shape::PLANE) {
        let normal = plane.get(&plane::NORMAL);
        return Shape::Plane { normal };
    }
    if let Some(axes) = view.variant(&shape::AXES) {
        return axes
            .get(&axes::LENGTH)
            .map_or(Shape::Sphere { radius: 1.0 }, |length| Shape::Axes { length });
    }
    if let Some(heightfield) = view.variant(&shape::HEIGHTFIELD) {
        return mesh::heightfield(&heightfield, context).unwrap_or(Shape::Plane { normal: DVec3::Y });
    }
    if let Some(view) = view.variant(&shape::COMPOUND) {
        return compound(name, &view, context).unwrap_or(Shape::Sphere { radius: 1.0 });
    }
    if let Some(sdl) = view.variant(&shape::SDL) {
        if sdl.get(&sdl::OBJECT).is_some_and(|text| text.trim().is_empty()) {
            impossible(&sdl, &sdl::OBJECT.spec, "an object in SDL needs words", "there are none", context);
        }
        return solid(&sdl.table(&sdl::STAND_IN), context).unwrap_or(Shape::Sphere { radius: 1.0 });
    }
    mesh_or_solid(view, context).unwrap_or(Shape::Sphere { radius: 1.0 })
}

/// Reads a mesh or a solid. Does not check whether the mesh is closed. `None` if a value is missing or wrong.
fn mesh_or_solid(view: &View<'_>, context: &mut Context<'_>) -> Option<Shape> {
    match view.variant(&shape::MESH) {
        Some(mesh) => mesh::read(&mesh, context),
        None => solid(view, context),
    }
}

/// Reads the parts of a compound shape. `None` if all of its parts are missing or wrong.
fn compound(name: &str, view: &View<'_>, context: &mut Context<'_>) -> Option<Shape> {
    let mut parts = Vec::new();
    for part in view.tables(&compound::PARTS) {
        let orientation = body::orientation(name, &part, context);
        let location = part.get(&part::LOCATION);
        let shape = mesh_or_solid(&part, context);
        let open = shape.as_ref().and_then(|shape| mesh::open(&part.table(&shape::MESH), shape));
        if let Some(error) = open {
            context.diagnostics.push(error.help("only closed meshes can be parts: close it"));
            continue;
        }
        parts.extend(shape.map(|shape| Part { shape, location, orientation }));
    }
    (!parts.is_empty()).then(|| Shape::Compound(Compound::new(parts)))
}

/// Reads a solid of finite size, such as a sphere or a box. `None` if a number is missing or wrong.
fn solid(view: &View<'_>, context: &mut Context<'_>) -> Option<Shape> {
    if let Some(sphere) = view.variant(&shape::SPHERE) {
        return Some(Shape::Sphere { radius: sphere.get(&sphere::RADIUS)? });
    }
    if let Some(cuboid) = view.variant(&shape::BOX) {
        let size = cuboid.get(&cuboid::SIZE)?;
        let rounding = cuboid.get(&cuboid::ROUNDING);
        if rounding <= 0.0 {
            return Some(Shape::Box { size });
        }
        let most = size.min_element() / 2.0;
        if rounding > most {
            let why = format!("half its smallest edge is {}", figure(most));
            impossible(
                &cuboid,
                &cuboid::ROUNDING.spec,
                "a box cannot be rounder than its smallest edge",
                &why,
                context,
            );
        }
        return Some(Shape::RoundedBox { size, rounding });
    }
    if let Some(cylinder) = view.variant(&shape::CYLINDER) {
        let (radius, height) = (cylinder.get(&cylinder::RADIUS)?, cylinder.get(&cylinder::HEIGHT)?);
        return Some(Shape::Cylinder { radius, height });
    }
    if let Some(capsule) = view.variant(&shape::CAPSULE) {
        let (radius, height) = (capsule.get(&capsule::RADIUS)?, capsule.get(&capsule::HEIGHT)?);
        if height < 2.0 * radius {
            let why = format!("its two half balls alone are {} high", figure(2.0 * radius));
            let what = "the height of a capsule is that from tip to tip, at least twice its radius";
            impossible(&capsule, &capsule::HEIGHT.spec, what, &why, context);
        }
        return Some(Shape::Capsule { radius, height });
    }
    if let Some(cone) = view.variant(&shape::CONE) {
        let top_radius = cone.get(&cone::TOP_RADIUS);
        let (radius, height) = (cone.get(&cone::RADIUS)?, cone.get(&cone::HEIGHT)?);
        return Some(Shape::Cone { radius, top_radius, height });
    }
    let torus = view.variant(&shape::TORUS)?;
    let (radius, tube_radius) = (torus.get(&torus::RADIUS)?, torus.get(&torus::TUBE_RADIUS)?);
    if tube_radius > radius {
        let why = format!("more than its `radius`, {}", figure(radius));
        impossible(
            &torus,
            &torus::TUBE_RADIUS.spec,
            "the tube of a torus would go through itself",
            &why,
            context,
        );
    }
    Some(Shape::Torus { radius, tube_radius })
}

/// Reports a shape that is geometrically impossible.
fn impossible(view: &View<'_>, key: &KeySpec, what: &str, why: &str, context: &mut Context<'_>) {
    let error = Diagnostic::error(Code::ImpossibleShape, what);
    context.diagnostics.extend(view.span(key).map(|span| error.at(span, why)));
}
