//! Newton's gravitation between bodies.

use std::sync::Arc;

use super::super::{BodyId, RigidBody};
use super::pairs::{self, Pairs};
use super::tree::ByTree;
use super::{Force, ForceBetween, Loads, Moment};

/// Newton's gravitation: any two of the listed bodies attract each other with G m₁ m₂ r / (r² + ε²)^(3/2). The potential is −G m₁ m₂ /
/// √(r² + ε²).
///
/// Fixed bodies attract other bodies as well. Source: I. Newton, *Principia* III, prop. 7; for the softening ε, H. C. Plummer, Mon. Not.
/// R. Astron. Soc. 71 (1911) 460.
#[derive(Debug, Clone, PartialEq)]
pub struct Gravitation {
    /// The bodies that attract each other.
    pub bodies: Vec<BodyId>,
    /// A second group of bodies, disjoint from the first. If present, each body attracts only the bodies of the other group.
    pub against: Option<Vec<BodyId>>,
    /// The gravitational constant G, m³/(kg s²).
    pub constant: f64,
    /// The softening length ε, m.
    pub softening: f64,
    /// The opening angle of the Barnes–Hut tree, above 0 and up to 1: the largest ratio of size to distance at which a group of bodies
    /// acts as a whole. With `None`, the forces are summed over all pairs of bodies.
    ///
    /// With a tree, the forces that two bodies exert on each other are not exactly opposite, and the forces are not exactly minus the
    /// gradient of the potential. So momentum and energy drift by about the relative error of the forces, 4e-4 at an angle of 0.5.
    pub opening_angle: Option<f64>,
}

impl Gravitation {
    /// Newton's gravitational constant, m³/(kg s²). Source: CODATA 2018, Rev. Mod. Phys. 93 (2021) 025010.
    pub const CONSTANT: f64 = 6.674_30e-11;

    fn of<'a>(&'a self, moment: &Moment<'a>) -> Pairs<'a> {
        let strength = moment.model.mass();
        Pairs {
            bodies: &self.bodies,
            against: self.against.as_deref(),
            strength,
            constant: -self.constant,
            softening: self.softening,
        }
    }

    /// Returns the gravitation between all pairs of bodies, to be computed by a tree with the opening angle `angle`.
    fn by_tree<'a>(&'a self, angle: f64, moment: &Moment<'a>) -> ByTree<'a> {
        ByTree { pairs: self.of(moment), angle, each: self.interactions(angle) }
    }

    /// Estimates the number of interactions of each body when a tree computes the forces.
    fn interactions(&self, angle: f64) -> u64 {
        let most = self.bodies.len().max(self.against.as_ref().map_or(0, Vec::len)) as u64;
        // Measurement: 1,500 interactions for each of 100,000 bodies at an opening angle of 0.5.
        most.min((400.0 / (angle * angle)) as u64)
    }
}

impl Force for Gravitation {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        match self.opening_angle {
            Some(angle) => self.by_tree(angle, moment).apply(moment, loads),
            None => self.of(moment).apply(moment, loads),
        }
    }

    fn depends_on_motion(&self) -> bool {
        false
    }

    fn turns_bodies(&self) -> bool {
        false
    }

    fn gravitation(&self) -> Option<&Gravitation> {
        Some(self)
    }

    fn potential(&self, moment: &Moment) -> f64 {
        match self.opening_angle {
            Some(angle) => self.by_tree(angle, moment).potential(moment),
            None => self.of(moment).potential(moment),
        }
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        match self.opening_angle {
            Some(angle) => self.by_tree(angle, moment).share_potential(moment, shares),
            None => self.of(moment).share_potential(moment, shares),
        }
    }

    fn pairs(&self) -> u64 {
        let Some(angle) = self.opening_angle else {
            return pairs::count(&self.bodies, self.against.as_deref());
        };
        let bodies = self.bodies.len() + self.against.as_ref().map_or(0, Vec::len);
        self.interactions(angle).saturating_mul(bodies as u64)
    }
}

impl ForceBetween for Gravitation {
    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn against(&self) -> Option<&[BodyId]> {
        self.against.as_deref()
    }

    fn on_particles(&self, particles: Vec<BodyId>, sources: Vec<BodyId>) -> Arc<dyn Force> {
        // With an opening angle, forces are computed from a tree, and the force on a particle would depend on the other particles.
        Arc::new(Gravitation { bodies: particles, against: Some(sources), opening_angle: None, ..*self })
    }

    fn depends_on_mass(&self) -> bool {
        true
    }

    fn source_strength(&self, source: &RigidBody) -> f64 {
        -source.mass
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    fn all(count: usize, softening: f64) -> Gravitation {
        Gravitation {
            bodies: (0..count).map(BodyId::new).collect(),
            against: None,
            constant: 2.0,
            softening,
            opening_angle: None,
        }
    }

    #[test]
    fn two_bodies_by_hand() {
        let (model, state) = bodies(&[(DVec3::ZERO, DVec3::X), (DVec3::new(0.0, 3.0, 4.0), DVec3::ZERO)]);
        // The force is G m₁ m₂ / r² = 2 · 1 · 2 / 25, in the direction r̂ = (0, 0.6, 0.8).
        let force = DVec3::new(0.0, 0.096, 0.128);
        let loads = loads(&all(2, 0.0), &model, &state);
        assert!(loads.force[0].abs_diff_eq(force, 1e-16) && loads.force[1] == -loads.force[0]);
        assert_eq!(loads.power.work, 0.0);
        let potential =
            |softening| all(2, softening).potential(&Moment { time: 0.0, state: &state, model: &model });
        assert_eq!(potential(0.0), -0.8);
        assert!((potential(12.0) + 4.0 / 13.0).abs() < 1e-16, "√(25 + 144) = 13");
    }

    #[test]
    fn the_force_is_minus_the_gradient_of_the_potential() {
        let located = [(1.0, 0.5), (-2.0, 1.0), (0.3, -1.7), (2.5, 2.0)]
            .map(|(x, y)| (DVec3::new(x, y, x * y), DVec3::X));
        let (model, state) = bodies(&located);
        for softening in [0.0, 0.7] {
            assert_minus_gradient(&all(4, softening), &model, &state);
        }
    }

    /// The forces are computed in tiles of 128 bodies. The counts give part of a tile, exactly one tile, one body more, and several tiles.
    /// The tolerance covers the rounding error of a sum of n terms, which grows with n and with the sum of their magnitudes.
    #[test]
    fn any_number_of_bodies_is_the_plain_double_sum() {
        for count in [1, 5, 128, 129, 300] {
            let at = |i: usize, k: f64| (i as f64 * k).fract() * 10.0;
            let located: Vec<_> = (0..count)
                .map(|i| (DVec3::new(at(i, 0.618_033), at(i, 0.414_213), at(i, 0.732_050)), DVec3::ZERO))
                .collect();
            let (model, state) = bodies(&located);
            let gravitation = all(count, 0.1);
            let loads = loads(&gravitation, &model, &state);
            let mut potential = 0.0;
            for (i, (here, _)) in located.iter().enumerate() {
                let (mut force, mut magnitude) = (DVec3::ZERO, 0.0);
                for (j, (there, _)) in located.iter().enumerate().filter(|(j, _)| *j != i) {
                    let (d, masses) = (*there - *here, model.mass()[i] * model.mass()[j]);
                    let square = d.length_squared() + 0.01;
                    let pull = 2.0 * masses / (square * square.sqrt()) * d;
                    force += pull;
                    magnitude += pull.length();
                    potential -= masses / square.sqrt();
                }
                let off = (loads.force[i] - force).length();
                assert!(off <= count as f64 * 1e-15 * magnitude, "{count} {i}: {off:e} of {magnitude}");
            }
            let given = gravitation.potential(&Moment { time: 0.0, state: &state, model: &model });
            assert!(
                (given - potential).abs() <= count as f64 * 1e-15 * potential.abs(),
                "{given} {potential}"
            );
        }
    }

    /// Two groups of 150 and 140 bodies, so that each group needs two tiles of 128 bodies.
    #[test]
    fn two_groups_attract_each_other_and_not_themselves() {
        let at = |i: usize, k: f64| (i as f64 * k).fract() * 10.0;
        let located: Vec<_> = (0..290)
            .map(|i| (DVec3::new(at(i, 0.618_033), at(i, 0.414_213), at(i, 0.732_050)), DVec3::ZERO))
            .collect();
        let (model, state) = bodies(&located);
        let ids = |range: std::ops::Range<usize>| range.map(BodyId::new).collect::<Vec<_>>();
        let force = Gravitation {
            bodies: ids(0..150),
            against: Some(ids(150..290)),
            constant: 2.0,
            softening: 0.1,
            opening_angle: None,
        };
        let loads = loads(&force, &model, &state);
        let mut potential = 0.0;
        for (i, (here, _)) in located.iter().enumerate() {
            let (mut sum, mut magnitude) = (DVec3::ZERO, 0.0);
            for (j, (there, _)) in located.iter().enumerate().filter(|(j, _)| (*j < 150) != (i < 150)) {
                let (d, masses) = (*there - *here, model.mass()[i] * model.mass()[j]);
                let square = d.length_squared() + 0.01;
                let pull = 2.0 * masses / (square * square.sqrt()) * d;
                sum += pull;
                magnitude += pull.length();
                potential -= masses / square.sqrt();
            }
            assert!((loads.force[i] - sum).length() <= 290e-15 * magnitude, "{i}");
        }
        let given = force.potential(&Moment { time: 0.0, state: &state, model: &model });
        assert!((given - potential).abs() <= 290e-15 * potential.abs(), "{given} {potential}");
    }
}
