//! A scene as data: its bodies, joints and forces. From this follow its text, and the texts of the same scene seen otherwise.

use std::fmt::Write;

use glam::{DQuat, DVec3};

/// A scene. All values are in SI units.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drawn {
    pub(crate) duration: f64,
    pub(crate) frame_rate: f64,
    pub(crate) step: f64,
    pub(crate) integrator: &'static str,
    pub(crate) contacts: Option<&'static str>,
    pub(crate) gravity: DVec3,
    pub(crate) bodies: Vec<Body>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) forces: Vec<Force>,
}

#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) name: String,
    pub(crate) shape: Shape,
    pub(crate) mass: f64,
    pub(crate) charge: f64,
    pub(crate) magnetic_moment: DVec3,
    pub(crate) location: DVec3,
    pub(crate) orientation: DQuat,
    pub(crate) velocity: DVec3,
    pub(crate) angular_velocity: DVec3,
    pub(crate) force: DVec3,
    pub(crate) torque: DVec3,
    pub(crate) fixed: bool,
    pub(crate) restitution: Option<f64>,
    pub(crate) friction: Option<f64>,
    pub(crate) rolling_friction: Option<f64>,
    pub(crate) start: Option<f64>,
    pub(crate) end: Option<f64>,
    pub(crate) motion: Option<Motion>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Sphere {
        radius: f64,
    },
    Box {
        size: DVec3,
    },
    Cylinder {
        radius: f64,
        height: f64,
    },
    Capsule {
        radius: f64,
        height: f64,
    },
    /// A plane through the body's location. The normal is in body axes.
    Plane {
        normal: DVec3,
    },
}

/// The given motion of a body: its location plus `way` · sin(`rate` t) + `velocity` t.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) way: DVec3,
    pub(crate) rate: f64,
    pub(crate) velocity: DVec3,
}

/// An end of a joint or a spring.
#[derive(Clone, Copy, Debug)]
pub(crate) enum End {
    /// A point of a body, which is given by its index. The point is in body axes.
    Body(usize, DVec3),
    /// A point of the world.
    Point(DVec3),
}

#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    pub(crate) collides: bool,
}

#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Ball {
        between: [End; 2],
        at: Option<DVec3>,
    },
    Fixed {
        between: [End; 2],
        at: Option<DVec3>,
    },
    Hinge {
        between: [End; 2],
        at: Option<DVec3>,
        axis: DVec3,
        freedom: Freedom,
    },
    Slider {
        between: [End; 2],
        at: Option<DVec3>,
        axis: DVec3,
        freedom: Freedom,
    },
    Rod {
        between: [End; 2],
    },
    Rope {
        between: [End; 2],
        length: f64,
    },
    Pulley {
        between: [End; 2],
        over: Vec<End>,
        ratio: f64,
    },
    /// A gear between two joints, which are given by their indices.
    Gear {
        joints: [usize; 2],
        ratio: f64,
    },
}

/// The limits and the motor of a hinge or a slider: rad or m.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Freedom {
    pub(crate) limits: Option<[f64; 2]>,
    pub(crate) motor: Option<Motor>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Motor {
    /// A motor that keeps a speed, with a largest torque or force.
    Speed { speed: f64, limit: f64 },
    /// A motor that keeps the value `size` · sin(`rate` t) + `speed` t, exactly or by a spring and a damper.
    Value { size: f64, rate: f64, speed: f64, spring: Option<[f64; 2]> },
}

#[derive(Clone, Debug)]
pub(crate) struct Force {
    pub(crate) name: String,
    pub(crate) law: Law,
}

#[derive(Clone, Debug)]
pub(crate) enum Law {
    Constant {
        force: DVec3,
        torque: DVec3,
    },
    Drag {
        linear: f64,
        quadratic: f64,
        wind: DVec3,
    },
    Spring {
        between: [End; 2],
        stiffness: f64,
        damping: f64,
        rest_length: f64,
    },
    Gravitation {
        constant: f64,
        softening: f64,
    },
    Coulomb {
        constant: f64,
        softening: f64,
    },
    Lorentz {
        electric: DVec3,
        magnetic: DVec3,
    },
    LennardJones {
        epsilon: f64,
        sigma: f64,
    },
    Dipoles {
        constant: f64,
        field: DVec3,
    },
    Buoyancy {
        density: f64,
        level: f64,
    },
    /// A formula: the force −`stiffness` (x − `center`) − `damping` v, with a potential if there is no damping.
    Center {
        center: DVec3,
        stiffness: f64,
        damping: f64,
    },
}

/// Returns a body at rest at the origin.
pub(crate) fn body(name: &str, shape: Shape, mass: f64) -> Body {
    Body {
        name: name.to_owned(),
        shape,
        mass,
        charge: 0.0,
        magnetic_moment: DVec3::ZERO,
        location: DVec3::ZERO,
        orientation: DQuat::IDENTITY,
        velocity: DVec3::ZERO,
        angular_velocity: DVec3::ZERO,
        force: DVec3::ZERO,
        torque: DVec3::ZERO,
        fixed: false,
        restitution: None,
        friction: None,
        rolling_friction: None,
        start: None,
        end: None,
        motion: None,
    }
}

impl Drawn {
    /// Returns the text of the scene.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text).unwrap();
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Drawn { duration, frame_rate, step, integrator, .. } = self;
        writeln!(text, "[simulation]\nduration = {duration:?}\nframe_rate = {frame_rate:?}")?;
        writeln!(text, "integrator = \"{integrator}\"")?;
        if !matches!(*integrator, "dop853" | "gauss-radau") {
            writeln!(text, "step = {step:?}")?;
        }
        if self.gravity != DVec3::ZERO {
            writeln!(text, "gravity = {}", list(self.gravity))?;
        }
        if let Some(contacts) = self.contacts {
            writeln!(text, "contacts = \"{contacts}\"")?;
        }
        writeln!(text, "[environment]\nground = false")?;
        for body in &self.bodies {
            body.write(text)?;
        }
        for joint in &self.joints {
            self.write_joint(joint, text)?;
        }
        for force in &self.forces {
            self.write_force(force, text)?;
        }
        Ok(())
    }

    fn end(&self, end: End) -> String {
        match end {
            End::Point(point) => list(point),
            End::Body(body, at) if at == DVec3::ZERO => format!("\"{}\"", self.bodies[body].name),
            End::Body(body, at) => format!("{{ body = \"{}\", at = {} }}", self.bodies[body].name, list(at)),
        }
    }

    fn ends(&self, ends: &[End]) -> String {
        let ends: Vec<String> = ends.iter().map(|end| self.end(*end)).collect();
        format!("[{}]", ends.join(", "))
    }

    fn write_joint(&self, joint: &Joint, text: &mut String) -> std::fmt::Result {
        let Joint { name, kind, collides } = joint;
        let word = match kind {
            Kind::Ball { .. } => "ball",
            Kind::Fixed { .. } => "fixed",
            Kind::Hinge { .. } => "hinge",
            Kind::Slider { .. } => "slider",
            Kind::Rod { .. } => "rod",
            Kind::Rope { .. } => "rope",
            Kind::Pulley { .. } => "pulley",
            Kind::Gear { .. } => "gear",
        };
        writeln!(text, "[joint.{name}.{word}]")?;
        if let Kind::Ball { between, .. }
        | Kind::Fixed { between, .. }
        | Kind::Hinge { between, .. }
        | Kind::Slider { between, .. }
        | Kind::Rod { between }
        | Kind::Rope { between, .. }
        | Kind::Pulley { between, .. } = kind
        {
            writeln!(text, "between = {}", self.ends(between))?;
        }
        match kind {
            Kind::Ball { at, .. }
            | Kind::Fixed { at, .. }
            | Kind::Hinge { at, .. }
            | Kind::Slider { at, .. } => {
                if let Some(at) = at {
                    writeln!(text, "at = {}", list(*at))?;
                }
            }
            Kind::Rod { .. } => {}
            Kind::Rope { length, .. } => writeln!(text, "length = {length:?}")?,
            Kind::Pulley { over, ratio, .. } => {
                writeln!(text, "over = {}\nratio = {ratio:?}", self.ends(over))?;
            }
            Kind::Gear { joints: [a, b], ratio } => {
                let [a, b] = [a, b].map(|&joint| &self.joints[joint].name);
                writeln!(text, "joints = [\"{a}\", \"{b}\"]\nratio = {ratio:?}")?;
            }
        }
        if let Kind::Hinge { axis, freedom, .. } | Kind::Slider { axis, freedom, .. } = kind {
            writeln!(text, "axis = {}", list(*axis))?;
            freedom.write(matches!(kind, Kind::Hinge { .. }), text)?;
        }
        if *collides {
            writeln!(text, "collides = true")?;
        }
        Ok(())
    }

    fn write_force(&self, Force { name, law }: &Force, text: &mut String) -> std::fmt::Result {
        match law {
            Law::Constant { force, torque } => {
                let (force, torque) = (list(*force), list(*torque));
                writeln!(text, "[force.{name}.constant]\nforce = {force}\ntorque = {torque}")
            }
            Law::Drag { linear, quadratic, wind } => {
                let wind = list(*wind);
                writeln!(
                    text,
                    "[force.{name}.drag]\nlinear = {linear:?}\nquadratic = {quadratic:?}\nwind = {wind}"
                )
            }
            Law::Spring { between, stiffness, damping, rest_length } => {
                writeln!(text, "[force.{name}.spring]\nbetween = {}", self.ends(between))?;
                writeln!(
                    text,
                    "stiffness = {stiffness:?}\ndamping = {damping:?}\nrest_length = {rest_length:?}"
                )
            }
            Law::Gravitation { constant, softening } => {
                writeln!(
                    text,
                    "[force.{name}.gravitation]\nconstant = {constant:?}\nsoftening = {softening:?}"
                )
            }
            Law::Coulomb { constant, softening } => {
                writeln!(text, "[force.{name}.coulomb]\nconstant = {constant:?}\nsoftening = {softening:?}")
            }
            Law::Lorentz { electric, magnetic } => {
                let (electric, magnetic) = (list(*electric), list(*magnetic));
                writeln!(text, "[force.{name}.lorentz]\nelectric = {electric}\nmagnetic = {magnetic}")
            }
            Law::LennardJones { epsilon, sigma } => {
                writeln!(text, "[force.{name}.lennard_jones]\nepsilon = {epsilon:?}\nsigma = {sigma:?}")
            }
            Law::Dipoles { constant, field } => {
                writeln!(text, "[force.{name}.dipoles]\nconstant = {constant:?}\nfield = {}", list(*field))
            }
            Law::Buoyancy { density, level } => {
                writeln!(text, "[force.{name}.buoyancy]\ndensity = {density:?}\nlevel = {level:?}")
            }
            Law::Center { center, stiffness, damping } => {
                let axes = [("x", center.x), ("y", center.y), ("z", center.z)];
                let pull = axes.map(|(axis, at)| {
                    format!("\"-({stiffness:?})*({axis}-({at:?}))-({damping:?})*v{axis}\"")
                });
                writeln!(text, "[force.{name}.formula]\nforce = [{}]", pull.join(", "))?;
                let square = axes.map(|(axis, at)| format!("({axis}-({at:?}))^2")).join("+");
                if *damping == 0.0 {
                    writeln!(text, "potential = \"0.5*({stiffness:?})*({square})\"")
                } else {
                    Ok(())
                }
            }
        }
    }
}

impl Body {
    fn write(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "[body.{}]", self.name)?;
        match self.shape {
            Shape::Sphere { radius } => writeln!(text, "shape.sphere.radius = {radius:?}")?,
            Shape::Box { size } => writeln!(text, "shape.box.size = {}", list(size))?,
            Shape::Cylinder { radius, height } => {
                writeln!(text, "shape.cylinder = {{ radius = {radius:?}, height = {height:?} }}")?;
            }
            Shape::Capsule { radius, height } => {
                writeln!(text, "shape.capsule = {{ radius = {radius:?}, height = {height:?} }}")?;
            }
            Shape::Plane { normal } => writeln!(text, "shape.plane.normal = {}", list(normal))?,
        }
        if !matches!(self.shape, Shape::Plane { .. }) {
            writeln!(text, "mass = {:?}", self.mass)?;
        }
        if self.charge != 0.0 {
            writeln!(text, "charge = {:?}", self.charge)?;
        }
        let vectors = [
            ("location", self.location),
            ("velocity", self.velocity),
            ("angular_velocity", self.angular_velocity),
            ("force", self.force),
            ("torque", self.torque),
            ("magnetic_moment", self.magnetic_moment),
        ];
        for (key, vector) in vectors {
            if vector != DVec3::ZERO {
                writeln!(text, "{key} = {}", list(vector))?;
            }
        }
        if self.orientation != DQuat::IDENTITY {
            writeln!(text, "orientation.quaternion = {:?}", self.orientation.to_array())?;
        }
        if self.fixed {
            writeln!(text, "fixed = true")?;
        }
        let numbers = [
            ("restitution", self.restitution),
            ("friction", self.friction),
            ("rolling_friction", self.rolling_friction),
            ("start", self.start),
            ("end", self.end),
        ];
        for (key, number) in numbers {
            if let Some(number) = number {
                writeln!(text, "{key} = {number:?}")?;
            }
        }
        if let Some(Motion { way, rate, velocity }) = self.motion {
            let place = |i: usize| {
                let (from, way, velocity) = (self.location[i], way[i], velocity[i]);
                format!("\"({from:?})+({way:?})*sin(({rate:?})*t)+({velocity:?})*t\"")
            };
            writeln!(text, "motion.formula.location = [{}]", [0, 1, 2].map(place).join(", "))?;
        }
        Ok(())
    }
}

impl Freedom {
    fn write(&self, is_angle: bool, text: &mut String) -> std::fmt::Result {
        let unit = if is_angle { 180.0 / std::f64::consts::PI } else { 1.0 };
        if let Some([low, high]) = self.limits {
            writeln!(text, "limits = [{:?}, {:?}]", low * unit, high * unit)?;
        }
        let (target, most) = if is_angle { ("angle", "torque") } else { ("position", "force") };
        match self.motor {
            None => Ok(()),
            Some(Motor::Speed { speed, limit }) => {
                writeln!(text, "motor = {{ speed = {speed:?}, {most} = {limit:?} }}")
            }
            Some(Motor::Value { size, rate, speed, spring }) => {
                let (size, speed) = (size * unit, speed * unit);
                let value = format!("({size:?})*sin(({rate:?})*t)+({speed:?})*t");
                let spring = spring.map_or(String::new(), |[stiffness, damping]| {
                    format!(", stiffness = {stiffness:?}, damping = {damping:?}")
                });
                writeln!(text, "motor = {{ {target} = \"{value}\"{spring} }}")
            }
        }
    }
}

/// Writes a vector as a list.
fn list(vector: DVec3) -> String {
    format!("{:?}", vector.to_array())
}
