use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::*;
use crate::random::Stream;
use crate::{
    BodyId, BodySnapshot, ConstantForce, Drag, Gravitation, METHODS, Mesh, Method, Motion, RigidBody, Shape,
    UniformGravity, World,
};

const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
/// The interval between frames, s, and the timestep, s.
const FRAME: f64 = 0.04;
const STEP: f64 = 0.004;

fn source(births: Births, lifetime: f64) -> ParticleSource {
    ParticleSource {
        births,
        lifetime: Arc::new(lifetime),
        longest_life: lifetime,
        origin: Origin::Point(DVec3::new(1.0, 2.0, 3.0)),
        direction: Some(DVec3::Y),
        spread: 0.0,
        speed: Arc::new(5.0),
        mass: 0.5,
        charge: 0.0,
        random: Stream::new(7, "emitter.test"),
    }
}

fn gravity() -> Field {
    Field::new(|_| Arc::new(UniformGravity { acceleration: GRAVITY }))
}

fn drag() -> Field {
    Field::new(|bodies| Arc::new(Drag { bodies, linear: 0.1, quadratic: 0.2, wind: DVec3::X }))
}

/// Returns the gravitational force of three bodies at rest on particles.
fn three_suns() -> Field {
    let suns = (0..3).map(|i| (BodyId::new(i), RigidBody::new(&Shape::Sphere { radius: 1.0 }, 10.0)));
    Field::from_bodies(suns.collect(), |bodies, against| {
        Arc::new(Gravitation {
            bodies,
            against: Some(against),
            constant: 1.0,
            softening: 0.1,
            opening_angle: None,
        })
    })
}

fn still(body: BodyId) -> Option<RecordedMotion> {
    let x = [-3.0, 0.5, 4.0][body.index()];
    Some(RecordedMotion::still(BodySnapshot {
        id: body.index(),
        location: DVec3::X * x,
        ..BodySnapshot::default()
    }))
}

/// Creates a cloud of particles, and advances it from frame to frame.
#[allow(clippy::unwrap_used, reason = "helpers of tests are tests")]
fn cloud(
    source: &ParticleSource,
    fields: &[Field],
    method: &str,
    (from, to): (f64, f64),
    stride: u64,
) -> Cloud {
    let method = Method::by_name(method).unwrap();
    let mut cloud = Cloud::new(Arc::new(source.clone()), None, fields, method, (from, stride));
    let mut frame = (from / FRAME).round();
    cloud.advance(frame * FRAME, STEP, &still);
    while frame * FRAME < to - 1e-9 {
        frame += 1.0;
        cloud.advance(frame * FRAME, STEP, &still);
    }
    cloud
}

/// Each particle is born at its own time between two steps. Under a constant force, methods of order 2 or higher must be exact.
/// Euler–Cromer has an error of at most g t h/2, where h is the step.
#[test]
fn every_particle_flies_along_its_own_parabola() {
    let source = source(Births::rate(333.0, 0.0, f64::INFINITY), 2.0);
    for (method, rate) in [("velocity-verlet", 0.0), ("rk4", 0.0), ("euler-cromer", 9.81 * STEP / 2.0)] {
        let cloud = cloud(&source, &[gravity()], method, (0.0, 1.0), 1);
        assert_eq!(cloud.particles().len(), 334, "one at 0 s, and 333 since");
        for particle in cloud.particles() {
            let t = cloud.time() - particle.born;
            let place = DVec3::new(1.0, 2.0, 3.0) + 5.0 * t * DVec3::Y + 0.5 * t * t * GRAVITY;
            let off = particle.location.distance(place);
            assert!(off <= rate * t * (1.0 + 1e-9) + 1e-13, "{method} {t}: {off:e}");
        }
    }
}

/// A particle must move exactly like a body of a world with the same mass, forces and integration method.
#[test]
fn a_particle_moves_as_a_body_does() {
    for method in METHODS {
        let burst = Births { start: 0.0, end: 0.0, at_once: 1, every: f64::INFINITY };
        let cloud = cloud(&source(burst, 9.0), &[gravity(), drag()], method.name, (0.0, 1.0), 1);
        let mut world = World::new();
        world.set_integrator(method);
        world.set_step(STEP);
        let start = DVec3::new(1.0, 2.0, 3.0);
        let ball = RigidBody::new(&Shape::Sphere { radius: 0.1 }, 0.5).with_location(start);
        let ball = world.add(ball.with_velocity(5.0 * DVec3::Y));
        world.add_force(UniformGravity { acceleration: GRAVITY });
        world.add_force(Drag { bodies: vec![ball], linear: 0.1, quadratic: 0.2, wind: DVec3::X });
        (1..=25).for_each(|frame| world.advance_to(f64::from(frame) * FRAME));
        // Velocity Verlet predicts a velocity, and keeps its loads for the next step. Particles compute these loads again at each frame,
        // so the two results differ slightly. The predicted velocity is wrong by h² times the rate of change of the acceleration, about 10
        // m/s³.
        let tolerance = if method.name == "velocity-verlet" { 10.0 * STEP * STEP } else { 1e-12 };
        let [particle] = cloud.particles() else { panic!("there is one") };
        assert!(particle.location.abs_diff_eq(world.location(ball), tolerance), "{}", method.name);
    }
}

/// At any time, the living particles must be those that were born within the last lifetime.
#[test]
fn so_many_are_alive_as_are_born_in_a_lifetime() {
    let source = source(Births::rate(100.0, 0.005, 3.0), 0.5);
    for (time, alive) in [(0.2, 20), (0.4, 40), (1.0, 50), (3.0, 50), (3.2, 30), (3.4, 10), (3.6, 0)] {
        assert_eq!(cloud(&source, &[], "rk4", (0.0, time), 1).particles().len(), alive, "{time}");
    }
    let late = cloud(&source, &[], "rk4", (0.0, 2.0), 1);
    assert!(late.particles().iter().all(|it| it.born > 1.5 - 1e-12 && it.born <= 2.0 && it.dies > 2.0));
}

/// After two thousand lifetimes, the cloud must not hold more particles than at first.
#[test]
fn the_dead_take_no_memory() {
    let source = source(Births::rate(1000.0, 0.0, f64::INFINITY), 0.1);
    let mut cloud = Cloud::new(Arc::new(source), None, &[], &METHODS[0], (0.0, 1));
    let mut most = 0;
    for frame in 0..5000 {
        cloud.advance(f64::from(frame) * FRAME, FRAME, &still);
        most = most.max(cloud.particles().len());
    }
    assert!((100..=101).contains(&most), "{most}");
}

/// A cloud that is computed only from 1.48 s on must contain the same particles at 2 s as a cloud that is computed from the start, bit for
/// bit, with every integration method.
#[test]
fn whoever_begins_later_gets_the_same_bits() {
    let mut source = source(Births::rate(1234.5, 0.0, f64::INFINITY), 0.5);
    (source.spread, source.charge) = (1.0, 1.0);
    let fields = [gravity(), drag(), three_suns()];
    for method in METHODS {
        let whole = cloud(&source, &fields, method.name, (0.0, 2.0), 1);
        let later = cloud(&source, &fields, method.name, (1.48, 2.0), 1);
        assert!(whole.particles().len() > 600);
        assert_eq!(whole.particles(), later.particles(), "{}", method.name);
    }
}

#[test]
fn some_of_them_are_the_same_as_among_all() {
    let mut source = source(Births::rate(1000.0, 0.0, f64::INFINITY), 0.5);
    source.spread = 1.0;
    let fields = [gravity(), three_suns()];
    let all = cloud(&source, &fields, "rk4", (0.0, 1.0), 1);
    let some = cloud(&source, &fields, "rk4", (0.0, 1.0), 7);
    let expected: Vec<Particle> = all.particles().iter().filter(|it| it.number % 7 == 0).copied().collect();
    assert_eq!(some.particles(), expected);
}

/// A cloud is advanced to a time between two frames. The particles born since the last frame must be present, at the right positions.
#[test]
fn births_between_frames_are_seen_at_once() {
    let source = source(Births::rate(1000.0, 0.0, f64::INFINITY), 0.5);
    let mut cloud = cloud(&source, &[gravity()], "rk4", (0.0, 1.0), 1);
    cloud.advance(1.0105, STEP, &still);
    let last = cloud.particles().last().unwrap();
    assert_eq!((last.number, last.born), (1010, 1010.0 * (1.0 / 1000.0)));
    assert!((last.location.y - 2.0 - 5.0 * 0.0005).abs() < 1e-5);
}

/// The cosine of the angle between the direction and the axis of the cone is uniform from cos 30° to 1. Its mean over N draws has the
/// standard deviation (1 − cos 30°)/√(12 N).
#[test]
fn directions_fill_the_cone_evenly() {
    const COUNT: u64 = 20_000;
    let burst = Births { start: 0.0, end: 0.0, at_once: COUNT, every: f64::INFINITY };
    let mut source = source(burst, 9.0);
    let middle = DVec3::new(1.0, 2.0, -2.0) / 3.0;
    (source.direction, source.spread) = (Some(middle), PI / 6.0);
    let (mut sum, mut aside) = (0.0, DVec3::ZERO);
    let edge = libm::cos(PI / 6.0);
    for number in 0..COUNT {
        let (_, velocity) = source.begin(number, 0.0, None);
        let cosine = velocity.dot(middle) / 5.0;
        assert!(cosine >= edge - 1e-12 && (velocity.length() - 5.0).abs() < 1e-12);
        sum += cosine;
        aside += velocity / 5.0 - cosine * middle;
    }
    let count = COUNT as f64;
    assert!((sum / count - (1.0 + edge) / 2.0).abs() < 4.0 * (1.0 - edge) / (12.0 * count).sqrt());
    // The mean of sin² of the angle is below ¼, so the mean of the vectors across the axis has a standard deviation below 1/(2√N).
    assert!((aside / count).length() < 4.0 * 0.5 / count.sqrt());
}

/// The measured fraction of N random points that lie in a region of area fraction p has the standard deviation √(p (1 − p)/N), at most
/// 1/(2√N).
#[test]
fn places_on_surfaces_are_as_likely_as_their_area() {
    const COUNT: u32 = 20_000;
    let share = |shape: &Shape, counts: &dyn Fn(DVec3) -> bool| {
        let mut random = Stream::new(3, "surface");
        let is_in = |_| u32::from(counts(surface::place(shape, &mut random).0));
        f64::from((0..COUNT).map(is_in).sum::<u32>()) / f64::from(COUNT)
    };
    let is = |shape: &Shape, expected: f64, counts: &dyn Fn(DVec3) -> bool| {
        let found = share(shape, counts);
        assert!(
            (found - expected).abs() < 4.0 * 0.5 / f64::from(COUNT).sqrt(),
            "{shape:?}: {found} {expected}"
        );
    };
    let across = |place: DVec3| (place.x * place.x + place.z * place.z).sqrt();
    is(&Shape::Sphere { radius: 2.0 }, 0.25, &|place| place.y > 1.0);
    is(&Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) }, 3.0 / 22.0, &|place| place.y > 1.0 - 1e-12);
    // The wall of a cylinder has the area 2πrh, its two ends have 2πr². So the wall's fraction of the area is h/(h + r).
    is(&Shape::Cylinder { radius: 1.0, height: 3.0 }, 0.75, &|place| place.y.abs() < 1.5 - 1e-9);
    // The two hemispheres of a capsule have an area of 4πr². The whole capsule has an area of 2πrh, where h includes the hemispheres.
    is(&Shape::Capsule { radius: 1.0, height: 6.0 }, 1.0 / 3.0, &|place| place.y.abs() > 2.0);
    // The wall of this cone has a slant height of 5 and the area 15π; the base has 9π. Three quarters of the wall are below half the
    // height.
    let cone = Shape::Cone { radius: 3.0, top_radius: 0.0, height: 4.0 };
    is(&cone, 9.0 / 24.0, &|place| place.y < -1.0 + 1e-9);
    is(&cone, 9.0 / 24.0 + 0.75 * 15.0 / 24.0, &|place| place.y < 1.0);
    // The part of a torus outside its middle circle has the fraction 1/2 + r/(πR) of the area.
    is(&Shape::Torus { radius: 3.0, tube_radius: 1.0 }, 0.5 + 1.0 / (3.0 * PI), &|place| across(place) > 3.0);
}

/// Of two triangles with areas of 2 and 6 square units of the mesh, the larger must get three quarters of the points. Within each
/// triangle, the half that is farther from a corner must get three quarters as well.
#[test]
fn places_on_triangles_are_as_likely_as_their_area() {
    const COUNT: u32 = 20_000;
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, -6.0, 0.0]];
    let vertices = corners.map(DVec3::from_array).to_vec();
    let mesh = Mesh::surface("two", vertices, vec![[0, 1, 2], [0, 1, 3]]);
    let triangles = Triangles::new(&mesh, 10.0);
    let mut random = Stream::new(3, "triangles");
    let places: Vec<_> = (0..COUNT).map(|_| triangles.place(&mut random)).collect();
    let share = |counts: &dyn Fn(DVec3) -> bool| {
        let found = places.iter().filter(|(place, _)| counts(*place)).count();
        f64::from(u32::try_from(found).unwrap()) / f64::from(COUNT)
    };
    let deviations = 4.0 * 0.5 / f64::from(COUNT).sqrt();
    assert!((share(&|place| place.y < 0.0) - 0.75).abs() < deviations);
    assert!((share(&|place| place.x < 10.0) - 0.75).abs() < deviations);
    for (place, normal) in places {
        let upwards = if place.y > 0.0 { DVec3::Z } else { -DVec3::Z };
        assert_eq!((place.z, normal), (0.0, upwards));
        let within =
            place.x >= 0.0 && place.x + place.y < 20.0 + 1e-9 && place.y > 3.0 * place.x - 60.0 - 1e-9;
        assert!(within, "{place}");
    }
}

#[test]
fn places_lie_on_their_surfaces_and_normals_point_outwards() {
    let shapes = [
        Shape::Sphere { radius: 2.0 },
        Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) },
        Shape::Cylinder { radius: 1.0, height: 3.0 },
        Shape::Capsule { radius: 1.0, height: 6.0 },
        Shape::Cone { radius: 3.0, top_radius: 1.0, height: 4.0 },
        Shape::Cone { radius: 1.0, top_radius: 3.0, height: 4.0 },
    ];
    for shape in shapes {
        let mut random = Stream::new(5, "surface");
        for _ in 0..500 {
            let (place, normal) = surface::place(&shape, &mut random);
            assert!((normal.length() - 1.0).abs() < 1e-12);
            // No point of a convex shape lies farther along the normal than the drawn point.
            let farthest = shape.support(DQuat::IDENTITY, normal).unwrap();
            assert!((place.dot(normal) - farthest).abs() < 1e-9, "{shape:?} {place} {normal}");
        }
    }
}

/// A wheel rotates at 500 rad/s, so by 20 rad per frame. Points on its rim must stay on the circle between frames, and particles must
/// leave the rim with the rim's velocity.
#[test]
fn what_a_wheel_throws_has_the_speed_of_its_rim() {
    let turned = |t: f64| BodySnapshot {
        orientation: DQuat::from_rotation_z(500.0 * t),
        angular_velocity: 500.0 * DVec3::Z,
        ..BodySnapshot::default()
    };
    let course = RecordedMotion::new(1.0, turned(1.0), 1.0 + FRAME, turned(1.0 + FRAME));
    for t in [1.0, 1.001, 1.0173, 1.04] {
        let (place, velocity) = course.state(t).point(DVec3::X);
        let (sin, cos) = libm::sincos(500.0 * t);
        assert!(place.abs_diff_eq(DVec3::new(cos, sin, 0.0), 1e-11), "{t}");
        assert!(velocity.abs_diff_eq(500.0 * DVec3::new(-sin, cos, 0.0), 1e-8), "{t}");
    }
    let still = source(Births::rate(1.0, 0.0, 0.0), 1.0);
    let moving = ParticleSource { origin: Origin::Point(DVec3::X), speed: Arc::new(0.0), ..still };
    let (_, velocity) = moving.begin(0, 1.01, Some(&course.state(1.01)));
    assert!((velocity.length() - 500.0).abs() < 1e-8);
}

/// The interpolated motion of a body under a constant force must be the exact parabola between two frames.
#[test]
fn a_course_is_exact_under_a_constant_force() {
    let at = |t: f64| BodySnapshot {
        location: DVec3::new(t, 5.0 * t, 0.0) + 0.5 * t * t * GRAVITY,
        velocity: DVec3::new(1.0, 5.0, 0.0) + t * GRAVITY,
        orientation: DQuat::IDENTITY,
        ..BodySnapshot::default()
    };
    let course = RecordedMotion::new(0.2, at(0.2), 0.3, at(0.3));
    for t in [0.2, 0.23, 0.3] {
        let given = course.at(t);
        assert!(given.location.abs_diff_eq(at(t).location, 1e-14));
        assert!(given.velocity.abs_diff_eq(at(t).velocity, 1e-13));
        assert!(given.acceleration.abs_diff_eq(GRAVITY, 1e-11));
    }
}

#[test]
fn a_constant_force_acts_by_the_mass() {
    let field = Field::new(|bodies| Arc::new(ConstantForce { bodies, force: DVec3::X, torque: DVec3::ZERO }));
    let burst = Births { start: 0.0, end: 0.0, at_once: 300, every: f64::INFINITY };
    let cloud = cloud(&source(burst, 9.0), &[field], "rk4", (0.0, 1.0), 1);
    assert!(cloud.particles().iter().all(|it| (it.velocity.x - 2.0).abs() < 1e-12));
}
