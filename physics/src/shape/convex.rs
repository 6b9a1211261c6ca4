//! Tests whether two convex shapes intersect.

use glam::{DQuat, DVec3};

use super::Shape;

/// The largest number of iterations in the search for a common point. Round shapes that just touch need the most iterations.
const MAX_STEPS: usize = 64;

/// A convex shape with a location, an orientation and a size in the world.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// The shape before it is scaled.
    pub shape: &'a Shape,
    /// The location of the centre of mass, m.
    pub location: DVec3,
    /// The rotation from the shape's axes to world axes.
    pub orientation: DQuat,
    /// The factor by which the shape is enlarged.
    pub scale: f64,
}

impl Placed<'_> {
    /// Returns the point of the shape that is farthest in a direction, world axes, m.
    fn farthest(&self, direction: DVec3) -> DVec3 {
        let point = self.shape.farthest(self.orientation.conjugate() * direction).unwrap_or(DVec3::ZERO);
        self.location + self.scale * (self.orientation * point)
    }

    /// Returns whether two convex shapes have a common point; false if the search does not converge.
    ///
    /// Two spheres are compared by their distance, other shapes by the GJK algorithm. Source: E. G. Gilbert, D. W. Johnson, S. S. Keerthi,
    /// IEEE J. Robotics and Automation 4 (1988) 193.
    #[must_use]
    pub fn intersects(&self, other: &Placed<'_>) -> bool {
        let between = other.location - self.location;
        if let (Shape::Sphere { radius: a }, Shape::Sphere { radius: b }) = (self.shape, other.shape) {
            return between.length() < a * self.scale + b * other.scale;
        }
        // This closure returns points of the Minkowski difference of the shapes. The difference contains the origin exactly if the shapes
        // have a common point.
        let difference = |direction: DVec3| self.farthest(direction) - other.farthest(-direction);
        let mut simplex = vec![difference(if between == DVec3::ZERO { DVec3::X } else { between })];
        let mut nearest = simplex[0];
        for _ in 0..MAX_STEPS {
            // At smaller distances, rounding errors would decide the result.
            if nearest.length_squared() <= 1e-24 * between.length_squared() {
                return true;
            }
            let point = difference(-nearest);
            if point.dot(nearest) > 0.0 {
                return false;
            }
            simplex.push(point);
            match reduce(&mut simplex) {
                Some(next) => nearest = next,
                None => return true,
            }
        }
        false
    }
}

/// Returns the point of the simplex that is nearest to the origin, and reduces the simplex to the vertices of the corner, edge or face
/// that contains this point. Returns `None` if a tetrahedron contains the origin.
fn reduce(simplex: &mut Vec<DVec3>) -> Option<DVec3> {
    match *simplex.as_slice() {
        [a, b] => Some(of_edge(simplex, a, b)),
        [a, b, c] => Some(of_triangle(simplex, a, b, c)),
        [a, b, c, d] => {
            let mut best: Option<(DVec3, Vec<DVec3>)> = None;
            for (a, b, c, opposite) in [(a, b, c, d), (a, c, d, b), (a, d, b, c), (b, d, c, a)] {
                let normal = (b - a).cross(c - a);
                // This face is skipped, because the origin and the opposite vertex are on the same side of it.
                if normal.dot(-a) * normal.dot(opposite - a) > 0.0 {
                    continue;
                }
                let mut face = Vec::new();
                let point = of_triangle(&mut face, a, b, c);
                if best.as_ref().is_none_or(|(other, _)| point.length_squared() < other.length_squared()) {
                    best = Some((point, face));
                }
            }
            let (point, face) = best?;
            *simplex = face;
            Some(point)
        }
        _ => simplex.first().copied(),
    }
}

fn of_edge(simplex: &mut Vec<DVec3>, a: DVec3, b: DVec3) -> DVec3 {
    let edge = b - a;
    let part = (-a).dot(edge) / edge.length_squared();
    if part > 0.0 && part < 1.0 {
        *simplex = vec![a, b];
        return a + part * edge;
    }
    let end = if part >= 1.0 { b } else { a };
    *simplex = vec![end];
    end
}

/// Returns the point of the triangle a, b, c that is nearest to the origin, and reduces `simplex` to the vertices of the corner, edge or
/// face that contains this point. Source: C. Ericson, *Real-Time Collision Detection* (2005), 5.1.5.
fn of_triangle(simplex: &mut Vec<DVec3>, a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let [d1, d2] = [ab.dot(-a), ac.dot(-a)];
    let [d3, d4] = [ab.dot(-b), ac.dot(-b)];
    let [d5, d6] = [ab.dot(-c), ac.dot(-c)];
    if d1 <= 0.0 && d2 <= 0.0 {
        *simplex = vec![a];
        return a;
    }
    if d3 >= 0.0 && d4 <= d3 {
        *simplex = vec![b];
        return b;
    }
    if d6 >= 0.0 && d5 <= d6 {
        *simplex = vec![c];
        return c;
    }
    let (of_c, of_b, of_a) = (d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4);
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return of_edge(simplex, a, b);
    }
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return of_edge(simplex, a, c);
    }
    if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        return of_edge(simplex, b, c);
    }
    *simplex = vec![a, b, c];
    let sum = of_a + of_b + of_c;
    a + ab * (of_b / sum) + ac * (of_c / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(shape: &Shape, location: [f64; 3], turn: f64) -> Placed<'_> {
        let orientation = DQuat::from_rotation_z(turn.to_radians());
        Placed { shape, location: DVec3::from_array(location), orientation, scale: 1.0 }
    }

    #[test]
    fn shapes_meet_where_they_do() {
        let ball = Shape::Sphere { radius: 1.0 };
        let cube = Shape::Box { size: DVec3::splat(2.0) };
        let soft = Shape::RoundedBox { size: DVec3::splat(2.0), rounding: 0.5 };
        let can = Shape::Cylinder { radius: 1.0, height: 4.0 };
        let pill = Shape::Capsule { radius: 0.5, height: 4.0 };
        let cone = Shape::Cone { radius: 1.0, top_radius: 0.0, height: 4.0 };
        for (one, two, place, turn, intersects) in [
            (&ball, &ball, [1.99, 0.0, 0.0], 0.0, true),
            (&ball, &ball, [2.01, 0.0, 0.0], 0.0, false),
            // Along the diagonal, the corners of both cubes are √3 m from their centres.
            (&cube, &cube, [1.99, 1.99, 1.99], 0.0, true),
            (&cube, &cube, [2.01, 0.0, 0.0], 0.0, false),
            // A cube that is rotated by 45 degrees extends √2 m along x.
            (&cube, &cube, [2.41, 0.0, 0.0], 45.0, true),
            (&cube, &cube, [2.42, 0.0, 0.0], 45.0, false),
            (&ball, &cube, [1.57, 1.57, 1.57], 0.0, true),
            (&ball, &cube, [1.58, 1.58, 1.58], 0.0, false),
            (&soft, &cube, [1.99, 0.0, 0.0], 0.0, true),
            // The rounded corner is (√3 − 1) / 2 m nearer to the centre than the corner of the cube.
            (&soft, &soft, [1.57, 1.57, 1.57], 0.0, true),
            (&soft, &soft, [1.6, 1.6, 1.6], 0.0, false),
            (&can, &ball, [0.0, 2.99, 0.0], 0.0, true),
            (&can, &ball, [0.0, 3.01, 0.0], 0.0, false),
            (&can, &pill, [1.49, 0.0, 0.0], 0.0, true),
            (&can, &pill, [1.51, 0.0, 0.0], 0.0, false),
            // The tip of a cone is three quarters of its height above its centre of mass.
            (&cone, &ball, [0.0, 3.99, 0.0], 0.0, true),
            (&cone, &ball, [0.0, 4.01, 0.0], 0.0, false),
            (&cone, &ball, [0.0, -1.99, 0.0], 0.0, true),
            (&cone, &ball, [0.0, -2.01, 0.0], 0.0, false),
        ] {
            let (a, b) = (placed(one, [0.0; 3], 0.0), placed(two, place, turn));
            assert_eq!(a.intersects(&b), intersects, "{one:?} {two:?} {place:?}");
            assert_eq!(b.intersects(&a), intersects, "{two:?} {one:?} {place:?}");
        }
    }

    /// A box with the largest possible rounding is a ball, so the distance of the centres gives the expected result. The intersection test
    /// of such a box needs iterations, unlike that of two spheres.
    #[test]
    fn round_boxes_meet_as_balls_do() {
        let (ball, round) =
            (Shape::Sphere { radius: 0.5 }, Shape::RoundedBox { size: DVec3::ONE, rounding: 0.5 });
        for i in 0..2000 {
            let at = |k: f64| (f64::from(i) * k).fract() * 1.6 - 0.8;
            let place = [at(0.618_033), at(0.414_213), at(0.732_050)];
            let distance = DVec3::from_array(place).length();
            if (distance - 1.0).abs() > 1e-3 {
                let intersects = placed(&ball, [0.0; 3], 0.0).intersects(&placed(&round, place, 20.0));
                assert_eq!(intersects, distance < 1.0, "{place:?}");
            }
        }
    }
}
