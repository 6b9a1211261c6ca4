//! Tests of meshes against closed forms of their solids.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::*;
use crate::shape::Shape;
use crate::{METHODS, RigidBody, World};

/// The relative tolerance for rounding errors of sums over some thousand triangles.
const RELATIVE_ROUNDING: f64 = 1e-12;

/// Returns the surface of a box about a centre, with its faces oriented outwards.
fn cuboid(size: DVec3, turn: DQuat, centre: DVec3) -> Mesh {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 0 { -0.5 } else { 0.5 };
        turn * (size * DVec3::new(side(0), side(1), side(2))) + centre
    };
    // Each face lists its corners in counter-clockwise order, seen from outside.
    let faces: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh::new("box", (0..8).map(corner).collect(), triangles)
}

/// Returns a surface that is closed in both directions. `point` returns the vertex for two angles, rad. The first angle takes `rows`
/// values around the circle, the second one `columns` values.
fn ring(rows: u32, columns: u32, point: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let angle = |i: u32, of: u32| 2.0 * PI * f64::from(i) / f64::from(of);
    let grid = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let vertices = grid.clone().map(|(i, j)| point(angle(i, rows), angle(j, columns))).collect();
    let number = |i: u32, j: u32| i % rows * columns + j % columns;
    let triangles = grid.flat_map(|(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    Mesh::new("ring", vertices, triangles.collect())
}

fn torus(radius: f64, tube_radius: f64, rows: u32, columns: u32) -> Mesh {
    ring(rows, columns, |around, tube| {
        let from_axis = radius + tube_radius * libm::cos(tube);
        DVec3::new(
            from_axis * libm::sin(around),
            tube_radius * libm::sin(tube),
            from_axis * libm::cos(around),
        )
    })
}

/// Returns a ball, made as a torus whose inner circle has shrunk to the axis. Some triangles there have two corners at the same position.
fn ball(radius: f64, n: u32) -> Mesh {
    let Mesh { vertices, triangles, .. } = ring(2 * n, n + 1, |around, along| {
        // Columns 0 to n run from one pole to the other.
        let polar = along * f64::from(n + 1) / f64::from(2 * n);
        let from_axis = radius * libm::sin(polar);
        DVec3::new(from_axis * libm::sin(around), radius * libm::cos(polar), from_axis * libm::cos(around))
    });
    // All vertices at a pole are merged into one, as readers of mesh files do.
    let pole = |vertex: u32| match vertex % (n + 1) {
        0 => 0,
        last if last == n => n,
        _ => vertex,
    };
    let triangles = triangles.into_iter().map(|corners| corners.map(pole));
    Mesh::new("ball", vertices, triangles.collect())
}

fn tensor(mesh: &Mesh) -> DMat3 {
    let turn = DMat3::from_quat(mesh.principal_axes());
    turn * DMat3::from_diagonal(mesh.inertia()) * turn.transpose()
}

#[test]
fn a_box_of_triangles_is_a_box() {
    let size = DVec3::new(3.0, 1.0, 2.0);
    let whole = Shape::Box { size };
    for (turn, centre) in [
        (DQuat::IDENTITY, DVec3::ZERO),
        (DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0), DVec3::new(100.0, -40.0, 7.0)),
    ] {
        let mesh = cuboid(size, turn, centre);
        assert_eq!(mesh.flaw(), None);
        assert!((mesh.volume().unwrap() - 6.0).abs() < 6.0 * RELATIVE_ROUNDING);
        let turn = DMat3::from_quat(turn);
        let expected = turn * DMat3::from_diagonal(whole.inertia(1.0)) * turn.transpose();
        assert!(tensor(&mesh).abs_diff_eq(expected, RELATIVE_ROUNDING), "{}", tensor(&mesh));
        let middle = mesh.vertices().iter().sum::<DVec3>() / 8.0;
        assert!(middle.abs_diff_eq(DVec3::ZERO, 100.0 * RELATIVE_ROUNDING), "{middle}");
    }
    assert_eq!(cuboid(size, DQuat::IDENTITY, DVec3::ZERO).principal_axes(), DQuat::IDENTITY);
}

/// The second moment of a tetrahedron about its centre is C = V/20 Σ p pᵀ over its corners p (Tonon, *Explicit Exact Formulas for the 3-D
/// Tetrahedron Inertia Tensor*, 2004).
#[test]
fn a_tetrahedron_has_the_inertia_of_its_corners() {
    let corners =
        [[0.3, -0.2, 0.1], [1.7, 0.4, 0.0], [0.1, 2.2, 0.5], [-0.4, 0.3, 1.9]].map(DVec3::from_array);
    let mesh = Mesh::new("tetrahedron", corners.into(), vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    let [a, b, c] = [1, 2, 3].map(|i| corners[i] - corners[0]);
    assert!((mesh.volume().unwrap() - a.dot(b.cross(c)) / 6.0).abs() < RELATIVE_ROUNDING);
    let centre = corners.iter().sum::<DVec3>() / 4.0;
    let second = corners.iter().fold(DMat3::ZERO, |sum, corner| {
        let p = *corner - centre;
        sum + DMat3::from_cols(p * p.x, p * p.y, p * p.z) * 0.05
    });
    let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
    let expected = DMat3::from_diagonal(DVec3::splat(trace)) - second;
    assert!(tensor(&mesh).abs_diff_eq(expected, RELATIVE_ROUNDING), "{}", tensor(&mesh));
    assert!((mesh.vertices()[2] - (corners[2] - centre)).length() < RELATIVE_ROUNDING);
}

/// A regular polygon with n corners has the fraction n sin(2π/n)/2π of the area of its circle. A ring of m wedges has m sin(2π/m)/2π of
/// the volume of the full ring.
#[test]
fn a_torus_of_triangles_has_the_volume_of_its_polygons() {
    let part = |n: u32| f64::from(n) * libm::sin(2.0 * PI / f64::from(n)) / (2.0 * PI);
    let round = Shape::Torus { radius: 2.0, tube_radius: 0.5 }.volume().unwrap();
    let mesh = torus(2.0, 0.5, 24, 16);
    let expected = round * part(24) * part(16);
    assert!(
        (mesh.volume().unwrap() - expected).abs() < expected * RELATIVE_ROUNDING,
        "{:?} {expected}",
        mesh.volume()
    );
}

/// Approximation by flat triangles has an error of second order in their size: twice as many triangles along each direction must leave a
/// quarter of the error. The bound follows from the mean gap between chord and arc, (2π/n)²/12 of the radius in each of two directions,
/// and from moments of inertia that grow with the fifth power of lengths.
#[test]
fn round_solids_of_triangles_approach_the_round_ones_in_second_order() {
    let error = |mesh: Mesh, round: &Shape| {
        let expected = round.inertia(1.0) * round.volume().unwrap();
        ((mesh.inertia() * mesh.volume().unwrap() - expected) / expected).abs().max_element()
    };
    let ring = Shape::Torus { radius: 2.0, tube_radius: 0.5 };
    let whole = Shape::Sphere { radius: 1.3 };
    for (coarse, fine) in [
        (error(torus(2.0, 0.5, 48, 48), &ring), error(torus(2.0, 0.5, 96, 96), &ring)),
        (error(ball(1.3, 24), &whole), error(ball(1.3, 48), &whole)),
    ] {
        let gap = (2.0 * PI / 48.0) * (2.0 * PI / 48.0) / 12.0;
        assert!(coarse < 2.0 * 5.0 * gap * 2.0, "{coarse}");
        assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse} {fine}");
    }
}

#[test]
fn a_surface_that_shows_its_inside_is_turned() {
    let mesh = torus(2.0, 0.5, 8, 8);
    let inward = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = Mesh::new("inward", mesh.vertices().to_vec(), inward);
    assert_eq!(turned.flaw(), None);
    assert!((turned.volume().unwrap() - mesh.volume().unwrap()).abs() < RELATIVE_ROUNDING);
    assert_eq!(turned.triangles().len(), mesh.triangles().len());
    assert!(tensor(&turned).abs_diff_eq(tensor(&mesh), RELATIVE_ROUNDING));
}

#[test]
fn what_encloses_nothing_says_why() {
    let whole = cuboid(DVec3::ONE, DQuat::IDENTITY, DVec3::splat(5.5));
    let vertices = || whole.vertices().iter().map(|vertex| *vertex + 5.5).collect::<Vec<_>>();
    let mut triangles = whole.triangles().to_vec();
    let [a, b, c] = triangles[0];
    triangles[0] = [a, c, b];
    let inconsistent = Mesh::new("", vertices(), triangles.clone());
    let Some(Flaw::Inconsistent { edges: 3, first }) = inconsistent.flaw() else {
        panic!("{:?}", inconsistent.flaw())
    };
    assert!(
        first.iter().all(|end| end.abs_diff_eq(end.round(), RELATIVE_ROUNDING)),
        "in the file's coordinates: {first:?}"
    );

    triangles[0] = [a, b, c];
    triangles.truncate(10);
    let open = Mesh::new("", vertices(), triangles.clone());
    assert!(matches!(open.flaw(), Some(Flaw::Open { edges: 4, .. })), "{:?}", open.flaw());
    assert_eq!((open.volume(), open.inertia()), (None, DVec3::ZERO));
    // The open box lacks its face at +z, so the centre of its surface is 0.1 below the centre of the box.
    assert!((open.support(DVec3::Z) - 0.6).abs() < RELATIVE_ROUNDING, "{}", open.support(DVec3::Z));

    let flat = Mesh::new("", vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2], [2, 1, 0]]);
    assert_eq!(flat.flaw(), Some(&Flaw::Flat));
    assert_eq!(flat.half_thickness(), None);
    // A triangle with two equal corners must not change whether the surface is closed.
    triangles.clone_from(&whole.triangles().to_vec());
    triangles.push([3, 3, 5]);
    assert_eq!(Mesh::new("", vertices(), triangles).flaw(), None);
}

#[test]
fn the_farthest_vertex_is_found_among_many() {
    let mesh = torus(2.0, 0.5, 40, 30);
    for i in 0..200 {
        let (turn, lift) = (f64::from(i) * 0.7, f64::from(i) * 0.01 - 1.0);
        let direction = DVec3::new(libm::cos(turn), lift, libm::sin(turn)).normalize();
        let farthest = mesh.vertices().iter().map(|vertex| vertex.dot(direction)).fold(f64::MIN, f64::max);
        assert_eq!(mesh.support(direction), farthest);
    }
}

#[test]
fn a_box_of_triangles_tumbles_as_the_box_does() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.5, 0.4, -0.9);
    let size = DVec3::new(3.0, 1.0, 2.0);
    let mesh = Arc::new(cuboid(size / 10.0, turn, DVec3::new(0.4, 0.0, 9.0)));
    let tumble = |shape: &Shape, orientation: DQuat| {
        let mut world = World::new();
        world.set_integrator(METHODS.iter().find(|method| method.name == "rk4").unwrap());
        world.set_step(1.0 / 240.0);
        let body = RigidBody::new(shape, 2.0).with_orientation(orientation);
        let body =
            world.add(body.with_angular_velocity(DVec3::new(0.3, 0.2, 3.0)).with_torque(DVec3::X * 0.1));
        world.advance_to(2.0);
        (world.orientation(body), world.angular_velocity(body))
    };
    let (whole, spin) = tumble(&Shape::Box { size }, turn);
    let shape = Shape::Mesh { mesh, scale: 10.0 };
    assert!((shape.volume().unwrap() - 6.0).abs() < RELATIVE_ROUNDING * 100.0);
    let reach = |shape: &Shape| shape.support(turn, DVec3::X).unwrap();
    assert!((reach(&shape.scaled(0.1)) * 10.0 - reach(&shape)).abs() < RELATIVE_ROUNDING);
    let (triangles, other_spin) = tumble(&shape, DQuat::IDENTITY);
    assert!(spin.abs_diff_eq(other_spin, 1e-9), "{spin} {other_spin}");
    assert!((whole.dot(triangles * turn).abs() - 1.0).abs() < 1e-9);
}
