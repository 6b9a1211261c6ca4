//! The features of a convex part (its corners, edges, faces and rims), with the borders and the normals of each.

use glam::DVec3;

use super::patch::{Patch, meet_placed};
use super::solid::{ConvexPart, Pose};

/// A feature of a convex part: a corner, an edge, a face, a rim or a round side. All coordinates are in body axes.
#[derive(Clone, Debug)]
pub(super) struct Feature {
    pub(super) patch: Patch,
    pub(super) outline: Outline,
    pub(super) normals: Normals,
    /// True for a flat or concave edge or corner between the triangles of a mesh. A face is always nearer there, so such a feature makes no
    /// contact.
    pub(super) is_seam: bool,
}

/// The part of a feature's patch (the extended surface) that the feature covers, within its borders.
#[derive(Clone, Debug)]
pub(super) enum Outline {
    /// The feature covers its whole patch, which has no borders.
    All,
    /// A line segment: points at most `half` from the middle `at`, measured along the unit vector `along`.
    Length { at: DVec3, along: DVec3, half: f64 },
    /// A polygon: the points inside all of its edges. Each edge is given by a point on the edge and the unit vector from the edge into the
    /// face.
    Edges(Vec<[DVec3; 2]>),
    /// A disc: points within `radius` of `centre`.
    Disc { centre: DVec3, radius: f64 },
}

/// The directions of the contact normals that are possible at a feature.
#[derive(Clone, Debug)]
pub(super) enum Normals {
    /// All normals of the patch are possible.
    All,
    /// The normals at an edge or a corner: the angle to each of these unit vectors, which lie in the surface, is at least 90°.
    Away(Vec<DVec3>),
    /// The normals at a rim. They point away from the axis, at an angle of at least 90° to the side. `side` is the unit vector along the
    /// side: its radial component and its component along the axis.
    Rim { centre: DVec3, axis: DVec3, side: [f64; 2] },
    /// The normals at the tip of a cone. `axis` points from the base to the tip. `half_angle` holds the cosine and the sine of half the
    /// opening angle.
    Tip { axis: DVec3, half_angle: [f64; 2] },
}

impl Feature {
    /// Creates a feature that can make contacts. A seam (a flat or concave edge or corner between triangles) cannot.
    pub(super) fn new(patch: Patch, outline: Outline, normals: Normals) -> Feature {
        Feature { patch, outline, normals, is_seam: false }
    }

    /// Creates a feature that covers its whole patch, with all normals.
    pub(super) fn all(patch: Patch) -> Feature {
        Feature::new(patch, Outline::All, Normals::All)
    }

    /// Returns the distance of a point on the patch from the borders of the feature, m. It is negative outside of the feature.
    pub(super) fn margin(&self, place: DVec3) -> f64 {
        match &self.outline {
            Outline::All => f64::INFINITY,
            Outline::Length { at, along, half } => half - (place - *at).dot(*along).abs(),
            Outline::Edges(edges) => {
                edges.iter().map(|[at, inward]| (place - *at).dot(*inward)).fold(f64::INFINITY, f64::min)
            }
            Outline::Disc { centre, radius } => radius - place.distance(*centre),
        }
    }

    /// Returns the straight edges of a face: for each, a point on the edge and the unit vector into the face. Empty for other features.
    pub(super) fn edges(&self) -> &[[DVec3; 2]] {
        match &self.outline {
            Outline::Edges(edges) => edges,
            _ => &[],
        }
    }

    /// Returns true if a point of the convex part's core lies below the feature at a depth equal to the rounding `radius` of the part,
    /// within `tolerance`, m.
    pub(super) fn is_near(&self, place: DVec3, radius: f64, tolerance: f64) -> bool {
        let point = Patch::Point { at: place, radius: 0.0 };
        let found = meet_placed(&point, &self.patch);
        (found.gap + radius).abs() <= tolerance && self.margin(found.on[1]) >= -tolerance
    }

    /// Returns true if a point lies on the feature, within `tolerance`, m.
    pub(super) fn holds(&self, place: DVec3, tolerance: f64) -> bool {
        self.is_near(place, 0.0, tolerance)
    }

    /// Returns an upper bound of the feature's extent along a unit vector, m. `part` is the convex part that the feature belongs to.
    pub(super) fn highest(&self, direction: DVec3, part: &ConvexPart) -> f64 {
        match self.patch {
            Patch::Point { at, radius } => at.dot(direction) + radius,
            Patch::Line { at, along, half, radius, .. } => {
                at.dot(direction) + half * along.dot(direction).abs() + radius
            }
            Patch::Circle { centre, axis, radius } => {
                centre.dot(direction) + radius * axis.cross(direction).length()
            }
            // The bound assumes that a face is as large as its convex part. For a face turned away from the direction, corners and rims
            // extend farther.
            Patch::Plane { at, normal } => {
                let tilt = normal.cross(direction).length();
                if normal.dot(direction) > 0.0 {
                    at.dot(direction) + 2.0 * part.bound * tilt
                } else {
                    f64::NEG_INFINITY
                }
            }
            Patch::Side { .. } => part.support(direction).dot(direction),
        }
    }

    /// Returns the sine of the angle between a unit vector and the nearest border of the feature's normals at a point. It is negative if
    /// the vector is not among the normals.
    pub(super) fn slack(&self, place: DVec3, normal: DVec3) -> f64 {
        match &self.normals {
            Normals::All => f64::INFINITY,
            Normals::Away(along) => {
                along.iter().map(|direction| -direction.dot(normal)).fold(f64::INFINITY, f64::min)
            }
            Normals::Rim { centre, axis, side } => {
                let from = place - *centre;
                let radial = (from - from.dot(*axis) * *axis).normalize_or_zero();
                let (out, up) = (normal.dot(radial), normal.dot(*axis));
                out.min(-(side[0] * out + side[1] * up))
            }
            Normals::Tip { axis, half_angle: [cosine, sine] } => {
                let up = normal.dot(*axis);
                cosine * up - sine * (normal - up * *axis).length()
            }
        }
    }
}

pub(super) fn features_of_ground(at: DVec3, normal: DVec3) -> Vec<Feature> {
    vec![Feature::all(Patch::Plane { at, normal })]
}

pub(super) fn features_of_capsule(ends: [DVec3; 2], radius: f64) -> Vec<Feature> {
    let between = ends[1] - ends[0];
    let (along, half) = (between.normalize_or_zero(), 0.5 * between.length());
    let at = 0.5 * (ends[0] + ends[1]);
    let end = |at: DVec3, inward: DVec3| Feature {
        patch: Patch::Point { at, radius },
        outline: Outline::All,
        normals: Normals::Away(vec![inward]),
        is_seam: false,
    };
    let side = Feature {
        patch: Patch::Line { at, along, half, radius, outward: DVec3::ZERO },
        outline: Outline::Length { at, along, half },
        normals: Normals::All,
        is_seam: false,
    };
    vec![side, end(ends[0], along), end(ends[1], -along)]
}

pub(super) fn features_of_box(pose: &Pose, half: DVec3, radius: f64) -> Vec<Feature> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| pose.orientation * axis);
    let half = half.to_array();
    let signs = [-1.0, 1.0];
    let mut features = Vec::new();
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        for s in signs {
            let normal = s * axes[i];
            let centre = pose.location + half[i] * normal;
            let edge = |axis: usize, sign: f64| [centre + sign * half[axis] * axes[axis], -sign * axes[axis]];
            features.push(Feature {
                patch: Patch::Plane { at: centre + radius * normal, normal },
                outline: Outline::Edges(vec![edge(j, 1.0), edge(j, -1.0), edge(k, 1.0), edge(k, -1.0)]),
                normals: Normals::All,
                is_seam: false,
            });
        }
    }
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        for (s, t) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let (y, z) = (s * axes[j], t * axes[k]);
            let at = pose.location + half[j] * y + half[k] * z;
            features.push(Feature {
                patch: Patch::Line { at, along: axes[i], half: half[i], radius, outward: y + z },
                outline: Outline::Length { at, along: axes[i], half: half[i] },
                normals: Normals::Away(vec![-y, -z]),
                is_seam: false,
            });
        }
    }
    for s in signs {
        for t in signs {
            for u in signs {
                let [x, y, z] = [s * axes[0], t * axes[1], u * axes[2]];
                features.push(Feature {
                    patch: Patch::Point {
                        at: pose.location + half[0] * x + half[1] * y + half[2] * z,
                        radius,
                    },
                    outline: Outline::All,
                    normals: Normals::Away(vec![-x, -y, -z]),
                    is_seam: false,
                });
            }
        }
    }
    features
}

pub(super) fn features_of_frustum(ends: [DVec3; 2], axis: DVec3, radii: [f64; 2]) -> Vec<Feature> {
    let height = ends[0].distance(ends[1]);
    let slant = libm::hypot(height, radii[1] - radii[0]);
    // The unit vector along the side from the first end to the second: its radial component and its component along the axis.
    let side = [(radii[1] - radii[0]) / slant, height / slant];
    let at = 0.5 * (ends[0] + ends[1]);
    let middle = 0.5 * (radii[0] + radii[1]);
    let half = 0.5 * height;
    let round = if radii[0] == radii[1] {
        Patch::Line { at, along: axis, half, radius: middle, outward: DVec3::ZERO }
    } else {
        Patch::Side { at, along: axis, half, radius: middle * side[1], taper: side[0] }
    };
    let mut features = vec![Feature {
        patch: round,
        outline: Outline::Length { at, along: axis, half },
        normals: Normals::All,
        is_seam: false,
    }];
    for (centre, radius, out, side) in
        [(ends[0], radii[0], -axis, side), (ends[1], radii[1], axis, side.map(|part| -part))]
    {
        if radius == 0.0 {
            features.push(Feature {
                patch: Patch::Point { at: centre, radius: 0.0 },
                outline: Outline::All,
                normals: Normals::Tip { axis: out, half_angle: [side[1].abs(), side[0].abs()] },
                is_seam: false,
            });
            continue;
        }
        features.push(Feature {
            patch: Patch::Plane { at: centre, normal: out },
            outline: Outline::Disc { centre, radius },
            normals: Normals::All,
            is_seam: false,
        });
        features.push(Feature {
            patch: Patch::Circle { centre, axis: out, radius },
            outline: Outline::All,
            normals: Normals::Rim { centre, axis, side },
            is_seam: false,
        });
    }
    features
}
