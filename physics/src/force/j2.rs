//! The gravity of the equatorial bulge of an oblate planet.

use glam::DVec3;

use super::super::BodyId;
use super::{Force, Loads, Moment, share};

/// The gravity of the equatorial bulge of an oblate planet, acting on some bodies. Its potential is
///
/// U = G M m J₂ R² (3 (d·a)²/r² − 1) / (2 r³), with d from the planet to the body, r its length, and a the planet's axis.
///
/// This potential excludes the attraction −G M m/r of a round planet, which is [`Gravitation`](super::Gravitation). The planet feels the
/// opposite force, and a torque that conserves the total angular momentum of planet and body. Source: D. Brouwer & G. M. Clemence,
/// *Methods of Celestial Mechanics*, ch. III.
#[derive(Debug, Clone, PartialEq)]
pub struct J2 {
    /// The oblate planet whose bulge attracts the bodies.
    pub planet: BodyId,
    /// The bodies that feel the bulge's gravity and act back on the planet. The planet itself is not in the list.
    pub bodies: Vec<BodyId>,
    /// The dimensionless coefficient J₂; positive for an oblate planet.
    pub j2: f64,
    /// The equatorial radius R of the planet that the coefficient J₂ refers to, m.
    pub radius: f64,
    /// The rotation axis of the planet, body axes, a unit vector.
    pub axis: DVec3,
    /// The gravitational constant G, m³/(kg s²).
    pub constant: f64,
}

impl J2 {
    /// If the planet is present, calls `see` for each present body with its index, the vector from the planet to the body (m), the
    /// planet's axis (world axes), and the factor 3/2 G M m J₂ R².
    fn each(&self, moment: &Moment, mut see: impl FnMut(usize, DVec3, DVec3, f64)) {
        let (model, state, planet) = (moment.model, moment.state, self.planet.index());
        if !model.is_present(planet) {
            return;
        }
        let axis = model.world_from_body(planet, state) * self.axis;
        let bulge = 1.5 * self.constant * model.mass()[planet] * self.j2 * self.radius * self.radius;
        for body in model.present(&self.bodies).iter() {
            let i = body.index();
            if model.movable()[i] || model.movable()[planet] {
                see(i, state.location[i] - state.location[planet], axis, bulge * model.mass()[i]);
            }
        }
    }
}

impl Force for J2 {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let planet = self.planet.index();
        self.each(moment, |i, d, axis, strength| {
            let (square, height) = (d.length_squared(), d.dot(axis));
            let fifth = strength / (square * square * square.sqrt());
            let force = -fifth * (2.0 * height * axis + (1.0 - 5.0 * height * height / square) * d);
            loads.force[i] += force;
            loads.force[planet] -= force;
            loads.torque[planet] -= d.cross(force);
        });
    }

    fn potential(&self, moment: &Moment) -> f64 {
        let mut sum = 0.0;
        self.each(moment, |_, d, axis, strength| sum += energy(d, axis, strength));
        sum
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        self.each(moment, |i, d, axis, strength| {
            share(energy(d, axis, strength), [i, self.planet.index()], moment, shares);
        });
    }

    fn depends_on_motion(&self) -> bool {
        false
    }
}

/// Returns the energy of a body at `d` (m) from the planet, J, for the strength that [`J2::each`] gives.
fn energy(d: DVec3, axis: DVec3, strength: f64) -> f64 {
    let (square, height) = (d.length_squared(), d.dot(axis));
    strength * (height * height / square - 1.0 / 3.0) / (square * square.sqrt())
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    fn planet() -> J2 {
        let bodies = vec![BodyId::new(1), BodyId::new(2)];
        J2 { planet: BodyId::new(0), bodies, j2: 0.3, radius: 0.8, axis: DVec3::Y, constant: 2.0 }
    }

    /// Above the equator, the bulge increases the attraction G M m/r² by the fraction 3/2 J₂ (R/r)². Above a pole, it decreases the
    /// attraction by twice that fraction.
    #[test]
    fn at_the_equator_and_at_a_pole() {
        let (model, state) = bodies(&[
            (DVec3::ZERO, DVec3::ZERO),
            (2.0 * DVec3::X, DVec3::ZERO),
            (-2.0 * DVec3::Y, DVec3::ZERO),
        ]);
        let force = loads(&planet(), &model, &state).force;
        let part = 1.5 * 0.3 * 0.16;
        // The attraction G M m/r² of a round planet is 2 · 1 · 2/4 on the first body and 2 · 1 · 3/4 on the second.
        assert!(force[1].abs_diff_eq(-part * DVec3::X, 1e-15), "{force:?}");
        assert!(force[2].abs_diff_eq(-2.0 * part * 1.5 * DVec3::Y, 1e-15), "{force:?}");
    }

    #[test]
    fn force_and_torque_are_minus_the_gradient_and_momentum_is_kept() {
        const H: f64 = 1e-5;
        let located =
            [(0.1, 0.2), (1.5, 0.8), (-0.7, 1.4)].map(|(x, y)| (DVec3::new(x, y, x - y), DVec3::ZERO));
        let (model, mut state) = bodies(&located);
        state.orientation[0] = DQuat::from_rotation_x(0.4) * DQuat::from_rotation_z(0.7);
        let force = planet();
        assert_minus_gradient(&force, &model, &state);
        let loads = loads(&force, &model, &state);
        let push: DVec3 = loads.force.iter().sum();
        let turn: DVec3 = loads.force.iter().zip(&state.location).map(|(force, at)| at.cross(*force)).sum();
        assert!(push.length() < 1e-15 && (turn + loads.torque[0]).length() < 1e-15);
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let potential = |angle: f64| {
                let mut state = state.clone();
                state.orientation[0] = DQuat::from_axis_angle(axis, angle) * state.orientation[0];
                force.potential(&Moment { time: 0.0, state: &state, model: &model })
            };
            let expected = (potential(-H) - potential(H)) / (2.0 * H);
            assert!((loads.torque[0].dot(axis) - expected).abs() < 2e-8, "{axis}: {expected}");
        }
    }
}
