//! The weights and contact forces of bodies that arrows show.

use std::collections::BTreeMap;

use glam::DVec3;

use super::Frame;
use crate::physics::{BodySnapshot, ContactSnapshot};
use crate::scene::{Arrow, Quantity, Scene};

/// A force on a body, shown by an arrow: the body's weight, or the normal force or friction from another body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// The index of the body on which the force acts.
    pub body: usize,
    /// The kind of force: weight, normal force or friction.
    pub quantity: Quantity,
    /// The scale and the color of the arrow.
    pub arrow: Arrow,
    /// The point of action, m: the center of the body, or the center of pressure of the contact.
    pub root: DVec3,
    /// The force in world axes, N.
    pub vector: DVec3,
}

/// The contact force of one body on another, summed over their points of contact.
#[derive(Default)]
struct Touch {
    normal: DVec3,
    friction: DVec3,
    /// The sum of the points of contact, each multiplied by its normal force, m N.
    places: DVec3,
    /// The sum of the normal forces, N.
    sizes: f64,
}

/// Computes the weights and contact forces that a frame shows, in the order of bodies. If two bodies touch at several points, a single
/// arrow at the center of pressure shows their total force.
pub fn loads(scene: &Scene, frame: &Frame) -> Vec<Load> {
    loads_on(scene, &frame.bodies, &frame.contacts)
}

/// Computes the weights and contact forces that the scene shows on `bodies`. `contacts` must hold all contacts of these bodies.
pub fn loads_on(scene: &Scene, bodies: &[BodySnapshot], contacts: &[ContactSnapshot]) -> Vec<Load> {
    let asks = |id: usize| scene.bodies.get(id).is_some_and(|body| body.showing.has_loads());
    let mut touches: BTreeMap<(usize, usize), Touch> = BTreeMap::new();
    for contact in contacts {
        let [one, two] = contact.bodies;
        for (body, other, sign) in [(one, two, -1.0), (two, one, 1.0)] {
            if asks(body) {
                let touch = touches.entry((body, other)).or_default();
                let size = contact.force.length();
                touch.normal += sign * contact.force;
                touch.friction += sign * contact.friction;
                touch.places += size * contact.place;
                touch.sizes += size;
            }
        }
    }
    let mut loads = Vec::new();
    for at in bodies.iter().filter(|at| asks(at.id)) {
        let body = &scene.bodies[at.id];
        let mut add = |quantity: Quantity, arrow: Option<Arrow>, root: DVec3, vector: DVec3| {
            loads.extend(arrow.map(|arrow| Load { body: at.id, quantity, arrow, root, vector }));
        };
        let [weight, normal, friction] = body.showing.loads;
        add(Quantity::Weight, weight, at.location, body.start.mass * scene.simulation.gravity);
        for touch in touches.range((at.id, 0)..=(at.id, usize::MAX)).map(|(_, touch)| touch) {
            if touch.sizes > 0.0 {
                let place = touch.places / touch.sizes;
                add(Quantity::Normal, normal, place, touch.normal);
                add(Quantity::Friction, friction, place, touch.friction);
            }
        }
    }
    loads
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Snapshot;

    #[test]
    fn several_places_of_one_contact_make_one_arrow_at_the_centre_of_pressure() {
        let text = "simulation = { contacts = 'event-driven', gravity = [0, -10, 0] }
            [body.block]\nshape.box.size = [2, 1, 1]\nlocation = [0, 0.5, 0]\nmass = 3
            arrows = { weight = true, normal = true, friction = true }
            [body.other]\nshape.sphere.radius = 1\nlocation = [5, 5, 0]";
        let scene = Scene::parse(text).unwrap();
        let contact = |x: f64, force: f64| ContactSnapshot {
            bodies: [0, 2],
            place: DVec3::X * x,
            normal: -DVec3::Y,
            force: DVec3::NEG_Y * force,
            friction: DVec3::X,
        };
        let at = |id: usize| BodySnapshot {
            id,
            location: scene.bodies[id].start.location,
            ..BodySnapshot::default()
        };
        let (bodies, contacts) = (vec![at(0), at(1)], vec![contact(-1.0, 10.0), contact(1.0, 20.0)]);
        let frame = Frame::of(0, Snapshot { bodies, contacts, ..Snapshot::default() });
        let loads = loads(&scene, &frame);
        let found: Vec<_> = loads.iter().map(|load| (load.quantity, load.root, load.vector)).collect();
        let third = DVec3::X * (10.0 / 30.0);
        let expected = [
            (Quantity::Weight, DVec3::Y * 0.5, DVec3::Y * -30.0),
            (Quantity::Normal, third, DVec3::Y * 30.0),
            (Quantity::Friction, third, DVec3::X * -2.0),
        ];
        assert_eq!(found, expected);
    }
}
