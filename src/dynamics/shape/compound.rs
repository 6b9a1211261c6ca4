//! Compounds: several solids as one rigid body.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::Shape;
use super::principal::principal;

/// A solid in a compound.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// The shape of the part. It is finite, or has no mass.
    pub shape: Shape,
    /// The location of the part's centre of mass, m.
    pub location: DVec3,
    /// The orientation of the part.
    pub orientation: DQuat,
}

/// Several solids of one density as one rigid body. The mass of an overlap counts for each part.
#[derive(Debug, Clone, PartialEq)]
pub struct Compound {
    /// The parts. Clones of a compound share them.
    parts: Arc<[Part]>,
    volume: f64,
    /// The principal moments of inertia per mass, m².
    inertia: DVec3,
    principal_axes: DQuat,
}

impl Compound {
    /// Creates a compound from parts. Moves the origin to the common centre of mass and keeps the axes, so the origin
    /// of the given parts does not matter.
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

    /// The parts, in a frame whose origin is the centre of mass of the compound.
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

    /// The largest reach of a part in a direction in the frame of the compound, m.
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

/// The inertia tensor of a part about the origin, per mass, m²: the tensor about its own centre, rotated, plus that of
/// its centre by the parallel axis theorem (Goldstein, *Classical Mechanics*, ch. 5).
fn tensor(part: &Part) -> DMat3 {
    let turn = DMat3::from_quat(part.orientation * part.shape.principal_axes());
    let own = turn * DMat3::from_diagonal(part.shape.inertia(1.0)) * turn.transpose();
    let d = part.location;
    let of_centre =
        DMat3::from_diagonal(DVec3::splat(d.length_squared())) - DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    own + of_centre
}
