//! Drag: the resistance of a fluid.

use std::sync::Arc;

use glam::DVec3;

use super::super::{BodyId, WorkAccount};
use super::{Force, ForceOnEach, Loads, Moment};

/// Drag on each of some bodies, F = −(c₁ + c₂ |u|) u, where u = v − w is the velocity relative to the fluid.
///
/// The linear part is for slow and small bodies (Stokes: c₁ = 6π η r for a sphere). The quadratic part is for fast and large bodies
/// (Newton: c₂ = ½ ρ C A, with the density ρ of the fluid, the drag coefficient C and the cross-section A). Source: L. D. Landau & E. M.
/// Lifshitz, *Fluid Mechanics*, § 20 and § 45.
///
/// Drag has no potential, so its work, with the power F·v, is added to the accounts. In a wind, the power may be positive: the fluid does
/// work on the body.
#[derive(Debug, Clone, PartialEq)]
pub struct Drag {
    /// The bodies that feel the drag.
    pub bodies: Vec<BodyId>,
    /// The coefficient c₁ of linear drag, N s/m.
    pub linear: f64,
    /// The coefficient c₂ of quadratic drag, N s²/m².
    pub quadratic: f64,
    /// The velocity w of the fluid, world axes, m/s.
    pub wind: DVec3,
}

impl Force for Drag {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        for body in &self.bodies {
            let i = body.index();
            let velocity = moment.state.velocity[i];
            let relative = velocity - self.wind;
            let drag = -(self.linear + self.quadratic * relative.length()) * relative;
            loads.force[i] += drag;
            loads.power.work += drag.dot(velocity);
        }
    }

    fn turns_bodies(&self) -> bool {
        false
    }

    fn work_account(&self) -> Option<WorkAccount> {
        Some(WorkAccount::Work)
    }

    fn potential(&self, _: &Moment) -> f64 {
        0.0
    }
}

impl ForceOnEach for Drag {
    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn on_particles(&self, particles: Vec<BodyId>) -> Arc<dyn Force> {
        Arc::new(Drag { bodies: particles, ..*self })
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{bodies, loads};
    use super::*;

    #[test]
    fn it_acts_on_the_named_bodies_against_their_velocity_in_the_air() {
        let (model, state) = bodies(&[(DVec3::X, DVec3::Y), (DVec3::ZERO, DVec3::new(4.0, 0.0, 4.0))]);
        let wind = DVec3::new(1.0, 0.0, 0.0);
        let drag = Drag { bodies: vec![BodyId::new(1)], linear: 2.0, quadratic: 0.5, wind };
        let loads = loads(&drag, &model, &state);
        // The velocity relative to the fluid is u = (3, 0, 4), so |u| = 5 and c₁ + c₂ |u| = 4.5.
        assert_eq!(loads.force, [DVec3::ZERO, DVec3::new(-13.5, 0.0, -18.0)]);
        assert_eq!(loads.power.work, -13.5 * 4.0 - 18.0 * 4.0);
    }

    #[test]
    fn a_wind_does_work_on_what_it_carries_along() {
        let (model, state) = bodies(&[(DVec3::ZERO, DVec3::X)]);
        let wind = DVec3::new(3.0, 0.0, 0.0);
        let drag = Drag { bodies: vec![BodyId::new(0)], linear: 0.0, quadratic: 1.0, wind };
        assert_eq!(loads(&drag, &model, &state).power.work, 4.0);
    }
}
