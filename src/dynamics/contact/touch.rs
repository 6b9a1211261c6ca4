//! All places at which two solids touch.

use glam::DVec3;

use super::feature::Feature;
use super::nearest::{EDGE, Nearest, apart, ball_and, between, edge, for_pairs, margin};
use super::patch::{Patch, meet, meet_placed};
use super::solid::{Core, Part, Pose, Solid};

/// A flat end lies flat if the sine of its tilt is smaller.
const FLAT: f64 = 1e-7;
/// Two places closer than this part of the size are one.
const SAME: f64 = 1e-6;
/// The most places kept for a pair of parts: enough to hold one on the other.
const MOST: usize = 8;

/// A place at which two solids touch or nearly touch.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct Touch {
    /// The surface of each body around it, in the axes of that body.
    pub patches: [Patch; 2],
    /// The nearest places of the two surfaces.
    pub meeting: Nearest,
    /// For each body, the indices of its part and of the feature there. A single place of a rim has no feature.
    features: [(usize, Option<usize>); 2],
}

/// All places at which two solids are closer than `within`, m, which must be small compared to their sizes. Each is
/// listed once, in a deterministic order.
pub(in crate::dynamics) fn touches(a: &Solid, pa: &Pose, b: &Solid, pb: &Pose, within: f64) -> Vec<Touch> {
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
        // Triangles share their edges and corners.
        let same = SAME * a.size().min(b.size());
        let mut once: Vec<Touch> = Vec::new();
        for touch in all {
            if !once.iter().any(|other| is_same(&other.meeting, &touch.meeting, same)) {
                once.push(touch);
            }
        }
        // At two corners, the meeting with the adjacent triangle's normal counts instead.
        let is_smooth = |touch: &Touch| !touch.patches[0].has_no_normal_with(&touch.patches[1]);
        if once.iter().any(is_smooth) {
            once.retain(is_smooth);
        }
        return farthest(once);
    }
    all
}

/// Whether two meetings are the same place.
fn is_same(a: &Nearest, b: &Nearest, same: f64) -> bool {
    a.on[1].distance(b.on[1]) < same && a.normal.dot(b.normal) > 1.0 - SAME
}

/// The distance of a touch from the borders of its features, m; negative outside, infinite without borders.
///
/// A touch that is 1e-9 sizes outside counts as inside, so that faces of the same size can lie on each other.
pub(in crate::dynamics) fn inside(touch: &Touch, a: &Solid, pa: &Pose, b: &Solid, pb: &Pose) -> f64 {
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
        // A round body that rolls from an edge to a face leaves the edge's normals before its places. Against a flat
        // face the normals do not matter: corners touch it at any tilt.
        if !matches!(touch.patches[1 - side], Patch::Plane { .. }) && sum > 0.0 {
            let normal = if side == 0 { meeting.normal } else { -meeting.normal };
            let slack = feature.slack(place, pose.orientation.conjugate() * normal);
            least = least.min(sum * (slack + EDGE));
        }
    }
    least
}

/// Two convex parts and their touches.
struct Pair<'a> {
    a: &'a Part,
    pa: &'a Pose,
    b: &'a Part,
    pb: &'a Pose,
    parts: [usize; 2],
    within: f64,
    /// Places that overlap by more than twice this are on the far side of a part, m.
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

    /// The corners and rims of a part that are near the ground.
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

    /// All pairs of features at which two convex parts touch.
    fn convex(&mut self) {
        let nearest = between(self.a, self.pa, self.b, self.pb);
        if nearest.gap > self.within {
            return;
        }
        self.depth = self.within + nearest.gap.abs() + SAME * self.a.bound.min(self.b.bound);
        let near_a = near_plane(self.a, self.pa, nearest.on[0], nearest.normal, self.depth);
        let near_b = near_plane(self.b, self.pb, nearest.on[1], -nearest.normal, self.depth);
        // Each feature is placed once, not for each pair.
        let near_a = placed(self.a, self.pa, self.pa.location, near_a);
        let near_b = placed(self.b, self.pb, self.pa.location, near_b);
        self.add_where(&near_a, &near_b, is_needed);
        if self.found.is_empty() {
            // A corner touches a corner or an edge: neither has a normal there.
            self.add_where(&near_a, &near_b, Patch::has_no_normal_with);
        }
    }

    /// Adds the touches of all wanted pairs of features, which are placed around the first body.
    fn add_where(
        &mut self,
        near_a: &[(usize, Patch)],
        near_b: &[(usize, Patch)],
        is_wanted: fn(&Patch, &Patch) -> bool,
    ) {
        let origin = self.pa.location;
        for (i, a) in near_a {
            for (j, b) in near_b {
                if !is_wanted(a, b) {
                    continue;
                }
                let meeting = meet_placed(a, b);
                if self.is_within_reach(&meeting) || a.is_rim() || b.is_rim() {
                    self.add_met(*i, *j, meeting.moved(origin));
                }
            }
        }
    }

    /// Adds the touches of a pair of features, if there are any.
    fn add(&mut self, i: usize, j: usize) {
        let (a, b) = (&self.a.features[i].patch, &self.b.features[j].patch);
        self.add_met(i, j, meet(a, self.pa, b, self.pb));
    }

    /// The same for two features whose patches meet there.
    fn add_met(&mut self, i: usize, j: usize, meeting: Nearest) {
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

    /// Whether a rim of one body lies flat on a plane of the other.
    fn is_flat(&self, rim: &Patch, normal: DVec3, of_second: bool) -> bool {
        let (own, other) = if of_second { (self.pb, self.pa) } else { (self.pa, self.pb) };
        match *rim {
            Patch::Circle { axis, .. } => {
                (own.orientation * axis).cross(other.orientation * normal).length() < FLAT
            }
            _ => false,
        }
    }

    /// Places that represent a rim that lies flat on a face: four around it, and those where it crosses an edge of the
    /// face.
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

    /// Whether patches touch at a meeting, and not on the far sides of the parts.
    fn is_within_reach(&self, meeting: &Nearest) -> bool {
        (-2.0 * self.depth..=self.within).contains(&meeting.gap)
    }

    /// Adds the touch of a place of a rim and a face, if the bodies touch there and it is new.
    fn keep_rim(&mut self, patches: [Patch; 2], features: [Option<usize>; 2]) {
        let meeting = meet(&patches[0], self.pa, &patches[1], self.pb);
        self.keep(patches, features, meeting);
    }

    /// Adds the touch of a pair of patches that meet there, if the bodies touch there and it is new.
    fn keep(&mut self, patches: [Patch; 2], features: [Option<usize>; 2], meeting: Nearest) {
        if !self.is_within_reach(&meeting) {
            return;
        }
        let parts = [(self.a, self.pa, meeting.normal), (self.b, self.pb, -meeting.normal)];
        for (side, (part, pose, normal)) in parts.into_iter().enumerate() {
            let Some(feature) = features[side].map(|i| &part.features[i]) else { continue };
            let edge = edge(part, !patches[1 - side].is_sharp());
            // A face on a face may be tilted a little while all its corners are within reach.
            let tilt = (FLAT + 4.0 * (self.within + meeting.gap.abs()) / part.bound).min(0.1) * part.bound;
            let place = feature.margin(pose.local(meeting.on[side]));
            if place < -edge || margin(feature, pose, meeting.on[side], normal, part.bound) < -edge.max(tilt)
            {
                return;
            }
        }
        let same = SAME * self.a.bound.min(self.b.bound);
        if self.found.iter().any(|touch| is_same(&touch.meeting, &meeting, same)) {
            return;
        }
        let features = [(self.parts[0], features[0]), (self.parts[1], features[1])];
        self.found.push(Touch { patches, meeting, features });
    }

    /// Keeps the most supportive places: the ends of lines, and those farthest from each other.
    fn thin_out(&mut self) {
        let lines = |touch: &Touch| match touch.patches {
            [
                Patch::Line { along: u, .. } | Patch::Side { along: u, .. },
                Patch::Line { along: v, .. } | Patch::Side { along: v, .. },
            ] => (self.pa.orientation * u).cross(self.pb.orientation * v).length() < FLAT,
            _ => false,
        };
        // Touching parallel lines are held at their ends, which are separate places.
        if self.found.iter().any(|touch| !lines(touch)) {
            let parallel: Vec<bool> = self.found.iter().map(lines).collect();
            let mut parallel = parallel.into_iter();
            self.found.retain(|_| !parallel.next().unwrap_or(false));
        }
        self.found = farthest(std::mem::take(&mut self.found));
    }
}

/// If there are too many touches, keeps those farthest from each other, beginning with the smallest gap.
fn farthest(all: Vec<Touch>) -> Vec<Touch> {
    if all.len() <= MOST {
        return all;
    }
    let first = (0..all.len()).min_by(|&i, &j| all[i].meeting.gap.total_cmp(&all[j].meeting.gap));
    let mut kept: Vec<usize> = first.into_iter().collect();
    while kept.len() < MOST {
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

/// Whether two patches need their own touch. A line or a face on a face touches at its ends or corners, which are
/// separate patches.
fn is_needed(a: &Patch, b: &Patch) -> bool {
    match (a, b) {
        (Patch::Plane { .. }, other) | (other, Patch::Plane { .. }) => {
            matches!(other, Patch::Point { .. } | Patch::Circle { .. })
        }
        _ => !a.has_no_normal_with(b),
    }
}

/// Some features of a part with their patches, in world axes, relative to an origin.
fn placed(part: &Part, pose: &Pose, origin: DVec3, features: Vec<usize>) -> Vec<(usize, Patch)> {
    let pose = Pose { location: pose.location - origin, orientation: pose.orientation };
    features.into_iter().map(|i| (i, part.features[i].patch.placed(&pose))).collect()
}

/// The indices of the features of a part that reach along `normal` at least as far as the point `at`, less `depth` (m).
fn near_plane(part: &Part, pose: &Pose, at: DVec3, normal: DVec3, depth: f64) -> Vec<usize> {
    let (at, normal) = (pose.local(at), pose.orientation.conjugate() * normal);
    let lowest = at.dot(normal) - depth;
    (0..part.features.len()).filter(|&i| part.features[i].highest(normal, part) >= lowest).collect()
}
