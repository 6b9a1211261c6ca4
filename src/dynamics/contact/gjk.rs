//! The border to parry: the first guess of where two convex parts are nearest, to some eight digits.

use glam::DVec3;
use parry3d_f64::query::contact::contact_support_map_support_map;
use parry3d_f64::shape::SupportMap;

use super::nearest::Nearest;
use super::solid::{Part, Pose};

/// The core of a part, with its centre near the origin and its size near 1: parry's tolerances are absolute.
struct Placed<'a> {
    part: &'a Part,
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

/// Where the cores of two parts are nearest. `None` where parry finds nothing.
pub(super) fn cores(a: &Part, pa: &Pose, b: &Part, pb: &Pose) -> Option<Nearest> {
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
    Some(Nearest {
        gap: unit * found.dist,
        normal: found.normal1,
        on: [world(found.point1), world(found.point2)],
    })
}
