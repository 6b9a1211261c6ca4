//! The quantities that labels and plots can show: measures of the run, of its bodies and of its joints, and formulas of them.

use glam::DVec3;

use super::JointKind;
use super::expression::Program;
use crate::physics::{BodyId, BodySnapshot, Coordinate, Reaction};

/// A formula of measures. It has a value at each time of the run.
#[derive(Clone, Debug)]
pub struct MeasureFormula {
    /// The compiled formula. Its inputs are the values of the measures in `inputs`.
    pub program: Program,
    /// The measures that the formula can name, in the order of the program's inputs: all of the run, and the named ones of bodies and joints.
    pub inputs: Vec<Measure>,
    /// The measure that the formula consists of, if it is the name of a single one.
    pub single: Option<Measure>,
}

impl MeasureFormula {
    /// Returns the unit of the formula's values: that of its measure. `None` if the formula is not the name of a single measure. The unit
    /// of a pure number is empty.
    pub fn unit(&self) -> Option<&'static str> {
        self.single.map(Measure::unit)
    }

    /// Returns the only body that the formula names, as an index in the scene. `None` if there is none, or if there are several.
    pub fn body(&self) -> Option<usize> {
        let bodies = self.inputs.iter().filter_map(|measure| match measure {
            Measure::Body(body, _) => Some(*body),
            _ => None,
        });
        let first = bodies.clone().next();
        first.filter(|first| bodies.clone().all(|body| body == *first))
    }
}

/// A quantity of a run. It has a value at each time of the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A quantity of the whole run, such as the time or the total energy.
    Run(RunMeasure),
    /// A quantity of one body. The number is the index of the body in the scene.
    Body(usize, BodyMeasure),
    /// A quantity of one joint. The number is the index of the joint in the scene.
    Joint(usize, JointMeasure),
    /// The number of impacts between two bodies so far. The number is an index into `pairs` of the scene.
    Impacts(usize),
}

impl Measure {
    /// Returns whether the quantity is a count. A label shows all digits of a count.
    pub fn is_count(self) -> bool {
        matches!(
            self,
            Measure::Run(RunMeasure::Impacts) | Measure::Body(_, BodyMeasure::Impacts) | Measure::Impacts(_)
        )
    }

    /// Returns the symbol of the quantity's unit. It is empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Measure::Run(measure) => measure.unit(),
            Measure::Body(_, measure) => measure.unit(),
            Measure::Joint(_, measure) => measure.unit(),
            Measure::Impacts(_) => "",
        }
    }
}

/// A quantity of the whole run at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunMeasure {
    /// The simulated time, s.
    Time,
    /// The index of the frame. The first frame has index 0.
    Frame,
    /// The kinetic and potential energy of the whole scene, J.
    Energy,
    /// The kinetic energy of the whole scene, J.
    Kinetic,
    /// The potential energy of the whole scene, J.
    Potential,
    /// A component of the momentum of all bodies that forces move, kg·m/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    Momentum(usize),
    /// A component of their angular momentum about the origin, kg·m²/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    AngularMomentum(usize),
    /// The energy error so far, relative to the largest kinetic energy so far.
    Drift,
    /// The number of impacts in the whole scene so far.
    Impacts,
}

impl RunMeasure {
    /// All quantities of the run, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, RunMeasure, &'static str); 16] = [
        ("t", RunMeasure::Time, "the time, s"),
        ("frame", RunMeasure::Frame, "the number of the frame"),
        ("total", RunMeasure::Energy, "kinetic and potential energy of the whole scene, J; also `energy`"),
        ("kinetic", RunMeasure::Kinetic, "its kinetic energy, J; also `kinetic_energy`"),
        ("potential", RunMeasure::Potential, "its potential energy, J; also `potential_energy`"),
        ("px", RunMeasure::Momentum(0), "the momentum of all bodies that forces move, kg·m/s"),
        ("py", RunMeasure::Momentum(1), "the momentum of all bodies that forces move, kg·m/s"),
        ("pz", RunMeasure::Momentum(2), "the momentum of all bodies that forces move, kg·m/s"),
        ("lx", RunMeasure::AngularMomentum(0), "their angular momentum about the origin, kg·m²/s"),
        ("ly", RunMeasure::AngularMomentum(1), "their angular momentum about the origin, kg·m²/s"),
        ("lz", RunMeasure::AngularMomentum(2), "their angular momentum about the origin, kg·m²/s"),
        ("drift", RunMeasure::Drift, "the energy error so far, as part of the largest kinetic energy so far"),
        ("impacts", RunMeasure::Impacts, "the number of impacts so far; needs `simulation.contacts`"),
        ("energy", RunMeasure::Energy, "the same as `total`, J"),
        ("kinetic_energy", RunMeasure::Kinetic, "the same as `kinetic`, J"),
        ("potential_energy", RunMeasure::Potential, "the same as `potential`, J"),
    ];

    /// Returns the symbol of the quantity's unit. It is empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            RunMeasure::Time => "s",
            RunMeasure::Energy | RunMeasure::Kinetic | RunMeasure::Potential => "J",
            RunMeasure::Momentum(_) => "kg·m/s",
            RunMeasure::AngularMomentum(_) => "kg·m²/s",
            RunMeasure::Frame | RunMeasure::Drift | RunMeasure::Impacts => "",
        }
    }
}

/// A quantity of a body at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyMeasure {
    /// A coordinate of the body's location, m. The number is the axis: 0 for x, 1 for y, 2 for z.
    Location(usize),
    /// The magnitude of the velocity, m/s.
    Speed,
    /// A component of the body's velocity, m/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    Velocity(usize),
    /// The magnitude of the body's acceleration, m/s².
    AccelerationMagnitude,
    /// A component of the body's acceleration, m/s². The number is the axis: 0 for x, 1 for y, 2 for z.
    Acceleration(usize),
    /// The magnitude of the net force on the body, N.
    ForceMagnitude,
    /// A component of the net force on the body, N. The number is the axis: 0 for x, 1 for y, 2 for z.
    Force(usize),
    /// The magnitude of the body's angular velocity, rad/s.
    AngularSpeed,
    /// The mass of the body, kg.
    Mass,
    /// The magnitude of the body's momentum, kg·m/s.
    Momentum,
    /// A component of the body's momentum, kg·m/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    MomentumComponent(usize),
    /// The power of the net force on the body, W.
    Power,
    /// The kinetic energy of translation and rotation, J.
    Kinetic,
    /// The number of impacts of the body so far.
    Impacts,
}

impl BodyMeasure {
    /// All quantities of a body, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, BodyMeasure, &'static str); 24] = [
        ("x", BodyMeasure::Location(0), "its location, m"),
        ("y", BodyMeasure::Location(1), "its location, m"),
        ("z", BodyMeasure::Location(2), "its location, m"),
        ("speed", BodyMeasure::Speed, "its speed, m/s"),
        ("vx", BodyMeasure::Velocity(0), "its velocity, m/s"),
        ("vy", BodyMeasure::Velocity(1), "its velocity, m/s"),
        ("vz", BodyMeasure::Velocity(2), "its velocity, m/s"),
        ("acceleration", BodyMeasure::AccelerationMagnitude, "the size of its acceleration, m/s²"),
        ("ax", BodyMeasure::Acceleration(0), "its acceleration, m/s²"),
        ("ay", BodyMeasure::Acceleration(1), "its acceleration, m/s²"),
        ("az", BodyMeasure::Acceleration(2), "its acceleration, m/s²"),
        ("force", BodyMeasure::ForceMagnitude, "the size of the sum of the forces on it, N"),
        ("fx", BodyMeasure::Force(0), "the sum of the forces on it, N"),
        ("fy", BodyMeasure::Force(1), "the sum of the forces on it, N"),
        ("fz", BodyMeasure::Force(2), "the sum of the forces on it, N"),
        ("spin", BodyMeasure::AngularSpeed, "the size of its angular velocity, rad/s"),
        ("mass", BodyMeasure::Mass, "its mass, kg"),
        ("momentum", BodyMeasure::Momentum, "the size of its momentum, kg·m/s"),
        ("px", BodyMeasure::MomentumComponent(0), "its momentum, kg·m/s"),
        ("py", BodyMeasure::MomentumComponent(1), "its momentum, kg·m/s"),
        ("pz", BodyMeasure::MomentumComponent(2), "its momentum, kg·m/s"),
        ("power", BodyMeasure::Power, "the power of the sum of the forces on it, W"),
        ("kinetic", BodyMeasure::Kinetic, "its kinetic energy, of translation and rotation, J"),
        (
            "impacts",
            BodyMeasure::Impacts,
            "the number of its impacts so far; `a.impacts.b` counts those of two bodies, `a.impacts.ground` those with the ground",
        ),
    ];

    /// Returns the symbol of the quantity's unit. It is empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            BodyMeasure::Location(_) => "m",
            BodyMeasure::Speed | BodyMeasure::Velocity(_) => "m/s",
            BodyMeasure::AccelerationMagnitude | BodyMeasure::Acceleration(_) => "m/s²",
            BodyMeasure::ForceMagnitude | BodyMeasure::Force(_) => "N",
            BodyMeasure::AngularSpeed => "rad/s",
            BodyMeasure::Mass => "kg",
            BodyMeasure::Momentum | BodyMeasure::MomentumComponent(_) => "kg·m/s",
            BodyMeasure::Power => "W",
            BodyMeasure::Kinetic => "J",
            BodyMeasure::Impacts => "",
        }
    }
}

/// A quantity of a joint at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointMeasure {
    /// The magnitude of the reaction force on the joint's second end, N.
    ForceMagnitude,
    /// A component of the reaction force on the joint's second end, N, in world axes. The number is the axis: 0 for x, 1 for y, 2 for z.
    Force(usize),
    /// The magnitude of the reaction torque on the joint's second end, N·m.
    TorqueMagnitude,
    /// A component of the reaction torque on the joint's second end, N·m, in world axes. The number is the axis: 0 for x, 1 for y, 2 for
    /// z.
    Torque(usize),
    /// The part of the motor: its torque about the axis of a hinge, N·m, or its force along the axis of a slider, N.
    Motor,
    /// The component of the force on the joint's second end along the axis of a hinge or slider, N.
    AxialForce,
    /// The component of the torque on the joint's second end about the axis of a hinge or slider, N·m.
    AxialTorque,
    /// The angle of a hinge, degrees, from -180 to 180.
    Angle,
    /// The angle of a hinge, degrees, counted through full turns.
    TotalAngle,
    /// The position of a slider along its axis, m.
    Position,
    /// The rate of change of a hinge's angle, rad/s, or of a slider's position, m/s.
    Speed,
}

impl JointMeasure {
    /// All quantities of a joint, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, JointMeasure, &'static str); 15] = [
        ("joint.NAME.force", JointMeasure::ForceMagnitude, "the size of its force on its second end, N"),
        ("joint.NAME.fx", JointMeasure::Force(0), "its force on its second end, N"),
        ("joint.NAME.fy", JointMeasure::Force(1), "its force on its second end, N"),
        ("joint.NAME.fz", JointMeasure::Force(2), "its force on its second end, N"),
        (
            "joint.NAME.torque",
            JointMeasure::TorqueMagnitude,
            "the size of its whole torque on its second end, about that point, N·m: that of its bearing, its limits and its motor",
        ),
        ("joint.NAME.tx", JointMeasure::Torque(0), "its torque on its second end, N·m"),
        ("joint.NAME.ty", JointMeasure::Torque(1), "its torque on its second end, N·m"),
        ("joint.NAME.tz", JointMeasure::Torque(2), "its torque on its second end, N·m"),
        (
            "joint.NAME.motor",
            JointMeasure::Motor,
            "what its motor gives: the torque of a hinge, N·m, or the force of a slider, N; positive in the direction of the angle or way",
        ),
        (
            "joint.NAME.axial_force",
            JointMeasure::AxialForce,
            "the part of its force along the axis of a hinge or slider, N",
        ),
        (
            "joint.NAME.axial_torque",
            JointMeasure::AxialTorque,
            "the part of its torque about the axis of a hinge or slider, N·m",
        ),
        (
            "joint.NAME.angle",
            JointMeasure::Angle,
            "the angle of a hinge, degrees, from -180 to 180; 0 is at the start",
        ),
        (
            "joint.NAME.total_angle",
            JointMeasure::TotalAngle,
            "that angle, degrees, counted through full turns",
        ),
        (
            "joint.NAME.position",
            JointMeasure::Position,
            "the way of a slider along its axis, m; 0 is at the start",
        ),
        ("joint.NAME.speed", JointMeasure::Speed, "the rate of that angle, rad/s, or of that way, m/s"),
    ];

    /// Returns all quantities of a joint, each with the last part of its name, such as `force`.
    pub fn names() -> impl Iterator<Item = (&'static str, JointMeasure)> {
        JointMeasure::ALL.into_iter().filter_map(|(name, it, _)| Some((name.rsplit_once('.')?.1, it)))
    }

    /// Returns the symbol of the quantity's unit. It is empty if the unit depends on the kind of the joint.
    pub fn unit(self) -> &'static str {
        match self {
            JointMeasure::ForceMagnitude | JointMeasure::Force(_) | JointMeasure::AxialForce => "N",
            JointMeasure::TorqueMagnitude | JointMeasure::Torque(_) | JointMeasure::AxialTorque => "N·m",
            JointMeasure::Angle | JointMeasure::TotalAngle => "°",
            JointMeasure::Position => "m",
            JointMeasure::Motor | JointMeasure::Speed => "",
        }
    }

    /// Returns whether a joint of the given kind has the quantity.
    pub fn is_of(self, joint: &JointKind) -> bool {
        match self {
            JointMeasure::Angle | JointMeasure::TotalAngle => matches!(joint, JointKind::Hinge(_)),
            JointMeasure::Position => matches!(joint, JointKind::Slider(_)),
            JointMeasure::Speed
            | JointMeasure::Motor
            | JointMeasure::AxialForce
            | JointMeasure::AxialTorque => joint.coordinate().is_some(),
            _ => true,
        }
    }

    /// Returns whether the quantity is a reaction force or a reaction torque.
    pub fn is_reaction(self) -> bool {
        !matches!(
            self,
            JointMeasure::Angle | JointMeasure::TotalAngle | JointMeasure::Position | JointMeasure::Speed
        )
    }

    /// Returns the value of the quantity.
    pub fn of(self, joint: &JointState) -> f64 {
        let JointState { reaction, coordinate: [value, rate], axis, total_angle } = *joint;
        match self {
            JointMeasure::Motor => reaction.motor,
            JointMeasure::AxialForce => reaction.force.dot(axis),
            JointMeasure::AxialTorque => reaction.torque.dot(axis),
            // The coordinate is NaN while a body of the joint is absent.
            JointMeasure::TotalAngle => (0.0 * value + total_angle).to_degrees(),
            JointMeasure::Angle => value.to_degrees(),
            JointMeasure::Position => value,
            JointMeasure::Speed => rate,
            JointMeasure::ForceMagnitude => reaction.force.length(),
            JointMeasure::Force(axis) => reaction.force[axis],
            JointMeasure::TorqueMagnitude => reaction.torque.length(),
            JointMeasure::Torque(axis) => reaction.torque[axis],
        }
    }
}

/// A joint at one moment, from which its [measures](JointMeasure) follow.
#[derive(Clone, Copy, Debug)]
pub struct JointState {
    /// The force, the torque and the motor of the joint.
    pub reaction: Reaction,
    /// The free coordinate (rad or m) and its rate. NaN for a joint without one, and while a body of the joint is absent.
    pub coordinate: [f64; 2],
    /// The axis, a unit vector in world axes. NaN for a joint without one, and while a body of the joint is absent.
    pub axis: DVec3,
    /// The angle, counted through full turns, rad.
    pub total_angle: f64,
}

impl JointState {
    /// Returns the state of a joint from its reaction, its counted angle (rad), and a closure that returns the snapshots of bodies.
    pub fn of(
        coordinate: Option<Coordinate>,
        (reaction, total_angle): (Reaction, f64),
        body: impl Fn(BodyId) -> Option<BodySnapshot>,
    ) -> JointState {
        let seen = coordinate.and_then(|coordinate| coordinate.seen(&body));
        let axis = coordinate.and_then(|coordinate| coordinate.axis_seen(&body));
        JointState {
            reaction,
            coordinate: seen.unwrap_or([f64::NAN; 2]),
            axis: axis.unwrap_or(DVec3::NAN),
            total_angle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The meaning names the unit after a comma, for people. The unit for axes must be the same.
    #[test]
    fn each_unit_is_the_one_that_the_meaning_names() {
        let run = RunMeasure::ALL.map(|(name, measure, meaning)| (name, measure.unit(), meaning));
        let body = BodyMeasure::ALL.map(|(name, measure, meaning)| (name, measure.unit(), meaning));
        let joint = JointMeasure::ALL.map(|(name, measure, meaning)| (name, measure.unit(), meaning));
        for (name, unit, meaning) in run.into_iter().chain(body).chain(joint) {
            let symbol = if unit == "°" { "degrees" } else { unit };
            let units = [
                "s",
                "J",
                "m",
                "m/s",
                "m/s²",
                "N",
                "rad/s",
                "kg",
                "kg·m/s",
                "N·m",
                "kg·m²/s",
                "W",
                "degrees",
            ];
            let named: Vec<&str> = units
                .into_iter()
                .filter(|unit| meaning.split([',', ';', ':']).any(|part| part.trim() == *unit))
                .collect();
            match named.as_slice() {
                [] => assert_eq!(symbol, "", "{name}"),
                [only] if !meaning.contains(" or ") || symbol == *only => assert_eq!(symbol, *only, "{name}"),
                _ => assert_eq!(symbol, "", "{name}: {named:?}"),
            }
        }
    }
}
