//! The labels, the scale bar and the grid of a scene, with the quantities that labels can show.

use glam::DVec3;

use super::Color;
use super::JointKind;
use super::expression::Program;
use crate::physics::{BodyId, BodySnapshot, Coordinate, Reaction};

/// A text that is drawn in the picture.
#[derive(Clone, Debug)]
pub struct Label {
    /// The name of the label, unique among labels.
    pub name: String,
    /// The pieces of the label's text, in order.
    pub text: Vec<Piece>,
    /// The position of the label in the picture.
    pub place: LabelPlace,
    /// The line height as a fraction of the picture's height. `None` for a size that is easy to read.
    pub size: Option<f64>,
    /// The color of the text. `None` for the default color: dark on a light background, and light on a dark one.
    pub color: Option<Color>,
}

/// A piece of a label's text.
#[derive(Clone, Debug)]
pub enum Piece {
    /// Text that is the same in all frames.
    Words(String),
    /// The value of a formula at the time of the frame.
    Value {
        /// The compiled formula. Its inputs are the values of the measures in `inputs`.
        formula: Program,
        /// The measures that the formula uses, in the order of the formula's inputs.
        inputs: Vec<Measure>,
        /// The number format of the value.
        format: Format,
    },
}

/// The format of a number in a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A number with three significant digits.
    Short,
    /// A number with this many decimals.
    Decimals(usize),
    /// Scientific notation with this many decimals and a power of ten.
    Scientific(usize),
}

/// The position of a label in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LabelPlace {
    /// The label stands in a corner of the picture, or at the middle of an edge.
    Corner(Corner),
    /// The label stands beside a body and moves with it.
    Body {
        /// The index of the body beside which the label stands.
        body: usize,
        /// The side of the body on which the label stands.
        side: Side,
        /// Whether each ghost of the body also has a label, with the values at the time of the ghost.
        ghosts: bool,
    },
}

/// A corner of the picture, or the middle of its top or bottom edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// The top left corner.
    TopLeft,
    /// The middle of the top edge.
    Top,
    /// The top right corner.
    TopRight,
    /// The bottom left corner.
    BottomLeft,
    /// The middle of the bottom edge.
    Bottom,
    /// The bottom right corner.
    BottomRight,
}

impl Corner {
    /// All corners and edges.
    pub const ALL: [Corner; 6] = [
        Corner::TopLeft,
        Corner::Top,
        Corner::TopRight,
        Corner::BottomLeft,
        Corner::Bottom,
        Corner::BottomRight,
    ];

    /// Returns the name of the corner in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Corner::TopLeft => "top-left",
            Corner::Top => "top",
            Corner::TopRight => "top-right",
            Corner::BottomLeft => "bottom-left",
            Corner::Bottom => "bottom",
            Corner::BottomRight => "bottom-right",
        }
    }
}

/// The side of a body on which its label stands, as seen in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The label stands above the body.
    Above,
    /// The label stands below the body.
    Below,
    /// The label stands to the left of the body.
    Left,
    /// The label stands to the right of the body.
    Right,
}

impl Side {
    /// All sides of a body on which a label can stand.
    pub const ALL: [Side; 4] = [Side::Above, Side::Below, Side::Left, Side::Right];

    /// Returns the name of the side in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Side::Above => "above",
            Side::Below => "below",
            Side::Left => "left",
            Side::Right => "right",
        }
    }
}

/// A quantity that labels can show. It has a value at each time of the run.
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
    /// The number of impacts in the whole scene so far.
    Impacts,
}

impl RunMeasure {
    /// All quantities of the run, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, RunMeasure, &'static str); 6] = [
        ("t", RunMeasure::Time, "the time, s"),
        ("frame", RunMeasure::Frame, "the number of the frame"),
        ("energy", RunMeasure::Energy, "kinetic and potential energy of the whole scene, J"),
        ("kinetic_energy", RunMeasure::Kinetic, "its kinetic energy, J"),
        ("potential_energy", RunMeasure::Potential, "its potential energy, J"),
        ("impacts", RunMeasure::Impacts, "the number of impacts so far; needs `simulation.contacts`"),
    ];
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
    /// The kinetic energy of translation and rotation, J.
    Kinetic,
    /// The number of impacts of the body so far.
    Impacts,
}

impl BodyMeasure {
    /// All quantities of a body, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, BodyMeasure, &'static str); 20] = [
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
        ("kinetic", BodyMeasure::Kinetic, "its kinetic energy, of translation and rotation, J"),
        (
            "impacts",
            BodyMeasure::Impacts,
            "the number of its impacts so far; `a.impacts.b` counts those of two bodies, `a.impacts.ground` those with the ground",
        ),
    ];
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

/// A scale bar in the picture: a bar of known length, with that length written beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleBar {
    /// The length of the bar, m. `None` for about a fifth of the picture's width.
    pub length: Option<f64>,
    /// The corner of the picture in which the bar is drawn.
    pub corner: Corner,
}

/// A grid of numbered lines at regular distances, from which lengths in the picture can be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The distance between two neighboring lines, m. `None` for a distance that suits the extent of the motion.
    pub spacing: Option<f64>,
    /// The plane in which the grid lies.
    pub plane: GridPlane,
}

/// The plane in which a grid lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridPlane {
    /// The plane of the ground.
    Ground,
    /// A vertical plane behind the motion.
    Wall,
}

impl GridPlane {
    /// All planes of grids.
    pub const ALL: [GridPlane; 2] = [GridPlane::Ground, GridPlane::Wall];

    /// Returns the name of the plane in scenes.
    pub fn name(self) -> &'static str {
        match self {
            GridPlane::Ground => "ground",
            GridPlane::Wall => "wall",
        }
    }
}
