//! The physics drawn in a checked scene: arrows, axes, ghosts, trails and springs.

use glam::DVec3;

use super::Color;

/// The physics drawn with a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Showing {
    /// Arrows for the vectors of the body, in the order of [`Quantity::OF_BODIES`].
    pub arrows: [Option<Arrow>; 3],
    /// Arrows for the body's weight and contact forces, in the order of [`Quantity::OF_LOADS`].
    pub loads: [Option<Arrow>; 3],
    /// The axes of the body.
    pub axes: Option<BodyAxes>,
    /// The ghosts of the body: earlier poses at regular intervals.
    pub ghosts: Option<Ghosts>,
    /// The trail of the body: its path so far.
    pub trail: Option<Trail>,
}

impl Showing {
    /// Whether the body has any arrow.
    pub fn has_arrows(&self) -> bool {
        self.arrows.iter().chain(&self.loads).any(Option::is_some)
    }

    /// Whether the body has an arrow for its weight or a contact force.
    pub fn has_loads(&self) -> bool {
        self.loads.iter().any(Option::is_some)
    }
}

/// A vector of a body or of a joint that an arrow can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The velocity of a body, m/s.
    Velocity,
    /// The net force on a body divided by its mass, m/s².
    Acceleration,
    /// The net force on a body, or the force of a joint on its second end, N.
    Force,
    /// The torque of a joint on its second end, N m.
    Torque,
    /// The weight of a body, N.
    Weight,
    /// The normal force of a touching body, N.
    Normal,
    /// The friction force of a touching body, N.
    Friction,
}

impl Quantity {
    /// The number of scales.
    pub const COUNT: usize = 5;
    /// The number of colors.
    pub const COLORS: usize = 7;

    /// The vectors of a body.
    pub const OF_BODIES: [Quantity; 3] = [Quantity::Velocity, Quantity::Acceleration, Quantity::Force];

    /// The weight of a body, and the forces of touching bodies.
    pub const OF_LOADS: [Quantity; 3] = [Quantity::Weight, Quantity::Normal, Quantity::Friction];

    /// The vectors of a joint.
    pub const OF_JOINTS: [Quantity; 2] = [Quantity::Force, Quantity::Torque];

    /// The index of the scale. Weight, normal force and friction share a scale, so that their arrows can be compared.
    pub fn number(self) -> usize {
        self.color().min(Self::COUNT - 1)
    }

    /// The index of the color, in the order of the enum.
    pub fn color(self) -> usize {
        self as usize
    }

    /// The name of the quantity in scenes.
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
    /// The length of the arrow per unit of its quantity, m. `None` for a common scale of all such arrows of the
    /// quantity, at which the longest arrow of the run is easy to see.
    pub scale: Option<f64>,
    /// The color of the arrow. `None` for the color of its quantity.
    pub color: Option<Color>,
}

/// The axes drawn on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyAxes {
    /// The length of each axis, m. `None` for twice the reach of the body.
    pub length: Option<f64>,
}

/// Earlier poses of a body at regular intervals, as under a stroboscope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ghosts {
    /// The interval between two ghosts, s. The first ghost is at time 0.
    pub every: f64,
    /// Whether each ghost has the arrows of the body.
    pub arrows: bool,
}

/// A line along the path of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trail {
    /// The time that the trail covers, s. `None` for the time since the start.
    pub duration: Option<f64>,
    /// The width of the trail, m. `None` for a width that is easy to see.
    pub width: Option<f64>,
    /// The color of the trail. `None` for the color of the body.
    pub color: Option<Color>,
    /// The point of the body that draws the trail, m, from the centre of mass, in the body's axes.
    pub at: DVec3,
}

/// The look of a spring. jabuka derives missing values from the length and the ends of the spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringLook {
    /// The form of the drawn spring.
    pub line: SpringLine,
    /// The radius of the coil or of the straight line, m.
    pub radius: Option<f64>,
    /// The color of the spring.
    pub color: Option<Color>,
}

/// The form of a drawn spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringLine {
    /// A coil of wire.
    Coil {
        /// The number of turns of the coil. `None` for a number that suits the spring.
        turns: Option<u32>,
    },
    /// A straight line from end to end.
    Straight,
}
