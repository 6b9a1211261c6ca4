//! Closest points of a small ball, such as a particle, and the convex parts of a solid.

use glam::{DQuat, DVec3};

use super::closest_points::{ClosestPoints, between};
use super::patch::Patch;
use super::solid::{Pose, Solid};
use crate::shape::Shape;

/// A small ball that does not rotate, such as a particle with collisions.
#[derive(Clone, Debug)]
pub(crate) struct Ball {
    solid: Solid,
    radius: f64,
}

impl Ball {
    /// Creates a ball of this radius, m. `None` if the radius gives no solid.
    pub(crate) fn new(radius: f64) -> Option<Ball> {
        Some(Ball { solid: Solid::of(&Shape::Sphere { radius })?, radius })
    }

    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }

    /// Computes the contact of the ball with one convex part of a solid. Returns the gap, m; the unit normal out of the solid; and the
    /// closest point on the solid, m.
    pub(crate) fn nearest(
        &self,
        centre: DVec3,
        solid: &Solid,
        part: usize,
        pose: &Pose,
    ) -> (f64, DVec3, DVec3) {
        let own = Pose { location: centre, orientation: DQuat::IDENTITY };
        let ClosestPoints { gap, normal, on } =
            between(&self.solid.parts()[0], &own, &solid.parts()[part], pose);
        (gap, -normal, on[1])
    }

    /// Computes the gap between the ball and a triangle of a mesh, m, and the unit direction from the triangle to the ball. `None` for
    /// parts that are not triangles.
    ///
    /// [`nearest`](Ball::nearest) gives an infinite gap if a neighbor of the triangle is nearer; this method gives the true gap.
    pub(crate) fn apart(
        &self,
        centre: DVec3,
        solid: &Solid,
        part: usize,
        pose: &Pose,
    ) -> Option<(f64, DVec3)> {
        let corner = |patch: &Patch| match patch {
            Patch::Point { at, .. } => Some(*at),
            _ => None,
        };
        let features = &solid.parts()[part].features;
        let mut corners = features.iter().filter_map(|feature| corner(&feature.patch));
        let triangle = [corners.next()?, corners.next()?, corners.next()?];
        if corners.next().is_some() {
            return None;
        }
        let local = pose.local(centre);
        let away = local - nearest_on_triangle(local, triangle);
        let normal = pose.orientation * away.try_normalize()?;
        Some((away.length() - self.radius, normal))
    }
}

/// Returns the point of a triangle that is nearest to a given point. Source: C. Ericson, *Real-Time Collision Detection* (2005), 5.1.5.
fn nearest_on_triangle(place: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let along = |corner: DVec3| [ab.dot(place - corner), ac.dot(place - corner)];
    let [[d1, d2], [d3, d4], [d5, d6]] = [a, b, c].map(along);
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if d1 <= 0.0 && d2 <= 0.0 {
        a
    } else if d3 >= 0.0 && d4 <= d3 {
        b
    } else if d6 >= 0.0 && d5 <= d6 {
        c
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        a + ab * (d1 / (d1 - d3))
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        a + ac * (d2 / (d2 - d6))
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))
    } else {
        a + (ab * vb + ac * vc) / (va + vb + vc)
    }
}

impl Solid {
    /// Returns the number of convex parts of the solid.
    pub(crate) fn count(&self) -> usize {
        self.parts().len()
    }

    /// Returns true if this convex part is a half-space.
    pub(crate) fn is_endless(&self, part: usize) -> bool {
        self.parts()[part].is_ground()
    }

    /// Returns true if the solid has a tree of bounding boxes for its convex parts, as meshes have.
    pub(crate) fn has_tree(&self) -> bool {
        self.tree().is_some()
    }

    /// Returns the bounding box of a convex part along the world axes: its lowest and its highest corner, m.
    pub(crate) fn box_of(&self, part: usize, pose: &Pose) -> [DVec3; 2] {
        self.parts()[part].box_in(pose, &Pose::IDENTITY)
    }

    /// Returns an upper bound of the distance of a convex part's points from the origin of the body, m.
    pub(crate) fn reach_of(&self, part: usize) -> f64 {
        let part = &self.parts()[part];
        part.centre.length() + part.bound
    }

    /// Returns the indices of the convex parts that may be within a distance of a point, m. The point is given in body axes. Without a
    /// tree of boxes, these are all parts.
    pub(crate) fn parts_near(&self, place: DVec3, within: f64) -> Vec<usize> {
        match self.tree() {
            Some(tree) => tree.near([place; 2], within, self.parts().len()),
            None => (0..self.parts().len()).collect(),
        }
    }
}
