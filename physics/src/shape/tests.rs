//! Tests of the formulas of shapes against numerical sums over their volume.

use std::f64::consts::FRAC_PI_4;

use super::*;

/// Returns the volume, the centre of mass, and the moments of inertia for mass 1 about the coordinate axes, as sums over the cells of a
/// grid in a box. `inside` returns whether a point belongs to the shape.
fn by_cells(low: DVec3, high: DVec3, inside: impl Fn(DVec3) -> bool) -> (f64, DVec3, DVec3) {
    const CELLS: i32 = 160;
    let width = (high - low) / f64::from(CELLS);
    let (mut count, mut centre, mut moments) = (0.0, DVec3::ZERO, DVec3::ZERO);
    for i in 0..CELLS {
        for j in 0..CELLS {
            for k in 0..CELLS {
                let p = low + width * (DVec3::new(f64::from(i), f64::from(j), f64::from(k)) + 0.5);
                if inside(p) {
                    count += 1.0;
                    centre += p;
                    moments += DVec3::splat(p.length_squared()) - p * p;
                }
            }
        }
    }
    (count * width.element_product(), centre / count, moments / count)
}

/// The relative tolerance of the sums over cells. A cell at a round surface counts fully or not at all, which makes errors of about 1 % of
/// a layer of cells. The errors have both signs and mostly cancel. Flat faces coincide with faces of cells. A wrong factor (⅖ for ½) would
/// make an error of 25 %.
const GRID_TOLERANCE: f64 = 2e-3;

/// Checks the volume, the centre of mass and the inertia of a shape against sums over cells. The shape must just fit into the box from
/// `low` to `high`.
fn assert_solid(shape: &Shape, low: DVec3, high: DVec3, inside: impl Fn(DVec3) -> bool) {
    let (volume, centre, moments) = by_cells(low, high, inside);
    let given = shape.volume().unwrap();
    assert!((given - volume).abs() < GRID_TOLERANCE * volume, "{shape:?}: {given} {volume}");
    assert!(centre.abs_diff_eq(DVec3::ZERO, GRID_TOLERANCE), "{shape:?}: {centre}");
    let given = shape.inertia(3.0) / 3.0;
    assert!(
        given.abs_diff_eq(moments, GRID_TOLERANCE * moments.max_element()),
        "{shape:?}: {given} {moments}"
    );
}

/// Returns the distance of a point from the y axis.
fn from_axis(p: DVec3) -> f64 {
    libm::hypot(p.x, p.z)
}

#[test]
fn volume_and_inertia_are_the_integrals_over_the_solid() {
    let symmetric = |shape: Shape, half: DVec3, inside: &dyn Fn(DVec3) -> bool| {
        assert_solid(&shape, -half, half, inside);
    };
    symmetric(Shape::Sphere { radius: 0.7 }, DVec3::splat(0.7), &|p| p.length() < 0.7);
    symmetric(Shape::Axes { length: 1.4 }, DVec3::splat(0.7), &|p| p.length() < 0.7);
    let size = DVec3::new(2.0, 1.2, 0.4);
    symmetric(Shape::Box { size }, size, &|p| p.abs().cmplt(size / 2.0).all());
    symmetric(Shape::Cylinder { radius: 0.6, height: 1.8 }, DVec3::new(0.6, 0.9, 0.6), &|p| {
        from_axis(p) < 0.6
    });
    symmetric(Shape::Capsule { radius: 0.4, height: 1.9 }, DVec3::new(0.4, 0.95, 0.4), &|p| {
        p.distance(DVec3::Y * p.y.clamp(-0.55, 0.55)) < 0.4
    });
    symmetric(Shape::Torus { radius: 0.7, tube_radius: 0.25 }, DVec3::new(0.95, 0.25, 0.95), &|p| {
        libm::hypot(from_axis(p) - 0.7, p.y) < 0.25
    });
    for (size, rounding) in
        [(DVec3::new(1.9, 1.2, 0.8), 0.25), (DVec3::new(1.9, 1.2, 0.8), 0.4), (DVec3::splat(1.8), 0.9)]
    {
        let inner = 0.5 * size - rounding;
        symmetric(Shape::RoundedBox { size, rounding }, 0.5 * size, &|p| {
            p.distance(p.clamp(-inner, inner)) < rounding
        });
    }
}

#[test]
fn cones_stand_with_their_centre_of_mass_at_the_origin() {
    for (radius, top_radius, height) in [(0.9, 0.0, 1.3), (0.9, 0.3, 1.2), (0.3, 0.9, 1.2), (0.6, 0.6, 1.8)] {
        let base = cone_base(radius, top_radius, height);
        let widest = f64::max(radius, top_radius);
        let (low, high) = (DVec3::new(-widest, base, -widest), DVec3::new(widest, base + height, widest));
        assert_solid(&Shape::Cone { radius, top_radius, height }, low, high, |p| {
            from_axis(p) < radius + (top_radius - radius) * (p.y - base) / height
        });
    }
    assert_eq!(cone_base(2.0, 0.0, 4.0), -1.0);
}

#[test]
fn limits_of_the_shapes_are_other_shapes() {
    let same = |a: &Shape, b: &Shape| {
        let (volume, other) = (a.volume().unwrap(), b.volume().unwrap());
        assert!((volume - other).abs() < 1e-14 * volume, "{a:?} {b:?}");
        let (inertia, other) = (a.inertia(2.0), b.inertia(2.0));
        assert!(inertia.abs_diff_eq(other, 1e-14 * inertia.max_element()), "{a:?} {b:?}: {inertia} {other}");
    };
    let ball = Shape::Sphere { radius: 0.7 };
    same(&Shape::Capsule { radius: 0.7, height: 1.4 }, &ball);
    same(&Shape::RoundedBox { size: DVec3::splat(1.4), rounding: 0.7 }, &ball);
    let (radius, height) = (0.7, 2.0);
    same(&Shape::Cone { radius, top_radius: radius, height }, &Shape::Cylinder { radius, height });
    let size = DVec3::new(1.0, 2.0, 3.0);
    same(&Shape::RoundedBox { size, rounding: 0.0 }, &Shape::Box { size });
    let tall = DVec3::new(1.4, 3.0, 1.4);
    same(&Shape::RoundedBox { size: tall, rounding: 0.7 }, &Shape::Capsule { radius, height: 3.0 });
}

/// Compares the support function of each shape with a search over all grid points inside the shape.
#[test]
fn support_is_the_farthest_point_of_the_solid() {
    let about = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, -0.4);
    let direction = DVec3::new(0.5, -0.7, 0.3).normalize();
    let in_body = about.conjugate() * direction;
    let reach = |inside: &dyn Fn(DVec3) -> bool| {
        let mut farthest = f64::MIN;
        for i in -60..=60 {
            for j in -60..=60 {
                for k in -60..=60 {
                    let p = DVec3::new(f64::from(i), f64::from(j), f64::from(k)) / 60.0;
                    if inside(p) {
                        farthest = farthest.max(p.dot(in_body));
                    }
                }
            }
        }
        farthest
    };
    let base = cone_base(0.6, 0.2, 1.2);
    let solids: [(Shape, &dyn Fn(DVec3) -> bool); 5] = [
        (Shape::Cylinder { radius: 0.6, height: 1.2 }, &|p| from_axis(p) <= 0.6 && p.y.abs() <= 0.6),
        (Shape::Capsule { radius: 0.3, height: 1.6 }, &|p| {
            p.distance(DVec3::Y * p.y.clamp(-0.5, 0.5)) <= 0.3
        }),
        (Shape::Cone { radius: 0.6, top_radius: 0.2, height: 1.2 }, &|p| {
            let up = (p.y - base) / 1.2;
            (0.0..=1.0).contains(&up) && from_axis(p) <= 0.6 - 0.4 * up
        }),
        (Shape::Torus { radius: 0.6, tube_radius: 0.3 }, &|p| libm::hypot(from_axis(p) - 0.6, p.y) <= 0.3),
        (Shape::RoundedBox { size: DVec3::new(1.6, 1.2, 0.8), rounding: 0.3 }, &|p| {
            let inner = DVec3::new(0.5, 0.3, 0.1);
            p.distance(p.clamp(-inner, inner)) <= 0.3
        }),
    ];
    for (shape, inside) in solids {
        let (given, found) = (shape.support(about, direction).unwrap(), reach(inside));
        // The farthest point of the shape is at most about one cell, 1/60 m, from the nearest grid point inside.
        assert!(found <= given + 1e-9 && found > given - 0.02, "{shape:?}: {given} {found}");
    }
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
    let reach = |shape: &Shape, direction| shape.support(about_z, direction).unwrap();
    // A unit square that stands on its corner extends by half of its diagonal. The rotation about z does not change the extent along z.
    let cube = Shape::Box { size: DVec3::new(1.0, 1.0, 4.0) };
    assert!((reach(&cube, DVec3::NEG_Y) - 0.5_f64.sqrt()).abs() < 1e-15);
    assert!((reach(&cube, DVec3::NEG_Z) - 2.0).abs() < 1e-15);
    // The arms x and y point up, to the right and to the left. The lowest point is at the origin, below it by the radius of an arm.
    let axes = Shape::Axes { length: 2.0 };
    let thick = 2.0 * ARM_RADIUS;
    assert!((reach(&axes, DVec3::Y) - 2.0_f64.sqrt() - thick).abs() < 1e-15);
    assert_eq!(reach(&axes, DVec3::NEG_Z), thick);
    assert!((reach(&axes, DVec3::NEG_Y) - thick).abs() < 1e-15);
    assert_eq!(reach(&Shape::Sphere { radius: 3.0 }, DVec3::X), 3.0);
}

#[test]
fn a_scaled_shape_has_the_scaled_volume_inertia_and_reach() {
    let size = DVec3::new(1.0, 2.0, 3.0);
    for shape in [
        Shape::Compound(ell(DQuat::IDENTITY)),
        Shape::Sphere { radius: 0.7 },
        Shape::Box { size },
        Shape::RoundedBox { size, rounding: 0.2 },
        Shape::Cylinder { radius: 0.7, height: 2.0 },
        Shape::Capsule { radius: 0.7, height: 2.0 },
        Shape::Cone { radius: 0.7, top_radius: 0.2, height: 2.0 },
        Shape::Torus { radius: 0.7, tube_radius: 0.2 },
        Shape::Axes { length: 2.0 },
    ] {
        let scaled = shape.scaled(3.0);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-13 * b.abs(), "{shape:?}: {a} {b}");
        near(scaled.volume().unwrap(), 27.0 * shape.volume().unwrap());
        near(scaled.inertia(1.0).x, 9.0 * shape.inertia(1.0).x);
        // With these factors, powers of lengths come close to overflow or underflow.
        for factor in [1e-90, 1e90] {
            near(shape.scaled(factor).inertia(1.0).y, factor * factor * shape.inertia(1.0).y);
        }
        near(scaled.half_thickness().unwrap(), 3.0 * shape.half_thickness().unwrap());
        let reach = |shape: &Shape| shape.support(DQuat::IDENTITY, size.normalize()).unwrap();
        near(reach(&scaled), 3.0 * reach(&shape));
    }
}

/// Returns a compound of two bricks in the form of an L, rotated by `turn` as a whole. Its principal axes differ from the axes of the
/// bricks.
fn ell(turn: DQuat) -> Compound {
    let brick = |size: DVec3, location: DVec3| Part {
        shape: Shape::Box { size },
        location: turn * location + 7.0,
        orientation: turn,
    };
    Compound::new(vec![
        brick(DVec3::new(0.4, 1.6, 0.4), DVec3::new(-0.4, 0.0, 0.0)),
        brick(DVec3::new(0.8, 0.4, 0.4), DVec3::new(0.2, -0.6, 0.0)),
    ])
}

#[test]
fn a_compound_is_the_sum_over_its_cells() {
    let compound = ell(DQuat::IDENTITY);
    let shape = Shape::Compound(compound.clone());
    let inside = |p: DVec3| {
        compound.parts().iter().any(|part| match part.shape {
            Shape::Box { size } => (p - part.location).abs().cmplt(size / 2.0).all(),
            _ => false,
        })
    };
    let reach = |direction: DVec3| shape.support(DQuat::IDENTITY, direction).unwrap();
    let low = -DVec3::new(reach(-DVec3::X), reach(-DVec3::Y), reach(-DVec3::Z));
    let high = DVec3::new(reach(DVec3::X), reach(DVec3::Y), reach(DVec3::Z));
    assert!((high - low).abs_diff_eq(DVec3::new(1.2, 1.6, 0.4), 1e-14));
    // The inner faces of the bricks lie within cells of the grid. The error is up to one cell in the 50 cells of a brick's thickness.
    let tolerance = 0.01;
    let (volume, centre, moments) = by_cells(low, high, inside);
    assert!((shape.volume().unwrap() - volume).abs() < tolerance * volume);
    assert!(centre.abs_diff_eq(DVec3::ZERO, tolerance), "{centre}");
    // The diagonal of the inertia tensor in body axes follows from the principal moments and axes.
    let turn = glam::DMat3::from_quat(shape.principal_axes());
    let tensor = turn * glam::DMat3::from_diagonal(shape.inertia(1.0)) * turn.transpose();
    let own = DVec3::new(tensor.x_axis.x, tensor.y_axis.y, tensor.z_axis.z);
    assert!(own.abs_diff_eq(moments, tolerance * moments.max_element()), "{own} {moments}");
    assert!(tensor.x_axis.y.abs() > 0.01, "the axes of an L are not its own: {tensor}");
}

#[test]
fn a_compound_that_is_turned_has_the_same_principal_moments() {
    let sorted = |shape: &Compound| {
        let mut moments = shape.inertia().to_array();
        moments.sort_unstable_by(f64::total_cmp);
        DVec3::from_array(moments)
    };
    let straight = ell(DQuat::IDENTITY);
    for angle in [0.1, 1.0, 2.5] {
        let turned = ell(DQuat::from_euler(glam::EulerRot::XYZ, angle, -angle, 0.3));
        assert!(sorted(&turned).abs_diff_eq(sorted(&straight), 1e-14));
    }
}

#[test]
fn halves_of_a_box_are_the_box() {
    let half = |y: f64| Part {
        shape: Shape::Box { size: DVec3::new(1.0, 1.0, 3.0) },
        location: DVec3::Y * y,
        orientation: DQuat::IDENTITY,
    };
    let (both, whole) =
        (Compound::new(vec![half(4.5), half(5.5)]), Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) });
    assert!(both.inertia().abs_diff_eq(whole.inertia(1.0), 1e-14));
    assert_eq!((both.volume(), both.principal_axes()), (6.0, DQuat::IDENTITY));
    assert_eq!(both.parts()[0].location, DVec3::new(0.0, -0.5, 0.0));
}

#[test]
fn the_ball_around_a_shape_holds_it_and_touches_it() {
    let part = |shape, location| Part { shape, location, orientation: DQuat::from_rotation_x(0.4) };
    let ball = Shape::Sphere { radius: 0.5 };
    let dumbbell = Compound::new(vec![part(ball.clone(), DVec3::X), part(ball.clone(), -DVec3::X)]);
    for shape in [
        ball,
        Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) },
        Shape::RoundedBox { size: DVec3::new(1.0, 2.0, 3.0), rounding: 0.2 },
        Shape::Cylinder { radius: 1.0, height: 3.0 },
        Shape::Capsule { radius: 0.5, height: 3.0 },
        Shape::Cone { radius: 1.0, top_radius: 0.3, height: 2.0 },
        Shape::Cone { radius: 0.2, top_radius: 1.0, height: 2.0 },
        Shape::Torus { radius: 1.0, tube_radius: 0.2 },
        Shape::Compound(dumbbell),
    ] {
        let radius = shape.bounding_radius().unwrap();
        let mut reach: f64 = 0.0;
        for i in 0..400 {
            for j in 0..400 {
                let (across, along) = (f64::from(i) * 0.015_71, f64::from(j) * 0.007_86);
                let (sin, cos) = libm::sincos(along);
                let direction = DVec3::new(sin * libm::cos(across), cos, sin * libm::sin(across));
                reach = reach.max(shape.support(DQuat::IDENTITY, direction).unwrap());
            }
        }
        // The nearest sampled direction differs from the exact direction by at most half a step of 0.0157 rad. In that direction, the
        // extent is smaller by the factor 1 − 0.0079²/2.
        assert!(
            reach <= radius * (1.0 + 1e-12) && reach > radius * (1.0 - 1e-4),
            "{shape:?}: {reach} {radius}"
        );
    }
    assert_eq!(Shape::Plane { normal: DVec3::Y }.bounding_radius(), None);
}
