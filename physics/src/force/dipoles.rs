//! Forces between magnets that are small compared to the distances between them.

use glam::DVec3;

use super::super::{BodyId, BodySnapshot, find};
use super::pairs;
use super::{Force, Loads, Moment, share};

/// Magnetic dipoles that rotate with their bodies, in the fields of each other and in a uniform field.
///
/// At a distance d = r n, the field of a dipole m is B = k (3 (m·n) n − m)/r³ with k = μ₀/4π. In this field, another dipole m has the
/// energy −m·B. With d from the second dipole to the first, the force and the torque on the first dipole are
///
/// F = 3k/r⁴ ((m₁·n) m₂ + (m₂·n) m₁ + (m₁·m₂) n − 5 (m₁·n)(m₂·n) n), τ = m₁ × B.
///
/// The torques on both dipoles and the couple d × F add up to zero. In the uniform field B₀, each dipole has the energy −m·B₀. Source: J.
/// D. Jackson, *Classical Electrodynamics*, 5.6 and 5.7.
#[derive(Debug, Clone, PartialEq)]
pub struct Dipoles {
    /// The magnetic bodies that act on each other.
    pub bodies: Vec<BodyId>,
    /// A second group of bodies, disjoint from the first. If present, each body acts only on the bodies of the other group.
    pub against: Option<Vec<BodyId>>,
    /// The magnetic moment of each body, body axes, A m²: first the bodies of the first group, then those of the second.
    pub moments: Vec<DVec3>,
    /// The constant k = μ₀/4π, N/A².
    pub constant: f64,
    /// The uniform magnetic field B₀, world axes, T.
    pub field: DVec3,
}

/// A magnetic dipole with its present position.
struct Dipole {
    body: usize,
    at: DVec3,
    /// The magnetic moment, world axes, A m².
    moment: DVec3,
    movable: bool,
}

impl Dipoles {
    /// The magnetic constant μ₀/4π, N/A². Source: CODATA 2022.
    pub const CONSTANT: f64 = 9.999_999_998_7e-8;

    /// Returns the magnetic field of all dipoles and the uniform field at a point (m), T. `bodies` are the present bodies, in ascending order of
    /// their ids.
    pub fn field_at(&self, point: DVec3, bodies: &[BodySnapshot]) -> DVec3 {
        let all = self.bodies.iter().chain(self.against.iter().flatten()).zip(&self.moments);
        let of_dipole = |(body, own): (&BodyId, &DVec3)| {
            let at = find(bodies, body.index())?;
            let way = point - at.location;
            let r = way.length();
            (r > 0.0).then(|| self.constant * field(at.orientation * *own, way / r, r))
        };
        self.field + all.filter_map(of_dipole).sum::<DVec3>()
    }

    /// Returns the dipoles of all present bodies, and the number of these that belong to the first group.
    fn present(&self, moment: &Moment) -> (Vec<Dipole>, usize) {
        let model = moment.model;
        let all = self.bodies.iter().chain(self.against.iter().flatten()).zip(&self.moments);
        let mut first = 0;
        let mut dipoles = Vec::with_capacity(self.moments.len());
        for (number, (body, own)) in all.enumerate() {
            let i = body.index();
            if !model.is_present(i) {
                continue;
            }
            first += usize::from(number < self.bodies.len());
            dipoles.push(Dipole {
                body: i,
                at: moment.state.location[i],
                moment: model.world_from_body(i, moment.state) * *own,
                movable: model.movable()[i],
            });
        }
        (dipoles, first)
    }

    /// Calls `see` for each pair of dipoles in which at least one body can move. `first` is the number of dipoles in the first group.
    fn each_pair(&self, dipoles: &[Dipole], first: usize, mut see: impl FnMut(&Dipole, &Dipole)) {
        for (number, one) in dipoles[..first].iter().enumerate() {
            let others = if self.against.is_some() { &dipoles[first..] } else { &dipoles[number + 1..] };
            for other in others.iter().filter(|other| one.movable || other.movable) {
                see(one, other);
            }
        }
    }

    /// Returns the energy of two dipoles in each other's field, J.
    fn energy(&self, one: &Dipole, other: &Dipole) -> f64 {
        let d = one.at - other.at;
        let r = d.length();
        -self.constant * one.moment.dot(field(other.moment, d / r, r))
    }
}

/// Returns the field of a magnetic dipole at the position d = r n relative to the dipole, divided by k.
fn field(moment: DVec3, n: DVec3, r: f64) -> DVec3 {
    (3.0 * moment.dot(n) * n - moment) / (r * r * r)
}

impl Force for Dipoles {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let (dipoles, first) = self.present(moment);
        for dipole in &dipoles {
            loads.torque[dipole.body] += dipole.moment.cross(self.field);
        }
        self.each_pair(&dipoles, first, |one, other| {
            let d = one.at - other.at;
            let r = d.length();
            let n = d / r;
            let (a, b) = (one.moment, other.moment);
            let (along, across) = (a.dot(n), b.dot(n));
            let square = r * r;
            let sum = along * b + across * a + (a.dot(b) - 5.0 * along * across) * n;
            let force = 3.0 * self.constant / (square * square) * sum;
            loads.force[one.body] += force;
            loads.force[other.body] -= force;
            loads.torque[one.body] += self.constant * a.cross(field(b, n, r));
            loads.torque[other.body] += self.constant * b.cross(field(a, n, r));
        });
        moment.model.pair_counter().add(usize::try_from(self.pairs()).unwrap_or(0));
    }

    fn potential(&self, moment: &Moment) -> f64 {
        let (dipoles, first) = self.present(moment);
        let movable = dipoles.iter().filter(|dipole| dipole.movable);
        let mut sum: f64 = movable.map(|dipole| -dipole.moment.dot(self.field)).sum();
        self.each_pair(&dipoles, first, |one, other| sum += self.energy(one, other));
        moment.model.pair_counter().add(usize::try_from(self.pairs()).unwrap_or(0));
        sum
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        let (dipoles, first) = self.present(moment);
        for dipole in &dipoles {
            share(-dipole.moment.dot(self.field), [dipole.body], moment, shares);
        }
        self.each_pair(&dipoles, first, |one, other| {
            share(self.energy(one, other), [one.body, other.body], moment, shares);
        });
    }

    fn depends_on_motion(&self) -> bool {
        false
    }

    fn pairs(&self) -> u64 {
        pairs::count(&self.bodies, self.against.as_deref())
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    fn dipoles(moments: &[DVec3]) -> Dipoles {
        let bodies = (0..moments.len()).map(BodyId::new).collect();
        Dipoles { bodies, against: None, moments: moments.to_vec(), constant: 2.0, field: DVec3::ZERO }
    }

    /// Two magnets in line attract each other with 6 k m₁ m₂/r⁴. Side by side, with parallel moments, they repel each other with half of
    /// that force.
    #[test]
    fn two_magnets_by_hand() {
        let (model, state) = bodies(&[(DVec3::ZERO, DVec3::ZERO), (2.0 * DVec3::X, DVec3::ZERO)]);
        for (moment, push) in [(DVec3::X, -6.0), (DVec3::Y, 3.0)] {
            let force = dipoles(&[3.0 * moment, 4.0 * moment]);
            let loads = loads(&force, &model, &state);
            let expected = push * 2.0 * 12.0 / 16.0 * DVec3::X;
            assert!(loads.force[1].abs_diff_eq(expected, 1e-13), "{loads:?}");
            assert_eq!(loads.force[0], -loads.force[1]);
            assert!(loads.torque.iter().all(|torque| *torque == DVec3::ZERO));
        }
        // If the moments are at right angles, the torque on one magnet is k m₁ m₂/r³, and the torque on the other is twice as large.
        let given = loads(&dipoles(&[DVec3::X, DVec3::Y]), &model, &state);
        assert!(
            given.torque[0].abs_diff_eq(-0.25 * DVec3::Z, 1e-15)
                && given.torque[1].abs_diff_eq(-0.5 * DVec3::Z, 1e-15)
        );
    }

    #[test]
    fn force_and_torque_are_minus_the_gradient_and_momentum_is_kept() {
        const H: f64 = 1e-5;
        let located =
            [(0.9, 0.4), (-1.1, 0.3), (0.2, -1.2)].map(|(x, y)| (DVec3::new(x, y, x - y), DVec3::ZERO));
        let (model, mut state) = bodies(&located);
        for (i, orientation) in state.orientation.iter_mut().enumerate() {
            *orientation = DQuat::from_rotation_x(i as f64) * DQuat::from_rotation_z(0.7);
        }
        let mut force = dipoles(&[DVec3::new(0.3, 0.5, -0.2), DVec3::X, DVec3::new(0.0, -0.4, 0.8)]);
        let total = |force: &Dipoles| {
            let loads = loads(force, &model, &state);
            let pairs = loads.force.iter().zip(&loads.torque).zip(&state.location);
            pairs.fold((DVec3::ZERO, DVec3::ZERO), |(push, turn), ((force, torque), at)| {
                (push + *force, turn + at.cross(*force) + *torque)
            })
        };
        let (push, turn) = total(&force);
        assert!(push.length() < 1e-14 && turn.length() < 1e-14, "{push} {turn}");
        force.field = DVec3::new(0.1, -0.6, 0.2);
        assert_minus_gradient(&force, &model, &state);
        let given = loads(&force, &model, &state).torque;
        for (i, given) in given.iter().enumerate() {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let potential = |angle: f64| {
                    let mut state = state.clone();
                    state.orientation[i] = DQuat::from_axis_angle(axis, angle) * state.orientation[i];
                    force.potential(&Moment { time: 0.0, state: &state, model: &model })
                };
                let expected = (potential(-H) - potential(H)) / (2.0 * H);
                assert!((given.dot(axis) - expected).abs() < 2e-8, "{i} {axis}: {expected}");
            }
        }
    }
}
