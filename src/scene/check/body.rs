//! Reads the bodies of a scene from `[body.NAME]`.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::read::figure;
use super::view::View;
use super::{Context, contact, corrections, look, mesh, motion, presence, shape, showing};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{RigidBody, Shape};
use crate::scene::default_looks::DefaultLooks;
use crate::scene::grammar::bodies::{body, orientation};
use crate::scene::grammar::scene::scene;
use crate::scene::grammar::shapes::shape as shape_keys;
use crate::scene::grammar::{Key, KeySpec};
use crate::scene::source::Table;
use crate::scene::value;
use crate::scene::{Body, BodyLook, LibraryMaterial, Material, Showing, SimulationSettings};

/// The keys for the initial velocities of a body.
static VELOCITY_KEYS: [&Key<DVec3>; 2] = [&body::VELOCITY, &body::ANGULAR_VELOCITY];
/// The keys for the moments of inertia and the constant loads of a body. They have no effect on a body that is fixed or has a given motion.
/// [`super::effect`] warns of a mass that has no effect.
static INERTIA_AND_LOAD_KEYS: [&KeySpec; 3] = [&body::INERTIA.spec, &body::FORCE.spec, &body::TORQUE.spec];

/// The parts of the body read before the current one. Copies of a body share these parts.
struct Last {
    /// The shape table of the body read before.
    table: Option<Table>,
    shape: Shape,
    look: Arc<BodyLook>,
    showing: Arc<Showing>,
}

pub(super) fn read(
    root: &View<'_>,
    simulation: &SimulationSettings,
    materials: &mut Vec<Material>,
    context: &mut Context<'_>,
) -> Vec<Body> {
    let mut default_looks = DefaultLooks::default();
    let mut last: Option<Last> = None;
    let mut bodies = Vec::with_capacity(root.bodies().len());
    let mut arranged = None;
    for table in root.bodies() {
        let (name, span) = (table.name(), table.span());
        if let Some(like) = bodies.last().filter(|_| context.has_too_many_wrong_copies(name)) {
            bodies.push(Body { name: name.clone(), ..Body::clone(like) });
            continue;
        }
        let before = context.diagnostics.len();
        let body = table.look(|view| {
            let table = view.table(&body::SHAPE);
            // If this body has the same shape table as the body read before it, reuse the shape.
            let same = last.as_ref().filter(|last| table.is_same(last.table.as_ref()));
            let shape = same.map(|last| last.shape.clone());
            let shape = shape.unwrap_or_else(|| shape::read(name, &table, context));
            let material = material(name, root, view, &shape, materials, &mut default_looks, context);
            let mut start = start(name, span, view, &shape, context);
            let place = (start.location, start.orientation);
            let own = presence::read(name, view, simulation, context);
            let motion = motion::read(name, view, place, &own, simulation, context);
            let (motion, presence) =
                motion.map_or((None, own), |(motion, presence)| (Some(motion), presence));
            presence::never(name, view, &presence, simulation, context);
            if let Some(motion) = &motion {
                // Take the initial pose from the motion, not from the body's table. Rest lengths of springs are computed from this pose.
                let (location, orientation) = motion.place(presence.first_from(0.0).unwrap_or(0.0));
                let is_first = view.has(&body::REPEAT);
                if is_first {
                    arranged = Some([start.location, location]);
                } else if let Some([first, path]) = arranged.take() {
                    let has_no_effect = first != start.location && path == location;
                    let span = view.key_span(&body::MOTION).filter(|_| has_no_effect);
                    context.diagnostics.extend(span.map(|span| same_path(name, span)));
                }
                start = RigidBody { location, orientation, ..start };
            }
            let collider = contact::collider(name, view, &shape, simulation, context);
            let collider = contact::shared(bodies.last(), collider);
            let look = look::of_body(name, view, &shape, context);
            let same = last.as_ref().filter(|last| *last.look == look);
            let look = same.map_or_else(|| Arc::new(look), |last| last.look.clone());
            let showing = showing::of_body(name, view, &shape, start.fixed, simulation, context);
            let same = last.as_ref().filter(|last| *last.showing == showing);
            let showing = same.map_or_else(|| Arc::new(showing), |last| last.showing.clone());
            last = Some(Last {
                table: table.to_table(),
                shape: shape.clone(),
                look: look.clone(),
                showing: showing.clone(),
            });
            let motion = motion.map(Arc::new);
            let magnetic_moment = view.get(&body::MAGNETIC_MOMENT);
            Body {
                name: name.clone(),
                shape,
                start,
                magnetic_moment,
                presence,
                motion,
                collider,
                material,
                look,
                showing,
            }
        });
        context.once(before, name, span);
        bodies.push(body);
    }
    bodies
}

/// Returns the warning that the copies of a body follow the same path, although they start at different places. `name` is the name of a
/// copy.
fn same_path(name: &str, span: Span) -> Diagnostic {
    let group = name.split('[').next().unwrap_or(name);
    let message = format!("all copies of `{group}` follow the same path: their places have no effect");
    let help = "write the places of the motion with the index `i`, such as `location = [\"i\", 0, 0]`";
    Diagnostic::warning(Code::NoEffect, message).at(span, "it gives all copies the same place").help(help)
}

/// Reads the initial state and the mass properties of a body.
fn start(name: &str, span: Span, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> RigidBody {
    let fixed = fixed(name, view, shape, context);
    let mass = mass(name, span, view, shape, context);
    let inertia = inertia(name, view, context);
    let open = mesh::open(&view.table(&body::SHAPE).table(&shape_keys::MESH), shape);
    let weighs_as_given = inertia.is_some() && view.has(&body::MASS);
    let help = "close it, or give the body `mass` and `inertia`, or say `fixed = true`";
    let needs_solid = !fixed && !weighs_as_given;
    context.diagnostics.extend(open.filter(|_| needs_solid).map(|error| error.help(help)));
    // Moments of inertia that the scene gives refer to the body axes. Otherwise, the shape gives the principal axes.
    let principal_axes = inertia.map_or(shape.principal_axes(), |_| DQuat::IDENTITY);
    RigidBody {
        mass,
        charge: view.get(&body::CHARGE),
        inertia: inertia.unwrap_or_else(|| inertia_of_shape(name, span, shape, mass, fixed, context)),
        principal_axes,
        location: view.get(&body::LOCATION),
        orientation: orientation(name, view, context),
        velocity: view.get(&body::VELOCITY),
        angular_velocity: view.get(&body::ANGULAR_VELOCITY),
        force: view.get(&body::FORCE),
        torque: view.get(&body::TORQUE),
        fixed,
    }
}

/// Returns whether a body is fixed. Reports keys that contradict `fixed`, and warns of keys that have no effect on a fixed body or on a
/// body with a given motion.
fn fixed(name: &str, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> bool {
    let scenery = if view.table(&body::SHAPE).has(&shape_keys::HEIGHTFIELD) {
        Some(("heightfield", "it is a surface without weight", "a heightfield is always fixed"))
    } else {
        matches!(shape, Shape::Plane { .. }).then_some((
            "plane",
            "a plane is endless",
            "a plane is always fixed",
        ))
    };
    let is_said_to_move = view.has(&body::FIXED) && !view.get(&body::FIXED);
    if let Some((what, why, always)) = scenery.filter(|_| is_said_to_move) {
        let error = Diagnostic::error(Code::PlaneMoves, format!("the {what} `{name}` cannot move: {why}"));
        context.diagnostics.extend(view.span(&body::FIXED).map(|span| error.at(span, always)));
    }
    let motion = view.key_span(&body::MOTION);
    if let (Some((what, why, always)), Some(span)) = (scenery, motion) {
        let error = Diagnostic::error(Code::PlaneMoves, format!("the {what} `{name}` cannot move: {why}"));
        context.diagnostics.push(error.at(span, always));
    }
    if motion.is_some() {
        let keys = VELOCITY_KEYS.iter().map(|key| &key.spec).chain(INERTIA_AND_LOAD_KEYS);
        for key in keys.filter(|key| view.has(key)) {
            let message = format!("`{}` of `{name}` has no effect", key.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            let why = "its motion is given";
            context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, why)));
        }
    }
    let fixed = scenery.is_some() || view.get(&body::FIXED);
    if fixed {
        let why = scenery.map_or("it is fixed", |(_, _, always)| always);
        for key in VELOCITY_KEYS.into_iter().filter(|key| view.get(key) != DVec3::ZERO) {
            let error = Diagnostic::error(
                Code::FixedMoves,
                format!("`{name}` is fixed, so its `{}` must be [0, 0, 0]", key.spec.name),
            );
            context.diagnostics.extend(view.key_span(key).map(|span| error.at(span, why)));
        }
        for key in INERTIA_AND_LOAD_KEYS.into_iter().filter(|key| view.has(key)) {
            let message = format!("`{}` of `{name}` has no effect", key.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, why)));
        }
    }
    fixed
}

fn mass(name: &str, span: Span, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> f64 {
    let Some(density) = view.get(&body::DENSITY) else { return view.get(&body::MASS) };
    let Some(volume) = shape.volume() else { return 1.0 };
    let mass = density * volume;
    if mass.is_finite() && mass > 0.0 {
        return mass;
    }
    let error = Diagnostic::error(Code::ImpossibleMass, format!("the mass of `{name}` is {}", extreme(mass)));
    let label = "mass = density × volume";
    context.diagnostics.push(error.at(view.span(&body::DENSITY).unwrap_or(span), label));
    1.0
}

/// Returns the words of an error message for a computed mass or moment of inertia that has become infinite or zero.
fn extreme(number: f64) -> &'static str {
    if number > 0.0 { "larger than any number" } else { "smaller than any number" }
}

/// Computes the principal moments of inertia (kg·m²) from the shape and the mass. Reports an error if a moment is not positive and finite.
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
    // Skip a mesh without a volume: another error reports it.
    if let (Some(moment), false, Some(_)) = (wrong, fixed, shape.volume()) {
        let message = format!("the moment of inertia of `{name}` is {}", extreme(moment));
        let error = Diagnostic::error(Code::ImpossibleInertia, message);
        context.diagnostics.push(error.at(span, "its shape or its mass is too extreme"));
    }
    inertia
}

/// Reads the moments of inertia (kg·m²) from the key `inertia`. Reports moments that no distribution of mass can have.
fn inertia(name: &str, view: &View<'_>, context: &mut Context<'_>) -> Option<DVec3> {
    /// The largest relative rounding error in the triangle inequality: no moment of inertia exceeds the sum of the other two. A flat body
    /// reaches this limit.
    const RELATIVE_ROUNDING: f64 = 1e-9;
    let inertia = view.get(&body::INERTIA)?;
    let mut moments = inertia.to_array();
    moments.sort_unstable_by(f64::total_cmp);
    let [smallest, middle, largest] = moments;
    let others = smallest + middle;
    if largest > others * (1.0 + RELATIVE_ROUNDING) {
        let message = format!("no body has the moments of inertia of `{name}`");
        let label =
            format!("{} is larger than the sum of the other two, {}", figure(largest), figure(others));
        let help = "Ix + Iy ≥ Iz, and likewise for the others, holds for every distribution of mass";
        let error = Diagnostic::error(Code::ImpossibleInertia, message).help(help);
        context.diagnostics.extend(view.span(&body::INERTIA).map(|span| error.at(span, label)));
    }
    Some(inertia)
}

/// Reads the orientation of the body `name` from the key `orientation`.
pub(super) fn orientation(name: &str, view: &View<'_>, context: &mut Context<'_>) -> DQuat {
    if let Some(angles) = view.get_as::<DVec3>(&body::ORIENTATION) {
        return euler(angles);
    }
    let table = view.table(&body::ORIENTATION);
    if table.has(&orientation::EULER) {
        return euler(table.get(&orientation::EULER));
    }
    if table.has(&orientation::QUATERNION) {
        return DQuat::from_array(table.get(&orientation::QUATERNION));
    }
    together(name, &table, [&orientation::AXIS.spec, &orientation::ANGLE.spec], context);
    match (table.get(&orientation::AXIS), table.get(&orientation::ANGLE)) {
        (Some(axis), Some(angle)) => DQuat::from_axis_angle(axis, angle.to_radians()),
        _ => DQuat::IDENTITY,
    }
}

/// Reports an orientation with an `axis` but no `angle`, or with an `angle` but no `axis`.
pub(super) fn together(
    name: &str,
    table: &View<'_>,
    [axis, angle]: [&KeySpec; 2],
    context: &mut Context<'_>,
) {
    for (key, other, value) in [(axis, angle, "45"), (angle, axis, "[0, 0, 1]")] {
        if let (Some(span), false) = (table.key_span(key), table.has(other)) {
            let (key, other) = (key.name, other.name);
            let message = format!("`{key}` without `{other}` in the orientation of `{name}`");
            let error = Diagnostic::error(Code::MissingKey, message).at(span, format!("needs `{other}`"));
            let (place, text) = corrections::before(span, &format!("{other} = {value}"), context);
            context.diagnostics.push(error.fix(place, text));
        }
    }
}

/// Returns the rotation about the world's x, then y, then z axis, like POV-Ray's `rotate <x, y, z>`. The angles are in degrees.
fn euler(angles: DVec3) -> DQuat {
    let turn = |axis: DVec3, angle: f64| DQuat::from_axis_angle(axis, angle.to_radians());
    turn(DVec3::Z, angles.z) * turn(DVec3::Y, angles.y) * turn(DVec3::X, angles.x)
}

/// Returns the index in `materials` of the material that the body's own `material` table describes. Copies of a body with equal looks
/// share one material.
fn own_material(own: Material, materials: &mut Vec<Material>, context: &Context<'_>) -> usize {
    /// The number of most recent materials that are compared with the new look.
    const MAX_COMPARED_MATERIALS: usize = 16;
    if let Some(original) = context.groups.original(&own.name) {
        let of_copy = |material: &Material| context.groups.original(&material.name) == Some(original);
        let latest = materials
            .iter()
            .enumerate()
            .rev()
            .take(MAX_COMPARED_MATERIALS)
            .take_while(|(_, other)| of_copy(other));
        if let Some((number, _)) = latest.into_iter().find(|(_, other)| other.looks_like(&own)) {
            return number;
        }
    }
    materials.push(own);
    materials.len() - 1
}

/// Returns the index of the body's material in `materials`. A body without a material gets the next color of the palette.
fn material(
    name: &str,
    root: &View<'_>,
    view: &View<'_>,
    shape: &Shape,
    materials: &mut Vec<Material>,
    default_looks: &mut DefaultLooks,
    context: &mut Context<'_>,
) -> Option<usize> {
    if matches!(shape, Shape::Axes { .. }) {
        let warning = Diagnostic::warning(Code::NoEffect, "the material of axes has no effect");
        let why = "axes are red, green and blue";
        context.diagnostics.extend(view.key_span(&body::MATERIAL).map(|span| warning.at(span, why)));
        return None;
    }
    let is_plane = matches!(shape, Shape::Plane { .. });
    // Take a palette color for every body, even for one with a material. Then the other bodies keep their colors when a user gives one body
    // a material.
    let usual = default_looks.next(shape);
    if let Some(table) = view.variant(&body::MATERIAL) {
        let own = super::material::look(name, &table, root, context);
        if is_plane {
            super::material::report_of_plane(name, &table, context);
        }
        return Some(own_material(own, materials, context));
    }
    // Raw SDL has its own textures, which a material would cover.
    let has_own = view.table(&body::SHAPE).has(&shape_keys::SDL);
    let Some(material) = view.get_as::<value::Text>(&body::MATERIAL) else {
        return (!has_own).then(|| default_looks.material(usual, materials));
    };
    if is_plane
        && let Some((_, _, table)) =
            root.named(&scene::MATERIAL).into_iter().find(|(known, ..)| *known == material)
    {
        super::material::report_of_plane(name, &table, context);
    }
    let number = context.names.materials.get(material).copied();
    let number =
        number.or_else(|| Some(default_looks.of_library(LibraryMaterial::named(material)?, materials)));
    Some(number.unwrap_or_else(|| default_looks.material(usual, materials)))
}
