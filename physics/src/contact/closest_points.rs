//! The closest points and the gap of two solids.

use glam::DVec3;

use super::feature::Feature;
use super::gjk;
use super::patch::{Patch, meet, meet_placed};
use super::solid::{ConvexPart, Core, Pose, Solid};

/// A feature is near a guessed point if their distance is below this fraction of the convex part's size. The guesses of GJK are better than
/// this, except for overlapping round parts.
const GUESS_TOLERANCE: f64 = 1e-3;
/// A point counts as on a feature if it lies outside by at most this fraction of the convex part's size. The resulting error of the gap is
/// only about the square of this fraction.
pub(super) const FEATURE_TOLERANCE: f64 = 1e-9;
/// If the other body is round, a point counts as on a triangle if it lies outside by at most this fraction of the size. Adjacent triangles
/// at a slight angle would otherwise leave a crack.
const SEAM_TOLERANCE: f64 = 1e-7;
/// The search among the triangles of a mesh begins with triangles that are nearer than this fraction of the smaller body's size.
const INITIAL_SEARCH_DISTANCE: f64 = 0.25;
/// Convex parts overlap deeply if they do by more than this fraction of the smaller one's size.
pub(super) const DEEP_OVERLAP: f64 = 1e-3;
/// The largest distance of the closest points of deeply overlapping parts from the center of each part, relative to its size.
const MAX_DISTANCE_IF_DEEP: f64 = 10.0;
/// The largest number of pairs of features of two convex parts that are compared without a guess by GJK.
const MAX_PAIRS_WITHOUT_GUESS: usize = 16;

/// The closest points of two solids, with their gap and normal. For overlapping solids, these are the points of deepest penetration: the
/// smallest motion that separates the solids moves one point onto the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosestPoints {
    /// The gap, m. For overlapping solids, it is minus the penetration depth.
    pub gap: f64,
    /// The unit normal at the closest points, from the first solid to the second, world axes.
    pub normal: DVec3,
    /// The closest point on the first solid and on the second, world axes, m.
    pub on: [DVec3; 2],
}

impl ClosestPoints {
    /// Returns the same closest points with the two solids swapped.
    pub(super) fn flipped(self) -> ClosestPoints {
        ClosestPoints { gap: self.gap, normal: -self.normal, on: [self.on[1], self.on[0]] }
    }

    /// Returns the same closest points, translated by a vector.
    pub(super) fn moved(self, by: DVec3) -> ClosestPoints {
        ClosestPoints { on: self.on.map(|place| place + by), ..self }
    }
}

/// Computes the closest points of two solids. `None` if their gap exceeds `beyond`, m.
///
/// A small gap is exact to within rounding errors. No returned gap is larger than the true one.
pub(crate) fn nearest(a: &Solid, pa: &Pose, b: &Solid, pb: &Pose, beyond: f64) -> Option<ClosestPoints> {
    let mut best: Option<ClosestPoints> = None;
    let mut within = if a.is_surface() || b.is_surface() {
        INITIAL_SEARCH_DISTANCE * a.size().min(b.size())
    } else {
        beyond
    };
    loop {
        for_pairs(a, pa, b, pb, within, &mut |i, j| {
            let (part_a, part_b) = (&a.parts()[i], &b.parts()[j]);
            if apart(part_a, pa, part_b, pb) <= best.map_or(beyond, |best| best.gap.min(beyond)) {
                let found = between(part_a, pa, part_b, pb);
                if found.gap <= beyond && best.is_none_or(|best| found.gap < best.gap) {
                    best = Some(found);
                }
            }
        });
        // Triangles outside this range are farther away than the best pair found.
        if best.is_some_and(|best| best.gap <= within) || within >= beyond || !within.is_finite() {
            return best.filter(|best| best.gap.is_finite());
        }
        within *= 4.0;
    }
}

/// Calls `look` with the indices of all pairs of convex parts whose gap may be below `within`, m, in ascending order.
pub(super) fn for_pairs(
    a: &Solid,
    pa: &Pose,
    b: &Solid,
    pb: &Pose,
    within: f64,
    look: &mut dyn FnMut(usize, usize),
) {
    match (a.tree(), b.tree()) {
        (_, Some(tree)) => {
            for (i, part) in a.parts().iter().enumerate() {
                for j in tree.near(part.box_in(pa, pb), within, b.parts().len()) {
                    look(i, j);
                }
            }
        }
        (Some(_), None) => {
            let mut pairs = Vec::new();
            for_pairs(b, pb, a, pa, within, &mut |j, i| pairs.push((i, j)));
            pairs.sort_unstable();
            pairs.into_iter().for_each(|(i, j)| look(i, j));
        }
        (None, None) => {
            for i in 0..a.parts().len() {
                for j in 0..b.parts().len() {
                    look(i, j);
                }
            }
        }
    }
}

/// Returns a lower bound of the gap of two convex parts, m: the gap of their bounding balls.
pub(super) fn apart(a: &ConvexPart, pa: &Pose, b: &ConvexPart, pb: &Pose) -> f64 {
    match (&a.core, &b.core) {
        (Core::Ground { .. }, Core::Ground { .. }) => f64::INFINITY,
        (Core::Ground { at, normal }, _) => above(pa, *at, *normal, pb.point(b.centre)) - b.bound,
        (_, Core::Ground { at, normal }) => above(pb, *at, *normal, pa.point(a.centre)) - a.bound,
        _ => (pb.point(b.centre) - pa.point(a.centre)).length() - a.bound - b.bound,
    }
}

fn above(pose: &Pose, at: DVec3, normal: DVec3, place: DVec3) -> f64 {
    (place - pose.point(at)).dot(pose.orientation * normal)
}

/// Computes the closest points of two convex parts.
pub(super) fn between(a: &ConvexPart, pa: &Pose, b: &ConvexPart, pb: &Pose) -> ClosestPoints {
    match (&a.core, &b.core) {
        (Core::Ground { at, normal }, _) => on_ground(pa, *at, *normal, b, pb),
        (_, Core::Ground { at, normal }) => on_ground(pb, *at, *normal, a, pa).flipped(),
        _ => match (a.ball(), b.ball()) {
            (Some(_), Some(_)) => meet(&a.features[0].patch, pa, &b.features[0].patch, pb),
            (Some(_), None) => ball_and(a, pa, b, pb).0,
            (None, Some(_)) => ball_and(b, pb, a, pa).0.flipped(),
            (None, None) => convex(a, pa, b, pb),
        },
    }
}

/// Computes the closest points of the ground, which comes first, and a convex part.
fn on_ground(ground: &Pose, at: DVec3, normal: DVec3, part: &ConvexPart, pose: &Pose) -> ClosestPoints {
    let normal = ground.orientation * normal;
    // Coordinates are relative to the ground, to keep precision far from the origin.
    let shift = pose.location - ground.location;
    let lowest = pose.orientation * part.support(-(pose.orientation.conjugate() * normal));
    let gap = (shift + lowest - ground.orientation * at).dot(normal);
    let place = pose.location + lowest;
    ClosestPoints { gap, normal, on: [place - gap * normal, place] }
}

/// Returns the distance outside a feature at which a point still counts as on the feature, m. `round` is true if the other body is round
/// there.
pub(super) fn edge(part: &ConvexPart, round: bool) -> f64 {
    part.bound * if round && part.surface.is_some() { SEAM_TOLERANCE } else { FEATURE_TOLERANCE }
}

/// Computes the closest points of a ball and a convex part, and the index of the part's feature at its closest point.
pub(super) fn ball_and(
    ball: &ConvexPart,
    pose: &Pose,
    part: &ConvexPart,
    at: &Pose,
) -> (ClosestPoints, usize) {
    let patch = &ball.features[0].patch;
    // The ball is moved into the body axes of the convex part, so the features of the part need no rotation.
    let centre = at.local(pose.point(ball.centre));
    let local = Patch::Point { at: centre, radius: ball.radius };
    // Adjacent triangles can meet at a slight angle, which leaves a crack for a ball.
    let edge = -(edge(part, true) + if part.surface.is_some() { SEAM_TOLERANCE * ball.radius } else { 0.0 });
    if let Some(i) = part.half.and_then(|half| feature_of_box(centre - part.centre, half, -edge)) {
        return (meet(patch, pose, &part.features[i].patch, at), i);
    }
    let mut best: Option<(f64, f64, usize)> = None;
    for (i, feature) in part.features.iter().enumerate().filter(|(_, feature)| !feature.is_seam) {
        let found = meet_placed(&local, &feature.patch);
        let slack = part.bound * feature.slack(found.on[1], -found.normal);
        let inside = feature.margin(found.on[1]).min(slack).clamp(edge, 0.0);
        // At the border of two features, rounding may place the point outside both. Then the nearer feature counts.
        let better = best.is_none_or(|(other, gap, _)| {
            let (is_in, was_in) = (inside > edge, other > edge);
            is_in && !was_in || is_in == was_in && if is_in { found.gap > gap } else { inside > other }
        });
        if better {
            best = Some((inside, found.gap, i));
        }
        // If the center of the ball is outside of a convex part, only one feature contains the closest point.
        if inside == 0.0 && found.gap + ball.radius > 0.0 && part.surface.is_none() {
            break;
        }
    }
    let (inside, i) = best.map_or((edge, 0), |(inside, _, i)| (inside, i));
    let found = meet(patch, pose, &part.features[i].patch, at);
    // The closest point is outside of this triangle, so another triangle is nearer and this one does not count.
    let gap = if part.surface.is_some() && inside <= edge { f64::INFINITY } else { found.gap };
    (ClosestPoints { gap, ..found }, i)
}

/// Returns the index of the feature of a box that is nearest to a point outside, given from the center of the box. `None` inside the box,
/// and within `edge` of the border between two features, m. The features are in the order of
/// [`features_of_box`](super::feature::features_of_box).
fn feature_of_box(place: DVec3, half: DVec3, edge: f64) -> Option<usize> {
    let (beyond, place) = ((place.abs() - half).to_array(), place.to_array());
    if beyond.iter().any(|beyond| beyond.abs() <= edge) {
        return None;
    }
    let is_out = |axis: usize| usize::from(beyond[axis] > 0.0);
    let is_high = |axis: usize| usize::from(place[axis] > 0.0);
    match [is_out(0), is_out(1), is_out(2)] {
        [0, 0, 0] => None,
        [1, 0, 0] => Some(is_high(0)),
        [0, 1, 0] => Some(2 + is_high(1)),
        [0, 0, 1] => Some(4 + is_high(2)),
        [0, 1, 1] => Some(6 + 2 * is_high(1) + is_high(2)),
        [1, 0, 1] => Some(10 + 2 * is_high(2) + is_high(0)),
        [1, 1, 0] => Some(14 + 2 * is_high(0) + is_high(1)),
        _ => Some(18 + 4 * is_high(0) + 2 * is_high(1) + is_high(2)),
    }
}

/// Computes the closest points of two convex parts.
///
/// The gap is the largest separation along any unit vector n (C. Ericson, *Real-Time Collision Detection* (2005), 5.2), and the right n is
/// the normal of some pair of features. The largest separation along the normals of all pairs is therefore the gap, exact to rounding
/// errors, with its sign. If GJK gives a guess, only the features near the guess are tried first.
fn convex(a: &ConvexPart, pa: &Pose, b: &ConvexPart, pb: &Pose) -> ClosestPoints {
    if let Some(found) = faces(a, pa, b, pb) {
        return found;
    }
    let mut search = Search::new(a, pa, b, pb);
    if a.features.len() * b.features.len() > MAX_PAIRS_WITHOUT_GUESS
        && let Some(guess) = gjk::cores(a, pa, b, pb)
    {
        let tolerance = GUESS_TOLERANCE * a.bound.max(b.bound);
        let places = [pa.local(guess.on[0]), pb.local(guess.on[1])];
        let radii = [a.radius, b.radius];
        search.pairs(|i, feature| feature.is_near(places[i], radii[i], tolerance));
        if let Some(found) = search.answer() {
            return found;
        }
        let gap = guess.gap - a.radius - b.radius;
        let on = [guess.on[0] + a.radius * guess.normal, guess.on[1] - b.radius * guess.normal];
        search.consider(ClosestPoints { gap, normal: guess.normal, on });
    }
    search.pairs(|_, _| true);
    match search.best {
        Some((along, found)) => ClosestPoints { gap: along, ..found },
        // No candidate was found, because a coordinate is NaN.
        None => ClosestPoints { gap: f64::NAN, normal: DVec3::X, on: [DVec3::NAN; 2] },
    }
}

/// Returns the patch of a feature. The edges of a triangle can be touched from all sides, since a triangle has no inside.
fn side(part: &ConvexPart, feature: &Feature) -> Patch {
    match feature.patch {
        Patch::Line { at, along, half, radius, .. } if part.surface.is_some() => {
            Patch::Line { at, along, half, radius, outward: DVec3::ZERO }
        }
        patch => patch,
    }
}

/// Computes the closest points of two boxes with parallel edges. `None` unless the boxes are nearest at two faces.
fn faces(a: &ConvexPart, pa: &Pose, b: &ConvexPart, pb: &Pose) -> Option<ClosestPoints> {
    let (of_a, of_b) = (a.half?, b.half?);
    if pa.orientation != pb.orientation {
        return None;
    }
    let apart = pa.orientation.conjugate() * (pb.location - pa.location) + b.centre - a.centre;
    let gaps = apart.abs() - of_a - of_b;
    let axis = (0..3).max_by(|&i, &j| gaps[i].total_cmp(&gaps[j]))?;
    if (0..3).any(|other| other != axis && gaps[other] > 0.0) {
        return None;
    }
    let sign = if apart[axis] < 0.0 { -1.0 } else { 1.0 };
    // The center of the overlap of the two faces.
    let mut place = 0.5 * ((-of_a).max(apart - of_b) + of_a.min(apart + of_b));
    place[axis] = sign * of_a[axis];
    let mut normal = DVec3::ZERO;
    normal[axis] = sign;
    let on = pa.point(a.centre + place);
    let normal = pa.orientation * normal;
    Some(ClosestPoints { gap: gaps[axis], normal, on: [on, on + gaps[axis] * normal] })
}

/// The search for the normal along which two convex parts have the largest separation.
struct Search<'a> {
    a: &'a ConvexPart,
    pa: &'a Pose,
    b: &'a ConvexPart,
    pb: &'a Pose,
    /// The largest separation so far, m, and the closest points whose normal gives it.
    best: Option<(f64, ClosestPoints)>,
    /// A bound of the rounding error of a distance between the convex parts, m.
    digits: f64,
    /// The corners of the cores that were farthest along the last normal for which the separation was needed. `None` for a round core.
    last: [Option<DVec3>; 2],
}

/// A feature whose patch is transformed once for all pairs: to world axes, relative to the first body.
struct Placed<'a> {
    feature: &'a Feature,
    patch: Patch,
    /// The separation along the normal of a face, m, if it is known. All pairs with this face share it.
    separation: Option<f64>,
}

impl<'a> Search<'a> {
    fn new(a: &'a ConvexPart, pa: &'a Pose, b: &'a ConvexPart, pb: &'a Pose) -> Search<'a> {
        let digits = 1e-14 * (a.bound + b.bound + (pb.location - pa.location).length());
        Search { a, pa, b, pb, best: None, digits, last: [None; 2] }
    }

    /// Places the features of a part that `is_wanted` accepts.
    fn placed(
        &self,
        part: &'a ConvexPart,
        pose: &Pose,
        is_wanted: impl Fn(&Feature) -> bool,
    ) -> Vec<Placed<'a>> {
        let pose = Pose { location: pose.location - self.pa.location, orientation: pose.orientation };
        let wanted = part.features.iter().filter(|feature| is_wanted(feature));
        let place = |feature| Placed { feature, patch: side(part, feature).placed(&pose), separation: None };
        wanted.map(place).collect()
    }

    /// Compares the pairs of all features that `is_wanted` accepts. Its first argument is 0 for a feature of the first part, else 1.
    fn pairs(&mut self, is_wanted: impl Fn(usize, &Feature) -> bool) {
        let mut of_a = self.placed(self.a, self.pa, |feature| is_wanted(0, feature));
        let mut of_b = self.placed(self.b, self.pb, |feature| is_wanted(1, feature));
        let origin = self.pa.location;
        for x in &mut of_a {
            for y in &mut of_b {
                // The normal of a pair with a face is that of the face.
                let face = match (x.patch, y.patch) {
                    (Patch::Plane { normal, .. }, _) => Some((&mut x.separation, normal)),
                    (_, Patch::Plane { normal, .. }) => Some((&mut y.separation, -normal)),
                    _ => None,
                };
                if let Some((known, normal)) = face {
                    let along = *known.get_or_insert_with(|| self.separation(normal));
                    if along > self.floor() {
                        self.best_of(along, meet_placed(&x.patch, &y.patch).moved(origin));
                    }
                    continue;
                }
                let found = meet_placed(&x.patch, &y.patch).moved(origin);
                let has_no_normal = x.feature.patch.has_no_normal_with(&y.feature.patch);
                if has_no_normal && self.is_nearest(x.feature, y.feature, &found) {
                    self.best_of(found.gap, found);
                } else {
                    self.consider(found);
                }
            }
        }
    }

    /// Returns true if the convex parts are nearest at a corner and another corner, an edge or a rim: the points and the normal belong to
    /// the two features. The gap is then exact. The normal is less accurate: its rounding error grows as the gap shrinks, so the
    /// separation along it would be too small.
    fn is_nearest(&self, of_a: &Feature, of_b: &Feature, found: &ClosestPoints) -> bool {
        let lost = (1e-6 + self.digits / found.gap.max(f64::MIN_POSITIVE)).min(1.0);
        [(of_a, self.pa, self.a, 0, 1.0), (of_b, self.pb, self.b, 1, -1.0)].into_iter().all(
            |(feature, pose, part, side, sign)| {
                let place = pose.local(found.on[side]);
                let normal = pose.orientation.conjugate() * (sign * found.normal);
                feature.margin(place) > -FEATURE_TOLERANCE * part.bound
                    && feature.slack(place, normal) > -lost
            },
        )
    }

    /// Returns the separation at or below which no candidate becomes the best, m.
    fn floor(&self) -> f64 {
        self.best.map_or(f64::NEG_INFINITY, |(best, _)| best - self.digits)
    }

    fn consider(&mut self, found: ClosestPoints) {
        // The separation along a normal is at most that of any two corners. Rounding keeps this order.
        if let [Some(a), Some(b)] = self.last {
            let [local_a, local_b] = self.local(found.normal);
            if self.between_supports(found.normal, a.dot(local_a), b.dot(local_b)) <= self.floor() {
                return;
            }
        }
        let along = self.separation(found.normal);
        self.best_of(along, found);
    }

    fn best_of(&mut self, along: f64, found: ClosestPoints) {
        let digits = self.digits;
        // Of several candidates with the same separation, the one whose gap is closest to this separation counts.
        let better = self.best.is_none_or(|(other, nearest)| {
            along > other + digits
                || along > other - digits && (found.gap - along).abs() < (nearest.gap - other).abs() - digits
        });
        if better && !along.is_nan() {
            self.best = Some((along, found));
        }
    }

    /// Returns the best candidate if it is certain: its gap is the separation along its normal, and its points are on the convex parts. The
    /// points of a deep overlap may lie outside of the features, but only near the parts. Almost parallel sides cross far from both parts.
    fn answer(&self) -> Option<ClosestPoints> {
        let (along, found) = self.best?;
        let is_exact = (found.gap - along).abs() <= 4.0 * self.digits;
        let is_deep = along < -DEEP_OVERLAP * self.a.bound.min(self.b.bound);
        let is_certain = |(part, pose, place): (&ConvexPart, &Pose, DVec3)| {
            let place = pose.local(place);
            if is_deep {
                place.distance(part.centre) <= MAX_DISTANCE_IF_DEEP * part.bound
            } else {
                part.features.iter().any(|feature| feature.holds(place, FEATURE_TOLERANCE * part.bound))
            }
        };
        let parts = [(self.a, self.pa, found.on[0]), (self.b, self.pb, found.on[1])];
        (is_exact && parts.into_iter().all(is_certain)).then_some(ClosestPoints { gap: along, ..found })
    }

    /// Returns a vector from the first part to the second in the body axes of the first, and the opposite vector in those of the second.
    fn local(&self, normal: DVec3) -> [DVec3; 2] {
        [self.pa.orientation.conjugate() * normal, -(self.pb.orientation.conjugate() * normal)]
    }

    /// Computes the separation of the convex parts along a unit vector from the first to the second, m. It is negative if their projections
    /// overlap.
    fn separation(&mut self, normal: DVec3) -> f64 {
        let [local_a, local_b] = self.local(normal);
        let (high_a, high_b) = (self.a.core.support(local_a), self.b.core.support(local_b));
        let corner = |part: &ConvexPart, at: DVec3| matches!(part.core, Core::Hull(_)).then_some(at);
        self.last = [corner(self.a, high_a), corner(self.b, high_b)];
        self.between_supports(normal, high_a.dot(local_a), high_b.dot(local_b))
    }

    /// Computes the separation along a unit vector from the heights of the cores along it, m.
    fn between_supports(&self, normal: DVec3, high_a: f64, high_b: f64) -> f64 {
        (self.pb.location - self.pa.location).dot(normal) - high_a - high_b - self.a.radius - self.b.radius
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{ALL_SHAPES, Random, solid};
    use super::*;

    impl Search<'_> {
        /// Compares all pairs of features as [`Search::pairs`] does, without its shortcuts.
        fn plain_pairs(&mut self) {
            for x in &self.a.features {
                for y in &self.b.features {
                    let found = meet(&side(self.a, x), self.pa, &side(self.b, y), self.pb);
                    if x.patch.has_no_normal_with(&y.patch) && self.is_nearest(x, y, &found) {
                        self.best_of(found.gap, found);
                    } else {
                        let along = self.separation(found.normal);
                        self.best_of(along, found);
                    }
                }
            }
        }
    }

    #[test]
    fn the_search_finds_what_the_comparison_of_all_pairs_finds() {
        let mut random = Random::new(12);
        for a in &ALL_SHAPES {
            for b in &ALL_SHAPES {
                let (a, b) = (solid(a), solid(b));
                let (a, b) = (&a.parts()[0], &b.parts()[0]);
                for k in 0..60 {
                    let pa = random.pose(0.3);
                    let mut pb = random.pose([0.3, 1.0, 2.0][k % 3]);
                    if k % 2 == 0 {
                        pb.orientation = pa.orientation;
                    }
                    let (mut search, mut plain) = (Search::new(a, &pa, b, &pb), Search::new(a, &pa, b, &pb));
                    search.pairs(|_, _| true);
                    plain.plain_pairs();
                    assert_eq!(format!("{:?}", search.best), format!("{:?}", plain.best), "{pa:?} {pb:?}");
                }
            }
        }
    }
}
