//! The physical quantities that are drawn in a scene: arrows, axes, ghosts, trails and springs.

use glam::DVec3;

use super::Color;

/// The physical quantities that are drawn with a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Showing {
    /// The arrows for the velocity, the acceleration and the net force of the body, in the order of [`Quantity::OF_BODIES`]. `None` for an
    /// arrow that is not drawn.
    pub arrows: [Option<Arrow>; 3],
    /// The arrows for the body's weight and contact forces, in the order of [`Quantity::OF_LOADS`]. `None` for an arrow that is not drawn.
    pub loads: [Option<Arrow>; 3],
    /// The drawn body axes. `None` if they are not drawn.
    pub axes: Option<BodyAxes>,
    /// The ghosts of the body: its earlier poses at regular intervals. `None` if they are not drawn.
    pub ghosts: Option<Ghosts>,
    /// The trail of the body: its path so far. `None` if it is not drawn.
    pub trail: Option<Trail>,
}

impl Showing {
    /// Returns whether the body has any arrow.
    pub fn has_arrows(&self) -> bool {
        self.arrows.iter().chain(&self.loads).any(Option::is_some)
    }

    /// Returns whether the body has an arrow for its weight or for a contact force.
    pub fn has_loads(&self) -> bool {
        self.loads.iter().any(Option::is_some)
    }
}

/// A vector of a body or of a joint that an arrow can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The velocity of a body, m/s.
    Velocity,
    /// The acceleration of a body, m/s²: the net force divided by the mass.
    Acceleration,
    /// The net force on a body, or the reaction force of a joint on its second end, N.
    Force,
    /// The reaction torque of a joint on its second end, N·m.
    Torque,
    /// The weight of a body, N.
    Weight,
    /// The normal force at a contact of a body, N.
    Normal,
    /// The friction force at a contact of a body, N.
    Friction,
    /// One of the named forces on a body, N.
    NamedForce,
}

impl Quantity {
    /// The number of arrow scales, one for each unit: all forces share one scale.
    pub const SCALE_COUNT: usize = 4;
    /// The number of arrow colors, one for each quantity.
    pub const COLOR_COUNT: usize = 8;

    /// The quantities for the arrows of a body, without its loads.
    pub const OF_BODIES: [Quantity; 3] = [Quantity::Velocity, Quantity::Acceleration, Quantity::Force];

    /// The quantities for the arrows of a body's loads: its weight and its contact forces.
    pub const OF_LOADS: [Quantity; 3] = [Quantity::Weight, Quantity::Normal, Quantity::Friction];

    /// The quantities for the arrows of a joint.
    pub const OF_JOINTS: [Quantity; 2] = [Quantity::Force, Quantity::Torque];

    /// Returns the index of the quantity's arrow scale. All forces share a scale, so that their arrows can be compared.
    pub fn number(self) -> usize {
        match self {
            Quantity::Velocity => 0,
            Quantity::Acceleration => 1,
            Quantity::Force
            | Quantity::Weight
            | Quantity::Normal
            | Quantity::Friction
            | Quantity::NamedForce => 2,
            Quantity::Torque => 3,
        }
    }

    /// Returns the index of the quantity's arrow color, in the order of the enum.
    pub fn color(self) -> usize {
        self as usize
    }

    /// Returns the name of the quantity in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Velocity => "velocity",
            Quantity::Acceleration => "acceleration",
            Quantity::Force => "force",
            Quantity::Torque => "torque",
            Quantity::Weight => "weight",
            Quantity::Normal => "normal",
            Quantity::Friction => "friction",
            Quantity::NamedForce => "force",
        }
    }
}

/// The scale and the color of an arrow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arrow {
    /// The length of the arrow in meters per unit of its quantity. `None` for a common scale of all such arrows, at which the longest
    /// arrow of the run is easy to see.
    pub scale: Option<f64>,
    /// The color of the arrow. `None` for the default color of its quantity.
    pub color: Option<Color>,
}

/// The body axes as they are drawn on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyAxes {
    /// The length of each drawn axis, m. `None` for twice the largest extent of the drawn body from its center along one of the axes.
    pub length: Option<f64>,
}

/// Earlier poses of a body that are drawn at regular intervals, as under a stroboscope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ghosts {
    /// The interval of time between two ghosts, s. The first ghost is at time 0.
    pub every: f64,
    /// Whether the arrows of the body are also drawn on each ghost.
    pub arrows: bool,
}

/// A line that is drawn along the path of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trail {
    /// The time that the trail covers, s. `None` for the whole time since the start.
    pub duration: Option<f64>,
    /// The width of the drawn trail, m. `None` for a width that is easy to see.
    pub width: Option<f64>,
    /// The color of the trail. `None` for the color of the body.
    pub color: Option<Color>,
    /// The point of the body whose path is drawn, m, relative to the center of mass in body axes.
    pub at: DVec3,
}

/// The look of a spring. jabuka derives missing values from the length and the ends of the spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringLook {
    /// Whether the spring is drawn as a coil or as a straight line.
    pub line: SpringLine,
    /// The radius of the drawn coil or straight line, m. `None` for a radius that jabuka derives.
    pub radius: Option<f64>,
    /// The color of the spring. `None` for the default color.
    pub color: Option<Color>,
}

/// The line with which a spring is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringLine {
    /// The spring is drawn as a coil of wire.
    Coil {
        /// The number of turns of the coil. `None` for a number that suits the spring.
        turns: Option<u32>,
    },
    /// The spring is drawn as a straight line from end to end.
    Straight,
}
