//! All contact points of two solids.

use glam::DVec3;

use super::closest_points::{ClosestPoints, FEATURE_TOLERANCE, apart, ball_and, between, edge, for_pairs};
use super::facing::{Facing, facing};
use super::feature::Feature;
use super::patch::{Patch, meet, meet_placed};
use super::solid::{ConvexPart, Core, Pose, Solid};

/// A flat end lies flat on a face, and two sides lie along each other, if the sine of the angle between them is below this.
const FLAT_CONTACT_SINE: f64 = 1e-7;
/// Two rims are parallel if the sine of the angle between their axes is below this.
const PARALLEL_RIM_SINE: f64 = 1e-3;
/// Two contact points count as the same if their distance is below this fraction of the smaller body's size, and if the cosine of the angle
/// between their normals differs from 1 by less than this.
const SAME_POINT_TOLERANCE: f64 = 1e-6;
/// The tolerances at the borders of two features and the rounding errors there are below this fraction of the bodies' sizes.
const BORDER_TOLERANCE: f64 = 1e-6;
/// The largest number of contact points that are kept for a pair of convex parts. So many are enough to hold one part on the other.
const MAX_CONTACT_POINTS: usize = 8;

/// A contact point of two solids that touch or nearly touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// For each solid, its surface around the contact point, in its body axes.
    pub patches: [Patch; 2],
    /// The closest points of the two patches, with their gap and normal.
    pub meeting: ClosestPoints,
    /// For each solid, the index of its convex part and the index of the feature in this part. `None` for a single point of a rim, which
    /// is no feature.
    features: [(usize, Option<usize>); 2],
}

impl Touch {
    /// Returns the same contact point, with its closest points measured again.
    pub(crate) fn with(&self, meeting: ClosestPoints) -> Touch {
        Touch { meeting, ..*self }
    }
}

/// Finds all contact points of two solids with gaps below `within`, m, which must be small compared to their sizes. Each point is listed
/// once, in a deterministic order.
pub(crate) fn touches(a: &Solid, pa: &Pose, b: &Solid, pb: &Pose, within: f64) -> Vec<Touch> {
    if a.is_ball() && b.is_ball() {
        let patches = [a, b].map(|ball| ball.parts()[0].features[0].patch);
        let meeting = meet(&patches[0], pa, &patches[1], pb);
        let features = [(0, Some(0)); 2];
        return if meeting.gap <= within { vec![Touch { patches, meeting, features }] } else { Vec::new() };
    }
    let mut all = Vec::new();
    for_pairs(a, pa, b, pb, within, &mut |i, j| {
        let (a, b) = (&a.parts()[i], &b.parts()[j]);
        if apart(a, pa, b, pb) <= within {
            let parts = [i, j];
            let pair = Pair { a, pa, b, pb, parts, within, depth: f64::INFINITY, found: Vec::new() };
            pair.add_to(&mut all);
        }
    });
    if a.is_surface() || b.is_surface() {
        // Adjacent triangles share edges and corners, so the same contact may occur several times.
        let same = SAME_POINT_TOLERANCE * a.size().min(b.size());
        let mut once: Vec<Touch> = Vec::new();
        for touch in all {
            if !once.iter().any(|other| is_same(&other.meeting, &touch.meeting, same)) {
                once.push(touch);
            }
        }
        // The contact of two corners has no unique normal. A contact with the normal of an adjacent triangle is preferred.
        let is_smooth = |touch: &Touch| !touch.patches[0].has_no_normal_with(&touch.patches[1]);
        if once.iter().any(is_smooth) {
            once.retain(is_smooth);
        }
        return farthest(once);
    }
    all
}

/// Returns true if two contact points coincide, with the same normal. `same` is the tolerance, m.
fn is_same(a: &ClosestPoints, b: &ClosestPoints, same: f64) -> bool {
    a.on[1].distance(b.on[1]) < same && a.normal.dot(b.normal) > 1.0 - SAME_POINT_TOLERANCE
}

/// Returns the distance of a contact point from the borders of its features, m. It is negative outside, and infinite without borders.
///
/// A point that is outside by up to 1e-9 of the part's size counts as inside, so that faces of the same size can lie on each other.
pub(crate) fn inside(touch: &Touch, a: &Solid, pa: &Pose, b: &Solid, pb: &Pose) -> f64 {
    let meeting = meet(&touch.patches[0], pa, &touch.patches[1], pb);
    let parts = [&a.parts()[touch.features[0].0], &b.parts()[touch.features[1].0]];
    let round = |patch: &Patch| match *patch {
        Patch::Point { radius, .. } | Patch::Line { radius, .. } | Patch::Side { radius, .. } => radius,
        Patch::Plane { .. } | Patch::Circle { .. } => 0.0,
    };
    let sum = round(&touch.patches[0]) + round(&touch.patches[1]);
    let mut least = f64::INFINITY;
    for (side, pose) in [pa, pb].into_iter().enumerate() {
        let Some(feature) = touch.features[side].1.map(|i| &parts[side].features[i]) else { continue };
        let place = pose.local(meeting.on[side]);
        least = least.min(feature.margin(place) + edge(parts[side], sum > 0.0));
        // When a round body rolls from an edge to a face, the contact normal leaves the range of the edge's normals before the contact
        // point leaves the edge. Against a flat face the normals do not matter: corners touch a face at any tilt.
        if !matches!(touch.patches[1 - side], Patch::Plane { .. }) && sum > 0.0 {
            let normal = if side == 0 { meeting.normal } else { -meeting.normal };
            let slack = feature.slack(place, pose.orientation.conjugate() * normal);
            least = least.min(sum * (slack + FEATURE_TOLERANCE));
        }
    }
    least
}

/// The search for the contact points of two convex parts.
struct Pair<'a> {
    a: &'a ConvexPart,
    pa: &'a Pose,
    b: &'a ConvexPart,
    pb: &'a Pose,
    parts: [usize; 2],
    within: f64,
    /// The largest expected overlap, m. A point that overlaps by more than twice as much lies on the far side of a convex part, and is
    /// ignored.
    depth: f64,
    found: Vec<Touch>,
}

impl Pair<'_> {
    fn add_to(mut self, all: &mut Vec<Touch>) {
        match (&self.a.core, &self.b.core) {
            (Core::Ground { .. }, Core::Ground { .. }) => return,
            (Core::Ground { .. }, _) | (_, Core::Ground { .. }) => self.on_ground(),
            _ => match (self.a.ball().is_some(), self.b.ball().is_some()) {
                (true, _) => {
                    let (found, i) = ball_and(self.a, self.pa, self.b, self.pb);
                    if found.gap <= self.within {
                        self.add(0, i);
                    }
                }
                (_, true) => {
                    let (found, i) = ball_and(self.b, self.pb, self.a, self.pa);
                    if found.gap <= self.within {
                        self.add(i, 0);
                    }
                }
                _ => self.convex(),
            },
        }
        self.thin_out();
        all.append(&mut self.found);
    }

    /// Adds the corners and rims of a convex part that are near the ground.
    fn on_ground(&mut self) {
        let ground_first = self.a.is_ground();
        let part = if ground_first { self.b } else { self.a };
        for (i, feature) in part.features.iter().enumerate() {
            if matches!(feature.patch, Patch::Point { .. } | Patch::Circle { .. }) {
                let (i, j) = if ground_first { (0, i) } else { (i, 0) };
                self.add(i, j);
            }
        }
    }

    /// Adds the contact points of all pairs of features at which two convex parts touch.
    fn convex(&mut self) {
        let (a, pa, b, pb) = (self.a, self.pa, self.b, self.pb);
        let (gap, normal, tops) = match facing(a, pa, b, pb, self.within) {
            Some(Facing::Apart) => return,
            Some(Facing::Near { gap, normal }) => {
                let top = |part: &ConvexPart, pose: &Pose, normal: DVec3| {
                    let normal = pose.orientation.conjugate() * normal;
                    part.core.support(normal).dot(normal) + part.radius
                };
                (gap, normal, [top(a, pa, normal), top(b, pb, -normal)])
            }
            None => {
                let nearest = between(a, pa, b, pb);
                if nearest.gap > self.within {
                    return;
                }
                let top = |pose: &Pose, at: DVec3, normal: DVec3| {
                    pose.local(at).dot(pose.orientation.conjugate() * normal)
                };
                let normal = nearest.normal;
                (nearest.gap, normal, [top(pa, nearest.on[0], normal), top(pb, nearest.on[1], -normal)])
            }
        };
        self.depth = self.within + gap.abs() + SAME_POINT_TOLERANCE * a.bound.min(b.bound);
        let near_a = near_plane(a, pa, tops[0] - self.depth, normal);
        let near_b = near_plane(b, pb, tops[1] - self.depth, -normal);
        // Each feature is transformed once, not for each pair.
        let near_a = placed(self.a, self.pa, self.pa.location, near_a);
        let near_b = placed(self.b, self.pb, self.pa.location, near_b);
        self.add_where(&near_a, &near_b, is_needed);
        if self.found.is_empty() {
            // A corner touches a corner or an edge, or two cones touch at the rims of their bases.
            self.add_where(&near_a, &near_b, has_no_normal);
        }
    }

    /// Adds the contact points of all pairs of features that `is_wanted` accepts. The patches are placed relative to the first body.
    fn add_where(
        &mut self,
        near_a: &[(usize, Patch)],
        near_b: &[(usize, Patch)],
        is_wanted: fn(&Patch, &Patch) -> bool,
    ) {
        let origin = self.pa.location;
        // Beyond this distance, two features do not touch within their borders.
        let reach = self.within.max(2.0 * self.depth) + BORDER_TOLERANCE * (self.a.bound + self.b.bound);
        for (i, a) in near_a {
            for (j, b) in near_b {
                if !is_wanted(a, b) || !a.may_reach(b, reach) {
                    continue;
                }
                let meeting = meet_placed(a, b);
                if self.is_within_reach(&meeting) || a.is_rim() || b.is_rim() {
                    self.add_met(*i, *j, meeting.moved(origin));
                }
            }
        }
    }

    /// Adds the contact points of a pair of features, if the features touch.
    fn add(&mut self, i: usize, j: usize) {
        let (a, b) = (&self.a.features[i].patch, &self.b.features[j].patch);
        self.add_met(i, j, meet(a, self.pa, b, self.pb));
    }

    /// Adds the contact points of two features, whose closest points are `meeting`.
    fn add_met(&mut self, i: usize, j: usize, meeting: ClosestPoints) {
        let (a, b) = (&self.a.features[i], &self.b.features[j]);
        if a.is_seam || b.is_seam {
            return;
        }
        match (a.patch, b.patch) {
            (Patch::Circle { .. }, Patch::Plane { normal, .. }) if self.is_flat(&a.patch, normal, false) => {
                for patch in self.rim_points(0, &a.patch, b) {
                    self.keep_rim([patch, b.patch], [None, Some(j)]);
                }
            }
            (Patch::Plane { normal, .. }, Patch::Circle { .. }) if self.is_flat(&b.patch, normal, true) => {
                for patch in self.rim_points(1, &b.patch, a) {
                    self.keep_rim([a.patch, patch], [Some(i), None]);
                }
            }
            _ => self.keep([a.patch, b.patch], [Some(i), Some(j)], meeting),
        }
    }

    /// Returns true if a rim of one body lies flat on a plane of the other. `normal` is the normal of the plane. The ends of two logs side by side
    /// face the same way, and do not lie on each other.
    fn is_flat(&self, rim: &Patch, normal: DVec3, of_second: bool) -> bool {
        let (own, other) = if of_second { (self.pb, self.pa) } else { (self.pa, self.pb) };
        match *rim {
            Patch::Circle { axis, .. } => {
                let (axis, normal) = (own.orientation * axis, other.orientation * normal);
                axis.dot(normal) < 0.0 && axis.cross(normal).length() < FLAT_CONTACT_SINE
            }
            _ => false,
        }
    }

    /// Returns points that represent a rim lying flat on a face: four around the rim, and the points where it crosses an edge of the face.
    fn rim_points(&self, side: usize, rim: &Patch, face: &Feature) -> Vec<Patch> {
        let Patch::Circle { centre, axis, radius } = *rim else { return Vec::new() };
        let (own, other) = if side == 0 { (self.pa, self.pb) } else { (self.pb, self.pa) };
        let x = axis.any_orthonormal_vector();
        let y = axis.cross(x);
        let mut places: Vec<DVec3> = [x, y, -x, -y].iter().map(|radial| centre + radius * *radial).collect();
        for [at, inward] in face.edges() {
            let at = own.local(other.point(*at)) - centre;
            let inward = own.orientation.conjugate() * (other.orientation * *inward);
            let from = at.dot(inward);
            let half = (radius * radius - from * from).max(0.0).sqrt();
            if half > 0.0 {
                let along = axis.cross(inward);
                let middle = centre + from * inward;
                places.extend([middle + half * along, middle - half * along]);
            }
        }
        places.into_iter().map(|at| Patch::Point { at, radius: 0.0 }).collect()
    }

    /// Returns true if two patches touch at their closest points, and not on the far sides of the convex parts.
    fn is_within_reach(&self, meeting: &ClosestPoints) -> bool {
        (-2.0 * self.depth..=self.within).contains(&meeting.gap)
    }

    /// Adds the contact between a point of a rim and a face, if they touch and the contact is new.
    fn keep_rim(&mut self, patches: [Patch; 2], features: [Option<usize>; 2]) {
        let meeting = meet(&patches[0], self.pa, &patches[1], self.pb);
        self.keep(patches, features, meeting);
    }

    /// Adds the contact of two patches, whose closest points are `meeting`, if the convex parts touch there and the contact is new.
    fn keep(&mut self, patches: [Patch; 2], features: [Option<usize>; 2], meeting: ClosestPoints) {
        if !self.is_within_reach(&meeting) {
            return;
        }
        let parts = [(self.a, self.pa, meeting.normal), (self.b, self.pb, -meeting.normal)];
        for (side, (part, pose, normal)) in parts.into_iter().enumerate() {
            let Some(feature) = features[side].map(|i| &part.features[i]) else { continue };
            let edge = edge(part, !patches[1 - side].is_sharp());
            // Two faces may be slightly tilted while all corners are within reach.
            let tilt = (FLAT_CONTACT_SINE + 4.0 * (self.within + meeting.gap.abs()) / part.bound).min(0.1)
                * part.bound;
            let place = pose.local(meeting.on[side]);
            if feature.margin(place) < -edge {
                return;
            }
            let normal = pose.orientation.conjugate() * normal;
            if part.bound * feature.slack(place, normal) < -edge.max(tilt) {
                return;
            }
        }
        let same = SAME_POINT_TOLERANCE * self.a.bound.min(self.b.bound);
        if self.found.iter().any(|touch| is_same(&touch.meeting, &meeting, same)) {
            return;
        }
        let features = [(self.parts[0], features[0]), (self.parts[1], features[1])];
        self.found.push(Touch { patches, meeting, features });
    }

    /// Keeps the contact points that support best: the ends of lines, and the points farthest from each other.
    fn thin_out(&mut self) {
        let lines = |touch: &Touch| match touch.patches {
            [
                Patch::Line { along: u, .. } | Patch::Side { along: u, .. },
                Patch::Line { along: v, .. } | Patch::Side { along: v, .. },
            ] => (self.pa.orientation * u).cross(self.pb.orientation * v).length() < FLAT_CONTACT_SINE,
            _ => false,
        };
        // Parallel lines in contact are supported at their ends, which are separate contact points.
        if self.found.iter().any(|touch| !lines(touch)) {
            let parallel: Vec<bool> = self.found.iter().map(lines).collect();
            let mut parallel = parallel.into_iter();
            self.found.retain(|_| !parallel.next().unwrap_or(false));
        }
        self.found = farthest(std::mem::take(&mut self.found));
    }
}

/// Limits the number of contact points: keeps the points farthest from each other, beginning with the smallest gap.
fn farthest(all: Vec<Touch>) -> Vec<Touch> {
    if all.len() <= MAX_CONTACT_POINTS {
        return all;
    }
    let first = (0..all.len()).min_by(|&i, &j| all[i].meeting.gap.total_cmp(&all[j].meeting.gap));
    let mut kept: Vec<usize> = first.into_iter().collect();
    while kept.len() < MAX_CONTACT_POINTS {
        let far = |i: usize| {
            let place = all[i].meeting.on[0];
            kept.iter().map(|&k| all[k].meeting.on[0].distance(place)).fold(f64::INFINITY, f64::min)
        };
        let mut best = (0.0, None);
        for i in 0..all.len() {
            let distance = far(i);
            if distance > best.0 {
                best = (distance, Some(i));
            }
        }
        match best.1 {
            Some(i) => kept.push(i),
            None => break,
        }
    }
    kept.sort_unstable();
    kept.into_iter().map(|i| all[i]).collect()
}

/// Returns true if two patches need a contact point of their own. Lines and faces touch a face at their ends and corners, which are
/// separate patches. For two logs side by side, the contact of a rim of one log and the side of the other is enough.
fn is_needed(a: &Patch, b: &Patch) -> bool {
    match (a, b) {
        (Patch::Plane { .. }, other) | (other, Patch::Plane { .. }) => {
            matches!(other, Patch::Point { .. } | Patch::Circle { .. })
        }
        _ => !has_no_normal(a, b),
    }
}

/// Returns true if two patches have no common normal where they touch: those of a corner, and two rims that face nearly the same way.
fn has_no_normal(a: &Patch, b: &Patch) -> bool {
    match (a, b) {
        (Patch::Circle { axis: u, .. }, Patch::Circle { axis: v, .. }) => {
            u.dot(*v) > 0.0 && u.cross(*v).length() < PARALLEL_RIM_SINE
        }
        _ => a.has_no_normal_with(b),
    }
}

/// Transforms the patches of some features of a convex part to world axes, relative to an origin. Returns them with the indices of the
/// features.
fn placed(part: &ConvexPart, pose: &Pose, origin: DVec3, features: Vec<usize>) -> Vec<(usize, Patch)> {
    let pose = Pose { location: pose.location - origin, orientation: pose.orientation };
    features.into_iter().map(|i| (i, part.features[i].patch.placed(&pose))).collect()
}

/// Returns the indices of the features of a convex part that extend along `normal` at least as far as `lowest`, m, from the body's center.
fn near_plane(part: &ConvexPart, pose: &Pose, lowest: f64, normal: DVec3) -> Vec<usize> {
    let normal = pose.orientation.conjugate() * normal;
    (0..part.features.len()).filter(|&i| part.features[i].highest(normal, part) >= lowest).collect()
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::super::tests::{ALL_SHAPES, Random, solid};
    use super::*;
    use crate::shape::Shape;

    /// Lists the contact points of two convex parts without shortcuts: by the closest points, and all pairs of features near them.
    fn plain(pair: &mut Pair) {
        let nearest = between(pair.a, pair.pa, pair.b, pair.pb);
        if nearest.gap > pair.within {
            return;
        }
        pair.depth = pair.within + nearest.gap.abs() + SAME_POINT_TOLERANCE * pair.a.bound.min(pair.b.bound);
        let near = |part: &ConvexPart, pose: &Pose, at: DVec3, normal: DVec3| {
            let lowest = pose.local(at).dot(pose.orientation.conjugate() * normal) - pair.depth;
            near_plane(part, pose, lowest, normal)
        };
        let near_a = near(pair.a, pair.pa, nearest.on[0], nearest.normal);
        let near_b = near(pair.b, pair.pb, nearest.on[1], -nearest.normal);
        for is_wanted in [is_needed, has_no_normal] {
            for (i, j) in near_a.iter().flat_map(|i| near_b.iter().map(move |j| (*i, *j))) {
                let (a, b) = (pair.a.features[i].patch, pair.b.features[j].patch);
                if is_wanted(&a.placed(pair.pa), &b.placed(pair.pb)) {
                    pair.add(i, j);
                }
            }
            if !pair.found.is_empty() {
                break;
            }
        }
        pair.thin_out();
    }

    #[test]
    fn touches_are_those_of_all_pairs_of_features() {
        let mut random = Random::new(13);
        let brick = Shape::Box { size: DVec3::new(0.2, 0.1, 0.2) };
        let shapes: Vec<&Shape> = ALL_SHAPES.iter().skip(1).chain([&brick]).collect();
        let (mut found, mut points) = (0, 0);
        for x in &shapes {
            for y in &shapes {
                let (x, y) = (solid(x), solid(y));
                let (a, b) = (&x.parts()[0], &y.parts()[0]);
                for k in 0..120 {
                    let pa = random.pose([0.0, 3.0][k % 2]);
                    // The second body rests on the first, tilted by an angle that becomes smaller. Each sixth pair has an arbitrary pose.
                    let noise = [1e-3, 1e-6, 1e-9, 1e-12, 0.0, 1.0][k % 6];
                    let spin = [0.0, random.number(), std::f64::consts::FRAC_PI_2][k / 6 % 3];
                    let askew = DQuat::from_scaled_axis(noise * random.vector());
                    let orientation = pa.orientation * (askew * DQuat::from_rotation_y(spin)).normalize();
                    let slide = DVec3::new(0.3 * random.number(), 0.0, 0.3 * random.number());
                    let mut pb = Pose { location: pa.point(slide + 3.0 * DVec3::Y), orientation };
                    let apart = between(a, &pa, b, &pb);
                    let way = if noise == 1.0 { apart.normal } else { pa.orientation * DVec3::Y };
                    let top = a.support(DVec3::Y).y - b.support(-DVec3::Y).y;
                    let flush = if noise == 1.0 { apart.gap } else { 3.0 - top };
                    pb.location -= (flush + noise.min(1e-3) * random.number()) * way;
                    let within = [1e-3, 1e-5, 1e-8][k / 18 % 3];
                    let pair = || {
                        let (depth, found) = (f64::INFINITY, Vec::new());
                        Pair { a, pa: &pa, b, pb: &pb, parts: [0, 0], within, depth, found }
                    };
                    let (mut quick, mut plainly) = (Vec::new(), pair());
                    pair().add_to(&mut quick);
                    plain(&mut plainly);
                    assert_eq!(format!("{quick:?}"), format!("{:?}", plainly.found), "{pa:?} {pb:?}");
                    found += usize::from(!quick.is_empty());
                    points += quick.len();
                }
            }
        }
        assert!(found > 2_000 && points > 5_000, "{found} {points}");
    }
}
