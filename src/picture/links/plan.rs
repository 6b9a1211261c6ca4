//! Plans the parts of springs and joints, and their sizes.

use glam::{DQuat, DVec3};

use super::{LinkPart, PlannedShape, SpringSize, room_for};
use crate::physics::{Anchor, Hinge, Rope, Slider, Spring};
use crate::scene::{Color, ForceKind, Joint, JointKind, JointLook, Scene, SpringLine, SpringLook};
use crate::simulate::{RequestedSizes, RequestedSlider, surface, touch_at_start};

/// The default color of springs and joints.
const STEEL: Color = Color([0.62, 0.64, 0.67]);
/// The default color of ropes.
const HEMP: Color = Color([0.76, 0.64, 0.45]);

/// Plans the parts of all drawn springs and joints.
pub(super) fn parts(scene: &Scene, sizes: &RequestedSizes) -> Vec<LinkPart> {
    let mut parts = Vec::new();
    for force in &scene.forces {
        let ForceKind::Spring { links, look: Some(look) } = &force.kind else { continue };
        links.iter().for_each(|link| spring(scene, &force.name, link, look, &mut parts));
    }
    for (number, its) in scene.joints.iter().enumerate() {
        let Some(look) = its.look else { continue };
        let travel = sizes.sliders.iter().find(|slider| slider.joint == number);
        joint(scene, (number, its), look, travel, &mut parts);
    }
    parts
}

/// Computes the thickness of the drawn springs, in the order of the forces. A spring force may have several springs.
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

/// Adds the parts of a spring: the coil or line, and a ball at each end that is a fixed point.
fn spring(scene: &Scene, name: &str, link: &Spring, look: &SpringLook, parts: &mut Vec<LinkPart>) {
    let (radius, free) = spring_size(scene, link, look);
    let between = link.between;
    let color = look.color.unwrap_or(STEEL);
    let part = |form: PlannedShape| LinkPart { name: name.to_owned(), between, form, color };
    let (knob, form) = match look.line {
        SpringLine::Coil { turns } => {
            let turns = turns.unwrap_or_else(|| usual_turns(free / (1.5 * radius)));
            (0.6 * radius, PlannedShape::Coil { radius, turns })
        }
        SpringLine::Straight => (1.6 * radius, PlannedShape::Rod { between, radius }),
    };
    parts.extend(knobs(between, knob).map(part));
    parts.push(part(form));
}

/// Computes the radius of a spring, m, and the length of its visible part at rest, m: the rest length or the initial length, whichever is
/// larger, without the parts inside bodies. By default, the radius of a coil is at most half the half-width of the smaller body at its
/// ends; a straight line is much thinner.
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
    // The length is 0 if the bodies coincide and the spring has no rest length.
    let radius = if radius > 0.0 { radius } else { of_body * smallest.min(1.0) };
    (radius, free)
}

/// Rounds the default number of turns to a number from 4 to 24.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped before")]
fn usual_turns(usual: f64) -> u32 {
    usual.round().clamp(4.0, 24.0) as u32
}

/// Adds the parts of a joint. `travel` is the range over which a slider moves in the run.
fn joint(
    scene: &Scene,
    (number, joint): (usize, &Joint),
    look: JointLook,
    travel: Option<&RequestedSlider>,
    parts: &mut Vec<LinkPart>,
) {
    let between = joint.kind.between();
    let is_rope = matches!(joint.kind, JointKind::Rope(_) | JointKind::Pulley(_));
    let color = look.color.unwrap_or(if is_rope { HEMP } else { STEEL });
    let mut add = |form: PlannedShape| {
        // The wheels of a pulley have another color than its rope.
        let color = if matches!(form, PlannedShape::Wheel { .. }) { STEEL } else { color };
        parts.push(LinkPart { name: joint.name.clone(), between, form, color });
    };
    match &joint.kind {
        JointKind::Rod(_) => {
            let [from, to] = between.map(|end| start(scene, end));
            let radius = look.radius.unwrap_or_else(|| rod_radius(scene, between, from.distance(to)));
            knobs(between, 1.6 * radius).for_each(&mut add);
            add(PlannedShape::Rod { between, radius });
        }
        JointKind::Ball(_) | JointKind::Fixed(_) => {
            let arms: Vec<PlannedShape> = arms(scene, between, look).collect();
            // Bodies that touch are joined where they touch, and need no rods, unless the scene asks for them.
            let is_usual = look == JointLook { radius: None, color: None };
            if is_usual && matches!(joint.kind, JointKind::Fixed(_)) && touch(scene, between) {
                if arms.len() == 2 {
                    // The point of the joint is outside of both bodies.
                    return;
                }
            } else {
                arms.into_iter().for_each(&mut add);
            }
            let radius = look.radius.unwrap_or_else(|| 0.56 * thinnest(scene, between));
            add(PlannedShape::Pin { at: between[0], radius });
        }
        JointKind::Hinge(hinge) => {
            let arms: Vec<PlannedShape> = arms(scene, between, look).collect();
            arms.iter().copied().for_each(&mut add);
            add(axle(scene, hinge, look, &arms));
        }
        JointKind::Rope(Rope { length, .. }) => {
            let radius = look.radius.unwrap_or_else(|| rope_radius(scene, between, *length));
            knobs(between, 1.6 * radius).for_each(&mut add);
            add(PlannedShape::Rope { between, length: *length, radius });
        }
        JointKind::Pulley(pulley) => {
            let radius = look.radius.unwrap_or_else(|| rope_radius(scene, between, pulley.length));
            let [_, over @ .., _] = pulley.path() else { return };
            let apart = over.windows(2).map(|pair| start(scene, pair[0]).distance(start(scene, pair[1])));
            let wheel =
                apart.filter(|apart| *apart > 0.0).fold(6.0 * radius, |wheel, apart| wheel.min(0.4 * apart));
            knobs(between, 1.6 * radius).for_each(&mut add);
            for wheel_number in 0..over.len() {
                let half_width = 1.5 * radius;
                add(PlannedShape::Wheel { joint: number, number: wheel_number, wheel, half_width });
            }
            add(PlannedShape::OverWheels { joint: number, wheel, radius });
        }
        // The wheels of a gear are drawn as bodies.
        JointKind::Gear(_) => {}
        JointKind::Slider(slider) => rail(scene, slider, look, travel).for_each(add),
    }
}

/// Returns a ball for each end of a joint that is a fixed point.
fn knobs(between: [Anchor; 2], radius: f64) -> impl Iterator<Item = PlannedShape> {
    between.into_iter().filter(|end| end.body().is_none()).map(move |at| PlannedShape::Pin { at, radius })
}

/// Half the thickness of the thinner of the two bodies that a joint or spring connects, m.
fn thinnest(scene: &Scene, between: [Anchor; 2]) -> f64 {
    let thickness = |end: Anchor| scene.bodies[end.body()?.index()].drawn().half_thickness();
    // All bodies that move have a thickness, except flat meshes.
    between.into_iter().filter_map(thickness).reduce(f64::min).unwrap_or(0.05)
}

/// The default radius of a rod, m: a fifth of the half-thickness of the thinner body, but at most a thirtieth of the rod's length.
fn rod_radius(scene: &Scene, between: [Anchor; 2], length: f64) -> f64 {
    (0.2 * thinnest(scene, between)).min(length / 30.0)
}

/// The default radius of a rope, m: a tenth of the half-thickness of the thinner body, but at most a hundredth of the rope's length.
fn rope_radius(scene: &Scene, between: [Anchor; 2], length: f64) -> f64 {
    (0.1 * thinnest(scene, between)).min(length / 100.0)
}

/// Returns true if the two bodies of a joint touch or overlap at the start.
fn touch(scene: &Scene, between: [Anchor; 2]) -> bool {
    match between.map(|end| end.body().map(|id| &scene.bodies[id.index()])) {
        [Some(one), Some(other)] => touch_at_start(one, other),
        _ => false,
    }
}

/// Rods from the centers of bodies to the point of a joint, for each body that does not contain this point.
fn arms(scene: &Scene, between: [Anchor; 2], look: JointLook) -> impl Iterator<Item = PlannedShape> {
    between.into_iter().filter_map(move |end| arm(scene, end, between, look))
}

/// A rod from the center of a body to a point. `None` if the point is inside the body's shape.
fn arm(scene: &Scene, end: Anchor, between: [Anchor; 2], look: JointLook) -> Option<PlannedShape> {
    let Anchor::Body { id, at } = end else { return None };
    let drawn = scene.bodies[id.index()].drawn();
    // A plane has no center from which a rod could start.
    drawn.half_thickness()?;
    let at = at * scene.bodies[id.index()].look.scale;
    let length = at.length();
    let is_outside = length > 1.02 * surface(&drawn, DQuat::IDENTITY, at.normalize_or_zero());
    let usual = || rod_radius(scene, between, length);
    let radius = look.radius.map_or_else(usual, |radius| 0.6 * radius);
    is_outside.then_some(PlannedShape::Rod { between: [Anchor::centre(id), end], radius })
}

/// The axle of a hinge. It is thicker than the rods to the bodies, and a little longer than the bodies are thick.
fn axle(scene: &Scene, hinge: &Hinge, look: JointLook, arms: &[PlannedShape]) -> PlannedShape {
    let thickest = arms.iter().fold(0.0_f64, |most, arm| match arm {
        PlannedShape::Rod { radius, .. } => most.max(*radius),
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
    PlannedShape::Bar { at: hinge.between[0], along: hinge.axis(), reach: [-half, half], radius }
}

/// The rail of a slider. It extends over the limits of the slider or, without limits, over its travel in the run. It is fastened to a
/// fixed end if there is one. If this end is a body, the rail starts at it. A rod connects the rail to each body that it does not reach.
fn rail(
    scene: &Scene,
    slider: &Slider,
    look: JointLook,
    travel: Option<&RequestedSlider>,
) -> impl Iterator<Item = PlannedShape> {
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
    // `foot` is the position on the rail that is nearest to the center of the sliding body, `beyond` the additional length of the rail at
    // both ends, and `rod` connects rail and body.
    let (foot, beyond, rod) = match rider {
        Anchor::Point(_) => (0.0, 0.0, None),
        Anchor::Body { id, at } => {
            let body = &scene.bodies[id.index()];
            let own = body.start.orientation.conjugate() * direction;
            let foot = -at.dot(own);
            let reach = body.drawn().support(body.start.orientation, direction).unwrap_or(0.0);
            (foot, 1.3 * reach, arm(scene, Anchor::Body { id, at: at + foot * own }, slider.between, look))
        }
    };
    let (reach, strut) = fastened(scene, slider, base, along, [least + foot - beyond, most + foot + beyond]);
    let radius = look.radius.unwrap_or_else(|| rod_radius(scene, slider.between, reach[1] - reach[0]));
    let strut = strut.and_then(|end| arm(scene, end, slider.between, look));
    rod.into_iter().chain(strut).chain([PlannedShape::Bar { at: base, along, reach, radius }])
}

/// Extends a rail to the surface of the body that it is fastened to, if the line of the rail passes through this body. `reach` holds the
/// positions of the rail's two ends along its direction `along`, relative to the anchor `base`. Otherwise, also returns the point of the
/// rail that is nearest to the center of the body, unless the two bodies of the slider touch.
fn fastened(
    scene: &Scene,
    slider: &Slider,
    base: Anchor,
    along: DVec3,
    [low, high]: [f64; 2],
) -> ([f64; 2], Option<Anchor>) {
    let Anchor::Body { id, at } = base else { return ([low, high], None) };
    let body = &scene.bodies[id.index()];
    match body.drawn().through(at * body.look.scale, along) {
        Some([begin, end]) => {
            // The rail ends slightly below the surface, so that there is no gap where the surface is curved.
            let depth = 0.05 * (end - begin);
            ([low.min(end - depth), high.max(begin + depth)], None)
        }
        None => {
            let nearest = (-at.dot(along)).clamp(low, high);
            let strut = Anchor::Body { id, at: at + nearest * along };
            ([low, high], Some(strut).filter(|_| !touch(scene, slider.between)))
        }
    }
}

/// The initial position of an anchor, m.
fn start(scene: &Scene, end: Anchor) -> DVec3 {
    end.place(|id| {
        let start = &scene.bodies[id.index()].start;
        (start.location, start.orientation)
    })
}

/// Rotates a direction from the axes of an anchor's body to world axes, at the start of the run.
fn in_world(scene: &Scene, end: Anchor, direction: DVec3) -> DVec3 {
    let turn = end.body().map_or(DQuat::IDENTITY, |id| scene.bodies[id.index()].start.orientation);
    turn * direction
}
