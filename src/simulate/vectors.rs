//! The vectors that arrows show, and the points where the arrows begin.

use glam::{DQuat, DVec3};

use super::Frame;
use crate::physics::{Anchor, BodySnapshot, Shape};
use crate::scene::{Body, ForceKind, JointKind, Quantity, Scene};

/// Returns the vector of a body's velocity, acceleration or force, in world axes and SI units.
pub fn shown(quantity: Quantity, body: &Body, frame: &BodySnapshot) -> DVec3 {
    match quantity {
        Quantity::Velocity => frame.velocity,
        Quantity::Acceleration if body.start.fixed => DVec3::ZERO,
        Quantity::Acceleration => frame.force / body.start.mass,
        Quantity::Force => frame.force,
        // Only joints have torque arrows, and the arrows of weights and contact forces are computed elsewhere.
        Quantity::Torque
        | Quantity::Weight
        | Quantity::Normal
        | Quantity::Friction
        | Quantity::NamedForce => DVec3::ZERO,
    }
}

/// The distance from the center of a shape to its surface in a direction, m. The direction is a unit vector in world axes. If a ray in
/// this direction crosses several surfaces, the last one counts. 0 for a plane, and if the ray meets no surface.
pub fn surface(shape: &Shape, orientation: DQuat, direction: DVec3) -> f64 {
    shape.exit(DVec3::ZERO, orientation.conjugate() * direction).unwrap_or(0.0)
}

/// The point where a vector's arrow begins, m: on the surface of the body, so that no part of the arrow is hidden inside.
pub fn root(body: &Body, frame: &BodySnapshot, vector: DVec3) -> DVec3 {
    let along = vector.normalize_or_zero();
    frame.location + along * surface(&body.drawn(), frame.orientation, along)
}

/// The end of a joint at which the joint's arrows begin.
#[derive(Clone, Debug)]
pub struct JointEnd {
    /// The index of the joint.
    joint: usize,
    /// The second end of the joint: a fixed point, or a point on a body in its drawn scale.
    end: Anchor,
    /// The drawn shape of the body, if the end is at the body's center.
    shape: Option<Shape>,
}

impl JointEnd {
    /// Finds the end at which the arrows of a joint begin, by the index of the joint in the scene.
    pub fn new(scene: &Scene, joint: usize) -> JointEnd {
        let (end, shape) = match scene.joints[joint].kind.between()[1] {
            end @ Anchor::Point(_) => (end, None),
            end @ Anchor::Body { id, at } => {
                let body = &scene.bodies[id.index()];
                let shape = end.is_centre().then(|| body.drawn());
                (Anchor::Body { id, at: at * body.look.scale }, shape)
            }
        };
        JointEnd { joint, end, shape }
    }

    /// Returns the point where the arrow begins (m) and the vector of a quantity in SI units. If the end is the center of a body, the
    /// arrow begins at the body's surface. `None` while the body is absent.
    pub fn arrow(&self, quantity: Quantity, frame: &Frame) -> Option<(DVec3, DVec3)> {
        let reaction = frame.reactions.get(self.joint)?;
        let vector = match quantity {
            Quantity::Force => reaction.force,
            Quantity::Torque => reaction.torque,
            _ => DVec3::ZERO,
        };
        let Some(id) = self.end.body() else {
            return Some((self.end.place(|_| (DVec3::ZERO, DQuat::IDENTITY)), vector));
        };
        let body = frame.body(id.index())?;
        let along = vector.normalize_or_zero();
        let depth = self.shape.as_ref().map_or(0.0, |shape| surface(shape, body.orientation, along));
        Some((self.end.place(|_| (body.location, body.orientation)) + along * depth, vector))
    }
}

/// The drawn length of each coordinate axis of a body, m. `None` if the scene does not show its axes.
pub fn axis(body: &Body) -> Option<f64> {
    let axes = body.showing.axes?;
    let reach = |direction| body.drawn().support(DQuat::IDENTITY, direction);
    let reach = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter_map(reach).fold(0.0, f64::max);
    Some(axes.length.unwrap_or(2.0 * reach))
}

/// The fixed ends of all drawn springs, joints and marks, in world axes, m.
pub(crate) fn anchors(scene: &Scene) -> impl Iterator<Item = DVec3> {
    let links = scene.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Spring { links, look: Some(_) } => Some(links),
        _ => None,
    });
    let joints = scene.joints.iter().filter(|joint| joint.look.is_some());
    let joints = joints.flat_map(|joint| match &joint.kind {
        JointKind::Pulley(pulley) => pulley.path().to_vec(),
        kind => kind.between().to_vec(),
    });
    let angles = scene.angles.iter().map(|angle| angle.vertex);
    let distances = scene.distances.iter().flat_map(|distance| distance.between);
    let areas = scene.areas.iter().map(|area| area.center);
    let marks = angles.chain(distances).chain(areas);
    links.flatten().flat_map(|link| link.between).chain(joints).chain(marks).filter_map(|end| match end {
        Anchor::Point(point) => Some(point),
        Anchor::Body { .. } => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_are_where_they_are() {
        let beam = Shape::Box { size: DVec3::new(4.0, 0.2, 1.0) };
        let can = Shape::Cylinder { radius: 0.5, height: 2.0 };
        let slanted = DVec3::new(3.0, 4.0, 0.0) / 5.0;
        let turned = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        for (shape, orientation, direction, distance) in [
            (Shape::Sphere { radius: 2.0 }, turned, slanted, 2.0),
            (beam.clone(), DQuat::IDENTITY, slanted, 0.125),
            (beam.clone(), DQuat::IDENTITY, DVec3::X, 2.0),
            (beam, turned, DVec3::Y, 2.0),
            (can.clone(), DQuat::IDENTITY, slanted, 0.5 / 0.6),
            (can, turned, slanted, 0.5 / 0.8),
            (Shape::Plane { normal: DVec3::Y }, DQuat::IDENTITY, DVec3::Y, 0.0),
            // A ring has no material along its axis.
            (Shape::Torus { radius: 2.0, tube_radius: 0.5 }, turned, DVec3::X, 0.0),
            (Shape::Torus { radius: 2.0, tube_radius: 0.5 }, turned, DVec3::Y, 2.5),
        ] {
            let found = surface(&shape, orientation, direction);
            assert!((found - distance).abs() < 1e-9, "{shape:?} {direction}: {found}");
        }
    }
}
