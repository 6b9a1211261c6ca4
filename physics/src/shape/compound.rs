//! Compounds: several solids that form one rigid body.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::Shape;
use super::principal::principal;

/// A solid that is part of a compound.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// The shape of the part. An infinite shape adds neither volume nor mass.
    pub shape: Shape,
    /// The location of the part's centre of mass in the frame of the compound, m.
    pub location: DVec3,
    /// The rotation from the part's axes to the axes of the compound.
    pub orientation: DQuat,
}

/// Several solids of the same density that form one rigid body. Where parts overlap, the common volume counts once for each part.
#[derive(Debug, Clone, PartialEq)]
pub struct Compound {
    /// The parts, which clones of a compound share.
    parts: Arc<[Part]>,
    volume: f64,
    /// The principal moments of inertia, divided by the mass, m².
    inertia: DVec3,
    principal_axes: DQuat,
}

impl Compound {
    /// Creates a compound from parts. The origin is moved to the common centre of mass, and the axes are kept. So the origin of the given
    /// locations does not matter.
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

    /// Returns the parts of the compound, in a frame whose origin is the compound's centre of mass.
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

    /// Returns the largest extent of any part in a direction in the frame of the compound, m.
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

/// Returns the inertia tensor of a part about the compound's origin, divided by the part's mass, m². It is the tensor about the part's own
/// centre, rotated, plus the tensor of a point mass at that centre, by the parallel axis theorem (Goldstein, *Classical Mechanics*, ch.
/// 5).
fn tensor(part: &Part) -> DMat3 {
    let turn = DMat3::from_quat(part.orientation * part.shape.principal_axes());
    let own = turn * DMat3::from_diagonal(part.shape.inertia(1.0)) * turn.transpose();
    let d = part.location;
    let of_centre =
        DMat3::from_diagonal(DVec3::splat(d.length_squared())) - DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    own + of_centre
}
