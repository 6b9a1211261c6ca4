//! Changes of what is arbitrary in a scene: where its origin is, where its axes point, what its units are, and what its bodies are called.

use glam::{DQuat, DVec3};

use super::drawn::{Body, Drawn, End, Force, Freedom, Joint, Kind, Law, Motion, Motor, Shape};
use super::random::Random;

/// A change of coordinates, of units and of names. The scene is mirrored in the plane x = 0, then turned, then shifted; then its units
/// change.
#[derive(Clone, Debug)]
pub(crate) struct Change {
    pub(crate) name: String,
    pub(crate) mirror: bool,
    pub(crate) turn: DQuat,
    pub(crate) shift: DVec3,
    /// The number of new units of length, mass and time in one old unit.
    pub(crate) units: [f64; 3],
    /// For each body, its new index. `None` if the bodies keep their names and their order.
    pub(crate) order: Option<Vec<usize>>,
}

impl Default for Change {
    fn default() -> Change {
        let name = "nothing".to_owned();
        Change {
            name,
            mirror: false,
            turn: DQuat::IDENTITY,
            shift: DVec3::ZERO,
            units: [1.0; 3],
            order: None,
        }
    }
}

impl Change {
    pub(crate) fn shifted(shift: DVec3) -> Change {
        Change { name: format!("shifted by {shift}"), shift, ..Change::default() }
    }

    pub(crate) fn turned(turn: DQuat) -> Change {
        Change { name: format!("turned by {turn}"), turn, ..Change::default() }
    }

    pub(crate) fn mirrored() -> Change {
        Change { name: "mirrored".to_owned(), mirror: true, ..Change::default() }
    }

    /// Changes the units. The arguments are the numbers of new units of length, mass and time in one old unit.
    pub(crate) fn units(length: f64, mass: f64, time: f64) -> Change {
        let name = format!("with lengths times {length}, masses times {mass}, times times {time}");
        Change { name, units: [length, mass, time], ..Change::default() }
    }

    /// Changes the names and the order of `bodies` bodies, of the joints and of the forces.
    pub(crate) fn shuffled(bodies: usize, random: &mut Random) -> Change {
        let mut order: Vec<usize> = (0..bodies).collect();
        for i in (1..bodies).rev() {
            order.swap(i, random.below(i + 1));
        }
        Change {
            name: format!("with its bodies in the order {order:?}"),
            order: Some(order),
            ..Change::default()
        }
    }

    fn unit(&self, length: i32, mass: i32, time: i32) -> f64 {
        let powers = self.units.iter().zip([length, mass, time]);
        powers.map(|(unit, power)| libm::pow(*unit, f64::from(power))).product()
    }

    /// Changes the direction of a vector, such as a velocity.
    fn polar(&self, vector: DVec3) -> DVec3 {
        self.turn * self.in_body(vector)
    }

    /// Changes the direction of a vector that follows from a sense of rotation, such as an angular velocity.
    fn axial(&self, vector: DVec3) -> DVec3 {
        if self.mirror { -self.polar(vector) } else { self.polar(vector) }
    }

    /// Changes a vector in body axes. Bodies turn with the scene, and each is its own mirror image.
    fn in_body(&self, vector: DVec3) -> DVec3 {
        if self.mirror { DVec3::new(-vector.x, vector.y, vector.z) } else { vector }
    }

    fn place(&self, place: DVec3) -> DVec3 {
        self.units[0] * (self.polar(place) + self.shift)
    }

    fn orientation(&self, turn: DQuat) -> DQuat {
        let turn = if self.mirror { DQuat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w) } else { turn };
        self.turn * turn
    }

    fn new_index(&self, body: usize) -> usize {
        self.order.as_ref().map_or(body, |order| order[body])
    }

    /// Returns the scene after this change.
    pub(crate) fn of(&self, scene: &Drawn) -> Drawn {
        let mut bodies = vec![None; scene.bodies.len()];
        for (i, body) in scene.bodies.iter().enumerate() {
            bodies[self.new_index(i)] = Some(self.body(body, i));
        }
        let mut joints: Vec<Joint> = scene.joints.iter().map(|joint| self.joint(joint, scene)).collect();
        let mut forces: Vec<Force> = scene.forces.iter().map(|force| self.force(force, scene)).collect();
        if self.order.is_some() {
            let last = joints.len().saturating_sub(1);
            joints.reverse();
            for joint in &mut joints {
                joint.name = format!("other_{}", joint.name);
                if let Kind::Gear { joints: [a, b], .. } = &mut joint.kind {
                    (*a, *b) = (last - *a, last - *b);
                }
            }
            forces.reverse();
        }
        Drawn {
            duration: scene.duration * self.unit(0, 0, 1),
            frame_rate: scene.frame_rate * self.unit(0, 0, -1),
            step: scene.step * self.unit(0, 0, 1),
            gravity: self.polar(scene.gravity) * self.unit(1, 0, -2),
            bodies: bodies.into_iter().flatten().collect(),
            joints,
            forces,
            ..scene.clone()
        }
    }

    fn body(&self, body: &Body, index: usize) -> Body {
        let size = |length: f64| length * self.units[0];
        let shape = match body.shape {
            Shape::Sphere { radius } => Shape::Sphere { radius: size(radius) },
            Shape::Box { size: edges } => Shape::Box { size: edges * self.units[0] },
            Shape::Cylinder { radius, height } => {
                Shape::Cylinder { radius: size(radius), height: size(height) }
            }
            Shape::Capsule { radius, height } => {
                Shape::Capsule { radius: size(radius), height: size(height) }
            }
            Shape::Plane { normal } => Shape::Plane { normal: self.in_body(normal) },
        };
        let moment = self.in_body(body.magnetic_moment) * if self.mirror { -1.0 } else { 1.0 };
        let motion = body.motion.map(|Motion { way, rate, velocity }| Motion {
            way: self.polar(way) * self.unit(1, 0, 0),
            rate: rate * self.unit(0, 0, -1),
            velocity: self.polar(velocity) * self.unit(1, 0, -1),
        });
        // New names in another alphabetical order.
        let name = match &self.order {
            Some(_) => format!("{}{}", ["zeta", "beta", "omega", "alpha", "mu"][index % 5], index),
            None => body.name.clone(),
        };
        Body {
            name,
            shape,
            mass: body.mass * self.unit(0, 1, 0),
            magnetic_moment: moment * self.unit(2, 0, -1),
            location: self.place(body.location),
            orientation: self.orientation(body.orientation),
            velocity: self.polar(body.velocity) * self.unit(1, 0, -1),
            angular_velocity: self.axial(body.angular_velocity) * self.unit(0, 0, -1),
            force: self.polar(body.force) * self.unit(1, 1, -2),
            torque: self.axial(body.torque) * self.unit(2, 1, -2),
            rolling_friction: body.rolling_friction.map(|length| length * self.unit(1, 0, 0)),
            start: body.start.map(|time| time * self.unit(0, 0, 1)),
            end: body.end.map(|time| time * self.unit(0, 0, 1)),
            motion,
            ..body.clone()
        }
    }

    fn end(&self, end: End) -> End {
        match end {
            End::Body(body, at) => End::Body(self.new_index(body), self.in_body(at) * self.units[0]),
            End::Point(point) => End::Point(self.place(point)),
        }
    }

    fn joint(&self, joint: &Joint, scene: &Drawn) -> Joint {
        let ends = |between: [End; 2]| between.map(|end| self.end(end));
        let place = |at: Option<DVec3>| at.map(|at| self.place(at));
        let kind = match &joint.kind {
            Kind::Ball { between, at } => Kind::Ball { between: ends(*between), at: place(*at) },
            Kind::Fixed { between, at } => Kind::Fixed { between: ends(*between), at: place(*at) },
            Kind::Hinge { between, at, axis, freedom } => Kind::Hinge {
                between: ends(*between),
                at: place(*at),
                axis: self.axial(*axis),
                freedom: self.freedom(freedom, 0),
            },
            Kind::Slider { between, at, axis, freedom } => Kind::Slider {
                between: ends(*between),
                at: place(*at),
                axis: self.polar(*axis),
                freedom: self.freedom(freedom, 1),
            },
            Kind::Rod { between } => Kind::Rod { between: ends(*between) },
            Kind::Rope { between, length } => {
                Kind::Rope { between: ends(*between), length: length * self.unit(1, 0, 0) }
            }
            Kind::Pulley { between, over, ratio } => {
                let over = over.iter().map(|end| self.end(*end)).collect();
                Kind::Pulley { between: ends(*between), over, ratio: *ratio }
            }
            Kind::Gear { joints, ratio } => {
                let slides = joints.map(|joint| matches!(scene.joints[joint].kind, Kind::Slider { .. }));
                let length = i32::from(slides[1]) - i32::from(slides[0]);
                Kind::Gear { joints: *joints, ratio: ratio * self.unit(length, 0, 0) }
            }
        };
        Joint { kind, ..joint.clone() }
    }

    /// Changes limits and motors. `length` is the exponent of the length in the unit of the coordinate: 0 for an angle, 1 for a
    /// displacement.
    fn freedom(&self, Freedom { limits, motor }: &Freedom, length: i32) -> Freedom {
        let unit = self.unit(length, 0, 0);
        let motor = motor.map(|motor| match motor {
            Motor::Speed { speed, limit } => Motor::Speed {
                speed: speed * self.unit(length, 0, -1),
                limit: limit * self.unit(2 - length, 1, -2),
            },
            Motor::Value { size, rate, speed, spring } => Motor::Value {
                size: size * unit,
                rate: rate * self.unit(0, 0, -1),
                speed: speed * self.unit(length, 0, -1),
                spring: spring.map(|[stiffness, damping]| {
                    let turning = 2 - 2 * length;
                    [stiffness * self.unit(turning, 1, -2), damping * self.unit(turning, 1, -1)]
                }),
            },
        });
        Freedom { limits: limits.map(|limits| limits.map(|limit| limit * unit)), motor }
    }

    fn force(&self, Force { name, law }: &Force, scene: &Drawn) -> Force {
        let law = match *law {
            Law::Constant { force, torque } => Law::Constant {
                force: self.polar(force) * self.unit(1, 1, -2),
                torque: self.axial(torque) * self.unit(2, 1, -2),
            },
            Law::Drag { linear, quadratic, wind } => Law::Drag {
                linear: linear * self.unit(0, 1, -1),
                quadratic: quadratic * self.unit(-1, 1, 0),
                wind: self.polar(wind) * self.unit(1, 0, -1),
            },
            Law::Spring { between, stiffness, damping, rest_length } => Law::Spring {
                between: between.map(|end| self.end(end)),
                stiffness: stiffness * self.unit(0, 1, -2),
                damping: damping * self.unit(0, 1, -1),
                rest_length: rest_length * self.unit(1, 0, 0),
            },
            Law::Gravitation { constant, softening } => Law::Gravitation {
                constant: constant * self.unit(3, -1, -2),
                softening: softening * self.unit(1, 0, 0),
            },
            Law::Coulomb { constant, softening } => Law::Coulomb {
                constant: constant * self.unit(3, 1, -2),
                softening: softening * self.unit(1, 0, 0),
            },
            Law::Lorentz { electric, magnetic } => Law::Lorentz {
                electric: self.polar(electric) * self.unit(1, 1, -2),
                magnetic: self.axial(magnetic) * self.unit(0, 1, -1),
            },
            Law::LennardJones { epsilon, sigma } => Law::LennardJones {
                epsilon: epsilon * self.unit(2, 1, -2),
                sigma: sigma * self.unit(1, 0, 0),
            },
            Law::Dipoles { constant, field } => Law::Dipoles {
                constant: constant * self.unit(1, 1, 0),
                field: self.axial(field) * self.unit(0, 1, -1),
            },
            Law::Buoyancy { density, level } => {
                let up = -self.polar(scene.gravity.normalize());
                Law::Buoyancy {
                    density: density * self.unit(-3, 1, 0),
                    level: (level + self.shift.dot(up)) * self.unit(1, 0, 0),
                }
            }
            Law::Center { center, stiffness, damping } => Law::Center {
                center: self.place(center),
                stiffness: stiffness * self.unit(0, 1, -2),
                damping: damping * self.unit(0, 1, -1),
            },
        };
        Force { name: name.clone(), law }
    }

    /// Returns what the changed scene shows of a body, in the old coordinates and units: location, velocity, orientation and angular
    /// velocity.
    pub(crate) fn undone(&self, seen: super::motion::Seen) -> super::motion::Seen {
        let [length, _, time] = self.units;
        let back = self.turn.conjugate();
        let turned = |vector: DVec3| self.in_body(back * vector);
        let spin = turned(seen.angular_velocity) * time;
        let orientation = back * seen.orientation;
        let orientation = if self.mirror {
            DQuat::from_xyzw(orientation.x, -orientation.y, -orientation.z, orientation.w)
        } else {
            orientation
        };
        super::motion::Seen {
            location: turned(seen.location / length - self.shift),
            velocity: turned(seen.velocity) * (time / length),
            orientation,
            angular_velocity: if self.mirror { -spin } else { spin },
        }
    }

    /// Returns the index that a body of the old scene has in the new one.
    pub(crate) fn index(&self, body: usize) -> usize {
        self.new_index(body)
    }
}
