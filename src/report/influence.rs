//! Finds out from a scene whether something outside of the moving bodies changes their total momentum.

use glam::DVec3;

use crate::physics::{Anchor, BodyId, Spring};
use crate::scene::{ForceKind, JointKind, Scene};

/// Whether influences from outside change the total momentum of the bodies that forces move: gravity, other bodies, points of the world,
/// fields, and bodies that come and go.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct OutsideInfluence {
    /// True if the total linear momentum changes.
    pub(super) linear: bool,
    /// True if the total angular momentum about the origin changes.
    pub(super) angular: bool,
}

impl OutsideInfluence {
    const NONE: OutsideInfluence = OutsideInfluence { linear: false, angular: false };
    const BOTH: OutsideInfluence = OutsideInfluence { linear: true, angular: true };

    /// Finds the influences in a scene.
    pub(super) fn of(scene: &Scene) -> OutsideInfluence {
        let forces = scene.forces.iter().map(|force| of_force(scene, &force.kind));
        let joints = scene.joints.iter().map(|joint| of_joint(scene, &joint.kind));
        let field = when(scene.simulation.gravity != DVec3::ZERO, OutsideInfluence::BOTH);
        [field, of_bodies(scene), of_contacts(scene)]
            .into_iter()
            .chain(forces)
            .chain(joints)
            .fold(OutsideInfluence::NONE, OutsideInfluence::or)
    }

    fn or(self, other: OutsideInfluence) -> OutsideInfluence {
        OutsideInfluence { linear: self.linear || other.linear, angular: self.angular || other.angular }
    }

    fn torque(is_present: bool) -> OutsideInfluence {
        OutsideInfluence { linear: false, angular: is_present }
    }
}

fn when(acts: bool, influence: OutsideInfluence) -> OutsideInfluence {
    if acts { influence } else { OutsideInfluence::NONE }
}

/// Returns true if forces move the body.
fn is_moved(scene: &Scene, id: BodyId) -> bool {
    let body = &scene.bodies[id.index()];
    !body.start.fixed && body.motion.is_none() && body.start.mass > 0.0
}

/// The influence of the moved bodies' own `force` and `torque`, and of moved bodies that come and go.
fn of_bodies(scene: &Scene) -> OutsideInfluence {
    let moved = (0..scene.bodies.len()).map(BodyId::new).filter(|id| is_moved(scene, *id));
    let influences = moved.map(|id| {
        let body = &scene.bodies[id.index()];
        let acts = body.start.force != DVec3::ZERO || !body.presence.is_always();
        when(acts, OutsideInfluence::BOTH).or(OutsideInfluence::torque(body.start.torque != DVec3::ZERO))
    });
    influences.fold(OutsideInfluence::NONE, OutsideInfluence::or)
}

/// The influence of contacts with the ground, and with bodies that no force moves.
fn of_contacts(scene: &Scene) -> OutsideInfluence {
    let stops = |(id, body): (usize, &crate::scene::Body)| {
        body.collider.is_some() && !is_moved(scene, BodyId::new(id))
    };
    let stopped = scene.ground_that_stops().is_some() || scene.bodies.iter().enumerate().any(stops);
    when(scene.simulation.contacts.is_some() && stopped, OutsideInfluence::BOTH)
}

fn of_force(scene: &Scene, force: &ForceKind) -> OutsideInfluence {
    let acts = |bodies: &[BodyId]| bodies.iter().any(|id| is_moved(scene, *id));
    match force {
        ForceKind::OnEach(force) => {
            let [linear, angular] = force.changes_momenta();
            when(acts(force.bodies()), OutsideInfluence { linear, angular })
        }
        ForceKind::Formula { bodies, .. } => when(acts(bodies), OutsideInfluence::BOTH),
        ForceKind::Buoyancy { liquid, .. } => {
            when(liquid.bodies.iter().any(|(id, _)| is_moved(scene, *id)), OutsideInfluence::BOTH)
        }
        ForceKind::Between(_) => force
            .bodies()
            .into_iter()
            .map(|id| of_central(scene, Anchor::centre(id)))
            .fold(OutsideInfluence::NONE, OutsideInfluence::or),
        ForceKind::Dipoles(dipoles) => {
            let bodies = dipoles.bodies.iter().chain(dipoles.against.iter().flatten());
            let held = bodies.copied().any(|id| !is_moved(scene, id));
            when(held, OutsideInfluence::BOTH).or(OutsideInfluence::torque(dipoles.field != DVec3::ZERO))
        }
        ForceKind::J2(j2) => {
            let held = [j2.planet].iter().chain(&j2.bodies).any(|id| !is_moved(scene, *id));
            when(held, OutsideInfluence::BOTH)
        }
        ForceKind::Spring { links, .. } => {
            let ends = links.iter().flat_map(|Spring { between, .. }| between);
            ends.map(|end| of_central(scene, *end)).fold(OutsideInfluence::NONE, OutsideInfluence::or)
        }
    }
}

fn of_joint(scene: &Scene, joint: &JointKind) -> OutsideInfluence {
    let is_held = |end: &Anchor| end.body().is_none_or(|id| !is_moved(scene, id));
    match joint {
        JointKind::Ball(_) | JointKind::Rod(_) | JointKind::Rope(_) => {
            let [one, other] = joint.between().map(|end| of_central(scene, end));
            one.or(other)
        }
        JointKind::Hinge(_) | JointKind::Slider(_) | JointKind::Fixed(_) => {
            when(joint.between().iter().any(is_held), OutsideInfluence::BOTH)
        }
        JointKind::Pulley(pulley) => when(pulley.path().iter().any(is_held), OutsideInfluence::BOTH),
        JointKind::Gear(gear) => {
            let ends = gear.joints.iter().flat_map(|joint| joint.between);
            when(ends.into_iter().any(|end| is_held(&end)), OutsideInfluence::BOTH)
        }
    }
}

/// The influence of an end at which a force without a torque acts. An end on a moved body has none, because the other end gets the
/// opposite force. An end that stays at the origin has no lever arm about it.
fn of_central(scene: &Scene, end: Anchor) -> OutsideInfluence {
    if end.body().is_some_and(|id| is_moved(scene, id)) {
        return OutsideInfluence::NONE;
    }
    let stays = end.body().is_none_or(|id| scene.bodies[id.index()].start.fixed);
    let place = end.place(|id| {
        let start = &scene.bodies[id.index()].start;
        (start.location, start.orientation)
    });
    OutsideInfluence { linear: true, angular: !(stays && place == DVec3::ZERO) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> [bool; 2] {
        let OutsideInfluence { linear, angular } = OutsideInfluence::of(&Scene::parse(text).unwrap());
        [linear, angular]
    }

    #[test]
    fn only_influences_from_outside_change_the_momentum() {
        let balls = "[body.a]\nshape.sphere.radius = 0.1\n[body.b]\nshape.sphere.radius = 0.1\nlocation = [1, 0, 0]\n";
        let wall = "[body.wall]\nshape.box.size = [1, 1, 1]\nlocation = [5, 0, 0]\nfixed = true\n";
        let spring = |ends: &str| format!("[force.s.spring]\nbetween = {ends}\nstiffness = 4\n");
        for (more, expected) in [
            ("", [false, false]),
            (wall, [false, false]),
            ("simulation.gravity = [0, -9.81, 0]\n", [true, true]),
            (
                "simulation = { contacts = 'event-driven', integrator = 'rk4' }\nenvironment.ground = false\n",
                [false, false],
            ),
            (
                "simulation = { contacts = 'event-driven', integrator = 'rk4' }\nenvironment.ground = { height = -3, friction = 0 }\n",
                [true, true],
            ),
            (&spring("['a', 'b']"), [false, false]),
            (&spring("[[0, 0, 0], 'b']"), [true, false]),
            (&spring("[[0, 2, 0], 'b']"), [true, true]),
            (&(wall.to_owned() + "[force.g.gravitation]\nconstant = 1\n"), [true, true]),
            ("[force.g.gravitation]\nconstant = 1\n", [false, false]),
            ("[force.d.drag]\nlinear = 1\n", [true, true]),
            ("[joint.j.rod]\nbetween = ['a', 'b']\n", [false, false]),
            ("[joint.j.rod]\nbetween = [[0, 0, 0], 'b']\n", [true, false]),
            ("[joint.j.hinge]\nbetween = [[1, 0, 0], 'b']\naxis = [0, 0, 1]\n", [true, true]),
        ] {
            let text = if more.starts_with("simulation") {
                more.to_owned() + balls
            } else {
                balls.to_owned() + more
            };
            assert_eq!(of(&text), expected, "{more}");
        }
    }
}
