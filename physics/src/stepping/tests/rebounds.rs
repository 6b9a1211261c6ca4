//! Tests of the rebounds of bodies on joints, in time-stepping, against closed forms.

use glam::{DQuat, DVec3};

use super::super::super::*;
use super::{GRAVITY, STEP, Scene, cube, door, run};

/// The time at which all impacts are over, s.
const END_TIME: f64 = 0.2;

fn surfaces(scene: &mut Scene, restitution: f64) {
    let surface = Surface { friction: Some(0.0), restitution: Some(restitution), ..Surface::default() };
    scene.surfaces = vec![Some(surface); scene.bodies.len()];
}

/// Adds a ball that flies along x with `speed`, m/s.
fn ball(scene: &mut Scene, mass: f64, at: DVec3, speed: f64) -> usize {
    let shape = Shape::Sphere { radius: 0.1 };
    let start = RigidBody::new(&shape, mass).with_location(at).with_velocity(speed * DVec3::X);
    scene.add(shape, |_| start).index()
}

fn stepping(scene: &Scene, kind: LinkKind) -> TimeStepping {
    TimeStepping::new(scene.world(0.0), &scene.contacts(), &[Link { kind, collides: false }])
}

/// Returns a run with a box of 1 kg that is fixed to a box of 20 kg, and a ball of 1 kg that flies to the first box at 10 m/s. Also returns
/// the indices of the three bodies.
fn hammer(restitution: f64) -> (TimeStepping, [usize; 3]) {
    let mut scene = Scene::default();
    let [near, far] = [(0.0, 1.0), (0.2, 20.0)].map(|(x, mass)| {
        let body = RigidBody::new(&cube(0.2), mass).with_location(x * DVec3::X);
        scene.add(cube(0.2), |_| body)
    });
    let ball = ball(&mut scene, 1.0, -0.5 * DVec3::X, 10.0);
    surfaces(&mut scene, restitution);
    let between = [Anchor::Body { id: near, at: 0.2 * DVec3::X }, Anchor::centre(far)];
    let stepping = stepping(&scene, LinkKind::Fixed(Fixed { between, turned: DQuat::IDENTITY }));
    (stepping, [near.index(), far.index(), ball])
}

/// A ball of 1 kg hits a box of 1 kg at 10 m/s. The box is fixed to a box of 20 kg. So the ball rebounds as from a body of 21 kg. The
/// energy that the impact takes is ½ μ (1 − e²) v², with the reduced mass μ and the velocity of approach v.
#[test]
fn a_joint_shares_a_rebound() {
    for restitution in [0.0, 0.5, 1.0] {
        let (mut stepping, [near, far, ball]) = hammer(restitution);
        let end = run(&mut stepping, END_TIME);
        let common = 10.0 / 22.0;
        let speeds = [common - 21.0 * restitution * common, common + restitution * common];
        for (body, speed) in [ball, near, far].into_iter().zip([speeds[0], speeds[1], speeds[1]]) {
            let found = end.bodies[body].velocity;
            // The engine's sweeps leave some per mille of an impulse.
            assert!(found.abs_diff_eq(speed * DVec3::X, 2e-3), "{restitution} {body}: {found} {speed}");
        }
        let impacts = stepping.impacts();
        let reduced = 21.0 / 22.0;
        let lost = 0.5 * reduced * (1.0 - restitution * restitution) * 100.0;
        assert_eq!(impacts.len(), 1);
        assert!((impacts[0].energy - lost).abs() < 0.01, "{restitution} {} {lost}", impacts[0].energy);
        let impulse = (1.0 + restitution) * reduced * 10.0;
        assert!((impacts[0].impulse.length() - impulse).abs() < 0.01, "{} {impulse}", impacts[0].impulse);
        assert!((end.balance.accounts.impacts + lost).abs() < 0.01, "{}", end.balance.accounts.impacts);
        assert!(end.balance.accounts.limits.abs() < 0.02, "{}", end.balance.accounts.limits);
        assert!(end.balance.drift.abs() < 1e-3, "{}", end.balance.drift);
    }
}

/// A rebound takes two steps. A run that is resumed between them must continue with the same bits.
#[test]
#[cfg(feature = "checkpoints")]
fn a_checkpoint_keeps_a_rebound() {
    let (mut whole, _) = hammer(0.5);
    let (mut parts, _) = hammer(0.5);
    let mut impacts = Vec::new();
    for k in 1..=24 {
        let t = f64::from(k) * STEP;
        let (one, two) = (run(&mut whole, t), run(&mut parts, t));
        assert_eq!(one, two, "{k}");
        impacts.extend(parts.impacts());
        let bytes = parts.checkpoint().unwrap();
        (parts, _) = hammer(0.5);
        assert!(parts.resume(&bytes));
    }
    assert_eq!(impacts, whole.impacts());
    assert_eq!(impacts.len(), 1);
}

/// A ball hits a rod on a hinge at the distance d. At the contact, the rod has the effective mass I/d².
#[test]
fn a_hinge_shares_a_rebound() {
    let mut scene = Scene::default();
    let (mass, distance, speed) = (0.25, 0.9, 4.0);
    let rod =
        scene.add(Shape::Box { size: DVec3::new(0.1, 1.0, 0.1) }, |body| body.with_location(-0.5 * DVec3::Y));
    let ball = ball(&mut scene, mass, DVec3::new(-0.5, -distance, 0.0), speed);
    surfaces(&mut scene, 0.8);
    let ends = [Anchor::Point(DVec3::ZERO), Anchor::Body { id: rod, at: 0.5 * DVec3::Y }];
    let end =
        run(&mut stepping(&scene, LinkKind::Hinge(Hinge::new(ends, DVec3::Z, DQuat::IDENTITY))), END_TIME);
    let effective = ((1.0 + 0.01) / 12.0 + 0.25) / (distance * distance);
    let common = mass * speed / (mass + effective);
    let wanted = common - 0.8 * effective * common / mass;
    let found = end.bodies[ball].velocity.x;
    assert!((found - wanted).abs() < 5e-3, "{found} {wanted}");
    let turning = end.bodies[rod.index()].angular_velocity.z;
    let turned = (common + 0.8 * common) / distance;
    assert!((turning - turned).abs() < 5e-3, "{turning} {turned}");
}

/// A door rotates at 3 rad/s, and hits a fixed ball near its hinge. It must rebound with e times its angular velocity.
#[test]
fn a_door_rebounds_from_a_stop() {
    let mut scene = Scene::default();
    let hinge = LinkKind::Hinge(door(&mut scene));
    let stop = Shape::Sphere { radius: 0.05 };
    scene.add(stop, |body| body.with_fixed(true).with_location(DVec3::new(0.1, 0.0, -0.2)));
    surfaces(&mut scene, 0.5);
    let end = run(&mut stepping(&scene, hinge), 0.5);
    let found = end.bodies[0].angular_velocity.y;
    assert!((found + 1.5).abs() < 5e-3, "{found}");
    assert!(end.balance.drift.abs() < 1e-2, "{}", end.balance.drift);
}

/// A table of five parts, with friction, falls flat by 0.45 m. All legs land at once, and the table rebounds to e² times this height.
#[test]
fn a_table_rebounds_from_its_four_legs() {
    /// The height from which the table falls, m.
    const FALL_HEIGHT: f64 = 0.45;
    let restitution = 0.8_f64;
    let mut scene = Scene::default().with_ground(0.0);
    let part = |scene: &mut Scene, size: DVec3, mass: f64, at: DVec3| {
        let shape = Shape::Box { size };
        let body = RigidBody::new(&shape, mass).with_location(at + FALL_HEIGHT * DVec3::Y);
        scene.add(shape, |_| body)
    };
    let top = part(&mut scene, DVec3::new(1.0, 0.1, 1.0), 4.0, 0.55 * DVec3::Y);
    let links: Vec<Link> = [(0.45, 0.45), (0.45, -0.45), (-0.45, 0.45), (-0.45, -0.45)]
        .map(|(x, z)| {
            let leg = part(&mut scene, DVec3::new(0.1, 0.5, 0.1), 0.5, DVec3::new(x, 0.25, z));
            let between = [
                Anchor::Body { id: top, at: DVec3::new(x, -0.05, z) },
                Anchor::Body { id: leg, at: 0.25 * DVec3::Y },
            ];
            Link { kind: LinkKind::Fixed(Fixed { between, turned: DQuat::IDENTITY }), collides: false }
        })
        .to_vec();
    scene.surfaces.iter_mut().for_each(|surface| {
        *surface = Some(Surface { restitution: Some(restitution), ..Surface::default() });
    });
    let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &links);
    stepping.set_step(0.001);
    let apex = (2.0 * FALL_HEIGHT / GRAVITY).sqrt() * (1.0 + restitution);
    let end = run(&mut stepping, apex).bodies[top.index()];
    let height = end.location.y - 0.55;
    // The table falls and rises for one step too long, which changes its height by up to v Δt.
    let tolerance = 2.0 * 0.001 * (2.0 * GRAVITY * FALL_HEIGHT).sqrt();
    assert!((height - restitution * restitution * FALL_HEIGHT).abs() < tolerance, "{height}");
    assert!(end.velocity.length() < 0.02, "{}", end.velocity);
}
