//! The part of a checked scene that is measured and written: labels, the scale bar, the grid.

use super::Color;
use super::JointKind;
use super::expression::Program;
use crate::dynamics::Reaction;

/// A text in the picture.
#[derive(Clone, Debug)]
pub struct Label {
    /// Its name, unique among labels.
    pub name: String,
    /// Its text, piece by piece.
    pub text: Vec<Piece>,
    /// Its place.
    pub place: LabelPlace,
    /// The height of its lines, as part of the picture's height; none: as is well read.
    pub size: Option<f64>,
    /// Its color; none: dark, or light before a dark background.
    pub color: Option<Color>,
}

/// A piece of a label.
#[derive(Clone, Debug)]
pub enum Piece {
    /// Words as they are.
    Words(String),
    /// The value of a formula at the moment that is shown.
    Value {
        /// The formula, whose inputs are the values of `inputs`.
        formula: Program,
        /// The measures that the formula uses.
        inputs: Vec<Measure>,
        /// How the value is written.
        format: Format,
    },
}

/// How a number is written in a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// With three significant digits.
    Short,
    /// With so many decimals.
    Decimals(usize),
    /// With so many decimals and a power of ten.
    Scientific(usize),
}

/// The place of a label.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LabelPlace {
    /// At an edge of the picture.
    Corner(Corner),
    /// Beside a body.
    Body {
        /// The number of the body.
        body: usize,
        /// On which side.
        side: Side,
        /// Whether it stands beside each ghost as well, with the values of its time.
        ghosts: bool,
    },
}

/// An edge of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// At the top, on the left.
    TopLeft,
    /// At the top, in the middle.
    Top,
    /// At the top, on the right.
    TopRight,
    /// At the bottom, on the left.
    BottomLeft,
    /// At the bottom, in the middle.
    Bottom,
    /// At the bottom, on the right.
    BottomRight,
}

impl Corner {
    /// All of them.
    pub const ALL: [Corner; 6] = [
        Corner::TopLeft,
        Corner::Top,
        Corner::TopRight,
        Corner::BottomLeft,
        Corner::Bottom,
        Corner::BottomRight,
    ];

    /// Its name in scenes.
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

/// A side of a body in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Over it.
    Above,
    /// Under it.
    Below,
    /// To its left.
    Left,
    /// To its right.
    Right,
}

impl Side {
    /// All of them.
    pub const ALL: [Side; 4] = [Side::Above, Side::Below, Side::Left, Side::Right];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Side::Above => "above",
            Side::Below => "below",
            Side::Left => "left",
            Side::Right => "right",
        }
    }
}

/// A number of a moment that labels can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A number of the whole run.
    Run(RunMeasure),
    /// A number of the body with this number in the scene.
    Body(usize, BodyMeasure),
    /// A number of the joint with this number in the scene.
    Joint(usize, JointMeasure),
    /// How many impacts there have been of the pair with this number in the scene.
    Impacts(usize),
}

impl Measure {
    /// Whether it is a number of things, which is written with all of its digits.
    pub fn is_count(self) -> bool {
        matches!(
            self,
            Measure::Run(RunMeasure::Impacts) | Measure::Body(_, BodyMeasure::Impacts) | Measure::Impacts(_)
        )
    }
}

/// A number of the whole run at a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunMeasure {
    /// The time, s.
    Time,
    /// The number of the frame.
    Frame,
    /// Kinetic and potential energy, J.
    Energy,
    /// The kinetic energy, J.
    Kinetic,
    /// The potential energy, J.
    Potential,
    /// How many impacts there have been.
    Impacts,
}

impl RunMeasure {
    /// All of them, each with its name in formulas and what it is.
    pub const ALL: [(&'static str, RunMeasure, &'static str); 6] = [
        ("t", RunMeasure::Time, "the time, s"),
        ("frame", RunMeasure::Frame, "the number of the frame"),
        ("energy", RunMeasure::Energy, "kinetic and potential energy of the whole scene, J"),
        ("kinetic_energy", RunMeasure::Kinetic, "its kinetic energy, J"),
        ("potential_energy", RunMeasure::Potential, "its potential energy, J"),
        ("impacts", RunMeasure::Impacts, "the number of impacts so far; needs `simulation.contacts`"),
    ];
}

/// A number of a body at a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyMeasure {
    /// A coordinate of its location, m.
    Location(usize),
    /// Its speed, m/s.
    Speed,
    /// A component of its velocity, m/s.
    Velocity(usize),
    /// The size of its acceleration, m/s².
    Accelerating,
    /// A component of its acceleration, m/s².
    Acceleration(usize),
    /// The size of the sum of the forces on it, N.
    Pull,
    /// A component of the sum of the forces on it, N.
    Force(usize),
    /// The size of its angular velocity, rad/s.
    Spin,
    /// Its mass, kg.
    Mass,
    /// Its momentum, kg·m/s.
    Momentum,
    /// The kinetic energy of its translation, J.
    Kinetic,
    /// How many impacts it has had.
    Impacts,
}

impl BodyMeasure {
    /// All of them, each with its name in formulas and what it is.
    pub const ALL: [(&'static str, BodyMeasure, &'static str); 20] = [
        ("x", BodyMeasure::Location(0), "its location, m"),
        ("y", BodyMeasure::Location(1), "its location, m"),
        ("z", BodyMeasure::Location(2), "its location, m"),
        ("speed", BodyMeasure::Speed, "its speed, m/s"),
        ("vx", BodyMeasure::Velocity(0), "its velocity, m/s"),
        ("vy", BodyMeasure::Velocity(1), "its velocity, m/s"),
        ("vz", BodyMeasure::Velocity(2), "its velocity, m/s"),
        ("acceleration", BodyMeasure::Accelerating, "the size of its acceleration, m/s²"),
        ("ax", BodyMeasure::Acceleration(0), "its acceleration, m/s²"),
        ("ay", BodyMeasure::Acceleration(1), "its acceleration, m/s²"),
        ("az", BodyMeasure::Acceleration(2), "its acceleration, m/s²"),
        ("force", BodyMeasure::Pull, "the size of the sum of the forces on it, N"),
        ("fx", BodyMeasure::Force(0), "the sum of the forces on it, N"),
        ("fy", BodyMeasure::Force(1), "the sum of the forces on it, N"),
        ("fz", BodyMeasure::Force(2), "the sum of the forces on it, N"),
        ("spin", BodyMeasure::Spin, "the size of its angular velocity, rad/s"),
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

/// A number of a joint at a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointMeasure {
    /// The size of its force, N.
    ForceMagnitude,
    /// A component of its force, N.
    Force(usize),
    /// The size of its torque, N·m.
    TorqueMagnitude,
    /// A component of its torque, N·m.
    Torque(usize),
    /// The angle of a hinge, degrees.
    Angle,
    /// The position of a slider along its axis, m.
    Position,
    /// The rate of change of the hinge angle, rad/s, or of the slider position, m/s.
    Speed,
}

impl JointMeasure {
    /// All of them, each with its name in formulas and what it is.
    pub const ALL: [(&'static str, JointMeasure, &'static str); 11] = [
        ("joint.NAME.force", JointMeasure::ForceMagnitude, "the size of its force on its second end, N"),
        ("joint.NAME.fx", JointMeasure::Force(0), "its force on its second end, N"),
        ("joint.NAME.fy", JointMeasure::Force(1), "its force on its second end, N"),
        ("joint.NAME.fz", JointMeasure::Force(2), "its force on its second end, N"),
        (
            "joint.NAME.torque",
            JointMeasure::TorqueMagnitude,
            "the size of its torque on its second end, about that point, N·m",
        ),
        ("joint.NAME.tx", JointMeasure::Torque(0), "its torque on its second end, N·m"),
        ("joint.NAME.ty", JointMeasure::Torque(1), "its torque on its second end, N·m"),
        ("joint.NAME.tz", JointMeasure::Torque(2), "its torque on its second end, N·m"),
        (
            "joint.NAME.angle",
            JointMeasure::Angle,
            "the angle of a hinge, degrees, from -180 to 180; 0 is at the start",
        ),
        (
            "joint.NAME.position",
            JointMeasure::Position,
            "the way of a slider along its axis, m; 0 is at the start",
        ),
        ("joint.NAME.speed", JointMeasure::Speed, "the rate of that angle, rad/s, or of that way, m/s"),
    ];

    /// The names behind the name of a joint, with their measures.
    pub fn names() -> impl Iterator<Item = (&'static str, JointMeasure)> {
        JointMeasure::ALL.into_iter().filter_map(|(name, it, _)| Some((name.rsplit_once('.')?.1, it)))
    }

    /// Whether a joint has it.
    pub fn is_of(self, joint: &JointKind) -> bool {
        match self {
            JointMeasure::Angle => matches!(joint, JointKind::Hinge(_)),
            JointMeasure::Position => matches!(joint, JointKind::Slider(_)),
            JointMeasure::Speed => joint.coordinate().is_some(),
            _ => true,
        }
    }

    /// Whether it is a force or a torque of the joint.
    pub fn is_reaction(self) -> bool {
        !matches!(self, JointMeasure::Angle | JointMeasure::Position | JointMeasure::Speed)
    }

    /// Its value for what a joint does, and for its coordinate with its rate.
    pub fn of(self, reaction: &Reaction, [value, rate]: [f64; 2]) -> f64 {
        match self {
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

/// A bar in the picture that shows a length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleBar {
    /// Its length, m; none: about a fifth of the picture's width.
    pub length: Option<f64>,
    /// The corner of the picture.
    pub corner: Corner,
}

/// Lines with numbers, to read lengths from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The distance from one line to the next, m; none: after the size of the motion.
    pub spacing: Option<f64>,
    /// Its plane.
    pub plane: GridPlane,
}

/// The plane of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridPlane {
    /// On the ground.
    Ground,
    /// Upright behind the motion.
    Wall,
}

impl GridPlane {
    /// All of them.
    pub const ALL: [GridPlane; 2] = [GridPlane::Ground, GridPlane::Wall];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            GridPlane::Ground => "ground",
            GridPlane::Wall => "wall",
        }
    }
}
