//! Patches: simple surfaces that describe a body around a contact point. Finds the closest points of two patches.

mod rim;

use glam::{DQuat, DVec3};

use super::closest_points::ClosestPoints;
use super::solid::Pose;

/// Two directions count as parallel if the sine of the angle between them is below this.
pub(super) const PARALLEL_SINE: f64 = 1e-9;

/// The surface of a body around a contact point, in body axes.
///
/// A patch extends beyond the borders of its edge or face, so the closest points of two patches are smooth functions of the poses.
/// [`inside`](super::touch::inside) gives the distance from the borders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Patch {
    /// A corner, or a ball: a sphere, the end of a capsule, or the corner of a rounded box.
    Point {
        /// The corner, or the center of the ball, body axes, m.
        at: DVec3,
        /// The radius of the ball, m; 0 for a corner.
        radius: f64,
    },
    /// An edge, or the round side of a capsule or cylinder.
    Line {
        /// The middle of the edge or of the axis, body axes, m.
        at: DVec3,
        /// The unit direction of the edge or of the axis.
        along: DVec3,
        /// Half the length of the edge or of the axis, m.
        half: f64,
        /// The distance of the surface from the line, m; 0 for a sharp edge.
        radius: f64,
        /// For an edge, a vector that points out of the body. Zero for a capsule or a cylinder, which are round about the line.
        outward: DVec3,
    },
    /// A flat face.
    Plane {
        /// A point of the face, body axes, m.
        at: DVec3,
        /// The unit normal of the face, out of the body.
        normal: DVec3,
    },
    /// The circular rim of the flat end of a cylinder or a cone.
    Circle {
        /// The center of the rim, body axes, m.
        centre: DVec3,
        /// The unit normal of the flat end, out of the body.
        axis: DVec3,
        /// The radius of the rim, m.
        radius: f64,
    },
    /// The side of a cone, as the envelope of balls around the points of its axis.
    Side {
        /// The middle of the cone's axis, body axes, m.
        at: DVec3,
        /// The unit direction of the cone's axis.
        along: DVec3,
        /// Half the height of the cone, m.
        half: f64,
        /// The radius of the ball around the middle `at`, m.
        radius: f64,
        /// The change of the balls' radius per length along the axis, m/m. For a cone that narrows along the axis, this is minus the sine
        /// of half the opening angle.
        taper: f64,
    },
}

/// A line segment of balls whose envelope is a round surface. A single ball is a segment without a direction.
#[derive(Clone, Copy, Debug)]
struct Spine {
    at: DVec3,
    along: DVec3,
    half: f64,
    radius: f64,
    taper: f64,
    outward: DVec3,
}

impl Patch {
    /// Transforms the patch by a pose: from body axes to the axes in which the pose is given.
    pub(super) fn placed(&self, at_pose: &Pose) -> Patch {
        let (point, turn) = (|p: DVec3| at_pose.point(p), at_pose.orientation);
        match *self {
            Patch::Point { at, radius } => Patch::Point { at: point(at), radius },
            Patch::Line { at, along, half, radius, outward } => {
                Patch::Line { at: point(at), along: turn * along, half, radius, outward: turn * outward }
            }
            Patch::Plane { at, normal } => Patch::Plane { at: point(at), normal: turn * normal },
            Patch::Circle { centre, axis, radius } => {
                Patch::Circle { centre: point(centre), axis: turn * axis, radius }
            }
            Patch::Side { at, along, half, radius, taper } => {
                Patch::Side { at: point(at), along: turn * along, half, radius, taper }
            }
        }
    }

    /// Returns true if the surface has no unique normal: for a corner, a sharp edge, or a rim.
    pub(super) fn is_sharp(&self) -> bool {
        match *self {
            Patch::Point { radius, .. } | Patch::Line { radius, .. } => radius == 0.0,
            Patch::Circle { .. } => true,
            Patch::Plane { .. } | Patch::Side { .. } => false,
        }
    }

    /// Returns true if the patch is the rim of a flat end.
    pub(super) fn is_rim(&self) -> bool {
        matches!(self, Patch::Circle { .. })
    }

    /// Returns true if the contact of two patches has no unique normal: neither patch has one, and one of the patches is a corner.
    pub(super) fn has_no_normal_with(&self, other: &Patch) -> bool {
        let corner = |patch: &Patch| matches!(patch, Patch::Point { .. });
        self.is_sharp() && other.is_sharp() && (corner(self) || corner(other))
    }

    /// Returns false if two edges, corners, or round parts of constant radius are certainly farther apart than `within`, m: no point of
    /// the length of one is nearer to the length of the other. `within` must allow for rounding errors.
    pub(super) fn may_reach(&self, other: &Patch, within: f64) -> bool {
        let (Some(a), Some(b)) = (self.spine(), other.spine()) else { return true };
        if a.taper != 0.0 || b.taper != 0.0 {
            return true;
        }
        let (w, cosine, reach) = (b.at - a.at, a.along.dot(b.along).abs(), within + a.radius + b.radius);
        let (on_a, on_b) = (w.dot(a.along), w.dot(b.along));
        if on_a.abs() > a.half + b.half * cosine + reach || on_b.abs() > b.half + a.half * cosine + reach {
            return false;
        }
        // No point of one length is nearer to the line of the other than its middle, less the way it leans there.
        let (sine, square) = ((1.0 - cosine * cosine).max(0.0).sqrt(), w.length_squared());
        let is_near = |on: f64, half: f64| {
            let far = half * sine + reach;
            square - on * on <= far * far
        };
        is_near(on_a, b.half) && is_near(on_b, a.half)
    }

    /// Returns the segment of balls whose envelope is the patch. `None` for planes and rims.
    fn spine(&self) -> Option<Spine> {
        let zero = DVec3::ZERO;
        match *self {
            Patch::Point { at, radius } => {
                Some(Spine { at, along: zero, half: 0.0, radius, taper: 0.0, outward: zero })
            }
            Patch::Line { at, along, half, radius, outward } => {
                Some(Spine { at, along, half, radius, taper: 0.0, outward })
            }
            Patch::Side { at, along, half, radius, taper } => {
                Some(Spine { at, along, half, radius, taper, outward: zero })
            }
            Patch::Plane { .. } | Patch::Circle { .. } => None,
        }
    }
}

/// Computes the closest points of two patches.
///
/// The gap between a corner and a corner, an edge or a rim is never negative, because the normal is not unique there.
pub(crate) fn meet(a: &Patch, pa: &Pose, b: &Patch, pb: &Pose) -> ClosestPoints {
    // Coordinates are relative to the first body, to keep precision far from the origin.
    let origin = pa.location;
    if let (Patch::Point { at: DVec3::ZERO, radius: ra }, Patch::Point { at: DVec3::ZERO, radius: rb }) =
        (a, b)
    {
        return balls(DVec3::ZERO, *ra, pb.location - origin, *rb, DVec3::ZERO).moved(origin);
    }
    let a = a.placed(&Pose { location: DVec3::ZERO, orientation: pa.orientation });
    let b = b.placed(&Pose { location: pb.location - origin, orientation: pb.orientation });
    meet_placed(&a, &b).moved(origin)
}

/// Computes the closest points of two patches in common axes.
pub(super) fn meet_placed(a: &Patch, b: &Patch) -> ClosestPoints {
    match (*a, *b) {
        (Patch::Plane { at, normal }, _) => on_plane(at, normal, b),
        (_, Patch::Plane { at, normal }) => on_plane(at, normal, a).flipped(),
        (Patch::Circle { centre, axis, radius }, Patch::Circle { centre: c, axis: x, radius: r }) => {
            rim::rims(rim::Rim { centre, axis, radius }, rim::Rim { centre: c, axis: x, radius: r })
        }
        (Patch::Circle { centre, axis, radius }, _) => rim_and(rim::Rim { centre, axis, radius }, b),
        (_, Patch::Circle { centre, axis, radius }) => {
            rim_and(rim::Rim { centre, axis, radius }, a).flipped()
        }
        _ => match (a.spine(), b.spine()) {
            (Some(a), Some(b)) => spines(&a, &b),
            // All pairs with a plane or a rim are handled above.
            _ => ClosestPoints { gap: f64::INFINITY, normal: DVec3::X, on: [DVec3::ZERO; 2] },
        },
    }
}

/// Returns the unit vector along the part of `direction` that is perpendicular to the unit vector `axis`. `None` if there is no such part.
///
/// If the two vectors are nearly parallel, much of that part is a rounding error along the axis. Hence the axis is taken out twice. Source:
/// L. Giraud, J. Langou & M. Rozložník, *The loss of orthogonality in the Gram–Schmidt orthogonalization process*, Computers & Mathematics
/// with Applications 50 (2005) 1069.
pub(super) fn radial(direction: DVec3, axis: DVec3) -> Option<DVec3> {
    let once = (direction - direction.dot(axis) * axis).try_normalize()?;
    let twice = once - once.dot(axis) * axis;
    if twice.length_squared() > 0.25 { twice.try_normalize() } else { None }
}

/// Computes the closest points of a plane and a patch. The closest point of a line is its nearer end.
fn on_plane(at: DVec3, normal: DVec3, other: &Patch) -> ClosestPoints {
    let lowest = match *other {
        Patch::Plane { at, .. } => at,
        Patch::Circle { centre, axis, radius } => {
            // If the rim is parallel to the plane, all its points are equally low, so any point will do.
            centre - radius * radial(normal, axis).unwrap_or_else(|| axis.any_orthonormal_vector())
        }
        _ => match other.spine() {
            Some(spine) => spine.lowest(normal),
            None => at,
        },
    };
    let gap = (lowest - at).dot(normal);
    ClosestPoints { gap, normal, on: [lowest - gap * normal, lowest] }
}

/// Computes the closest points of a rim and a point, a line, or the side of a cone.
fn rim_and(rim: rim::Rim, other: &Patch) -> ClosestPoints {
    match other.spine() {
        Some(spine) => rim::rim_and_spine(rim, &spine),
        None => ClosestPoints { gap: f64::INFINITY, normal: rim.axis, on: [rim.centre; 2] },
    }
}

impl Spine {
    /// Returns the point of the surface that is farthest in the direction opposite to the unit vector `normal`.
    fn lowest(&self, normal: DVec3) -> DVec3 {
        let end = |s: f64| self.at + s * self.along - (self.radius + self.taper * s) * normal;
        let ends = [end(self.half), end(-self.half)];
        if ends[1].dot(normal) < ends[0].dot(normal) { ends[1] } else { ends[0] }
    }

    fn is_point(&self) -> bool {
        self.along == DVec3::ZERO
    }
}

/// Computes the closest points of two envelopes of balls.
///
/// The gap of the balls at s and t is |w + t v − s u| − r₁ − r₂ − k₁ s − k₂ t. Let the lines be nearest at (s₀, t₀), at the distance h.
/// With x = (s, t) − (s₀, t₀) and the matrix G of the dot products of the directions, the gap is √(h² + xᵀ G x) − k·x − …, whose minimum
/// is at x = G⁻¹ k h / √(1 − kᵀ G⁻¹ k).
fn spines(a: &Spine, b: &Spine) -> ClosestPoints {
    let w = b.at - a.at;
    if a.is_point() && b.is_point() {
        return balls(a.at, a.radius, b.at, b.radius, DVec3::ZERO);
    }
    if a.is_point() {
        return spines(b, a).flipped();
    }
    let (u, v) = (a.along, b.along);
    let cross = u.cross(v);
    let sine = cross.length();
    if b.is_point() || sine < PARALLEL_SINE {
        // Parallel lines are in contact at the middle of the length that they share, or at their nearer ends.
        let t = if b.is_point() { 0.0 } else { common_middle(a, b, w) };
        let from = w + t * v;
        let s0 = from.dot(u);
        let across = from - s0 * u;
        let h = across.length();
        let taper = a.taper + b.taper * u.dot(v);
        let below = (1.0 - taper * taper).max(0.0).sqrt();
        if below < PARALLEL_SINE {
            return nowhere(a.at + s0 * u, b.at + t * v, across.try_normalize().unwrap_or(DVec3::X));
        }
        let s = s0 + taper * h / below;
        let away = if a.outward == DVec3::ZERO { u.any_orthonormal_vector() } else { a.outward };
        return balls(a.at + s * u, a.radius + a.taper * s, b.at + t * v, b.radius + b.taper * t, away);
    }
    let unit = cross / sine;
    let h = w.dot(unit);
    let cosine = u.dot(v);
    let inverse = |x: f64, y: f64| [(x + cosine * y) / (sine * sine), (cosine * x + y) / (sine * sine)];
    let [s0, t0] = inverse(w.dot(u), -w.dot(v));
    let k = [a.taper, b.taper];
    let steepest = inverse(k[0], k[1]);
    // The outward directions of the two bodies determine the sign of the normal, even if the bodies overlap.
    let out = unit.dot(a.outward - b.outward);
    let sign = if out == 0.0 { 1.0_f64.copysign(h) } else { out.signum() };
    // Since the gap has a sign, it is smooth even when the lines cross each other.
    let below = (1.0 - k[0] * steepest[0] - k[1] * steepest[1]).max(0.0).sqrt();
    if below < PARALLEL_SINE {
        return nowhere(a.at + s0 * u, b.at + t0 * v, sign * unit);
    }
    let scale = sign * h / below;
    let (s, t) = (s0 + steepest[0] * scale, t0 + steepest[1] * scale);
    let normal = sign * below * unit + steepest[1] * v - steepest[0] * u;
    let radii = [a.radius + k[0] * s, b.radius + k[1] * t];
    ClosestPoints {
        gap: scale - radii[0] - radii[1],
        normal,
        on: [a.at + s * u + radii[0] * normal, b.at + t * v - radii[1] * normal],
    }
}

/// Returns an infinite gap. The gap of steep cones decreases steadily along the lines, so the cones are nearest at an end, which is a
/// separate patch.
fn nowhere(a: DVec3, b: DVec3, normal: DVec3) -> ClosestPoints {
    ClosestPoints { gap: f64::INFINITY, normal, on: [a, b] }
}

/// Returns the middle of the length that two parallel lines share, as a distance from the middle of the second line, m.
fn common_middle(a: &Spine, b: &Spine, w: DVec3) -> f64 {
    let start = w.dot(b.along);
    let low = (-b.half).max(-start - a.half);
    let high = b.half.min(a.half - start);
    (0.5 * (low + high)).clamp(-b.half, b.half)
}

/// Computes the closest points of two balls with centers `a` and `b` and radii `ra` and `rb`. `away` is the normal for concentric balls.
fn balls(a: DVec3, ra: f64, b: DVec3, rb: f64, away: DVec3) -> ClosestPoints {
    let between = b - a;
    let normal = between.try_normalize().or(away.try_normalize()).unwrap_or(DVec3::X);
    ClosestPoints { gap: between.length() - ra - rb, normal, on: [a + ra * normal, b - rb * normal] }
}

impl Pose {
    /// Transforms a point from body axes to world axes.
    #[inline]
    pub(crate) fn point(&self, point: DVec3) -> DVec3 {
        // The centers of balls are frequent.
        if point == DVec3::ZERO { self.location } else { self.location + self.orientation * point }
    }

    /// Transforms a point from world axes to body axes.
    pub(crate) fn local(&self, place: DVec3) -> DVec3 {
        self.orientation.conjugate() * (place - self.location)
    }

    /// The pose of a body at the origin, with its axes parallel to the world axes.
    pub(crate) const IDENTITY: Pose = Pose { location: DVec3::ZERO, orientation: DQuat::IDENTITY };
}
