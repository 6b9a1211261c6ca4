//! Tests of joints in time-stepping against closed forms.

use glam::{DQuat, DVec3};

use super::super::super::*;
use super::{GRAVITY, STEP, Scene, door, run};

/// Adds the bob of a pendulum of 1 m that hangs from the origin, deflected by `angle` (rad) about z. Returns the ends of the joint and the
/// position of the bob.
fn bob(scene: &mut Scene, angle: f64) -> ([Anchor; 2], DVec3) {
    let at = DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0);
    let bob = scene.add(Shape::Sphere { radius: 0.1 }, |body| body.with_location(at));
    ([Anchor::Point(DVec3::ZERO), Anchor::Body { id: bob, at: -at }], at)
}

fn swing(scene: &Scene, kind: LinkKind) -> TimeStepping {
    TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &[Link { kind, collides: false }])
}

/// A pendulum starts at 30° and swings for 20 s, with steps of 1/240 s. It must keep its energy, and so its height, within a thousandth.
#[test]
fn pendulums_keep_their_length_and_their_energy() {
    let angle = std::f64::consts::FRAC_PI_6;
    for name in ["rod", "ball", "hinge", "rope"] {
        let mut scene = Scene::default();
        let (ends, start) = bob(&mut scene, angle);
        let between = [ends[0], Anchor::centre(BodyId::new(0))];
        let kind = match name {
            "rod" => LinkKind::Rod(Rod { between, length: 1.0 }),
            "ball" => LinkKind::Ball(Ball { between: ends }),
            "hinge" => LinkKind::Hinge(Hinge::new(ends, DVec3::Z, DQuat::IDENTITY)),
            _ => LinkKind::Rope(Rope { between, length: 1.0 }),
        };
        let mut stepping = swing(&scene, kind);
        let (mut highest, mut worst) = (f64::NEG_INFINITY, 0.0_f64);
        for k in 1..=2000 {
            let at = run(&mut stepping, 0.01 * f64::from(k)).bodies[0].location;
            worst = worst.max((at.length() - 1.0).abs());
            if k > 1800 {
                highest = highest.max(at.y);
            }
        }
        // The lost energy, as a fraction of the initial potential energy above the lowest point.
        let lost = (start.y - highest) / (1.0 + start.y);
        println!("{name}: {lost} of the energy lost, length off by {worst} m");
        assert!(lost.abs() < 1e-3 && worst < 1e-4, "{name} {lost} {worst}");
    }
}

/// A bar rotates freely about a joint at its end, at 10 rad/s for 10 s. Nothing brakes it. The joint yields by ½ (ω dt)² of the distance to
/// the bar's centre, so the speed may differ by a part of this order.
#[test]
fn joints_do_not_brake_a_free_rotation() {
    let spin = 10.0 * DVec3::Z;
    for name in ["hinge", "ball", "rope", "chain"] {
        let mut scene = Scene::default();
        let long = Shape::Box { size: DVec3::new(1.0, 0.1, 0.1) };
        let bar = |scene: &mut Scene, x: f64| {
            scene.add(long.clone(), |body| {
                body.with_location(x * DVec3::X)
                    .with_angular_velocity(spin)
                    .with_velocity(spin.cross(x * DVec3::X))
            })
        };
        let bar_1 = bar(&mut scene, 0.5);
        let ends = [Anchor::Point(DVec3::ZERO), Anchor::Body { id: bar_1, at: -0.5 * DVec3::X }];
        let kinds = match name {
            "hinge" => vec![LinkKind::Hinge(Hinge::new(ends, DVec3::Z, DQuat::IDENTITY))],
            "ball" => vec![LinkKind::Ball(Ball { between: ends })],
            "rope" => vec![LinkKind::Rope(Rope { between: [ends[0], Anchor::centre(bar_1)], length: 0.5 })],
            _ => {
                let bar_2 = bar(&mut scene, 1.5);
                let one = Anchor::Body { id: bar_1, at: 0.5 * DVec3::X };
                let two = Anchor::Body { id: bar_2, at: -0.5 * DVec3::X };
                vec![
                    LinkKind::Hinge(Hinge::new(ends, DVec3::Z, DQuat::IDENTITY)),
                    LinkKind::Fixed(Fixed { between: [one, two], turned: DQuat::IDENTITY }),
                ]
            }
        };
        let links: Vec<Link> = kinds.into_iter().map(|kind| Link { kind, collides: false }).collect();
        let mut stepping = TimeStepping::new(scene.world(0.0), &scene.contacts(), &links);
        let start = stepping.snapshot().unwrap().balance.kinetic;
        let end = run(&mut stepping, 10.0).balance;
        println!("{name}: {} of the energy kept", end.kinetic / start);
        assert!((end.kinetic / start - 1.0).abs() < 0.005, "{name} {}", end.kinetic / start);
        assert!(end.drift.abs() < 1e-6, "{name} {}", end.drift);
    }
}

/// A ball circles on a rope of 1 m, so fast that it moves farther than its radius within a step. It must keep its speed. The rope yields by
/// ½ (ω dt)² of its length at the start.
#[test]
fn a_fast_ball_on_a_rope_keeps_its_speed() {
    for speed in [30.0, 60.0] {
        let mut scene = Scene::default();
        let ball = scene.add(Shape::Sphere { radius: 0.1 }, |body| {
            body.with_location(DVec3::X).with_velocity(speed * DVec3::Y)
        });
        let between = [Anchor::Point(DVec3::ZERO), Anchor::centre(ball)];
        let link = Link { kind: LinkKind::Rope(Rope { between, length: 1.0 }), collides: true };
        let end = run(&mut TimeStepping::new(scene.world(0.0), &scene.contacts(), &[link]), 2.0).bodies[0];
        let yielding = 0.5 * (speed * STEP) * (speed * STEP);
        assert!((end.velocity.length() / speed - 1.0).abs() < yielding, "{speed} {}", end.velocity);
    }
}

/// Two boxes with the same centre, a plank and a plate, tumble on a hinge without friction. Their energy must not grow.
#[test]
fn a_tumbling_pair_on_a_hinge_is_stable() {
    let mut scene = Scene::default();
    let spin = DVec3::new(0.2, 0.0, 10.0);
    let [plank, plate] = [DVec3::new(2.0, 0.2, 0.2), DVec3::new(0.5, 0.5, 0.1)]
        .map(|size| scene.add(Shape::Box { size }, |body| body.with_angular_velocity(spin)));
    let ends = [plank, plate].map(Anchor::centre);
    let kind = LinkKind::Hinge(Hinge::new(ends, DVec3::Z, DQuat::IDENTITY));
    let mut stepping =
        TimeStepping::new(scene.world(0.0), &scene.contacts(), &[Link { kind, collides: false }]);
    let start = run(&mut stepping, 0.0).balance.total;
    let end = run(&mut stepping, 10.0).balance.total;
    assert!((end / start - 1.0).abs() < 0.01, "{start} {end}");
}

/// A thin rod rotates about a hinge at its end, at 40 rad/s. Its moment of inertia about its own axis is 5,000 times smaller than about the
/// hinge. Rounding errors must not grow, and nothing may add energy.
#[test]
fn a_thin_rod_on_a_hinge_is_stable() {
    let mut scene = Scene::default();
    let spin = 40.0 * DVec3::Z;
    let rod = scene.add(Shape::Box { size: DVec3::new(1.0, 0.01, 0.01) }, |body| {
        body.with_location(0.5 * DVec3::X).with_angular_velocity(spin).with_velocity(20.0 * DVec3::Y)
    });
    let ends = [Anchor::Point(DVec3::ZERO), Anchor::Body { id: rod, at: -0.5 * DVec3::X }];
    let hinge = LinkKind::Hinge(Hinge::new(ends, DVec3::Z, DQuat::IDENTITY));
    let link = Link { kind: hinge, collides: false };
    let mut stepping = TimeStepping::new(scene.world(0.0), &scene.contacts(), &[link]);
    let start = stepping.snapshot().unwrap().balance.kinetic;
    let end = run(&mut stepping, 4.0);
    assert!((end.bodies[0].location.length() - 0.5).abs() < 0.01, "{}", end.bodies[0].location);
    assert!(end.balance.kinetic < 1.001 * start && end.balance.kinetic > 0.5 * start);
}

/// A door swings against the limit of its hinge at 3 rad/s. It must stay there.
#[test]
fn a_limit_does_not_throw_a_door_back() {
    let mut scene = Scene::default();
    let freedom = Freedom { limits: Some([-1.5, 1.5]), motor: None };
    let hinge = door(&mut scene).with(freedom);
    let link = Link { kind: LinkKind::Hinge(hinge), collides: false };
    let end = run(&mut TimeStepping::new(scene.world(0.0), &scene.contacts(), &[link]), 2.0).bodies[0];
    assert!(end.angular_velocity.length() < 0.02, "{}", end.angular_velocity);
}

/// A hinge must stop at its limit when its body falls. A motor must bring a wheel to its target speed and no further.
#[test]
fn limits_stop_a_hinge_and_motors_turn_it() {
    let mut scene = Scene::default();
    let (ends, _) = bob(&mut scene, 1.2);
    let freedom = Freedom { limits: Some([-0.7, 0.1]), motor: None };
    let mut stepping =
        swing(&scene, LinkKind::Hinge(Hinge::new(ends, DVec3::Z, DQuat::IDENTITY).with(freedom)));
    let end = run(&mut stepping, 5.0).bodies[0].location;
    let angle = libm::atan2(end.x, -end.y);
    assert!((angle - 0.5).abs() < 2e-3, "{angle}");

    let mut scene = Scene::default();
    let wheel = scene.add(Shape::Cylinder { radius: 1.0, height: 0.2 }, |body| body);
    let ends = [Anchor::Point(DVec3::ZERO), Anchor::centre(wheel)];
    let freedom = Freedom { limits: None, motor: Some(Motor::Speed { speed: 3.0, limit: 0.5 }) };
    let kind = LinkKind::Hinge(Hinge::new(ends, DVec3::Y, DQuat::IDENTITY).with(freedom));
    let mut stepping = swing(&scene, kind);
    // The angular acceleration of the wheel is α = M/I = 0.5/(½ · 1 · 1²) = 1 rad/s².
    for (t, speed) in [(1.0, 1.0), (2.0, 2.0), (4.0, 3.0)] {
        let turning = run(&mut stepping, t).bodies[0].angular_velocity;
        assert!(turning.abs_diff_eq(speed * DVec3::Y, 0.02), "{t} {turning}");
    }
}

/// A body on an inclined rail must slide down with the acceleration g sin α.
#[test]
fn a_slider_runs_along_its_axis() {
    let mut scene = Scene::default();
    let cart = scene.add(Shape::Box { size: DVec3::new(0.2, 0.1, 0.1) }, |body| body);
    let axis = DVec3::new(libm::cos(0.4), -libm::sin(0.4), 0.0);
    let between = [Anchor::Point(DVec3::ZERO), Anchor::centre(cart)];
    let slider = Slider { between, axis, turned: DQuat::IDENTITY, freedom: Freedom::default() };
    let end = run(&mut swing(&scene, LinkKind::Slider(slider)), 1.0).bodies[0].location;
    let way = 0.5 * GRAVITY * libm::sin(0.4);
    assert!((end.dot(axis) - way).abs() < 0.01 * way, "{end}");
    assert!(end.reject_from_normalized(axis).length() < 1e-4, "{end}");
}

/// A motor brings a wheel to 3 rad/s, so the wheel has ½ · ½ · 9 J. Another motor pushes a cart up a slope, so the cart has ½ m v² and m g
/// h. The account of the motors must hold this energy.
#[test]
fn what_motors_give_is_booked() {
    let mut scene = Scene::default();
    let wheel = scene.add(Shape::Cylinder { radius: 1.0, height: 0.2 }, |body| body);
    let between = [Anchor::Point(DVec3::ZERO), Anchor::centre(wheel)];
    let freedom = Freedom { limits: None, motor: Some(Motor::Speed { speed: 3.0, limit: 0.5 }) };
    let hinge = Hinge::new(between, DVec3::Y, DQuat::IDENTITY).with(freedom.clone());
    let balance = run(&mut swing(&scene, LinkKind::Hinge(hinge)), 4.0).balance;
    assert!((balance.accounts.motors - 2.25).abs() < 1e-3, "{:?}", balance.accounts);
    assert!(balance.drift.abs() < 1e-3, "{}", balance.drift);

    let axis = DVec3::new(libm::cos(0.4), libm::sin(0.4), 0.0);
    let freedom = Freedom { limits: None, motor: Some(Motor::Speed { speed: 3.0, limit: 8.0 }) };
    let slider = Slider { between, axis, turned: DQuat::IDENTITY, freedom };
    let mut stepping = swing(&scene, LinkKind::Slider(slider));
    stepping.snapshot().unwrap();
    let end = run(&mut stepping, 2.0);
    let given = 4.5 + GRAVITY * end.bodies[0].location.y;
    assert!(end.bodies[0].location.y > 1.0);
    assert!((end.balance.accounts.motors / given - 1.0).abs() < 0.01, "{given} {:?}", end.balance.accounts);
    assert!(end.balance.drift.abs() < 0.01, "{}", end.balance.drift);
}

/// The target angle of a servo jumps while its rod is at rest. In the first steps, the rod's energy must equal the servo's work: in each
/// step, the torque times the mean rotation.
#[test]
fn what_servos_give_is_booked() {
    #[derive(Debug)]
    struct Jump;
    impl Target for Jump {
        fn at(&self, _: f64) -> [f64; 3] {
            [0.8, 0.0, 0.0]
        }
    }
    let mut scene = Scene::default();
    let rod =
        scene.add(Shape::Box { size: DVec3::new(1.0, 0.1, 0.1) }, |body| body.with_location(0.5 * DVec3::X));
    let between = [Anchor::Point(DVec3::ZERO), Anchor::Body { id: rod, at: -0.5 * DVec3::X }];
    let hinge = Hinge::new(between, DVec3::Y, DQuat::IDENTITY);
    let mut world = scene.world(0.0);
    let target = std::sync::Arc::new(Jump);
    world.add_force(Servo { coordinate: hinge.coordinate(), target, stiffness: 200.0, damping: 3.0 });
    let link = Link { kind: LinkKind::Hinge(hinge), collides: false };
    let mut stepping = TimeStepping::new(world, &scene.contacts(), &[link]);
    stepping.snapshot().unwrap();
    for k in 1..=8 {
        let balance = run(&mut stepping, f64::from(k) / 240.0).balance;
        assert!(balance.kinetic > 0.0 && balance.drift.abs() < 1e-3, "{k}: {}", balance.drift);
    }
}

/// Twenty planks hang between two banks by short ropes. The ropes carry the weight of all planks, and may hardly stretch: with as few sweeps
/// as contacts need, they stretch by 0.4 m.
#[test]
fn a_rope_bridge_does_not_stretch() {
    /// The length of each rope, m.
    const ROPE_LENGTH: f64 = 0.06;
    let mut scene = Scene::default();
    let mut links = Vec::new();
    let rope = |from: Anchor, to: Anchor| Link {
        kind: LinkKind::Rope(Rope { between: [from, to], length: ROPE_LENGTH }),
        collides: false,
    };
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let at = |k: i32| 0.45 * f64::from(k);
    let plank = Shape::Box { size: DVec3::new(0.4, 0.05, 2.0) };
    for k in 0..20 {
        scene.add(plank.clone(), |body| body.with_location(at(k) * DVec3::X));
    }
    for z in [-0.9, 0.9] {
        let end = |k: i32, x: f64| match k {
            0..20 => Anchor::Body { id: BodyId::new(k as usize), at: corner(x, z) },
            _ => Anchor::Point(corner(at(k) + x, z)),
        };
        links.extend((0..=20).map(|k| rope(end(k - 1, 0.2), end(k, -0.2))));
    }
    let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &links);
    let mut stretched = 0.0_f64;
    for k in 1..=60 {
        let moment = run(&mut stepping, 0.05 * f64::from(k));
        for link in &links {
            let LinkKind::Rope(rope) = &link.kind else { unreachable!() };
            let [one, two] = rope.between.map(|end| match end {
                Anchor::Point(at) => at,
                Anchor::Body { id, at } => {
                    let body = &moment.bodies[id.index()];
                    body.location + body.orientation * at
                }
            });
            stretched = stretched.max((one - two).length() - ROPE_LENGTH);
        }
    }
    assert!(stretched < 0.04, "{stretched}");
}

/// A chain of eight links falls from a horizontal line, and swings above the ground. The energy that its joints take must be booked. The
/// remaining error is that of Euler–Cromer.
#[test]
fn what_joints_take_is_booked() {
    let mut scene = Scene::default().with_ground(0.0);
    let mut links = Vec::new();
    let mut before = Anchor::Point(DVec3::new(0.0, 2.3, 0.0));
    for k in 0..8 {
        let at = DVec3::new(0.25 * (f64::from(k) + 0.5), 2.3, 0.0);
        let link =
            scene.add(Shape::Box { size: DVec3::new(0.25, 0.06, 0.06) }, |body| body.with_location(at));
        let end = |x: f64| Anchor::Body { id: link, at: x * DVec3::X };
        links.push(Link { kind: LinkKind::Ball(Ball { between: [before, end(-0.125)] }), collides: false });
        before = end(0.125);
    }
    let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &links);
    let (mut error, mut largest, mut taken) = (0.0_f64, 0.0_f64, 0.0);
    for k in 1..=80 {
        let balance = run(&mut stepping, 0.05 * f64::from(k)).balance;
        largest = largest.max(balance.kinetic);
        error = error.max((balance.drift * largest).abs());
        taken = balance.accounts.limits;
    }
    println!("error {error} J, taken {taken} J, largest kinetic energy {largest} J");
    assert!(error < 0.01 * largest, "{error} {largest}");
    assert!(taken < -0.05 * largest, "{taken} {largest}");
}

/// Two balls that a joint connects spin while they fall. Joints act on both bodies with opposite forces, so the centre of mass falls freely,
/// and the angular momentum about it stays the same.
#[test]
fn a_spinning_dumbbell_falls_freely() {
    for name in ["rope", "rod", "ball", "fixed", "hinge"] {
        let mut scene = Scene::default();
        let spin = 3.0 * DVec3::Z;
        let [one, two] = [-0.5, 0.5].map(|x| {
            let at = x * DVec3::X;
            let body = |body: RigidBody| {
                body.with_location(at).with_velocity(spin.cross(at)).with_angular_velocity(spin)
            };
            scene.add(Shape::Sphere { radius: 0.2 }, body)
        });
        let apart = [Anchor::centre(one), Anchor::centre(two)];
        let between =
            [Anchor::Body { id: one, at: 0.5 * DVec3::X }, Anchor::Body { id: two, at: -0.5 * DVec3::X }];
        let kind = match name {
            "rope" => LinkKind::Rope(Rope { between: apart, length: 1.0 }),
            "rod" => LinkKind::Rod(Rod { between: apart, length: 1.0 }),
            "ball" => LinkKind::Ball(Ball { between }),
            "fixed" => LinkKind::Fixed(Fixed { between, turned: DQuat::IDENTITY }),
            _ => LinkKind::Hinge(Hinge::new(between, DVec3::Z, DQuat::IDENTITY)),
        };
        let mut stepping = swing(&scene, kind);
        let start = stepping.snapshot().unwrap();
        let end = run(&mut stepping, 1.0);
        let momentum: DVec3 = end.bodies.iter().map(|body| body.velocity).sum();
        assert!(momentum.abs_diff_eq(-2.0 * GRAVITY * DVec3::Y, 1e-9), "{name} {momentum}");
        let turning = |moment: &Snapshot| {
            let [one, two] = [0, 1].map(|i| moment.bodies[i]);
            let own = 0.4 * 0.04 * (one.angular_velocity + two.angular_velocity);
            own + 0.5 * (two.location - one.location).cross(two.velocity - one.velocity)
        };
        let [before, after] = [turning(&start), turning(&end)];
        assert!(before.abs_diff_eq(after, 0.01 * before.length()), "{name} {before} {after}");
    }
}
