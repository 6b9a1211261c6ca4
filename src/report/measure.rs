//! Measures the distance between two runs of a scene, body by body.

use glam::{DQuat, DVec3};

use crate::physics::{BodySnapshot, Shape, Snapshot};
use crate::scene::Scene;

/// The bodies that are compared between runs: those that forces move.
pub(super) struct ComparedBodies {
    /// The indices of the compared bodies in the scene.
    pub(super) bodies: Vec<usize>,
    /// For each compared body, the distance of its farthest point from its center, m. It is 0 for a ball, since a ball looks the same in
    /// every orientation.
    reach: Vec<f64>,
    /// For each compared body, the radius of its bounding sphere, m.
    radius: Vec<f64>,
    mass: Vec<f64>,
    inertia: Vec<f64>,
}

/// The distance between a body in one run and the same body in another run, at the same time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Distance {
    /// The distance between the two positions of the body's center, m.
    pub(super) place: f64,
    /// The angle between the two orientations of the body, rad.
    pub(super) angle: f64,
    /// An upper bound of the distance between the two positions of any point of the body, m.
    pub(super) point: f64,
}

impl ComparedBodies {
    /// Selects the bodies of a scene that forces move, and computes their sizes, masses and moments of inertia.
    pub(super) fn of(scene: &Scene) -> ComparedBodies {
        let moves = |id: &usize| {
            let body = &scene.bodies[*id];
            !body.start.fixed && body.motion.is_none() && body.start.mass > 0.0
        };
        let bodies: Vec<usize> = (0..scene.bodies.len()).filter(moves).collect();
        let of = |get: &dyn Fn(usize) -> f64| bodies.iter().map(|&id| get(id)).collect();
        let radius: Vec<f64> = of(&|id| scene.bodies[id].shape.bounding_radius().unwrap_or_default());
        let is_ball = |id: usize| matches!(scene.bodies[id].shape, Shape::Sphere { .. });
        let reach = bodies.iter().zip(&radius).map(|(&id, r)| if is_ball(id) { 0.0 } else { *r }).collect();
        let mass = of(&|id| scene.bodies[id].start.mass);
        let inertia = of(&|id| scene.bodies[id].start.inertia.max_element());
        ComparedBodies { reach, radius, mass, inertia, bodies }
    }

    /// Returns a compared body in two snapshots. `body` is its index among the compared bodies. `None` if a snapshot lacks the body.
    pub(super) fn pair<'s>(&self, body: usize, moments: [&'s Snapshot; 2]) -> Option<[&'s BodySnapshot; 2]> {
        let id = *self.bodies.get(body)?;
        let [one, two] = moments.map(|moment| moment.body(id));
        Some([one?, two?])
    }

    /// Computes the distance between two states of a compared body. `body` is its index among the compared bodies.
    pub(super) fn distance(&self, body: usize, [one, two]: [&BodySnapshot; 2]) -> Distance {
        let place = (one.location - two.location).length();
        let angle = angle(one.orientation, two.orientation);
        Distance { place, angle, point: place + angle * self.reach[body] }
    }

    /// Returns the axis-aligned box around the compared bodies of a snapshot, as its smallest and largest corner, m. `None` if the
    /// snapshot contains none of them.
    pub(super) fn around(&self, moment: &Snapshot) -> Option<[DVec3; 2]> {
        let places = self.bodies.iter().zip(&self.radius).filter_map(|(&id, radius)| {
            let place = moment.body(id)?.location;
            Some([place - *radius, place + *radius])
        });
        places.reduce(union)
    }

    /// Returns upper bounds of the total linear (kg m/s) and angular momentum (kg m²/s): the sums of the magnitudes of all bodies'
    /// momenta.
    pub(super) fn momenta(&self, moment: &Snapshot) -> [f64; 2] {
        let (mut linear, mut angular) = (0.0, 0.0);
        for (body, &id) in self.bodies.iter().enumerate() {
            let Some(at) = moment.body(id) else { continue };
            let momentum = self.mass[body] * at.velocity;
            linear += momentum.length();
            angular +=
                at.location.cross(momentum).length() + self.inertia[body] * at.angular_velocity.length();
        }
        [linear, angular]
    }
}

/// Returns the smallest axis-aligned box around two boxes. A box is given by its smallest and its largest corner.
pub(super) fn union([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> [DVec3; 2] {
    [a.min(c), b.max(d)]
}

/// Returns the angle of the rotation from one orientation to another, rad. Tiny angles are accurate, too.
fn angle(one: DQuat, two: DQuat) -> f64 {
    let turn = one.conjugate() * two;
    2.0 * libm::atan2(turn.xyz().length(), turn.w.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tiny_turn_has_its_angle() {
        for expected in [0.0, 1e-12, 1e-3, 1.0, 3.0] {
            let found = angle(DQuat::from_rotation_x(0.3), -DQuat::from_rotation_x(0.3 + expected));
            assert!((found - expected).abs() < 1e-15 + 1e-15 * expected, "{found} {expected}");
        }
    }

    #[test]
    fn only_what_forces_move_is_compared_and_a_ball_may_turn() {
        let text = "[body.ball]\nshape.sphere.radius = 1\n[body.box]\nshape.box.size = [2, 2, 2]\n\
                    [body.rock]\nshape.sphere.radius = 1\nfixed = true\n\
                    [body.lift]\nshape.sphere.radius = 1\nmotion.formula.location = ['t', 0, 0]\n";
        let scene = Scene::parse(text).unwrap();
        let measured = ComparedBodies::of(&scene);
        assert_eq!(measured.bodies, [0, 1]);
        let one = BodySnapshot::default();
        let two = BodySnapshot { location: DVec3::X, orientation: DQuat::from_rotation_y(0.1), ..one };
        let points = [0, 1].map(|body| measured.distance(body, [&one, &two]).point);
        assert!((points[0] - 1.0).abs() < 1e-15);
        assert!((points[1] - (1.0 + 0.1 * 3.0_f64.sqrt())).abs() < 1e-15);
    }
}
