//! The part of a checked scene that shows its physics: arrows, axes, ghosts, trails and springs.

use glam::DVec3;

use super::Color;

/// The physics shown beside a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Showing {
    /// Arrows for its vectors, in the order of [`Quantity::OF_BODIES`].
    pub arrows: [Option<Arrow>; 3],
    /// Arrows for its weight and what touches it, in the order of [`Quantity::OF_LOADS`].
    pub loads: [Option<Arrow>; 3],
    /// Its own axes.
    pub axes: Option<BodyAxes>,
    /// Ghosts: its earlier poses, at regular intervals.
    pub ghosts: Option<Ghosts>,
    /// The way that it has come.
    pub trail: Option<Trail>,
}

impl Showing {
    /// Whether the body has any arrow.
    pub fn has_arrows(&self) -> bool {
        self.arrows.iter().chain(&self.loads).any(Option::is_some)
    }

    /// Whether it has arrows for its weight or for what touches it.
    pub fn has_loads(&self) -> bool {
        self.loads.iter().any(Option::is_some)
    }
}

/// A vector of a body or of a joint that an arrow can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Its velocity, m/s.
    Velocity,
    /// The sum of the forces on it by its mass, m/s².
    Acceleration,
    /// The sum of the forces on a body, or the force of a joint on its second end, N.
    Force,
    /// The torque of a joint on its second end, N m.
    Torque,
    /// The weight of a body, N.
    Weight,
    /// The normal force of another body that touches it, N.
    Normal,
    /// The friction of another body that touches it, N.
    Friction,
}

impl Quantity {
    /// How many scales there are.
    pub const COUNT: usize = 5;
    /// How many colors there are.
    pub const COLORS: usize = 7;

    /// Those of bodies.
    pub const OF_BODIES: [Quantity; 3] = [Quantity::Velocity, Quantity::Acceleration, Quantity::Force];

    /// The weight of a body, and the forces of what touches it.
    pub const OF_LOADS: [Quantity; 3] = [Quantity::Weight, Quantity::Normal, Quantity::Friction];

    /// Those of joints.
    pub const OF_JOINTS: [Quantity; 2] = [Quantity::Force, Quantity::Torque];

    /// The number of its scale. Weight, normal force and friction share one, since they are to be compared.
    pub fn number(self) -> usize {
        self.color().min(Self::COUNT - 1)
    }

    /// The number of its color, in the order of the enum.
    pub fn color(self) -> usize {
        self as usize
    }

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Velocity => "velocity",
            Quantity::Acceleration => "acceleration",
            Quantity::Force => "force",
            Quantity::Torque => "torque",
            Quantity::Weight => "weight",
            Quantity::Normal => "normal",
            Quantity::Friction => "friction",
        }
    }
}

/// An arrow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arrow {
    /// Its length for one unit of what it shows, m; none: the same for all arrows of its kind that have none, so
    /// that the longest of the whole run is easily seen.
    pub scale: Option<f64>,
    /// Its color; none: that of its kind.
    pub color: Option<Color>,
}

/// The axes that are drawn on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyAxes {
    /// The length of each, m; none: twice as far as the body reaches.
    pub length: Option<f64>,
}

/// The places of a body as a stroboscope shows them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ghosts {
    /// The time from one to the next, s; the first is at 0.
    pub every: f64,
    /// Whether each has the arrows of the body.
    pub arrows: bool,
}

/// A line along the way of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trail {
    /// How far back it goes, s; none: to the beginning.
    pub duration: Option<f64>,
    /// Its width, m; none: as is well seen.
    pub width: Option<f64>,
    /// Its color; none: that of the body.
    pub color: Option<Color>,
    /// The point of the body that leaves it, in the body's own axes, from its centre of mass, m.
    pub at: DVec3,
}

/// How a spring is drawn. What is not given follows from its length and from what it is fastened to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringLook {
    /// As what.
    pub line: SpringLine,
    /// The radius of the coil or of the straight line, m.
    pub radius: Option<f64>,
    /// Its color.
    pub color: Option<Color>,
}

/// As what a spring is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringLine {
    /// A coil of wire.
    Coil {
        /// The number of its turns.
        turns: Option<u32>,
    },
    /// A straight line from end to end.
    Straight,
}
