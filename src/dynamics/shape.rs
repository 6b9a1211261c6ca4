//! What a body looks like, as far as mechanics cares: volume, inertia and extent.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

/// The shape of a body, in its own frame: the centre of mass is the origin and the principal axes of inertia are
/// the coordinate axes. Lengths are metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A solid sphere.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// A solid box, its edges along the axes.
    Box {
        /// Full lengths of the edges along x, y and z, m.
        size: DVec3,
    },
    /// An infinite plane through the origin, with solid ground below it.
    Plane {
        /// Unit normal, in the frame of the body; it points out of the ground.
        normal: DVec3,
    },
    /// A triad of axes: three arms from the origin along x, y and z. It shows an orientation, and has the mechanics
    /// of a solid sphere with radius `length / 2`.
    Axes {
        /// Length of an arm, m.
        length: f64,
    },
}

/// The radius of an arm of the axes, at its thickest, in lengths of an arm.
const ARM_RADIUS: f64 = 0.078;

impl Shape {
    /// The volume in m³; `None` for a plane, which has no finite one.
    #[must_use]
    pub fn volume(&self) -> Option<f64> {
        match *self {
            Shape::Sphere { radius } => Some(sphere_volume(radius)),
            Shape::Box { size } => Some(size.element_product()),
            Shape::Plane { .. } => None,
            Shape::Axes { length } => Some(sphere_volume(length / 2.0)),
        }
    }

    /// The principal moments of inertia, kg m², of a homogeneous solid of `mass` kg.
    ///
    /// Sphere: ⅖ m r²; box: m/12 (b² + c²) and its permutations (Goldstein, *Classical Mechanics*, ch. 5). A plane
    /// has no finite moments; zero stands for them, which everywhere means that no torque turns the body.
    #[must_use]
    pub fn inertia(&self, mass: f64) -> DVec3 {
        match *self {
            Shape::Sphere { radius } => DVec3::splat(sphere_moment(mass, radius)),
            Shape::Box { size } => {
                let square = size * size;
                mass / 12.0 * DVec3::new(square.y + square.z, square.z + square.x, square.x + square.y)
            }
            Shape::Plane { .. } => DVec3::ZERO,
            Shape::Axes { length } => DVec3::splat(sphere_moment(mass, length / 2.0)),
        }
    }

    /// How far the shape reaches from its centre along the unit vector `direction` (world axes), in metres: the
    /// support function, the largest `p · direction` over its points `p`. `None` for a plane.
    #[must_use]
    pub fn support(&self, world_from_body: DQuat, direction: DVec3) -> Option<f64> {
        let direction = world_from_body.conjugate() * direction;
        match *self {
            Shape::Sphere { radius } => Some(radius),
            Shape::Box { size } => Some(0.5 * size.dot(direction.abs())),
            Shape::Plane { .. } => None,
            // The ends of the arms count: the three tips and the origin, whose p · direction is 0.
            Shape::Axes { length } => Some(length * (direction.max_element().max(0.0) + ARM_RADIUS)),
        }
    }

    /// Whether the shape has no end, as a plane has none.
    #[must_use]
    pub fn is_unbounded(&self) -> bool {
        matches!(self, Shape::Plane { .. })
    }
}

fn sphere_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}

fn sphere_moment(mass: f64, radius: f64) -> f64 {
    0.4 * mass * radius * radius
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::*;

    /// Volume and principal moments for mass 1, summed over the cells of a grid on the cube [-half, half]³.
    fn by_cells(half: f64, inside: impl Fn(DVec3) -> bool) -> (f64, DVec3) {
        const CELLS: i32 = 100;
        let width = 2.0 * half / f64::from(CELLS);
        let middle = |k: i32| (f64::from(k) + 0.5) * width - half;
        let (mut count, mut moments) = (0.0, DVec3::ZERO);
        for i in 0..CELLS {
            for j in 0..CELLS {
                for k in 0..CELLS {
                    let p = DVec3::new(middle(i), middle(j), middle(k));
                    if inside(p) {
                        count += 1.0;
                        moments += DVec3::splat(p.length_squared()) - p * p;
                    }
                }
            }
        }
        (count * width * width * width, moments / count)
    }

    /// The cells at the surface, counted whole or not at all, are about 6 of 100 deep along a diameter; their errors
    /// have either sign and cancel to well below a tenth of one layer's 1 %. A wrong factor (⅖ for ½) is 25 % off.
    const GRID_TOLERANCE: f64 = 2e-3;

    fn assert_solid(shape: Shape, half: f64, inside: impl Fn(DVec3) -> bool) {
        let (volume, moments) = by_cells(half, inside);
        let given = shape.volume().unwrap();
        assert!((given - volume).abs() < GRID_TOLERANCE * volume, "{given} {volume}");
        let given = shape.inertia(3.0) / 3.0;
        assert!(given.abs_diff_eq(moments, GRID_TOLERANCE * moments.max_element()), "{given} {moments}");
    }

    #[test]
    fn volume_and_inertia_are_the_integrals_over_the_solid() {
        assert_solid(Shape::Sphere { radius: 0.7 }, 0.7, |p| p.length() < 0.7);
        assert_solid(Shape::Axes { length: 1.4 }, 0.7, |p| p.length() < 0.7);
        // Edges that are whole numbers of cells (0.02 m), so that no cell is cut.
        let size = DVec3::new(2.0, 1.2, 0.4);
        assert_solid(Shape::Box { size }, 1.0, |p| p.abs().cmplt(size / 2.0).all());
    }

    #[test]
    fn a_plane_has_neither_volume_nor_moments_nor_end() {
        let plane = Shape::Plane { normal: DVec3::Y };
        assert!(plane.is_unbounded());
        assert_eq!(plane.volume(), None);
        assert_eq!(plane.inertia(1.0), DVec3::ZERO);
        assert_eq!(plane.support(DQuat::IDENTITY, DVec3::Y), None);
    }

    #[test]
    fn support_is_the_reach_along_a_direction() {
        let about_z = DQuat::from_rotation_z(FRAC_PI_4);
        let reach = |shape: Shape, direction| shape.support(about_z, direction).unwrap();
        // A unit square on its corner reaches half its diagonal; its thickness is as it was.
        let cube = Shape::Box { size: DVec3::new(1.0, 1.0, 4.0) };
        assert!((reach(cube, DVec3::NEG_Y) - 0.5_f64.sqrt()).abs() < 1e-15);
        assert!((reach(cube, DVec3::NEG_Z) - 2.0).abs() < 1e-15);
        // Arms x and y point up to either side; downward there is but the origin, as thick as an arm.
        let axes = Shape::Axes { length: 2.0 };
        let thick = 2.0 * ARM_RADIUS;
        assert!((reach(axes, DVec3::Y) - 2.0_f64.sqrt() - thick).abs() < 1e-15);
        assert_eq!(reach(axes, DVec3::NEG_Z), thick);
        assert!((reach(axes, DVec3::NEG_Y) - thick).abs() < 1e-15);
        assert_eq!(reach(Shape::Sphere { radius: 3.0 }, DVec3::X), 3.0);
    }
}
