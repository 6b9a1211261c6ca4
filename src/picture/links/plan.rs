//! The parts of springs and joints, and their sizes.

use glam::{DQuat, DVec3};

use super::{Form, Part, SpringSize, room_for};
use crate::dynamics::{Anchor, Hinge, Rope, Slider, Spring};
use crate::scene::{Color, ForceKind, Joint, JointKind, JointLook, Scene, SpringLine, SpringLook};
use crate::simulate::{Asked, AskedSlider, surface};

/// The usual color of springs and joints.
const STEEL: Color = Color([0.62, 0.64, 0.67]);
/// The usual color of ropes.
const HEMP: Color = Color([0.76, 0.64, 0.45]);

/// The parts of all springs and joints that are drawn.
pub(super) fn parts(scene: &Scene, asked: &Asked) -> Vec<Part> {
    let mut parts = Vec::new();
    for force in &scene.forces {
        let ForceKind::Spring { links, look: Some(look) } = &force.kind else { continue };
        links.iter().for_each(|link| spring(scene, &force.name, link, look, &mut parts));
    }
    for (number, its) in scene.joints.iter().enumerate() {
        let Some(look) = its.look else { continue };
        let travel = asked.sliders.iter().find(|slider| slider.joint == number);
        joint(scene, its, look, travel, &mut parts);
    }
    parts
}

/// The thickness of the springs that are drawn, in the order of the forces and their links.
pub(super) fn springs(scene: &Scene) -> Vec<SpringSize> {
    let forces = scene.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Spring { links, look: Some(look) } => Some((links, look)),
        _ => None,
    });
    let size = |link: &Spring, look: &SpringLook| {
        let (radius, _) = spring_size(scene, link, look);
        let is_coil = matches!(look.line, SpringLine::Coil { .. });
        SpringSize { radius, room: if is_coil { room_for(radius) } else { 0.0 }, is_coil }
    };
    forces.flat_map(|(links, look)| links.iter().map(move |link| size(link, look))).collect()
}

/// The parts of a spring: itself, and a ball at each end that is a point of the world.
fn spring(scene: &Scene, name: &str, link: &Spring, look: &SpringLook, parts: &mut Vec<Part>) {
    let (radius, free) = spring_size(scene, link, look);
    let between = link.between;
    let color = look.color.unwrap_or(STEEL);
    let part = |form: Form| Part { name: name.to_owned(), between, form, color };
    let (knob, form) = match look.line {
        SpringLine::Coil { turns } => {
            let turns = turns.unwrap_or_else(|| usual_turns(free / (1.5 * radius)));
            (0.6 * radius, Form::Coil { radius, turns })
        }
        SpringLine::Straight => (1.6 * radius, Form::Rod { between, radius }),
    };
    parts.extend(knobs(between, knob).map(part));
    parts.push(part(form));
}

/// The radius of a spring, m, and its length at rest or, failing that, between the bodies at the start, m. A coil is
/// about half as wide as the smaller body at its ends. A straight line is thinner than a rod.
fn spring_size(scene: &Scene, link: &Spring, look: &SpringLook) -> (f64, f64) {
    let [from, to] = link.between.map(|end| start(scene, end));
    let along = to - from;
    let length = link.rest_length.max(along.length());
    let towards = along.normalize_or(DVec3::Y);
    let reach = |end: Anchor, direction: DVec3| {
        let body = &scene.bodies[end.body()?.index()];
        body.drawn().support(body.start.orientation, direction)
    };
    let widest =
        |end| [DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter_map(|axis| reach(end, axis)).reduce(f64::max);
    let smallest = link.between.into_iter().filter_map(widest).fold(f64::MAX, f64::min);
    let depth = |end: Anchor| match end {
        Anchor::Body { id, .. } if end.is_centre() => {
            let body = &scene.bodies[id.index()];
            surface(&body.drawn(), body.start.orientation, towards)
        }
        _ => 0.0,
    };
    let free = length - link.between.map(depth).iter().sum::<f64>();
    let free = if free > 0.0 { free } else { length };
    let (of_body, of_length) = match look.line {
        SpringLine::Coil { .. } => (0.5, 0.12),
        SpringLine::Straight => (0.06, 1.0 / 100.0),
    };
    let radius = look.radius.unwrap_or_else(|| (of_body * smallest).min(of_length * free));
    // For bodies that coincide, with a spring of zero length.
    let radius = if radius > 0.0 { radius } else { of_body * smallest.min(1.0) };
    (radius, free)
}

/// The usual number of turns.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped before")]
fn usual_turns(usual: f64) -> u32 {
    usual.round().clamp(4.0, 24.0) as u32
}

/// The parts of a joint.
fn joint(scene: &Scene, joint: &Joint, look: JointLook, travel: Option<&AskedSlider>, parts: &mut Vec<Part>) {
    let between = joint.kind.between();
    let is_rope = matches!(joint.kind, JointKind::Rope(_) | JointKind::Pulley(_));
    let color = look.color.unwrap_or(if is_rope { HEMP } else { STEEL });
    let mut add = |form: Form| {
        // The wheels of a rope are not made of hemp.
        let color = if matches!(form, Form::Wheel { .. }) { STEEL } else { color };
        parts.push(Part { name: joint.name.clone(), between, form, color });
    };
    match &joint.kind {
        JointKind::Rod(_) => {
            let [from, to] = between.map(|end| start(scene, end));
            let radius = look.radius.unwrap_or_else(|| rod_radius(scene, between, from.distance(to)));
            knobs(between, 1.6 * radius).for_each(&mut add);
            add(Form::Rod { between, radius });
        }
        JointKind::Ball(_) | JointKind::Fixed(_) => {
            arms(scene, between, look).for_each(&mut add);
            let radius = look.radius.unwrap_or_else(|| 0.56 * thinnest(scene, between));
            add(Form::Pin { at: between[0], radius });
        }
        JointKind::Hinge(hinge) => {
            let arms: Vec<Form> = arms(scene, between, look).collect();
            arms.iter().copied().for_each(&mut add);
            add(axle(scene, hinge, look, &arms));
        }
        JointKind::Rope(Rope { length, .. }) => {
            let radius = look.radius.unwrap_or_else(|| rope_radius(scene, between, *length));
            knobs(between, 1.6 * radius).for_each(&mut add);
            add(Form::Rope { between, length: *length, radius });
        }
        JointKind::Pulley(pulley) => {
            let radius = look.radius.unwrap_or_else(|| rope_radius(scene, between, pulley.length));
            let apart = start(scene, pulley.over[0]).distance(start(scene, pulley.over[1]));
            let wheel = if apart > 0.0 { (6.0 * radius).min(0.4 * apart) } else { 6.0 * radius };
            knobs(between, 1.6 * radius).for_each(&mut add);
            for number in 0..2 {
                add(Form::Wheel { pulley: *pulley, number, wheel, half_width: 1.5 * radius });
            }
            add(Form::OverWheels { pulley: *pulley, wheel, radius });
        }
        // The wheels are bodies already.
        JointKind::Gear(_) => {}
        JointKind::Slider(slider) => rail(scene, slider, look, travel).for_each(add),
    }
}

/// A ball at each end that is a point of the world.
fn knobs(between: [Anchor; 2], radius: f64) -> impl Iterator<Item = Form> {
    between.into_iter().filter(|end| end.body().is_none()).map(move |at| Form::Pin { at, radius })
}

/// Half the thickness of the thinner of the bodies at two ends, m.
fn thinnest(scene: &Scene, between: [Anchor; 2]) -> f64 {
    let thickness = |end: Anchor| scene.bodies[end.body()?.index()].drawn().half_thickness();
    // Everything that moves has a thickness, except triangles without one.
    between.into_iter().filter_map(thickness).reduce(f64::min).unwrap_or(0.05)
}

/// The radius of a rod: a fifth of the half-thickness of the thinner body, and at most a thirtieth of its length.
fn rod_radius(scene: &Scene, between: [Anchor; 2], length: f64) -> f64 {
    (0.2 * thinnest(scene, between)).min(length / 30.0)
}

/// The radius of a rope: a tenth of the half-thickness of the thinner body, and at most a hundredth of its length.
fn rope_radius(scene: &Scene, between: [Anchor; 2], length: f64) -> f64 {
    (0.1 * thinnest(scene, between)).min(length / 100.0)
}

/// Rods from bodies to the point of a joint, if it lies outside them.
fn arms(scene: &Scene, between: [Anchor; 2], look: JointLook) -> impl Iterator<Item = Form> {
    between.into_iter().filter_map(move |end| arm(scene, end, between, look))
}

/// A rod from the centre of a body to a point outside its shape.
fn arm(scene: &Scene, end: Anchor, between: [Anchor; 2], look: JointLook) -> Option<Form> {
    let Anchor::Body { id, at } = end else { return None };
    let drawn = scene.bodies[id.index()].drawn();
    // A plane has no centre for an arm to begin in.
    drawn.half_thickness()?;
    let at = at * scene.bodies[id.index()].look.scale;
    let length = at.length();
    let is_outside = length > 1.02 * surface(&drawn, DQuat::IDENTITY, at.normalize_or_zero());
    let usual = || rod_radius(scene, between, length);
    let radius = look.radius.map_or_else(usual, |radius| 0.6 * radius);
    is_outside.then_some(Form::Rod { between: [Anchor::centre(id), end], radius })
}

/// The axle of a hinge: thicker than its arms, and a little longer than the bodies are thick.
fn axle(scene: &Scene, hinge: &Hinge, look: JointLook, arms: &[Form]) -> Form {
    let thickest = arms.iter().fold(0.0_f64, |most, arm| match arm {
        Form::Rod { radius, .. } => most.max(*radius),
        _ => most,
    });
    let usual = || (0.35 * thinnest(scene, hinge.between)).max(1.5 * thickest);
    let radius = look.radius.unwrap_or_else(usual);
    let in_world = in_world(scene, hinge.between[0], hinge.axis());
    let through = hinge.between.into_iter().filter_map(|end| {
        let Anchor::Body { id, at } = end else { return None };
        let body = &scene.bodies[id.index()];
        let axis = body.start.orientation.conjugate() * in_world;
        let (drawn, at) = (body.drawn(), at * body.look.scale);
        let ways = [axis, -axis].map(|way| drawn.exit(at, way));
        ways.into_iter().flatten().reduce(f64::max)
    });
    let half = through.reduce(f64::min).unwrap_or(0.0).min(10.0 * radius) + 2.0 * radius;
    Form::Bar { at: hinge.between[0], along: hinge.axis(), reach: [-half, half], radius }
}

/// The rail of a slider. It extends to the limits or, without limits, over the slider's travel in the run. It is
/// fastened to the world if one end is there, else to the end that moves less. If the rail misses the moving body, an
/// arm joins them.
fn rail(
    scene: &Scene,
    slider: &Slider,
    look: JointLook,
    travel: Option<&AskedSlider>,
) -> impl Iterator<Item = Form> {
    let [first, second] = slider.between;
    let is_still = |end: Anchor| end.body().is_none_or(|id| scene.bodies[id.index()].start.fixed);
    let is_turned = is_still(second) && !is_still(first);
    let (base, rider, along) = if is_turned {
        (second, first, -(slider.turned * slider.axis))
    } else {
        (first, second, slider.axis)
    };
    let travel = travel.map(|travel| [travel.least, travel.most]).filter(|[least, most]| least <= most);
    let [least, most] = slider.freedom.limits.or(travel).unwrap_or([0.0; 2]);
    let direction = in_world(scene, base, along);
    // The point of the rail nearest to the sliding body's centre, how far the rail extends beyond it, and the arm.
    let (foot, beyond, arm) = match rider {
        Anchor::Point(_) => (0.0, 0.0, None),
        Anchor::Body { id, at } => {
            let body = &scene.bodies[id.index()];
            let own = body.start.orientation.conjugate() * direction;
            let foot = -at.dot(own);
            let reach = body.drawn().support(body.start.orientation, direction).unwrap_or(0.0);
            (foot, 1.3 * reach, arm(scene, Anchor::Body { id, at: at + foot * own }, slider.between, look))
        }
    };
    let reach = [least + foot - beyond, most + foot + beyond];
    let radius = look.radius.unwrap_or_else(|| rod_radius(scene, slider.between, reach[1] - reach[0]));
    arm.into_iter().chain([Form::Bar { at: base, along, reach, radius }])
}

/// The place of an end at the start, m.
fn start(scene: &Scene, end: Anchor) -> DVec3 {
    end.place(|id| {
        let start = &scene.bodies[id.index()].start;
        (start.location, start.orientation)
    })
}

/// A direction in the axes of an end, in the world at the start.
fn in_world(scene: &Scene, end: Anchor, direction: DVec3) -> DVec3 {
    let turn = end.body().map_or(DQuat::IDENTITY, |id| scene.bodies[id.index()].start.orientation);
    turn * direction
}
