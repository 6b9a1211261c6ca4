//! Compares triangles with the exact shapes.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DQuat, DVec3, Vec3};

use super::*;
use crate::physics::{Compound, Mesh, Part, Shape};

/// A tetrahedron with unequal edges.
fn tetrahedron() -> Mesh {
    let vertices = vec![DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 3.0, DVec3::Z];
    Mesh::new("tetrahedron", vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
}

fn solids() -> Vec<Shape> {
    let size = DVec3::new(1.0, 2.0, 0.5);
    let mesh =
        |smooth: Option<f64>| Shape::Mesh { mesh: Arc::new(tetrahedron().with_smooth(smooth)), scale: 0.5 };
    vec![
        Shape::Sphere { radius: 0.7 },
        Shape::Box { size },
        Shape::RoundedBox { size, rounding: 0.1 },
        Shape::RoundedBox { size, rounding: 0.25 },
        Shape::RoundedBox { size: DVec3::ONE, rounding: 0.5 },
        Shape::Cylinder { radius: 0.3, height: 2.0 },
        Shape::Capsule { radius: 0.3, height: 2.0 },
        Shape::Capsule { radius: 0.3, height: 0.6 },
        Shape::Cone { radius: 0.5, top_radius: 0.0, height: 1.5 },
        Shape::Cone { radius: 0.0, top_radius: 0.5, height: 1.5 },
        Shape::Cone { radius: 0.5, top_radius: 0.3, height: 0.5 },
        Shape::Cone { radius: 0.2, top_radius: 0.2, height: 0.5 },
        Shape::Torus { radius: 1.0, tube_radius: 0.25 },
        Shape::Torus { radius: 0.5, tube_radius: 0.5 },
        mesh(None),
        mesh(Some(0.1)),
        mesh(Some(3.2)),
    ]
}

/// The corners of a piece's triangles in body axes: position and normal.
fn placed(piece: &Piece, detail: Detail) -> Vec<[(DVec3, DVec3); 3]> {
    let triangles = piece.form.triangles(detail);
    assert_eq!(triangles.positions.len(), triangles.normals.len());
    assert_eq!(triangles.indices.len() % 3, 0);
    let vertex = |index: u32| {
        let position = Vec3::from_array(triangles.positions[index as usize]).as_dvec3();
        let normal = Vec3::from_array(triangles.normals[index as usize]).as_dvec3();
        assert!((normal.length() - 1.0).abs() < 1e-6, "{normal}");
        let place = piece.location + piece.orientation * (piece.scale * position);
        (place, (piece.orientation * (normal / piece.scale)).normalize())
    };
    triangles.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|i| vertex(corners[i]))).collect()
}

fn whole(shape: &Shape, detail: Detail) -> Vec<[(DVec3, DVec3); 3]> {
    pieces(shape).iter().flat_map(|piece| placed(piece, detail)).collect()
}

/// The volume enclosed by triangles, by the divergence theorem.
fn volume(triangles: &[[(DVec3, DVec3); 3]]) -> f64 {
    triangles.iter().map(|[(a, _), (b, _), (c, _)]| a.dot(b.cross(*c)) / 6.0).sum()
}

/// The relative difference between the area of a circle and that of an inscribed regular polygon.
fn loss(sides: u32) -> f64 {
    let angle = std::f64::consts::TAU / f64::from(sides);
    1.0 - libm::sin(angle) / angle
}

/// Each edge must be passed once in either direction. There are then no holes and no reversed triangles.
#[test]
fn closed_forms_are_closed() {
    for shape in solids() {
        for piece in pieces(&shape) {
            assert!(piece.form.is_closed());
            let Triangles { positions, indices, .. } = piece.form.triangles(Detail::Coarse);
            let at = |index: u32| positions[index as usize].map(|part| (part + 0.0).to_bits());
            let mut passes: HashMap<_, i32> = HashMap::new();
            for corners in indices.chunks_exact(3) {
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let (from, to) = (at(corners[i]), at(corners[j]));
                    assert_ne!(from, to, "{shape:?}");
                    let sense = if from < to { 1 } else { -1 };
                    *passes.entry((from.min(to), from.max(to))).or_default() += sense;
                }
            }
            assert!(passes.values().all(|&sum| sum == 0), "{shape:?}");
        }
    }
}

#[test]
fn normals_point_where_triangles_do() {
    for shape in solids() {
        for detail in [Detail::Fine, Detail::Coarse] {
            for corners in whole(&shape, detail) {
                let [a, b, c] = corners.map(|(place, _)| place);
                let face = (b - a).cross(c - a).normalize();
                // The fully smoothed tetrahedron has vertex normals that differ much from its face normals.
                let least = if matches!(shape, Shape::Mesh { .. }) { 0.0 } else { 0.9 };
                assert!(corners.iter().all(|(_, normal)| normal.dot(face) > least), "{shape:?}: {corners:?}");
            }
        }
    }
}

/// The missing volume comes from polygons instead of circles: once around the axis, and once along the profile. For a circle of radius 1
/// and a chord of length h, the mean distance between the chord and its arc is h²/12. The circle loses twice this fraction of its area, and
/// a ball three times this fraction of its volume.
#[test]
fn volumes_converge_to_those_of_the_shapes() {
    for shape in solids() {
        let exact = shape.volume().unwrap();
        let missing = |detail| 1.0 - volume(&whole(&shape, detail)) / exact;
        // A torus also loses the difference at its tube, which has half as many sides.
        let most = |detail: Detail| match shape {
            Shape::Torus { .. } => 1.05 * (loss(detail.sides()) + loss(detail.sides() / 2)),
            _ => 2.55 * loss(detail.sides()),
        };
        for detail in [Detail::Fine, Detail::Coarse] {
            let missing = missing(detail);
            assert!((-1e-6..most(detail)).contains(&missing), "{shape:?} {detail:?}: {missing}");
        }
        if missing(Detail::Coarse) > 1e-5 {
            let ratio = missing(Detail::Coarse) / missing(Detail::Fine);
            assert!((7.5..9.5).contains(&ratio), "{shape:?}: a third of the angle is a ninth: {ratio}");
        }
    }
}

/// Vertices lie on the surface. Between them, chords are below the surface by the sagitta, in two directions.
#[test]
fn extents_are_those_of_the_shapes() {
    let directions = (0..200).map(|i| {
        let y = (f64::from(i) + 0.5) / 100.0 - 1.0;
        let (sine, cosine) = libm::sincos(2.4 * f64::from(i));
        DVec3::new((1.0 - y * y).sqrt() * cosine, y, (1.0 - y * y).sqrt() * sine)
    });
    let directions: Vec<_> = directions.collect();
    for shape in solids() {
        let size = shape.bounding_radius().unwrap();
        let triangles = whole(&shape, Detail::Fine);
        for &direction in &directions {
            let exact = shape.support(DQuat::IDENTITY, direction).unwrap();
            let found = triangles.iter().flatten().map(|(place, _)| place.dot(direction));
            let missing = exact - found.fold(f64::MIN, f64::max);
            let sagitta = 1.0 - libm::cos(std::f64::consts::PI / 24.0);
            assert!((-1e-6 * size..2.0 * sagitta * size).contains(&missing), "{shape:?}: {missing}");
        }
    }
}

#[test]
fn details_have_as_many_vertices_as_they_promise() {
    let vertices = |detail| BaseShape::BALL.triangles(detail).positions.len();
    assert_eq!([vertices(Detail::Fine), vertices(Detail::Coarse)], [48 * 23 + 2, 16 * 7 + 2]);
}

#[test]
fn bodies_of_one_kind_share_a_form() {
    let form = |shape: &Shape| pieces(shape)[0].form.clone();
    let scaled = |shape: &Shape| assert_eq!(form(shape), form(&shape.scaled(2.0)));
    solids().iter().for_each(scaled);
    let (one, other) = (Arc::new(tetrahedron()), Arc::new(tetrahedron()));
    assert_eq!(BaseShape::mesh(Arc::clone(&one)), BaseShape::mesh(Arc::clone(&one)));
    assert_ne!(BaseShape::mesh(one), BaseShape::mesh(other), "each is where it is");
    assert_ne!(BaseShape::torus(0.5), BaseShape::torus(0.25));
}

#[test]
fn a_compound_has_the_pieces_of_its_parts_at_their_places() {
    let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let part = |shape, location, orientation| Part { shape, location, orientation };
    let compound = Shape::Compound(Compound::new(vec![
        part(Shape::Sphere { radius: 0.5 }, DVec3::X, DQuat::IDENTITY),
        part(Shape::Cylinder { radius: 0.1, height: 3.0 }, DVec3::NEG_Y, turn),
    ]));
    let exact = compound.volume().unwrap();
    let found = volume(&whole(&compound, Detail::Fine));
    assert!((0.99 * exact..exact).contains(&found), "{found} of {exact}");
    for direction in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
        let exact = compound.support(DQuat::IDENTITY, direction).unwrap();
        let places = whole(&compound, Detail::Fine);
        let found = places.iter().flatten().map(|(place, _)| place.dot(direction)).fold(f64::MIN, f64::max);
        assert!((found - exact).abs() < 1e-6, "{direction}: {found}, {exact}");
    }
}

#[test]
fn axes_reach_as_far_as_their_arms_and_have_four_colors() {
    let axes = Shape::Axes { length: 2.0 };
    let pieces = pieces(&axes);
    assert_eq!(pieces.len(), 7);
    let mut colors: Vec<_> = pieces.iter().map(|piece| piece.color.unwrap().0).collect();
    colors.dedup();
    assert_eq!(colors.len(), 4);
    let places = whole(&axes, Detail::Fine);
    for direction in [DVec3::X, DVec3::Y, DVec3::Z] {
        let reach = places.iter().flatten().map(|(place, _)| place.dot(direction)).fold(f64::MIN, f64::max);
        assert!((reach - 2.0).abs() < 1e-6, "{reach}");
    }
}

#[test]
fn a_plane_is_a_square_whose_front_is_where_its_normal_points() {
    let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
    let [piece] = &pieces(&Shape::Plane { normal })[..] else { panic!("one piece") };
    assert!(!piece.form.is_closed());
    for corners in placed(piece, Detail::Fine) {
        let [(a, _), (b, _), (c, _)] = corners;
        assert!((b - a).cross(c - a).normalize().abs_diff_eq(normal, 1e-6));
        assert!(corners.iter().all(|(_, each)| each.abs_diff_eq(normal, 1e-6)));
    }
}
