//! Thin rods on hinges, which rotate at a constant angular velocity within a step.
//!
//! If the angular momentum of a thin rod is not exactly perpendicular to the rod, free rotation is fast about the rod's own axis. The hinge
//! corrects this rotation only at the end of the step, and the errors would grow.

use glam::{DQuat, DVec3};

use super::mechanisms::Mechanisms;

/// A body counts as a thin rod if its moment of inertia about a hinge is larger than this multiple of its smallest moment.
const MIN_INERTIA_RATIO: f64 = 4.0;
/// A body rotates in the plane of its hinge if its angular velocity across the hinge's axis is at most this fraction of its whole angular
/// velocity.
const PLANAR_ROTATION_TOLERANCE: f64 = 1e-4;

/// The thin rods of a scene.
pub(super) struct ThinRods(Vec<Option<Rod>>);

struct Rod {
    /// The axis of the hinge, a unit vector in the frame of the principal axes.
    axis: DVec3,
    /// Whether the rod and its hinge can tumble together: whether they belong to a mechanism that nothing connects with the world.
    can_tumble: bool,
}

impl ThinRods {
    /// Finds the thin rods. `axes` holds the axis of each body's hinge, a unit vector in the frame of the principal axes. `inertia` holds the
    /// principal moments of inertia, kg m².
    pub(super) fn new(axes: &[Option<DVec3>], inertia: &[DVec3], mechanisms: &Mechanisms) -> ThinRods {
        let rod = |((axis, inertia), is_free): ((&Option<DVec3>, &DVec3), bool)| {
            let axis =
                axis.filter(|axis| axis.dot(*inertia * *axis) > MIN_INERTIA_RATIO * inertia.min_element())?;
            Some(Rod { axis, can_tumble: is_free })
        };
        ThinRods(axes.iter().zip(inertia).zip(mechanisms.free()).map(rod).collect())
    }

    /// Returns whether a body must rotate at its constant angular velocity `turning` (rad/s) within a step. A rod that tumbles with its
    /// hinge must rotate freely, or it would gain energy.
    pub(super) fn is_steady(&self, body: usize, orientation: DQuat, turning: DVec3) -> bool {
        let Some(rod) = &self.0[body] else { return false };
        let across = turning.reject_from_normalized(orientation * rod.axis).length_squared();
        !rod.can_tumble
            || across <= PLANAR_ROTATION_TOLERANCE * PLANAR_ROTATION_TOLERANCE * turning.length_squared()
    }
}
