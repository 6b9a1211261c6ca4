//! The surface of a body for contacts: its shape as convex parts, each with its corners, edges and faces.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::feature::{
    Feature, features_of_box, features_of_capsule, features_of_frustum, features_of_ground,
};
use super::patch::{Patch, radial};
use super::tree::Tree;
use super::triangles::triangles;
use crate::shape::{Part as Piece, Shape, cone_base};

/// The position and the orientation of a body. The body axes are those of its shape, not its principal axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    /// The position of the body's center of mass, world axes, m.
    pub location: DVec3,
    /// The rotation from body axes to world axes.
    pub orientation: DQuat,
}

/// The surface of a body for contacts, as a list of convex parts.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    reach: f64,
    size: f64,
    parts: Arc<[ConvexPart]>,
    /// The tree of the convex parts' bounding boxes; `None` for all but meshes.
    tree: Option<Arc<Tree>>,
    is_surface: bool,
}

/// A convex part of a body: its core, enlarged on all sides by the rounding `radius`, m. All points are in body axes.
#[derive(Debug)]
pub(super) struct ConvexPart {
    pub(super) core: Core,
    pub(super) radius: f64,
    /// For a box parallel to the body axes, its half extents, m. `None` for all other parts.
    pub(super) half: Option<DVec3>,
    /// The center of a bounding ball of the convex part, body axes, m.
    pub(super) centre: DVec3,
    /// The radius of the bounding ball, m; infinite for the ground.
    pub(super) bound: f64,
    /// The corners, edges, faces and rims of the convex part.
    pub(super) features: Vec<Feature>,
    /// For a triangle of a mesh, the size of the whole mesh, m. `None` for a solid part.
    pub(super) surface: Option<f64>,
}

/// The geometry of a convex part without its rounding.
#[derive(Debug)]
pub(super) enum Core {
    /// The convex hull of points. A single point becomes a ball by rounding, two points a capsule.
    Hull(Vec<DVec3>),
    /// A cylinder, a cone, or a truncated cone: the convex hull of two discs about one axis.
    Frustum {
        /// The centers of the two discs, body axes, m.
        ends: [DVec3; 2],
        /// The unit direction of the axis, from the first disc to the second.
        axis: DVec3,
        /// The radii of the two discs, m; 0 for the tip of a cone.
        radii: [f64; 2],
    },
    /// The ground: the half-space below a plane.
    Ground {
        /// A point on the plane, body axes, m.
        at: DVec3,
        /// The unit normal of the plane, out of the ground.
        normal: DVec3,
    },
}

impl Solid {
    /// Creates the surface of a shape. `None` for a torus, for axes, and for compounds that contain one of these.
    pub(crate) fn of(shape: &Shape) -> Option<Solid> {
        let mut parts = Vec::new();
        add(shape, &Pose::IDENTITY, &mut parts)?;
        let is_surface = parts.iter().any(|part| part.surface.is_some());
        let body = Pose::IDENTITY;
        let tree = is_surface.then(|| Tree::new(parts.iter().map(|part| part.box_in(&body, &body))).into());
        let reach = parts.iter().map(ConvexPart::reach).fold(0.0, f64::max);
        let size = parts.iter().map(ConvexPart::size).fold(f64::INFINITY, f64::min);
        Some(Solid { parts: parts.into(), tree, is_surface, reach, size })
    }

    /// Returns the largest distance of the cores from the center of mass, m. At the angular speed ω, no point of a core moves faster than
    /// ω times this. 0 for a ball around its center; infinite for a plane.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Returns a typical size of the body, m: the smallest thickness of its convex parts. Infinite for a plane.
    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// Returns the bounding box of the body along the world axes: its lowest and its highest corner, m. Infinite for a plane.
    pub(crate) fn bounds(&self, pose: &Pose) -> [DVec3; 2] {
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for part in &*self.parts {
            if part.is_ground() {
                return [DVec3::NEG_INFINITY, DVec3::INFINITY];
            }
            let [low, high] = part.box_in(pose, &Pose::IDENTITY);
            bounds = [bounds[0].min(low), bounds[1].max(high)];
        }
        bounds
    }

    /// Returns the tree of the convex parts' bounding boxes. `None` for all but meshes.
    pub(super) fn tree(&self) -> Option<&Tree> {
        self.tree.as_deref()
    }

    /// Returns true if the body is a single ball. It touches a convex solid at only one point.
    pub(super) fn is_ball(&self) -> bool {
        matches!(&*self.parts, [part] if part.ball().is_some())
    }

    /// Returns true if triangles of a mesh are among the parts.
    pub(super) fn is_surface(&self) -> bool {
        self.is_surface
    }

    pub(super) fn parts(&self) -> &[ConvexPart] {
        &self.parts
    }
}

impl ConvexPart {
    fn new(core: Core, radius: f64, features: Vec<Feature>) -> ConvexPart {
        let (centre, bound) = match &core {
            Core::Hull(corners) => {
                let centre = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
                (centre, corners.iter().map(|corner| corner.distance(centre)).fold(0.0, f64::max))
            }
            Core::Frustum { ends, radii, .. } => {
                let half = 0.5 * ends[0].distance(ends[1]);
                (0.5 * (ends[0] + ends[1]), libm::hypot(half, radii[0].max(radii[1])))
            }
            Core::Ground { at, .. } => (*at, f64::INFINITY),
        };
        ConvexPart { core, radius, half: None, centre, bound: bound + radius, features, surface: None }
    }

    /// Returns the point of the convex part that is farthest along a vector of any length, body axes, m.
    pub(super) fn support(&self, direction: DVec3) -> DVec3 {
        let core = self.core.support(direction);
        if self.radius > 0.0 { core + self.radius * direction.normalize_or_zero() } else { core }
    }

    /// Returns the bounding box of the convex part along the axes of another body: its lowest and its highest corner, m.
    pub(super) fn box_in(&self, pose: &Pose, other: &Pose) -> [DVec3; 2] {
        if self.is_ground() {
            return [DVec3::NEG_INFINITY, DVec3::INFINITY];
        }
        let turn = pose.orientation.conjugate() * other.orientation;
        let reach = |axis: DVec3| {
            let direction = turn * axis;
            self.support(direction).dot(direction)
        };
        let high = DVec3::new(reach(DVec3::X), reach(DVec3::Y), reach(DVec3::Z));
        let low = -DVec3::new(reach(-DVec3::X), reach(-DVec3::Y), reach(-DVec3::Z));
        let origin = other.local(pose.location);
        [origin + low, origin + high]
    }

    pub(super) fn is_ground(&self) -> bool {
        matches!(self.core, Core::Ground { .. })
    }

    /// Returns the center of the part if it is a ball, body axes, m. `None` for all other parts.
    pub(super) fn ball(&self) -> Option<DVec3> {
        match &self.core {
            Core::Hull(corners) if corners.len() == 1 => Some(corners[0]),
            _ => None,
        }
    }

    fn reach(&self) -> f64 {
        match &self.core {
            Core::Hull(corners) => corners.iter().map(|corner| corner.length()).fold(0.0, f64::max),
            Core::Frustum { ends, axis, radii } => {
                let rim = |i: usize| {
                    let along = ends[i].dot(*axis);
                    libm::hypot((ends[i] - along * *axis).length() + radii[i], along)
                };
                rim(0).max(rim(1))
            }
            Core::Ground { .. } => f64::INFINITY,
        }
    }

    fn size(&self) -> f64 {
        if let Some(size) = self.surface {
            return size;
        }
        let core = match &self.core {
            // The smallest width of the hull along the normal of a face.
            Core::Hull(corners) if corners.len() > 2 => {
                let width = |feature: &Feature| match feature.patch {
                    Patch::Plane { at, normal } => {
                        Some((at - self.core.support(-normal)).dot(normal) - self.radius)
                    }
                    _ => None,
                };
                self.features.iter().filter_map(width).fold(f64::INFINITY, f64::min)
            }
            Core::Hull(_) => 0.0,
            Core::Frustum { ends, radii, .. } => ends[0].distance(ends[1]).min(2.0 * radii[0].max(radii[1])),
            Core::Ground { .. } => return f64::INFINITY,
        };
        core + 2.0 * self.radius
    }
}

impl Core {
    /// Returns the point of the core that is farthest along a vector of any length, body axes, m.
    pub(super) fn support(&self, direction: DVec3) -> DVec3 {
        match self {
            Core::Hull(corners) => {
                let mut best = (f64::NEG_INFINITY, DVec3::ZERO);
                for &corner in corners {
                    let height = corner.dot(direction);
                    if height > best.0 {
                        best = (height, corner);
                    }
                }
                best.1
            }
            Core::Frustum { ends, axis, radii } => {
                let rim = radial(direction, *axis).unwrap_or(DVec3::ZERO);
                let places = [ends[0] + radii[0] * rim, ends[1] + radii[1] * rim];
                if places[1].dot(direction) > places[0].dot(direction) { places[1] } else { places[0] }
            }
            Core::Ground { at, .. } => *at,
        }
    }
}

/// Appends the convex parts of a shape. `pose` is the pose of the shape in body axes. `None` if the shape has no surface for contacts.
fn add(shape: &Shape, pose: &Pose, parts: &mut Vec<ConvexPart>) -> Option<()> {
    let up = pose.orientation * DVec3::Y;
    let along = |y: f64| pose.location + y * up;
    let ball = |radius: f64| {
        let patch = Patch::Point { at: pose.location, radius };
        ConvexPart::new(Core::Hull(vec![pose.location]), radius, vec![Feature::all(patch)])
    };
    let rod = |half: f64, radius: f64, up: DVec3| {
        let ends = [pose.location - half * up, pose.location + half * up];
        ConvexPart::new(Core::Hull(ends.to_vec()), radius, features_of_capsule(ends, radius))
    };
    parts.push(match *shape {
        Shape::Sphere { radius } => ball(radius),
        Shape::Capsule { radius, height } if height <= 2.0 * radius => ball(radius),
        Shape::Capsule { radius, height } => rod(0.5 * height - radius, radius, up),
        Shape::Box { size } => block(pose, 0.5 * size, 0.0),
        Shape::RoundedBox { size, rounding } => {
            let half = (0.5 * size - rounding).max(DVec3::ZERO);
            let long = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter(|axis| half.dot(*axis) > 0.0);
            match long.clone().count() {
                0 => ball(rounding),
                1 => rod(half.max_element(), rounding, pose.orientation * long.sum::<DVec3>()),
                _ => block(pose, half, rounding),
            }
        }
        Shape::Cylinder { radius, height } => {
            frustum([along(-0.5 * height), along(0.5 * height)], [radius; 2])
        }
        Shape::Cone { radius, top_radius, height } => {
            let base = cone_base(radius, top_radius, height);
            frustum([along(base), along(base + height)], [radius, top_radius])
        }
        Shape::Plane { normal } => {
            let normal = pose.orientation * normal;
            let at = pose.location;
            ConvexPart::new(Core::Ground { at, normal }, 0.0, features_of_ground(at, normal))
        }
        Shape::Compound(ref compound) => {
            for Piece { shape, location, orientation } in compound.parts() {
                let pose =
                    Pose { location: pose.point(*location), orientation: pose.orientation * *orientation };
                add(shape, &pose, parts)?;
            }
            return Some(());
        }
        Shape::Mesh { ref mesh, scale } => {
            let half = shape.half_thickness().or(shape.bounding_radius());
            let size = 2.0 * half.unwrap_or(0.5);
            for (corners, features) in triangles(mesh, scale, pose) {
                let part = ConvexPart::new(Core::Hull(corners.to_vec()), 0.0, features);
                parts.push(ConvexPart { surface: Some(size), ..part });
            }
            return Some(());
        }
        Shape::Torus { .. } | Shape::Axes { .. } => return None,
    });
    Some(())
}

fn block(pose: &Pose, half: DVec3, radius: f64) -> ConvexPart {
    let corner = |i: u32| {
        let sign = |bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        pose.point(half * DVec3::new(sign(0), sign(1), sign(2)))
    };
    let corners = (0..8).map(corner).collect();
    let part = ConvexPart::new(Core::Hull(corners), radius, features_of_box(pose, half, radius));
    let is_upright = radius == 0.0 && pose.orientation == DQuat::IDENTITY;
    ConvexPart { half: is_upright.then_some(half), ..part }
}

fn frustum(ends: [DVec3; 2], radii: [f64; 2]) -> ConvexPart {
    let axis = (ends[1] - ends[0]).normalize_or(DVec3::Y);
    ConvexPart::new(Core::Frustum { ends, axis, radii }, 0.0, features_of_frustum(ends, axis, radii))
}
