//! `[body.NAME]`.

use glam::{DQuat, DVec3};

use super::read::figure;
use super::view::View;
use super::{Context, look, shape, showing};
use crate::diagnostic::{Diagnostic, Span};
use crate::dynamics::{RigidBody, Shape};
use crate::scene::palette::Palette;
use crate::scene::{Body, LibraryMaterial, Material};

/// The keys that say how a body moves.
const MOTION: [&str; 2] = ["velocity", "angular_velocity"];
/// The keys that say how easily a body is turned, and what pushes it. Of its mass see [`super::effect`].
const PUSHING: [&str; 3] = ["inertia", "force", "torque"];

pub(super) fn read(root: &View<'_>, materials: &mut Vec<Material>, context: &mut Context<'_>) -> Vec<Body> {
    let tables = root.named("body");
    let mut palette = Palette::default();
    let read = |(name, span, view): (&str, Span, View<'_>)| {
        let shape = shape::read(name, &view.table("shape"), context);
        let material = material(name, root, &view, &shape, materials, &mut palette, context);
        let start = start(name, span, &view, &shape, context);
        let look = look::of_body(name, &view, &shape, context);
        let showing = showing::of_body(name, &view, &shape, start.fixed, context);
        Body { name: name.to_owned(), shape, start, material, look, showing }
    };
    tables.into_iter().map(read).collect()
}

/// The body as it is at the start.
fn start(name: &str, span: Span, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> RigidBody {
    let fixed = fixed(name, view, shape, context);
    let mass = mass(name, span, view, shape, context);
    let inertia = inertia(name, view, context);
    // Moments that are given are those about the body's own axes.
    let principal_axes = inertia.map_or(shape.principal_axes(), |_| DQuat::IDENTITY);
    let vector = |key: &str| view.vector(key).unwrap_or(DVec3::ZERO);
    RigidBody {
        mass,
        charge: view.number("charge").unwrap_or(0.0),
        inertia: inertia.unwrap_or_else(|| inertia_of_shape(name, span, shape, mass, fixed, context)),
        principal_axes,
        location: vector("location"),
        orientation: orientation(name, view, context),
        velocity: vector("velocity"),
        angular_velocity: vector("angular_velocity"),
        force: vector("force"),
        torque: vector("torque"),
        fixed,
    }
}

/// Whether a body stays where it is; what contradicts that, or is of no use then, is reported.
fn fixed(name: &str, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> bool {
    let plane = matches!(shape, Shape::Plane { .. });
    let given = view.boolean("fixed");
    if plane && given == Some(false) {
        let error =
            Diagnostic::error("plane-moves", format!("the plane `{name}` cannot move: a plane is endless"));
        context.diagnostics.extend(view.span("fixed").map(|span| error.at(span, "a plane is always fixed")));
    }
    let fixed = plane || given == Some(true);
    if fixed {
        let why = if plane { "a plane is always fixed" } else { "it is fixed" };
        for key in MOTION.into_iter().filter(|key| view.vector(key).is_some_and(|v| v != DVec3::ZERO)) {
            let error = Diagnostic::error(
                "fixed-moves",
                format!("`{name}` is fixed, so its `{key}` must be [0, 0, 0]"),
            );
            context.diagnostics.extend(view.key_span(key).map(|span| error.at(span, why)));
        }
        for key in PUSHING.into_iter().filter(|key| view.has(key)) {
            let message = format!("`{key}` of `{name}` has no effect");
            let warning = Diagnostic::warning("no-effect", message);
            context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, why)));
        }
    }
    fixed
}

fn mass(name: &str, span: Span, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> f64 {
    let Some(density) = view.number("density") else { return view.number("mass").unwrap_or(1.0) };
    let Some(volume) = shape.volume() else { return 1.0 };
    let mass = density * volume;
    if mass.is_finite() && mass > 0.0 {
        return mass;
    }
    let error = Diagnostic::error("impossible-mass", format!("the mass of `{name}` is {}", extreme(mass)));
    let label = "mass = density × volume";
    context.diagnostics.push(error.at(view.span("density").unwrap_or(span), label));
    1.0
}

/// What is wrong with a number that should be positive and finite, and has been computed.
fn extreme(number: f64) -> &'static str {
    if number > 0.0 { "larger than any number" } else { "smaller than any number" }
}

/// The inertia that follows from shape and mass, which must be one that a computer can divide by.
fn inertia_of_shape(
    name: &str,
    span: Span,
    shape: &Shape,
    mass: f64,
    fixed: bool,
    context: &mut Context<'_>,
) -> DVec3 {
    let inertia = shape.inertia(mass);
    let wrong = inertia.to_array().into_iter().find(|moment| !moment.is_finite() || *moment <= 0.0);
    if let (Some(moment), false) = (wrong, fixed) {
        let message = format!("the moment of inertia of `{name}` is {}", extreme(moment));
        let error = Diagnostic::error("impossible-inertia", message);
        context.diagnostics.push(error.at(span, "its shape or its mass is too extreme"));
    }
    inertia
}

/// The inertia that is given, if it is one that a body can have.
fn inertia(name: &str, view: &View<'_>, context: &mut Context<'_>) -> Option<DVec3> {
    // Each moment is a sum over the other two coordinates, so none can exceed the sum of the others; a flat
    // body reaches it, and rounding may exceed it a little.
    const ROUNDING: f64 = 1e-9;
    let inertia = view.vector("inertia")?;
    let mut moments = inertia.to_array();
    moments.sort_unstable_by(f64::total_cmp);
    let [smallest, middle, largest] = moments;
    let others = smallest + middle;
    if largest > others * (1.0 + ROUNDING) {
        let message = format!("no body has the moments of inertia of `{name}`");
        let label =
            format!("{} is larger than the sum of the other two, {}", figure(largest), figure(others));
        let help = "Ix + Iy ≥ Iz, and likewise for the others, holds for every distribution of mass";
        let error = Diagnostic::error("impossible-inertia", message).help(help);
        context.diagnostics.extend(view.span("inertia").map(|span| error.at(span, label)));
    }
    Some(inertia)
}

/// An orientation under the key of that name; `name` is the body's.
pub(super) fn orientation(name: &str, view: &View<'_>, context: &mut Context<'_>) -> DQuat {
    if let Some(angles) = view.vector("orientation") {
        return euler(angles);
    }
    let table = view.table("orientation");
    if let Some(angles) = table.vector("euler") {
        return euler(angles);
    }
    if let Some(quaternion) = table.direction::<4>("quaternion") {
        return DQuat::from_array(quaternion);
    }
    for (key, other) in [("axis", "angle"), ("angle", "axis")] {
        if let (Some(span), false) = (table.key_span(key), table.has(other)) {
            let message = format!("`{key}` without `{other}` in the orientation of `{name}`");
            let error = Diagnostic::error("missing-key", message).at(span, format!("needs `{other}`"));
            context.diagnostics.push(error);
        }
    }
    match (table.direction::<3>("axis"), table.number("angle")) {
        (Some(axis), Some(angle)) => DQuat::from_axis_angle(DVec3::from_array(axis), angle.to_radians()),
        _ => DQuat::IDENTITY,
    }
}

/// Turned about the world's x, then y, then z, as POV-Ray's `rotate <x, y, z>` does; angles in degrees.
fn euler(angles: DVec3) -> DQuat {
    let turn = |axis: DVec3, angle: f64| DQuat::from_axis_angle(axis, angle.to_radians());
    turn(DVec3::Z, angles.z) * turn(DVec3::Y, angles.y) * turn(DVec3::X, angles.x)
}

/// The number of a body's material; bodies without one get one of the palette's, and axes have colors of their own.
fn material(
    name: &str,
    root: &View<'_>,
    view: &View<'_>,
    shape: &Shape,
    materials: &mut Vec<Material>,
    palette: &mut Palette,
    context: &mut Context<'_>,
) -> Option<usize> {
    if matches!(shape, Shape::Axes { .. }) {
        let warning = Diagnostic::warning("no-effect", "the material of axes has no effect");
        let why = "axes are red, green and blue";
        context.diagnostics.extend(view.key_span("material").map(|span| warning.at(span, why)));
        return None;
    }
    // Also a body with a material of its own takes its turn: giving it one changes no other's color.
    let usual = palette.next(shape);
    if let Some(table) = view.variant("material") {
        let look = super::material::look(&table, root, context);
        materials.push(Material { name: name.to_owned(), look });
        return Some(materials.len() - 1);
    }
    // An object in POV-Ray's own words brings its own textures along, which another one would cover.
    let has_own = view.table("shape").has("sdl");
    let Some(name) = view.text("material") else {
        return (!has_own).then(|| palette.material(usual, materials));
    };
    let number = context.names.materials.get(name).copied();
    let number = number.or_else(|| Some(palette.of_library(LibraryMaterial::named(name)?, materials)));
    Some(number.unwrap_or_else(|| palette.material(usual, materials)))
}
