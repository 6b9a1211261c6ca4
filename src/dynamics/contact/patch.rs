//! The surface of a body around a touched place, and the nearest places of two such surfaces.

mod rim;

use glam::{DQuat, DVec3};

use super::nearest::Nearest;
use super::solid::Pose;

/// Two directions are parallel if the sine of their angle is smaller.
const PARALLEL: f64 = 1e-9;

/// The surface of a body around a touched place, in the body's own axes.
///
/// A patch extends beyond the borders of its edge or face, so that the places of a meeting are smooth functions of the
/// poses. [`inside`](super::touch::inside) gives the distance from the borders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::dynamics) enum Patch {
    /// A corner, a ball, the end of a capsule, the corner of a rounded box.
    Point {
        /// The corner, or the centre of the ball.
        at: DVec3,
        /// The radius of the ball, m; 0 for a corner.
        radius: f64,
    },
    /// An edge, or the side of a capsule or cylinder.
    Line {
        /// The middle of the edge, or of the axis.
        at: DVec3,
        /// Its unit direction.
        along: DVec3,
        /// Half its length, m.
        half: f64,
        /// The distance of the surface from it, m; 0 for a sharp edge.
        radius: f64,
        /// The direction out of the body at an edge. Zero for a capsule or a cylinder, which are round about the line.
        outward: DVec3,
    },
    /// A face.
    Plane {
        /// A point of it.
        at: DVec3,
        /// Its unit normal, out of the body.
        normal: DVec3,
    },
    /// The rim of the flat end of a cylinder or a cone.
    Circle {
        /// Its centre.
        centre: DVec3,
        /// The unit normal of the flat end, out of the body.
        axis: DVec3,
        /// Its radius, m.
        radius: f64,
    },
    /// The side of a cone: the envelope of balls around the points of its axis.
    Side {
        /// The middle of the axis.
        at: DVec3,
        /// The unit direction of the axis.
        along: DVec3,
        /// Half the height, m.
        half: f64,
        /// The radius of the ball around `at`, m.
        radius: f64,
        /// The growth of the balls' radius along the axis, m/m. For a cone that narrows along it, this is minus the
        /// sine of half the opening angle.
        taper: f64,
    },
}

/// A line of balls, whose envelope is the surface. A point is a line without a direction.
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
    /// The same patch in other axes.
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

    /// Whether the surface has no unique normal there: a corner, an edge, or a rim.
    pub(super) fn is_sharp(&self) -> bool {
        match *self {
            Patch::Point { radius, .. } | Patch::Line { radius, .. } => radius == 0.0,
            Patch::Circle { .. } => true,
            Patch::Plane { .. } | Patch::Side { .. } => false,
        }
    }

    /// Whether it is the rim of a flat end.
    pub(super) fn is_rim(&self) -> bool {
        matches!(self, Patch::Circle { .. })
    }

    /// Whether the meeting has no unique normal: neither patch has one, and they are not two crossing edges.
    pub(super) fn has_no_normal_with(&self, other: &Patch) -> bool {
        let corner = |patch: &Patch| matches!(patch, Patch::Point { .. });
        self.is_sharp() && other.is_sharp() && (corner(self) || corner(other))
    }

    /// The line of balls whose envelope is the patch. `None` for planes and rims.
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

/// The nearest places of two patches.
///
/// A gap between a corner and a corner, an edge or a rim is never negative, because the normal is not unique there.
pub(in crate::dynamics) fn meet(a: &Patch, pa: &Pose, b: &Patch, pb: &Pose) -> Nearest {
    // Near the first body, to keep digits far from the origin.
    let origin = pa.location;
    let a = a.placed(&Pose { location: DVec3::ZERO, orientation: pa.orientation });
    let b = b.placed(&Pose { location: pb.location - origin, orientation: pb.orientation });
    meet_placed(&a, &b).moved(origin)
}

/// The same for patches in common axes.
pub(super) fn meet_placed(a: &Patch, b: &Patch) -> Nearest {
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
            // Planes and rims are handled above.
            _ => Nearest { gap: f64::INFINITY, normal: DVec3::X, on: [DVec3::ZERO; 2] },
        },
    }
}

/// The nearest places of a plane and a patch. For a line, this is its nearer end.
fn on_plane(at: DVec3, normal: DVec3, other: &Patch) -> Nearest {
    let lowest = match *other {
        Patch::Plane { at, .. } => at,
        Patch::Circle { centre, axis, radius } => {
            let across = normal - normal.dot(axis) * axis;
            // A rim that lies flat has no lowest place; any place will do.
            centre - radius * across.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector())
        }
        _ => match other.spine() {
            Some(spine) => spine.lowest(normal),
            None => at,
        },
    };
    let gap = (lowest - at).dot(normal);
    Nearest { gap, normal, on: [lowest - gap * normal, lowest] }
}

/// The nearest places of a rim and a point, a line, or the side of a cone.
fn rim_and(rim: rim::Rim, other: &Patch) -> Nearest {
    match other.spine() {
        Some(spine) => rim::rim_and_spine(rim, &spine),
        None => Nearest { gap: f64::INFINITY, normal: rim.axis, on: [rim.centre; 2] },
    }
}

impl Spine {
    /// The farthest place of the surface against a direction.
    fn lowest(&self, normal: DVec3) -> DVec3 {
        let end = |s: f64| self.at + s * self.along - (self.radius + self.taper * s) * normal;
        let ends = [end(self.half), end(-self.half)];
        if ends[1].dot(normal) < ends[0].dot(normal) { ends[1] } else { ends[0] }
    }

    fn is_point(&self) -> bool {
        self.along == DVec3::ZERO
    }
}

/// The nearest places of two envelopes of balls.
///
/// The gap of the balls at s and t is |w + t v − s u| − r₁ − r₂ − k₁ s − k₂ t. Let the lines be nearest at (s₀, t₀), at the
/// distance h. With x = (s, t) − (s₀, t₀) and the matrix G of the scalar products of the directions, the gap is
/// √(h² + xᵀ G x) − k·x − …, whose minimum is at x = G⁻¹ k h / √(1 − kᵀ G⁻¹ k).
fn spines(a: &Spine, b: &Spine) -> Nearest {
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
    if b.is_point() || sine < PARALLEL {
        // Parallel lines meet in the middle of the length that they share, or at their nearer ends.
        let t = if b.is_point() { 0.0 } else { common_middle(a, b, w) };
        let from = w + t * v;
        let s0 = from.dot(u);
        let across = from - s0 * u;
        let h = across.length();
        let taper = a.taper + b.taper * u.dot(v);
        let below = (1.0 - taper * taper).max(0.0).sqrt();
        if below < PARALLEL {
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
    // The outward directions of the two bodies give the sign of the normal, even if the bodies overlap.
    let out = unit.dot(a.outward - b.outward);
    let sign = if out == 0.0 { 1.0_f64.copysign(h) } else { out.signum() };
    // With its sign, the gap is smooth even at a crossing of the lines.
    let below = (1.0 - k[0] * steepest[0] - k[1] * steepest[1]).max(0.0).sqrt();
    if below < PARALLEL {
        return nowhere(a.at + s0 * u, b.at + t0 * v, sign * unit);
    }
    let scale = sign * h / below;
    let (s, t) = (s0 + steepest[0] * scale, t0 + steepest[1] * scale);
    let normal = sign * below * unit + steepest[1] * v - steepest[0] * u;
    let radii = [a.radius + k[0] * s, b.radius + k[1] * t];
    Nearest {
        gap: scale - radii[0] - radii[1],
        normal,
        on: [a.at + s * u + radii[0] * normal, b.at + t * v - radii[1] * normal],
    }
}

/// No meeting. The gap shrinks steadily along the lines of steep cones, so they are nearest at an end, which is a
/// separate patch.
fn nowhere(a: DVec3, b: DVec3, normal: DVec3) -> Nearest {
    Nearest { gap: f64::INFINITY, normal, on: [a, b] }
}

/// The middle of the common part of two parallel lines, from the middle of the second, m.
fn common_middle(a: &Spine, b: &Spine, w: DVec3) -> f64 {
    let start = w.dot(b.along);
    let low = (-b.half).max(-start - a.half);
    let high = b.half.min(a.half - start);
    (0.5 * (low + high)).clamp(-b.half, b.half)
}

/// The nearest places of two balls. `away` is the normal for concentric balls.
fn balls(a: DVec3, ra: f64, b: DVec3, rb: f64, away: DVec3) -> Nearest {
    let between = b - a;
    let normal = between.try_normalize().or(away.try_normalize()).unwrap_or(DVec3::X);
    Nearest { gap: between.length() - ra - rb, normal, on: [a + ra * normal, b - rb * normal] }
}

impl Pose {
    /// A place of the body in the world.
    pub(in crate::dynamics) fn point(&self, point: DVec3) -> DVec3 {
        self.location + self.orientation * point
    }

    /// A place of the world in the axes of the body.
    pub(in crate::dynamics) fn local(&self, place: DVec3) -> DVec3 {
        self.orientation.conjugate() * (place - self.location)
    }

    /// Neither moved nor rotated.
    pub(in crate::dynamics) const IDENTITY: Pose =
        Pose { location: DVec3::ZERO, orientation: DQuat::IDENTITY };
}
