//! Lists of quantities that have their default values for most bodies.

use std::ops::Range;

use glam::{DQuat, DVec3};

/// A quantity that has its default value for most bodies. The list ends at the last body with another value, to save memory.
#[derive(Clone, Default)]
pub(super) struct Sparse<T>(Vec<T>);

/// A type with a default value for [`Sparse`] lists.
pub(super) trait DefaultValue: Copy + PartialEq {
    const DEFAULT_VALUE: Self;
}

impl DefaultValue for DVec3 {
    const DEFAULT_VALUE: DVec3 = DVec3::ZERO;
}

impl DefaultValue for DQuat {
    const DEFAULT_VALUE: DQuat = DQuat::IDENTITY;
}

impl<T: DefaultValue> Sparse<T> {
    pub(super) fn get(&self, body: usize) -> T {
        self.0.get(body).copied().unwrap_or(T::DEFAULT_VALUE)
    }

    pub(super) fn set(&mut self, body: usize, value: T) {
        if body >= self.0.len() && value != T::DEFAULT_VALUE {
            self.0.resize(body + 1, T::DEFAULT_VALUE);
        }
        if let Some(place) = self.0.get_mut(body) {
            *place = value;
        }
    }

    /// Replaces the contents of `out` by the values of the first `bodies` bodies.
    pub(super) fn write(&self, out: &mut Vec<T>, bodies: usize) {
        out.clone_from(&self.0);
        out.resize(bodies, T::DEFAULT_VALUE);
    }

    /// Writes the values of a range of bodies to the same range of `out`.
    pub(super) fn write_part(&self, out: &mut [T], bodies: Range<usize>) {
        let known = self.0.len().clamp(bodies.start, bodies.end);
        out[known..bodies.end].fill(T::DEFAULT_VALUE);
        if known > bodies.start {
            out[bodies.start..known].copy_from_slice(&self.0[bodies.start..known]);
        }
    }
}
