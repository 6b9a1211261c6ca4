//! The quantities of joints.

use glam::DVec3;

use super::super::JointKind;
use crate::physics::{BodyId, BodySnapshot, Coordinate, Reaction};

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
        ("joint.NAME.force", JointMeasure::ForceMagnitude, "the size of its force on its second end"),
        ("joint.NAME.fx", JointMeasure::Force(0), "its force on its second end"),
        ("joint.NAME.fy", JointMeasure::Force(1), "its force on its second end"),
        ("joint.NAME.fz", JointMeasure::Force(2), "its force on its second end"),
        (
            "joint.NAME.torque",
            JointMeasure::TorqueMagnitude,
            "the size of its whole torque on its second end, about that point: that of its bearing, its limits and its motor",
        ),
        ("joint.NAME.tx", JointMeasure::Torque(0), "its torque on its second end"),
        ("joint.NAME.ty", JointMeasure::Torque(1), "its torque on its second end"),
        ("joint.NAME.tz", JointMeasure::Torque(2), "its torque on its second end"),
        (
            "joint.NAME.motor",
            JointMeasure::Motor,
            "what its motor gives: the torque of a hinge, or the force of a slider; positive in the direction of the angle or way",
        ),
        (
            "joint.NAME.axial_force",
            JointMeasure::AxialForce,
            "the part of its force along the axis of a hinge or slider",
        ),
        (
            "joint.NAME.axial_torque",
            JointMeasure::AxialTorque,
            "the part of its torque about the axis of a hinge or slider",
        ),
        (
            "joint.NAME.angle",
            JointMeasure::Angle,
            "the angle of a hinge, from -180° to 180°; 0 is at the start",
        ),
        ("joint.NAME.total_angle", JointMeasure::TotalAngle, "that angle, counted through full turns"),
        (
            "joint.NAME.position",
            JointMeasure::Position,
            "the way of a slider along its axis; 0 is at the start",
        ),
        ("joint.NAME.speed", JointMeasure::Speed, "the rate of that angle, or of that way"),
    ];

    /// Returns all quantities of a joint, each with the last part of its name, such as `force`.
    pub fn names() -> impl Iterator<Item = (&'static str, JointMeasure)> {
        JointMeasure::ALL.into_iter().filter_map(|(name, it, _)| Some((name.rsplit_once('.')?.1, it)))
    }

    /// Returns the symbol of the quantity's unit, for a hinge and for other joints.
    const fn units(self) -> [&'static str; 2] {
        match self {
            JointMeasure::ForceMagnitude | JointMeasure::Force(_) | JointMeasure::AxialForce => ["N"; 2],
            JointMeasure::TorqueMagnitude | JointMeasure::Torque(_) | JointMeasure::AxialTorque => ["N·m"; 2],
            JointMeasure::Angle | JointMeasure::TotalAngle => ["°"; 2],
            JointMeasure::Position => ["m"; 2],
            JointMeasure::Motor => ["N·m", "N"],
            JointMeasure::Speed => ["rad/s", "m/s"],
        }
    }

    /// Returns the symbol of the unit that the quantity has for a joint of the given kind.
    pub fn unit_of(self, joint: &JointKind) -> &'static str {
        self.units()[usize::from(!matches!(joint, JointKind::Hinge(_)))]
    }

    /// Returns the units that the quantity can have, for people: `N·m or N`.
    pub fn unit_in_words(self) -> String {
        let [of_hinge, of_other] = self.units();
        if of_hinge == of_other { of_hinge.to_owned() } else { format!("{of_hinge} or {of_other}") }
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
