//! Copies of the velocities of all bodies, for methods that compute several velocities in a step.

use glam::DVec3;

use super::super::State;

/// Two velocities count as equal if their relative difference is at most this.
const VELOCITY_TOLERANCE: f64 = 4e-16;

/// The velocities and angular momenta of all bodies at one stage of a step.
#[derive(Clone, Default)]
pub(super) struct Velocities {
    velocity: Vec<DVec3>,
    angular_momentum: Vec<DVec3>,
}

impl Velocities {
    pub(super) fn read(&mut self, state: &State) {
        self.velocity.clone_from(&state.velocity);
        self.angular_momentum.clone_from(&state.angular_momentum);
    }

    pub(super) fn write(&self, state: &mut State) {
        state.velocity.clone_from(&self.velocity);
        state.angular_momentum.clone_from(&self.angular_momentum);
    }

    /// Extrapolates the velocities of `state` linearly: adds their difference from the stored velocities.
    pub(super) fn extrapolate(&self, state: &mut State) {
        let pairs = state.velocity.iter_mut().zip(&self.velocity);
        pairs.for_each(|(now, before)| *now += *now - *before);
        let pairs = state.angular_momentum.iter_mut().zip(&self.angular_momentum);
        pairs.for_each(|(now, before)| *now += *now - *before);
    }

    /// Writes the mean of these velocities and `others` to `state`.
    pub(super) fn write_mean(&self, others: &Velocities, state: &mut State) {
        let mean = |(a, b): (&DVec3, &DVec3)| 0.5 * (*a + *b);
        state.velocity.clear();
        state.velocity.extend(self.velocity.iter().zip(&others.velocity).map(mean));
        state.angular_momentum.clear();
        state.angular_momentum.extend(self.angular_momentum.iter().zip(&others.angular_momentum).map(mean));
    }

    /// Replaces velocities of `state` by the stored velocities where both agree up to rounding. Returns whether all velocities agree.
    ///
    /// Each body is compared on its own, so that particles that are advanced together do not depend on each other.
    pub(super) fn settle(&self, state: &mut State) -> bool {
        let take = |known: &[DVec3], new: &mut [DVec3]| {
            let mut are_all = true;
            for (known, new) in known.iter().zip(new) {
                let is_same =
                    (*known - *new).abs().max_element() <= VELOCITY_TOLERANCE * known.abs().max_element();
                are_all &= is_same;
                *new = if is_same { *known } else { *new };
            }
            are_all
        };
        let velocities = take(&self.velocity, &mut state.velocity);
        take(&self.angular_momentum, &mut state.angular_momentum) && velocities
    }
}
