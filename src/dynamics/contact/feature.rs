//! The corners, edges and faces of a convex part, and where each of them ends.

use glam::DVec3;

use super::patch::{Patch, meet_placed};
use super::solid::{Part, Pose};

/// A corner, an edge, a face, a rim or a side, in the axes of the body.
#[derive(Clone, Debug)]
pub(super) struct Feature {
    pub(super) patch: Patch,
    pub(super) outline: Outline,
    pub(super) normals: Normals,
    /// Whether it is inside a surface of triangles, so that nothing touches there: a face is nearer.
    pub(super) is_seam: bool,
}

/// Where the places of a feature are.
#[derive(Clone, Debug)]
pub(super) enum Outline {
    /// Wherever the patch is.
    All,
    /// No farther than `half` from the middle, along a unit direction.
    Length { at: DVec3, along: DVec3, half: f64 },
    /// On the inner side of each of these edges: a place on it, and the unit direction into the face.
    Edges(Vec<[DVec3; 2]>),
    /// Within a disc.
    Disc { centre: DVec3, radius: f64 },
}

/// Which directions are normals of the body at a feature.
#[derive(Clone, Debug)]
pub(super) enum Normals {
    /// All that the patch has.
    All,
    /// Those that point away from each of these unit directions, which go along the surface.
    Away(Vec<DVec3>),
    /// At a rim: those that point away from the axis and from the side, whose unit direction has these components out from the
    /// axis and along it.
    Rim { centre: DVec3, axis: DVec3, side: [f64; 2] },
    /// At the tip of a cone, whose axis points to it, with this cosine and sine of half its opening angle.
    Tip { axis: DVec3, half_angle: [f64; 2] },
}

impl Feature {
    /// A patch with where it ends, and its normals.
    pub(super) fn new(patch: Patch, outline: Outline, normals: Normals) -> Feature {
        Feature { patch, outline, normals, is_seam: false }
    }

    /// A patch that has no end.
    pub(super) fn all(patch: Patch) -> Feature {
        Feature::new(patch, Outline::All, Normals::All)
    }

    /// How far a place on the patch is from where the feature ends, m; negative beyond it.
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

    /// The straight edges of a face.
    pub(super) fn edges(&self) -> &[[DVec3; 2]] {
        match &self.outline {
            Outline::Edges(edges) => edges,
            _ => &[],
        }
    }

    /// Whether a place of the core is within `tolerance` of the feature of a part with this rounding.
    pub(super) fn is_near(&self, place: DVec3, radius: f64, tolerance: f64) -> bool {
        let point = Patch::Point { at: place, radius: 0.0 };
        let found = meet_placed(&point, &self.patch);
        (found.gap + radius).abs() <= tolerance && self.margin(found.on[1]) >= -tolerance
    }

    /// Whether a place is on the feature, but for `tolerance`.
    pub(super) fn holds(&self, place: DVec3, tolerance: f64) -> bool {
        self.is_near(place, 0.0, tolerance)
    }

    /// How far the feature of a part reaches along a unit direction.
    pub(super) fn highest(&self, direction: DVec3, part: &Part) -> f64 {
        match self.patch {
            Patch::Point { at, radius } => at.dot(direction) + radius,
            Patch::Line { at, along, half, radius, .. } => {
                at.dot(direction) + half * along.dot(direction).abs() + radius
            }
            Patch::Circle { centre, axis, radius } => {
                centre.dot(direction) + radius * axis.cross(direction).length()
            }
            // Corners and rims bound what is left.
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

    /// By how much a unit direction is within the normals at a place of the feature: a sine, negative for one that is none.
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
    // The direction of the side from the first end to the second: out from the axis, and along it.
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
