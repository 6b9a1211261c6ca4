//! Random scenes: mechanisms, free bodies under forces, and bodies in contact.

use glam::DVec3;

use super::drawn::{Body, Drawn, End, Force, Freedom, Joint, Kind, Law, Motion, Motor, Shape, body};
use super::random::Random;

/// The methods that keep joints, and those that move free bodies.
const WITH_JOINTS: [&str; 4] = ["euler-cromer", "explicit-euler", "velocity-verlet", "rk4"];
const FREE: [&str; 7] =
    ["euler-cromer", "explicit-euler", "velocity-verlet", "rk4", "yoshida4", "dop853", "gauss-radau"];

/// Draws a mechanism: one to five bodies with joints of all kinds, without contacts.
pub(crate) fn mechanism(random: &mut Random) -> Drawn {
    let mut scene = simulation(random, &WITH_JOINTS);
    let size = length(random);
    // Where beginners put things: half of the scenes begin at the origin itself.
    let at_origin = random.chance(0.5);
    let count = 1 + random.below(5);
    let moves = random.chance(0.6);
    for i in 0..count {
        let own = size * random.between(0.2, 0.5);
        let mut body = solid(random, &format!("part{i}"), own);
        body.location = match (i, at_origin) {
            (0, true) => DVec3::ZERO,
            _ => random.vector(size),
        };
        if moves {
            body.velocity = random.vector(size);
            body.angular_velocity = random.vector(2.0);
        }
        scene.bodies.push(body);
    }
    if random.chance(0.15) {
        guide(random, &mut scene.bodies[0], size);
    }
    for i in 0..count {
        let to_world = i == 0 || random.chance(0.25);
        if scene.bodies[i].motion.is_some() || (i == 0 && random.chance(0.2)) {
            continue;
        }
        let other = random.below(i.max(1));
        let kind = joint(random, &scene, (!to_world).then_some(other), i, size);
        scene.joints.push(Joint { name: format!("joint{i}"), kind, collides: false });
    }
    let free = |joint: &usize| matches!(scene.joints[*joint].kind, Kind::Hinge { .. } | Kind::Slider { .. });
    let free: Vec<usize> = (0..scene.joints.len()).filter(free).collect();
    if free.len() > 1 && random.chance(0.4) {
        let ratio = random.choose(&[-2.0, -1.0, 0.5, 1.0, 1.7]);
        let is_turning = |joint: usize| matches!(scene.joints[joint].kind, Kind::Hinge { .. });
        let unit = match [free[0], free[1]].map(is_turning) {
            [true, false] => size,
            [false, true] => 1.0 / size,
            _ => 1.0,
        };
        let kind = Kind::Gear { joints: [free[0], free[1]], ratio: ratio * unit };
        // A motor on one of the two joints may drive both, but two motors would fight.
        if let Kind::Hinge { freedom, .. } | Kind::Slider { freedom, .. } = &mut scene.joints[free[1]].kind {
            *freedom = Freedom::default();
        }
        scene.joints.push(Joint { name: "gearing".to_owned(), kind, collides: false });
    }
    if random.chance(0.7) {
        scene.gravity = gravity(random, size);
    }
    forces(random, &mut scene, size, true);
    scene
}

/// Draws bodies that move freely under forces of all kinds. Some of them come and go, and some have a given motion.
pub(crate) fn free(random: &mut Random) -> Drawn {
    let mut scene = simulation(random, &FREE);
    let size = length(random);
    for i in 0..1 + random.below(5) {
        let own = size * random.between(0.1, 0.3);
        let mut body = solid(random, &format!("body{i}"), own);
        body.location = random.vector(size);
        body.velocity = random.vector(size);
        body.angular_velocity = random.vector(3.0);
        if random.chance(0.3) {
            body.force = random.vector(body.mass * size);
            body.torque = random.vector(0.1 * body.mass * size * size);
        }
        if i > 0 && random.chance(0.2) {
            body.start = Some(random.between(0.1, 0.4) * scene.duration);
        }
        if i > 0 && random.chance(0.2) {
            body.end = Some(random.between(0.5, 0.9) * scene.duration);
        }
        if i > 0 && random.chance(0.15) {
            guide(random, &mut body, size);
        }
        scene.bodies.push(body);
    }
    if random.chance(0.5) {
        scene.gravity = gravity(random, size);
    }
    forces(random, &mut scene, size, false);
    scene
}

/// Draws a few bodies that fall onto a plane and each other, some of them with joints. The contacts are of this kind.
pub(crate) fn contacts(random: &mut Random, kind: &'static str) -> Drawn {
    let methods: &[&str] =
        if kind == "event-driven" { &["velocity-verlet", "rk4"] } else { &["euler-cromer"] };
    let mut scene = simulation(random, methods);
    scene.contacts = Some(kind);
    let size = length(random);
    scene.gravity = DVec3::new(0.0, -random.between(5.0, 15.0) * size, 0.0);
    let mut floor = body("floor", Shape::Plane { normal: DVec3::Y }, 1.0);
    (floor.friction, floor.restitution) = (Some(random.between(0.0, 0.8)), Some(random.between(0.0, 0.9)));
    scene.bodies.push(floor);
    let count = 1 + random.below(4);
    for i in 0..count {
        let own = size * random.between(0.1, 0.3);
        let mut body = solid(random, &format!("body{i}"), own);
        // Each body has its own place, so none overlap at the start.
        let place = DVec3::new(0.9 * size * i as f64, random.between(0.5, 0.9) * size, 0.0);
        body.location = place + DVec3::new(0.0, 0.0, random.between(-0.1, 0.1) * size);
        body.velocity = DVec3::new(-(i as f64) * random.between(0.0, 0.5), 0.0, 0.0) * size;
        body.velocity += random.vector(0.5 * size);
        if random.chance(0.5) {
            body.angular_velocity = random.vector(3.0);
        }
        body.friction = random.chance(0.5).then(|| random.between(0.0, 1.0));
        body.restitution = random.chance(0.5).then(|| random.between(0.0, 0.9));
        body.rolling_friction = random.chance(0.2).then(|| own * random.between(0.0, 0.1));
        scene.bodies.push(body);
    }
    if count > 1 && random.chance(0.3) {
        let between = [End::Body(1, DVec3::ZERO), End::Body(2, DVec3::ZERO)];
        let middle = 0.5 * (scene.bodies[1].location + scene.bodies[2].location);
        let kind = match random.below(3) {
            0 => Kind::Ball { between, at: Some(middle) },
            1 => Kind::Hinge {
                between,
                at: Some(middle),
                axis: random.direction(),
                freedom: Freedom::default(),
            },
            _ => Kind::Rod { between },
        };
        scene.joints.push(Joint { name: "link".to_owned(), kind, collides: true });
    }
    scene
}

/// Draws the duration, the step and the method. A run has about a hundred steps.
fn simulation(random: &mut Random, methods: &[&'static str]) -> Drawn {
    let duration = random.between(0.3, 0.8);
    Drawn {
        duration,
        frame_rate: 10.0 / duration,
        step: duration / random.choose(&[60.0, 100.0, 150.0]),
        integrator: random.choose(methods),
        ..Drawn::default()
    }
}

/// Draws the size of a scene, m: mostly that of things in a room, sometimes far smaller or larger.
fn length(random: &mut Random) -> f64 {
    random.choose(&[1.0, 1.0, 1.0, 0.3, 3.0, 0.01, 100.0])
}

fn gravity(random: &mut Random, size: f64) -> DVec3 {
    let down = if random.chance(0.7) { DVec3::NEG_Y } else { random.direction() };
    random.between(3.0, 15.0) * size * down
}

/// Draws a body of about this size, in a random orientation.
fn solid(random: &mut Random, name: &str, size: f64) -> Body {
    let shape = match random.below(4) {
        0 => Shape::Sphere { radius: size },
        1 => Shape::Box {
            size: 2.0 * size * DVec3::new(1.0, random.between(0.3, 1.0), random.between(0.3, 1.0)),
        },
        2 => Shape::Cylinder { radius: random.between(0.3, 0.8) * size, height: size },
        _ => Shape::Capsule { radius: 0.4 * size, height: size },
    };
    let mut body = body(name, shape, random.between(0.3, 3.0));
    if random.chance(0.6) {
        body.orientation = random.turn();
    }
    body
}

/// Gives a body a motion: it swings, and it may travel.
fn guide(random: &mut Random, body: &mut Body, size: f64) {
    let velocity = if random.chance(0.5) { random.vector(size) } else { DVec3::ZERO };
    body.motion = Some(Motion { way: random.vector(0.5 * size), rate: random.between(1.0, 6.0), velocity });
    (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
    (body.force, body.torque) = (DVec3::ZERO, DVec3::ZERO);
}

/// Draws a joint between body `i` and another body, or the world.
fn joint(random: &mut Random, scene: &Drawn, other: Option<usize>, i: usize, size: f64) -> Kind {
    let here = scene.bodies[i].location;
    // The joint is at a body, at the origin, or somewhere between.
    let place = match random.below(4) {
        0 => here,
        1 if other.is_none() => DVec3::ZERO,
        _ => here + random.vector(0.7 * size),
    };
    let (between, at) = match other {
        Some(other) => ([End::Body(other, DVec3::ZERO), End::Body(i, DVec3::ZERO)], Some(place)),
        None => ([End::Point(place), End::Body(i, DVec3::ZERO)], None),
    };
    // Ropes and rods end at points of the bodies, and these points are apart.
    let far = match other {
        Some(other) => End::Body(other, random.vector(0.2 * size)),
        None => End::Point(here + random.between(0.5, 1.5) * size * random.direction()),
    };
    let near = End::Body(i, if random.chance(0.5) { DVec3::ZERO } else { random.vector(0.2 * size) });
    let point = |end: End| match end {
        End::Point(point) => point,
        End::Body(body, at) => scene.bodies[body].location + scene.bodies[body].orientation * at,
    };
    let distance = point(far).distance(point(near));
    let axis =
        if random.chance(0.5) { random.choose(&[DVec3::X, DVec3::Y, DVec3::Z]) } else { random.direction() };
    match random.below(8) {
        0 => Kind::Ball { between, at },
        1 => Kind::Fixed { between, at },
        2 | 3 => Kind::Hinge { between, at, axis, freedom: freedom(random, 1.0, size * size) },
        4 | 5 => Kind::Slider { between, at, axis, freedom: freedom(random, size, size) },
        6 => Kind::Rod { between: [far, near] },
        _ => Kind::Rope { between: [far, near], length: distance * random.between(1.0, 1.2) },
    }
}

/// Draws limits and a motor for a coordinate whose usual value is `unit` and whose usual force or torque is `strength`.
fn freedom(random: &mut Random, unit: f64, strength: f64) -> Freedom {
    let limits =
        random.chance(0.25).then(|| [-unit * random.between(0.05, 1.0), unit * random.between(0.05, 1.0)]);
    let motor = random.chance(0.35).then(|| match random.below(3) {
        0 => Motor::Speed {
            speed: unit * random.between(-3.0, 3.0),
            limit: strength * random.between(0.5, 20.0),
        },
        kind => Motor::Value {
            size: unit * random.between(0.1, 0.6),
            rate: random.between(1.0, 6.0),
            speed: if random.chance(0.3) { unit * random.between(-2.0, 2.0) } else { 0.0 },
            spring: (kind == 1).then(|| {
                let per = strength / unit;
                [per * random.between(5.0, 50.0), per * random.between(0.0, 3.0)]
            }),
        },
    });
    let limits = if matches!(motor, Some(Motor::Value { spring: None, .. })) { None } else { limits };
    Freedom { limits, motor }
}

/// Adds up to three forces.
fn forces(random: &mut Random, scene: &mut Drawn, size: f64, is_jointed: bool) {
    for i in 0..random.below(4) {
        let law = match random.below(if is_jointed { 4 } else { 9 }) {
            0 => Law::Constant { force: random.vector(size), torque: random.vector(0.1 * size * size) },
            1 => Law::Drag {
                linear: random.between(0.0, 1.0),
                quadratic: random.between(0.0, 1.0) / size,
                wind: if random.chance(0.5) { random.vector(size) } else { DVec3::ZERO },
            },
            2 => {
                let own = random.below(scene.bodies.len());
                let end = End::Body(own, random.vector(0.1 * size));
                let other = if own > 0 && random.chance(0.5) {
                    End::Body(own - 1, random.vector(0.1 * size))
                } else {
                    End::Point(if random.chance(0.5) { DVec3::ZERO } else { random.vector(size) })
                };
                Law::Spring {
                    between: [other, end],
                    stiffness: random.between(5.0, 50.0),
                    damping: random.between(0.0, 1.0),
                    rest_length: random.between(0.2, 1.0) * size,
                }
            }
            3 => Law::Center {
                center: if random.chance(0.5) { DVec3::ZERO } else { random.vector(size) },
                stiffness: random.between(1.0, 10.0),
                damping: random.choose(&[0.0, 0.3]),
            },
            4 => Law::Gravitation { constant: size * size * size, softening: 0.3 * size },
            5 => {
                scene.bodies.iter_mut().for_each(|body| body.charge = random.between(-1.0, 1.0));
                Law::Coulomb { constant: size * size * size, softening: 0.3 * size }
            }
            6 => {
                scene.bodies.iter_mut().for_each(|body| body.charge = random.between(-1.0, 1.0));
                Law::Lorentz { electric: random.vector(size), magnetic: random.vector(3.0) }
            }
            // Its cutoff is a kink, at which adaptive methods find no step.
            7 if !matches!(scene.integrator, "dop853" | "gauss-radau") => {
                Law::LennardJones { epsilon: 0.1 * size * size, sigma: 0.4 * size }
            }
            _ => {
                let moment = size * size;
                scene.bodies.iter_mut().for_each(|body| body.magnetic_moment = random.vector(moment));
                Law::Dipoles { constant: 0.03 * size, field: random.vector(0.3) }
            }
        };
        scene.forces.push(Force { name: format!("force{i}"), law });
    }
    if scene.gravity != DVec3::ZERO && random.chance(0.1) {
        let law =
            Law::Buoyancy { density: 3.0 / (size * size * size), level: random.between(-1.0, 1.0) * size };
        scene.forces.push(Force { name: "water".to_owned(), law });
    }
}
