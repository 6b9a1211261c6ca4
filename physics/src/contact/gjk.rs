//! The use of GJK (the distance algorithm of Gilbert, Johnson and Keerthi) from the crate parry. It finds the closest points of two convex
//! parts to about eight digits, which serves as a first guess.

use glam::DVec3;
use parry3d_f64::query::contact::contact_support_map_support_map;
use parry3d_f64::shape::SupportMap;

use super::closest_points::ClosestPoints;
use super::solid::{ConvexPart, Pose};

/// The core of a convex part as parry sees it: moved to the origin and scaled to a size of about 1, since parry's tolerances are absolute.
struct Placed<'a> {
    part: &'a ConvexPart,
    pose: Pose,
    origin: DVec3,
    unit: f64,
}

impl SupportMap for Placed<'_> {
    fn local_support_point(&self, direction: DVec3) -> DVec3 {
        let core = self.part.core.support(self.pose.orientation.conjugate() * direction);
        (self.pose.point(core) - self.origin) / self.unit
    }
}

/// Computes the closest points of the cores of two convex parts by GJK. `None` if the algorithm fails or a part is infinite.
pub(super) fn cores(a: &ConvexPart, pa: &Pose, b: &ConvexPart, pb: &Pose) -> Option<ClosestPoints> {
    let origin = pa.point(a.centre);
    let unit = a.bound.max(b.bound);
    let far = (pb.point(b.centre) - origin).length();
    if !(far.is_finite() && unit > 0.0) {
        return None;
    }
    let placed = |part, pose: &Pose| Placed { part, pose: *pose, origin, unit };
    let same = parry3d_f64::math::Pose::IDENTITY;
    let found = contact_support_map_support_map(&same, &placed(a, pa), &placed(b, pb), f64::MAX)?;
    let world = |point: DVec3| origin + unit * point;
    Some(ClosestPoints {
        gap: unit * found.dist,
        normal: found.normal1,
        on: [world(found.point1), world(found.point2)],
    })
}
