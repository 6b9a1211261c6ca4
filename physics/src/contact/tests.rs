//! Tests of gaps against closed forms and against parry's shapes, and of the points at which solids touch.

use glam::{DQuat, DVec3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use std::sync::Arc;

use super::closest_points::{ClosestPoints, nearest};
use super::patch::{Patch, meet};
use super::solid::{Pose, Solid};
use super::touch::{Touch, inside, touches};
use crate::shape::{Mesh, Shape};

/// Random numbers between −1 and 1 from a fixed seed, the same in every run.
pub(super) struct Random(ChaCha8Rng);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(ChaCha8Rng::seed_from_u64(seed))
    }

    pub(super) fn number(&mut self) -> f64 {
        self.0.next_u64() as f64 / u64::MAX as f64 * 2.0 - 1.0
    }

    pub(super) fn vector(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    fn turn(&mut self) -> DQuat {
        let vector = self.vector();
        DQuat::from_xyzw(vector.x, vector.y, vector.z, self.number()).normalize()
    }

    pub(super) fn pose(&mut self, far: f64) -> Pose {
        Pose { location: far * self.vector(), orientation: self.turn() }
    }
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose { location: DVec3::new(x, y, z), orientation: DQuat::IDENTITY }
}

fn turned(pose: Pose, orientation: DQuat) -> Pose {
    Pose { orientation, ..pose }
}

#[allow(clippy::unwrap_used, reason = "a test fails where the shape is none that touches")]
pub(super) fn solid(shape: &Shape) -> Solid {
    Solid::of(shape).unwrap()
}

#[allow(clippy::unwrap_used, reason = "without a limit, there is a nearest place")]
fn near(a: &Shape, pa: &Pose, b: &Shape, pb: &Pose) -> ClosestPoints {
    nearest(&solid(a), pa, &solid(b), pb, f64::INFINITY).unwrap()
}

fn touch(a: &Shape, pa: &Pose, b: &Shape, pb: &Pose) -> Vec<Touch> {
    touches(&solid(a), pa, &solid(b), pb, 1e-6)
}

const GROUND: Shape = Shape::Plane { normal: DVec3::Y };
const BALL: Shape = Shape::Sphere { radius: 0.5 };
const CUBE: Shape = Shape::Box { size: DVec3::new(1.0, 1.4, 0.6) };
const ROUNDED_CUBE: Shape = Shape::RoundedBox { size: DVec3::new(1.0, 1.4, 0.6), rounding: 0.2 };
const CAN: Shape = Shape::Cylinder { radius: 0.4, height: 1.2 };
const PILL: Shape = Shape::Capsule { radius: 0.3, height: 1.6 };
const CONE: Shape = Shape::Cone { radius: 0.5, top_radius: 0.0, height: 1.0 };
const BUCKET: Shape = Shape::Cone { radius: 0.3, top_radius: 0.6, height: 0.8 };
/// All shapes above except the ground.
pub(super) const ALL_SHAPES: [Shape; 7] = [BALL, CUBE, ROUNDED_CUBE, CAN, PILL, CONE, BUCKET];

/// The rim of an upright can meets a rounded edge where both have the same direction. The rounded edge alone has the normal.
#[test]
fn a_rim_that_meets_a_rounded_edge_has_the_normal_of_the_edge() {
    // The axis of the edge is at x = 0.3 and y = 0.5.
    let (block, can) = (solid(&ROUNDED_CUBE), solid(&CAN));
    for degrees in [20.0_f64, 45.0, 70.0] {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let normal = DVec3::new(cos, sin, 0.0);
        for gap in [1e-2, 1e-5, 1e-8, 1e-10, 0.0, -1e-10, -1e-8, -1e-5] {
            let rim = DVec3::new(0.3, 0.5, 0.0) + (0.2 + gap) * normal;
            let (p, q) = (at(0.0, 0.0, 0.0), at(rim.x + 0.4, rim.y + 0.6, 0.0));
            let found = nearest(&block, &p, &can, &q, f64::INFINITY).unwrap();
            assert!((found.gap - gap).abs() < 1e-14, "{degrees}°, {gap}: {found:?}");
            let touches = touches(&block, &p, &can, &q, gap.abs() + 1e-9);
            assert_eq!(touches.len(), 1, "{degrees}°, {gap}: {touches:?}");
            assert!((touches[0].meeting.normal - normal).length() < 1e-7, "{degrees}°, {gap}: {touches:?}");
        }
    }
}

/// Logs that lie side by side and are almost parallel have the gap between their sides, and not the overlap of their ends.
#[test]
fn logs_side_by_side_have_the_gap_of_their_sides() {
    const LOG: Shape = Shape::Cylinder { radius: 0.1, height: 0.3 };
    let (log, lying) = (solid(&LOG), DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2));
    // The sides of these two cross far outside of the logs, in a point from which their ends seem to overlap.
    let pa = turned(
        at(-0.10631749081209203, 0.1000000000556526, -8.248519528784344e-10),
        DQuat::from_xyzw(0.7067540460518802, 0.022331988877859966, 0.022331988915161253, 0.7067540469874574),
    );
    let pb = turned(
        at(3.4941168761444083e-9, 0.26940071070234833, 1.4152146906186866e-9),
        DQuat::from_xyzw(
            0.7071067802809472,
            -7.743983674361987e-8,
            -7.800910286739715e-8,
            0.7071067820921394,
        ),
    );
    let gap = (pb.location - pa.location).length() - 0.2;
    let found = near(&LOG, &pa, &LOG, &pb);
    assert!((found.gap - gap).abs() < 1e-9, "{found:?}, {gap}");
    let mut random = Random::new(31);
    for k in 0..40_000 {
        let small = |k: usize| [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12][k % 6];
        let (tilt, slide, apart) = (small(k), small(k / 6), small(k / 36));
        let askew = |random: &mut Random| {
            let rolled = lying * DQuat::from_rotation_y(random.number());
            DQuat::from_scaled_axis(tilt * random.vector()) * rolled
        };
        let (one, other) = (askew(&mut random), askew(&mut random));
        let (gap, angle) = (apart * random.number(), random.number());
        let way = (0.2 + gap) * DVec3::new(libm::cos(angle), libm::sin(angle), 0.0);
        let (pa, pb) =
            (turned(at(0.0, 0.0, 0.0), one), turned(at(way.x, way.y, slide * random.number()), other));
        let found = near(&LOG, &pa, &LOG, &pb);
        assert!((found.gap - gap).abs() < 3.0 * tilt, "{found:?}, {gap}, {tilt}");
        for touch in touches(&log, &pa, &log, &pb, 1e-4) {
            assert!((touch.meeting.gap - gap).abs() < 6.0 * tilt, "{touch:?}, {gap}, {tilt}");
        }
    }
}

#[test]
fn gaps_have_closed_forms() {
    let lying = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let corner = DVec3::new(0.5, 0.7, 0.3);
    let diagonal = corner + 2.0 * DVec3::ONE;
    // A point on the side of the cone, relative to the center of mass, which is at a quarter of the height.
    let slope = DVec3::new(2.0, 1.0, 0.0).normalize();
    let on_side = DVec3::new(0.25, 0.25, 0.0);
    for (a, b, pose, gap) in [
        (&GROUND, &BALL, at(3.0, 0.75, -2.0), 0.25),
        (&GROUND, &CUBE, at(3.0, 0.75, -2.0), 0.05),
        (&GROUND, &CAN, turned(at(3.0, 0.75, -2.0), lying), 0.35),
        (&GROUND, &PILL, at(3.0, 0.75, -2.0), -0.05),
        (&GROUND, &CONE, at(3.0, 0.75, -2.0), 0.5),
        (&BALL, &BALL, at(1.2, 0.0, 0.9), 0.5),
        (&BALL, &CUBE, at(0.0, 1.7, 0.0), 0.5),
        (&CUBE, &BALL, at(1.5, 1.7, 0.2), 2.0_f64.sqrt() - 0.5),
        (&CUBE, &BALL, at(diagonal.x, diagonal.y, diagonal.z), 12.0_f64.sqrt() - 0.5),
        (&CUBE, &CUBE, at(0.1, 1.5, 0.2), 0.1),
        (&CUBE, &CUBE, at(0.1, 1.3, 0.1), -0.1),
        (&CUBE, &CUBE, at(1.3, 1.8, 0.2), 0.5),
        (&ROUNDED_CUBE, &CUBE, at(1.3, 1.8, 0.2), libm::hypot(0.5, 0.6) - 0.2),
        (&CAN, &BALL, at(1.2, 0.3, 0.0), 0.3),
        (&CAN, &BALL, at(0.7, 1.0, 0.0), 0.5 - 0.5),
        (&CAN, &CAN, at(0.6, 0.2, 0.8), 0.2),
        (&CAN, &CAN, turned(at(1.3, 0.1, 0.0), DQuat::from_rotation_x(1.0)), 0.5),
        (&CAN, &PILL, turned(at(1.0, 0.1, 0.0), DQuat::from_rotation_x(0.7)), 0.3),
        (&PILL, &PILL, at(0.0, 2.0, 0.0), 0.4),
        (&PILL, &PILL, at(0.9, 0.3, 0.0), 0.3),
        (&CONE, &BALL, at(0.0, 1.5, 0.0), 0.25),
        (&CONE, &BALL, at(on_side.x + slope.x, on_side.y + slope.y, 0.0), 0.5),
        (&CONE, &CONE, turned(at(0.0, -0.7, 0.0), DQuat::from_rotation_z(std::f64::consts::PI)), 0.2),
    ] {
        let found = near(a, &at(0.0, 0.0, 0.0), b, &pose);
        assert!((found.gap - gap).abs() < 2e-15, "{a:?} {b:?} {pose:?}: {found:?} {gap}");
        let along = (found.on[1] - found.on[0]).dot(found.normal);
        assert!((along - gap).abs() < 1e-14, "{a:?} {b:?} {pose:?}: {found:?} {gap}");
    }
}

/// Computes the gap of two shapes with parry's own shapes, independently of the solids under test.
#[cfg(feature = "time-stepping")]
#[allow(clippy::unwrap_used, reason = "parry knows these pairs")]
fn parry(a: &Shape, pa: &Pose, b: &Shape, pb: &Pose) -> f64 {
    use parry3d_f64::shape::{Ball, Capsule, Cone, Cuboid, Cylinder, SharedShape};
    let shape = |shape: &Shape| -> (SharedShape, f64) {
        match *shape {
            Shape::Sphere { radius } => (SharedShape::new(Ball::new(radius)), 0.0),
            Shape::Box { size } => (SharedShape::new(Cuboid::new(0.5 * size)), 0.0),
            Shape::RoundedBox { size, rounding } => {
                (SharedShape::new(Cuboid::new(0.5 * size - rounding)), rounding)
            }
            Shape::Cylinder { radius, height } => {
                (SharedShape::new(Cylinder::new(0.5 * height, radius)), 0.0)
            }
            Shape::Capsule { radius, height } => {
                (SharedShape::new(Capsule::new_y(0.5 * height - radius, radius)), 0.0)
            }
            _ => (SharedShape::new(Cone::new(0.5, 0.5)), 0.0),
        }
    };
    let place = |shape: &Shape, pose: &Pose| {
        let lift = if matches!(shape, Shape::Cone { .. }) { 0.25 * DVec3::Y } else { DVec3::ZERO };
        parry3d_f64::math::Pose {
            rotation: pose.orientation,
            translation: pose.location + pose.orientation * lift,
        }
    };
    let ((sa, ra), (sb, rb)) = (shape(a), shape(b));
    let found = parry3d_f64::query::contact(&place(a, pa), &*sa, &place(b, pb), &*sb, 1e9).unwrap();
    found.unwrap().dist - ra - rb
}

#[cfg(feature = "time-stepping")]
#[test]
fn gaps_are_those_of_parry() {
    let mut random = Random::new(1);
    let shapes = [BALL, CUBE, ROUNDED_CUBE, CAN, PILL, CONE];
    let mut worst = 0.0_f64;
    for a in &shapes {
        for b in &shapes {
            for _ in 0..200 {
                let (pa, pb) = (random.pose(0.9), random.pose(0.9));
                let (found, other) = (near(a, &pa, b, &pb), parry(a, &pa, b, &pb));
                // parry's closest points lie on the shapes, so its distance is never smaller than the gap. For round shapes, it can be
                // larger.
                let error = other - found.gap;
                worst = worst.max(error);
                assert!(error > -1e-9, "{a:?} {pa:?} {b:?} {pb:?}: {} {other}", found.gap);
                assert!(error < 5e-3 || other < 0.0, "{a:?} {pa:?} {b:?} {pb:?}: {} {other}", found.gap);
            }
        }
    }
    assert!(worst > 0.0);
}

/// The closest points lie on the bodies, and two parallel planes through them separate the bodies. Together, this proves that the gap is
/// right.
#[test]
fn nearest_places_prove_the_gap() {
    let mut random = Random::new(5);
    for a in &ALL_SHAPES {
        for b in &ALL_SHAPES {
            for _ in 0..100 {
                let (pa, pb) = (random.pose(0.9), random.pose(0.9));
                let found = near(a, &pa, b, &pb);
                if found.gap < 0.0 {
                    continue;
                }
                let what = format!("{a:?} {pa:?} {b:?} {pb:?}: {found:?}");
                assert!((found.on[1] - found.on[0] - found.gap * found.normal).length() < 1e-9, "{what}");
                let dot = Shape::Sphere { radius: 1e-9 };
                for (shape, pose, place, out) in
                    [(a, &pa, found.on[0], found.normal), (b, &pb, found.on[1], -found.normal)]
                {
                    let reach = shape.support(pose.orientation, out).unwrap_or(f64::INFINITY);
                    assert!((reach - (place - pose.location).dot(out)).abs() < 1e-9, "{what}");
                    let place = Pose { location: place, orientation: DQuat::IDENTITY };
                    assert!(near(&dot, &place, shape, pose).gap < 1e-8, "{what}");
                }
            }
        }
    }
}

#[test]
fn gaps_do_not_depend_on_the_order_nor_on_the_place() {
    let mut random = Random::new(2);
    for a in &ALL_SHAPES {
        for b in &ALL_SHAPES {
            for _ in 0..100 {
                let (pa, pb, motion) = (random.pose(1.0), random.pose(1.0), random.pose(1.0));
                let move_by = |pose: &Pose| Pose {
                    location: motion.point(pose.location),
                    orientation: motion.orientation * pose.orientation,
                };
                let found = near(a, &pa, b, &pb);
                let swapped = near(b, &pb, a, &pa);
                let moved = near(a, &move_by(&pa), b, &move_by(&pb));
                let what = format!("{a:?} {pa:?} {b:?} {pb:?}: {found:?} {swapped:?} {moved:?}");
                let deep = if found.gap < -0.1 { 1e-3 } else { 1e-13 };
                assert!((found.gap - swapped.gap).abs() < deep, "{what}");
                assert!((found.gap - moved.gap).abs() < deep, "{what}");
                if found.gap > 1e-3 {
                    assert!((found.normal + swapped.normal).length() < 1e-9, "{what}");
                    assert!((motion.orientation * found.normal - moved.normal).length() < 1e-9, "{what}");
                    assert!((found.on[0] - swapped.on[1]).length() < 1e-6, "{what}");
                }
            }
        }
    }
}

/// Bodies that approach each other in a random pose touch at exactly one point: the closest one.
#[test]
fn bodies_at_random_touch_once() {
    let mut random = Random::new(3);
    for a in &ALL_SHAPES {
        for b in &ALL_SHAPES {
            for _ in 0..50 {
                let (pa, mut pb) = (random.pose(0.1), random.pose(2.0));
                let apart = near(a, &pa, b, &pb);
                if apart.gap < 0.01 {
                    continue;
                }
                // Moves the bodies very near to each other along the normal, so the closest points stay the same.
                pb.location -= (apart.gap - 1e-7) * apart.normal;
                let found = near(a, &pa, b, &pb);
                let what = format!("{a:?} {pa:?} {b:?} {pb:?}: {found:?}");
                assert!((found.gap - 1e-7).abs() < 1e-14, "{what}");
                let touches = touches(&solid(a), &pa, &solid(b), &pb, 2e-7);
                assert!(!touches.is_empty(), "{what}");
                let gap = touches.iter().map(|touch| touch.meeting.gap).fold(f64::INFINITY, f64::min);
                assert!((gap - found.gap).abs() < 1e-9, "{what} {touches:?}");
                for touch in &touches {
                    assert!(inside(touch, &solid(a), &pa, &solid(b), &pb) > 0.0, "{what} {touch:?}");
                }
                assert_eq!(touches.len(), 1, "{what} {touches:?}");
            }
        }
    }
}

/// The rate of the gap is the normal component of the relative velocity: d(gap)/dt = n · (velocity of the second point − that of the
/// first).
#[test]
fn gaps_change_as_places_move() {
    let mut random = Random::new(4);
    let zero = DVec3::ZERO;
    let (up, across) = (DVec3::Y, DVec3::new(1.0, 2.0, -1.0).normalize());
    let line =
        |radius, outward| Patch::Line { at: 0.1 * DVec3::ONE, along: across, half: 0.5, radius, outward };
    let patches = [
        Patch::Point { at: DVec3::new(0.2, 0.1, 0.3), radius: 0.25 },
        line(0.2, zero),
        line(0.0, across.any_orthonormal_vector()),
        Patch::Plane { at: zero, normal: up },
        Patch::Circle { centre: DVec3::new(0.0, 0.2, 0.1), axis: across, radius: 0.5 },
        Patch::Side { at: zero, along: up, half: 0.5, radius: 0.25, taper: -0.4 },
    ];
    for a in &patches {
        for b in &patches {
            if matches!((a, b), (Patch::Plane { .. }, Patch::Plane { .. })) {
                continue;
            }
            for _ in 0..100 {
                let (pa, pb) = (random.pose(0.3), random.pose(2.0));
                let (v, w) = ([random.vector(), random.vector()], [random.vector(), random.vector()]);
                let moved = |pose: &Pose, i: usize, t: f64| Pose {
                    location: pose.location + t * v[i],
                    orientation: DQuat::from_scaled_axis(t * w[i]) * pose.orientation,
                };
                let now = meet(a, &pa, b, &pb);
                let velocity = |i: usize, pose: &Pose| v[i] + w[i].cross(now.on[i] - pose.location);
                let rate = now.normal.dot(velocity(1, &pb) - velocity(0, &pa));
                let h = 1e-5;
                let gap = |t: f64| meet(a, &moved(&pa, 0, t), b, &moved(&pb, 1, t)).gap;
                let (near, far) =
                    ((gap(h) - gap(-h)) / (2.0 * h), (gap(2.0 * h) - gap(-2.0 * h)) / (4.0 * h));
                let what = format!("{a:?} {pa:?} {b:?} {pb:?}: {now:?} {near} {far} {rate}");
                // The gap is not smooth where lines are nearly parallel or where another point of a rim becomes the closest one.
                if (near - far).abs() < 1e-6 && now.gap > -0.2 {
                    assert!(((4.0 * near - far) / 3.0 - rate).abs() < 1e-8, "{what}");
                }
            }
        }
    }
}

#[test]
fn bodies_rest_on_all_their_corners() {
    let lying = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let tilted = DQuat::from_rotation_z(0.3);
    let (sin, cos) = (libm::sin(0.3), libm::cos(0.3));
    let ground = at(0.0, 0.0, 0.0);
    let table = Shape::Box { size: DVec3::new(4.0, 2.0, 4.0) };
    let top = at(0.0, -1.0, 0.0);
    for (shape, height, turn, count) in [
        (&BALL, 0.5, tilted, 1),
        (&CUBE, 0.7, DQuat::IDENTITY, 4),
        (&CUBE, 0.5, lying, 4),
        (&CUBE, 0.7 * cos + 0.5 * sin, tilted, 2),
        (&ROUNDED_CUBE, 0.7, DQuat::IDENTITY, 4),
        (&ROUNDED_CUBE, 0.2 + 0.5 * cos + 0.3 * sin, tilted, 2),
        (&CAN, 0.6, DQuat::IDENTITY, 4),
        (&CAN, 0.4, lying, 2),
        (&CAN, 0.6 * cos + 0.4 * sin, tilted, 1),
        (&PILL, 0.3, lying, 2),
        (&PILL, 0.8, DQuat::IDENTITY, 1),
        (&PILL, 0.3 + 0.5 * cos, tilted, 1),
        (&CONE, 0.25, DQuat::IDENTITY, 4),
        (&CONE, 0.75, DQuat::from_rotation_x(std::f64::consts::PI), 1),
    ] {
        let pose = turned(at(0.1, height, 0.2), turn);
        for (under, place) in [(&GROUND, &ground), (&table, &top)] {
            let found = touch(under, place, shape, &pose);
            assert_eq!(found.len(), count, "{under:?} {shape:?} {turn:?}: {found:?}");
            for touch in &found {
                assert!(touch.meeting.gap.abs() < 1e-15, "{under:?} {shape:?}: {touch:?}");
                assert!((touch.meeting.normal - DVec3::Y).length() < 1e-14, "{under:?} {shape:?}: {touch:?}");
                assert!(inside(touch, &solid(under), place, &solid(shape), &pose) > 0.0, "{touch:?}");
            }
            assert_eq!(touch(shape, &pose, under, place).len(), count, "{shape:?} {under:?}");
        }
    }
}

#[test]
fn boxes_touch_where_their_faces_overlap() {
    let origin = at(0.0, 0.0, 0.0);
    // The same box on top, shifted along one axis, along two axes, and rotated: the contact points are corners of both boxes and crossings
    // of edges.
    let turn = DQuat::from_rotation_y(0.5);
    for (pose, count) in [
        (at(0.0, 1.4, 0.0), 4),
        (at(0.3, 1.4, 0.0), 4),
        (at(0.3, 1.4, 0.2), 4),
        (turned(at(0.0, 1.4, 0.0), turn), 8),
        (turned(at(0.3, 1.4, 0.1), turn), 5),
    ] {
        let found = touch(&CUBE, &origin, &CUBE, &pose);
        let places: Vec<DVec3> = found.iter().map(|touch| touch.meeting.on[0]).collect();
        assert_eq!(found.len(), count, "{pose:?}: {places:?}");
        for place in &places {
            let other = pose.local(*place);
            for local in [*place, other] {
                assert!(local.x.abs() < 0.5 + 1e-9 && local.z.abs() < 0.3 + 1e-9, "{pose:?}: {places:?}");
            }
        }
    }
}

/// Creates a box as a mesh. The three bits of a corner's index select its coordinates.
fn mesh_of_box(size: DVec3) -> Shape {
    let corner = |i: u32| {
        let side = |bit: u32| f64::from(i >> bit & 1) - 0.5;
        size * DVec3::new(side(0), side(1), side(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let mesh = Mesh::new("box", (0..8).map(corner).collect(), triangles);
    Shape::Mesh { mesh: Arc::new(mesh), scale: 1.0 }
}

/// Creates a flat square mesh of 4 m by 4 m at height 0, from 4 × 4 squares of two triangles each.
fn flat() -> Shape {
    let vertices = (0..25).map(|i| DVec3::new(f64::from(i % 5) - 2.0, 0.0, f64::from(i / 5) - 2.0)).collect();
    let squares = (0..16).map(|i| i % 4 + 5 * (i / 4));
    let triangles = squares.flat_map(|a| [[a, a + 5, a + 1], [a + 1, a + 5, a + 6]]).collect();
    Shape::Mesh { mesh: Arc::new(Mesh::surface("flat", vertices, triangles)), scale: 1.0 }
}

#[test]
fn a_mesh_touches_as_the_solid_does_that_it_encloses() {
    let mut random = Random::new(6);
    let Shape::Box { size } = CUBE else { return };
    let mesh = mesh_of_box(size);
    for other in &ALL_SHAPES {
        for _ in 0..50 {
            let (pa, mut pb) = (random.pose(0.1), random.pose(2.0));
            let solid_gap = near(&CUBE, &pa, other, &pb);
            if solid_gap.gap < 0.01 {
                continue;
            }
            let found = near(&mesh, &pa, other, &pb);
            let what = format!("{other:?} {pa:?} {pb:?}: {found:?} {solid_gap:?}");
            assert!((found.gap - solid_gap.gap).abs() < 1e-13, "{what}");
            pb.location -= (found.gap - 1e-7) * found.normal;
            let found = touches(&solid(&mesh), &pa, &solid(other), &pb, 2e-7);
            // At a corner, adjacent triangles may report the same contact.
            assert!(!found.is_empty() && found.len() < 4, "{what} {found:?}");
            for touch in &found {
                assert!((touch.meeting.gap - 1e-7).abs() < 1e-9, "{what} {found:?}");
                assert!((touch.meeting.on[0] - found[0].meeting.on[0]).length() < 1e-6, "{what} {found:?}");
            }
        }
    }
}

#[test]
fn nothing_catches_at_the_seams_of_a_flat_surface() {
    let (surface, place) = (flat(), at(0.0, 0.0, 0.0));
    // The ball is placed across the seams between triangles, along these seams, and over corners of triangles.
    for i in 0..100 {
        let x = f64::from(i) * 0.037 - 1.85;
        for z in [0.0, 0.25, x, -x, 1.0] {
            for side in [1.0, -1.0] {
                let pose = at(x, 0.5 * side, z);
                let found = touch(&surface, &place, &BALL, &pose);
                assert_eq!(found.len(), 1, "{x} {z}: {found:?}");
                assert!(matches!(found[0].patches[0], Patch::Plane { .. }), "{x} {z}: {found:?}");
                assert!(found[0].meeting.gap.abs() < 1e-15, "{x} {z}: {found:?}");
                assert_eq!(found[0].meeting.normal, side * DVec3::Y, "{x} {z}: {found:?}");
            }
        }
    }
    let found = touch(&surface, &place, &CUBE, &at(0.13, 0.7, 0.41));
    assert_eq!(found.len(), 4, "{found:?}");
    // A ball just beyond the end of the mesh touches nothing; slightly lower, it touches the edge.
    assert!(touch(&surface, &place, &BALL, &at(2.3, 0.45, 0.0)).is_empty());
    assert_eq!(touch(&surface, &place, &BALL, &at(2.3, 0.4, 0.0)).len(), 1);
}

#[test]
fn a_mesh_rests_on_its_corners() {
    let Shape::Box { size } = CUBE else { return };
    assert_eq!(touch(&GROUND, &at(0.0, 0.0, 0.0), &mesh_of_box(size), &at(0.3, 0.7, 0.1)).len(), 4);
    assert_eq!(touch(&flat(), &at(0.0, 0.0, 0.0), &mesh_of_box(size), &at(0.3, 0.7, 0.1)).len(), 4);
}

#[test]
fn parallel_lines_meet_in_the_middle_of_the_length_that_they_share() {
    // In the first case, the axis of the first capsule extends from −0.5 m to 0.5 m, and that of the second from −0.2 m to 0.8 m. In the
    // second case, both are 0.3 m lower.
    for (a, b) in [(0.0, 0.3), (-0.3, 0.0)] {
        let found = near(&PILL, &at(0.0, a, 0.0), &PILL, &at(0.9, b, 0.0));
        assert!((found.on[0].y - (a + 0.15)).abs() < 1e-15, "{found:?}");
    }
}

#[test]
fn a_touch_ends_at_the_border_of_its_face() {
    let origin = at(0.0, 0.0, 0.0);
    let found = touch(&CUBE, &origin, &BALL, &at(0.1, 1.2, 0.0));
    assert_eq!(found.len(), 1, "{found:?}");
    // The top of the box extends to x = 0.5 m and z = 0.3 m.
    for (x, z, left) in [(0.1, 0.0, 0.3), (0.3, 0.0, 0.2), (0.7, 0.0, -0.2), (0.0, -0.4, -0.1)] {
        let inside = inside(&found[0], &solid(&CUBE), &origin, &solid(&BALL), &at(x, 1.2, z));
        assert!((inside - left).abs() < 1e-8, "{x} {z}: {inside}");
    }
}

#[test]
fn a_can_beside_the_edge_of_a_table_stands_on_that_edge_too() {
    let table = Shape::Box { size: DVec3::new(4.0, 2.0, 4.0) };
    let found = touch(&table, &at(0.0, -1.0, 0.0), &CAN, &at(2.0, 0.6, 0.0));
    for z in [-0.4, 0.4] {
        let edge = DVec3::new(2.0, 0.0, z);
        assert!(found.iter().any(|touch| touch.meeting.on[1].distance(edge) < 1e-9), "{found:?}");
    }
    assert!(found.iter().all(|touch| touch.meeting.on[1].x < 2.0 + 1e-9), "{found:?}");
}

/// A cylinder that stands upright, or tilts by rounding errors, is above the ground by the height of its lower end. Its axis is known only to
/// within rounding errors, which must not count as a tilt towards the rim.
#[test]
fn upright_cylinders_stand_on_their_ends() {
    for i in 1..2_000 {
        let height = 0.1 + 0.01 * f64::from(i);
        let can = Shape::Cylinder { radius: 3.0 * height, height };
        let tilt = 1e-17 * f64::from(i);
        for orientation in
            [DQuat::IDENTITY, DQuat::from_rotation_z(tilt), DQuat::from_rotation_y(0.37 * f64::from(i))]
        {
            let pose = turned(at(0.3, 2.0 * height, -0.2), orientation);
            let found = near(&GROUND, &at(0.0, 0.0, 0.0), &can, &pose);
            let tolerance = height * (1e-14 + 3.0 * tilt);
            assert!((found.gap - 1.5 * height).abs() < tolerance, "{height}: {found:?}");
        }
    }
}
