//! The replacement of GJK without the feature `time-stepping`: there is no first guess, so all pairs of features are compared. The result
//! is as exact, but the search is slower.

use super::closest_points::ClosestPoints;
use super::solid::{ConvexPart, Pose};

/// Always returns `None`: without GJK, there is no first guess for the closest points of two convex parts.
pub(super) fn cores(_: &ConvexPart, _: &Pose, _: &ConvexPart, _: &Pose) -> Option<ClosestPoints> {
    None
}
