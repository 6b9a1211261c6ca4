//! More than thirty mechanisms of physics lessons, built around the origin of the world, where beginners put things. They move the same at the
//! origin, 1 m away and 1,000 m away.

use glam::{DQuat, DVec3};

use super::change::Change;
use super::drawn::{Body, Drawn, End, Force, Freedom, Joint, Kind, Law, Motor, Shape, body};
use super::motion::{Failure, differences, run};

const ORIGIN: End = End::Point(DVec3::ZERO);

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn ball(name: &str, location: DVec3) -> Body {
    Body { location, ..body(name, Shape::Sphere { radius: 0.05 }, 1.0) }
}

/// Returns a bar along x.
fn bar(name: &str, length: f64, location: DVec3) -> Body {
    Body { location, ..body(name, Shape::Box { size: v(length, 0.1, 0.1) }, 1.0) }
}

/// Returns a disc with its axis along z.
fn disc(name: &str, radius: f64, location: DVec3) -> Body {
    let orientation = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    Body { location, orientation, ..body(name, Shape::Cylinder { radius, height: 0.1 }, 1.0) }
}

fn center(body: usize) -> End {
    End::Body(body, DVec3::ZERO)
}

fn joint(name: &str, kind: Kind) -> Joint {
    Joint { name: name.to_owned(), kind, collides: false }
}

fn hinge(name: &str, between: [End; 2], at: Option<DVec3>, freedom: Freedom) -> Joint {
    joint(name, Kind::Hinge { between, at, axis: DVec3::Z, freedom })
}

fn slider(name: &str, between: [End; 2], axis: DVec3, freedom: Freedom) -> Joint {
    joint(name, Kind::Slider { between, at: None, axis, freedom })
}

fn force(law: Law) -> Force {
    Force { name: "law".to_owned(), law }
}

const FREE: Freedom = Freedom { limits: None, motor: None };

fn motor(speed: f64, limit: f64) -> Freedom {
    Freedom { motor: Some(Motor::Speed { speed, limit }), limits: None }
}

fn driven(size: f64, rate: f64, speed: f64, spring: Option<[f64; 2]>) -> Freedom {
    Freedom { motor: Some(Motor::Value { size, rate, speed, spring }), limits: None }
}

/// Returns a scene that runs for a second, with the gravity of the earth.
fn lesson(bodies: Vec<Body>, joints: Vec<Joint>) -> Drawn {
    Drawn {
        duration: 1.0,
        frame_rate: 10.0,
        step: 1.0 / 240.0,
        integrator: "velocity-verlet",
        gravity: v(0.0, -9.81, 0.0),
        bodies,
        joints,
        ..Drawn::default()
    }
}

/// Returns the thirty mechanisms with their names.
fn lessons() -> Vec<(&'static str, Drawn)> {
    let pendulum = || lesson(vec![ball("bob", v(1.0, 0.0, 0.0))], vec![]);
    let with = |mut scene: Drawn, joints: Vec<Joint>| {
        scene.joints = joints;
        scene
    };
    let double = || {
        let joints = vec![
            hinge("upper", [ORIGIN, center(0)], None, FREE),
            hinge("lower", [center(0), center(1)], Some(v(1.0, 0.0, 0.0)), FREE),
        ];
        lesson(vec![bar("one", 1.0, v(0.5, 0.0, 0.0)), bar("two", 1.0, v(1.5, 0.0, 0.0))], joints)
    };
    let table = |freedom: Freedom| {
        let plate = body("table", Shape::Cylinder { radius: 1.0, height: 0.1 }, 5.0);
        let seat = |name: &str, x: f64| Body {
            location: v(x, 0.3, 0.0),
            ..body(name, Shape::Box { size: v(0.1, 0.5, 0.1) }, 1.0)
        };
        let bolt =
            |name: &str, i: usize| joint(name, Kind::Fixed { between: [center(0), center(i)], at: None });
        let axle = Kind::Hinge { between: [ORIGIN, center(0)], at: None, axis: DVec3::Y, freedom };
        let joints = vec![joint("axle", axle), bolt("left", 1), bolt("right", 2)];
        lesson(vec![plate, seat("a", 0.8), seat("b", -0.8)], joints)
    };
    let crank = |freedom: Freedom| {
        let joints = vec![
            hinge("axle", [ORIGIN, center(0)], None, freedom),
            hinge("pin", [center(0), center(1)], Some(v(1.0, 0.0, 0.0)), FREE),
            hinge("wrist", [center(1), center(2)], Some(v(3.0, 0.0, 0.0)), FREE),
            slider("track", [End::Point(v(3.0, 0.0, 0.0)), center(2)], DVec3::X, FREE),
        ];
        let crank = Body {
            angular_velocity: v(0.0, 0.0, 2.0),
            velocity: v(0.0, 1.0, 0.0),
            ..bar("crank", 1.0, v(0.5, 0.0, 0.0))
        };
        let piston = body("piston", Shape::Box { size: v(0.2, 0.2, 0.2) }, 1.0);
        let bodies =
            vec![crank, bar("rod", 2.0, v(2.0, 0.0, 0.0)), Body { location: v(3.0, 0.0, 0.0), ..piston }];
        lesson(bodies, joints)
    };
    let bead = || {
        let rod = Body {
            orientation: DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            ..body("rod", Shape::Cylinder { radius: 0.02, height: 3.0 }, 1.0)
        };
        let bead = Body {
            velocity: v(0.0, 0.0, -0.6),
            angular_velocity: v(0.0, 3.0, 0.0),
            ..ball("bead", v(0.2, 0.0, 0.0))
        };
        let axle = Kind::Hinge {
            between: [ORIGIN, center(0)],
            at: None,
            axis: DVec3::Y,
            freedom: driven(0.0, 1.0, 3.0, None),
        };
        let rail = slider("rail", [center(0), center(1)], DVec3::X, FREE);
        Drawn {
            integrator: "rk4",
            gravity: DVec3::ZERO,
            ..lesson(vec![rod, bead], vec![joint("axle", axle), rail])
        }
    };
    let top = || Body {
        angular_velocity: v(3.0, 80.0, 0.0),
        ..body("top", Shape::Cylinder { radius: 0.3, height: 0.05 }, 1.0)
    };
    let wheels = || {
        vec![
            Body { angular_velocity: v(0.0, 0.0, 3.0), ..disc("a", 0.5, DVec3::ZERO) },
            disc("b", 0.25, v(0.75, 0.0, 0.0)),
        ]
    };
    let axles = |freedom: Freedom| {
        vec![
            hinge("left", [ORIGIN, center(0)], None, freedom),
            hinge("right", [End::Point(v(0.75, 0.0, 0.0)), center(1)], None, FREE),
            joint("mesh", Kind::Gear { joints: [0, 1], ratio: -2.0 }),
        ]
    };
    let atwood = |axle: End| {
        let mut scene =
            lesson(vec![ball("light", v(-0.2, -1.0, 0.0)), ball("heavy", v(0.2, -1.0, 0.0))], vec![]);
        scene.bodies[1].mass = 2.0;
        if let End::Body(..) = axle {
            scene.bodies.push(Body { fixed: true, ..disc("wheel", 0.2, DVec3::ZERO) });
        }
        let over = match axle {
            End::Point(_) => vec![End::Point(v(-0.2, 0.0, 0.0)), End::Point(v(0.2, 0.0, 0.0))],
            End::Body(wheel, _) => {
                vec![End::Body(wheel, v(-0.2, 0.0, 0.0)), End::Body(wheel, v(0.2, 0.0, 0.0))]
            }
        };
        let kind = Kind::Pulley { between: [center(0), center(1)], over, ratio: 1.0 };
        with(scene, vec![joint("rope", kind)])
    };
    let cube =
        |location: DVec3| Body { location, ..body("cube", Shape::Box { size: v(0.2, 0.2, 0.2) }, 1.0) };
    let spring =
        |between: [End; 2]| force(Law::Spring { between, stiffness: 40.0, damping: 0.1, rest_length: 0.5 });
    let forced = |mut scene: Drawn, forces: Vec<Force>| {
        scene.forces = forces;
        scene
    };
    let chain = |joint_of: &dyn Fn(usize) -> Joint| {
        let links = (0..5).map(|i| bar(&format!("link{i}"), 0.4, v(0.2 + 0.4 * i as f64, 0.0, 0.0)));
        lesson(links.collect(), (0..5).map(joint_of).collect())
    };
    let limited = |low: f64, high: f64| Freedom { limits: Some([low, high]), motor: None };
    let at = |x: f64| Some(v(x, 0.0, 0.0));
    vec![
        (
            "pendulum on a rod",
            with(pendulum(), vec![joint("rod", Kind::Rod { between: [ORIGIN, center(0)] })]),
        ),
        ("pendulum on a hinge", with(pendulum(), vec![hinge("pivot", [ORIGIN, center(0)], None, FREE)])),
        (
            "pendulum on a ball joint",
            with(pendulum(), vec![joint("pivot", Kind::Ball { between: [ORIGIN, center(0)], at: None })]),
        ),
        (
            "pendulum on a slack rope",
            with(pendulum(), vec![joint("rope", Kind::Rope { between: [ORIGIN, center(0)], length: 1.2 })]),
        ),
        (
            "pendulum with a stop",
            with(pendulum(), vec![hinge("pivot", [ORIGIN, center(0)], None, limited(-0.6, 0.2))]),
        ),
        ("double pendulum", double()),
        ("double pendulum by rk4", Drawn { integrator: "rk4", ..double() }),
        ("double pendulum by euler-cromer", Drawn { integrator: "euler-cromer", ..double() }),
        (
            "pendulum in air",
            forced(double(), vec![force(Law::Drag { linear: 0.2, quadratic: 0.3, wind: v(1.0, 0.0, 0.5) })]),
        ),
        (
            "turning wheel",
            lesson(
                vec![Body { angular_velocity: v(0.0, 0.0, 5.0), ..disc("wheel", 0.5, DVec3::ZERO) }],
                vec![hinge("axle", [ORIGIN, center(0)], None, FREE)],
            ),
        ),
        (
            "wheel with a motor",
            lesson(
                vec![disc("wheel", 0.5, DVec3::ZERO)],
                vec![hinge("axle", [ORIGIN, center(0)], None, motor(5.0, 2.0))],
            ),
        ),
        (
            "wheel with a servo",
            lesson(
                vec![disc("wheel", 0.5, DVec3::ZERO)],
                vec![hinge("axle", [ORIGIN, center(0)], None, driven(1.0, 4.0, 0.0, Some([20.0, 2.0])))],
            ),
        ),
        (
            "wheel with a given angle",
            lesson(
                vec![disc("wheel", 0.5, DVec3::ZERO)],
                vec![hinge("axle", [ORIGIN, center(0)], None, driven(1.0, 4.0, 1.0, None))],
            ),
        ),
        ("carousel", table(motor(2.0, 50.0))),
        ("free carousel", table(FREE)),
        ("slider-crank", crank(FREE)),
        ("slider-crank with a motor", crank(driven(0.0, 1.0, 4.0, None))),
        ("four-bar linkage", {
            let ground = v(2.0, 0.0, 0.0);
            let upright = |name: &str, length: f64, x: f64| Body {
                orientation: DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
                ..bar(name, length, v(x, 0.5 * length, 0.0))
            };
            let bodies = vec![
                upright("crank", 1.0, 0.0),
                bar("coupler", 2.0, v(1.0, 1.0, 0.0)),
                upright("rocker", 1.0, 2.0),
            ];
            let joints = vec![
                hinge("a", [ORIGIN, center(0)], None, motor(1.5, 30.0)),
                hinge("b", [center(0), center(1)], Some(v(0.0, 1.0, 0.0)), FREE),
                hinge("c", [center(1), center(2)], Some(v(2.0, 1.0, 0.0)), FREE),
                hinge("d", [End::Point(ground), center(2)], None, FREE),
            ];
            lesson(bodies, joints)
        }),
        ("gears", lesson(wheels(), axles(FREE))),
        ("gears with a motor", lesson(wheels(), axles(motor(-4.0, 1.0)))),
        ("Atwood's machine", atwood(ORIGIN)),
        ("Atwood's machine on a wheel", atwood(center(2))),
        ("block and tackle", {
            let load = Body { mass: 3.0, ..ball("load", v(0.0, -1.0, 0.0)) };
            let strap = |x: f64| End::Body(0, v(x, 0.05, 0.0));
            let over =
                vec![strap(-0.02), End::Point(v(0.05, 0.1, 0.0)), strap(0.02), End::Point(v(0.2, 0.0, 0.0))];
            let kind = Kind::Pulley { between: [ORIGIN, center(1)], over, ratio: 1.0 };
            lesson(vec![load, ball("hand", v(0.25, -0.5, 0.0))], vec![joint("rope", kind)])
        }),
        ("bead on a rod", bead()),
        (
            "gyroscope",
            lesson(vec![top()], vec![joint("gimbal", Kind::Ball { between: [ORIGIN, center(0)], at: None })]),
        ),
        (
            "heavy top",
            lesson(
                vec![Body { location: v(0.1, 0.5, 0.0), ..top() }],
                vec![joint("foot", Kind::Ball { between: [ORIGIN, center(0)], at: None })],
            ),
        ),
        ("block on a rail with a spring", {
            let scene = lesson(
                vec![cube(DVec3::ZERO)],
                vec![slider("rail", [ORIGIN, center(0)], v(1.0, -0.5, 0.0), limited(-0.3, 0.3))],
            );
            forced(scene, vec![spring([End::Point(v(-0.5, 0.0, 0.0)), center(0)])])
        }),
        (
            "lift",
            lesson(
                vec![cube(DVec3::ZERO)],
                vec![slider("shaft", [ORIGIN, center(0)], DVec3::Y, motor(0.5, 30.0))],
            ),
        ),
        (
            "chain of hinges",
            chain(&|i| match i {
                0 => hinge("h0", [ORIGIN, center(0)], None, FREE),
                _ => hinge(&format!("h{i}"), [center(i - 1), center(i)], at(0.4 * i as f64), FREE),
            }),
        ),
        (
            "welded beam",
            chain(&|i| {
                let between = if i == 0 { [ORIGIN, center(0)] } else { [center(i - 1), center(i)] };
                joint(
                    &format!("w{i}"),
                    Kind::Fixed { between, at: (i > 0).then(|| v(0.4 * i as f64, 0.0, 0.0)) },
                )
            }),
        ),
        ("conical pendulum", {
            let bob = Body { velocity: v(0.0, 0.5, 2.0), ..ball("bob", v(0.8, -0.6, 0.0)) };
            lesson(vec![bob], vec![joint("rod", Kind::Rod { between: [ORIGIN, center(0)] })])
        }),
    ]
}

#[test]
fn more_than_thirty_mechanisms_move_the_same_everywhere() {
    let lessons = lessons();
    assert!(lessons.len() > 30);
    let mut wrong = Vec::new();
    for (name, scene) in &lessons {
        let course = |scene: &Drawn| match run(scene) {
            Ok(course) => Ok(course),
            Err(Failure::Scene(error) | Failure::Run(error)) => Err(error),
        };
        let base = match course(scene) {
            Ok(base) => base,
            Err(error) => {
                wrong.push(format!("{name} at the origin: {error}"));
                continue;
            }
        };
        for shift in [v(0.6, 0.64, -0.48), v(600.0, 640.0, -480.0)] {
            let change = Change::shifted(shift);
            match course(&change.of(scene)) {
                Err(error) => wrong.push(format!("{name} {}: {error}", change.name)),
                Ok(moved) => {
                    let apart = differences(scene, &base, &moved, &change)
                        .into_iter()
                        .map(|(apart, _)| apart)
                        .fold(0.0, f64::max);
                    println!("{name} {}: {apart:.1e}", change.name);
                    if apart.is_nan() || apart > 1e-9 {
                        wrong.push(format!("{name} {} differs by {apart:.1e}", change.name));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
