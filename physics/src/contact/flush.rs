//! Bodies that lie flush: one slides along a face of another, over its border, without hitting what lies flush behind it.
//!
//! A box that slides over a row of equal boxes touches the next one first at an edge, at which the normal is not unique. The normal along the
//! motion would make the box trip, although nothing is in its way: a plane separates the two, and the box moves along it. Source: E. Coumans,
//! *Contact generation*, Game Developers Conference (2010), on internal edges.

use std::collections::BTreeMap;

use glam::DVec3;

use super::closest_points::{ClosestPoints, for_pairs};
use super::patch::Patch;
use super::solid::{ConvexPart, Pose, Solid};

/// Two parts touch along a plane if they reach over it, or keep away from it, by less than this fraction of the smaller one's size.
const FLUSH_TOLERANCE: f64 = 1e-5;
/// A normal is perpendicular to a plane's normal if the cosine of the angle between them is below this.
const PERPENDICULAR_COSINE: f64 = 0.1;
/// A normal differs from a plane's normal if the cosine of the angle between them is below this. Where two edges touch, rounding errors can
/// turn the normal to any direction between those of their faces.
const OTHER_COSINE: f64 = 0.99;
/// Two normals are parallel if the cosine of the angle between them is above this.
const PARALLEL_COSINE: f64 = 1.0 - 1e-9;
/// Bodies move along a plane if they close in on it by less than this fraction of the speed at which they close in along the other normal.
const SLIDING_RATIO: f64 = 0.01;
/// Bodies slide if they close in by more than this fraction of their own speeds. Slower rates are what the solver leaves between bodies that
/// move together.
const SLIDING_SPEED: f64 = 1e-3;

/// Contact points, each with the indices of its two bodies.
pub(super) type Places = Vec<([usize; 2], ClosestPoints)>;

/// Returns true if two solids lie flush at a place, along a plane whose normal, from the first solid to the second, `is_wanted` accepts. The
/// cosine of the angle between this normal and the place's normal is below `cosine`. Of compounds, this holds for all parts that meet there.
fn lie_flush(
    solids: [&Solid; 2],
    poses: [&Pose; 2],
    place: &ClosestPoints,
    cosine: f64,
    is_wanted: impl Fn(DVec3) -> bool,
) -> bool {
    let [a, b] = solids;
    // The triangles of a mesh have no borders that stand out. A ball has no edges, and the ground has none.
    let has_borders = |solid: &&Solid| {
        !solid.is_surface() && !solid.is_ball() && !solid.parts().iter().any(ConvexPart::is_ground)
    };
    if !solids.iter().all(has_borders) {
        return false;
    }
    let tolerance = FLUSH_TOLERANCE * a.size().min(b.size());
    let (mut is_near, mut is_flush) = (false, true);
    for_pairs(a, poses[0], b, poses[1], place.gap + tolerance, &mut |i, j| {
        let pair = Pair { parts: [&a.parts()[i], &b.parts()[j]], poses };
        if is_flush && pair.reaches(place, tolerance) {
            is_near = true;
            is_flush = pair.planes().any(|(normal, separation)| {
                separation.abs() <= tolerance && normal.dot(place.normal).abs() < cosine && is_wanted(normal)
            });
        }
    });
    is_near && is_flush
}

/// Returns true if two solids cannot hit each other at a place, because they lie flush along a plane there, and slide along it. `velocities`
/// are those of the two solids at the place, m/s.
pub(super) fn slide_past(
    solids: [&Solid; 2],
    poses: [&Pose; 2],
    place: &ClosestPoints,
    velocities: [DVec3; 2],
) -> bool {
    let velocity = velocities[1] - velocities[0];
    let closing = -velocity.dot(place.normal);
    let is_along = |normal: DVec3| -velocity.dot(normal) <= SLIDING_RATIO * closing;
    closing > SLIDING_SPEED * (velocities[0].length() + velocities[1].length())
        && lie_flush(solids, poses, place, OTHER_COSINE, is_along)
}

/// Returns, for each of all contact points, whether it lies at a seam: a body that forces move lies flush with a plane there, and another body
/// supports it on this plane. `moves` tells whether forces move a body, and `solids` returns the two solids of a contact point with their poses.
pub(super) fn at_seams<'a>(
    places: &Places,
    moves: impl Fn(usize) -> bool,
    solids: impl Fn(usize) -> Option<([&'a Solid; 2], [Pose; 2])>,
) -> Vec<bool> {
    let mut of_bodies: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, (bodies, _)) in places.iter().enumerate() {
        for body in bodies.iter().filter(|body| moves(**body)) {
            of_bodies.entry(*body).or_default().push(number);
        }
    }
    let is_at_seam = |number: usize| {
        let (bodies, place) = &places[number];
        // The contact points of each moving body with others: the point on the body, its gap, and the normal as in this pair.
        let others = |side: usize| {
            let all = of_bodies.get(&bodies[side]).into_iter().flatten().map(|other| &places[*other]);
            all.filter(|(pair, _)| pair != bodies).map(move |(pair, place)| {
                let own = if pair[0] == bodies[side] { 0 } else { 1 };
                (place.on[own], place.gap, if own == side { place.normal } else { -place.normal })
            })
        };
        let across = |normal: DVec3| normal.dot(place.normal).abs() < PERPENDICULAR_COSINE;
        if ![0, 1].into_iter().any(|side| others(side).any(|(_, _, normal)| across(normal))) {
            return false;
        }
        let Some((solids, [p, q])) = solids(number) else { return false };
        let tolerance = FLUSH_TOLERANCE * solids[0].size().min(solids[1].size());
        let is_supported = |plane: DVec3| {
            [0, 1].into_iter().any(|side| {
                others(side).any(|(on, gap, normal)| {
                    let is_level = (on - place.on[side]).dot(plane).abs() <= tolerance;
                    normal.dot(plane) > PARALLEL_COSINE && is_level && gap <= tolerance
                })
            })
        };
        lie_flush(solids, [&p, &q], place, PERPENDICULAR_COSINE, is_supported)
    };
    (0..places.len()).map(is_at_seam).collect()
}

/// Two convex parts with their poses.
struct Pair<'a> {
    parts: [&'a ConvexPart; 2],
    poses: [&'a Pose; 2],
}

impl<'a> Pair<'a> {
    /// Returns true if the closest points are in both parts, as far as their faces tell.
    fn reaches(&self, place: &ClosestPoints, tolerance: f64) -> bool {
        [0, 1].into_iter().all(|side| {
            let (part, on) = (self.parts[side], self.poses[side].local(place.on[side]));
            part.features.iter().all(|feature| match feature.patch {
                Patch::Plane { at, normal } => (on - at).dot(normal) <= tolerance,
                _ => true,
            })
        })
    }

    /// Returns the planes of the faces of both parts: for each, its unit normal from the first part to the second, and how far the parts are
    /// separated along it, m.
    fn planes(&'a self) -> impl Iterator<Item = (DVec3, f64)> + 'a {
        [0, 1].into_iter().flat_map(move |side| {
            let [own, other] = [side, 1 - side].map(|side| (self.parts[side], self.poses[side]));
            own.0.features.iter().filter_map(move |feature| {
                let Patch::Plane { at, normal } = feature.patch else { return None };
                let normal = own.1.orientation * normal;
                let lowest = other.1.point(other.0.support(other.1.orientation.conjugate() * -normal));
                let separation = (lowest - own.1.point(at)).dot(normal);
                Some((if side == 0 { normal } else { -normal }, separation))
            })
        })
    }
}
