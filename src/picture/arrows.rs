//! Arrows that show vectors of bodies and joints, and the coordinate axes of bodies.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::beside;
use super::camera::Placed;
use super::in_front::lift_from_body;
use super::thing::{Form, Line, Thing};
use crate::decimal::decimal_step;
use crate::physics::{BodyId, BodySnapshot, ContactSnapshot, find};
use crate::scene::{self, ArrowOwner, Body, Color, Joint, Quantity, Scene};
use crate::simulate::{Frame, Ghost, JointEnd, Load, Measures, MomentState, axis, loads_on, root, shown};

/// The colors of arrows on light backgrounds, in the order of [`Quantity::color`]. They are easy to tell apart, and rarely used for
/// bodies.
const COLORS: [Color; Quantity::COLOR_COUNT] = [
    Color([0.03, 0.30, 0.70]),
    Color([0.93, 0.50, 0.04]),
    Color([0.76, 0.08, 0.48]),
    Color([0.05, 0.48, 0.30]),
    Color([0.20, 0.62, 0.16]),
    Color([0.85, 0.10, 0.10]),
    Color([0.96, 0.78, 0.05]),
    Color([0.0, 0.52, 0.58]),
];
/// The colors of arrows on dark backgrounds, in the order of [`Quantity::color`].
const LIGHT_COLORS: [Color; Quantity::COLOR_COUNT] = [
    Color([0.35, 0.72, 1.0]),
    Color([1.0, 0.70, 0.25]),
    Color([1.0, 0.45, 0.80]),
    Color([0.45, 0.95, 0.65]),
    Color([0.55, 0.95, 0.40]),
    Color([1.0, 0.40, 0.35]),
    Color([1.0, 0.92, 0.35]),
    Color([0.30, 0.85, 0.90]),
];

/// An arrow that shows a vector of a body, a joint or a named force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arrow {
    /// The body, joint or force that has the arrow.
    pub(super) owner: ArrowOwner,
    /// The index of the body at which the arrow begins. `None` for an arrow of a joint between fixed points.
    pub(super) body: Option<usize>,
    /// The quantity that the arrow shows.
    pub(super) quantity: Quantity,
    /// The point where the arrow begins, in world axes, m.
    pub(super) from: DVec3,
    /// The tip of the arrow, in world axes, m.
    pub(super) to: DVec3,
    /// The radius of the arrow's shaft, m.
    pub(super) radius: f64,
    /// The color of the arrow.
    pub(super) color: Color,
}

/// The length of the longest arrow without a given scale, relative to the width of the picture.
pub(super) const LONGEST: f64 = 0.13;
/// The radius of an arrow's shaft, in strokes. A stroke is the width of a clearly visible line.
const SHAFT_RADIUS: f64 = 0.6;
/// The radius of an arrow's head, relative to the radius of its shaft.
pub(super) const HEAD: f64 = 3.2;
/// The length below which an arrow is omitted, relative to the width of the picture: less than a tenth of a pixel.
const INVISIBLE_LENGTH: f64 = 5e-5;

/// The drawn length of one unit of each quantity, m, for arrows without a given scale.
pub(super) type Scales = [f64; Quantity::SCALE_COUNT];

/// The arrows and coordinate axes that a scene requests.
#[derive(Clone, Debug)]
pub(super) struct Arrows {
    /// The bodies with arrows or axes, each with its index, in the order of the scene.
    bodies: Vec<(usize, Body)>,
    /// The requested arrows of all bodies, in the order of the bodies.
    arrows: Vec<Planned>,
    /// The arrows of joints.
    of_joints: Vec<OfJoint>,
    /// The names of the joints that have arrows, by their indices.
    joint_names: BTreeMap<usize, String>,
    /// The names of the forces that have arrows, by their indices.
    force_names: BTreeMap<usize, String>,
    measures: Arc<Measures>,
    /// The scene and the colors of arrows. `None` if the scene shows no weights or contact forces.
    of_loads: Option<(Box<Scene>, [Color; Quantity::COLOR_COUNT])>,
    /// The length of the longest vector of each quantity in the run, in the unit of the quantity. Only arrows without a given scale count.
    longest: [f64; Quantity::SCALE_COUNT],
}

/// A requested arrow of a joint.
#[derive(Clone, Debug)]
struct OfJoint {
    owner: ArrowOwner,
    /// The index of the body at the second end of the joint. If that end is a fixed point, the index of the body at the first end.
    body: Option<usize>,
    end: JointEnd,
    quantity: Quantity,
    /// The drawn length of one unit of the quantity, m. `None` if the scene gives no scale.
    scale: Option<f64>,
    color: Color,
}

/// A requested arrow at a body.
#[derive(Clone, Debug)]
struct Planned {
    /// The index of the body in `Arrows::bodies`.
    of: usize,
    /// The body, or the force whose arrow is at the body.
    owner: ArrowOwner,
    quantity: Quantity,
    /// The drawn length of one unit of the quantity, m. `None` if the scene gives no scale.
    scale: Option<f64>,
    color: Color,
}

/// The sizes of arrows in the picture of one frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArrowSizes {
    /// The width in view of the camera, m.
    view: f64,
    /// The radius of an arrow's shaft, m.
    radius: f64,
    scales: Scales,
}

/// Computes the drawn length of one unit of each quantity, m, for a width in view of `view` (m). The longest vector of each quantity gets
/// the length [`LONGEST`].
fn scales(longest: [f64; Quantity::SCALE_COUNT], view: f64) -> Scales {
    longest.map(|longest| if longest > 0.0 { LONGEST * view / longest } else { 1.0 })
}

/// Computes drawn lengths as [`scales`] does, and rounds them down, so that small edits of a scene do not change them.
pub(super) fn round_scales(longest: [f64; Quantity::SCALE_COUNT], view: f64) -> Scales {
    scales(longest, view).map(round_down)
}

/// Rounds a positive number down to 1, 1.5, 2, 3, 4, 5, 6 or 8 times a power of ten. Returns 1 for 0.
pub(super) fn round_down(number: f64) -> f64 {
    let decade = decimal_step(number);
    let digits = [8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.5];
    let digit = digits.into_iter().find(|digit| digit * decade <= number * (1.0 + 1e-9));
    if decade.is_finite() && decade > 0.0 { digit.unwrap_or(1.0) * decade } else { 1.0 }
}

impl Arrow {
    /// The shaft of the arrow, from its beginning to its tip.
    pub(super) fn line(&self) -> Line {
        Line { from: self.from, to: self.to, radius: self.radius }
    }

    /// The arrow along another line.
    pub(super) fn along(&self, line: Line) -> Arrow {
        Arrow { from: line.from, to: line.to, radius: line.radius, ..*self }
    }
}

impl Arrows {
    /// Plans the arrows of a scene. `measures` are those of the scene.
    pub(super) fn new(
        scene: &Scene,
        longest: [f64; Quantity::SCALE_COUNT],
        measures: Arc<Measures>,
    ) -> Arrows {
        let of_forces: Vec<(usize, usize)> = scene.arrows_of_forces().collect();
        let shows = |(number, body): &(usize, &Body)| {
            body.showing.axes.is_some()
                || body.showing.has_arrows()
                || of_forces.binary_search_by_key(number, |(_, body)| *body).is_ok()
        };
        let bodies = scene.bodies.iter().enumerate().filter(shows);
        let bodies: Vec<(usize, Body)> = bodies.map(|(number, body)| (number, body.clone())).collect();
        let colors = if scene.environment.is_dark() { LIGHT_COLORS } else { COLORS };
        let mut arrows = Vec::new();
        for (of, (number, body)) in bodies.iter().enumerate() {
            let own = Quantity::OF_BODIES.into_iter().zip(body.showing.arrows);
            let own = own.map(|(quantity, arrow)| (ArrowOwner::Body(*number), quantity, arrow));
            let its = of_forces.iter().filter(|(_, body)| body == number).map(|(force, _)| {
                (ArrowOwner::Force(*force), Quantity::NamedForce, scene.forces[*force].arrow)
            });
            arrows.extend(own.chain(its).filter_map(|(owner, quantity, arrow)| {
                let scene::Arrow { scale, color } = arrow?;
                let color = color.unwrap_or(colors[quantity.color()]);
                Some(Planned { of, owner, quantity, scale, color })
            }));
        }
        let of_joints = scene.joints.iter().enumerate().flat_map(|(number, joint)| {
            let [first, second] = joint.kind.between().map(|end| end.body().map(BodyId::index));
            let (owner, body) = (ArrowOwner::Joint(number), second.or(first));
            Quantity::OF_JOINTS.into_iter().zip(joint.arrows).filter_map(move |(quantity, arrow)| {
                let scene::Arrow { scale, color } = arrow?;
                let color = color.unwrap_or(colors[quantity.color()]);
                Some(OfJoint { owner, body, end: JointEnd::new(scene, number), quantity, scale, color })
            })
        });
        let of_joints = of_joints.collect();
        let has_arrows = |joint: &Joint| joint.arrows.iter().any(Option::is_some);
        let named = scene.joints.iter().enumerate().filter(|(_, joint)| has_arrows(joint));
        let joint_names = named.map(|(number, joint)| (number, joint.name.clone())).collect();
        let named = of_forces.iter().map(|(force, _)| (*force, scene.forces[*force].name.clone()));
        let force_names = named.collect();
        let of_loads = scene
            .bodies
            .iter()
            .any(|body| body.showing.has_loads())
            .then(|| (Box::new(scene.clone()), colors));
        Arrows { bodies, arrows, of_joints, joint_names, force_names, measures, of_loads, longest }
    }

    /// The sizes of arrows in all pictures of a fixed camera. `scales` are the scales that its position was chosen for.
    pub(super) fn still_sizes(&self, scales: Scales, view: f64, stroke: f64) -> ArrowSizes {
        ArrowSizes { view, radius: SHAFT_RADIUS * stroke, scales }
    }

    /// The sizes of arrows in one picture of a moving camera. They change smoothly with the width in view.
    pub(super) fn sizes(&self, view: f64, stroke: f64) -> ArrowSizes {
        ArrowSizes { view, radius: SHAFT_RADIUS * stroke, scales: scales(self.longest, view) }
    }

    /// Computes the arrows of a frame as seen by a camera: first those of bodies, then those of joints.
    pub(super) fn arrows(&self, frame: &Frame, sizes: ArrowSizes, camera: &Placed) -> Vec<Arrow> {
        let of_one = self.arrows.chunk_by(|one, next| one.of == next.of);
        let of_one = of_one.filter_map(|its| Some((its, frame.body(self.bodies[its[0].of].0)?)));
        let now = MomentState::now(frame);
        let mut arrows: Vec<Arrow> =
            of_one.flat_map(|(its, at)| self.of_body(its, (at, &now), sizes, camera)).collect();
        arrows.extend(self.loads((&frame.bodies, &frame.contacts), sizes, camera));
        arrows.extend(self.of_joints.iter().filter_map(|arrow| {
            let (from, vector) = arrow.end.arrow(arrow.quantity, frame)?;
            let to = from + vector * arrow.scale.unwrap_or(sizes.scales[arrow.quantity.number()]);
            let OfJoint { owner, body, quantity, color, .. } = *arrow;
            is_seen(from, to, sizes).then_some(Arrow {
                owner,
                body,
                quantity,
                from,
                to,
                radius: sizes.radius,
                color,
            })
        }));
        arrows
    }

    /// Computes the arrows for weights and contact forces. These arrows begin inside the body or on its far side, so they are moved in
    /// front of the body.
    fn loads(
        &self,
        (bodies, contacts): (&[BodySnapshot], &[ContactSnapshot]),
        sizes: ArrowSizes,
        camera: &Placed,
    ) -> Vec<Arrow> {
        let Some((scene, colors)) = &self.of_loads else { return Vec::new() };
        let arrow = |load: &Load| {
            let Load { body, quantity, root: from, vector, .. } = *load;
            let to = from + vector * load.arrow.scale.unwrap_or(sizes.scales[quantity.number()]);
            let color = load.arrow.color.unwrap_or(colors[quantity.color()]);
            let mut arrow = Arrow {
                owner: ArrowOwner::Body(body),
                body: Some(body),
                quantity,
                from,
                to,
                radius: sizes.radius,
                color,
            };
            let seen = is_seen(from, to, sizes);
            lift_from_body(&mut arrow, &scene.bodies[body], find(bodies, body)?, camera);
            seen.then_some(arrow)
        };
        loads_on(scene, bodies, contacts).iter().filter_map(arrow).collect()
    }

    /// The arrow as a thing to draw.
    pub(super) fn thing(&self, arrow: &Arrow) -> Thing<'static> {
        let Arrow { from, to, radius, color, .. } = *arrow;
        let owner = match arrow.owner {
            ArrowOwner::Body(body) => self.body(body).map(|body| &*body.name),
            ArrowOwner::Joint(joint) => self.joint_names.get(&joint).map(String::as_str),
            ArrowOwner::Force(force) => self.force_names.get(&force).map(String::as_str),
        };
        let name = format!("{}, {}", owner.unwrap_or_default(), arrow.quantity.name());
        Thing { name: name.into(), form: Form::Arrow { from, to, radius }, color }
    }

    /// The coordinate axes that are drawn in a frame, each with the index of its body.
    pub(super) fn axes(&self, frame: &Frame) -> Vec<(usize, Thing<'static>)> {
        let axes = |(number, body): &(usize, Body)| {
            let (length, at) = (axis(body)?, frame.body(*number)?);
            let form = Form::Axes { location: at.location, orientation: at.orientation, length };
            Some((*number, Thing { name: format!("{}, axes", body.name).into(), form, color: Color::WHITE }))
        };
        self.bodies.iter().filter_map(axes).collect()
    }

    /// The measures of the scene.
    pub(super) fn measures(&self) -> &Measures {
        &self.measures
    }

    /// The body with an index in the scene, if it has arrows or axes.
    fn body(&self, number: usize) -> Option<&Body> {
        let of = self.bodies.binary_search_by_key(&number, |(number, _)| *number).ok()?;
        Some(&self.bodies[of].1)
    }

    /// Computes the arrows of a ghost as seen by a camera. Empty if the ghosts of its body have no arrows.
    pub(super) fn of_ghost(&self, ghost: &Ghost, sizes: ArrowSizes, camera: &Placed) -> Vec<Arrow> {
        let Ghost { body: at, contacts, .. } = ghost;
        let Ok(of) = self.bodies.binary_search_by_key(&at.id, |(number, _)| *number) else {
            return Vec::new();
        };
        if !self.bodies[of].1.showing.ghosts.is_some_and(|ghosts| ghosts.arrows) {
            return Vec::new();
        }
        let [first, end] = [of, of + 1].map(|of| self.arrows.partition_point(|arrow| arrow.of < of));
        let then = MomentState::then(ghost);
        let mut arrows = self.of_body(&self.arrows[first..end], (at, &then), sizes, camera);
        arrows.extend(self.loads((&[*at], contacts), sizes, camera));
        arrows
    }

    /// Computes the arrows of one body at a moment. Arrows in nearly the same direction are placed side by side.
    fn of_body(
        &self,
        its: &[Planned],
        (at, moment): (&BodySnapshot, &MomentState<'_>),
        sizes: ArrowSizes,
        camera: &Placed,
    ) -> Vec<Arrow> {
        let arrow = |arrow| self.arrow(arrow, (at, moment), sizes);
        let mut arrows: Vec<Arrow> = its.iter().filter_map(arrow).collect();
        if arrows.len() > 1 {
            beside::apart(&mut arrows, &self.bodies[its[0].of].1, at, camera);
        }
        arrows
    }

    fn arrow(
        &self,
        arrow: &Planned,
        (at, moment): (&BodySnapshot, &MomentState<'_>),
        sizes: ArrowSizes,
    ) -> Option<Arrow> {
        let (number, body) = &self.bodies[arrow.of];
        let vector = match arrow.owner {
            ArrowOwner::Force(force) => self.measures.force_on(*number, force, moment)?,
            ArrowOwner::Body(_) | ArrowOwner::Joint(_) => shown(arrow.quantity, body, at),
        };
        let from = root(body, at, vector);
        let Planned { owner, quantity, scale, color, .. } = *arrow;
        let to = from + vector * scale.unwrap_or(sizes.scales[quantity.number()]);
        is_seen(from, to, sizes).then_some(Arrow {
            owner,
            body: Some(*number),
            quantity,
            from,
            to,
            radius: sizes.radius,
            color,
        })
    }
}

/// True if an arrow is finite and long enough to be drawn.
fn is_seen(from: DVec3, to: DVec3, sizes: ArrowSizes) -> bool {
    to.is_finite() && from.distance(to) > INVISIBLE_LENGTH * sizes.view
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        for (number, round) in [(0.37, 0.3), (0.5, 0.5), (7.0, 6.0), (1.0, 1.0), (1.9e-9, 1.5e-9), (0.0, 1.0)]
        {
            assert!((round_down(number) / round - 1.0).abs() < 1e-12, "{number}");
        }
    }
}
