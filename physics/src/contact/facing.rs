//! How two boxes that lie on each other face each other: their gap and its normal, by separating axes.
//!
//! Two boxes that overlap have their largest separation along the normal of a face, or along the cross product of two edges. If they do not
//! overlap, the largest separation along these axes is the gap if the closest points lie on a face. Source: S. Gottschalk, M. C. Lin &
//! D. Manocha, *OBBTree: a hierarchical structure for rapid interference detection*, SIGGRAPH (1996) 171.

use glam::DVec3;

use super::closest_points::DEEP_OVERLAP;
use super::feature::Feature;
use super::patch::{Patch, meet_placed};
use super::solid::{ConvexPart, Core, Pose};

/// Two separations count as equal if they differ by less than this fraction of the sizes and the distance of the boxes. This is ten times
/// what rounding errors may amount to.
const SEPARATION_ROUNDING: f64 = 1e-13;
/// A corner counts as lying on an edge of the other box if their distance is below this fraction of the sizes and the distance of the boxes.
/// Rounding errors then hide the normal between the corner and the edge.
const ON_EDGE: f64 = 1e-10;
/// Two unit normals count as equal if their scalar product differs from 1 by less than this.
const NORMAL_TOLERANCE: f64 = 1e-12;
/// Two edges count as parallel if the square of the sine of the angle between them is below this.
const PARALLEL_SINE_SQUARED: f64 = 1e-18;
/// The number of corners of a box.
const BOX_CORNERS: usize = 8;

/// How two boxes face each other.
#[derive(Clone, Copy, Debug)]
pub(super) enum Facing {
    /// The gap exceeds the largest one that matters.
    Apart,
    /// The boxes have this gap, m, along this unit normal from the first box to the second, world axes.
    Near { gap: f64, normal: DVec3 },
}

/// What an axis belongs to.
#[derive(Clone, Copy)]
enum Owner<'a> {
    /// A face of the first box, whose index is 0, or of the second.
    Face(usize, &'a Feature),
    /// For each box, one of the three directions of its edges.
    Edges([usize; 2]),
}

/// The axis of the largest separation so far, in the body axes of the first box.
struct Best<'a> {
    /// The separation of the boxes without their rounding, m.
    along: f64,
    normal: DVec3,
    owner: Owner<'a>,
    /// False if the separation along an axis with another normal is equal.
    is_clear: bool,
    /// The largest difference of equal separations, m.
    equal: f64,
}

impl<'a> Best<'a> {
    fn consider(&mut self, along: f64, normal: DVec3, owner: Owner<'a>) {
        if along <= self.along - self.equal {
            return;
        }
        let is_same = normal.dot(self.normal) > 1.0 - NORMAL_TOLERANCE;
        self.is_clear = along > self.along + self.equal || self.is_clear && is_same;
        if along > self.along {
            (self.along, self.normal, self.owner) = (along, normal, owner);
        }
    }
}

/// Returns how two boxes face each other. `None` if a closer search is needed: for other parts, for deep overlaps, if the boxes may be
/// nearest at corners or parallel edges, and if several normals are equally good. `within` is the largest gap that matters, m.
pub(super) fn facing(a: &ConvexPart, pa: &Pose, b: &ConvexPart, pb: &Pose, within: f64) -> Option<Facing> {
    let (of_a, of_b) = (corners(a)?, corners(b)?);
    // All coordinates are in the body axes of the first box.
    let (turn, shift) = (pa.orientation.conjugate() * pb.orientation, pa.local(pb.location));
    let of_b = of_b.map(|corner| shift + turn * corner);
    let lengths = a.bound + b.bound + a.centre.length() + b.centre.length() + shift.length();
    let (equal, blurred) = (SEPARATION_ROUNDING * lengths, ON_EDGE * lengths);
    let none = f64::NEG_INFINITY;
    let mut best =
        Best { along: none, normal: DVec3::ZERO, owner: Owner::Edges([0; 2]), is_clear: true, equal };
    for feature in &a.features {
        let Patch::Plane { at, normal } = feature.patch else { continue };
        let high = at.dot(normal) - a.radius;
        best.consider(lowest(&of_b, normal) - high, normal, Owner::Face(0, feature));
    }
    for feature in &b.features {
        let Patch::Plane { at, normal } = feature.patch else { continue };
        let high = at.dot(normal) - b.radius;
        let normal = turn * normal;
        best.consider(lowest(of_a, normal) - shift.dot(normal) - high, -normal, Owner::Face(1, feature));
    }
    let radii = a.radius + b.radius;
    if best.along - radii > within + equal {
        return Some(Facing::Apart);
    }
    let along_b = directions(b).map(|along| turn * along);
    for (i, u) in directions(a).into_iter().enumerate() {
        for (j, v) in along_b.into_iter().enumerate() {
            let cross = u.cross(v);
            let square = cross.length_squared();
            if square > PARALLEL_SINE_SQUARED {
                let normal = cross / square.sqrt();
                let ([low_a, high_a], [low_b, high_b]) = (extent(of_a, normal), extent(&of_b, normal));
                best.consider(low_b - high_a, normal, Owner::Edges([i, j]));
                best.consider(low_a - high_b, -normal, Owner::Edges([i, j]));
            }
        }
    }
    let gap = best.along - radii;
    if gap > within + equal {
        return Some(Facing::Apart);
    }
    let normal = best.normal;
    let is_on = |feature: &Feature, place: DVec3| feature.margin(place) >= -equal;
    let local = |place: DVec3| turn.conjugate() * (place - shift);
    let is_nearest = || match best.owner {
        Owner::Face(0, face) => {
            let low = lowest(&of_b, normal) + equal;
            of_b.iter().any(|corner| corner.dot(normal) <= low && is_on(face, *corner))
        }
        Owner::Face(_, face) => {
            let low = lowest(of_a, -normal) + equal;
            of_a.iter().any(|corner| corner.dot(-normal) <= low && is_on(face, local(*corner)))
        }
        Owner::Edges([i, j]) => {
            let pose = Pose { location: shift, orientation: turn };
            edges(a).skip(4 * i).take(4).any(|x| {
                edges(b).skip(4 * j).take(4).any(|y| {
                    let met = meet_placed(&x.patch, &y.patch.placed(&pose));
                    (met.gap - gap).abs() <= equal && is_on(x, met.on[0]) && is_on(y, local(met.on[1]))
                })
            })
        }
    };
    let is_blurred = || {
        is_on_edge(&of_b, a, normal, blurred)
            || is_on_edge(&of_a.map(local), b, turn.conjugate() * -normal, blurred)
    };
    let deep = DEEP_OVERLAP * a.bound.min(b.bound);
    let is_sure = -deep < gap && gap < within - equal && best.is_clear;
    (is_sure && is_nearest() && !is_blurred()).then(|| Facing::Near { gap, normal: pa.orientation * normal })
}

/// Returns true if a corner of another box lies on an edge of a box that is highest along `normal`, to within `blurred`, m.
fn is_on_edge(corners: &[DVec3; BOX_CORNERS], part: &ConvexPart, normal: DVec3, blurred: f64) -> bool {
    let high = part.core.support(normal).dot(normal);
    corners.iter().filter(|corner| corner.dot(normal) <= high + blurred).any(|corner| {
        edges(part).any(|edge| match edge.patch {
            Patch::Line { at, along, half, .. } if at.dot(normal) >= high - blurred => {
                let from = *corner - at;
                let across = from - from.dot(along).clamp(-half, half) * along;
                across.length_squared() <= blurred * blurred
            }
            _ => false,
        })
    })
}

/// Returns the corners of a box without its rounding. `None` for all other parts.
fn corners(part: &ConvexPart) -> Option<&[DVec3; BOX_CORNERS]> {
    match &part.core {
        Core::Hull(corners) if part.surface.is_none() => corners.as_slice().try_into().ok(),
        _ => None,
    }
}

/// Returns the edges of a box. The four edges of each direction follow each other.
fn edges(part: &ConvexPart) -> impl Iterator<Item = &Feature> {
    part.features.iter().filter(|feature| matches!(feature.patch, Patch::Line { .. }))
}

/// Returns the directions of the edges of a box.
fn directions(part: &ConvexPart) -> [DVec3; 3] {
    let mut found = [DVec3::ZERO; 3];
    for (found, edge) in found.iter_mut().zip(edges(part).step_by(4)) {
        if let Patch::Line { along, .. } = edge.patch {
            *found = along;
        }
    }
    found
}

/// Returns how far points extend along a vector at least, m.
fn lowest(places: &[DVec3; BOX_CORNERS], direction: DVec3) -> f64 {
    places.iter().map(|place| place.dot(direction)).fold(f64::INFINITY, f64::min)
}

/// Returns how far points extend along a vector at least and at most, m.
fn extent(places: &[DVec3; BOX_CORNERS], direction: DVec3) -> [f64; 2] {
    places
        .iter()
        .map(|place| place.dot(direction))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}
