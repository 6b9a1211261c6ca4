//! Several solids as one.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::Shape;
use super::principal::principal;

/// One of the solids of a compound.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its shape, which is finite unless it weighs nothing.
    pub shape: Shape,
    /// Its centre of mass, m.
    pub location: DVec3,
    /// Its orientation.
    pub orientation: DQuat,
}

/// Several solids of one density as one rigid body. Where they overlap, both count.
#[derive(Debug, Clone, PartialEq)]
pub struct Compound {
    /// Clones of a compound share them.
    parts: Arc<[Part]>,
    volume: f64,
    /// Principal moments of inertia per mass, m².
    inertia: DVec3,
    principal_axes: DQuat,
}

impl Compound {
    /// The compound of some parts, in a frame whose axes are theirs and whose origin is the centre of mass of all, so
    /// it does not matter where theirs is.
    #[must_use]
    pub fn new(mut parts: Vec<Part>) -> Compound {
        let volume_of = |part: &Part| part.shape.volume().unwrap_or(0.0);
        let volume: f64 = parts.iter().map(volume_of).sum();
        let centre: DVec3 = parts.iter().map(|part| part.location * (volume_of(part) / volume)).sum();
        parts.iter_mut().for_each(|part| part.location -= centre);
        let tensors = parts.iter().map(|part| tensor(part) * (volume_of(part) / volume));
        let tensor = tensors.fold(DMat3::ZERO, |sum, tensor| sum + tensor);
        let (inertia, principal_axes) = principal(tensor);
        Compound { parts: parts.into(), volume, inertia, principal_axes }
    }

    /// Its parts, about its centre of mass.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    pub(super) fn volume(&self) -> f64 {
        self.volume
    }

    pub(super) fn inertia(&self) -> DVec3 {
        self.inertia
    }

    pub(super) fn principal_axes(&self) -> DQuat {
        self.principal_axes
    }

    /// The farthest that a part reaches along a direction in the frame of the compound.
    pub(super) fn support(&self, direction: DVec3) -> Option<f64> {
        let reach = |part: &Part| {
            Some(part.location.dot(direction) + part.shape.support(part.orientation, direction)?)
        };
        self.parts.iter().filter_map(reach).max_by(f64::total_cmp)
    }

    pub(super) fn half_thickness(&self) -> Option<f64> {
        self.parts.iter().filter_map(|part| part.shape.half_thickness()).min_by(f64::total_cmp)
    }

    pub(super) fn scale(&mut self, factor: f64) {
        let scaled = |part: &Part| Part {
            shape: part.shape.scaled(factor),
            location: part.location * factor,
            orientation: part.orientation,
        };
        self.parts = self.parts.iter().map(scaled).collect();
        self.volume *= factor * factor * factor;
        self.inertia *= factor * factor;
    }
}

/// The inertia of a part per mass about the origin, m²: that about its own centre, turned, and by the parallel axis
/// theorem (Goldstein, *Classical Mechanics*, ch. 5) that of its centre.
fn tensor(part: &Part) -> DMat3 {
    let turn = DMat3::from_quat(part.orientation * part.shape.principal_axes());
    let own = turn * DMat3::from_diagonal(part.shape.inertia(1.0)) * turn.transpose();
    let d = part.location;
    let of_centre =
        DMat3::from_diagonal(DVec3::splat(d.length_squared())) - DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    own + of_centre
}
