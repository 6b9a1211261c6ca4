//! Absent bodies: bodies before their birth or after their death.

use std::borrow::Cow;

use glam::DVec3;

use super::super::{BodyId, State};
use super::Model;

/// The constants and the motion of an absent body, stored until it returns. Meanwhile, the body has zero mass, charge and inertia in the
/// model, and is at rest. Most forces then skip it without a special case.
#[derive(Clone, Copy)]
pub(super) struct Away {
    mass: f64,
    charge: f64,
    inverse_mass: f64,
    inertia: DVec3,
    inverse_inertia: DVec3,
    movable: bool,
    velocity: DVec3,
    angular_momentum: DVec3,
}

impl Away {
    /// Returns true if forces do not move the body when it is present.
    pub(super) fn is_given(&self) -> bool {
        self.inverse_mass == 0.0
    }
}

impl Model {
    /// Returns true if a body is present.
    #[must_use]
    pub fn is_present(&self, body: usize) -> bool {
        self.away.get(body).is_none_or(Option::is_none)
    }

    /// Returns those of the given bodies that are present.
    #[must_use]
    pub fn present<'a>(&self, bodies: &'a [BodyId]) -> Cow<'a, [BodyId]> {
        if self.away.is_empty() {
            return Cow::Borrowed(bodies);
        }
        bodies.iter().copied().filter(|body| self.is_present(body.index())).collect()
    }

    /// Makes bodies appear (true) or disappear (false). A body appears in the state in which it disappeared. If its motion is given, it
    /// must be [placed](Model::place) afterwards.
    pub(in super::super) fn let_come_and_go(&mut self, changes: &[(usize, bool)], state: &mut State) {
        for &(body, comes) in changes {
            if comes { self.bring(body, state) } else { self.take_away(body, state) }
        }
        let inverse = &self.inverse_mass;
        self.unmoved.clear();
        self.unmoved.extend((0..inverse.len()).filter(|&i| inverse[i] == 0.0));
    }

    /// Makes a body disappear, if it is present.
    pub(in super::super) fn take_away(&mut self, i: usize, state: &mut State) {
        if !self.is_present(i) {
            return;
        }
        if self.away.len() <= i {
            self.away.resize(i + 1, None);
        }
        if self.inverse_mass[i] != 0.0 {
            self.unmoved.push(i);
        }
        // A struct literal, so that no field can be forgotten.
        self.away[i] = Some(Box::new(Away {
            mass: std::mem::take(&mut self.mass[i]),
            charge: std::mem::take(&mut self.charge[i]),
            inverse_mass: std::mem::take(&mut self.inverse_mass[i]),
            inertia: std::mem::take(&mut self.inertia[i]),
            inverse_inertia: std::mem::take(&mut self.inverse_inertia[i]),
            movable: std::mem::take(&mut self.movable[i]),
            velocity: std::mem::take(&mut state.velocity[i]),
            angular_momentum: std::mem::take(&mut state.angular_momentum[i]),
        }));
    }

    /// Makes a body appear, if it is absent. The caller must update the list `unmoved` of bodies that no load moves.
    pub(in super::super) fn bring(&mut self, i: usize, state: &mut State) {
        let Some(away) = self.away.get_mut(i).and_then(Option::take) else { return };
        let Away {
            mass,
            charge,
            inverse_mass,
            inertia,
            inverse_inertia,
            movable,
            velocity,
            angular_momentum,
        } = *away;
        self.mass[i] = mass;
        self.charge[i] = charge;
        self.inverse_mass[i] = inverse_mass;
        self.inertia[i] = inertia;
        self.inverse_inertia[i] = inverse_inertia;
        self.movable[i] = movable;
        state.velocity[i] = velocity;
        state.angular_momentum[i] = angular_momentum;
    }
}

/// Functions that the engine for time-stepping needs.
#[cfg(feature = "time-stepping")]
impl Model {
    /// Returns true if forces move a body while it is present.
    pub(in super::super) fn is_moved_by_forces(&self, body: usize) -> bool {
        match self.away.get(body) {
            Some(Some(away)) => !away.is_given(),
            _ => self.inverse_mass[body] != 0.0,
        }
    }

    /// Returns true if a body is present and follows a given motion.
    pub(in super::super) fn is_guided(&self, body: usize) -> bool {
        self.movable[body] && self.inverse_mass[body] == 0.0
    }

    /// Returns the absent bodies, each with the velocity (m/s) and the angular momentum (kg m²/s) with which it will appear.
    #[cfg(feature = "checkpoints")]
    pub(in super::super) fn away(&self) -> Vec<(usize, DVec3, DVec3)> {
        let away = self.away.iter().enumerate();
        away.filter_map(|(i, away)| away.as_ref().map(|away| (i, away.velocity, away.angular_momentum)))
            .collect()
    }

    /// Makes exactly these bodies absent, with the velocity and angular momentum with which each will appear; all other bodies become
    /// present.
    #[cfg(feature = "checkpoints")]
    pub(in super::super) fn set_away(&mut self, away: &[(usize, DVec3, DVec3)], state: &mut State) {
        let mut is_there = vec![true; self.inverse_mass.len()];
        away.iter().for_each(|(i, ..)| is_there[*i] = false);
        let changes: Vec<(usize, bool)> = is_there.into_iter().enumerate().collect();
        self.let_come_and_go(&changes, state);
        for &(i, velocity, angular_momentum) in away {
            if let Some(Some(away)) = self.away.get_mut(i) {
                (away.velocity, away.angular_momentum) = (velocity, angular_momentum);
            }
        }
    }
}
